//! Tests pools: slots cannot be confused, lights give the visibilities that they would give alone,
//! and static ones cost nothing.

use glam::{DVec3, Mat4, Vec3};
use shadow_support::mesh::Mesh;
use shadow_support::probe::Point;
use shadow_support::random::Random;
use wgpu_shadows::shader::MODULES;
use wgpu_shadows::{
    Aabb, OmniLight, OmniShadow, OmniShadowDescriptor, ShadowBindings, ShadowBindingsDescriptor,
    ShadowCaster, ShadowError, ShadowViewUniform, SpotLight, SpotShadow, SpotShadowDescriptor,
    pool::OmniShadowPool, pool::PoolDescriptor, pool::PoolLight, pool::ShadowSlot,
    pool::SpotShadowPool, report::ShadowReport, report::ViewStatus,
};

use crate::fixtures::ask::{Ask, record_omni, record_spot, submitted};
use crate::fixtures::frames::{OmniFrame, PoolFrame, RecordFrame, SpotFrame};
use crate::fixtures::gpu::{Gpu, gpu};
use crate::fixtures::scene::{Scene, default_pipeline};
use crate::fixtures::watched::Watched;
use crate::fixtures::wgsl;

const EVERYWHERE: [Aabb; 1] = [Aabb::new(Vec3::splat(-30.0), Vec3::splat(30.0))];

pub(super) fn pool(capacity: u32, map_size: u32) -> Result<OmniShadowPool, ShadowError> {
    let descriptor = PoolDescriptor {
        capacity,
        map_size,
        ..Default::default()
    };
    OmniShadowPool::new(&gpu().device, &descriptor)
}

pub(super) fn lamp(slot: ShadowSlot, place: DVec3, importance: f32) -> PoolLight<OmniLight> {
    PoolLight {
        slot,
        light: OmniLight {
            position_world: place,
            range: 20.0,
        },
        importance,
    }
}

pub(super) fn frame<'a, L>(
    lights: &'a [PoolLight<L>],
    casters: &'a [&'a dyn ShadowCaster],
) -> PoolFrame<'a, L> {
    PoolFrame {
        origin: DVec3::ZERO,
        lights,
        camera: None,
        casters,
        receivers: &EVERYWHERE,
        max_views: None,
    }
}

pub(super) fn record(
    gpu: &Gpu,
    pool: &mut OmniShadowPool,
    frame: &PoolFrame<'_, OmniLight>,
) -> Result<ShadowReport, ShadowError> {
    submitted(gpu, |encoder| pool.record_frame(encoder, frame))
}

#[test]
fn slots_are_given_out_once() {
    let gpu = gpu();
    let mut pool = pool(3, 8).expect("a valid pool");
    let slots = [(); 3].map(|()| pool.insert().expect("a free slot"));
    let mut indices = slots.map(|slot| slot.index());
    indices.sort_unstable();
    assert_eq!(indices, [0, 1, 2]);
    assert_eq!(pool.insert(), Err(ShadowError::PoolFull { capacity: 3 }));
    pool.remove(slots[1]).expect("a slot in use");
    let unknown = |field| ShadowError::UnknownSlot { field, index: 1 };
    assert_eq!(pool.remove(slots[1]), Err(unknown("slot")));
    let next = pool.insert().expect("the slot that came back");
    assert_eq!(next.index(), 1);
    // The light that had the slot before does not have it any longer, though the index is in use.
    assert_eq!(pool.remove(slots[1]), Err(unknown("slot")));
    let field = "PoolLight::slot";
    let refused = |pool: &mut OmniShadowPool, lights: &[PoolLight<OmniLight>]| {
        record(gpu, pool, &frame(lights, &[])).expect_err("a bad slot")
    };
    let stale = [lamp(slots[1], DVec3::ZERO, 1.0)];
    assert_eq!(refused(&mut pool, &stale), unknown(field));
    let twice = [lamp(next, DVec3::ZERO, 1.0), lamp(next, DVec3::X, 1.0)];
    let duplicate = ShadowError::DuplicateSlot { field, index: 1 };
    assert_eq!(refused(&mut pool, &twice), duplicate);
    let mut other = self::pool(3, 8).expect("a valid pool");
    other.insert().expect("a free slot");
    let foreign = [lamp(other.insert().expect("a free slot"), DVec3::ZERO, 1.0)];
    assert_eq!(refused(&mut pool, &foreign), unknown(field));
    for importance in [-1.0, f32::NAN, f32::INFINITY] {
        let wanted = ShadowError::OutOfRange {
            field: "PoolLight::importance",
            rule: "finite and at least 0",
            value: importance.to_string(),
        };
        let light = [lamp(next, DVec3::ZERO, importance)];
        assert_eq!(refused(&mut pool, &light), wanted);
    }
    record(gpu, &mut pool, &frame(&[lamp(next, DVec3::ZERO, 0.0)], &[])).expect("a good slot");
}

