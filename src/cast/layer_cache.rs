//! Tracks what each layer of a map caches, which of its casters are static, and so what a frame
//! must draw.

use std::num::NonZeroU32;
use std::ops::Range;

use crate::ShadowView;
use crate::cast::costs::{TEXELS_PER_DRAW, TEXELS_PER_TRIANGLE};
use crate::cast::draw_list::DrawCounter;
use crate::cast::{FrameCasters, Revision};
use crate::fit::{TexelRect, ViewPlacement};

/// Is one view of this frame with the casters that it needs, by their indices among the casters of
/// the frame.
#[derive(Debug)]
pub(crate) struct ViewDraws {
    pub view: ShadowView,
    pub casters: Vec<u32>,
    /// States that the refresh of the view is deferred: the layer keeps its present depths,
    /// whatever has changed.
    pub deferred: bool,
    /// States how the layer is brought up to date; the recorder sets it.
    pub plan: Plan,
    /// Counts the casters of the view that were copied from the static-caster cache instead of
    /// being drawn; the next field counts their triangles.
    pub copied: u32,
    pub copied_triangles: u64,
    /// Is the range of the draw calls of its pass in the lists of the frame; the recorder sets it.
    pub calls: Range<usize>,
    /// Is the range of those that draw the static-caster cache.
    pub static_calls: Range<usize>,
}

impl ViewDraws {
    pub(crate) fn new(view: ShadowView, casters: Vec<u32>) -> Self {
        Self {
            view,
            casters,
            deferred: false,
            plan: Plan::Keep,
            copied: 0,
            copied_triangles: 0,
            calls: 0..0,
            static_calls: 0..0,
        }
    }

    /// Returns the number of draw calls that the view takes, which is 0 for a view that is kept.
    pub(crate) fn draw_calls(&self) -> u32 {
        (self.calls.len() + self.static_calls.len()) as u32
    }
}

/// States how a layer comes to hold a view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Plan {
    /// Leaves the layer as it is: it holds the view already.
    Keep,
    /// Draws all casters into it.
    All,
    /// Copies the static-caster cache into it, and draws the other casters over that.
    OverStaticCache,
    /// Draws the static casters into the static-caster cache first, a texture of its own, and then
    /// does as `OverStaticCache`.
    RenewStaticCache,
}

impl Plan {
    /// Returns how often the plan renders the view: into the layer, and into the static-caster
    /// cache.
    pub(crate) const fn renders(self) -> u32 {
        match self {
            Self::Keep => 0,
            Self::All | Self::OverStaticCache => 1,
            Self::RenewStaticCache => 2,
        }
    }
}

/// Is a caster as it was drawn. Lists of them are in ascending order of revisions, so that it does
/// not matter in which order, or at which indices, the engine has its casters.
#[derive(Clone, Copy, Debug)]
struct Drawn {
    revision: Option<Revision>,
    /// Is the number of its triangles, as it was reported.
    triangles: u32,
    /// Is equal for those that are drawn in one call.
    batch: Option<NonZeroU32>,
    /// Counts the draws for which it had not changed.
    age: u32,
}

/// Is the number of draws without a change after which a caster, or a view, counts as static. A
/// caster that is animated at a quarter of the frame rate or faster never does.
const STATIC_AFTER_DRAWS: u32 = 4;

/// Is the longest time, in draws, for which no static-caster cache is made after one that did not
/// last. With a pause this long, a cache made for nothing costs less than one draw in a hundred.
const LONGEST_COOLDOWN_DRAWS: u32 = 256;

/// Holds what a layer of the map caches: the view, the casters as they were drawn, and its static
/// casters.
#[derive(Clone, Debug, Default)]
pub(crate) struct LayerCache {
    /// Is where the view is, in the world and in the layer; `None` before the first pass.
    placement: Option<(ViewPlacement, TexelRect)>,
    /// Is the largest render coordinate, in world units, that the depths were computed from. They
    /// carry its rounding, whatever the origin is by now.
    render_reach: f64,
    /// Counts the draws since the view last changed.
    age: u32,
    drawn: Vec<Drawn>,
    /// Holds the revisions of the casters in the order in which they were drawn or last kept.
    in_order: Vec<Option<Revision>>,
    static_cache: StaticCasterCache,
}

/// Describes the texture that holds a layer's static casters alone.
#[derive(Clone, Debug, Default)]
struct StaticCasterCache {
    /// Is empty while there is no usable cache.
    casters: Vec<Drawn>,
    /// Is the largest render coordinate, in world units, that its depths were computed from.
    render_reach: f64,
    /// Counts the draws that used it.
    served: u32,
    /// Is the number of draws until a cache may be made again; the next field is the length of the
    /// last such pause.
    cooldown: u32,
    last_cooldown: u32,
}

