//! What is measured on: meshes, a light and a camera.

use glam::camera::rh::{proj::directx::perspective_infinite_reverse, view::look_at_mat4};
use glam::{DVec3, Mat4, Vec3};
use wgpu_shadows::{Aabb, CameraView};

use super::mesh::Mesh;

/// A generated scene. All coordinates but those of local lights are render space: world minus `origin`.
pub struct Scene {
    pub name: &'static str,
    pub meshes: Vec<Mesh>,
    pub light: Light,
    pub camera: Camera,
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
    },
    Point {
        position_world: DVec3,
        range: f32,
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

    pub fn is_soft(&self) -> bool {
        matches!(self, Self::Sun { angular_diameter_radians, .. } if *angular_diameter_radians > 0.0)
    }
}

/// Where a scene is looked at from.
#[derive(Clone, Copy, Debug)]
pub struct Camera {
    pub eye: Vec3,
    pub target: Vec3,
    pub fov_y_radians: f32,
}

impl Camera {
    pub const fn new(eye: Vec3, target: Vec3) -> Self {
        Self {
            eye,
            target,
            fov_y_radians: 0.9,
        }
    }

    /// The matrices that an engine would use: right-handed, reversed depth without a far plane.
    pub fn view(&self, aspect: f32) -> CameraView {
        CameraView::new(
            self.view_from_render(),
            perspective_infinite_reverse(self.fov_y_radians, aspect, 0.1),
        )
    }

    fn view_from_render(&self) -> Mat4 {
        look_at_mat4(self.eye, self.target, Vec3::Y)
    }

    /// Directions of the rays through the centres of the pixels, row by row from the top.
    pub fn pixel_rays(&self, [width, height]: [u32; 2]) -> impl Iterator<Item = DVec3> {
        let forward = (self.target - self.eye).as_dvec3().normalize();
        let right = forward.cross(DVec3::Y).normalize();
        let up = right.cross(forward);
        let top = (f64::from(self.fov_y_radians) * 0.5).tan();
        let side = top * f64::from(width) / f64::from(height);
        (0..width * height).map(move |index| {
            let x = (f64::from(index % width) + 0.5) / f64::from(width);
            let y = (f64::from(index / width) + 0.5) / f64::from(height);
            (forward + right * side * (2.0 * x - 1.0) + up * top * (1.0 - 2.0 * y)).normalize()
        })
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
