//! Decides whether the six faces of a cube are drawn in one pass or in a pass for each.
//!
//! One pass draws every caster once and into all six faces. A pass for each face draws a caster
//! once per face that it touches. So one pass saves passes and draw calls, and puts every triangle
//! through six faces.
//!
//! What it assumes of their costs is in `costs.rs`. On a GPU triangles cost less beside calls, so
//! there one pass is taken more rarely than it could be.

use glam::Vec4;

use crate::cast::costs::{TRIANGLES_PER_SAVED_DRAW, TRIANGLES_PER_SAVED_PASS};
use crate::cast::draw_list::DrawCounter;
use crate::cast::{FrameCasters, ViewDraws};
use crate::gpu::FACE_COUNT;
use crate::{Aabb, ShadowView};

/// Returns the casters that one pass would draw, in order, where it gives the same depths as a pass
/// for each face and costs less. `views` are the faces that something casts into, all of which are
/// to be drawn whole.
pub(crate) fn one_pass_casters(
    views: &[ViewDraws],
    casters: &FrameCasters<'_>,
) -> Option<Vec<u32>> {
    // Each caster has one bit for each view that draws it.
    let drawn = views.iter().enumerate();
    let drawn = drawn.flat_map(|(view, draws)| {
        let bit = move |&caster: &u32| (caster, 1u8 << view);
        draws.casters.iter().map(bit)
    });
    let mut drawn: Vec<(u32, u8)> = drawn.collect();
    drawn.sort_unstable();
    drawn.dedup_by(|next, first| {
        let same = next.0 == first.0;
        if same {
            first.1 |= next.1;
        }
        same
    });
    let draws_in_passes = views.iter().map(|draws| {
        let mut counter = DrawCounter::new();
        for &caster in &draws.casters {
            counter.add(casters.facts(caster).batch);
        }
        counter.draws()
    });
    let boxes = casters.casting();
    let passes_saved = (views.len() as u64).saturating_sub(1);
    let (mut counter, mut triangles) = (DrawCounter::new(), 0);
    let mut union = Vec::with_capacity(drawn.len());
    for (index, drawn_by) in drawn {
        let (facts, bounds) = (casters.facts(index), boxes.at(index));
        let own_triangles = u64::from(facts.triangles);
        let in_others = |bounds: &Aabb| {
            let others = views.iter().enumerate();
            let mut others = others.filter(|(view, _)| drawn_by >> view & 1 == 0);
            others.any(|(_, draws)| may_show_beyond_reach(bounds, &draws.view))
        };
        if own_triangles == 0 || !facts.same_in_every_view || in_others(bounds) {
            return None;
        }
        counter.add(facts.batch);
        triangles += u64::from(FACE_COUNT) * own_triangles;
        union.push(index);
    }
    let draws_saved = draws_in_passes.sum::<u64>().saturating_sub(counter.draws());
    let worth = TRIANGLES_PER_SAVED_PASS * passes_saved + TRIANGLES_PER_SAVED_DRAW * draws_saved;
    (triangles < worth).then_some(union)
}

/// Returns whether a part of a caster beyond the light's reach may be visible in a view. Casters
/// are culled by the part of them that the light reaches. The part beyond can be seen by a view
/// that leaves the caster out, so that one pass would draw it there while a pass for each face
/// would not.
fn may_show_beyond_reach(bounds: &Aabb, view: &ShadowView) -> bool {
    let light = view.anchor_render();
    let farthest = (bounds.max - light).max(light - bounds.min).max_element();
    if f64::from(farthest) <= view.reach_world() {
        return false;
    }
    let clip_from_anchor = view.clip_from_anchor();
    let corners = [0, 1, 2, 3, 4, 5, 6, 7]
        .map(|corner| clip_from_anchor * (bounds.corner(corner) - light).extend(1.0));
    // A convex body is outside if all its corners are on the far side of one plane.
    let outside = |beyond: fn(&Vec4) -> bool| corners.iter().all(beyond);
    !(outside(|clip| clip.x > clip.w)
        || outside(|clip| clip.x < -clip.w)
        || outside(|clip| clip.y > clip.w)
        || outside(|clip| clip.y < -clip.w)
        || outside(|clip| clip.z > clip.w))
}
