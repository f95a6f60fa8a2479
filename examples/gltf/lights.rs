//! Owns the scene's shadows, and the WGSL that samples them: a `DirectionalShadow` for each sun,
//! an `OmniShadow` for a point light that is alone, and pools for spots and for several point
//! lights.

use std::fmt::Write;

use example_support::gltf_file::scene::{Light, LightKind, Scene};
use shadow_support::gpu::Gpu;
use wgpu_shadows::{
    Casters, Coverage, DirectionalLight, DirectionalShadow, DirectionalShadowDescriptor, OmniLight,
    OmniShadow, OmniShadowDescriptor, ShadowBindings, ShadowBindingsDescriptor, ShadowCaster,
    ShadowFrameDescriptor, ShadowMaps, ShadowScene, SpotLight, pool::OmniShadowPool,
    pool::PoolDescriptor, pool::PoolLight, pool::ShadowSlot, pool::SpotShadowPool,
    report::ShadowReport,
};

use crate::options::Options;

/// Is the number of lights that the shader loops over at most.
pub const MAX_LIGHTS: usize = 256;
/// Is the largest number of directional lights with shadows, each of which needs a texture of its
/// own.
const MAX_SUNS: usize = 4;
/// Is the number of local lights in one pool: 40 times six faces have 60 KB of uniforms, within
/// WebGPU's defaults.
const POOL_CAPACITY: usize = 40;

/// Is a set of maps, and the lights of the scene that it belongs to.
enum Maps {
    Sun {
        shadow: Box<DirectionalShadow>,
        light: usize,
    },
    Lamp {
        shadow: Box<OmniShadow>,
        light: usize,
    },
    Spots {
        pool: Box<SpotShadowPool>,
        slots: Vec<(ShadowSlot, usize)>,
    },
    Lamps {
        pool: Box<OmniShadowPool>,
        slots: Vec<(ShadowSlot, usize)>,
    },
}

impl Maps {
    fn source(&self) -> &ShadowMaps {
        match self {
            Self::Sun { shadow, .. } => shadow.maps(),
            Self::Lamp { shadow, .. } => shadow.maps(),
            Self::Spots { pool, .. } => pool.maps(),
            Self::Lamps { pool, .. } => pool.maps(),
        }
    }

    fn report(&self) -> &ShadowReport {
        self.source().report()
    }

    /// Returns the lights of the scene, with their index in the pool.
    fn lights(&self) -> Vec<(usize, u32)> {
        match self {
            Self::Sun { light, .. } | Self::Lamp { light, .. } => vec![(*light, 0)],
            Self::Spots { slots, .. } | Self::Lamps { slots, .. } => slots
                .iter()
                .map(|(slot, light)| (*light, slot.index()))
                .collect(),
        }
    }
}

/// Holds the lights of the scene with their shadows.
pub struct SceneLights {
    pub lights: Vec<Light>,
    shadow_scene: ShadowScene,
    maps: Vec<(String, Maps)>,
    pub bindings: ShadowBindings,
    /// Defines `visibility_of_light(maps, index, position, normal)`.
    pub wgsl: String,
    max_distance: f32,
}

/// Mirrors `Light` in `shade.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Default, bytemuck::Pod, bytemuck::Zeroable)]
pub struct LightUniform {
    intensity: [f32; 3],
    local: u32,
    direction: [f32; 3],
    range: f32,
    position: [f32; 3],
    cone_scale: f32,
    cone_offset: f32,
    /// Is the number of its maps, counted from 1; 0 for a light without shadows.
    maps: u32,
    /// Is its index in a pool.
    index: u32,
    padding: f32,
}

impl SceneLights {
    pub fn new(gpu: &Gpu, scene: &Scene, options: &Options) -> Result<Self, String> {
        let mut lights = scene.lights.clone();
        if lights.len() > MAX_LIGHTS {
            eprintln!(
                "note: the first {MAX_LIGHTS} of {} lights are used",
                lights.len()
            );
            lights.truncate(MAX_LIGHTS);
        }
        let maps = if options.no_shadows {
            Vec::new()
        } else {
            make_maps(gpu, &lights, options)?
        };
        let sources: Vec<(&str, &ShadowMaps)> = maps
            .iter()
            .map(|(name, maps)| (name.as_str(), maps.source()))
            .collect();
        let bindings = ShadowBindings::new(
            &gpu.device,
            &ShadowBindingsDescriptor {
                label: Some("shadows"),
                group: 1,
                lights: &sources,
                ..Default::default()
            },
        )
        .map_err(|error| error.to_string())?;
        let wgsl = visibility_of_light(&maps);
        Ok(Self {
            lights,
            shadow_scene: ShadowScene::new(),
            maps,
            bindings,
            wgsl,
            max_distance: options.max_distance,
        })
    }

