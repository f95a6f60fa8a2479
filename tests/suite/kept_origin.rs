//! Tests maps that are kept while the origin of render space moves: their depths carry the rounding
//! of the render coordinates from which they were drawn, and no receiver may shadow itself because
//! of it.

use glam::{DMat3, DVec3, Mat4, Quat, Vec3};
use shadow_support::mesh::Mesh;
use shadow_support::probe::Point;
use shadow_support::random::Random;
use wgpu_shadows::{
    Aabb, CascadeLayout, CasterPipeline, DirectionalLight, DirectionalShadow,
    DirectionalShadowDescriptor, Revision, ShadowCaster, SpotLight, SpotShadow,
    SpotShadowDescriptor, pool::PoolDescriptor, pool::PoolLight, pool::SpotShadowPool,
    report::ShadowReport, report::ViewStatus,
};

use crate::fixtures::ask::{Ask, record_spot, submitted};
use crate::fixtures::frames::{Coverage, DirectionalFrame, PoolFrame, RecordFrame, SpotFrame};
use crate::fixtures::gpu::{Gpu, gpu, vulkan};
use crate::fixtures::probe::{SunProbe, record};
use crate::fixtures::scene::default_pipeline;
use crate::fixtures::watched::Watched;

/// Lists the distances of the wall from the world's origin, where the map is drawn first.
const DISTANCES: [f64; 6] = [20.0, 120.0, 500.0, 1000.0, 5000.0, 20_000.0];

/// Is the least visibility of lit receivers: the results of 3000 of them differ from 1 by the
/// rounding of a sum of 16 weights, sharpened three times.
const LIT: f32 = 1.0 - 192.0 * f32::EPSILON;

/// Describes a wall 10 m wide and high whose sides follow none of the axes, somewhere in the world.
struct Wall {
    center: DVec3,
    world_from_wall: DMat3,
}

impl Wall {
    fn at(distance: f64) -> Self {
        let turn = Quat::from_euler(glam::EulerRot::YXZ, 0.7, 0.15, 0.0);
        Self {
            center: DVec3::new(distance, 3.1, 0.6 * distance),
            world_from_wall: glam::Mat3::from_quat(turn).as_dmat3(),
        }
    }

    /// Returns the unit normal of the front, in world axes.
    fn normal(&self) -> DVec3 {
        self.world_from_wall.z_axis
    }

    /// Returns the wall as an engine draws it whose render space begins at `origin`. Its version
    /// does not change while the origin moves, as `Revision` allows.
    fn caster(&self, gpu: &Gpu, pipeline: &CasterPipeline, origin: DVec3) -> Watched {
        let mut mesh = Mesh::cuboid(Vec3::new(-5.0, -5.0, -0.3), Vec3::new(5.0, 5.0, 0.0));
        for position in &mut mesh.positions {
            let world = self.center + self.world_from_wall * position.as_dvec3();
            *position = (world - origin).as_vec3();
        }
        let caster = mesh.caster(gpu, pipeline, Mat4::IDENTITY);
        Watched::with_revision(caster, Some(Revision::new(1, 0)))
    }

    /// Returns receivers all over the front. All of them are lit, since nothing is in front of it.
    fn receivers(&self, origin: DVec3) -> Vec<Point> {
        let mut random = Random::new(11);
        let mut place = || {
            let on_wall = random.point(DVec3::new(-4.8, -4.8, 0.0), DVec3::new(4.8, 4.8, 0.0));
            let world = self.center + self.world_from_wall * on_wall;
            Point::rounded(world - origin, self.normal())
        };
        (0..3000).map(|_| place()).collect()
    }
}

fn assert_lit(seen: &[f32], what: &str) {
    let dark = seen.iter().filter(|seen| **seen < LIT).count();
    assert_eq!(dark, 0, "of {} lit receivers, {what}", seen.len());
}

/// Returns a low sun that the front of the wall faces. Depths vary so little across a texel that
/// the allowance for rounding is the only part of the bias that keeps the wall from shadowing
/// itself.
fn low_sun(wall: &Wall) -> DirectionalLight {
    DirectionalLight::new(-wall.normal().as_vec3())
}

