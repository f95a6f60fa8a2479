//! Tests local lights at origins and positions of any finite magnitude: a frame is correct or is
//! refused, as [`far_origins`](super::far_origins) has it for suns.

use glam::{DVec3, Vec3};
use wgpu_shadows::{
    OmniLight, OmniShadow, OmniShadowDescriptor, ShadowError, SpotLight, SpotShadow,
    SpotShadowDescriptor,
};

use crate::fixtures::ask::{Ask, record_omni, record_spot};
use crate::fixtures::frames::{OmniFrame, SpotFrame};
use crate::fixtures::gpu::gpu;
use crate::fixtures::report::assert_whole;
use crate::fixtures::scene::Scene;
use crate::suite::far_origins::{assert_finite, assert_right, meshes, origins, points, settled};

/// Lights are three units above the floor, as exactly as the spacing of their f64 position allows;
/// others are as far away as their origin.
#[test]
fn lamps_of_any_origin_are_right_or_refused() {
    let gpu = gpu();
    let meshes = meshes(1.0);
    let scene = Scene::new(gpu, &meshes);
    let casters = scene.list();
    let omni = OmniShadowDescriptor {
        map_size: 256,
        ..Default::default()
    };
    let mut omni = OmniShadow::new(&gpu.device, &omni).expect("a valid lamp");
    let spot = SpotShadowDescriptor {
        map_size: 256,
        ..Default::default()
    };
    let mut spot = SpotShadow::new(&gpu.device, &spot).expect("a valid lamp");
    let asks = [omni.maps(), spot.maps()].map(|source| Ask::light(gpu, source));
    let mut right = 0;
    for place in origins() {
        for (origin, position_world) in [(place, place + DVec3::Y * 3.0), (DVec3::ZERO, place)] {
            let light = position_world - origin;
            omni.invalidate();
            omni.reset_history();
            spot.invalidate();
            spot.reset_history();
            let omni_frame = OmniFrame {
                origin,
                light: OmniLight {
                    position_world,
                    range: f32::INFINITY,
                },
                camera: None,
                casters: &casters,
                receivers: &[],
            };
            let spot_frame = SpotFrame {
                origin,
                light: SpotLight {
                    position_world,
                    direction: Vec3::NEG_Y,
                    outer_angle_radians: 1.1,
                    range: f32::INFINITY,
                },
                camera: None,
                casters: &casters,
                receivers: &[],
            };
            let records = [
                record_omni(gpu, &mut omni, &omni_frame),
                record_spot(gpu, &mut spot, &spot_frame),
            ];
            for (index, record) in records.into_iter().enumerate() {
                let what = format!("lamp {index} at {position_world}, origin {origin}");
                let report = match record {
                    Ok(report) => report,
                    Err(ShadowError::ViewNotRepresentable { .. }) => {
                        assert!(light.length() > 1e17, "{what} is refused");
                        continue;
                    }
                    Err(error) => panic!("{what}: {error}"),
                };
                assert_whole(&report, &what);
                if index == 0 {
                    assert_finite(omni.maps().views(), omni.maps().view_uniforms(), &what);
                } else {
                    assert_finite(spot.maps().views(), spot.maps().view_uniforms(), &what);
                }
                // The test compares where the light is above the slab and the slab's shadow leaves
                // some of the floor lit.
                if light.distance(DVec3::Y * 3.0) > 0.5 {
                    continue;
                }
                let views = report.views.iter();
                let texel = views
                    .map(|view| f64::from(view.texel_size_world.max_element()))
                    .fold(0.0, f64::max);
                let wanted = settled(&scene.triangles, 1.0, 3.0 * texel, |from| light - from);
                assert_right(&wanted, &asks[index].points(gpu, &points(&wanted)), &what);
                right += 1;
            }
        }
    }
    assert!(right > 100, "{right}");
}