    /// Records the depth passes of all lights.
    pub fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        scene: &Scene,
        casters: &[&dyn ShadowCaster],
    ) -> Result<(), String> {
        let camera = scene.camera.with_max_distance(self.max_distance);
        let frame = self
            .shadow_scene
            .frame(&ShadowFrameDescriptor {
                origin: scene.origin,
                coverage: Coverage::Cameras(&[camera]),
                casters: Casters::List(casters),
                receivers: &[],
            })
            .map_err(|error| error.to_string())?;
        let lights = &self.lights;
        let lamp = |light: &Light| OmniLight {
            position_world: scene.origin + light.position_render.as_dvec3(),
            range: light.range,
        };
        for (_, maps) in &mut self.maps {
            let recorded = match maps {
                Maps::Sun { shadow, light } => {
                    let sun = DirectionalLight::new(lights[*light].direction);
                    shadow.record(encoder, &frame, &sun)
                }
                Maps::Lamp { shadow, light } => {
                    shadow.record(encoder, &frame, &lamp(&lights[*light]))
                }
                Maps::Spots { pool, slots } => {
                    let spot = |light: &Light| SpotLight {
                        position_world: scene.origin + light.position_render.as_dvec3(),
                        direction: light.direction,
                        outer_angle_radians: light.kind.outer_angle_radians(),
                        range: light.range,
                    };
                    pool.record(encoder, &frame, &listed(slots, lights, spot), None)
                }
                Maps::Lamps { pool, slots } => {
                    pool.record(encoder, &frame, &listed(slots, lights, lamp), None)
                }
            };
            recorded.map_err(|error| error.to_string())?;
        }
        Ok(())
    }

    /// Makes the next frame draw every map again.
    pub fn invalidate(&mut self) {
        for (_, maps) in &mut self.maps {
            match maps {
                Maps::Sun { shadow, .. } => shadow.invalidate(),
                Maps::Lamp { shadow, .. } => shadow.invalidate(),
                Maps::Spots { pool, .. } => pool.invalidate(),
                Maps::Lamps { pool, .. } => pool.invalidate(),
            }
        }
    }

    /// Returns each set of maps with its report and the lights that it belongs to.
    pub fn reports(&self) -> impl Iterator<Item = (&str, &ShadowReport, Vec<usize>)> {
        self.maps.iter().map(|(name, maps)| {
            let lights = maps.lights().into_iter().map(|(light, _)| light).collect();
            (name.as_str(), maps.report(), lights)
        })
    }

    pub fn uniforms(&self) -> Vec<LightUniform> {
        let mut uniforms = vec![LightUniform::default(); MAX_LIGHTS];
        for (uniform, light) in uniforms.iter_mut().zip(&self.lights) {
            // Without a cone, scale 0 and offset 1 pass all light.
            let (cone_scale, cone_offset) = match light.kind {
                LightKind::Spot {
                    inner_cone_radians,
                    outer_cone_radians,
                } => {
                    let (inner, outer) = (inner_cone_radians.cos(), outer_cone_radians.cos());
                    let scale = 1.0 / (inner - outer).max(1e-3);
                    (scale, -outer * scale)
                }
                _ => (0.0, 1.0),
            };
            *uniform = LightUniform {
                intensity: light.intensity.to_array(),
                local: u32::from(light.kind != LightKind::Directional),
                direction: light.direction.to_array(),
                range: light.range.min(1e18),
                position: light.position_render.to_array(),
                cone_scale,
                cone_offset,
                ..Default::default()
            };
        }
        for (number, (_, maps)) in (1..).zip(&self.maps) {
            for (light, index) in maps.lights() {
                uniforms[light].maps = number;
                uniforms[light].index = index;
            }
        }
        uniforms
    }

    /// Returns the exposure that brings the brightest light to an irradiance of one at the middle
    /// of the scene, or, for a light in the middle, at a quarter of the scene's radius.
    pub fn exposure(&self, scene: &Scene) -> f32 {
        let bounds = scene.bounds_render();
        let middle = (bounds.min + bounds.max) * 0.5;
        let least = (bounds.max - bounds.min).length() * 0.125;
        let brightest = self
            .lights
            .iter()
            .map(|light| {
                let share = match light.kind {
                    LightKind::Directional => 1.0,
                    _ => {
                        let distance = (middle - light.position_render).length();
                        distance.max(least).max(1e-6).powi(-2)
                    }
                };
                light.intensity.max_element() * share
            })
            .fold(0.0, f32::max);
        if brightest > 0.0 {
            1.0 / brightest
        } else {
            1.0
        }
    }
}

