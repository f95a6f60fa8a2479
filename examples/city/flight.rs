//! Moves the camera: along a street, then up and over the roofs.

use example_support::camera::Camera;
use glam::Vec3;

/// Returns the camera of frame `index` of `count`, for images of `size` pixels.
pub fn camera(index: u32, count: u32, size: [u32; 2]) -> Camera {
    let share = index as f32 / count.saturating_sub(1).max(1) as f32;
    let climb = smooth_step(0.4, 1.0, share);
    let turn = 0.12 * (share * 9.0).sin() * (1.0 - climb) + 0.6 * climb;
    let dip = 0.02 + 0.36 * climb;
    let eye = Vec3::new(1.5, 2.2 + 85.0 * climb, 330.0 - 330.0 * share);
    let forward = Vec3::new(turn.sin() * dip.cos(), -dip.sin(), -turn.cos() * dip.cos());
    Camera::new(eye, eye + forward, 0.9, size)
}

/// Rises from 0 at `start` to 1 at `end`, level at both ends.
fn smooth_step(start: f32, end: f32, place: f32) -> f32 {
    let share = ((place - start) / (end - start)).clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}
