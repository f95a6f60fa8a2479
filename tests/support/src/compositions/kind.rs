//! Emits the WGSL of lights of every kind.

use std::error::Error;

use wgpu_shadows::pool::{OmniShadowPool, PoolDescriptor, SpotShadowPool};
use wgpu_shadows::{
    Bias, CascadeLayout, DirectionalShadow, DirectionalShadowDescriptor, Filter, OmniShadow,
    OmniShadowDescriptor, ShadowBindings, ShadowBindingsDescriptor, ShadowMaps, SpotShadow,
    SpotShadowDescriptor,
};

use crate::gpu::Gpu;

/// Is a kind of light, with what changes the WGSL of its lookups.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// Is a sun with that many cascades, of which one ends where the next begins.
    Sun(u32),
    /// Is a sun with that many cascades, which blend into each other.
    Blended(u32),
    Spot {
        fade: f32,
    },
    Point {
        fade: f32,
    },
    /// Is a pool of spot lights.
    Spots {
        fade: f32,
    },
    /// Is a pool of point lights.
    Points {
        fade: f32,
    },
}

impl Kind {
    /// Lists kinds of every different text.
    pub const EVERY: [Self; 13] = [
        Self::Sun(1),
        Self::Sun(2),
        Self::Sun(4),
        Self::Sun(8),
        Self::Blended(4),
        Self::Spot { fade: 0.0 },
        Self::Spot { fade: 0.2 },
        Self::Point { fade: 0.0 },
        Self::Point { fade: 0.2 },
        Self::Spots { fade: 0.0 },
        Self::Spots { fade: 0.2 },
        Self::Points { fade: 0.0 },
        Self::Points { fade: 0.2 },
    ];

    /// Returns its name as in tables.
    pub fn name(self) -> String {
        let fading = |name: &str, fade| {
            let suffix = if fade > 0.0 { "_fading" } else { "" };
            format!("{name}{suffix}")
        };
        match self {
            Self::Sun(cascades) => format!("sun_{cascades}"),
            Self::Blended(cascades) => format!("sun_{cascades}_blended"),
            Self::Spot { fade } => fading("spot", fade),
            Self::Point { fade } => fading("point", fade),
            Self::Spots { fade } => fading("spot_pool", fade),
            Self::Points { fade } => fading("point_pool", fade),
        }
    }

    /// Returns whether the kind accepts direction-space filters.
    pub fn has_cube(self) -> bool {
        matches!(self, Self::Point { .. } | Self::Points { .. })
    }
}

/// Is how a light is sampled.
pub type Sampling = (Filter, Bias);

/// Reads the index of a pool's light from a uniform, as in a loop over the lights of a tile.
const POOL_INDEX: &str = "
@group(0) @binding(0) var<uniform> light_index: vec4<u32>;
";

/// Returns the WGSL of a light of this kind with a function `visibility`.
pub fn one_light(gpu: &Gpu, kind: Kind, sampling: Sampling) -> Result<String, Box<dyn Error>> {
    let light = Light::new(gpu, kind, sampling)?;
    let wgsl = emitted(gpu, &[("light", light.maps())])?;
    let (declaration, index) = match kind {
        Kind::Spots { .. } | Kind::Points { .. } => (POOL_INDEX, "light_index.x, "),
        _ => ("", ""),
    };
    let value = format!("shadow_light({index}position, normal)");
    Ok(wgsl + declaration + &visibility(&value))
}

/// Returns the WGSL of two lights, neither of them a pool, with a function `visibility` of both.
pub fn two_lights(gpu: &Gpu, lights: [(Kind, Sampling); 2]) -> Result<String, Box<dyn Error>> {
    let [sun, lamp] = lights.map(|(kind, sampling)| Light::new(gpu, kind, sampling));
    let (sun, lamp) = (sun?, lamp?);
    let wgsl = emitted(gpu, &[("sun", sun.maps()), ("lamp", lamp.maps())])?;
    let value = "shadow_sun(position, normal) + shadow_lamp(position, normal)";
    Ok(wgsl + &visibility(value))
}

fn visibility(value: &str) -> String {
    format!(
        "
fn visibility(position: vec3<f32>, normal: vec3<f32>) -> f32 {{
    return {value};
}}
"
    )
}

fn emitted(gpu: &Gpu, lights: &[(&str, &ShadowMaps)]) -> Result<String, Box<dyn Error>> {
    let descriptor = ShadowBindingsDescriptor {
        lights,
        ..Default::default()
    };
    let bindings = ShadowBindings::new(&gpu.device, &descriptor)?;
    Ok(bindings.wgsl().to_owned())
}

/// Owns the maps of a light.
enum Light {
    Sun(Box<DirectionalShadow>),
    Spot(SpotShadow),
    Point(OmniShadow),
    Spots(SpotShadowPool),
    Points(OmniShadowPool),
}

impl Light {
    fn new(gpu: &Gpu, kind: Kind, (filter, bias): Sampling) -> Result<Self, Box<dyn Error>> {
        let device = &gpu.device;
        // The size of the map does not change the shader.
        let map_size = 16;
        let sun = |cascades, blend| {
            let descriptor = DirectionalShadowDescriptor {
                map_size,
                layout: CascadeLayout::fixed(cascades),
                blend,
                filter,
                bias,
                ..Default::default()
            };
            DirectionalShadow::new(device, &descriptor)
        };
        let pool = |fade| PoolDescriptor {
            capacity: 16,
            map_size,
            filter,
            bias,
            fade,
            ..Default::default()
        };
        Ok(match kind {
            Kind::Sun(cascades) => Self::Sun(Box::new(sun(cascades, 0.0)?)),
            Kind::Blended(cascades) => Self::Sun(Box::new(sun(cascades, 0.1)?)),
            Kind::Spot { fade } => {
                let descriptor = SpotShadowDescriptor {
                    map_size,
                    filter,
                    bias,
                    fade,
                    ..Default::default()
                };
                Self::Spot(SpotShadow::new(device, &descriptor)?)
            }
            Kind::Point { fade } => {
                let descriptor = OmniShadowDescriptor {
                    map_size,
                    filter,
                    bias,
                    fade,
                    ..Default::default()
                };
                Self::Point(OmniShadow::new(device, &descriptor)?)
            }
            Kind::Spots { fade } => Self::Spots(SpotShadowPool::new(device, &pool(fade))?),
            Kind::Points { fade } => Self::Points(OmniShadowPool::new(device, &pool(fade))?),
        })
    }

    fn maps(&self) -> &ShadowMaps {
        match self {
            Self::Sun(light) => light.maps(),
            Self::Spot(light) => light.maps(),
            Self::Point(light) => light.maps(),
            Self::Spots(light) => light.maps(),
            Self::Points(light) => light.maps(),
        }
    }
}
