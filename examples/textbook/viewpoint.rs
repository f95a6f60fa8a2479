//! Where the scene is looked at from.

use glam::Vec3;

use crate::common::camera::Camera;

/// A place to look from.
#[derive(Clone, Copy)]
pub enum Viewpoint {
    /// Close to the cubes.
    Close,
    /// From afar, with the map's ends in sight.
    Wide,
}

impl Viewpoint {
    /// For pictures of `size` pixels.
    pub fn camera(self, size: [u32; 2]) -> Camera {
        let (eye, target) = match self {
            Self::Close => (Vec3::new(5.8, 3.1, -3.8), Vec3::new(0.75, 0.45, 0.75)),
            Self::Wide => (Vec3::new(2.6, 6.0, -11.5), Vec3::new(1.6, 0.0, 0.6)),
        };
        Camera::new(eye, target, 0.55, size)
    }
}
