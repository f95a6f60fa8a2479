//! Limits how near to a local light a near plane may be, for each caster.
//!
//! Depth is near / w, with w the distance along the view's axis. Its error relative to itself is
//! that of f32 wherever the near plane is. What does depend on the near plane is the rasteriser's
//! interpolation in f32: across a triangle that starts at the near plane it errs by w² / near ·
//! 2⁻²³ at distance w, and receivers are moved toward the light by as much. So a near plane that is
//! too near costs contact far from the light: w / near · 2⁻²⁴ · N texels in a map of N texels a
//! side. A near plane that is too far costs the whole shadow of the casters before it.
//!
//! So the near plane is at the box of the nearest caster, as long as the box tells where the
//! caster's surface is. A box that contains the light does not tell it. A surface that passes the
//! light within rounding, like the ceiling that a lamp hangs on, has no distance that is worth
//! resolving.

use glam::DVec3;

use crate::Aabb;

/// Is the share of the light's reach, and of half the largest side of a caster's box, below which
/// no surface needs to be resolved. With a near plane at this share of the reach, the interpolation
/// errs by 2⁻¹³ of the distance at the end of the reach, which is a sixteenth of a texel in a map
/// of 1024.
const RESOLVED_SHARE: f64 = 1.0 / 1024.0;

/// Is the distance at which the surface of a mesh is expected to begin whose box contains the
/// light, as a share of half the smallest side of the box. It serves the shade of a lamp, and
/// leaves room for lights that are not in its middle.
const ENCLOSING_SHARE: f64 = 1.0 / 16.0;

/// Is the contact, in texels, that may be lost at the end of the reach for the sake of a large mesh
/// whose box contains the light. Nearer to the light the loss shrinks in proportion to the
/// distance. The kernel of a filter costs several texels of contact everywhere.
const CONTACT_TEXELS: f64 = 0.5;

/// Is the least distance of a near plane as a share of the light's reach. With a nearer one the
/// depth at the end of the reach would be below the error of its interpolation.
const LEAST_SHARE: f64 = 1.0 / 16_777_216.0;

/// Returns the world distance from `light` (render space) below which the near plane is not moved
/// for the sake of the caster with these bounds, in a map of `map_size` texels a side. It is at
/// most the share of `reach` that is resolved without any caster.
pub(crate) fn nearest_for(bounds: &Aabb, light: DVec3, reach: f64, map_size: u32) -> f64 {
    let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
    let half = (max - min) * 0.5;
    let resolved = RESOLVED_SHARE * half.max_element();
    let contains_light = min.cmple(light).all() && light.cmple(max).all();
    let nearest = if contains_light {
        // This is where w / near · 2⁻²⁴ · N comes to CONTACT_TEXELS at the end of the reach.
        let affordable = reach * LEAST_SHARE * f64::from(map_size) / CONTACT_TEXELS;
        let expected = ENCLOSING_SHARE * half.min_element();
        expected.max(resolved.min(affordable))
    } else {
        resolved
    };
    nearest.clamp(LEAST_SHARE * reach, RESOLVED_SHARE * reach)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    fn around(half: Vec3) -> Aabb {
        Aabb::new(-half, half)
    }

    /// Checks the near planes of boxes that contain the light: each is well inside of what the box
    /// may be, and large boxes have the share of the reach.
    #[test]
    fn boxes_that_contain_the_light_are_entered() {
        let nearest = |half: Vec3, reach| nearest_for(&around(half), DVec3::ZERO, reach, 1024);
        // The shade of a lamp is entered before the horizon; in a room the share of the reach is
        // nearer than needed.
        assert_eq!(nearest(Vec3::splat(0.125), 1e4), 0.125 / 16.0);
        assert_eq!(nearest(Vec3::splat(0.125), 4.0), 4.0 / 1024.0);
        // Rooms and towns tell nothing of their surfaces.
        assert_eq!(nearest(Vec3::new(4.0, 2.0, 4.0), 8.0), 8.0 / 1024.0);
        assert_eq!(nearest(Vec3::new(500.0, 25.0, 500.0), 64.0), 64.0 / 1024.0);
        // A whole scene on a wide ground is entered as far as its height suggests, or as far as
        // half a texel of contact at the end of the reach allows.
        assert_eq!(nearest(Vec3::new(512.0, 1.0, 512.0), 512.0), 0.0625);
        assert_eq!(nearest(Vec3::new(2048.0, 1.0, 2048.0), 2048.0), 0.25);
        // A sheet in which the light happens to be sets the limit of its size.
        assert_eq!(nearest(Vec3::new(1.0, 0.0, 1.0), 8.0), 1.0 / 1024.0);
        // A point has no size.
        assert_eq!(nearest(Vec3::ZERO, 8.0), 8.0 / 16_777_216.0);
    }

    /// Checks that a box beside the light sets no limit but that of its size.
    #[test]
    fn boxes_beside_the_light_set_their_own_distance() {
        let plate = Aabb::new(Vec3::new(-2.0, 0.25, -2.0), Vec3::new(2.0, 0.5, 2.0));
        assert_eq!(nearest_for(&plate, DVec3::ZERO, 1e3, 1024), 2.0 / 1024.0);
        assert_eq!(nearest_for(&plate, DVec3::ZERO, 1.0, 1024), 1.0 / 1024.0);
    }
}
