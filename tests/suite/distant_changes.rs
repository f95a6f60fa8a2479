//! Compares lights that keep their fit where no change reaches them with lights that fit every
//! frame anew: views, uniforms and reports are the same over thousands of random changes, most of
//! them out of reach. The test runs on Vulkan alone: what is compared is found on the CPU.

use glam::{DVec3, Vec3};
use shadow_support::camera::Camera;
use shadow_support::random::Random;
use wgpu_shadows::{
    Aabb, CasterId, CasterPipeline, CasterSet, Casters, Coverage, Revision, ShadowFrameDescriptor,
    ShadowScene, caster::CasterPipelineDescriptor, caster::CasterShape, report::ViewStatus,
};

use crate::fixtures::any_light::AnyLight;
use crate::fixtures::body::Body;
use crate::fixtures::gpu::vulkan;

/// Holds bodies, most of them far from all lights and cameras.
struct Field {
    pipeline: CasterPipeline,
    set: CasterSet<Body>,
    ids: Vec<CasterId>,
    random: Random,
    made: u64,
}

impl Field {
    /// Returns the bounds of a body: within reach of the lights with the probability `near`, and
    /// once in a while as large as the field.
    fn bounds(&mut self, near: f64) -> Aabb {
        let random = &mut self.random;
        let half = if random.unit() < near { 9.0 } else { 90.0 };
        let low = random.point(DVec3::new(-half, 0.0, -half), DVec3::new(half, 2.0, half));
        let size = match random.index(60) {
            0 => DVec3::new(120.0, 0.1, 120.0),
            1 => DVec3::new(0.1, 40.0, 90.0),
            _ => random.point(DVec3::splat(0.2), DVec3::splat(2.0)),
        };
        Aabb::new(low.as_vec3(), (low + size).as_vec3())
    }

    fn revision(&mut self) -> Revision {
        self.made += 1;
        Revision::new(self.made, 0)
    }

    fn insert(&mut self, near: f64) {
        let (bounds, revision) = (self.bounds(near), self.revision());
        let role = self.random.index(6);
        self.ids.push(self.set.insert(Body {
            pipeline: self.pipeline.clone(),
            bounds,
            casts: role != 0,
            receives: role != 1,
            shape: [CasterShape::Any, CasterShape::Convex, CasterShape::Cuboid]
                [self.random.index(3)],
            triangles: 12,
            revision,
        }));
    }

    /// Changes bodies, within reach of the lights with the probability `near`.
    fn step(&mut self, near: f64) {
        for _ in 0..self.random.index(4) {
            let id = self.ids[self.random.index(self.ids.len())];
            let bounds = self.set.get(id).expect("a body").bounds;
            let place = (bounds.min + bounds.max) * 0.5;
            if place.length() < 30.0 && self.random.unit() >= near {
                continue;
            }
            let way = self
                .random
                .point(DVec3::splat(-1.0), DVec3::splat(1.0))
                .as_vec3();
            let (other, revision) = (self.bounds(near), self.revision());
            let kind = self.random.index(12);
            let changed = self.set.update(id, |body| match kind {
                0 => body.bounds = other,
                1 => body.casts = !body.casts,
                2 => body.receives = !body.receives,
                3 => body.shape = CasterShape::Cuboid,
                4 => body.triangles = 14,
                5 => body.revision = revision,
                6 => body.bounds = Aabb::EMPTY,
                _ => body.bounds = Aabb::new(bounds.min + way, bounds.max + way),
            });
            changed.expect("a known body");
        }
        match self.random.index(40) {
            0 if self.ids.len() > 150 => {
                let index = self.random.index(self.ids.len());
                let bounds = self.set.get(self.ids[index]).expect("a body").bounds;
                if ((bounds.min + bounds.max) * 0.5).length() > 30.0 || near > 0.1 {
                    let id = self.ids.swap_remove(index);
                    self.set.remove(id).expect("a known body");
                }
            }
            1 if self.ids.len() < 200 => self.insert(near),
            _ => {}
        }
    }
}

