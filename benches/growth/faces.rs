//! Compares a pass for each of a point light's six faces with one pass for all, where the device
//! draws several views at once.

use std::time::Instant;

use glam::{DVec3, Mat4, Vec3};
use shadow_support::gpu::Gpu;
use shadow_support::measure::statistics::Spread;
use shadow_support::mesh::Mesh;
use shadow_support::random::Random;
use wgpu_shadows::{
    Aabb, CasterPipeline, Casters, Coverage, MeshCaster, OmniLight, OmniShadow,
    OmniShadowDescriptor, Revision, ShadowCaster, ShadowFrameDescriptor, ShadowScene, ShadowView,
    caster::CasterPipelineDescriptor, caster::MeshCasterDescriptor, caster::MeshIndices,
    report::ShadowReport,
};

use super::stage::Stage;

/// Is the number of texels per side: few, since filling them costs the same both ways.
const MAP_SIZE: u32 = 32;

/// Prints both ways for few and many casters, with few triangles and with many. The casters lie in
/// two and three faces, or in all of them, so that none is culled.
pub fn in_one_pass(stage: &Stage<'_>) {
    println!(
        "\npoint light: one pass for all faces beside a pass each (ratio of the times of frame, record, submission and \
         completion; triangles of one pass for each draw call saved)"
    );
    println!(
        "{:>8}{:>8}{:>11}{:>8}{:>16}{:>14}{:>18}{:>8}{:>18}{:>12}",
        "casters",
        "faces",
        "triangles",
        "passes",
        "draws",
        "through faces",
        "each saved draw",
        "ratio",
        "middle half",
        "rule takes"
    );
    for count in [1, 12, 50, 200] {
        for touched in [2, 3, 6] {
            for rings in [2, 3, 5, 9] {
                if !row(stage, count, touched, rings) {
                    println!("this device draws a pass each");
                    return;
                }
            }
        }
    }
}

/// Is what one pass for all faces takes beside a pass each.
pub struct Comparison {
    /// Is the time of one pass divided by that of a pass each.
    pub ratio: Spread,
    pub rule_takes_one_pass: bool,
    /// Is the number of triangles of each caster.
    triangles: u32,
    /// Are the reports of one pass, and of a pass each.
    reports: [ShadowReport; 2],
}

/// Compares both ways for `count` casters, each of which lies in as many faces as `touched` says.
/// Returns `None` where the device does not draw six views at once.
pub fn compare(stage: &Stage<'_>, count: u32, touched: u32, rings: u32) -> Option<Comparison> {
    let gpu = stage.gpu;
    let mut lamp = |telling| Lamp::new(gpu, count, touched, rings, telling);
    let [mut told, mut one, mut six] =
        [Telling::Truth, Telling::OneTriangle, Telling::Nothing].map(&mut lamp);
    // The first run of each warms up.
    for lamp in [&mut told, &mut one, &mut six] {
        lamp.seconds(gpu);
    }
    let reports = [one.report().clone(), six.report().clone()];
    if reports[0].passes != 1 || reports[1].passes == 1 {
        return None;
    }
    Some(Comparison {
        ratio: Spread::of((0..stage.repeats).map(|_| one.seconds(gpu) / six.seconds(gpu))),
        rule_takes_one_pass: told.report().passes == 1,
        triangles: told.things[0].triangles,
        reports,
    })
}

/// Prints a row, and returns false where the device does not draw six views at once.
fn row(stage: &Stage<'_>, count: u32, touched: u32, rings: u32) -> bool {
    let Some(compared) = compare(stage, count, touched, rings) else {
        return false;
    };
    let Comparison {
        ratio, triangles, ..
    } = compared;
    let [one, six] = &compared.reports;
    let through_faces = 6 * triangles * one.draws();
    println!(
        "{count:>8}{touched:>8}{triangles:>11}{:>8}{:>16}{through_faces:>14}{:>18.0}{:>8.3}{:>18}{:>12}",
        format!("{} to {}", six.passes, one.passes),
        format!("{} to {}", six.draws(), one.draws()),
        f64::from(through_faces) / f64::from(six.draws() - one.draws()),
        ratio.median,
        format!("{:.3} to {:.3}", ratio.lower_quartile, ratio.upper_quartile),
        if compared.rule_takes_one_pass {
            "one pass"
        } else {
            "each"
        }
    );
    true
}

