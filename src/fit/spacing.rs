//! Determines how finely f64 distinguishes positions in absolute light space, and when that is too
//! coarse for a map.
//!
//! A map rectangle consists of whole texels of a grid that is fixed in the world, so its position
//! is an absolute coordinate. Far from the world's origin f64 itself has coarse steps: 2⁻⁵² of a
//! coordinate, 16 units at 10¹⁷. Casters and receivers go through one matrix whose linear part is
//! exact, so these steps never move a shadow against what casts it; they move the map rectangle
//! against both.

use glam::{DVec2, DVec3, UVec2};

use crate::ShadowError;
use crate::fit::LightBox;

/// Is the number of f64 steps by which a computed light coordinate may be off, and which a map
/// rectangle covers in addition. In halves of a step: 1 for adding the origin, 3 for the row of the
/// axes, 1 for the box around its middle, 1 for the rectangle's start, 1 for its end, 4 for the
/// anchor of the view, which is 11, and so less than 6 steps.
const ERROR_STEPS: f64 = 8.0;

/// Is the least width of a texel in f64 steps: a rectangle's start is then within an eighth of a
/// texel of the whole texel that it represents, and its edges do not visibly shimmer as it moves.
const STEPS_PER_TEXEL: f64 = 4.0;

/// Is the share of a texel by which rounding may move a lookup; the border of every map includes as
/// much.
const FREE_SHARE: f64 = 1.0 / 64.0;

/// Is the least number of texels per side that a map has across the scene where the steps of f64
/// limit its texels.
const LEAST_TEXELS: u32 = 64;

/// Measures the largest step of f64 among the coordinates that a map rectangle is computed from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spacing {
    /// Is the largest coordinate, in world units.
    coordinate: f64,
}

impl Spacing {
    /// Returns the spacing for what is inside `required`, in a render space that begins at
    /// `origin`.
    pub(super) fn around(origin: DVec3, required: &LightBox) -> Self {
        // The origin counts by itself, since it is added to render coordinates to get world
        // coordinates.
        Self {
            coordinate: origin.length().max(required.reach()),
        }
    }

    fn step(self) -> f64 {
        f64::EPSILON * self.coordinate
    }

    /// Returns by how much computed light coordinates may be off, in world units.
    pub(super) fn error(self) -> f64 {
        ERROR_STEPS * self.step()
    }

    /// Returns a box in light space, grown by all that its sides may be off, for the position of
    /// the map rectangle and for their own.
    pub(super) fn widest(self, bounds: &LightBox) -> LightBox {
        bounds.grown(self.error() + ERROR_STEPS * f64::EPSILON * bounds.reach())
    }

    /// Returns the finest texel that a map rectangle can be made of.
    pub(super) fn finest_texel(self) -> f64 {
        STEPS_PER_TEXEL * self.step()
    }

    /// Returns the least depth range of which a 64th, the room behind the deepest receiver, is no
    /// less than the error.
    pub(super) fn least_depth(self) -> f64 {
        64.0 * self.error()
    }

    /// Returns what a map rectangle must be requested to cover so that it covers `min..max` in
    /// spite of the error, where that is more than the border of the map allows for anyway.
    pub(super) fn grown(
        self,
        (min, max): (DVec2, DVec2),
        size_texels: UVec2,
        texel_floor: f64,
    ) -> (DVec2, DVec2) {
        let texel = ((max - min) / size_texels.as_dvec2()).max(DVec2::splat(texel_floor));
        let error = self.error();
        let growth = texel.map(|texel| {
            if error > texel * FREE_SHARE {
                error
            } else {
                0.0
            }
        });
        (min - growth, max + growth)
    }

    /// Returns the spacing if it is fine enough for a map of `map_size` texels over `extent` world
    /// units, or for `texel_floor`, the finest texel that render space can resolve, where that is
    /// coarser. `distance` is from the render origin, for the error. `extent` is called only where
    /// the floor does not settle the matter, as it does for all but astronomical coordinates.
    pub(super) fn checked(
        self,
        extent: impl FnOnce() -> f64,
        map_size: u32,
        texel_floor: f64,
        distance: f64,
    ) -> Result<Self, ShadowError> {
        if self.finest_texel() <= texel_floor {
            return Ok(self);
        }
        let extent = extent();
        let texel = extent / f64::from(map_size.max(LEAST_TEXELS));
        // Coordinates that overflow give infinity or NaN, and fail this.
        if self.finest_texel() <= texel {
            Ok(self)
        } else {
            Err(ShadowError::ViewNotRepresentable {
                extent_world: extent,
                distance_world: distance,
                coordinate_world: self.coordinate,
            })
        }
    }
}
