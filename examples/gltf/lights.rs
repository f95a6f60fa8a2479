//! The scene's shadows, and the WGSL that asks them.

use std::fmt::Write;

use glam::Vec3;
use serde_json::{Value, json};
use wgpu_shadows::{
    Coverage, DirectionalFrame, DirectionalLight, DirectionalShadow, DirectionalShadowDescriptor,
    OmniFrame, OmniLight, OmniShadow, OmniShadowDescriptor, ShadowBindings,
    ShadowBindingsDescriptor, ShadowCaster, ShadowReport, ShadowSource, SpotFrame, SpotLight,
    SpotShadow, SpotShadowDescriptor,
};

use crate::device::Gpu;
use crate::measure::Times;
use crate::options::Options;
use crate::scene::{Light, LightKind, Scene};

/// Lights that the shader loops over.
pub const MAX_LIGHTS: usize = 8;

/// A light's shadow maps.
enum Shadow {
    Directional(Box<DirectionalShadow>),
    Spot(Box<SpotShadow>),
    Omni(Box<OmniShadow>),
}

impl Shadow {
    fn source(&self) -> ShadowSource<'_> {
        match self {
            Self::Directional(shadow) => shadow.source(),
            Self::Spot(shadow) => shadow.source(),
            Self::Omni(shadow) => shadow.source(),
        }
    }

    fn report(&self) -> &ShadowReport {
        match self {
            Self::Directional(shadow) => shadow.report(),
            Self::Spot(shadow) => shadow.report(),
            Self::Omni(shadow) => shadow.report(),
        }
    }
}

/// Lights of the scene with the shadows of those that have some.
pub struct SceneLights {
    pub lights: Vec<Light>,
    shadows: Vec<Option<Shadow>>,
    pub bindings: ShadowBindings,
    /// `visibility_of_light(index, position, normal)`.
    pub wgsl: String,
    max_distance: f32,
}

