//! What is measured on: meshes, a light and a camera.

use glam::{DVec3, Vec3};
use wgpu_shadows::{Aabb, CameraView};

use super::mesh::Mesh;

/// A scene. All coordinates but those of local lights are render space: world minus `origin`.
pub struct Scene {
    pub name: &'static str,
    pub meshes: Vec<Mesh>,
    pub light: Light,
    pub camera: CameraView,
    /// World position of render space's origin.
    pub origin: DVec3,
    /// Cascades that the library is given; other lights than suns ignore it.
    pub cascades: u32,
}

/// Angular diameter of the sun: 0.533 degrees.
pub const SUN_DIAMETER_RADIANS: f64 = 0.533 * std::f64::consts::PI / 180.0;

/// The light of a scene.
#[derive(Clone, Copy, Debug)]
pub enum Light {
    Sun {
        /// Direction in which it shines.
        direction: Vec3,
        /// Zero for hard shadows.
        angular_diameter_radians: f64,
    },
    Spot {
        position_world: DVec3,
        direction: Vec3,
        outer_angle_radians: f32,
        range: f32,
        /// Zero for hard shadows.
        radius_world: f32,
    },
    Point {
        position_world: DVec3,
        range: f32,
        /// Zero for hard shadows.
        radius_world: f32,
    },
}

impl Light {
    /// A sun of no extent that shines along `direction`.
    pub const fn sun(direction: Vec3) -> Self {
        Self::Sun {
            direction,
            angular_diameter_radians: 0.0,
        }
    }

    /// Does it have an extent, hence penumbrae?
    pub fn is_soft(&self) -> bool {
        match *self {
            Self::Sun {
                angular_diameter_radians,
                ..
            } => angular_diameter_radians > 0.0,
            Self::Spot { radius_world, .. } | Self::Point { radius_world, .. } => {
                radius_world > 0.0
            }
        }
    }
}

impl Scene {
    pub fn bounds(&self) -> Aabb {
        self.meshes
            .iter()
            .map(Mesh::bounds)
            .fold(Aabb::EMPTY, Aabb::union)
    }

    /// Length of the diagonal of the bounds.
    pub fn diameter(&self) -> f64 {
        let bounds = self.bounds();
        f64::from((bounds.max - bounds.min).length())
    }
}
