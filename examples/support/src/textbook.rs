//! Defines the scene of the tutorial at learnopengl.com: a floor of 50 by 50, three cubes, and a
//! sun that shines from (-2, 4, -1) to the origin.

use glam::{Mat4, Quat, Vec3};

use crate::mesh::{Instance, Vertex, cube, square};

/// Points toward the sun; its length is not one.
pub const TOWARD_SUN: Vec3 = Vec3::new(-2.0, 4.0, -1.0);

/// Is where the camera stands, close to the cubes, and what it looks at.
pub const EYE: Vec3 = Vec3::new(5.8, 3.1, -3.8);
pub const TARGET: Vec3 = Vec3::new(0.75, 0.45, 0.75);
pub const FIELD_OF_VIEW_RADIANS: f32 = 0.55;

/// Is the tutorial's bias of 0.005 and 0.05, which is there in units of a depth range of 6.5.
pub const BIAS_CONSTANT: f32 = 0.005 * 6.5;
pub const BIAS_SLOPE: f32 = 0.05 * 6.5;

/// Returns the floor, and the three cubes.
pub fn parts() -> [(Vec<Vertex>, Instance); 4] {
    let floor = Instance {
        render_from_model: Mat4::from_translation(Vec3::new(0.0, -0.5, 0.0))
            * Mat4::from_scale(Vec3::splat(25.0)),
        albedo: Vec3::new(0.58, 0.50, 0.40),
        checker: 0.12,
    };
    let cube = |center, half, rotation, albedo| {
        let scale = Vec3::splat(half);
        let instance = Instance {
            render_from_model: Mat4::from_scale_rotation_translation(scale, rotation, center),
            albedo,
            checker: 0.0,
        };
        (cube(), instance)
    };
    let (red, green, blue) = (
        Vec3::new(0.75, 0.30, 0.20),
        Vec3::new(0.35, 0.55, 0.30),
        Vec3::new(0.25, 0.42, 0.70),
    );
    let upright = Quat::IDENTITY;
    let diagonal = Vec3::new(1.0, 0.0, 1.0).normalize();
    let tilted = Quat::from_axis_angle(diagonal, 60_f32.to_radians());
    [
        (square(Vec3::Y, 0.0).to_vec(), floor),
        cube(Vec3::new(0.0, 1.5, 0.0), 0.5, upright, red),
        cube(Vec3::new(2.0, 0.0, 1.0), 0.5, upright, green),
        cube(Vec3::new(-1.0, 0.0, 2.0), 0.25, tilted, blue),
    ]
}
