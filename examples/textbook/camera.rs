//! Where the scene is looked at from.

use glam::camera::rh::{proj::directx::perspective_infinite_reverse, view::look_at_mat4};
use glam::{Mat4, Vec3};

/// A place to look from.
#[derive(Clone, Copy)]
pub enum Viewpoint {
    /// Close to the cubes.
    Close,
    /// From afar, with the map's ends in sight.
    Wide,
}

/// A perspective camera with reversed depth.
pub struct Camera {
    pub eye: Vec3,
    pub view_from_render: Mat4,
    pub clip_from_view: Mat4,
}

impl Camera {
    /// For pictures of `width` by `height` pixels.
    pub fn new(viewpoint: Viewpoint, [width, height]: [u32; 2]) -> Self {
        let (eye, target) = match viewpoint {
            Viewpoint::Close => (Vec3::new(5.8, 3.1, -3.8), Vec3::new(0.75, 0.45, 0.75)),
            Viewpoint::Wide => (Vec3::new(2.6, 6.0, -11.5), Vec3::new(1.6, 0.0, 0.6)),
        };
        let field_of_view_radians = 0.55;
        let aspect = width as f32 / height as f32;
        Self {
            eye,
            view_from_render: look_at_mat4(eye, target, Vec3::Y),
            clip_from_view: perspective_infinite_reverse(field_of_view_radians, aspect, 0.1),
        }
    }

    /// Clip space from render space.
    pub fn clip_from_render(&self) -> Mat4 {
        self.clip_from_view * self.view_from_render
    }
}
