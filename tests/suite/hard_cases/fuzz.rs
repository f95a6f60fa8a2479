//! Passes any numbers to every constructor and every per-frame call: each returns a result or an
//! error, and the device reports no error.
//!
//! Seeds are fixed; `PROPTEST_RNG_SEED` and `PROPTEST_CASES` explore further: the long run is
//! `PROPTEST_CASES=10000 cargo test --test suite hard_cases::fuzz`, which takes some minutes.

use std::cell::RefCell;

use glam::{DVec3, Mat4, Vec3};
use shadow_support::mesh::Mesh;
use shadow_support::probe::Point;
use wgpu_shadows::{
    Aabb, CascadeLayout, CascadeSplit, DepthFormat, DirectionalLight, DirectionalShadow,
    DirectionalShadowDescriptor, OmniLight, OmniShadow, OmniShadowDescriptor, ShadowCaster,
    SpotLight, SpotShadow, SpotShadowDescriptor, Stability, pool::OmniShadowPool,
    pool::PoolDescriptor, pool::PoolLight, pool::ShadowSlot, pool::SpotShadowPool,
};

use proptest::{prop_assert, prop_assert_eq};

use super::fuzz_values::{
    Counts, Numbers, bias, bounds, filter, matrix, number, numbers, run, size,
};
use super::stage::caster;
use crate::fixtures::ask::{Ask, submitted};
use crate::fixtures::frames::{
    Coverage, DirectionalFrame, OmniFrame, PoolFrame, RecordFrame, SpotFrame,
};
use crate::fixtures::gpu::gpu;
use crate::fixtures::report::assert_whole;
use crate::fixtures::watched::Watched;

/// Whatever a descriptor contains, the object is made or an error says why not; no invalid request
/// reaches the device.
#[test]
fn any_descriptor_is_taken_or_refused() {
    let counts = Counts::default();
    let descriptor = (size(), 0..11_u32, filter(), bias(), 0..4, number());
    run(
        300,
        descriptor,
        |(map_size, count, filter, bias, split, lambda)| {
            let device = &gpu().device;
            let cascade_split = split;
            let split = match split {
                0 => CascadeSplit::Uniform,
                1 => CascadeSplit::Logarithmic,
                2 => CascadeSplit::Explicit {
                    ends: &[lambda, 2.0, 3.0],
                },
                _ => CascadeSplit::Practical { lambda },
            };
            let sun = DirectionalShadowDescriptor {
                label: None,
                map_size,
                layout: if cascade_split == 3 {
                    CascadeLayout::Automatic {
                        max_cascades: count,
                    }
                } else {
                    CascadeLayout::Fixed {
                        cascades: count,
                        split,
                    }
                },
                filter,
                bias,
                fade: if cascade_split == 0 { lambda } else { 0.5 },
                blend: lambda,
                stability: Stability::TightFit,
                depth_format: DepthFormat::Unorm16,
            };
            counts.count(&DirectionalShadow::new(device, &sun));
            let spot = SpotShadowDescriptor {
                label: None,
                map_size,
                filter,
                bias,
                fade: if cascade_split == 0 { lambda } else { 0.5 },
            };
            counts.count(&SpotShadow::new(device, &spot));
            let lamp = OmniShadowDescriptor {
                label: None,
                map_size,
                filter,
                bias,
                fade: if cascade_split == 0 { lambda } else { 0.5 },
            };
            counts.count(&OmniShadow::new(device, &lamp));
            let pool = PoolDescriptor {
                label: None,
                capacity: if count == 10 { u32::MAX } else { count },
                map_size,
                filter,
                bias,
                fade: if cascade_split == 0 { lambda } else { 0.5 },
            };
            counts.count(&SpotShadowPool::new(device, &pool));
            counts.count(&OmniShadowPool::new(device, &pool));
            Ok(())
        },
    );
    counts.finish(
        "any numbers in every light's descriptor",
        "an object or an error, no panic, no device error",
    );
}

/// Holds one light of every kind, two kinds of sun among them, and the probes that sample them.
struct Lights {
    suns: [DirectionalShadow; 2],
    spot: SpotShadow,
    lamp: OmniShadow,
    spots: SpotShadowPool,
    lamps: OmniShadowPool,
    slots: [ShadowSlot; 2],
    asks: Vec<Ask>,
}

