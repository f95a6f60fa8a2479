//! Owns the lights of the scene with their shadows, and records these.

use example_support::gltf_file::scene::{Light, LightKind, Scene};
use shadow_support::gpu::Gpu;
use wgpu_shadows::{
    Casters, Coverage, DirectionalLight, OmniLight, ShadowBindings, ShadowBindingsDescriptor,
    ShadowCaster, ShadowFrameDescriptor, ShadowMaps, ShadowScene, SpotLight, pool::PoolLight,
    pool::ShadowSlot, report::ShadowReport,
};

use crate::maps::{Maps, make_maps, visibility_of_light};
use crate::options::Options;

/// Is the number of lights that the shader loops over at most.
pub const MAX_LIGHTS: usize = 256;

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