impl LayerCache {
    /// Returns whether the layer holds nothing that a later frame may rely on.
    pub(super) fn is_empty(&self) -> bool {
        self.placement.is_none()
    }

    /// Returns whether the layer holds `view`, whatever the casters.
    pub(super) fn is_of(&self, view: &ShadowView) -> bool {
        self.placement == Some((*view.placement(), view.texels()))
    }

    /// Returns whether the layer holds the view of `draws`, and its casters are those that were
    /// drawn, in the same order.
    fn holds_in_order(&self, draws: &ViewDraws, casters: &FrameCasters<'_>) -> bool {
        let same = |(&index, was): (&u32, &Option<Revision>)| {
            let now = casters.facts(index).revision;
            now == *was && now.is_some()
        };
        self.is_kept_view(draws)
            && self.in_order.len() == draws.casters.len()
            && draws.casters.iter().zip(&self.in_order).all(same)
    }

    /// Returns whether the layer holds the view of `draws`, whatever the casters, with depths that
    /// are good enough.
    fn is_kept_view(&self, draws: &ViewDraws) -> bool {
        self.is_of(&draws.view) && draws.view.may_keep_depths_from(self.render_reach)
    }

    /// Returns whether the layer holds what `draws` would put there. `now` are its casters.
    fn holds(&self, draws: &ViewDraws, now: &[Drawn]) -> bool {
        self.is_kept_view(draws)
            && self.drawn.len() == now.len()
            && now
                .iter()
                .zip(&self.drawn)
                .all(|(now, was)| now.is_same(was))
    }

    /// Returns what `draws` needs. `can_copy` is false where layers cannot be copied.
    pub(super) fn plan(
        &self,
        draws: &ViewDraws,
        casters: &FrameCasters<'_>,
        can_copy: bool,
    ) -> Plan {
        if draws.deferred || self.holds_in_order(draws, casters) {
            return Plan::Keep;
        }
        if !self.is_of(&draws.view) {
            return Plan::All;
        }
        let now = &now(draws, casters);
        if self.holds(draws, now) {
            return Plan::Keep;
        }
        if !can_copy {
            return Plan::All;
        }
        let size = draws.view.texels().size;
        let texels = u64::from(size.x) * u64::from(size.y);
        let static_cost = draw_cost_texels(self.static_casters(now));
        if self.static_cache.is_valid_for(draws, now) {
            let cached_cost = draw_cost_texels(self.static_cache.casters.iter().copied());
            return if static_cost > cached_cost + texels {
                Plan::RenewStaticCache
            } else {
                Plan::OverStaticCache
            };
        }
        if self.age >= STATIC_AFTER_DRAWS && self.static_cache.cooldown == 0 && static_cost > texels
        {
            Plan::RenewStaticCache
        } else {
            Plan::All
        }
    }

    /// Returns the largest render coordinate that the layer's depths will have been computed from
    /// once `draws` has been carried out as planned.
    pub(super) fn render_reach_after(&self, draws: &ViewDraws) -> f64 {
        let now = draws.view.render_reach();
        match draws.plan {
            Plan::Keep => self.render_reach,
            Plan::OverStaticCache => self.static_cache.render_reach.max(now),
            Plan::All | Plan::RenewStaticCache => now,
        }
    }

    /// Returns whether the static-caster cache holds a caster of this revision.
    pub(super) fn is_static(&self, revision: Option<Revision>) -> bool {
        let casters = &self.static_cache.casters;
        revision.is_some()
            && casters
                .binary_search_by_key(&revision, |c| c.revision)
                .is_ok()
    }

    /// Takes note of the order of the casters of a view that is kept.
    pub(super) fn keep(&mut self, draws: &ViewDraws, casters: &FrameCasters<'_>) {
        if !draws.deferred && !self.holds_in_order(draws, casters) {
            self.note_order(draws, casters);
        }
    }

    fn note_order(&mut self, draws: &ViewDraws, casters: &FrameCasters<'_>) {
        self.in_order.clear();
        let revisions = draws
            .casters
            .iter()
            .map(|&index| casters.facts(index).revision);
        self.in_order.extend(revisions);
    }

    /// Returns the revisions, in order, of the casters that the static-caster cache will hold once
    /// `draws` has renewed it.
    pub(super) fn static_after_renewal(
        &self,
        draws: &ViewDraws,
        casters: &FrameCasters<'_>,
    ) -> Vec<Option<Revision>> {
        let now = now(draws, casters);
        let found = self.static_casters(&now);
        found.map(|drawn| drawn.revision).collect()
    }