fn sun_frame<'a>(
    wall: &Wall,
    origin: DVec3,
    casters: &'a [&'a dyn ShadowCaster],
) -> DirectionalFrame<'a> {
    let around = (wall.center - origin).as_vec3();
    DirectionalFrame {
        origin,
        light: low_sun(wall),
        coverage: Coverage::Bounds(Aabb::new(around - 7.5, around + 7.5)),
        casters,
        receivers: &[],
    }
}

#[test]
fn a_sun_kept_while_the_origin_moves_to_its_wall() {
    let gpu = gpu();
    let pipeline = default_pipeline(gpu);
    let mut kept = 0;
    for distance in DISTANCES {
        let wall = Wall::at(distance);
        let mut shadow =
            DirectionalShadow::new(&gpu.device, &DirectionalShadowDescriptor::default())
                .expect("a valid sun");
        let probe = SunProbe::new(gpu, &shadow);
        let far = wall.caster(gpu, &pipeline, DVec3::ZERO);
        record(gpu, &mut shadow, &sun_frame(&wall, DVec3::ZERO, &[&far]));
        let near = wall.caster(gpu, &pipeline, wall.center);
        let report = record(gpu, &mut shadow, &sun_frame(&wall, wall.center, &[&near]));
        let status = report.views[0].status;
        kept += u32::from(status == ViewStatus::Kept);
        let seen = probe.ask(gpu, &wall.receivers(wall.center));
        assert_lit(&seen, &format!("{status:?} after {distance} m"));
    }
    assert!(kept > 0, "a short way costs no drawing");
}

/// Nothing is lost the other way round either: render coordinates that grow make the receivers
/// coarser, not the map.
#[test]
fn a_sun_kept_while_the_origin_moves_away() {
    let gpu = gpu();
    let pipeline = default_pipeline(gpu);
    for distance in DISTANCES {
        let wall = Wall::at(distance);
        let mut shadow =
            DirectionalShadow::new(&gpu.device, &DirectionalShadowDescriptor::default())
                .expect("a valid sun");
        let probe = SunProbe::new(gpu, &shadow);
        let near = wall.caster(gpu, &pipeline, wall.center);
        record(gpu, &mut shadow, &sun_frame(&wall, wall.center, &[&near]));
        let far = wall.caster(gpu, &pipeline, DVec3::ZERO);
        let report = record(gpu, &mut shadow, &sun_frame(&wall, DVec3::ZERO, &[&far]));
        let status = report.views[0].status;
        let seen = probe.ask(gpu, &wall.receivers(DVec3::ZERO));
        assert_lit(&seen, &format!("{status:?} after {distance} m"));
    }
}

/// Returns a spot light that the front of the wall faces.
fn spot(wall: &Wall) -> SpotLight {
    let toward_light = wall.normal() * 25.0;
    SpotLight {
        position_world: wall.center + toward_light,
        direction: -toward_light.as_vec3(),
        outer_angle_radians: 0.35,
        // The range is less than the distance to the farthest corner of the bounds, which are
        // rounded, and so it is the same in every frame.
        range: 27.0,
    }
}

#[test]
fn a_spot_kept_while_the_origin_moves_to_its_wall() {
    let gpu = gpu();
    let pipeline = default_pipeline(gpu);
    for distance in DISTANCES {
        let wall = Wall::at(distance);
        let mut shadow =
            SpotShadow::new(&gpu.device, &SpotShadowDescriptor::default()).expect("a valid spot");
        let ask = Ask::light(gpu, shadow.maps());
        let mut status = ViewStatus::Empty;
        for origin in [DVec3::ZERO, wall.center] {
            let caster = wall.caster(gpu, &pipeline, origin);
            let report = record_spot(
                gpu,
                &mut shadow,
                &SpotFrame {
                    origin,
                    light: spot(&wall),
                    camera: None,
                    casters: &[&caster],
                    receivers: &[],
                },
            );
            status = report.expect("a valid frame").views[0].status;
        }
        let seen = ask.points(gpu, &wall.receivers(wall.center));
        assert_lit(&seen, &format!("{status:?} after {distance} m"));
    }
}

