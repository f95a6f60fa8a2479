//! Chooses how many cascades a light has, where they end, and how the texels are divided among
//! them, by predicted error.

use glam::DVec2;

use crate::fit::axes::LightBox;
use crate::fit::cascade_bounds::Cascade;
use crate::fit::directional_input::{FitInput, FitLimits, Region};
use crate::fit::layout_pack::{CascadeNeed, Layer};
use crate::fit::layout_samples::{Sample, SampleScratch, Sampled};
use crate::fit::map_rect::HeldDepth;
use crate::fit::predicted_error::{LARGEST_TEXEL_PIXELS, root_mean_error};
use crate::fit::required::{camera_slice, required_box};
use crate::fit::spacing::Spacing;
use crate::fit::split::{MAX_CASCADES, SplitRule};
use crate::fit::texel_rect::TexelRect;
use crate::fit::visible::SeenBounds;

/// Is the number of equal ratios of depth, or equal depths where the camera's begin behind it, into
/// which the covered depth is divided; cascades end at the ends of these.
pub(crate) const ZONES: usize = 12;

/// Is the least number of points on which shadows can fall for a cascade to be judged: the error of
/// its weight is then at most about 40 percent (the root of 1/6), and so that of its share of the
/// texels about 27.
const LEAST_SAMPLES: u32 = 6;

/// Is the factor by which each cascade more must lower the predicted error, which counts its pass
/// and its draws. The error goes with the number of texels to the power of -1/4, so that a cascade
/// has to be worth 18 percent more texels.
const ERROR_PER_CASCADE: f64 = 0.96;

/// States how the texels of a light are divided among its cascades.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Layout {
    pub cascades: usize,
    /// Holds for each cascade the zone before which it ends.
    ends: [u8; MAX_CASCADES],
    pub rects: [TexelRect; MAX_CASCADES],
}

impl Layout {
    /// Returns the layout of one cascade.
    pub(crate) fn single(map_size: u32) -> Self {
        let mut rects = [TexelRect::default(); MAX_CASCADES];
        rects[0] = TexelRect::whole(map_size);
        Self {
            cascades: 1,
            ends: [ZONES as u8; MAX_CASCADES],
            rects,
        }
    }

    /// Returns the settings of a light with this layout.
    pub(crate) fn applied(&self, limits: &FitLimits) -> FitLimits {
        let ends = std::array::from_fn(|end| f64::from(self.ends[end]) / ZONES as f64);
        FitLimits {
            cascades: self.cascades,
            split: SplitRule::Fractions { ends },
            rects: self.rects,
            ..*limits
        }
    }

    /// Returns the zones of each cascade.
    fn zones(&self) -> impl Iterator<Item = (usize, usize)> {
        let ends = &self.ends[..self.cascades];
        let starts = std::iter::once(&0).chain(ends);
        starts
            .zip(ends)
            .map(|(start, end)| (usize::from(*start), usize::from(*end)))
    }
}

/// Holds what a cascade over one or more zones would cover.
#[derive(Clone, Copy, Debug)]
struct Extent {
    required: LightBox,
    shadows: LightBox,
}

impl Extent {
    const NOTHING: Self = Self {
        required: LightBox::EMPTY,
        shadows: LightBox::EMPTY,
    };

    fn union(&mut self, other: &Self) {
        self.required.union(&other.required);
        self.shadows.union(&other.shadows);
    }

    /// Returns what is covered across the light, if anything is.
    fn covered(&self) -> Option<Covered> {
        let both = self.required.intersection_xy(&self.shadows)?;
        let (min, max) = (both.min.truncate(), both.max.truncate());
        Some(Covered { min, max })
    }
}

/// Is what a cascade covers across the light.
#[derive(Clone, Copy, Debug)]
struct Covered {
    min: DVec2,
    max: DVec2,
}

impl Covered {
    fn holds(&self, place: DVec2) -> bool {
        self.min.cmple(place).all() && place.cmple(self.max).all()
    }
}

/// Holds what layouts are compared by.
pub(crate) struct Prediction<'a> {
    limits: &'a FitLimits,
    layer: Layer,
    /// Holds what cascades from the beginning of one zone to the end of another cover.
    covered: [[Option<Covered>; ZONES]; ZONES],
    /// Holds the points on which shadows can fall.
    samples: &'a [Sample],
    /// Counts all points.
    sample_count: usize,
}