impl Lights {
    fn new() -> Self {
        let gpu = gpu();
        let device = &gpu.device;
        let map_size = 16;
        let pool = PoolDescriptor {
            map_size: 4 * map_size,
            capacity: 2,
            ..Default::default()
        };
        let sun = DirectionalShadow::new(
            device,
            &DirectionalShadowDescriptor {
                map_size,
                layout: CascadeLayout::fixed(2),
                ..Default::default()
            },
        );
        let round = DirectionalShadow::new(
            device,
            &DirectionalShadowDescriptor {
                map_size,
                layout: CascadeLayout::Fixed {
                    cascades: 3,
                    split: CascadeSplit::Explicit { ends: &[2.0, 10.0] },
                },
                blend: 0.2,
                stability: Stability::BoundingSphere,
                ..Default::default()
            },
        );
        let spot = SpotShadow::new(
            device,
            &SpotShadowDescriptor {
                map_size,
                ..Default::default()
            },
        );
        let lamp = OmniShadow::new(
            device,
            &OmniShadowDescriptor {
                map_size,
                ..Default::default()
            },
        );
        let suns = [sun, round].map(|sun| sun.expect("sun"));
        let (spot, lamp) = (spot.expect("spot"), lamp.expect("lamp"));
        let mut spots = SpotShadowPool::new(device, &pool).expect("a pool");
        let mut lamps = OmniShadowPool::new(device, &pool).expect("a pool");
        let slots = [spots.insert().expect("free"), lamps.insert().expect("free")];
        let asks = vec![
            Ask::light(gpu, suns[0].maps()),
            Ask::light(gpu, spot.maps()),
            Ask::light(gpu, lamp.maps()),
            Ask::slot(gpu, spots.maps(), slots[0].index()),
            Ask::slot(gpu, lamps.maps(), slots[1].index()),
            Ask::light(gpu, suns[1].maps()),
        ];
        Self {
            suns,
            spot,
            lamp,
            spots,
            lamps,
            slots,
            asks,
        }
    }

    /// Records the frame of light `kind`.
    fn record(
        &mut self,
        kind: usize,
        numbers: &Numbers,
        casters: &[&dyn ShadowCaster],
    ) -> Result<(), String> {
        let gpu = gpu();
        let origin = numbers.origin.as_dvec3();
        let receivers = [numbers.receiver];
        let camera = numbers.camera;
        let spot = SpotLight {
            position_world: numbers.place.as_dvec3(),
            direction: numbers.direction,
            outer_angle_radians: numbers.angle,
            range: numbers.range,
        };
        let lamp = OmniLight {
            position_world: numbers.place.as_dvec3(),
            range: numbers.range,
        };
        let result = match kind {
            0 | 5 => {
                let light = DirectionalLight {
                    direction: numbers.direction,
                    up: numbers.up,
                };
                let coverage = camera.map_or(Coverage::Bounds(numbers.cover), Coverage::Camera);
                let frame = DirectionalFrame {
                    origin,
                    light,
                    coverage,
                    casters,
                    receivers: &receivers,
                };
                let sun = &mut self.suns[usize::from(kind == 5)];
                submitted(gpu, |encoder| sun.record_frame(encoder, &frame))
            }
            1 => {
                let frame = SpotFrame {
                    origin,
                    light: spot,
                    camera,
                    casters,
                    receivers: &receivers,
                };
                submitted(gpu, |encoder| self.spot.record_frame(encoder, &frame))
            }
            2 => {
                let frame = OmniFrame {
                    origin,
                    light: lamp,
                    camera,
                    casters,
                    receivers: &receivers,
                };
                submitted(gpu, |encoder| self.lamp.record_frame(encoder, &frame))
            }
            3 => {
                let lights = [PoolLight {
                    slot: self.slots[0],
                    light: spot,
                    importance: numbers.importance,
                }];
                let frame = pool_frame(numbers, origin, &lights, casters, &receivers);
                submitted(gpu, |encoder| self.spots.record_frame(encoder, &frame))
            }
            _ => {
                let lights = [PoolLight {
                    slot: self.slots[1],
                    light: lamp,
                    importance: numbers.importance,
                }];
                let frame = pool_frame(numbers, origin, &lights, casters, &receivers);
                submitted(gpu, |encoder| self.lamps.record_frame(encoder, &frame))
            }
        };
        result
            .map(|report| assert_whole(&report, &format!("kind {kind}")))
            .map_err(|error| error.to_string())
    }

