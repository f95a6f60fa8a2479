//! Tests that the cameras of the tests are what they say, since the truth about images is found
//! through their rays.

use glam::DVec3;
use shadow_support::camera::{Camera, Lens, Pose};

/// Matrices and rays agree: a point along a ray is projected back to where the ray started, inside
/// the depth range, and its depth changes in the right direction.
#[test]
fn rays_project_to_their_pixels() {
    let pose = Pose::looking_at(DVec3::new(3.0, 5.0, -7.0), DVec3::new(-1.0, 0.5, 2.0));
    let sides = [-0.3, 0.9, -0.5, 0.2];
    let lenses = [
        Lens::Perspective {
            sides,
            near: 0.5,
            far: 50.0,
        },
        Lens::Perspective {
            sides,
            near: 0.5,
            far: f64::INFINITY,
        },
        Lens::Orthographic {
            sides,
            near: -2.0,
            far: 50.0,
        },
    ];
    for lens in lenses {
        for reversed in [false, true] {
            let camera = Camera {
                pose,
                lens,
                reversed,
            };
            let clip_from_render = camera.clip_from_view() * camera.view_from_render();
            for (across, up) in [(0.0, 0.0), (0.25, 0.8), (1.0, 0.5)] {
                let (start, direction) = camera.ray(across, up);
                let (Lens::Perspective { near, far, .. } | Lens::Orthographic { near, far, .. }) =
                    lens;
                let depth = |distance: f64| {
                    let clip = clip_from_render * (start + direction * distance).extend(1.0);
                    let ndc = clip.truncate() / clip.w;
                    assert!((ndc.x - (2.0 * across - 1.0)).abs() < 1e-9);
                    assert!((ndc.y - (2.0 * up - 1.0)).abs() < 1e-9);
                    ndc.z
                };
                let (first, last) = if reversed { (1.0, 0.0) } else { (0.0, 1.0) };
                assert!((depth(near) - first).abs() < 1e-9);
                let inside = across > 0.0 && across < 1.0;
                assert_eq!(camera.sees(start + direction * 3.0, 40.0, 1e-9), inside);
                assert!(!camera.sees(start + direction * 3.0, 2.9, 1e-9));
                assert!(!camera.sees(start + direction * (near - 0.1), 40.0, 1e-9));
                assert!((depth(far.min(1e9)) - last).abs() < 1e-7);
            }
        }
    }
}
