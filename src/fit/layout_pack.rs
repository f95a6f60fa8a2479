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
pub(crate) struct Content {
    /// Is the fraction of all texels that it should have.
    pub share: f64,
    /// Is the world size of what it covers.
    pub size: DVec2,
    /// Is by how much a world unit of texel size, the mean along x and y, makes shadows wrong.
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

    /// Divides the layer among `contents`, which are cut apart in their order by one straight cut
    /// after the other, so that the sum of what is wrong is least. Returns `None` where the layer
    /// is too small.
    pub fn divide(&self, contents: &[Content]) -> Option<[TexelRect; MAX_CASCADES]> {
        let mut rects = [TexelRect::default(); MAX_CASCADES];
        let whole = TexelRect::whole(self.map_size);
        if contents.len() == 1 {
            rects[0] = whole;
            return Some(rects);
        }
        let step = self.step()?;
        let wrong = self.place(contents, whole, step, &mut rects);
        wrong.is_finite().then_some(rects)
    }

    /// Places `contents` in `rect`, fills `rects`, and returns what is wrong; infinite where they
    /// do not fit.
    fn place(
        &self,
        contents: &[Content],
        rect: TexelRect,
        step: u32,
        rects: &mut [TexelRect],
    ) -> f64 {
        if let [content] = contents {
            rects[0] = rect;
            return content.weight * self.mean_texel(content.size, rect.size);
        }
        let total: f64 = contents.iter().map(|content| content.share).sum();
        let (mut best, mut best_rects) = (f64::INFINITY, [TexelRect::default(); MAX_CASCADES]);
        let mut first_share = 0.0;
        for cut in 1..contents.len() {
            first_share += contents[cut - 1].share;
            // Of many contents only halves of about equal numbers are tried.
            if contents.len() > 5 && cut.abs_diff(contents.len() - cut) > 1 {
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
                let (before, after) = tried[..contents.len()].split_at_mut(cut);
                let wrong = self.place(&contents[..cut], first, step, before)
                    + self.place(&contents[cut..], second, step, after);
                if wrong < best {
                    (best, best_rects) = (wrong, tried);
                }
            }
        }
        rects[..contents.len()].copy_from_slice(&best_rects[..contents.len()]);
        best
    }

    /// Returns the mean along x and y of the world sizes of a texel, in the steps that sizes have,
    /// where `size` world units fill a rectangle.
    pub fn mean_texel(&self, size: DVec2, texels: UVec2) -> f64 {
        let usable = texels.as_dvec2() - f64::from(2 * self.margin_texels + 1);
        let texel = (size / usable.max(DVec2::ONE))
            .map(|size| if size > 0.0 { size_step_up(size) } else { 0.0 });
        texel.element_sum() * 0.5
    }
}
