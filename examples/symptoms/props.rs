//! Holds the objects of the images.

use example_support::mesh::{Instance, Vertex, cube, inside_out, sphere, square};
use example_support::textbook;
use glam::{Mat4, Quat, Vec3};

/// Is an object as it is drawn, and as it casts.
#[derive(Clone)]
pub struct Prop {
    pub mesh: Vec<Vertex>,
    pub instance: Instance,
    pub is_drawn: bool,
    pub casts: bool,
    /// Is how far the caster is from where it is drawn.
    pub caster_offset: Vec3,
}

impl Prop {
    fn new(mesh: Vec<Vertex>, render_from_model: Mat4, albedo: Vec3) -> Self {
        Self::of((
            mesh,
            Instance {
                render_from_model,
                albedo,
                checker: 0.0,
            },
        ))
    }

    fn of((mesh, instance): (Vec<Vertex>, Instance)) -> Self {
        Self {
            mesh,
            instance,
            is_drawn: true,
            casts: true,
            caster_offset: Vec3::ZERO,
        }
    }
}

/// Returns the textbook's floor and cubes, in this order.
pub fn cubes() -> Vec<Prop> {
    textbook::parts().map(Prop::of).into()
}

/// Returns the floor with three balls.
pub fn balls() -> Vec<Prop> {
    let ball = |x, z, radius, albedo: [f32; 3]| {
        let place = Vec3::new(x, radius - 0.5, z);
        let matrix = Mat4::from_translation(place) * Mat4::from_scale(Vec3::splat(radius));
        Prop::new(smooth_ball(), matrix, albedo.into())
    };
    vec![
        cubes().swap_remove(0),
        ball(0.0, 0.0, 0.8, [0.75, 0.30, 0.20]),
        ball(2.2, 0.9, 0.6, [0.35, 0.55, 0.30]),
        ball(-0.8, 2.0, 0.5, [0.25, 0.42, 0.70]),
    ]
}

/// Returns a coarse ball whose normals are those of a smooth one.
fn smooth_ball() -> Vec<Vertex> {
    sphere(7)
}

/// Returns the floor with a fence of thin posts.
pub fn fence() -> Vec<Prop> {
    let mut props = vec![cubes().swap_remove(0)];
    for index in 0..9 {
        let place = Vec3::new(-1.4 + 0.5 * index as f32, 0.1, 0.9);
        let matrix = Mat4::from_translation(place) * Mat4::from_scale(Vec3::new(0.025, 0.6, 0.025));
        props.push(Prop::new(cube(), matrix, Vec3::new(0.45, 0.32, 0.22)));
    }
    props
}

/// Returns the floor with two rows of posts into the distance, under rails.
pub fn avenue() -> Vec<Prop> {
    let mut props = vec![cubes().swap_remove(0)];
    for index in 0..24 {
        let away = (index / 2) as f32;
        let side = if index % 2 == 0 { -1.1 } else { 1.1 };
        let place = Vec3::new(1.5 * away - 8.0, 0.5, side);
        let matrix = Mat4::from_translation(place) * Mat4::from_scale(Vec3::new(0.12, 1.0, 0.12));
        props.push(Prop::new(cube(), matrix, Vec3::new(0.35, 0.45, 0.60)));
    }
    for side in [-1.1, 1.1] {
        let matrix = Mat4::from_translation(Vec3::new(0.25, 1.4, side))
            * Mat4::from_scale(Vec3::new(8.5, 0.1, 0.12));
        props.push(Prop::new(cube(), matrix, Vec3::new(0.35, 0.45, 0.60)));
    }
    props
}

/// Returns the floor and cubes, under a sky dome.
pub fn under_a_dome() -> Vec<Prop> {
    let matrix = Mat4::from_scale(Vec3::splat(40.0));
    let mut dome = Prop::new(inside_out(&sphere(16)), matrix, Vec3::ONE);
    // The clear colour is the sky of the images.
    dome.is_drawn = false;
    let mut props = cubes();
    props.push(dome);
    props
}

/// Returns the floor with two sheets that stand on it, and that show their fronts to the camera and
/// their backs to the light.
pub fn sheets() -> Vec<Prop> {
    let mut props = vec![cubes().swap_remove(0)];
    for (x, z, turn) in [(1.4, -0.2, -0.9), (0.2, 1.4, -0.6)] {
        let matrix = Mat4::from_translation(Vec3::new(x, 0.2, z))
            * Mat4::from_quat(Quat::from_rotation_y(turn))
            * Mat4::from_scale(Vec3::new(0.8, 0.7, 0.8));
        let sheet = square(Vec3::X, 0.0).to_vec();
        props.push(Prop::new(sheet, matrix, Vec3::new(0.62, 0.58, 0.35)));
    }
    props
}

/// Moves objects behind the floor to where they are a frame later.
pub fn a_frame_later(mut props: Vec<Prop>) -> Vec<Prop> {
    for prop in &mut props[1..] {
        prop.caster_offset = Vec3::new(0.35, 0.0, -0.35);
    }
    props
}

/// Leaves the object of this number out of the casters and of the picture; or, where it casts, of
/// the picture alone.
pub fn out_of_view(mut props: Vec<Prop>, index: usize, casts: bool) -> Vec<Prop> {
    props[index].is_drawn = false;
    props[index].casts = casts;
    props
}
