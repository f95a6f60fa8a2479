//! Tests `shadow_geometric_normal` by itself.

use glam::{Mat4, Vec3};
use wgpu_shadows::shader;

use crate::fixtures::gpu::gpu;
use crate::fixtures::triangles::{SIZE, VERTEX, draw};

/// Returns stages that show the geometric normal on the side of `eye.place`, from -1 to 1 as 0 to
/// 255.
fn source() -> String {
    let modules = shader::compose(&["normal"]).expect("a module of the table");
    let fragment = "
@fragment
fn fragment(in: Varying) -> @location(0) vec4<f32> {
    return vec4<f32>(shadow_geometric_normal(in.position, eye.place.xyz) * 0.5 + 0.5, 1.0);
}
";
    format!("{modules}{VERTEX}{fragment}")
}

/// Returns the uniform of an image in clip space `clip`, with the vector to the side of the normal.
fn uniform(clip: Mat4, side: Vec3) -> Vec<f32> {
    let side = side.extend(0.0).to_array();
    clip.to_cols_array().into_iter().chain(side).collect()
}

/// With both windings, both handednesses, and vectors of any length to the side, a leaning triangle
/// has its own normal on the given side.
#[test]
fn normals_are_on_the_side_that_is_told() {
    let gpu = gpu();
    let corners = [
        Vec3::new(-2.0, -1.0, -2.0),
        Vec3::new(2.0, -2.0, 0.5),
        Vec3::new(0.3, 3.0, 0.7),
    ];
    let normal = (corners[1] - corners[0])
        .cross(corners[2] - corners[0])
        .normalize();
    let source = source();
    let aslant = normal + 0.9 * normal.any_orthonormal_vector();
    let sides = [1.0, 1e-30, 1e-36, 1e6, 1e30, 3e38].map(|length| aslant.normalize() * length);
    for mirrored in [1.0, -1.0] {
        for turned in [false, true] {
            let mut vertices = corners;
            if turned {
                vertices.swap(1, 2);
            }
            // The steps of a pixel have positions of all sizes: the position is scaled, and clip
            // space with it.
            for scale in [1.0, 1e-6, 1e-30, 1e-34, 1e6, 1e30] {
                let vertices = vertices.map(|corner| corner * scale);
                let clip = Mat4::from_scale(Vec3::new(0.3 * mirrored / scale, 0.3 / scale, 0.0));
                let told = |side: Vec3| {
                    let picture = draw(gpu, &source, &uniform(clip, side), &vertices, None);
                    let [x, y, z, _] = picture.get_pixel(SIZE / 2, SIZE / 2).0;
                    [x, y, z].map(|byte| f32::from(byte) / 127.5 - 1.0)
                };
                let context = format!("mirrored {mirrored}, turned {turned}, scale {scale}");
                let near = |seen: [f32; 3], wanted: Vec3| {
                    // A step of 8 bits is 1/127.5; half of it is rounding, and the error of the
                    // derivatives is far below it.
                    Vec3::from_array(seen).abs_diff_eq(wanted, 0.5 / 127.5 + 1e-3)
                };
                for side in sides {
                    for sign in [1.0, -1.0] {
                        let seen = told(side * sign);
                        assert!(
                            near(seen, normal * sign),
                            "{context}: {seen:?} for the side {}",
                            side * sign
                        );
                    }
                }
                for side in [Vec3::ZERO, Vec3::NAN] {
                    let seen = told(side);
                    assert!(
                        near(seen, normal) || near(seen, -normal),
                        "{context}: {seen:?} for {side}"
                    );
                }
            }
        }
    }
}

/// Far from the origin of render space, positions are rounded, and so are their differences from
/// pixel to pixel: a normal made of them errs by up to 8 u P / f radians, with P the largest
/// coordinate, f the size of a pixel on the surface, and u = 2^-24. (Two rounded positions differ
/// by up to 2 u P each way, on two axes, twice.)
#[test]
fn normals_err_by_the_rounding_of_positions() {
    let gpu = gpu();
    let corners = [
        Vec3::new(-2.0, -2.0, -1.0),
        Vec3::new(2.0, -2.0, 0.2),
        Vec3::new(0.0, 3.0, 0.6),
    ];
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    let normal = normal.normalize();
    let source = source();
    let pixel = 2.0 / 0.3 / f64::from(SIZE);
    let mut worst_share = 0.0_f64;
    for exponent in 0..=5 {
        let away = 3.7 * 10_f32.powi(exponent);
        let place = Vec3::new(away, 0.6 * away, -0.8 * away);
        let vertices = corners.map(|corner| corner + place);
        let clip = Mat4::from_scale(Vec3::new(0.3, 0.3, 0.0)) * Mat4::from_translation(-place);
        let image = draw(gpu, &source, &uniform(clip, Vec3::Z), &vertices, None);
        let mut worst = 0.0_f64;
        for y in SIZE / 4..SIZE * 3 / 4 {
            let [nx, ny, nz, _] = image.get_pixel(SIZE / 2, y).0;
            let [nx, ny, nz] = [nx, ny, nz].map(|byte| f64::from(byte) / 127.5 - 1.0);
            let seen = Vec3::new(nx as f32, ny as f32, nz as f32);
            worst = worst.max(f64::from(seen.angle_between(normal)));
        }
        let bound = 8.0 / f64::from(1 << 24) * f64::from(away) / pixel;
        // A step of 8 bits is 1/127.5 on each of two axes.
        assert!(worst <= bound + 1.5 / 127.5, "{worst} of {bound} at {away}");
        worst_share = worst_share.max((worst - 1.5 / 127.5) / bound);
    }
    assert!(worst_share > 0.05, "the bound says nothing: {worst_share}");
}
