//! Samples what cameras see, to predict how wrong the shadows of a layout will be.

use std::ops::RangeInclusive;

use glam::{DVec2, DVec3};

use crate::Aabb;
use crate::fit::axes::LightBox;
use crate::fit::camera::CameraFrustum;
use crate::fit::camera_rays::{CameraRays, RayHit, assumed_edges};
use crate::fit::caster_parts::CasterPart;
use crate::fit::directional_casters::DirectionalCasters;
use crate::fit::directional_input::FitInput;
use crate::fit::point_grid::PointGrid;
use crate::fit::spacing::Spacing;
use crate::fit::visible::Seen;

/// Is the number of rays in a round, which all cameras of a frame share.
const RAYS: u32 = 320;

/// Is the number of points on which shadows can fall that suffice.
const ENOUGH: usize = 128;

/// Is the largest number of rounds that are made for these points, where casters are small in the
/// images.
const ROUNDS: u32 = 4;

/// Is a visible point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sample {
    /// Is its position across the light.
    pub light: DVec2,
    /// Is the density of shadow edges that is assumed, in pixels of edges per pixel, at most 1; 0
    /// where no shadow can fall.
    pub edges: f64,
    /// Is the world side of a square across the light with the area that a pixel covers there.
    pub pixel: f64,
}

/// Holds lists that are reused from prediction to prediction.
#[derive(Debug, Default)]
pub(crate) struct SampleScratch {
    /// Holds what was sampled last.
    pub samples: Vec<Sample>,
    rays: CameraRays,
    hits: Vec<Hit>,
    grid: PointGrid,
    outlines: Vec<Outline>,
}

/// Is a point at which a ray may meet a receiver.
#[derive(Clone, Copy, Debug)]
struct Hit {
    render: DVec3,
    /// Holds the rest of the sample. Its density of edges is that of a pixel of size 1.
    sample: Sample,
    /// Is the size of the pixel as far as it counts.
    counted_pixel: f64,
}

/// Is the outline of a caster between a point and the light.
#[derive(Clone, Copy, Debug)]
struct Outline {
    /// Is the index of the point.
    hit: usize,
    /// Is the length of the outline, per area across the light.
    length: f64,
}

/// Holds what is sampled.
pub(crate) struct Sampled<'a> {
    pub input: &'a FitInput<'a>,
    pub seen: &'a [Seen],
    /// Holds the casters that count as a whole.
    pub casters: DirectionalCasters<'a>,
    pub parts: &'a [CasterPart],
}

impl Sampled<'_> {
    /// Replaces `scratch.samples` by those of the points at which rays through the images of
    /// `cameras` meet the bounds of what they see.
    pub(super) fn take(&self, cameras: &[CameraFrustum], scratch: &mut SampleScratch) {
        scratch.samples.clear();
        let rays = (RAYS / (cameras.len() as u32).max(1)).max(16);
        for round in 0..ROUNDS {
            for camera in cameras.iter().enumerate() {
                self.sample(camera, round * rays + 1..=(round + 1) * rays, scratch);
            }
            let shadowed = scratch.samples.iter().filter(|sample| sample.edges > 0.0);
            if shadowed.count() >= ENOUGH {
                break;
            }
        }
        let samples = &mut scratch.samples;
        let logs = samples.iter().map(|sample| sample.pixel.ln()).sum::<f64>();
        let mean_pixel = (logs / samples.len().max(1) as f64).exp();
        for sample in samples.iter_mut().filter(|sample| sample.edges > 0.0) {
            let assumed = assumed_edges(sample.pixel, mean_pixel);
            sample.edges = sample.edges.max(assumed).min(1.0);
        }
    }

    /// Adds the samples of some rays of a camera.
    fn sample(
        &self,
        (index, camera): (usize, &CameraFrustum),
        indices: RangeInclusive<u32>,
        scratch: &mut SampleScratch,
    ) {
        let SampleScratch {
            samples,
            rays,
            hits,
            grid,
            outlines,
        } = scratch;
        let seen = || self.seen.iter().filter_map(|seen| seen.bounds_of(index));
        let met = rays.cast(camera, indices, seen);
        hits.clear();
        hits.extend(met.filter_map(|met| self.hit(&met)));
        grid.fill(hits.iter().map(|hit| hit.sample.light));
        self.add_edges(hits, grid, outlines);
        samples.extend(hits.iter().filter_map(|hit| {
            let edges = hit.sample.edges.is_finite();
            edges.then_some(Sample {
                edges: hit.sample.edges * hit.counted_pixel,
                ..hit.sample
            })
        }));
    }

    /// Returns a point at which a ray meets a receiver, with no edges.
    fn hit(&self, met: &RayHit) -> Option<Hit> {
        let space = &self.input.space;
        let toward_light = space.axes.toward_light();
        let pixel = met.pixel_across(toward_light);
        let light = space.point(met.render).truncate();
        (pixel > 0.0 && pixel.is_finite() && light.is_finite()).then_some(Hit {
            render: met.render,
            sample: Sample {
                light,
                edges: 0.0,
                pixel,
            },
            counted_pixel: pixel * met.facing(toward_light),
        })
    }

    /// Adds to each point the length of the outlines of casters between it and the light, per area
    /// across the light. `grid` holds the points across the light.
    fn add_edges(&self, hits: &mut [Hit], grid: &PointGrid, outlines: &mut Vec<Outline>) {
        if hits.is_empty() {
            return;
        }
        let space = &self.input.space;
        let inverse = space.axes.toward_light().recip();
        let shadows = |bounds: &Aabb, point: DVec3| {
            let least = 1e-6 * point.abs().max_element();
            let low = (bounds.min.as_dvec3() - point) * inverse;
            let high = (bounds.max.as_dvec3() - point) * inverse;
            let enter = low.min(high).max_element().max(0.0);
            low.max(high).min_element() > enter + least
        };
        let mut window = LightBox::EMPTY;
        for hit in hits.iter() {
            window.include(hit.sample.light.extend(0.0));
        }
        let spacing = Spacing::around(space.origin, &window);
        outlines.clear();
        let find = |outlines: &mut Vec<Outline>, bounds: &Aabb, light: &LightBox| {
            let around = spacing.widest(light);
            let length = 2.0 * (light.max - light.min).truncate().recip().element_sum();
            let near = grid.near(around.min.truncate(), around.max.truncate());
            let shadowed = near.filter(|hit| shadows(bounds, hits[*hit].render));
            outlines.extend(shadowed.map(|hit| Outline { hit, length }));
        };
        self.casters.walk(
            spacing,
            outlines,
            |_, around| around.overlaps_xy(&window),
            |outlines, _, bounds, light| find(outlines, bounds, light),
        );
        for part in self.parts {
            find(outlines, &part.bounds, &part.light);
        }
        // Sums depend on the order of what is added, and casters come in any order.
        outlines.sort_unstable_by(|a, b| {
            let lengths = a.length.total_cmp(&b.length);
            a.hit.cmp(&b.hit).then(lengths)
        });
        for outline in outlines {
            hits[outline.hit].sample.edges += outline.length;
        }
    }
}
