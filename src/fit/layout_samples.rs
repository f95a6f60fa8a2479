//! Samples what cameras see, to predict how wrong the shadows of a layout will be.

use std::ops::RangeInclusive;

use glam::{DVec2, DVec3};

use crate::Aabb;
use crate::fit::axes::LightBox;
use crate::fit::camera::CameraFrustum;
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

/// Is the height in pixels of the image for which errors are predicted.
const IMAGE_HEIGHT_PIXELS: f64 = 720.0;

/// Is the density of shadow edges that is assumed for a pixel of mean size, in pixels of edges per
/// pixel: the mean over eight test pictures, which have from 0.005 to 0.045.
const MEAN_EDGES: f64 = 0.02;

/// Is the exponent with which that density grows with the world size of a pixel. It would be 0 if
/// shadows were as detailed as the image everywhere, and 1 if edges were equally dense everywhere
/// in the world.
const EDGES_EXPONENT: f64 = 2.0 / 3.0;

/// Is the factor by which a pixel counts less on a side of a receiver's bounds that faces away from
/// the light: of what lies behind that side, most faces away as well.
const AWAY: f64 = 0.25;

/// Is the least cosine of the angles between a surface and the directions to light and eye that
/// counts.
const LEAST_COSINE: f64 = 0.02;

/// Is the cosine for a surface whose direction is unknown.
const MEAN_COSINE: f64 = 0.5;

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
    rays: Vec<Ray>,
    hits: Vec<Hit>,
    grid: PointGrid,
    outlines: Vec<Outline>,
}

