//! Divides a layer into rectangles, one per cascade.

use glam::{DVec2, UVec2};

use crate::fit::size_step::size_step_up;
use crate::fit::split::MAX_CASCADES;
use crate::fit::texel_rect::TexelRect;

/// Is the number of parts of a layer's side on whose borders rectangles begin and end. Layouts then
/// differ by enough to be worth a change.
const STEPS: u32 = 16;

/// Describes what a rectangle is for.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct CascadeNeed {
    /// Is the fraction of all texels that it should have.
    pub share: f64,
    /// Is the world size of what it covers.
    pub size: DVec2,
    /// Is the squared error, up to a factor, that a world unit of texel size, the mean along x and
    /// y, adds.
    pub weight: f64,
}

/// Describes the layer that is divided.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Layer {
    pub map_size: u32,
    /// Counts the texels at each side of a rectangle that cover nothing.
    pub margin_texels: u32,
}

impl Layer {
    /// Returns the number of texels between borders on which rectangles may begin; `None` where the
    /// layer is too small to be divided.
    fn step(&self) -> Option<u32> {
        let step = self.map_size / STEPS;
        // A rectangle of one step is at least half map, and half margin.
        (step > 4 * self.margin_texels).then_some(step)
    }

    /// Divides the layer among `needs`, in their order, by the guillotine cuts for which the sum of
    /// their errors is least. Returns `None` where the layer is too small.
    pub(super) fn divide(&self, needs: &[CascadeNeed]) -> Option<[TexelRect; MAX_CASCADES]> {
        let mut rects = [TexelRect::default(); MAX_CASCADES];
        let whole = TexelRect::whole(self.map_size);
        if needs.len() == 1 {
            rects[0] = whole;
            return Some(rects);
        }
        let step = self.step()?;
        let error = self.place(needs, whole, step, &mut rects);
        error.is_finite().then_some(rects)
    }

    /// Places `needs` in `rect`, fills `rects`, and returns the sum of their errors; infinite where
    /// they do not fit.
    fn place(
        &self,
        needs: &[CascadeNeed],
        rect: TexelRect,
        step: u32,
        rects: &mut [TexelRect],
    ) -> f64 {
        if let [need] = needs {
            rects[0] = rect;
            return need.weight * self.mean_texel(need.size, rect.size);
        }
        let total: f64 = needs.iter().map(|need| need.share).sum();
        let (mut best, mut best_rects) = (f64::INFINITY, [TexelRect::default(); MAX_CASCADES]);
        let mut first_share = 0.0;
        for cut in 1..needs.len() {
            first_share += needs[cut - 1].share;
            // Of many needs only halves of about equal numbers are tried.
            if needs.len() > 5 && cut.abs_diff(needs.len() - cut) > 1 {
                continue;
            }
            for axis in 0..2 {
                let side = rect.size[axis];
                if side < 2 * step {
                    continue;
                }
                let part = f64::from(side) * first_share / total.max(f64::MIN_POSITIVE);
                let steps = (part / f64::from(step)).round() as u32;
                let part = (steps * step).clamp(step, side - step);
                let (mut first, mut second) = (rect, rect);
                first.size[axis] = part;
                second.min[axis] += part;
                second.size[axis] -= part;
                let mut tried = [TexelRect::default(); MAX_CASCADES];
                let (before, after) = tried[..needs.len()].split_at_mut(cut);
                let error = self.place(&needs[..cut], first, step, before)
                    + self.place(&needs[cut..], second, step, after);
                if error < best {
                    (best, best_rects) = (error, tried);
                }
            }
        }
        rects[..needs.len()].copy_from_slice(&best_rects[..needs.len()]);
        best
    }

    /// Returns the mean along x and y of the world sizes of a texel, in the steps that sizes have,
    /// where `size` world units fill a rectangle.
    pub(super) fn mean_texel(&self, size: DVec2, texels: UVec2) -> f64 {
        let usable = texels.as_dvec2() - f64::from(2 * self.margin_texels + 1);
        let texel = (size / usable.max(DVec2::ONE))
            .map(|size| if size > 0.0 { size_step_up(size) } else { 0.0 });
        texel.element_sum() * 0.5
    }
}
