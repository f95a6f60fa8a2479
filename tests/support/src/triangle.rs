//! Defines triangles in f64, and what rays meet among a few of them.

use glam::DVec3;

/// Is a triangle in render space, in f64.
#[derive(Clone, Copy, Debug)]
pub struct Triangle(pub [DVec3; 3]);

impl Triangle {
    /// Returns the unit normal on the side from which the corners are counter-clockwise; `None`
    /// without an area.
    pub fn try_normal(&self) -> Option<DVec3> {
        let [a, b, c] = self.0;
        (b - a).cross(c - a).try_normalize()
    }

    /// Returns the unit normal of a triangle that has an area.
    pub fn normal(&self) -> DVec3 {
        let [a, b, c] = self.0;
        (b - a).cross(c - a).normalize()
    }

    /// Returns the point with barycentric coordinates made from two numbers in 0..1, evenly spread.
    pub fn point(&self, s: f64, t: f64) -> DVec3 {
        let [a, b, c] = self.0;
        let root = s.sqrt();
        a * (1.0 - root) + b * (root * (1.0 - t)) + c * (root * t)
    }

    /// Returns the distance along a ray at which it hits the triangle, from either side (Möller and
    /// Trumbore 1997).
    pub fn hit(&self, from: DVec3, direction: DVec3) -> Option<f64> {
        let [a, b, c] = self.0;
        let (edge_b, edge_c) = (b - a, c - a);
        let across = direction.cross(edge_c);
        let determinant = edge_b.dot(across);
        if determinant == 0.0 {
            return None;
        }
        let to_start = from - a;
        let s = to_start.dot(across) / determinant;
        let turned = to_start.cross(edge_b);
        let t = direction.dot(turned) / determinant;
        (s >= 0.0 && t >= 0.0 && s + t <= 1.0).then(|| edge_c.dot(turned) / determinant)
    }
}

/// Returns the truth: whether anything lies between `point` and the light, farther than `skip`
/// along the ray.
pub fn occluded(triangles: &[Triangle], point: DVec3, toward_light: DVec3, skip: f64) -> bool {
    triangles
        .iter()
        .any(|triangle| triangle.hit(point, toward_light).is_some_and(|t| t > skip))
}
