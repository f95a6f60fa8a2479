//! Measures errors over all lamps of a scene against rays.

use std::error::Error;
use std::time::Instant;

use glam::{DVec3, Mat4, Vec3};
use shadow_support::camera;
use shadow_support::gpu::Gpu;
use shadow_support::measure::parallel;
use shadow_support::mesh::render_space_pipeline;
use shadow_support::probe::{Point, PointShader};
use shadow_support::truth::{LightInWorld, World};
use wgpu_shadows::{
    CameraView, Casters, Coverage, MeshCaster, OmniLight, OmniShadow, OmniShadowDescriptor,
    ShadowBindings, ShadowBindingsDescriptor, ShadowCaster, ShadowError, ShadowFrame,
    ShadowFrameDescriptor, ShadowMaps, ShadowScene, SpotLight, SpotShadow, SpotShadowDescriptor,
    pool::OmniShadowPool, pool::PoolDescriptor, pool::PoolLight, pool::ShadowSlot,
    pool::SpotShadowPool,
};

use super::scenes::{LampScene, Lamps};

/// Are the numbers of texels per side of the layer of a pool.
const SIDES: [u32; 5] = [512, 1024, 2048, 4096, 8192];

/// Is a pair of a visible point and a lamp that shines on it.
struct Pair {
    lamp: u32,
    point: Point,
    /// States that nothing is between them.
    is_lit: bool,
}

/// Is the error of all lamps at some number of bytes.
struct Row {
    side: u32,
    by_need: f64,
    predicted: f64,
    equal: f64,
    squares: String,
}

/// Prints the errors by need and with equal maps for each number of bytes, for an image of
/// `picture` pixels.
pub fn measure(gpu: &Gpu, scene: &LampScene, picture: [u32; 2]) -> Result<(), Box<dyn Error>> {
    let pairs = pairs(scene, picture);
    println!(
        "\nlamps of {}: {} views, {} pairs of a pixel and a lamp\n{:>8}{:>10}{:>12}{:>12}{:>12}{:>8}  squares by need",
        scene.name,
        scene.views(),
        pairs.len(),
        "side",
        "MB",
        "by need",
        "predicted",
        "equal",
        "ratio"
    );
    let pipeline = render_space_pipeline(gpu);
    let casters = scene.meshes.iter();
    let casters: Vec<MeshCaster> = casters
        .map(|mesh| mesh.caster(gpu, &pipeline, Mat4::IDENTITY))
        .collect();
    let list: Vec<&dyn ShadowCaster> = casters.iter().map(|caster| caster as _).collect();
    let mut shadow_scene = ShadowScene::new();
    let frame = shadow_scene.frame(&ShadowFrameDescriptor {
        origin: DVec3::ZERO,
        coverage: Coverage::Cameras(&[scene.camera]),
        casters: Casters::List(&list),
        receivers: &[],
    })?;
    let mut rows = Vec::new();
    let largest = gpu.device.limits().max_texture_dimension_2d;
    for side in SIDES.into_iter().filter(|side| *side <= largest) {
        let row = row(gpu, scene, &frame, &pairs, side)?;
        println!(
            "{:>8}{:>10.1}{:>12.4}{:>12.4}{:>12.4}{:>8.2}  {}",
            row.side,
            f64::from(side).powi(2) * 4.0 / 1e6,
            row.by_need,
            row.predicted,
            row.equal,
            row.by_need / row.equal,
            row.squares
        );
        rows.push(row);
    }
    for pair in rows.windows(2) {
        println!(
            "by need with {} a side over equal with four times the bytes: {:.2}",
            pair[0].side,
            pair[0].by_need / pair[1].equal
        );
    }
    print_time(gpu, scene, &list)
}

fn pairs(scene: &LampScene, picture: [u32; 2]) -> Vec<Pair> {
    let meshes = scene.meshes.iter();
    let triangles: Vec<_> = meshes
        .flat_map(|mesh| mesh.triangles(&Mat4::IDENTITY))
        .collect();
    let sun = LightInWorld::Far {
        toward_light: DVec3::Y,
        disc_tangent: 0.0,
    };
    let world = World::from_triangles(&triangles, 1000.0, sun);
    let rays: Vec<_> = camera::pixel_rays(&scene.camera, picture).collect();
    let places = scene.places();
    let of_ray = |ray: &camera::PixelRay| {
        let Some(hit) = world.first_hit(ray.start, ray.direction, ray.reach) else {
            return Vec::new();
        };
        let position = ray.start + ray.direction * hit.distance;
        let shines = (0u32..)
            .zip(&places)
            .filter(|(_, (lamp, range, axis, cosine))| {
                let way = *lamp - position;
                way.length() < 0.98 * range
                    && way.normalize().dot(hit.normal) > 0.02
                    && -way.normalize().dot(*axis) > *cosine + 0.02
            });
        let pair = |(lamp, (place, ..)): (u32, &(DVec3, f64, DVec3, f64))| Pair {
            lamp,
            // The shader reads the number of the lamp from the length of the normal.
            point: Point::rounded(position, hit.normal * f64::from(lamp + 1)),
            is_lit: world.is_clear(position, *place, hit.normal),
        };
        shines.map(pair).collect()
    };
    let pairs = parallel::map(&format!("truth of {}", scene.name), &rays, of_ray);
    pairs.into_iter().flatten().collect()
}

