//! What a layer of a map holds, what part of it stands still, and so what a frame must draw.

use crate::ShadowView;
use crate::cast::{FrameCasters, Revision};
use crate::fit::ViewPlacement;

/// One view of this frame and the casters that it needs, by index into the engine's list, ascending.
#[derive(Debug)]
pub(crate) struct ViewDraws {
    pub view: ShadowView,
    pub casters: Vec<u32>,
    /// The layer keeps what it holds, whatever has changed.
    pub deferred: bool,
    /// Set by the recorder.
    pub plan: Plan,
    /// Casters of the view that came with the still part instead of being drawn, and their triangles.
    pub copied: u32,
    pub copied_triangles: u64,
}

impl ViewDraws {
    pub fn new(view: ShadowView, casters: Vec<u32>) -> Self {
        Self {
            view,
            casters,
            deferred: false,
            plan: Plan::Keep,
            copied: 0,
            copied_triangles: 0,
        }
    }
}

/// How a layer comes to hold a view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Plan {
    /// It does already.
    Keep,
    /// All casters are drawn into it.
    All,
    /// The still part is copied into it, and the casters that are not of it drawn over.
    OverStaticCache,
    /// The still part is drawn anew into a texture of its own first.
    RenewStaticCache,
}

impl Plan {
    /// Returns how many depth passes it takes.
    pub const fn passes(self) -> u32 {
        match self {
            Self::Keep => 0,
            Self::All | Self::OverStaticCache => 1,
            Self::RenewStaticCache => 2,
        }
    }
}

/// A caster as it was drawn.
#[derive(Clone, Copy, Debug)]
struct Drawn {
    index: u32,
    revision: Revision,
    /// Draws for which it had not changed.
    age: u32,
}

/// Casters count as still, and so does a view, after so many draws without change: what is animated at a quarter of the frame
/// rate or faster never does.
const STATIC_AFTER_DRAWS: u32 = 4;

/// A still part pays where drawing it again would cost more than copying a layer. So many texels of copying come to a draw, and
/// so many to a triangle. In software a draw of a box costs as much as copying 100 000 (`cargo bench --bench cost`, "still
/// part"); a third of that leaves room for devices that draw faster beside their memory.
const TEXELS_PER_DRAW: u64 = 32_768;

/// By the memory that a texel of copying moves (8 bytes) against the corners, fetched and transformed, that a triangle needs
/// (some 100 bytes where corners are shared); a software rasteriser takes far longer over triangles.
const TEXELS_PER_TRIANGLE: u64 = 16;

/// Longest time, in draws, for which no part is made after one that did not last: so long, one part in vain costs less than one
/// draw in a hundred.
const LONGEST_REST: u32 = 256;

/// What a layer of the map holds.
#[derive(Clone, Debug, Default)]
pub(crate) struct LayerCache {
    /// None before the first pass.
    placement: Option<ViewPlacement>,
    /// Largest render coordinate that the depths were computed from: they carry its rounding, whatever the origin is by now.
    render_reach: f64,
    /// Draws since the view last changed.
    age: u32,
    drawn: Vec<Drawn>,
    part: StaticCasterCache,
}

/// What the texture of a layer's still part holds.
#[derive(Clone, Debug, Default)]
struct StaticCasterCache {
    /// Nothing while it is of no use.
    casters: Vec<Drawn>,
    /// Largest render coordinate that its depths were computed from.
    render_reach: f64,
    /// Draws that it has served.
    served: u32,
    /// Draws until one may be made again, and for how long the last pause was.
    resting: u32,
    last_rest: u32,
}

impl LayerCache {
    /// Is it of `view`, whatever the casters?
    pub fn is_of(&self, view: &ShadowView) -> bool {
        self.placement == Some(*view.placement())
    }

    /// Returns whether it is as good as what `draws` would put there.
    fn holds(&self, draws: &ViewDraws, casters: &FrameCasters<'_>) -> bool {
        self.is_of(&draws.view)
            && draws.view.may_keep_depths_from(self.render_reach)
            && self.drawn.len() == draws.casters.len()
            && now(draws, casters)
                .zip(&self.drawn)
                .all(|(now, was)| now.revision == was.revision && now.revision.is_stable())
    }

    /// What `draws` needs. `can_copy` is false where layers cannot be copied.
    pub fn plan(&self, draws: &ViewDraws, casters: &FrameCasters<'_>, can_copy: bool) -> Plan {
        if draws.deferred || self.holds(draws, casters) {
            return Plan::Keep;
        }
        if !can_copy || !self.is_of(&draws.view) {
            return Plan::All;
        }
        let texels = u64::from(draws.view.map_size()).pow(2);
        let still = worth(self.still(draws, casters), casters);
        if self.part.lasts(draws, casters) {
            let part = worth(self.part.casters.iter().copied(), casters);
            return if still > part + texels {
                Plan::RenewStaticCache
            } else {
                Plan::OverStaticCache
            };
        }
        if self.age >= STATIC_AFTER_DRAWS && self.part.resting == 0 && still > texels {
            Plan::RenewStaticCache
        } else {
            Plan::All
        }
    }