    /// Updates the cache's state to what `draws` puts into the layer.
    pub(super) fn replace(&mut self, draws: &ViewDraws, casters: &FrameCasters<'_>) {
        self.render_reach = self.render_reach_after(draws);
        let placement = Some((*draws.view.placement(), draws.view.texels()));
        if self.placement != placement {
            self.placement = placement;
            self.age = 0;
            self.static_cache.casters.clear();
        }
        self.age = self.age.saturating_add(1);
        let mut new = now(draws, casters);
        self.static_cache.cooldown = self.static_cache.cooldown.saturating_sub(1);
        match draws.plan {
            Plan::Keep => return,
            Plan::All => self.static_cache.discard(),
            Plan::OverStaticCache => {
                self.static_cache.served = self.static_cache.served.saturating_add(1)
            }
            Plan::RenewStaticCache => {
                let mut kept = std::mem::take(&mut self.static_cache.casters);
                kept.clear();
                kept.extend(self.static_casters(&new));
                self.static_cache.casters = kept;
                self.static_cache.render_reach = self.render_reach;
                self.static_cache.served = 0;
            }
        }
        let mut old = self.drawn.iter().peekable();
        for drawn in &mut new {
            while old.next_if(|old| old.revision < drawn.revision).is_some() {}
            if let Some(old) = old.next_if(|old| old.is_same(drawn)) {
                drawn.age = old.age.saturating_add(1);
            }
        }
        self.drawn = new;
        self.note_order(draws, casters);
    }

    /// Returns those of the casters `now` that have not changed for [`STATIC_AFTER_DRAWS`] draws.
    fn static_casters<'a>(&'a self, now: &'a [Drawn]) -> impl Iterator<Item = Drawn> + 'a {
        unchanged(&self.drawn, now).filter(|was| was.age >= STATIC_AFTER_DRAWS)
    }
}

impl StaticCasterCache {
    /// Returns whether there is a cache and `draws` contains every one of its casters unchanged.
    fn is_valid_for(&self, draws: &ViewDraws, now: &[Drawn]) -> bool {
        !self.casters.is_empty()
            && draws.view.may_keep_depths_from(self.render_reach)
            && unchanged(&self.casters, now).count() == self.casters.len()
    }

    /// Drops the cached casters. The fewer draws the cache has served, the longer no new one is
    /// made: the pause doubles, from 1 draw up to [`LONGEST_COOLDOWN_DRAWS`], unless the cache
    /// served at least four times as many draws as the last pause was long, which sets the pause to
    /// 0.
    fn discard(&mut self) {
        if self.casters.is_empty() {
            return;
        }
        self.casters.clear();
        self.last_cooldown = if self.served < 4 * self.last_cooldown.max(1) {
            (2 * self.last_cooldown).clamp(1, LONGEST_COOLDOWN_DRAWS)
        } else {
            0
        };
        self.cooldown = self.last_cooldown;
    }
}

impl Drawn {
    fn is_same(&self, other: &Self) -> bool {
        self.revision == other.revision && self.revision.is_some()
    }
}

/// Returns the casters of `draws` in their present revisions.
fn now(draws: &ViewDraws, casters: &FrameCasters<'_>) -> Vec<Drawn> {
    let now = draws.casters.iter().map(|&index| {
        let facts = casters.facts(index);
        Drawn {
            revision: facts.revision,
            triangles: facts.triangles,
            batch: facts.batch,
            age: 0,
        }
    });
    let mut now: Vec<Drawn> = now.collect();
    // Most lists are in order already, or in few runs that are, which a stable sort makes use of.
    now.sort_by_key(|drawn| drawn.revision);
    now
}

/// Returns those of `before` that are in `now` with the same revision; both are in order.
fn unchanged<'a>(before: &'a [Drawn], now: &'a [Drawn]) -> impl Iterator<Item = Drawn> + 'a {
    let mut now = now.iter().peekable();
    before.iter().copied().filter(move |was| {
        while now.next_if(|now| now.revision < was.revision).is_some() {}
        now.next_if(|now| now.is_same(was)).is_some()
    })
}

/// Returns what drawing the casters costs, in copied texels.
fn draw_cost_texels(drawn: impl Iterator<Item = Drawn>) -> u64 {
    let mut counter = DrawCounter::new();
    let mut triangles = 0;
    for drawn in drawn {
        counter.add(drawn.batch);
        triangles += u64::from(drawn.triangles);
    }
    TEXELS_PER_DRAW * counter.draws() + TEXELS_PER_TRIANGLE * triangles
}