#[test]
fn capacities_that_no_device_has() {
    let bytes = gpu().device.limits().max_uniform_buffer_binding_size;
    let most = (bytes / (6 * ShadowViewUniform::SIZE_BYTES)) as u32;
    pool(most, 64).expect("as many as the uniforms allow");
    assert!(matches!(
        pool(most + 1, 64),
        Err(ShadowError::OverDeviceLimit {
            field: "PoolDescriptor::capacity",
            limit: "max_uniform_buffer_binding_size",
            maximum,
            value,
        }) if maximum == bytes && value > maximum
    ));
    // Eleven lights have 66 faces, which need eight rows and a ninth: sixteen by a power of two.
    for (capacity, least) in [(1, 4), (2, 4), (3, 8), (10, 8), (11, 16)] {
        pool(capacity, least).expect("a texel for each face");
        assert!(matches!(
            pool(capacity, least - 1),
            Err(ShadowError::OutOfRange {
                field: "PoolDescriptor::map_size",
                ..
            })
        ));
    }
    assert!(matches!(
        pool(0, 8),
        Err(ShadowError::OutOfRange {
            field: "PoolDescriptor::capacity",
            ..
        })
    ));
}

fn solids(gpu: &Gpu) -> Scene {
    Scene::new(
        gpu,
        &[
            Mesh::floor(0.0, 10.0),
            Mesh::cuboid(Vec3::new(-1.0, 0.0, -1.0), Vec3::new(0.5, 2.0, 0.3)),
            Mesh::sphere(Vec3::new(2.0, 1.2, 1.0), 0.8, 8),
        ],
    )
}

fn points_on(scene: &Scene, count: usize) -> Vec<Point> {
    let mut random = Random::new(71);
    (0..count)
        .map(|index| {
            // Half of the points lie on the floor, which is the first two triangles.
            let among = if index % 2 == 0 {
                2
            } else {
                scene.triangles.len()
            };
            let triangle = scene.triangles[random.index(among)];
            let place = triangle.point(random.unit(), random.unit());
            Point::rounded(place, triangle.normal())
        })
        .collect()
}

pub(super) fn bits(values: &[f32]) -> Vec<u32> {
    values.iter().map(|value| value.to_bits()).collect()
}

/// Checks that visibilities are those of the same map somewhere else in a layer of `map_size`
/// texels a side. A position of a lookup then has the rounding `2uN` of the sum and of the product
/// that make it, and the default filter turns a texel into at most four times its length of
/// visibility. A vertex is rounded to 1/256 of a texel in other directions, which moves an edge by
/// twice that; that is seen only where one passes.
pub(super) fn assert_same_map(seen: &[f32], wanted: &[f32], map_size: u32) {
    let rounding = 4.0 * 2.0 * f32::EPSILON * map_size as f32;
    let differences = seen
        .iter()
        .zip(wanted)
        .map(|(seen, wanted)| (seen - wanted).abs());
    let differences: Vec<f32> = differences.collect();
    let largest = differences.iter().copied().fold(0.0, f32::max);
    let moved = differences
        .iter()
        .filter(|difference| **difference > rounding)
        .count();
    assert!(
        moved * 200 <= seen.len(),
        "{moved} of {} differ, by {largest}",
        seen.len()
    );
}

