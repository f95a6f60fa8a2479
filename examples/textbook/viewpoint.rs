//! Defines the cameras.

use example_support::camera::Camera;
use example_support::textbook;
use glam::Vec3;

/// Selects a camera.
#[derive(Clone, Copy)]
pub enum Viewpoint {
    /// Is close to the cubes.
    Close,
    /// Is far away, with the map's ends in sight.
    Wide,
}

impl Viewpoint {
    /// Returns the camera for images of `size` pixels.
    pub fn camera(self, size: [u32; 2]) -> Camera {
        let (eye, target) = match self {
            Self::Close => (textbook::EYE, textbook::TARGET),
            Self::Wide => (Vec3::new(2.6, 6.0, -11.5), Vec3::new(1.6, 0.0, 0.6)),
        };
        Camera::new(eye, target, textbook::FIELD_OF_VIEW_RADIANS, size)
    }
}