fn row(
    gpu: &Gpu,
    scene: &LampScene,
    frame: &ShadowFrame<'_>,
    pairs: &[Pair],
    side: u32,
) -> Result<Row, Box<dyn Error>> {
    let (by_need, predicted, squares) = by_need(gpu, scene, frame, pairs, side)?;
    let texels = f64::from(side).powi(2) / f64::from(scene.views());
    let map_size = texels.sqrt() as u32;
    Ok(Row {
        side,
        by_need,
        predicted,
        equal: equal(gpu, scene, frame, pairs, map_size)?,
        squares: format!("{squares} against {map_size} each"),
    })
}

/// Returns the root of the mean squared error.
fn error(pairs: &[Pair], seen: &[f32]) -> f64 {
    let squares = pairs.iter().zip(seen).map(|(pair, seen)| {
        let wanted = if pair.is_lit { 1.0 } else { 0.0 };
        (f64::from(*seen) - wanted).powi(2)
    });
    (squares.sum::<f64>() / pairs.len() as f64).sqrt()
}

fn bindings(gpu: &Gpu, maps: &ShadowMaps) -> Result<ShadowBindings, Box<dyn Error>> {
    let descriptor = ShadowBindingsDescriptor {
        visibility: wgpu::ShaderStages::COMPUTE,
        lights: &[("lamps", maps)],
        ..Default::default()
    };
    Ok(ShadowBindings::new(&gpu.device, &descriptor)?)
}

fn by_need(
    gpu: &Gpu,
    scene: &LampScene,
    frame: &ShadowFrame<'_>,
    pairs: &[Pair],
    side: u32,
) -> Result<(f64, f64, String), Box<dyn Error>> {
    let mut pool = Pool::new(gpu, scene, side)?;
    let mut encoder = gpu.encoder();
    pool.record(&mut encoder, frame)?;
    let maps = pool.maps();
    gpu.submit(encoder);
    let report = maps.report();
    let sizes = report.views.iter().map(|view| view.texels.size.x);
    let mut sizes: Vec<u32> = sizes.filter(|size| *size > 0).collect();
    sizes.sort_unstable_by(|a, b| b.cmp(a));
    let counts = sizes.chunk_by(|a, b| a == b);
    let counts: Vec<String> = counts
        .map(|same| format!("{}×{}²", same.len(), same[0]))
        .collect();
    let predicted = report.predicted_error.map_or(f64::NAN, f64::from);
    let bindings = bindings(gpu, maps)?;
    let value = "shadow_lamps(u32(length(point.normal) + 0.5) - 1u, point.position, normalize(point.normal))";
    let shader = PointShader::new(gpu, bindings.wgsl(), "f32", value, bindings.layout());
    let points: Vec<Point> = pairs.iter().map(|pair| pair.point).collect();
    let seen: Vec<f32> = shader.ask(gpu, bindings.bind_group(), &points);
    Ok((error(pairs, &seen), predicted, counts.join(" ")))
}

/// Prints how long `record` takes on the CPU while the camera moves.
fn print_time(
    gpu: &Gpu,
    scene: &LampScene,
    list: &[&dyn ShadowCaster],
) -> Result<(), Box<dyn Error>> {
    const FRAMES: u32 = 96;
    let mut pool = Pool::new(gpu, scene, 2048)?;
    let mut shadow_scene = ShadowScene::new();
    let mut microseconds = Vec::new();
    for step in 0..FRAMES {
        let shift = Mat4::from_translation(Vec3::new(0.0, 0.0, 0.02 * step as f32));
        let camera = CameraView {
            view_from_render: shift * scene.camera.view_from_render,
            ..scene.camera
        };
        let frame = shadow_scene.frame(&ShadowFrameDescriptor {
            origin: DVec3::ZERO,
            coverage: Coverage::Cameras(&[camera]),
            casters: Casters::List(list),
            receivers: &[],
        })?;
        let mut encoder = gpu.encoder();
        let start = Instant::now();
        pool.record(&mut encoder, &frame)?;
        microseconds.push(start.elapsed().as_secs_f64() * 1e6);
        gpu.submit(encoder);
    }
    // The first frame draws everything.
    let mut rest = microseconds.split_off(1);
    let predictions: Vec<f64> = rest.iter().skip(15).step_by(16).copied().collect();
    rest.sort_by(f64::total_cmp);
    println!(
        "`record` on the CPU, the camera moving: median {:.0} µs, in frames with a prediction {:.0} µs on average",
        rest[rest.len() / 2],
        predictions.iter().sum::<f64>() / predictions.len() as f64
    );
    Ok(())
}