const PLACES: [DVec3; 3] = [
    DVec3::new(0.3, 3.0, 2.0),
    DVec3::new(-3.0, 1.5, -2.0),
    DVec3::new(3.5, 4.0, -1.0),
];

/// Each light of a pool has the visibilities of the same light alone, to the bit; slots that no
/// light has, and indices that no slot has, are lit.
#[test]
fn lamps_see_what_they_see_alone() {
    let gpu = gpu();
    let scene = solids(gpu);
    let list = scene.list();
    let mut pool = pool(5, 800).expect("a valid pool");
    // The first slot stays without a light, so that an index and a position in the list differ.
    let unlisted = pool.insert().expect("a free slot");
    let lights = PLACES.map(|place| lamp(pool.insert().expect("a free slot"), place, 1.0));
    let report = record(gpu, &mut pool, &frame(&lights, &list)).expect("a valid frame");
    let drawn = report.views.iter().map(|view| view.texels.size.x);
    let sizes: Vec<u32> = drawn.filter(|size| *size > 0).collect();
    let map_size = sizes[0];
    assert!(sizes.iter().all(|size| *size == map_size), "{sizes:?}");
    // More than four faces have room in four by four squares, or in eight by eight.
    assert_eq!(map_size, if sizes.len() > 16 { 100 } else { 200 });
    let points = points_on(&scene, 3000);
    for light in lights {
        let descriptor = OmniShadowDescriptor {
            map_size,
            ..Default::default()
        };
        let mut alone = OmniShadow::new(&gpu.device, &descriptor).expect("a valid lamp");
        let frame = OmniFrame {
            origin: DVec3::ZERO,
            light: light.light,
            camera: None,
            casters: &list,
            receivers: &EVERYWHERE,
        };
        record_omni(gpu, &mut alone, &frame).expect("a valid frame");
        let wanted = Ask::light(gpu, alone.maps()).points(gpu, &points);
        let dark = wanted.iter().filter(|seen| **seen < 0.5).count();
        assert!(dark > 200 && dark < 2800, "{dark}");
        let seen = Ask::slot(gpu, pool.maps(), light.slot.index()).points(gpu, &points);
        assert_same_map(&seen, &wanted, 800);
    }
    for index in [unlisted.index(), 4, 5, 1000, u32::MAX] {
        let seen = Ask::slot(gpu, pool.maps(), index).points(gpu, &points);
        assert!(seen.iter().all(|seen| *seen == 1.0), "slot {index}");
    }
}

#[test]
fn spots_see_what_they_see_alone() {
    let gpu = gpu();
    let scene = solids(gpu);
    let list = scene.list();
    let descriptor = PoolDescriptor {
        capacity: 4,
        map_size: 200,
        ..Default::default()
    };
    let mut pool = SpotShadowPool::new(&gpu.device, &descriptor).expect("a valid pool");
    let lights = PLACES.map(|place| PoolLight {
        slot: pool.insert().expect("a free slot"),
        light: SpotLight {
            position_world: place,
            direction: (DVec3::Y * 0.5 - place).as_vec3(),
            outer_angle_radians: 0.6,
            range: 20.0,
        },
        importance: 1.0,
    });
    let pool_frame = frame(&lights, &list);
    submitted(gpu, |encoder| pool.record_frame(encoder, &pool_frame)).expect("a valid frame");
    let points = points_on(&scene, 3000);
    for light in lights {
        let descriptor = SpotShadowDescriptor {
            map_size: 100,
            ..Default::default()
        };
        let mut alone = SpotShadow::new(&gpu.device, &descriptor).expect("a valid spot");
        let frame = SpotFrame {
            origin: DVec3::ZERO,
            light: light.light,
            camera: None,
            casters: &list,
            receivers: &EVERYWHERE,
        };
        record_spot(gpu, &mut alone, &frame).expect("a valid frame");
        let wanted = Ask::light(gpu, alone.maps()).points(gpu, &points);
        assert!(wanted.iter().filter(|seen| **seen < 0.5).count() > 100);
        let seen = Ask::slot(gpu, pool.maps(), light.slot.index()).points(gpu, &points);
        assert_same_map(&seen, &wanted, 200);
    }
}