/// The wall is static while an object moves beside it, and is therefore copied rather than drawn.
/// The test runs on Vulkan alone, since wgpu's OpenGL backend copies no depth textures.
#[test]
fn a_wall_copied_while_the_origin_moves() {
    let gpu = vulkan();
    let pipeline = default_pipeline(gpu);
    for distance in DISTANCES {
        let wall = Wall::at(distance);
        let descriptor = DirectionalShadowDescriptor {
            map_size: 512,
            layout: CascadeLayout::fixed(1),
            ..Default::default()
        };
        let mut shadow = DirectionalShadow::new(&gpu.device, &descriptor).expect("a valid sun");
        let probe = SunProbe::new(gpu, &shadow);
        let mut frame = |origin: DVec3, turn: u64| -> ShadowReport {
            let walls: Vec<_> = (0..24)
                .map(|id| Watched {
                    revision: Some(Some(Revision::new(id, 0))),
                    ..wall.caster(gpu, &pipeline, origin)
                })
                .collect();
            // The position is behind the wall, as seen from the light.
            let place = (wall.center - wall.normal() * 2.0 - origin).as_vec3();
            let mover = Mesh::cuboid(place, place + 0.5).caster(gpu, &pipeline, Mat4::IDENTITY);
            let mover = Watched::with_revision(mover, Some(Revision::new(100, turn)));
            let mut casters: Vec<&dyn ShadowCaster> = Vec::new();
            casters.extend(walls.iter().map(|wall| wall as &dyn ShadowCaster));
            casters.push(&mover);
            record(gpu, &mut shadow, &sun_frame(&wall, origin, &casters))
        };
        let copied: u32 = (0..12)
            .map(|turn| frame(DVec3::ZERO, turn).views[0].copied)
            .sum();
        assert!(copied > 0, "what stands still is copied in the end");
        let report = frame(wall.center, 12);
        let seen = probe.ask(gpu, &wall.receivers(wall.center));
        let copied = report.views[0].copied;
        assert_lit(&seen, &format!("{copied} copied after {distance} m"));
    }
}

/// A light that a budget defers shows its old map under the new origin.
#[test]
fn a_spot_put_off_while_the_origin_moves() {
    let gpu = gpu();
    let pipeline = default_pipeline(gpu);
    for distance in DISTANCES {
        let wall = Wall::at(distance);
        let mut pool = SpotShadowPool::new(
            &gpu.device,
            &PoolDescriptor {
                capacity: 2,
                map_size: 2048,
                ..Default::default()
            },
        )
        .expect("a valid pool");
        let slots = [(); 2].map(|()| pool.insert().expect("a free slot"));
        let ask = Ask::slot(gpu, pool.maps(), slots[1].index());
        let mut version = 0;
        let mut frame = |origin: DVec3, max_views: Option<u32>| {
            version += 1;
            let caster = Watched {
                revision: Some(Some(Revision::new(1, version))),
                ..wall.caster(gpu, &pipeline, origin)
            };
            let light = |slot: usize| PoolLight {
                slot: slots[slot],
                light: spot(&wall),
                importance: [1.0, 0.0][slot],
            };
            let frame = PoolFrame {
                origin,
                lights: &[light(0), light(1)],
                camera: None,
                casters: &[&caster],
                receivers: &[],
                max_views,
            };
            submitted(gpu, |encoder| pool.record_frame(encoder, &frame)).expect("a valid frame")
        };
        frame(DVec3::ZERO, None);
        let report = frame(wall.center, Some(1));
        assert_eq!(report.views[1].status, ViewStatus::Deferred);
        let seen = ask.points(gpu, &wall.receivers(wall.center));
        assert_lit(&seen, &format!("put off after {distance} m"));
    }
}