/// Checks it with cameras, a covered box and everything covered. Changes within reach come in
/// bursts, between which extents have the time to shrink.
#[test]
fn what_no_change_reaches_stays_as_if_fitted_anew() {
    let gpu = vulkan();
    let pipeline = CasterPipeline::new(&gpu.device, &CasterPipelineDescriptor::new());
    let mut field = Field {
        pipeline: pipeline.expect("a valid pipeline"),
        set: CasterSet::new(),
        ids: Vec::new(),
        random: Random::new(23),
        made: 0,
    };
    (0..170).for_each(|_| field.insert(0.2));
    let (mut keeping, mut anew) = (AnyLight::all(gpu), AnyLight::all(gpu));
    let mut scene = ShadowScene::new();
    let mut random = Random::new(5);
    let mut eye = DVec3::new(0.0, 5.0, 12.0);
    let (mut place, mut kind, mut drawn) = (DVec3::new(0.3, 4.0, -0.4), 0, 0);
    let mut encoder = gpu.encoder();
    for frame in 0..3000 {
        let near = if frame % 300 < 60 { 0.5 } else { 0.004 };
        field.step(near);
        if frame % 300 == 0 {
            eye = random.point(DVec3::new(-9.0, 2.0, 9.0), DVec3::new(9.0, 9.0, 15.0));
            place = random.point(DVec3::new(-6.0, 0.5, -6.0), DVec3::new(6.0, 5.0, 6.0));
            kind = frame / 300 % 5;
        }
        let camera = |max_distance| {
            let view = Camera::modern(eye, DVec3::ZERO, 1.0, 1.5).view();
            view.with_max_distance(max_distance)
        };
        let cameras = [camera(30.0), camera(25.0)];
        let receivers = [Aabb::new(Vec3::splat(-2.0), Vec3::new(2.0, -2.0, 2.0))];
        let descriptor = ShadowFrameDescriptor {
            origin: DVec3::ZERO,
            coverage: match kind {
                0 | 1 => Coverage::Cameras(&cameras[..1]),
                2 => Coverage::Cameras(&cameras),
                3 => Coverage::Bounds(Aabb::new(Vec3::splat(-6.0), Vec3::splat(6.0))),
                _ => Coverage::Everything,
            },
            casters: Casters::Set(&field.set),
            receivers: &receivers,
        };
        let frame_of_scene = scene.frame(&descriptor).expect("a valid frame");
        // A scene knows of no frame but its own, so that lights take this one for a new one.
        let mut other_scene = ShadowScene::new();
        let other_frame = other_scene.frame(&descriptor).expect("a valid frame");
        let direction = Vec3::new(0.4, -1.0, 0.3);
        for (index, (light, other)) in keeping.iter_mut().zip(&mut anew).enumerate() {
            let what = format!("frame {frame}, light {index}");
            let report = light.record(&mut encoder, &frame_of_scene, place, direction);
            let other_report = other.record(&mut encoder, &other_frame, place, direction);
            assert_eq!(report, other_report, "{what}");
            let (views, other_views) = (light.maps().views(), other.maps().views());
            assert_eq!(
                views.collect::<Vec<_>>(),
                other_views.collect::<Vec<_>>(),
                "{what}"
            );
            let uniforms = bytemuck::cast_slice::<_, u8>(light.maps().view_uniforms());
            let other_uniforms = bytemuck::cast_slice::<_, u8>(other.maps().view_uniforms());
            assert!(uniforms == other_uniforms, "{what}");
            let views = report.views.iter();
            drawn += views
                .filter(|view| view.status == ViewStatus::Drawn)
                .count();
        }
        if frame % 50 == 0 {
            gpu.submit(std::mem::replace(&mut encoder, gpu.encoder()));
        }
    }
    gpu.submit(encoder);
    assert!(drawn > 1000, "{drawn}");
}