/// Selects how many triangles the casters report, by which the library chooses.
#[derive(Clone, Copy)]
enum Telling {
    Truth,
    /// Reports so few that one pass is cheaper.
    OneTriangle,
    /// Reports nothing, which leads to a pass for each face.
    Nothing,
}

/// Holds a point light and the objects around it.
struct Lamp {
    scene: ShadowScene,
    shadow: OmniShadow,
    things: Vec<Thing>,
}

struct Thing {
    mesh: MeshCaster,
    triangles: u32,
    telling: Telling,
}

impl Lamp {
    fn new(gpu: &Gpu, count: u32, touched: u32, rings: u32, telling: Telling) -> Self {
        let descriptor = CasterPipelineDescriptor::new();
        let pipeline = CasterPipeline::new(&gpu.device, &descriptor).expect("a valid pipeline");
        let mut random = Random::new(17);
        let things = (0..count).map(|_| {
            let mut distance = || random.between(4.0, 9.0);
            let places: Vec<Vec3> = match touched {
                2 => vec![Vec3::new(1.0, 1.0, 0.0) * distance()],
                3 => vec![Vec3::splat(distance())],
                _ => [Vec3::X, Vec3::Y, Vec3::Z]
                    .into_iter()
                    .flat_map(|axis| [axis * distance(), axis * -distance()])
                    .collect(),
            };
            let mesh = places.iter().fold(Mesh::default(), |mesh, place| {
                mesh.joined(Mesh::sphere(*place, 0.1, rings))
            });
            Thing::new(gpu, &pipeline, &mesh, telling)
        });
        let descriptor = OmniShadowDescriptor {
            map_size: MAP_SIZE,
            ..Default::default()
        };
        Self {
            scene: ShadowScene::new(),
            shadow: OmniShadow::new(&gpu.device, &descriptor).expect("a valid light"),
            things: things.collect(),
        }
    }

    /// Returns the time of a frame with every face drawn, from its first command to its end.
    fn seconds(&mut self, gpu: &Gpu) -> f64 {
        let list: Vec<&dyn ShadowCaster> = self
            .things
            .iter()
            .map(|thing| thing as &dyn ShadowCaster)
            .collect();
        let start = Instant::now();
        let mut encoder = gpu.encoder();
        self.shadow.invalidate();
        let frame = self.scene.frame(&ShadowFrameDescriptor {
            origin: DVec3::ZERO,
            coverage: Coverage::Everything,
            casters: Casters::List(&list),
            receivers: &[Aabb::new(Vec3::splat(-15.0), Vec3::splat(15.0))],
        });
        let frame = frame.expect("a valid frame");
        let light = OmniLight {
            position_world: DVec3::ZERO,
            range: 30.0,
        };
        let recorded = self.shadow.record(&mut encoder, &frame, &light);
        recorded.expect("a valid light");
        gpu.submit(encoder);
        start.elapsed().as_secs_f64()
    }

    fn report(&self) -> &ShadowReport {
        self.shadow.maps().report()
    }
}

impl Thing {
    fn new(gpu: &Gpu, pipeline: &CasterPipeline, mesh: &Mesh, telling: Telling) -> Self {
        let count = mesh.indices.len() as u32;
        let descriptor = MeshCasterDescriptor {
            label: None,
            pipeline,
            vertices: &gpu.buffer(&mesh.positions, wgpu::BufferUsages::VERTEX),
            indices: MeshIndices::Buffer {
                buffer: gpu.buffer(&mesh.indices, wgpu::BufferUsages::INDEX),
                format: wgpu::IndexFormat::Uint32,
                indices: 0..count,
                base_vertex: 0,
            },
            bounds_model: mesh.bounds(),
            render_from_model: Mat4::IDENTITY,
        };
        Self {
            mesh: MeshCaster::new(&gpu.device, &descriptor).expect("a valid mesh"),
            triangles: count / 3,
            telling,
        }
    }
}

impl ShadowCaster for Thing {
    fn bounds(&self) -> Aabb {
        self.mesh.bounds()
    }

    fn pipeline(&self) -> &CasterPipeline {
        self.mesh.pipeline()
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, view: &ShadowView) {
        self.mesh.draw(pass, view);
    }

    fn keeps_pass_state(&self) -> bool {
        true
    }

    fn same_in_every_view(&self) -> bool {
        true
    }

    fn triangles(&self) -> u32 {
        match self.telling {
            Telling::Truth => self.triangles,
            Telling::OneTriangle => 1,
            Telling::Nothing => 0,
        }
    }

    fn revision(&self) -> Option<Revision> {
        self.mesh.revision()
    }
}