impl<'a> Prediction<'a> {
    /// Samples the frame; returns `None` without a camera, or where no shadow can be seen.
    pub(super) fn of(
        sampled: &Sampled<'_>,
        limits: &'a FitLimits,
        visible: &SeenBounds,
        held_depths: Option<&HeldDepth>,
        scratch: &'a mut SampleScratch,
    ) -> Option<Self> {
        let input = sampled.input;
        let Region::Cameras(cameras) = input.region else {
            return None;
        };
        sampled.take(cameras, scratch);
        let samples = &mut scratch.samples;
        let sample_count = samples.len();
        samples.retain(|sample| sample.edges > 0.0);
        if samples.is_empty() {
            return None;
        }
        let zone_limits = FitLimits {
            cascades: ZONES,
            split: SplitRule::Practical { lambda: 1.0 },
            ..*limits
        };
        let mut between = [(0.0, 0.0); ZONES];
        let mut required = [None; ZONES];
        let mut window = LightBox::EMPTY;
        for zone in 0..ZONES {
            let slice = camera_slice(input, &zone_limits, visible, held_depths, zone)?;
            between[zone] = slice.between;
            required[zone] = required_box(input, &zone_limits, Some(&slice), sampled.seen, zone);
            required[zone]
                .iter()
                .for_each(|required| window.union(required));
        }
        let zones: [Extent; ZONES] = std::array::from_fn(|zone| match &required[zone] {
            None => Extent::NOTHING,
            Some(required) => extent(sampled, &zone_limits, between[zone], required, &window),
        });
        let mut covered = [[None; ZONES]; ZONES];
        for (first, covered) in covered.iter_mut().enumerate() {
            let mut all = Extent::NOTHING;
            for (covered, zone) in covered.iter_mut().zip(&zones).skip(first) {
                all.union(zone);
                *covered = all.covered();
            }
        }
        Some(Self {
            limits,
            layer: Layer {
                map_size: limits.map_size,
                margin_texels: limits.margin_texels,
            },
            covered,
            samples,
            sample_count,
        })
    }

    /// Returns the layout with the least predicted error, where every cascade more has to be worth
    /// its pass.
    ///
    /// From one number of cascades to the next, one of them is divided where that is best. Then
    /// each end is moved by single zones for as long as that helps.
    pub(super) fn best(&self) -> Layout {
        let mut best = Layout::single(self.limits.map_size);
        let mut least = self.cost(&best);
        let (mut layout, most) = (best, self.limits.cascades.min(ZONES));
        while layout.cascades < most {
            let ends = layout.ends;
            let inner = &ends[..layout.cascades - 1];
            let candidates = (1..ZONES as u8).filter(|end| !inner.contains(end));
            let Some(mut next) = self.least(
                candidates.map(|end| {
                    let mut ends = ends;
                    ends[layout.cascades] = end;
                    ends[..=layout.cascades].sort_unstable();
                    ends
                }),
                layout.cascades + 1,
            ) else {
                return best;
            };
            loop {
                let ends = next.1.ends;
                let moves = (0..layout.cascades).flat_map(|end| [(end, -1), (end, 1)]);
                let moved = moves.filter_map(|(end, by): (usize, i8)| {
                    let mut ends = ends;
                    ends[end] = ends[end].saturating_add_signed(by);
                    let grow =
                        ends[..=layout.cascades].is_sorted_by(|before, after| before < after);
                    (grow && ends[0] > 0).then_some(ends)
                });
                match self.least(moved, layout.cascades + 1) {
                    Some(better) if better.0 < next.0 => next = better,
                    _ => break,
                }
            }
            layout = next.1;
            if next.0 < least {
                (best, least) = (layout, next.0);
            }
        }
        best
    }

    /// Returns the layout of the least cost, with its cost, among those with one of `all` the ends.
    fn least(
        &self,
        all: impl Iterator<Item = [u8; MAX_CASCADES]>,
        cascades: usize,
    ) -> Option<(f64, Layout)> {
        let mut least: Option<(f64, Layout)> = None;
        for ends in all {
            let mut layout = Layout {
                cascades,
                ends,
                rects: [TexelRect::default(); MAX_CASCADES],
            };
            let Some(rects) = self.rects(&layout) else {
                continue;
            };
            layout.rects = rects;
            let cost = self.cost(&layout);
            if least.is_none_or(|(least, _)| cost < least) {
                least = Some((cost, layout));
            }
        }
        least
    }

