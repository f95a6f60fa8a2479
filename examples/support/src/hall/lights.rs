//! Defines where the lights are, what they look like, and how some of them move.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use wgpu_shadows::{OmniLight, SpotLight};

pub const SPOTS: usize = 4;
pub const LAMPS: usize = 32;

/// Points toward the sun, through the skylight.
pub const TOWARD_SUN: Vec3 = Vec3::new(0.28, 1.0, 0.22);

/// Mirrors `Light` in `lights.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Default, Pod, Zeroable)]
pub struct LightUniform {
    place: Vec3,
    range: f32,
    color: Vec3,
    /// Is that of a spot light's cone; -1 for a point light.
    cone_cosine: f32,
    direction: Vec3,
    padding: f32,
}

/// Is a spot light with its appearance.
#[derive(Clone, Copy)]
pub struct Spot {
    pub place: Vec3,
    direction: Vec3,
    color: Vec3,
    pub moves: bool,
}

/// Is a point light with its appearance.
#[derive(Clone, Copy)]
pub struct Lamp {
    pub place: Vec3,
    pub color: Vec3,
    pub moves: bool,
}

const SPOT_RANGE: f32 = 9.0;
const SPOT_OUTER_ANGLE_RADIANS: f32 = 0.55;
const LAMP_RANGE: f32 = 3.6;

/// Holds the lights of a frame.
pub struct Lights {
    pub spots: [Spot; SPOTS],
    pub lamps: [Lamp; LAMPS],
}

impl Lights {
    /// Returns the lights at `time`, in steps of a fifth of a second or so.
    pub fn at(time: f32) -> Self {
        Self {
            spots: std::array::from_fn(|index| spot(index, time)),
            lamps: std::array::from_fn(|index| lamp(index, time)),
        }
    }

    /// Returns the lights as the shader reads them: spot lights, then point lights.
    pub fn uniforms(&self) -> Vec<LightUniform> {
        let spots = self.spots.iter().map(|spot| LightUniform {
            place: spot.place,
            range: SPOT_RANGE,
            color: spot.color,
            cone_cosine: SPOT_OUTER_ANGLE_RADIANS.cos(),
            direction: spot.direction.normalize(),
            padding: 0.0,
        });
        let lamps = self.lamps.iter().map(|lamp| LightUniform {
            place: lamp.place,
            range: LAMP_RANGE,
            color: lamp.color,
            cone_cosine: -1.0,
            ..Default::default()
        });
        spots.chain(lamps).collect()
    }
}

impl Spot {
    /// Returns the light as the library takes it.
    pub fn light(&self) -> SpotLight {
        SpotLight {
            position_world: self.place.as_dvec3(),
            direction: self.direction,
            outer_angle_radians: SPOT_OUTER_ANGLE_RADIANS,
            range: SPOT_RANGE,
        }
    }
}

impl Lamp {
    /// Returns the light as the library takes it.
    pub fn light(&self) -> OmniLight {
        OmniLight {
            position_world: self.place.as_dvec3(),
            range: LAMP_RANGE,
        }
    }
}

/// Returns one of four under the ceiling; the first swings.
fn spot(index: usize, time: f32) -> Spot {
    let places = [[-3.4, 2.6], [3.6, -2.7], [-7.6, -2.6], [6.4, 2.7]];
    let targets = [[-2.5, 0.3], [3.0, -0.8], [-6.6, -1.2], [4.6, 0.9]];
    let place = Vec3::new(places[index][0], 5.6, places[index][1]);
    let moves = index == 0;
    let swing = if moves { 0.5 * (time * 0.6).sin() } else { 0.0 };
    let target = Vec3::new(targets[index][0] + swing, 0.4, targets[index][1]);
    Spot {
        place,
        direction: target - place,
        color: Vec3::new(0.85, 0.80, 0.70),
        moves,
    }
}

/// Returns one of eight by four in the hall; every sixth moves in a circle.
fn lamp(index: usize, time: f32) -> Lamp {
    let (column, row) = (index % 8, index / 8);
    let mut place = Vec3::new(
        column as f32 * 3.0 - 10.5,
        [1.5, 0.9, 1.1, 1.7][row] + 0.25 * (index as f32 * 1.7).sin(),
        [-5.8, -2.2, 2.4, 5.8][row] + 0.4 * (index as f32 * 2.3).cos(),
    );
    let moves = index % 6 == 5;
    if moves {
        let angle = index as f32 + time * 0.5;
        place += Vec3::new(angle.cos(), 0.0, angle.sin()) * 0.5;
    }
    let colors = [
        [1.00, 0.55, 0.25],
        [0.35, 0.60, 1.00],
        [0.55, 1.00, 0.50],
        [1.00, 0.35, 0.50],
        [0.95, 0.85, 0.45],
    ];
    Lamp {
        place,
        color: Vec3::from_array(colors[index % 5]),
        moves,
    }
}
