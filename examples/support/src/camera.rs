//! Defines the camera of a scene.

use glam::{Mat4, Vec3};
use shadow_support::camera::perspective;
use wgpu_shadows::CameraView;

/// Is a perspective camera with reversed depth.
pub struct Camera {
    pub eye: Vec3,
    /// Is the camera as the library takes it.
    pub view: CameraView,
}

impl Camera {
    /// Makes a camera from `eye` toward `target`, for images of `width` by `height` pixels.
    pub fn new(
        eye: Vec3,
        target: Vec3,
        field_of_view_radians: f32,
        [width, height]: [u32; 2],
    ) -> Self {
        let aspect = width as f32 / height as f32;
        Self {
            eye,
            view: perspective(eye, target, field_of_view_radians, aspect),
        }
    }

    /// Returns the matrix to clip space from render space.
    pub fn clip_from_render(&self) -> Mat4 {
        self.view.clip_from_view * self.view.view_from_render
    }
}
