//! Defines what an error meter reports.

use glam::{DVec3, Vec3};

use crate::meter::estimate::Estimate;

/// Is a place at which a light's lookup and rays toward the light were compared.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct MeasuredPlace {
    /// Is the world position: that of the receiver, with the origin of its frame.
    pub position_world: DVec3,
    /// Is the receiver's normal, of unit length.
    pub normal: Vec3,
    /// Is the index of the slot of the light, for pools; 0 otherwise.
    pub slot: u32,
    /// Is the visibility that the light's lookup returned, in 0..=1.
    pub visibility: f32,
    /// Is the visibility by rays: 0 or 1, or one half where the light has an extent and one of two
    /// rays was blocked.
    pub visibility_by_rays: f32,
}

impl MeasuredPlace {
    /// Returns the distance between both visibilities, in 0..=1; 1 where the lookup returned none
    /// that is finite.
    pub fn error(&self) -> f32 {
        let error = (self.visibility - self.visibility_by_rays).abs();
        if error.is_finite() { error } else { 1.0 }
    }
}

/// Is the error of a light's shadows, over the places that were given.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct MeasuredError {
    /// Is the root of the mean squared difference between the visibility by the light's lookup and
    /// that by rays, in 0..=1.
    pub rmse: Estimate,
    /// Is the share of light that the lookups take away where rays reach the light: false shadow,
    /// as a mean over all places. For a light with an extent each ray counts by itself, so that a
    /// penumbra counts here and as [`MeasuredError::false_light`], however right it is.
    pub false_shadow: Estimate,
    /// Is the share of light that the lookups leave where rays are blocked: false light, as a mean
    /// over all places.
    pub false_light: Estimate,
    /// Is the number of places of equal weight that the estimates are worth.
    pub samples: f64,
    /// Holds the places with the largest errors among those that are not forgotten, the worst
    /// first, at most [`MeasuredError::MOST_WORST`].
    pub worst: Vec<MeasuredPlace>,
}

impl MeasuredError {
    /// Is the largest number of places in [`MeasuredError::worst`].
    pub const MOST_WORST: usize = 32;
}

/// Tells what an error meter did in a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct MeterReport {
    /// Counts the places that are measured.
    pub places: u32,
    /// Counts the rays that are drawn: one texel each. Those whose answer is known without drawing
    /// are not among them.
    pub rays: u32,
    /// Counts the draw calls.
    pub draws: u32,
    /// Counts the triangles, as far as the casters tell them.
    pub triangles: u64,
    /// Counts the passes: one that draws the rays, and one that asks the light's lookup. It is 0
    /// where the results of so many frames are on their way that this one was left out.
    pub passes: u32,
    /// Counts the receivers that were left out because they face away from the light.
    pub facing_away: u32,
    /// Counts the receivers that were left out because the light does not shine there.
    pub out_of_reach: u32,
    /// Counts the receivers that were left out because the rounding of their rays
    /// ([`MeterReport::largest_blind_height_world`]) exceeds a texel of the light's map there. The
    /// bounds of a caster that extend far beyond the scene are a cause.
    pub unresolved: u32,
    /// Is the largest height, in world units, above a measured surface up to which a ray sees
    /// nothing, so that the surface does not shadow itself by rounding. It is also how far a ray
    /// may be off to its sides. It grows with the distance of the farthest corner of the bounds
    /// that rays meet, by some `20u` of it (1.2 mm per kilometre).
    pub largest_blind_height_world: f64,
}