    /// Returns what each cascade of a layout covers.
    fn covered(&self, layout: &Layout) -> [Option<Covered>; MAX_CASCADES] {
        let mut all = [None; MAX_CASCADES];
        for (covered, (start, end)) in all.iter_mut().zip(layout.zones()) {
            *covered = self.covered[start][end - 1];
        }
        all
    }

    /// Divides the texels so that the error is least; returns `None` for a layout that too few
    /// samples are known of, or that has no place.
    ///
    /// With square texels, the squared error is `weight * sqrt(area / texels)`, summed over the
    /// cascades. At a given number of texels in all it is least where the derivatives of all
    /// summands by their texels are equal, which gives the shares.
    fn rects(&self, layout: &Layout) -> Option<[TexelRect; MAX_CASCADES]> {
        let covered = self.covered(layout);
        let mut counts = [0; MAX_CASCADES];
        let mut needs = [CascadeNeed::default(); MAX_CASCADES];
        for (need, covered) in needs.iter_mut().zip(&covered) {
            need.size = covered.map_or(DVec2::ZERO, |covered| covered.max - covered.min);
        }
        for sample in self.samples {
            if let Some(cascade) = cascade_of(&covered, sample) {
                needs[cascade].weight += sample.edges / sample.pixel;
                counts[cascade] += 1;
            }
        }
        if counts[..layout.cascades]
            .iter()
            .any(|count| *count < LEAST_SAMPLES)
        {
            return None;
        }
        for need in &mut needs {
            let area = need.size.element_product();
            need.share = (need.weight * area.sqrt()).powf(2.0 / 3.0);
        }
        self.layer.divide(&needs[..layout.cascades])
    }

    /// Returns the root of the mean squared error of visibility, over the pixels of the images,
    /// that is predicted for a layout.
    pub(super) fn error(&self, layout: &Layout) -> f64 {
        let covered = self.covered(layout);
        let texels: [_; MAX_CASCADES] = std::array::from_fn(|cascade| {
            let size = covered[cascade].map_or(DVec2::ZERO, |covered| covered.max - covered.min);
            self.layer.mean_texel(size, layout.rects[cascade].size)
        });
        let wrong = |sample: &Sample| {
            cascade_of(&covered, sample).map_or(0.0, |cascade| {
                let texel = texels[cascade] / sample.pixel;
                sample.edges * texel.min(LARGEST_TEXEL_PIXELS)
            })
        };
        let sum: f64 = self.samples.iter().map(wrong).sum();
        root_mean_error(sum, self.sample_count)
    }

    /// Returns the predicted error with what the number of cascades adds to it, by which layouts
    /// are compared.
    pub(super) fn cost(&self, layout: &Layout) -> f64 {
        self.error(layout) * ERROR_PER_CASCADE.powi(-(layout.cascades as i32))
    }
}

/// Returns the cascade that serves a point: the first that covers it.
fn cascade_of(covered: &[Option<Covered>; MAX_CASCADES], sample: &Sample) -> Option<usize> {
    covered
        .iter()
        .position(|covered| covered.is_some_and(|covered| covered.holds(sample.light)))
}

/// Returns what a cascade over a zone with the receivers `required` would cover, as far as it is in
/// `window`, which holds the receivers of all zones.
fn extent(
    sampled: &Sampled<'_>,
    limits: &FitLimits,
    between: (f64, f64),
    required: &LightBox,
    window: &LightBox,
) -> Extent {
    let input: &FitInput<'_> = sampled.input;
    let cascade = Cascade {
        input,
        limits,
        casters: sampled.casters,
        parts: sampled.parts,
        size_texels: glam::UVec2::splat(limits.map_size),
        seen: sampled.seen,
        between: Some(between),
    };
    let spacing = Spacing::around(input.space.origin, required);
    match cascade.shadows(required, window, spacing) {
        Some(shadows) => Extent {
            required: *required,
            shadows,
        },
        None => Extent::NOTHING,
    }
}