/// Sixty-four point lights in two pools shine on a static scene: from the second frame on nothing
/// is drawn and no caster's `draw` is called.
#[test]
fn still_lamps_cost_nothing() {
    let gpu = gpu();
    let pipeline = default_pipeline(gpu);
    let meshes: Vec<_> = (0..16)
        .map(|index| {
            let low = Vec3::new((index % 4) as f32 * 3.0, 0.0, (index / 4) as f32 * 3.0);
            Mesh::cuboid(low, low + 1.0).caster(gpu, &pipeline, Mat4::IDENTITY)
        })
        .map(Watched::new)
        .collect();
    let casters: Vec<&dyn ShadowCaster> = meshes.iter().map(|mesh| mesh as _).collect();
    let mut random = Random::new(73);
    let mut pools: Vec<_> = (0..2)
        .map(|_| {
            let mut pool = pool(32, 256).expect("a valid pool");
            let lights: Vec<_> = (0..32)
                .map(|_| random.point(DVec3::new(0.0, 1.5, 0.0), DVec3::new(11.0, 4.0, 11.0)))
                .map(|place| lamp(pool.insert().expect("a free slot"), place, 1.0))
                .collect();
            (pool, lights)
        })
        .collect();
    for step in 0..4 {
        for mesh in &meshes {
            mesh.draws.set(0);
        }
        for (pool, lights) in &mut pools {
            let report = record(gpu, pool, &frame(lights, &casters)).expect("a valid frame");
            // All views of a pool are drawn in one pass.
            assert_eq!(report.passes, u32::from(step == 0), "frame {step}");
            let drawn = report.views.iter();
            let drawn = drawn.filter(|view| view.status == ViewStatus::Drawn);
            let (drawn, draws) = (drawn.count(), report.draws());
            assert_eq!(draws > 0, step == 0, "frame {step}: {draws} draws");
            assert!(step > 0 || drawn >= 32, "frame {step}: {drawn} views");
        }
        let asked: u32 = meshes.iter().map(|mesh| mesh.draws.get()).sum();
        assert_eq!(asked > 0, step == 0, "frame {step}: {asked} draws");
    }
}

/// The text for a sun and 32 point lights is that for a sun and two, except for the numbers.
#[test]
fn the_wgsl_does_not_grow_with_the_lights() {
    let gpu = gpu();
    let sun = wgpu_shadows::DirectionalShadow::new(&gpu.device, &Default::default());
    let sun = sun.expect("a valid sun");
    let texts = [2, 32].map(|capacity| {
        let lamps = pool(capacity, 16).expect("a valid pool");
        let descriptor = ShadowBindingsDescriptor {
            lights: &[("sun", sun.maps()), ("lamps", lamps.maps())],
            ..Default::default()
        };
        let bindings = ShadowBindings::new(&gpu.device, &descriptor).expect("valid bindings");
        let module = wgsl::validate(bindings.wgsl()).expect("valid WGSL");
        let letters: String = bindings
            .wgsl()
            .chars()
            .filter(|c| !c.is_ascii_digit())
            .collect();
        (module.functions.len(), letters, bindings.wgsl().to_owned())
    });
    let [few, text] = [&texts[0].2, &texts[1].2];
    assert_eq!(texts[0].0, texts[1].0);
    assert_eq!(texts[0].1, texts[1].1);
    // The numbers of views, 12 and 192, and the last index, 1 and 31, differ by a digit wherever
    // they occur. Each of the four functions of the pool reads what all views have in common at
    // some places.
    assert!(
        text.len() - few.len() <= 24,
        "{} bytes more",
        text.len() - few.len()
    );
    // Beside the modules, the text holds the bindings and some eight functions of each light, with
    // their comments.
    let modules = MODULES.iter().map(|module| module.source);
    let modules = modules.filter(|source| text.contains(source)).map(str::len);
    let own = text.len() - modules.sum::<usize>();
    assert!(own < 8_000, "{own} bytes");
}
