//! Divides the depth along the view among cascades.

use crate::ShadowError;
use crate::check::in_range;

/// Selects how the covered depth is divided among the cascades of a directional light.
/// [`DirectionalShadowDescriptor`](crate::DirectionalShadowDescriptor) defaults to `Logarithmic`.
///
/// Depths are along the camera's view, in world units. They run from the nearest visible receiver (not the camera's
/// near plane) to the farthest one or the camera's distance limit; under
/// [`Stability::BoundingSphere`](crate::Stability::BoundingSphere) they run from the camera's near plane to its far plane or
/// distance limit. A cascade that is too long for its map shows coarse texels at its near end. Numbers out of range
/// make [`DirectionalShadow::new`](crate::DirectionalShadow::new) return [`ShadowError::OutOfRange`].
///
/// Sources: Engel 2006 (*Cascaded Shadow Maps*), Zhang et al. 2006 (*Parallel-Split Shadow Maps*, GPU Gems 3 ch. 10).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum CascadeSplit {
    /// Divides into equal depths, which gives too few texels per pixel near the camera and more than needed far from
    /// it.
    Uniform,
    /// Divides in equal ratios, which gives equal texels per pixel everywhere. This is right whenever the near end is a
    /// receiver.
    Logarithmic,
    /// Divides at `lambda` (0..=1) of the way from uniform to logarithmic, for scenes with a single object close to the
    /// camera.
    Practical {
        /// Is 0 for uniform and 1 for logarithmic.
        lambda: f32,
    },
    /// Divides at given depths, for scenes with a known break, such as a cockpit before a landscape. A cascade that
    /// ends before the nearest visible receiver stays empty.
    Explicit {
        /// Holds the depths along the view, in world units, finite and growing, at which all cascades but the last end.
        /// As many are read as there are cascades but one; the rest is ignored.
        ends: [f32; 7],
    },
}

impl CascadeSplit {
    /// Returns the depth at which cascade `index` of `count` begins (`index == count` is the far end).
    pub(crate) fn depth(self, index: usize, count: usize, near: f64, far: f64) -> f64 {
        if index == 0 {
            return near;
        }
        if index == count {
            return far;
        }
        let share = index as f64 / count as f64;
        let uniform = near + (far - near) * share;
        // Equal ratios need a positive start; depths of an orthographic camera may begin behind it.
        let logarithmic = if near > 0.0 {
            near * (far / near).powf(share)
        } else {
            uniform
        };
        match self {
            Self::Uniform => uniform,
            Self::Logarithmic => logarithmic,
            Self::Practical { lambda } => {
                let lambda = f64::from(lambda);
                lambda * logarithmic + (1.0 - lambda) * uniform
            }
            Self::Explicit { ends } => f64::from(ends[index - 1]).max(near).min(far),
        }
    }

    /// Checks the numbers for a light of `cascades` cascades.
    pub(crate) fn check(self, field: &'static str, cascades: u32) -> Result<(), ShadowError> {
        let lambda = match self {
            Self::Practical { lambda } => lambda,
            Self::Uniform | Self::Logarithmic => 1.0,
            Self::Explicit { ends } => {
                let ends = &ends[..cascades as usize - 1];
                let finite = ends.iter().all(|end| end.is_finite());
                return in_range(
                    field,
                    "of finite ends that grow",
                    finite && ends.is_sorted_by(|before, after| before < after),
                    format_args!("{ends:?}"),
                );
            }
        };
        in_range(
            field,
            "of a lambda in 0..=1",
            (0.0..=1.0).contains(&lambda),
            lambda,
        )
    }
}