    fn ask(&self, kind: usize, points: &[Point]) -> Vec<f32> {
        self.asks[kind].points(gpu(), points)
    }
}

fn pool_frame<'a, L>(
    numbers: &Numbers,
    origin: DVec3,
    lights: &'a [PoolLight<L>],
    casters: &'a [&'a dyn ShadowCaster],
    receivers: &'a [Aabb],
) -> PoolFrame<'a, L> {
    PoolFrame {
        origin,
        lights,
        camera: numbers.camera,
        casters,
        receivers,
        max_views: numbers.max_views,
    }
}

/// Whatever a frame contains, it is accepted or refused; every result is a visibility, for invalid
/// receivers as well; and a refused frame leaves all visibilities as they were.
#[test]
fn any_frame_is_taken_or_refused() {
    let lights = RefCell::new(Lights::new());
    let counts = Counts::default();
    let mesh = Mesh::cuboid(Vec3::new(-1.0, 1.0, -1.0), Vec3::new(1.0, 1.2, 1.0));
    let fixed: Vec<_> = (0..32_u8)
        .map(|index| {
            let (x, z) = (f32::from(index % 8) - 3.7, f32::from(index / 8) - 1.6);
            Point::new(Vec3::new(x, 0.1 * z, z), Vec3::Y)
        })
        .collect();
    run(250, numbers(), |numbers| {
        let mut lights = lights.borrow_mut();
        let slab = caster(gpu(), &mesh, Mat4::IDENTITY);
        let slab = Watched::with_bounds(slab, numbers.bounds);
        let broken: Vec<_> = numbers
            .points
            .iter()
            .map(|(position, normal)| Point::new(*position, *normal))
            .collect();
        for kind in 0..6 {
            let before = lights.ask(kind, &fixed);
            let result = lights.record(kind, &numbers, &[&slab]);
            counts.count(&result);
            let after = lights.ask(kind, &fixed);
            if let Err(error) = &result {
                prop_assert_eq!(&before, &after, "kind {}: {}", kind, error);
            }
            let mut all = after;
            all.extend(lights.ask(kind, &broken));
            let sound = all.iter().all(|seen| (0.0..=1.0).contains(seen));
            prop_assert!(sound, "kind {}: {:?} after {:?}", kind, all, result);
        }
        Ok(())
    });
    counts.finish(
        "any numbers in every light's frame",
        "answers in 0..=1 or an error that changes nothing, no panic, no device error",
    );
}

/// A mesh accepts any matrix and any bounds, or refuses them; a refused transform leaves it where
/// it was.
#[test]
fn any_mesh_is_taken_or_refused() {
    let counts = Counts::default();
    let mesh = Mesh::cuboid(Vec3::NEG_ONE, Vec3::ONE);
    let fine = RefCell::new(caster(gpu(), &mesh, Mat4::IDENTITY));
    let lights = RefCell::new(Lights::new());
    let cover = Aabb::new(Vec3::splat(-3.0), Vec3::splat(3.0));
    let quiet = Numbers {
        origin: Vec3::ZERO,
        place: Vec3::ZERO,
        direction: Vec3::NEG_Y,
        up: Vec3::Y,
        range: 1.0,
        angle: 0.5,
        bounds: cover,
        receiver: cover,
        cover,
        camera: None,
        importance: 1.0,
        max_views: None,
        points: Vec::new(),
    };
    let point = [Point::new(Vec3::new(0.1, -1.5, 0.2), Vec3::Y)];
    run(200, (matrix(), bounds()), |(matrix, bounds)| {
        let mut fine = fine.borrow_mut();
        let held = fine.render_from_model();
        let result = fine.set_transform(matrix);
        counts.count(&result);
        if result.is_err() {
            prop_assert_eq!(fine.render_from_model(), held);
        }
        let held = fine.bounds();
        let result = fine.geometry_changed(bounds);
        counts.count(&result);
        if result.is_err() {
            prop_assert_eq!(fine.bounds(), held);
        }
        prop_assert!(fine.bounds().is_empty() || fine.bounds().is_finite());
        let mut lights = lights.borrow_mut();
        counts.count(&lights.record(0, &quiet, &[&*fine]));
        let seen = lights.ask(0, &point)[0];
        prop_assert!((0.0..=1.0).contains(&seen), "{}", seen);
        Ok(())
    });
    counts.finish(
        "any numbers in a mesh's matrix and bounds",
        "drawn or refused, no panic, no device error",
    );
}
