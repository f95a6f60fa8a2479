//! How finely f64 tells places apart in absolute light space, and from where on that is too coarse for a map.
//!
//! A window lies on whole texels of a grid that is fixed in the world, so its place is an absolute coordinate. Far from the
//! world's origin f64 itself steps: by 2⁻⁵² of a coordinate, 16 units at 10¹⁷. Casters and receivers go through one matrix
//! whose linear part is exact, so steps never move a shadow against what casts it; they move the window against both.

use glam::{DVec2, DVec3};

use crate::ShadowError;
use crate::fit::LightBox;

/// Steps by which a computed light coordinate may be off, and what a window covers with it. In halves of a step: 1 for adding
/// the origin, 3 for the row of the axes, 1 for the box around its middle, 1 for the window's start, 1 for its end, 4 for the
/// anchor of the view, which is 11, and so less than 6 steps.
const ERROR_STEPS: f64 = 8.0;

/// Steps that a texel is wide at least: a window's start is then within an eighth of a texel of the whole texel that it
/// stands for, and its edges do not visibly tremble as it moves.
const STEPS_PER_TEXEL: f64 = 4.0;

/// Shares of a texel by which rounding may move a lookup: as much is part of the border of every map.
const FREE_SHARE: f64 = 1.0 / 64.0;

/// A map has at least as many texels across the scene that the steps of f64 leave it.
const LEAST_TEXELS: u32 = 64;

/// The largest step of f64 among the coordinates that a window is computed from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spacing {
    /// Largest coordinate.
    coordinate: f64,
}

impl Spacing {
    /// For what lies in `required`, of a render space that begins at `origin`.
    pub fn around(origin: DVec3, required: &LightBox) -> Self {
        // The origin counts by itself where render coordinates lead from it back to the world's.
        Self {
            coordinate: origin.length().max(required.reach()),
        }
    }

    fn step(self) -> f64 {
        f64::EPSILON * self.coordinate
    }

    /// By how much computed light coordinates may be off.
    pub fn error(self) -> f64 {
        ERROR_STEPS * self.step()
    }

    /// A box in light space with all that its sides may be off, for the place of the window and for their own.
    pub fn widest(self, bounds: &LightBox) -> LightBox {
        bounds.grown(self.error() + ERROR_STEPS * f64::EPSILON * bounds.reach())
    }

    /// The finest texel that a window can be made of.
    pub fn finest_texel(self) -> f64 {
        STEPS_PER_TEXEL * self.step()
    }

    /// The least depth range of which a 64th, the room behind the deepest receiver, is no less than the error.
    pub fn least_depth(self) -> f64 {
        64.0 * self.error()
    }

    /// What a window must be asked to cover so that it covers `min..max` in spite of the error, where that is more than the
    /// border of the map allows for anyway.
    pub fn grown(
        self,
        (min, max): (DVec2, DVec2),
        map_size: u32,
        texel_floor: f64,
    ) -> (DVec2, DVec2) {
        let texel = ((max - min) / f64::from(map_size)).max(DVec2::splat(texel_floor));
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

    /// Returns the spacing if it is fine enough for a map of `map_size` texels over `extent` world units, or for `texel_floor`,
    /// the finest texel that render space can tell apart, where that is coarser; `distance` is from the render origin, for the
    /// error. The extent is asked for only where the floor does not settle the matter, as it does for all but astronomical
    /// coordinates.
    pub fn checked(
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
        // Coordinates that overflow are no numbers, and fail this.
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
