//! Keeps the layout of a light's cascades from frame to frame.

use crate::fit::layout_choice::{Layout, Prediction};
use crate::fit::predicted_error::FRAMES_BETWEEN_PREDICTIONS;

/// Is the factor by which the cost of another layout must be lower for a change. The error goes
/// with the number of texels to the power of -1/4, so that the change is worth 1.9 times the
/// texels.
const BETTER: f64 = 0.85;

/// Is the number of predictions in a row for which another layout must be better: 128 frames,
/// about as long as extents are held that are larger than needed.
const PREDICTIONS_FOR_CHANGE: u32 = 8;

/// Is the factor by which the cost of another layout must be lower for a change at once: it is then
/// worth sixteen times the texels, as after a cut of the camera.
const MUCH_BETTER: f64 = 0.5;

/// Holds a layout from frame to frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct HeldLayout {
    pub layout: Layout,
    /// Is the error that was predicted for it last.
    pub predicted_error: f64,
    /// Counts the frames since the last prediction.
    frames: u32,
    /// Counts the predictions in a row for which another layout was better.
    better: u32,
}

impl HeldLayout {
    /// Returns the layout of the next frame where no prediction is due.
    pub(super) fn without_prediction(&self) -> Option<Self> {
        let frames = self.frames + 1;
        (frames < FRAMES_BETWEEN_PREDICTIONS).then_some(Self { frames, ..*self })
    }

    /// Returns the layout of the next frame. `predict` is called where a prediction is due; it
    /// returns `None` where no shadow is seen, so that any layout serves as well.
    pub(super) fn next<'a>(
        held: Option<&Self>,
        map_size: u32,
        predict: impl FnOnce() -> Option<Prediction<'a>>,
    ) -> Self {
        if let Some(next) = held.and_then(Self::without_prediction) {
            return next;
        }
        let Some(prediction) = predict() else {
            let none = Self {
                layout: Layout::single(map_size),
                predicted_error: 0.0,
                frames: 0,
                better: 0,
            };
            // The first better layout for shadows that come into view is taken at once.
            return Self {
                frames: 0,
                better: PREDICTIONS_FOR_CHANGE - 1,
                ..held.copied().unwrap_or(none)
            };
        };
        let best = prediction.best();
        let taken = Self {
            layout: best,
            predicted_error: prediction.error(&best),
            frames: 0,
            better: 0,
        };
        let Some(held) = held else {
            return taken;
        };
        let ratio = prediction.cost(&best) / prediction.cost(&held.layout);
        let better = if ratio < BETTER { held.better + 1 } else { 0 };
        if ratio < MUCH_BETTER || better >= PREDICTIONS_FOR_CHANGE {
            return taken;
        }
        Self {
            predicted_error: prediction.error(&held.layout),
            frames: 0,
            better,
            ..*held
        }
    }
}
