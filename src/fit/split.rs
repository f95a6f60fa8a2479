//! Divides the depth along the view among cascades.

use crate::ShadowError;
use crate::check::in_range;

/// Is the largest number of cascades that one light may have.
pub(crate) const MAX_CASCADES: usize = 8;

/// Selects how the covered depth is divided among the cascades of a directional light.
/// [`DirectionalShadowDescriptor`](crate::DirectionalShadowDescriptor) defaults to `Logarithmic`.
///
/// Depths are along the camera's view, in world units. They run from the nearest visible receiver
/// (not the camera's near plane) to the farthest one or the camera's distance limit; under
/// [`Stability::BoundingSphere`](crate::Stability::BoundingSphere) they run from the camera's near
/// plane to its far plane or distance limit. A cascade that is too long for its map shows coarse
/// texels at its near end. Numbers out of range make
/// [`DirectionalShadow::new`](crate::DirectionalShadow::new) return [`ShadowError::OutOfRange`].
///
/// Sources: Engel 2006 (*Cascaded Shadow Maps*), Zhang et al. 2006 (*Parallel-Split Shadow Maps*,
/// GPU Gems 3 ch. 10).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum CascadeSplit<'a> {
    /// Divides into equal depths, which gives too few texels per pixel near the camera and more
    /// than needed far from it.
    Uniform,
    /// Divides in equal ratios, which gives equal texels per pixel everywhere. This is right
    /// whenever the near end is a receiver.
    Logarithmic,
    /// Divides at `lambda` (0..=1) of the way from uniform to logarithmic, for scenes with a single
    /// object close to the camera.
    Practical {
        /// Is 0 for uniform and 1 for logarithmic.
        lambda: f32,
    },
    /// Divides at given depths, for scenes with a known break, such as a cockpit before a
    /// landscape. A cascade that ends before the nearest visible receiver stays empty.
    Explicit {
        /// Holds the depths along the view, in world units, finite and growing, at which all
        /// cascades but the last end: one fewer than there are cascades.
        ends: &'a [f32],
    },
}

/// Holds a [`CascadeSplit`] whose numbers are checked, with a copy of them.
#[derive(Clone, Copy, Debug)]
pub(crate) enum SplitRule {
    /// Divides at the fraction `lambda` of the way from uniform to logarithmic.
    Practical { lambda: f64 },
    /// Divides at the ends of all cascades but the last.
    Explicit { ends: [f64; MAX_CASCADES - 1] },
    /// Divides at fractions of the logarithmic range: those at which each cascade ends.
    Fractions { ends: [f64; MAX_CASCADES] },
}

impl CascadeSplit<'_> {
    /// Checks the numbers for a light of `cascades` cascades.
    pub(crate) fn checked(
        self,
        field: &'static str,
        cascades: u32,
    ) -> Result<SplitRule, ShadowError> {
        let lambda = match self {
            Self::Uniform => 0.0,
            Self::Logarithmic => 1.0,
            Self::Practical { lambda } => lambda,
            Self::Explicit { ends } => {
                let finite = ends.iter().all(|end| end.is_finite());
                let growing = ends.is_sorted_by(|before, after| before < after);
                in_range(
                    field,
                    "a split with finite ends that grow, one fewer than there are cascades",
                    finite && growing && ends.len() + 1 == cascades as usize,
                    format_args!("{ends:?}"),
                )?;
                let mut all = [0.0; MAX_CASCADES - 1];
                for (own, end) in all.iter_mut().zip(ends) {
                    *own = f64::from(*end);
                }
                return Ok(SplitRule::Explicit { ends: all });
            }
        };
        in_range(
            field,
            "a split with a lambda in 0..=1",
            (0.0..=1.0).contains(&lambda),
            lambda,
        )?;
        let lambda = f64::from(lambda);
        Ok(SplitRule::Practical { lambda })
    }
}

impl SplitRule {
    /// Returns the depth at which cascade `index` of `count` begins (`index == count` is the far
    /// end).
    pub(crate) fn depth(self, index: usize, count: usize, near: f64, far: f64) -> f64 {
        if index == 0 {
            return near;
        }
        if index == count {
            return far;
        }
        let (share, lambda) = match self {
            Self::Explicit { ends } => return ends[index - 1].max(near).min(far),
            Self::Practical { lambda } => (index as f64 / count as f64, lambda),
            Self::Fractions { ends } => (ends[index - 1], 1.0),
        };
        let uniform = near + (far - near) * share;
        // Equal ratios need a positive start; depths of an orthographic camera may begin behind it.
        let logarithmic = if near > 0.0 {
            near * (far / near).powf(share)
        } else {
            uniform
        };
        // At both limits of `lambda` one of the depths is returned unchanged, so that the other
        // adds no rounding.
        if lambda == 1.0 {
            logarithmic
        } else if lambda == 0.0 {
            uniform
        } else {
            lambda * logarithmic + (1.0 - lambda) * uniform
        }
    }
}
