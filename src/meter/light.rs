//! Defines the lights that an error meter measures, and where rays toward them lead.

use glam::DVec3;

use crate::check;
use crate::meter::random::Random;
use crate::pool::PoolLight;
use crate::receive::{Selection, ShadowMaps};
use crate::{DirectionalLight, OmniLight, ShadowError, SpotLight};

/// Names the light that the maps of an [`ErrorMeter`](crate::meter::ErrorMeter) were recorded with
/// in this frame.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub enum MeasuredLight<'a> {
    /// Is the light of a [`DirectionalShadow`](crate::DirectionalShadow).
    Directional(&'a DirectionalLight),
    /// Is the light of a [`SpotShadow`](crate::SpotShadow).
    Spot(&'a SpotLight),
    /// Is the light of an [`OmniShadow`](crate::OmniShadow).
    Omni(&'a OmniLight),
    /// Holds the lights of a [`SpotShadowPool`](crate::pool::SpotShadowPool), as they were given to
    /// its `record`. Each place is measured for one of the lights that reach it, at random.
    SpotPool(&'a [PoolLight<SpotLight>]),
    /// Holds the lights of an [`OmniShadowPool`](crate::pool::OmniShadowPool), in the same way.
    OmniPool(&'a [PoolLight<OmniLight>]),
}

/// Is the way from a place toward the middle of a light.
#[derive(Clone, Copy, Debug)]
pub(super) struct TowardLight {
    /// Has unit length.
    pub direction: DVec3,
    /// Is the world distance; infinite for a directional light.
    pub distance: f64,
    /// Is the index of the light's slot in a pool; 0 without one.
    pub slot: u32,
}

impl MeasuredLight<'_> {
    /// Checks the values of the lights, and that they are of the kind that `maps` are of.
    pub(super) fn check(&self, maps: &ShadowMaps) -> Result<(), ShadowError> {
        let sampled = maps.sampled();
        let (kind, selection, indexed) = match self {
            Self::Directional(_) => ("Directional", Selection::Cascades, false),
            Self::Spot(_) => ("Spot", Selection::OneView, false),
            Self::Omni(_) => ("Omni", Selection::CubeFace, false),
            Self::SpotPool(_) => ("SpotPool", Selection::OneView, true),
            Self::OmniPool(_) => ("OmniPool", Selection::CubeFace, true),
        };
        check::in_range(
            "MeasuredLight",
            "of the kind of ErrorMeterDescriptor::maps",
            sampled.selection == selection && sampled.indexed == indexed,
            kind,
        )?;
        let spot = |light: &SpotLight| {
            check::finite_vector("SpotLight::position_world", light.position_world)?;
            check::direction("SpotLight::direction", light.direction.as_dvec3())
        };
        let omni = |light: &OmniLight| {
            check::finite_vector("OmniLight::position_world", light.position_world)
        };
        match self {
            Self::Directional(light) => {
                let direction = light.direction.as_dvec3();
                check::direction("DirectionalLight::direction", direction)
            }
            Self::Spot(light) => spot(light),
            Self::Omni(light) => omni(light),
            Self::SpotPool(lights) => lights.iter().try_for_each(|entry| spot(&entry.light)),
            Self::OmniPool(lights) => lights.iter().try_for_each(|entry| omni(&entry.light)),
        }
    }

    /// Returns the way from a world position to the light, or to one of several that shine there;
    /// `None` where none does.
    pub(super) fn toward(&self, position: DVec3, random: &mut Random) -> Option<TowardLight> {
        match self {
            Self::Directional(light) => Some(TowardLight {
                direction: -light.direction.as_dvec3().normalize(),
                distance: f64::INFINITY,
                slot: 0,
            }),
            Self::Spot(light) => toward_spot(light, 0, position),
            Self::Omni(light) => toward_omni(light, 0, position),
            Self::SpotPool(lights) => one_of(random, lights, |entry| {
                toward_spot(&entry.light, entry.slot.index(), position)
            }),
            Self::OmniPool(lights) => one_of(random, lights, |entry| {
                toward_omni(&entry.light, entry.slot.index(), position)
            }),
        }
    }
}

/// Returns one of the ways to lights, each with the same probability.
fn one_of<L>(
    random: &mut Random,
    lights: &[L],
    toward: impl Fn(&L) -> Option<TowardLight>,
) -> Option<TowardLight> {
    let mut chosen = None;
    for (found, way) in lights.iter().filter_map(toward).enumerate() {
        // Of n, the last is chosen with probability 1/n (reservoir sampling).
        if random.unit() * (found + 1) as f64 <= 1.0 {
            chosen = Some(way);
        }
    }
    chosen
}

fn toward_omni(light: &OmniLight, slot: u32, position: DVec3) -> Option<TowardLight> {
    let way = light.position_world - position;
    let distance = way.length();
    let reaches = distance > 0.0 && distance < f64::from(light.range);
    reaches.then(|| TowardLight {
        direction: way / distance,
        distance,
        slot,
    })
}

fn toward_spot(light: &SpotLight, slot: u32, position: DVec3) -> Option<TowardLight> {
    let omni = OmniLight {
        position_world: light.position_world,
        range: light.range,
    };
    let axis = light.direction.as_dvec3().normalize();
    let cone_cosine = f64::from(light.outer_angle_radians).cos();
    toward_omni(&omni, slot, position).filter(|toward| -toward.direction.dot(axis) > cone_cosine)
}
