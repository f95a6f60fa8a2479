//! Samples what cameras see, to predict how wrong the shadows of a layout will be.

use glam::{DVec2, DVec3};

use crate::Aabb;
use crate::fit::axes::LightBox;
use crate::fit::camera::CameraFrustum;
use crate::fit::caster_parts::CasterPart;
use crate::fit::directional_input::FitInput;
use crate::fit::spacing::Spacing;
use crate::fit::sun_casters::SunCasters;
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
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sample {
    /// Is its position across the light.
    pub light: DVec2,
    /// Is the density of shadow edges that is assumed, in pixels of edges per pixel, at most 1; 0
    /// where no shadow can fall.
    pub edges: f64,
    /// Is the world side of a square across the light with the area that a pixel covers there.
    pub pixel: f64,
}

/// Is a point at which a ray may meet a receiver.
struct Hit {
    depth: f64,
    /// Is the outward normal of the side that it meets, if the surface is known to be there.
    normal: Option<DVec3>,
}

/// Holds what is sampled.
pub(crate) struct Sampled<'a> {
    pub input: &'a FitInput<'a>,
    pub seen: &'a [Seen],
    /// Holds the casters that count as a whole.
    pub casters: SunCasters<'a>,
    pub parts: &'a [CasterPart],
}

impl Sampled<'_> {
    /// Replaces `samples` by those of the points at which rays through the images of `cameras` meet
    /// the bounds of what they see. The rays are the same in all frames.
    pub fn take(&self, cameras: &[CameraFrustum], samples: &mut Vec<Sample>) {
        samples.clear();
        let mut outlines = Vec::new();
        let rays = (RAYS / (cameras.len() as u32).max(1)).max(16);
        for round in 0..ROUNDS {
            let indices = || round * rays + 1..=(round + 1) * rays;
            for camera in cameras.iter().enumerate() {
                let mut sample = |index| self.sample(camera, index, &mut outlines);
                samples.extend(indices().filter_map(&mut sample));
            }
            let shadowed = samples.iter().filter(|sample| sample.edges > 0.0);
            if shadowed.count() >= ENOUGH {
                break;
            }
        }
        let logs = samples.iter().map(|sample| sample.pixel.ln()).sum::<f64>();
        let mean_pixel = (logs / samples.len().max(1) as f64).exp();
        for sample in samples.iter_mut().filter(|sample| sample.edges > 0.0) {
            let assumed = MEAN_EDGES * (sample.pixel / mean_pixel).powf(EDGES_EXPONENT);
            sample.edges = sample.edges.max(assumed).min(1.0);
        }
    }

    fn sample(
        &self,
        camera: (usize, &CameraFrustum),
        index: u32,
        outlines: &mut Vec<f64>,
    ) -> Option<Sample> {
        // These are the fractions of the multiples of three irrational numbers, which fill a cube
        // most evenly (Roberts 2018, "The Unreasonable Effectiveness of Quasirandom Sequences").
        const STEPS: DVec3 = DVec3::new(
            0.819_172_513_396_164_4,
            0.671_043_606_703_789_3,
            0.549_700_477_901_970_9,
        );
        let place = (STEPS * f64::from(index)).fract();
        let (start, per_depth) = camera.1.ray(place.truncate());
        let hit = self.hit(camera, (start, per_depth), place.z)?;
        let point = start + per_depth * hit.depth;
        let space = &self.input.space;
        let toward_light = space.axes.toward_light();
        let cosine = |direction: DVec3| match hit.normal {
            None => MEAN_COSINE,
            Some(normal) => normal.dot(direction).abs().max(LEAST_COSINE),
        };
        let height = camera.1.image_height(hit.depth) / IMAGE_HEIGHT_PIXELS;
        let area_factor = cosine(toward_light) / cosine(per_depth.normalize());
        let pixel = height * area_factor.sqrt();
        let facing = match hit.normal {
            Some(normal) if normal.dot(toward_light) < 0.0 => AWAY,
            _ => 1.0,
        };
        let edges = self.edges_per_length(point, toward_light, outlines)?;
        let light = space.point(point);
        (pixel > 0.0 && pixel.is_finite() && light.is_finite()).then_some(Sample {
            light: light.truncate(),
            edges: edges * pixel * facing,
            pixel,
        })
    }

    /// Returns where a ray meets a receiver. `choice`, from 0 to 1, chooses among the places where
    /// it may: flat bounds are met for certain; in others the surface may be anywhere, most likely
    /// toward the end.
    fn hit(
        &self,
        (index, camera): (usize, &CameraFrustum),
        (start, per_depth): (DVec3, DVec3),
        choice: f64,
    ) -> Option<Hit> {
        let (near, far) = camera.depth_range();
        let near = near.max(0.0);
        let inverse = per_depth.recip();
        let seen = || self.seen.iter().filter_map(|seen| seen.bounds_of(index));
        let chord = |bounds: &Aabb| {
            let low = (bounds.min.as_dvec3() - start) * inverse;
            let high = (bounds.max.as_dvec3() - start) * inverse;
            let (enter, leave) = (low.min(high), low.max(high));
            let meets = enter.max_element() <= leave.min_element() && leave.min_element() >= near;
            meets.then_some((enter, leave.min_element()))
        };
        let mut surface: Option<Hit> = None;
        let (mut end, mut end_axis) = (far, 0);
        for bounds in seen().filter(|bounds| is_flat(bounds)) {
            let Some((enter, _)) = chord(bounds) else {
                continue;
            };
            let depth = enter.max_element();
            let axis = enter.max_position();
            // Of several at the same depth, the one across the first axis counts.
            let is_first = depth < end || (depth == end && axis < end_axis);
            if depth >= near && is_first {
                let mut normal = DVec3::ZERO;
                normal[axis] = -per_depth[axis].signum();
                (end, end_axis) = (depth, axis);
                surface = Some(Hit {
                    depth,
                    normal: Some(normal),
                });
            }
        }
        let (mut first, mut last) = (f64::INFINITY, f64::NEG_INFINITY);
        for bounds in seen().filter(|bounds| !is_flat(bounds)) {
            if let Some((enter, leave)) = chord(bounds) {
                let enter = enter.max_element().max(near);
                if enter < end {
                    first = first.min(enter);
                    last = last.max(leave.min(end));
                }
            }
        }
        let within = |choice: f64| {
            (first <= last && last.is_finite()).then(|| Hit {
                depth: first + (last - first) * choice.sqrt(),
                normal: None,
            })
        };
        match surface {
            None => within(choice),
            Some(surface) if choice < 0.5 => Some(surface),
            Some(surface) => Some(within(2.0 * choice - 1.0).unwrap_or(surface)),
        }
    }

    /// Returns the length of the outlines of casters between a point and the light, per area across
    /// the light; 0 where there are none.
    fn edges_per_length(
        &self,
        point: DVec3,
        toward_light: DVec3,
        outlines: &mut Vec<f64>,
    ) -> Option<f64> {
        let inverse = toward_light.recip();
        let least = 1e-6 * point.abs().max_element();
        let shadows = |bounds: &Aabb| {
            let low = (bounds.min.as_dvec3() - point) * inverse;
            let high = (bounds.max.as_dvec3() - point) * inverse;
            let enter = low.min(high).max_element().max(0.0);
            low.max(high).min_element() > enter + least
        };
        let outline =
            |light: &LightBox| 2.0 * (light.max - light.min).truncate().recip().element_sum();
        let place = self.input.space.point(point);
        let place = LightBox {
            min: place,
            max: place,
        };
        let spacing = Spacing::around(self.input.space.origin, &place);
        outlines.clear();
        self.casters.walk(
            spacing,
            outlines,
            |_, around| around.overlaps_xy(&place),
            |outlines, _, bounds, light| {
                if spacing.widest(light).overlaps_xy(&place) && shadows(bounds) {
                    outlines.push(outline(light));
                }
            },
        );
        for part in self.parts.iter().filter(|part| shadows(&part.bounds)) {
            outlines.push(outline(&part.light));
        }
        // Sums depend on the order of what is added.
        outlines.sort_unstable_by(f64::total_cmp);
        let edges = outlines.iter().sum::<f64>();
        edges.is_finite().then_some(edges)
    }
}

/// Returns whether the surface in bounds must be where the bounds are.
fn is_flat(bounds: &Aabb) -> bool {
    let size = bounds.max - bounds.min;
    size.min_element() <= 1e-3 * size.max_element()
}