    /// Returns the largest render coordinate that the layer's depths will have been computed from once `draws` has been carried
    /// out as planned.
    pub fn render_reach_after(&self, draws: &ViewDraws) -> f64 {
        let now = draws.view.render_reach();
        match draws.plan {
            Plan::Keep => self.render_reach,
            Plan::OverStaticCache => self.part.render_reach.max(now),
            Plan::All | Plan::RenewStaticCache => now,
        }
    }

    /// Does the still part hold the caster?
    pub fn is_still(&self, index: u32) -> bool {
        let casters = &self.part.casters;
        casters.binary_search_by_key(&index, |c| c.index).is_ok()
    }

    /// Takes on what `draws` puts there.
    pub fn replace(&mut self, draws: &ViewDraws, casters: &FrameCasters<'_>) {
        self.render_reach = self.render_reach_after(draws);
        let placement = Some(*draws.view.placement());
        if self.placement != placement {
            self.placement = placement;
            self.age = 0;
            self.part.casters.clear();
        }
        self.age = self.age.saturating_add(1);
        self.part.resting = self.part.resting.saturating_sub(1);
        match draws.plan {
            Plan::Keep => return,
            Plan::All => self.part.give_up(),
            Plan::OverStaticCache => self.part.served = self.part.served.saturating_add(1),
            Plan::RenewStaticCache => {
                let mut part = std::mem::take(&mut self.part.casters);
                part.clear();
                part.extend(self.still(draws, casters));
                self.part.casters = part;
                self.part.render_reach = self.render_reach;
                self.part.served = 0;
            }
        }
        // The old list stands in front of the new one while ages go over.
        let before = self.drawn.len();
        self.drawn.extend(now(draws, casters));
        let (old, new) = self.drawn.split_at_mut(before);
        let mut old = old.iter().peekable();
        for drawn in new {
            while old.next_if(|old| old.index < drawn.index).is_some() {}
            if let Some(old) = old.next_if(|old| old.is_same(drawn)) {
                drawn.age = old.age.saturating_add(1);
            }
        }
        self.drawn.drain(..before);
    }

    /// Casters of `draws` that have not changed for long enough.
    fn still<'a>(
        &'a self,
        draws: &'a ViewDraws,
        casters: &'a FrameCasters<'_>,
    ) -> impl Iterator<Item = Drawn> + 'a {
        unchanged(&self.drawn, draws, casters).filter(|was| was.age >= STATIC_AFTER_DRAWS)
    }
}

impl StaticCasterCache {
    /// Is there one, of which `draws` has every caster as it was?
    fn lasts(&self, draws: &ViewDraws, casters: &FrameCasters<'_>) -> bool {
        !self.casters.is_empty()
            && draws.view.may_keep_depths_from(self.render_reach)
            && unchanged(&self.casters, draws, casters).count() == self.casters.len()
    }

    /// The longer it takes until the next one, the less this one has served.
    fn give_up(&mut self) {
        if self.casters.is_empty() {
            return;
        }
        self.casters.clear();
        self.last_rest = if self.served < 4 * self.last_rest.max(1) {
            (2 * self.last_rest).clamp(1, LONGEST_REST)
        } else {
            0
        };
        self.resting = self.last_rest;
    }
}

impl Drawn {
    fn is_same(&self, other: &Self) -> bool {
        self.index == other.index && self.revision == other.revision && self.revision.is_stable()
    }
}

/// The casters of `draws` as they are.
fn now<'a>(
    draws: &'a ViewDraws,
    casters: &'a FrameCasters<'_>,
) -> impl Iterator<Item = Drawn> + 'a {
    draws.casters.iter().map(|&index| Drawn {
        index,
        revision: casters.facts(index).revision,
        age: 0,
    })
}

/// Those of `before` (ascending by index) that `draws` has with the same revision.
fn unchanged<'a>(
    before: &'a [Drawn],
    draws: &'a ViewDraws,
    casters: &'a FrameCasters<'_>,
) -> impl Iterator<Item = Drawn> + 'a {
    let mut now = now(draws, casters).peekable();
    before.iter().copied().filter(move |was| {
        while now.next_if(|now| now.index < was.index).is_some() {}
        now.peek().is_some_and(|now| now.is_same(was))
    })
}

/// Texels of copying that drawing the casters would cost.
fn worth(drawn: impl Iterator<Item = Drawn>, casters: &FrameCasters<'_>) -> u64 {
    drawn
        .map(|drawn| {
            let triangles = casters.facts(drawn.index).triangles;
            TEXELS_PER_DRAW + TEXELS_PER_TRIANGLE * u64::from(triangles)
        })
        .sum()
}