/// Mirror of `Light` in `shade.wgsl`.
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
    padding: [f32; 3],
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
        let shadows = lights
            .iter()
            .map(|light| shadow_of(gpu, light, options))
            .collect::<Result<Vec<_>, _>>()?;
        let names: Vec<String> = (0..lights.len()).map(light_name).collect();
        let sources: Vec<(&str, ShadowSource<'_>)> = names
            .iter()
            .zip(&shadows)
            .filter_map(|(name, shadow)| Some((name.as_str(), shadow.as_ref()?.source())))
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
        let wgsl = visibility_of_light(&sources, &names);
        Ok(Self {
            lights,
            shadows,
            bindings,
            wgsl,
            max_distance: options.max_distance,
        })
    }

    /// Records the depth passes of all lights.
    pub fn record(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        scene: &Scene,
        casters: &[&dyn ShadowCaster],
    ) -> Result<(), String> {
        let camera = scene.camera.with_max_distance(self.max_distance);
        for (light, shadow) in self.lights.iter().zip(&mut self.shadows) {
            let Some(shadow) = shadow else { continue };
            let position_world = scene.origin + light.position_render.as_dvec3();
            match shadow {
                Shadow::Directional(shadow) => shadow.record(
                    &gpu.device,
                    encoder,
                    &DirectionalFrame {
                        origin: scene.origin,
                        light: DirectionalLight::new(light.direction),
                        coverage: Coverage::Camera(camera),
                        casters,
                        receivers: &[],
                    },
                ),
                Shadow::Spot(shadow) => shadow.record(
                    &gpu.device,
                    encoder,
                    &SpotFrame {
                        origin: scene.origin,
                        light: SpotLight {
                            position_world,
                            direction: light.direction,
                            outer_angle_radians: light.kind.outer_angle_radians(),
                            range: light.range,
                        },
                        camera: Some(camera),
                        casters,
                        receivers: &[],
                    },
                ),
                Shadow::Omni(shadow) => shadow.record(
                    &gpu.device,
                    encoder,
                    &OmniFrame {
                        origin: scene.origin,
                        light: OmniLight {
                            position_world,
                            range: light.range,
                        },
                        camera: Some(camera),
                        casters,
                        receivers: &[],
                    },
                ),
            }
            .map_err(|error| error.to_string())?;
        }
        Ok(())
    }

    /// Makes the next frame draw every map anew.
    pub fn invalidate(&mut self) {
        for shadow in self.shadows.iter_mut().flatten() {
            match shadow {
                Shadow::Directional(shadow) => shadow.invalidate(),
                Shadow::Spot(shadow) => shadow.invalidate(),
                Shadow::Omni(shadow) => shadow.invalidate(),
            }
        }
    }

    pub fn uniforms(&self) -> [LightUniform; MAX_LIGHTS] {
        let mut uniforms = [LightUniform::default(); MAX_LIGHTS];
        for (uniform, light) in uniforms.iter_mut().zip(&self.lights) {
            // Outside a directional or point light's non-existent cone, scale 0 and offset 1 let everything through.
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
                padding: [0.0; 3],
            };
        }
        uniforms
    }

    /// Brings the brightest light to an irradiance of one at the middle of the scene.
    pub fn exposure(&self, scene: &Scene) -> f32 {
        let bounds = scene.bounds_render();
        let middle = (bounds.min + bounds.max) * 0.5;
        let brightest = self
            .lights
            .iter()
            .map(|light| {
                let share = match light.kind {
                    LightKind::Directional => 1.0,
                    _ => 1.0 / (middle - light.position_render).length_squared().max(1e-6),
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

    /// The lights' reports and the times, for `--report`.
    pub fn report_json(&self, gpu: &Gpu, scene: &Scene, times: &Times) -> Value {
        let vector = |v: Vec3| json!([v.x, v.y, v.z]);
        let lights: Vec<Value> = self
            .lights
            .iter()
            .zip(&self.shadows)
            .map(|(light, shadow)| {
                json!({
                    "kind": format!("{:?}", light.kind),
                    "direction": vector(light.direction),
                    "shadow": shadow.as_ref().map(|shadow| report_value(shadow.report())),
                })
            })
            .collect();
        json!({
            "adapter": gpu.adapter_info.name,
            "backend": gpu.adapter_info.backend.to_string(),
            "instances": scene.instances.len(),
            "triangles": scene.triangle_count(),
            "lights": lights,
            "times": times.to_json(),
        })
    }
}

fn shadow_of(gpu: &Gpu, light: &Light, options: &Options) -> Result<Option<Shadow>, String> {
    if options.no_shadows {
        return Ok(None);
    }
    let (device, map_size) = (&gpu.device, options.map_size);
    let (filter, bias) = (options.filter, options.bias);
    let made = match light.kind {
        LightKind::Directional => {
            let descriptor = DirectionalShadowDescriptor {
                label: Some("sun"),
                map_size,
                cascades: options.cascades,
                filter,
                bias,
                ..Default::default()
            };
            DirectionalShadow::new(device, &descriptor)
                .map(|shadow| Shadow::Directional(Box::new(shadow)))
        }
        LightKind::Spot { .. } => {
            let label = Some("spot");
            let descriptor = SpotShadowDescriptor {
                label,
                map_size,
                filter,
                bias,
            };
            SpotShadow::new(device, &descriptor).map(|shadow| Shadow::Spot(Box::new(shadow)))
        }
        LightKind::Point => {
            let label = Some("lamp");
            let descriptor = OmniShadowDescriptor {
                label,
                map_size,
                filter,
                bias,
            };
            OmniShadow::new(device, &descriptor).map(|shadow| Shadow::Omni(Box::new(shadow)))
        }
    };
    made.map(Some).map_err(|error| error.to_string())
}

/// `light_a`, `light_b` and so on.
fn light_name(index: usize) -> String {
    format!("light_{}", (b'a' + index as u8) as char)
}

fn visibility_of_light(sources: &[(&str, ShadowSource<'_>)], names: &[String]) -> String {
    let mut text =
        "fn visibility_of_light(index: u32, position: vec3<f32>, normal: vec3<f32>) -> f32 {\n    switch index {\n".to_owned();
    for (index, name) in names.iter().enumerate() {
        if sources.iter().any(|(shadowed, _)| shadowed == name) {
            // Writing to a String does not fail.
            let _ = writeln!(
                text,
                "        case {index}u: {{ return shadow_{name}(position, normal); }}"
            );
        }
    }
    text + "        default: { return 1.0; }\n    }\n}\n"
}

fn report_value(report: &ShadowReport) -> Value {
    let views: Vec<Value> = report
        .views
        .iter()
        .map(|view| {
            json!({
                "layer": view.layer,
                "status": format!("{:?}", view.status),
                "casters": view.casters,
                "culled": view.culled,
                "texel_size_world": [view.texel_size_world.x, view.texel_size_world.y],
                "depth_range_world": view.depth_range_world,
                "worst_gap_world": view.worst_gap_world,
            })
        })
        .collect();
    json!({
        "views": views,
        "passes": report.passes,
        "draws": report.draws(),
        "bytes_held": report.bytes_held,
    })
}