/// Is a pool with every lamp of a scene in a slot of its own, in order.
enum Pool {
    Spots(SpotShadowPool, Vec<PoolLight<SpotLight>>),
    Points(OmniShadowPool, Vec<PoolLight<OmniLight>>),
}

impl Pool {
    fn new(gpu: &Gpu, scene: &LampScene, side: u32) -> Result<Self, ShadowError> {
        fn listed<L: Copy>(
            lamps: &[L],
            mut insert: impl FnMut() -> Result<ShadowSlot, ShadowError>,
        ) -> Result<Vec<PoolLight<L>>, ShadowError> {
            let listed = lamps.iter().map(|light| {
                Ok(PoolLight {
                    slot: insert()?,
                    light: *light,
                    importance: 1.0,
                })
            });
            listed.collect()
        }
        let descriptor = |capacity| PoolDescriptor {
            capacity: capacity as u32,
            map_size: side,
            ..Default::default()
        };
        Ok(match &scene.lamps {
            Lamps::Spots(lamps) => {
                let mut pool = SpotShadowPool::new(&gpu.device, &descriptor(lamps.len()))?;
                let listed = listed(lamps, || pool.insert())?;
                Self::Spots(pool, listed)
            }
            Lamps::Points(lamps) => {
                let mut pool = OmniShadowPool::new(&gpu.device, &descriptor(lamps.len()))?;
                let listed = listed(lamps, || pool.insert())?;
                Self::Points(pool, listed)
            }
        })
    }

    fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        frame: &ShadowFrame<'_>,
    ) -> Result<(), ShadowError> {
        match self {
            Self::Spots(pool, lamps) => pool.record(encoder, frame, lamps, None)?,
            Self::Points(pool, lamps) => pool.record(encoder, frame, lamps, None)?,
        };
        Ok(())
    }

    fn maps(&self) -> &ShadowMaps {
        match self {
            Self::Spots(pool, _) => pool.maps(),
            Self::Points(pool, _) => pool.maps(),
        }
    }
}

fn equal(
    gpu: &Gpu,
    scene: &LampScene,
    frame: &ShadowFrame<'_>,
    pairs: &[Pair],
    map_size: u32,
) -> Result<f64, Box<dyn Error>> {
    let mut seen = vec![1.0; pairs.len()];
    let mut shader = None;
    let mut ask = |lamp: usize, maps: &ShadowMaps| -> Result<(), Box<dyn Error>> {
        let own = pairs.iter().enumerate();
        let own = own.filter(|(_, pair)| pair.lamp as usize == lamp);
        let (places, points): (Vec<_>, Vec<_>) =
            own.map(|(index, pair)| (index, pair.point)).unzip();
        if points.is_empty() {
            return Ok(());
        }
        let bindings = bindings(gpu, maps)?;
        let value = "shadow_lamps(point.position, normalize(point.normal))";
        // The text and the layout are the same for all lamps.
        let shader = shader.get_or_insert_with(|| {
            PointShader::new(gpu, bindings.wgsl(), "f32", value, bindings.layout())
        });
        let answers: Vec<f32> = shader.ask(gpu, bindings.bind_group(), &points);
        for (place, answer) in places.into_iter().zip(answers) {
            seen[place] = answer;
        }
        Ok(())
    };
    match &scene.lamps {
        Lamps::Spots(lamps) => {
            let descriptor = SpotShadowDescriptor {
                map_size,
                ..Default::default()
            };
            for (index, light) in lamps.iter().enumerate() {
                let mut shadow = SpotShadow::new(&gpu.device, &descriptor)?;
                let mut encoder = gpu.encoder();
                shadow.record(&mut encoder, frame, light)?;
                gpu.submit(encoder);
                ask(index, shadow.maps())?;
            }
        }
        Lamps::Points(lamps) => {
            let descriptor = OmniShadowDescriptor {
                map_size,
                ..Default::default()
            };
            for (index, light) in lamps.iter().enumerate() {
                let mut shadow = OmniShadow::new(&gpu.device, &descriptor)?;
                let mut encoder = gpu.encoder();
                shadow.record(&mut encoder, frame, light)?;
                gpu.submit(encoder);
                ask(index, shadow.maps())?;
            }
        }
    }
    Ok(error(pairs, &seen))
}