/// Is a ray through a camera's image, with what it has met so far.
#[derive(Clone, Copy, Debug)]
struct Ray {
    /// Is where it passes through the image, from 0 to 1 along x and y.
    place: DVec2,
    /// Chooses among the depths at which it may meet a receiver, from 0 to 1.
    choice: f64,
    start: DVec3,
    per_depth: DVec3,
    /// Is the depth of the nearest flat bounds, or the far end of the camera's view.
    end: f64,
    /// Is the axis across which these bounds are met; the next field is their outward normal.
    end_axis: usize,
    normal: Option<DVec3>,
    /// Is the depth at which the first of the other bounds begin, and at which the last end.
    first: f64,
    last: f64,
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
    /// `cameras` meet the bounds of what they see. The rays are the same in all frames.
    ///
    /// Boxes look for the rays that may meet them, since there are far fewer rays than pairs of a
    /// ray and a box.
    pub fn take(&self, cameras: &[CameraFrustum], scratch: &mut SampleScratch) {
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
            let assumed = MEAN_EDGES * (sample.pixel / mean_pixel).powf(EDGES_EXPONENT);
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
        rays.clear();
        rays.extend(indices.map(|index| Ray::new(camera, index)));
        grid.fill(rays.iter().map(|ray| ray.place));
        let (near, _) = camera.depth_range();
        let near = near.max(0.0);
        let seen = || self.seen.iter().filter_map(|seen| seen.bounds_of(index));
        for bounds in seen().filter(|bounds| is_flat(bounds)) {
            let (min, max) = camera.image_rect(bounds);
            for ray in grid.near(min, max) {
                rays[ray].meet_flat(bounds, near);
            }
        }
        for bounds in seen().filter(|bounds| !is_flat(bounds)) {
            let (min, max) = camera.image_rect(bounds);
            for ray in grid.near(min, max) {
                rays[ray].meet_solid(bounds, near);
            }
        }
        hits.clear();
        hits.extend(rays.iter().filter_map(|ray| self.hit(camera, ray)));
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

    /// Returns where a ray meets a receiver, with no edges.
    fn hit(&self, camera: &CameraFrustum, ray: &Ray) -> Option<Hit> {
        let (depth, normal) = ray.depth_and_normal()?;
        let render = ray.start + ray.per_depth * depth;
        let space = &self.input.space;
        let toward_light = space.axes.toward_light();
        let cosine = |direction: DVec3| match normal {
            None => MEAN_COSINE,
            Some(normal) => normal.dot(direction).abs().max(LEAST_COSINE),
        };
        let height = camera.image_height(depth) / IMAGE_HEIGHT_PIXELS;
        let area_factor = cosine(toward_light) / cosine(ray.per_depth.normalize());
        let pixel = height * area_factor.sqrt();
        let facing = match normal {
            Some(normal) if normal.dot(toward_light) < 0.0 => AWAY,
            _ => 1.0,
        };
        let light = space.point(render).truncate();
        (pixel > 0.0 && pixel.is_finite() && light.is_finite()).then_some(Hit {
            render,
            sample: Sample {
                light,
                edges: 0.0,
                pixel,
            },
            counted_pixel: pixel * facing,
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

impl Ray {
    /// Makes the ray at `index` of those that are spread over the image.
    fn new(camera: &CameraFrustum, index: u32) -> Self {
        // These are the fractions of the multiples of three irrational numbers, which fill a cube
        // most evenly (Roberts 2018, "The Unreasonable Effectiveness of Quasirandom Sequences").
        const STEPS: DVec3 = DVec3::new(
            0.819_172_513_396_164_4,
            0.671_043_606_703_789_3,
            0.549_700_477_901_970_9,
        );
        let place = (STEPS * f64::from(index)).fract();
        let (start, per_depth) = camera.ray(place.truncate());
        Self {
            place: place.truncate(),
            choice: place.z,
            start,
            per_depth,
            end: camera.depth_range().1,
            end_axis: 0,
            normal: None,
            first: f64::INFINITY,
            last: f64::NEG_INFINITY,
        }
    }

    /// Returns, for each axis, the depth at which the ray enters the slab of the bounds, and the
    /// depth at which it leaves them; `None` where it does not meet them beyond `near`.
    fn chord(&self, bounds: &Aabb, near: f64) -> Option<(DVec3, f64)> {
        let inverse = self.per_depth.recip();
        let low = (bounds.min.as_dvec3() - self.start) * inverse;
        let high = (bounds.max.as_dvec3() - self.start) * inverse;
        let (enter, leave) = (low.min(high), low.max(high));
        let meets = enter.max_element() <= leave.min_element() && leave.min_element() >= near;
        meets.then_some((enter, leave.min_element()))
    }

    /// Ends the ray where it meets flat bounds, which the surface fills.
    fn meet_flat(&mut self, bounds: &Aabb, near: f64) {
        let Some((enter, _)) = self.chord(bounds, near) else {
            return;
        };
        let (depth, axis) = (enter.max_element(), enter.max_position());
        // Of several at the same depth, the one across the first axis counts.
        let is_first = depth < self.end || (depth == self.end && axis < self.end_axis);
        if depth >= near && is_first {
            let mut normal = DVec3::ZERO;
            normal[axis] = -self.per_depth[axis].signum();
            (self.end, self.end_axis) = (depth, axis);
            self.normal = Some(normal);
        }
    }

    /// Extends the depths at which the surface in other bounds may be met, up to the end.
    fn meet_solid(&mut self, bounds: &Aabb, near: f64) {
        if let Some((enter, leave)) = self.chord(bounds, near) {
            let enter = enter.max_element().max(near);
            if enter < self.end {
                self.first = self.first.min(enter);
                self.last = self.last.max(leave.min(self.end));
            }
        }
    }

    /// Returns the depth at which the ray meets a receiver, with the normal of the side that it
    /// meets if the surface is known to be there. In bounds that are not flat the surface may be
    /// anywhere, most likely toward the end.
    fn depth_and_normal(&self) -> Option<(f64, Option<DVec3>)> {
        let within = |choice: f64| {
            let (first, last) = (self.first, self.last);
            (first <= last && last.is_finite())
                .then(|| (first + (last - first) * choice.sqrt(), None))
        };
        let Some(normal) = self.normal else {
            return within(self.choice);
        };
        let surface = (self.end, Some(normal));
        if self.choice < 0.5 {
            return Some(surface);
        }
        within(2.0 * self.choice - 1.0).or(Some(surface))
    }
}

/// Returns whether the surface in bounds must be where the bounds are.
fn is_flat(bounds: &Aabb) -> bool {
    let size = bounds.max - bounds.min;
    size.min_element() <= 1e-3 * size.max_element()
}
