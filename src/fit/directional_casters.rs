//! Walks the casters of a frame as a directional light sees them.

use crate::Aabb;
use crate::fit::axes::{LightBox, LightSpace};
use crate::fit::boxes::Boxes;
use crate::fit::spacing::Spacing;
use crate::fit::visible::SeenBounds;

/// Is what the sides of a box in light space are moved outward by, in multiples of its reach, for
/// it to hold the light-space boxes of all that is in the same box in render space, grown by what
/// [`Spacing::widest`] adds. That is 8 f64 steps, and two boxes are each rounded by less than 6.
const AROUND_STEPS: f64 = 32.0;

/// Is a caster as a directional light sees it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DirectionalCaster {
    pub index: u32,
    pub light: LightBox,
}

/// Holds the casters of a frame that can shadow something visible, and that count as a whole.
#[derive(Clone, Copy)]
pub(crate) struct DirectionalCasters<'a> {
    pub space: &'a LightSpace,
    pub boxes: Boxes<'a>,
    pub visible: &'a SeenBounds,
    /// Holds the casters that are divided into parts, in ascending order. They do not count.
    pub divided: &'a [u32],
    /// Holds the casters where no tree finds them; those that are divided are among them, and
    /// others that can shadow nothing visible.
    pub listed: &'a [DirectionalCaster],
}

/// Returns a box in light space that surely holds that of any box in `around`, grown as
/// [`Spacing::widest`] does.
pub(crate) fn light_box_around(space: &LightSpace, spacing: Spacing, around: &Aabb) -> LightBox {
    let light = space.bounds(around);
    let reach = light.min.abs().max(light.max.abs()).element_sum();
    light.grown(spacing.error() + AROUND_STEPS * f64::EPSILON * reach)
}

impl<'a> DirectionalCasters<'a> {
    /// Lists the casters that can shadow something, where no tree finds them.
    pub(super) fn list(
        space: &LightSpace,
        boxes: Boxes<'_>,
        visible: &SeenBounds,
        listed: &mut Vec<DirectionalCaster>,
    ) {
        listed.clear();
        if boxes.tree.is_none() {
            let toward_light = space.axes.toward_light();
            let casters = boxes.iter();
            let casters =
                casters.filter(|(_, bounds)| visible.can_be_shadowed_by(bounds, toward_light));
            listed.extend(casters.map(|(index, bounds)| DirectionalCaster {
                index,
                light: space.bounds(bounds),
            }));
        }
    }

    /// Calls `meet` with each caster, except where `enters` returns false for a box in light space
    /// that surely holds its own, grown as [`Spacing::widest`] does. `enters` may refuse boxes of
    /// which no part matters, in the present state.
    pub(super) fn walk<S>(
        &self,
        spacing: Spacing,
        state: &mut S,
        mut enters: impl FnMut(&S, &LightBox) -> bool,
        mut meet: impl FnMut(&mut S, u32, &'a Aabb, &LightBox),
    ) {
        let toward_light = self.space.axes.toward_light();
        let counts = |index: u32, bounds: &Aabb| {
            self.visible.can_be_shadowed_by(bounds, toward_light) && !self.is_divided(index)
        };
        if self.boxes.tree.is_none() {
            for caster in self.listed {
                let bounds = self.boxes.at(caster.index);
                if counts(caster.index, bounds) {
                    meet(state, caster.index, bounds, &caster.light);
                }
            }
            return;
        }
        self.boxes.walk(
            state,
            |state, around| {
                if !self.visible.can_be_shadowed_by(around, toward_light) {
                    return false;
                }
                enters(state, &light_box_around(self.space, spacing, around))
            },
            |state, index, bounds| {
                if counts(index, bounds) {
                    meet(state, index, bounds, &self.space.bounds(bounds));
                }
            },
        );
    }

    /// Returns whether there is any caster.
    pub(super) fn any(&self, spacing: Spacing) -> bool {
        let mut any = false;
        self.walk(spacing, &mut any, |any, _| !any, |any, _, _, _| *any = true);
        any
    }

    fn is_divided(&self, index: u32) -> bool {
        !self.divided.is_empty() && self.divided.binary_search(&index).is_ok()
    }
}
