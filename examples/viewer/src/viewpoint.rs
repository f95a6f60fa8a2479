//! Moves the camera: around what it looks at, or by flying.

use example_support::camera::Camera;
use glam::{Vec2, Vec3};
use shadow_support::camera::perspective;

/// Is where the camera stands and what it looks at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewpoint {
    /// Is in render space.
    pub eye: Vec3,
    /// Is the angle from -Z toward +X, in radians.
    pub yaw: f32,
    /// Is the angle above the horizon, in radians.
    pub pitch: f32,
    /// Is the distance to what an orbit turns around, in world units.
    pub distance: f32,
    pub field_of_view_radians: f32,
}

/// Is the largest pitch: short of upright, where the view would have no side that is up.
const STEEPEST: f32 = 1.55;

impl Viewpoint {
    pub fn new(eye: Vec3, target: Vec3, field_of_view_radians: f32) -> Self {
        let way = target - eye;
        let forward = way.normalize_or(Vec3::NEG_Z);
        Self {
            eye,
            yaw: forward.x.atan2(-forward.z),
            pitch: forward.y.clamp(-1.0, 1.0).asin().clamp(-STEEPEST, STEEPEST),
            distance: way.length().max(1e-3),
            field_of_view_radians,
        }
    }

    /// Returns the unit vector along the view.
    pub fn forward(&self) -> Vec3 {
        let (up, across) = self.pitch.sin_cos();
        let (x, z) = self.yaw.sin_cos();
        Vec3::new(x * across, up, -z * across)
    }

    fn right(&self) -> Vec3 {
        Vec3::new(self.yaw.cos(), 0.0, self.yaw.sin())
    }

    fn target(&self) -> Vec3 {
        self.eye + self.forward() * self.distance
    }

    /// Turns the camera on the spot, by parts of the picture's height.
    pub fn look(&mut self, drag: Vec2) {
        self.turn(drag, self.field_of_view_radians);
    }

    /// Turns the camera around its target, by parts of the picture's height.
    pub fn orbit(&mut self, drag: Vec2) {
        let target = self.target();
        self.turn(-drag, 3.0);
        self.eye = target - self.forward() * self.distance;
    }

    fn turn(&mut self, drag: Vec2, radians: f32) {
        self.yaw = (self.yaw - drag.x * radians) % std::f32::consts::TAU;
        self.pitch = (self.pitch + drag.y * radians).clamp(-STEEPEST, STEEPEST);
    }

    /// Moves the camera across the view, by parts of the picture's height.
    pub fn pan(&mut self, drag: Vec2) {
        let up = self.right().cross(self.forward());
        let scale = 2.0 * self.distance * (self.field_of_view_radians * 0.5).tan();
        self.eye += (up * drag.y - self.right() * drag.x) * scale;
    }

    /// Changes the distance to the target by a factor.
    pub fn zoom(&mut self, factor: f32) {
        let target = self.target();
        self.distance = (self.distance * factor).clamp(1e-3, 1e6);
        self.eye = target - self.forward() * self.distance;
    }

    /// Flies by `way` (right, up, forward) times the distance to the target.
    pub fn fly(&mut self, way: Vec3) {
        let scale = self.distance;
        self.eye += (self.right() * way.x + Vec3::Y * way.y + self.forward() * way.z) * scale;
    }

    /// Returns the camera for a picture of `size` pixels, whose shadows end at `max_distance`.
    pub fn camera(&self, size: [u32; 2], max_distance: f32) -> Camera {
        let aspect = size[0].max(1) as f32 / size[1].max(1) as f32;
        let target = self.eye + self.forward();
        let mut view = perspective(self.eye, target, self.field_of_view_radians, aspect);
        if max_distance > 0.0 {
            view.max_distance = max_distance;
        }
        Camera {
            eye: self.eye,
            view,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_orbit_keeps_the_target() {
        let mut viewpoint =
            Viewpoint::new(Vec3::new(3.0, 2.0, 1.0), Vec3::new(0.5, 0.0, -1.0), 0.7);
        let target = viewpoint.target();
        viewpoint.orbit(Vec2::new(0.3, -0.2));
        viewpoint.zoom(1.7);
        // A few roundings at coordinates below 16.
        assert!(viewpoint.target().distance(target) < 32.0 * f32::EPSILON * 16.0);
    }
}
