//! Estimates how many texels the views of local lights need, from what cameras see of the receivers
//! on which shadows of these lights can fall.

use glam::{DVec2, DVec3};

use crate::Aabb;
use crate::fit::axes::LightAxes;
use crate::fit::camera::CameraFrustum;
use crate::fit::camera_rays::{CameraRays, RayHit, assumed_edges};
use crate::fit::local_input::MAX_LOCAL_VIEWS;
use crate::fit::reached::ReachedCaster;
use crate::fit::visible::{Receivers, SeenLists};

/// Is the number of rays through the images, which all cameras of a frame share.
const RAYS: u32 = 2048;

/// Is the least number of rays of a camera.
const LEAST_RAYS: u32 = 64;

/// Holds the points that cameras see, and the memory to find them.
#[derive(Debug, Default)]
pub(crate) struct LocalNeeds {
    points: Vec<RayHit>,
    /// Is the mean world height of a pixel at these points.
    mean_height: f64,
    rays: CameraRays,
    lists: SeenLists,
}

/// Describes a light to the estimate.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LightShape<'a> {
    /// Is in render space.
    pub position: DVec3,
    pub range: f64,
    /// Holds the axes of each view, which looks against its z axis.
    pub views: &'a [LightAxes],
    /// Is the tangent of half the angle over which a view has receivers.
    pub tangent: f64,
    /// Is the cosine of the half-angle of the cone; -2 if there is no cone.
    pub cone_cosine: f64,
}

/// Is what is seen of the receivers of a view.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ViewNeed {
    /// Is the squared error that a texel adds whose side is one in tangents: the sum, over the
    /// points, of the density of shadow edges times the reciprocal of a pixel's side in tangents.
    pub weight: f64,
    /// Is the sum of these densities.
    pub edges: f64,
    /// Counts the points on which the light shines, whether shadows can fall on them or not.
    pub points: u32,
}

impl ViewNeed {
    /// Returns the need, or an earlier one that has shrunk since, whichever is larger.
    pub(crate) fn or_shrunk(self, earlier: &Self, factor: f64) -> Self {
        let weight = earlier.weight * factor;
        if weight > self.weight {
            return Self { weight, ..*earlier };
        }
        self
    }
}

impl LocalNeeds {
    /// Counts the points that the cameras see.
    pub(crate) fn points(&self) -> usize {
        self.points.len()
    }

    /// Finds what the cameras see of the receivers.
    pub(crate) fn look(&mut self, cameras: &[CameraFrustum], receivers: Receivers<'_>) {
        let Self {
            points,
            mean_height,
            rays,
            lists,
        } = self;
        points.clear();
        lists.find(cameras, receivers);
        let count = (RAYS / (cameras.len() as u32).max(1)).max(LEAST_RAYS);
        for (index, camera) in cameras.iter().enumerate() {
            let seen = || lists.seen.iter().filter_map(|seen| seen.bounds_of(index));
            let met = rays.cast(camera, 1..=count, seen);
            points.extend(met.filter(|met| {
                met.render.is_finite() && met.height > 0.0 && met.height.is_finite()
            }));
        }
        let logs = points.iter().map(|point| point.height.ln()).sum::<f64>();
        *mean_height = (logs / points.len().max(1) as f64).exp();
    }

    /// Returns whether a camera sees anything on which a light may shine.
    pub(crate) fn any_within(&self, position: DVec3, range: f64) -> bool {
        let mut points = self.points.iter();
        points.any(|point| point.render.distance_squared(position) < range * range)
    }

    /// Returns what is seen of the receivers of each view of a light, given the casters that it
    /// reaches.
    pub(crate) fn of(
        &self,
        light: &LightShape<'_>,
        casters: &[ReachedCaster],
    ) -> [ViewNeed; MAX_LOCAL_VIEWS] {
        let mut needs = [ViewNeed::default(); MAX_LOCAL_VIEWS];
        let middles = casters
            .iter()
            .map(|caster| Outlined::new(&caster.bounds, light));
        let outlined: Vec<Outlined> = middles.collect();
        for point in &self.points {
            let from_light = point.render - light.position;
            let distance = from_light.length();
            if !(distance < light.range && distance > 0.0) {
                continue;
            }
            let toward_light = -from_light / distance;
            let place = |axes: &LightAxes| {
                let local = axes.light_from_world * from_light;
                let tangents = local.truncate() / -local.z;
                let cosine = -local.z / distance;
                let inside = local.z < 0.0
                    && tangents.abs().max_element() <= light.tangent
                    && cosine > light.cone_cosine;
                inside.then_some(-local.z)
            };
            let places = light.views.iter().map(place).enumerate();
            let Some((view, along_axis)) = places
                .filter_map(|(view, along_axis)| Some((view, along_axis?)))
                .next()
            else {
                continue;
            };
            let Some(need) = needs.get_mut(view) else {
                continue;
            };
            need.points += 1;
            let pixel = point.pixel_across(toward_light);
            let densities = outlined
                .iter()
                .filter_map(|caster| caster.density_over(point.render, light.position, distance));
            // In the shadow of several casters, only the outline of the largest is seen.
            let density = densities.fold(f64::INFINITY, f64::min);
            if !(density > 0.0 && density.is_finite() && pixel > 0.0 && pixel.is_finite()) {
                continue;
            }
            let counted = density * pixel * point.facing(toward_light);
            let edges = counted.max(assumed_edges(pixel, self.mean_height)).min(1.0);
            need.edges += edges;
            need.weight += edges * along_axis / pixel;
        }
        needs
    }
}

/// Is a caster whose outline may lie between a light and a point.
#[derive(Clone, Copy, Debug)]
struct Outlined {
    min: DVec3,
    max: DVec3,
    /// Is the length of its outline per area, as seen from the light: both in tangents.
    density: f64,
}

impl Outlined {
    fn new(bounds: &Aabb, light: &LightShape<'_>) -> Self {
        let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
        let half = (max - min) * 0.5;
        let middle = (min + max) * 0.5 - light.position;
        let distance = middle
            .length()
            .max(half.min_element())
            .max(f64::MIN_POSITIVE);
        let (right, up) = (-middle / distance)
            .try_normalize()
            .map_or((DVec3::X, DVec3::Y), |toward| toward.any_orthonormal_pair());
        let across = |axis: DVec3| axis.abs().dot(half) * 2.0 / distance;
        let size = DVec2::new(across(right), across(up)).min(DVec2::splat(2.0));
        Self {
            min,
            max,
            density: 2.0 * size.recip().element_sum(),
        }
    }

    /// Returns the length of the outline per world area at a point, if the bounds are between the
    /// point and the light.
    fn density_over(&self, point: DVec3, light: DVec3, distance: f64) -> Option<f64> {
        let inverse = (light - point).recip();
        let low = (self.min - point) * inverse;
        let high = (self.max - point) * inverse;
        let enter = low.min(high).max_element().max(0.0);
        let leave = low.max(high).min_element().min(1.0);
        // What is left of the bounds next to the point itself is rounding.
        (leave > enter + 1e-5).then(|| self.density / distance)
    }
}
