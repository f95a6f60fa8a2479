//! Defines the camera of a scene.

use glam::camera::rh::{proj::directx::perspective_infinite_reverse, view::look_at_mat4};
use glam::{Mat4, Vec3};
use wgpu_shadows::CameraView;

/// Is a perspective camera with reversed depth.
pub struct Camera {
    pub eye: Vec3,
    pub view_from_render: Mat4,
    pub clip_from_view: Mat4,
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
            view_from_render: look_at_mat4(eye, target, Vec3::Y),
            clip_from_view: perspective_infinite_reverse(field_of_view_radians, aspect, 0.1),
        }
    }

    /// Returns the matrix to clip space from render space.
    pub fn clip_from_render(&self) -> Mat4 {
        self.clip_from_view * self.view_from_render
    }

    /// Returns the camera as the library takes it.
    pub fn for_shadows(&self) -> CameraView {
        CameraView::new(self.view_from_render, self.clip_from_view)
    }
}
