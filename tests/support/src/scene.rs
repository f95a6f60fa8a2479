//! Defines what is measured: meshes, a light and a camera.

use glam::{DVec3, Vec3};
use wgpu_shadows::{Aabb, CameraView};

use crate::mesh::Mesh;

/// Is a scene. All coordinates but those of local lights are in render space: world minus `origin`.
pub struct Scene {
    pub name: &'static str,
    pub meshes: Vec<Mesh>,
    pub light: Light,
    pub camera: CameraView,
    /// Is the world position of render space's origin.
    pub origin: DVec3,
}

/// Is the angular diameter of the sun: 0.533 degrees.
pub const SUN_DIAMETER_RADIANS: f64 = 0.533 * std::f64::consts::PI / 180.0;

/// Is the light of a scene.
#[derive(Clone, Copy, Debug)]
pub enum Light {
    Sun {
        /// Is the direction in which it shines.
        direction: Vec3,
        /// Is zero for hard shadows.
        angular_diameter_radians: f64,
    },
    Spot {
        position_world: DVec3,
        direction: Vec3,
        outer_angle_radians: f32,
        range: f32,
        /// Is zero for hard shadows.
        radius_world: f32,
    },
    Point {
        position_world: DVec3,
        range: f32,
        /// Is zero for hard shadows.
        radius_world: f32,
    },
}

impl Light {
    /// Returns a sun without extent that shines along `direction`.
    pub const fn sun(direction: Vec3) -> Self {
        Self::Sun {
            direction,
            angular_diameter_radians: 0.0,
        }
    }

    /// Returns whether it has an extent, hence penumbrae.
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

    /// Returns the length of the diagonal of the bounds.
    pub fn diameter(&self) -> f64 {
        let bounds = self.bounds();
        f64::from((bounds.max - bounds.min).length())
    }
}
