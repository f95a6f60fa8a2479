//! Defines what an engine may say of the surface within a caster's bounds.

use glam::Mat4;

/// States what is known of a caster's surface beyond its bounds.
///
/// A light's map covers every surface on which a shadow may be visible. Bounds alone do not tell
/// whether an object can shadow itself: a hilly terrain does, and a flat slab of the same bounds
/// does not. If an object is known not to shadow itself, the map covers only the part of it that
/// can shadow *other* objects, so a ground slab of any size costs no texels. A shape that promises
/// too much loses shadows that the object casts on itself, outside the part of the map that other
/// objects need.
///
/// [`caster_shape`](crate::caster::caster_shape) finds the shape of a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum CasterShape {
    /// Makes no promise: the bounds may contain any surface. This is always correct.
    #[default]
    Any,
    /// Promises a convex solid or a part of a plane: no point of its surface that faces the light
    /// is shadowed by another point of it. (Points that face away from the light are dark by the
    /// lighting model's `n · l`, whatever their visibility.)
    Convex,
    /// Promises a convex solid that fills its bounds: a cuboid whose sides are parallel to the axes
    /// of render space. Shadows on it are then visible only on the sides of the bounds.
    Cuboid,
}

impl CasterShape {
    /// Returns whether the object may cast a visible shadow on itself.
    pub(crate) const fn shadows_itself(self) -> bool {
        matches!(self, Self::Any)
    }

    /// Returns the shape of the same object under an affine transform: a cuboid remains one where
    /// each axis of the result comes from a single axis, and is a convex solid otherwise.
    pub fn transformed(self, target_from_source: &Mat4) -> Self {
        let axes = [
            target_from_source.x_axis,
            target_from_source.y_axis,
            target_from_source.z_axis,
        ];
        let keeps_axes = axes
            .iter()
            .all(|axis| (0..3).filter(|&row| axis[row] != 0.0).count() == 1);
        match self {
            Self::Cuboid if !keeps_axes => Self::Convex,
            shape => shape,
        }
    }
}
