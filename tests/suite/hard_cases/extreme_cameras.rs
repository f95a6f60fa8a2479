//! Tests cameras at and beyond the limits of what a camera can be.

use glam::{DVec3, Mat4, Vec3};
use shadow_support::camera::{Camera, Lens, Pose};
use wgpu_shadows::{
    CascadeLayout, CascadeSplit, DirectionalLight, DirectionalShadowDescriptor, ShadowError,
};

use super::stage::{Sun, boxes, level, meshes, scene};
use super::table;
use crate::fixtures::frames::{Coverage, DirectionalFrame, RecordFrame};
use crate::fixtures::gpu::gpu;
use crate::fixtures::report::assert_whole;
use crate::fixtures::view_member::member;

/// Returns every lens with its name, and whether it is a camera that engines have.
fn lenses() -> Vec<(String, Lens, bool)> {
    let mut lenses = Vec::new();
    let ranges = [
        (0.1, f64::INFINITY),
        (0.1, 100.0),
        (5.0, 5.0),
        (1e-6, 1e6),
        (5.0, 5.0001),
    ];
    for fov in [1e-3, 0.1, 1.0, 60.0, 170.0, 179.0, 179.9_f64] {
        for aspect in [1e-3, 0.5, 1.0, 100.0, 1e3] {
            for (near, far) in ranges {
                let top = (fov.to_radians() * 0.5).tan();
                let sides = [-top * aspect, top * aspect, -top, top];
                let usual = (1.0..=170.0).contains(&fov) && (0.5..=1.0).contains(&aspect);
                lenses.push((
                    format!("fov {fov} aspect {aspect} depth {near}..{far}"),
                    Lens::Perspective { sides, near, far },
                    usual && near == 0.1,
                ));
            }
        }
    }
    for half in [1e-6, 1.0, 1e6] {
        for (near, far) in [(-10.0, 100.0), (0.0, 0.0), (1.0, 1.0 + 1e-6), (-1e9, 1e9)] {
            lenses.push((
                format!("orthographic {half} depth {near}..{far}"),
                Lens::Orthographic {
                    sides: [-half, half, -half, half],
                    near,
                    far,
                },
                half == 1.0 && near == -10.0,
            ));
        }
    }
    lenses
}

/// The frame is accepted, and then every uniform is finite and every result a visibility; or the
/// camera is refused, and then the visibilities are as before. Cameras that engines have are
/// accepted.
#[test]
fn any_lens_is_fitted_or_refused() {
    let gpu = gpu();
    let scene = scene(&meshes(&boxes(), 8.0, glam::DMat3::IDENTITY, DVec3::ZERO));
    let mut sun = Sun::new(&DirectionalShadowDescriptor {
        map_size: 64,
        layout: CascadeLayout::Fixed {
            cascades: 3,
            split: CascadeSplit::Practical { lambda: 0.7 },
        },
        ..Default::default()
    });
    let places: Vec<_> = (0..64)
        .map(|index| DVec3::new(f64::from(index % 8) - 4.1, 0.0, f64::from(index / 8) - 3.9))
        .collect();
    let points = level(&places, DVec3::ZERO);
    let eyes = [DVec3::new(3.0, 4.0, 5.0), DVec3::new(0.3, 0.5, 0.2)];
    let (mut taken, mut refused) = (0, 0);
    let mut before = sun.ask(&points);
    for (name, lens, usual) in lenses() {
        for (reversed, eye) in [(false, eyes[0]), (true, eyes[0]), (true, eyes[1])] {
            let camera = Camera {
                pose: Pose::looking_at(eye, DVec3::new(-0.4, 0.1, -0.2)),
                lens,
                reversed,
            };
            let frame = DirectionalFrame {
                origin: DVec3::ZERO,
                light: DirectionalLight::new(Vec3::new(0.3, -1.0, 0.2)),
                coverage: Coverage::Camera(camera.view()),
                casters: &scene.list(),
                receivers: &[],
            };
            let mut encoder = gpu.encoder();
            let result = sun.shadow.record_frame(&mut encoder, &frame);
            let result = result.map(|report| assert_whole(report, &name.to_string()));
            gpu.submit(encoder);
            let seen = sun.ask(&points);
            match result {
                Ok(()) => {
                    taken += 1;
                    for view in sun.shadow.maps().view_uniforms() {
                        let mapping: [f32; 12] = member(view, "mapping");
                        let vectors = ["right", "down", "toward", "anchor"];
                        let vectors = vectors.map(|name| member::<[f32; 3]>(view, name));
                        let mut all = mapping.iter().chain(vectors.iter().flatten());
                        assert!(all.all(|number| number.is_finite()), "{name}: {view:?}");
                    }
                    assert!(seen.iter().all(|seen| (0.0..=1.0).contains(seen)), "{name}");
                }
                Err(error) => {
                    refused += 1;
                    assert!(!usual, "{name} reversed {reversed}: {error}");
                    let known = matches!(
                        error,
                        ShadowError::CameraMatrix { .. } | ShadowError::ViewNotRepresentable { .. }
                    );
                    assert!(known, "{name}: {error:?}");
                    assert_eq!(seen, before, "{name}: a refused frame changes nothing");
                }
            }
            before = seen;
        }
    }
    assert!(
        taken > 100 && refused > 10,
        "{taken} taken, {refused} refused"
    );
    table::record(
        "lenses of 1e-3 to 179.9 degrees, aspects of 1e-3 to 1e3, empty depth ranges",
        "finite uniforms and answers in 0..=1, or a camera's error and nothing changed",
        format!("{taken} taken, {refused} refused, 0 broken"),
    );
}

/// What an engine may pass by mistake is refused by the name of its field.
#[test]
fn what_is_no_camera_is_refused() {
    let gpu = gpu();
    let mut sun = Sun::of_size(16);
    let fine = Camera::modern(DVec3::new(3.0, 4.0, 5.0), DVec3::ZERO, 1.0, 1.0).view();
    let broken = [
        Mat4::ZERO,
        Mat4::NAN,
        Mat4::from_scale(Vec3::new(1.0, 0.0, 1.0)),
        Mat4::from_scale(Vec3::INFINITY),
    ];
    for matrix in broken {
        for view in [false, true] {
            let mut camera = fine;
            let (field, wanted) = if view {
                (&mut camera.view_from_render, "CameraView::view_from_render")
            } else {
                (&mut camera.clip_from_view, "CameraView::clip_from_view")
            };
            *field = matrix;
            let frame = DirectionalFrame {
                origin: DVec3::ZERO,
                light: DirectionalLight::new(Vec3::NEG_Y),
                coverage: Coverage::Camera(camera),
                casters: &[],
                receivers: &[],
            };
            let error = sun
                .shadow
                .record_frame(&mut gpu.encoder(), &frame)
                .expect_err("no camera");
            assert!(
                matches!(error, ShadowError::CameraMatrix { field, .. } if field == wanted),
                "{matrix}: {error:?}"
            );
        }
    }
}