fn listed<L>(
    slots: &[(ShadowSlot, usize)],
    lights: &[Light],
    convert: impl Fn(&Light) -> L,
) -> Vec<PoolLight<L>> {
    slots
        .iter()
        .map(|(slot, light)| PoolLight {
            slot: *slot,
            light: convert(&lights[*light]),
            importance: 1.0,
        })
        .collect()
}

/// Makes maps for suns one by one, for a point light that is alone, and for spots and several point
/// lights in pools.
/// Names end in a letter, as the library requires.
fn make_maps(
    gpu: &Gpu,
    lights: &[Light],
    options: &Options,
) -> Result<Vec<(String, Maps)>, String> {
    let of_kind = |wanted: fn(&LightKind) -> bool| -> Vec<usize> {
        (0..lights.len())
            .filter(|&light| wanted(&lights[light].kind))
            .collect()
    };
    let suns = of_kind(|kind| *kind == LightKind::Directional);
    let spots = of_kind(|kind| matches!(kind, LightKind::Spot { .. }));
    let lamps = of_kind(|kind| *kind == LightKind::Point);
    if suns.len() > MAX_SUNS {
        eprintln!(
            "note: {} of {} directional lights have shadows",
            MAX_SUNS,
            suns.len()
        );
    }
    // All lights of a pool share its texels. A few lamps may be as fine as a sun.
    let local_map_size = options.map_size.unwrap_or(4096);
    let letter = |number: usize| (b'a' + number as u8) as char;
    let mut maps = Vec::new();
    for (number, &light) in suns.iter().take(MAX_SUNS).enumerate() {
        let shadow = DirectionalShadow::new(
            &gpu.device,
            &DirectionalShadowDescriptor {
                label: Some("sun"),
                map_size: options.map_size.unwrap_or(2048),
                layout: options.layout(),
                filter: options.sun_filter(),
                bias: options.bias,
                ..Default::default()
            },
        )
        .map_err(|error| error.to_string())?;
        let shadow = Box::new(shadow);
        maps.push((
            format!("sun_{}", letter(number)),
            Maps::Sun { shadow, light },
        ));
    }
    let descriptor = |label, lights: &[usize]| PoolDescriptor {
        label: Some(label),
        capacity: lights.len() as u32,
        map_size: local_map_size,
        filter: options.local_filter(),
        bias: options.bias,
        ..Default::default()
    };
    for (number, lights) in spots.chunks(POOL_CAPACITY).enumerate() {
        let mut pool = SpotShadowPool::new(&gpu.device, &descriptor("spots", lights))
            .map_err(|error| error.to_string())?;
        let slots = take_slots(lights, || pool.insert())?;
        let pool = Box::new(pool);
        maps.push((
            format!("spots_{}", letter(number)),
            Maps::Spots { pool, slots },
        ));
    }
    if let [light] = lamps[..] {
        let default = OmniShadowDescriptor::default();
        let descriptor = OmniShadowDescriptor {
            label: Some("lamp"),
            map_size: options.map_size.unwrap_or(default.map_size),
            filter: options.local_filter(),
            bias: options.bias,
            ..default
        };
        let shadow =
            OmniShadow::new(&gpu.device, &descriptor).map_err(|error| error.to_string())?;
        let shadow = Box::new(shadow);
        maps.push(("lamp_a".to_owned(), Maps::Lamp { shadow, light }));
        return Ok(maps);
    }
    for (number, lights) in lamps.chunks(POOL_CAPACITY).enumerate() {
        let mut pool = OmniShadowPool::new(&gpu.device, &descriptor("lamps", lights))
            .map_err(|error| error.to_string())?;
        let slots = take_slots(lights, || pool.insert())?;
        let pool = Box::new(pool);
        maps.push((
            format!("lamps_{}", letter(number)),
            Maps::Lamps { pool, slots },
        ));
    }
    Ok(maps)
}

fn take_slots(
    lights: &[usize],
    mut insert: impl FnMut() -> Result<ShadowSlot, wgpu_shadows::ShadowError>,
) -> Result<Vec<(ShadowSlot, usize)>, String> {
    lights
        .iter()
        .map(|&light| Ok((insert().map_err(|error| error.to_string())?, light)))
        .collect()
}

fn visibility_of_light(maps: &[(String, Maps)]) -> String {
    let mut text = "fn visibility_of_light(maps: u32, index: u32, position: vec3<f32>, normal: vec3<f32>) -> f32 {\n    switch maps {\n".to_owned();
    for (number, (name, maps)) in (1..).zip(maps) {
        let index = match maps {
            Maps::Sun { .. } | Maps::Lamp { .. } => "",
            Maps::Spots { .. } | Maps::Lamps { .. } => "index, ",
        };
        // Writing to a String does not fail.
        let _ = writeln!(
            text,
            "        case {number}u: {{ return shadow_{name}({index}position, normal); }}"
        );
    }
    text + "        default: { return 1.0; }\n    }\n}\n"
}
