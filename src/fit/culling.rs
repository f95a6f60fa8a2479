//! Bounds what casters must be able to shadow in order to be drawn.

use crate::fit::visible::SeenBounds;

/// Is the number of frames after which casters are left out that can shadow nothing visible any
/// more: two seconds at sixty frames per second.
const HELD_FRAMES: u32 = 120;

/// Bounds what was visible of late, kept from frame to frame while the bounds of a cascade stay the
/// same.
///
/// A camera that walks leaves casters behind whose shadows it no longer sees. They are still where
/// the map shows them, so the map stays right, and is not drawn again for each of them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HeldVisible {
    pub visible: SeenBounds,
    /// Counts the frames in which it was more than what was visible then.
    frames: u32,
}

impl HeldVisible {
    /// Returns the bounds for a frame that sees `visible`. `held` are those of the frame before, if
    /// the cascade has stayed the same.
    pub(super) fn following(held: Option<Self>, visible: &SeenBounds) -> Self {
        let now = Self {
            visible: *visible,
            frames: 0,
        };
        let Some(held) = held else {
            return now;
        };
        let all = Self {
            visible: held.visible.union(visible),
            frames: held.frames + 1,
        };
        if all.visible == *visible || all.frames >= HELD_FRAMES {
            now
        } else {
            all
        }
    }

    /// Returns the bounds for a frame that sees the same as the last. Returns `None` where they
    /// become others.
    pub(super) fn again(self, visible: &SeenBounds) -> Option<Self> {
        let next = Self::following(Some(self), visible);
        (next.visible == self.visible).then_some(next)
    }
}
