//! Reads kiss3d's collection of lights.

use glam::Vec3;
use kiss3d::prelude::{CollectedLight, LightType};

use crate::object::vec3;

/// Is a light as shaders and shadows need it.
#[derive(Clone, Copy)]
pub struct Light {
    pub kind: Kind,
    pub position: Vec3,
    pub direction: Vec3,
    /// Is colour times intensity.
    pub color: Vec3,
    pub range: f32,
    /// Are the angles from the axis of a cone, in radians, where the light begins to fade and where
    /// it ends.
    pub cone: [f32; 2],
    pub casts: bool,
}

#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    Sun,
    Spot,
    Lamp,
}

impl From<&CollectedLight> for Light {
    fn from(light: &CollectedLight) -> Self {
        let (kind, range, cone) = match light.light_type {
            LightType::Directional(_) => (Kind::Sun, f32::INFINITY, [0.0; 2]),
            LightType::Point { attenuation_radius } => (Kind::Lamp, attenuation_radius, [0.0; 2]),
            LightType::Spot {
                inner_cone_angle,
                outer_cone_angle,
                attenuation_radius,
            } => (
                Kind::Spot,
                attenuation_radius,
                [inner_cone_angle, outer_cone_angle],
            ),
        };
        Self {
            kind,
            position: vec3(light.world_position),
            direction: vec3(light.world_direction),
            color: vec3(light.color * light.intensity),
            range,
            cone,
            casts: light.casts_shadows,
        }
    }
}
