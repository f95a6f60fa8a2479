//! Counts what is drawn for a camera that walks through a crowd.

use glam::{DVec3, Vec3};
use shadow_support::camera::Camera;
use shadow_support::random::Random;
use wgpu_shadows::{
    Aabb, CascadeLayout, CasterPipeline, CasterSet, Casters, Coverage, DirectionalLight,
    DirectionalShadow, DirectionalShadowDescriptor, Revision, ShadowFrameDescriptor, ShadowScene,
    caster::CasterPipelineDescriptor, caster::CasterShape, report::ViewStatus,
};

use crate::fixtures::body::Body;
use crate::fixtures::gpu::gpu;

/// Returns a crowd of boxes, with four square metres of ground each.
fn crowd() -> CasterSet<Body> {
    let pipeline = CasterPipeline::new(&gpu().device, &CasterPipelineDescriptor::new());
    let pipeline = pipeline.expect("a valid pipeline");
    let mut random = Random::new(31);
    let mut set = CasterSet::new();
    set.insert_all((0..8_000).map(|id| {
        let mut between = |low, high| random.between(low, high);
        let foot = Vec3::new(between(-90.0, 90.0), 0.0, between(-90.0, 90.0));
        let size = Vec3::new(between(0.3, 1.0), between(0.3, 3.0), between(0.3, 1.0));
        Body {
            pipeline: pipeline.clone(),
            bounds: Aabb::new(foot, foot + size),
            casts: true,
            receives: true,
            shape: CasterShape::Any,
            triangles: 12,
            revision: Revision::new(id, 0),
        }
    }));
    set
}

/// Checks that a camera that walks by 0.1 m a frame does not have its maps drawn anew for every
/// caster that it leaves behind. Where each of them is left out at once, more than a third of the
/// casters in the views are drawn in each frame (86 765 of 245 581 in all). Held, maps are drawn
/// where their windows move, or where more comes into view; a fifth leaves room for both.
/// Where the camera stands still, what it left behind is dropped, once.
#[test]
fn casters_that_a_camera_leaves_behind_are_kept_in_the_maps() {
    let set = crowd();
    let mut shadow = DirectionalShadow::new(
        &gpu().device,
        &DirectionalShadowDescriptor {
            map_size: 1024,
            layout: CascadeLayout::fixed(4),
            ..Default::default()
        },
    )
    .expect("a valid sun");
    let mut scene = ShadowScene::new();
    let mut encoder = gpu().encoder();
    let (mut in_views, mut drawn, mut drawn_standing) = (0, 0, 0);
    for frame in 0..460_u32 {
        // The camera stands still for longer than the maps hold what they need no more.
        let walked = 0.1 * f64::from(frame.min(200));
        let eye = DVec3::new(walked - 10.0, 2.0, 0.0);
        let camera = Camera::modern(eye, eye + DVec3::new(9.0, -1.0, 5.0), 0.9, 1.5).view();
        let frame_of_scene = scene.frame(&ShadowFrameDescriptor {
            origin: DVec3::ZERO,
            coverage: Coverage::Cameras(&[camera.with_max_distance(60.0)]),
            casters: Casters::Set(&set),
            receivers: &[],
        });
        let frame_of_scene = frame_of_scene.expect("a valid frame");
        let light = DirectionalLight::new(Vec3::new(-0.5, -1.0, -0.3));
        let report = shadow.record(&mut encoder, &frame_of_scene, &light);
        for view in &report.expect("a valid light").views {
            let is_drawn = view.status == ViewStatus::Drawn;
            match frame {
                0..20 => {}
                20..=200 => {
                    in_views += view.casters;
                    drawn += if is_drawn {
                        view.casters - view.copied
                    } else {
                        0
                    };
                }
                _ => drawn_standing += u32::from(is_drawn),
            }
        }
    }
    gpu().submit(encoder);
    assert!(in_views > 100_000, "{in_views}");
    assert!(drawn * 5 < in_views, "{drawn} of {in_views}");
    assert!(drawn_standing <= 8, "{drawn_standing}");
}
