//! Tests which objects cast and which receive, as their flags say.

use glam::{DVec3, Mat4, Vec3};
use shadow_support::camera::Camera;
use shadow_support::mesh::Mesh;
use wgpu_shadows::{
    Casters, Coverage, DirectionalLight, DirectionalShadow, DirectionalShadowDescriptor,
    ShadowCaster, ShadowFrameDescriptor, ShadowScene, report::ViewStatus,
};

use crate::fixtures::gpu::gpu;
use crate::fixtures::scene::default_pipeline;
use crate::fixtures::watched::Watched;

/// A dome that does not receive costs no texels; a sheet that does not cast is not drawn and still
/// counts as a receiver.
#[test]
fn who_casts_and_who_receives() {
    let gpu = gpu();
    let pipeline = default_pipeline(gpu);
    let slab = Mesh::cuboid(Vec3::new(-0.5, 1.0, -0.5), Vec3::new(0.5, 1.1, 0.5));
    let slab = slab.caster(gpu, &pipeline, Mat4::IDENTITY);
    let floor = Mesh::floor(0.0, 2.0).caster(gpu, &pipeline, Mat4::IDENTITY);
    let dome = Mesh::sphere(Vec3::ZERO, 400.0, 8).caster(gpu, &pipeline, Mat4::IDENTITY);
    let flagged = |mesh, casts, receives| Watched {
        casts,
        receives,
        ..Watched::new(mesh)
    };
    let mut floor = flagged(floor, false, true);
    let mut dome = flagged(dome, false, false);
    let camera = Camera::modern(DVec3::new(0.5, 4.0, 5.0), DVec3::ZERO, 0.8, 1.0).view();
    let mut scene = ShadowScene::new();
    let mut report = |casters: &[&dyn ShadowCaster]| {
        let frame = scene
            .frame(&ShadowFrameDescriptor {
                origin: DVec3::ZERO,
                coverage: Coverage::Cameras(&[camera]),
                casters: Casters::List(casters),
                receivers: &[],
            })
            .expect("a valid frame");
        let descriptor = DirectionalShadowDescriptor::default();
        let mut shadow = DirectionalShadow::new(&gpu.device, &descriptor).expect("a valid sun");
        let mut encoder = gpu.encoder();
        let light = DirectionalLight::new(Vec3::new(0.35, -1.0, 0.2));
        let report = shadow.record(&mut encoder, &frame, &light);
        let view = report.expect("a valid frame").views[0];
        gpu.submit(encoder);
        view
    };
    let alone = report(&[&slab, &floor]);
    assert_eq!((alone.status, alone.casters), (ViewStatus::Drawn, 1));
    assert_eq!(report(&[&slab, &floor, &dome]), {
        let mut with_one_culled = alone;
        with_one_culled.culled += 1;
        with_one_culled
    });
    // With its default flags the dome would take the whole map.
    (dome.casts, dome.receives) = (true, true);
    let coarse = report(&[&slab, &floor, &dome]);
    assert!(coarse.texel_size_world.x > 4.0 * alone.texel_size_world.x);
    // Where nothing receives except the slab itself, nothing needs its shadow.
    floor.receives = false;
    let own = report(&[&slab, &floor]);
    assert!(
        own.depth_range_world < 0.7 * alone.depth_range_world,
        "{own:?} {alone:?}"
    );
}
