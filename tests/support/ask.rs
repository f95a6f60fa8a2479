//! Samples any set of lights through `ShadowBindings`, and records their frames.

use wgpu_shadows::{
    OmniShadow, ShadowBindings, ShadowBindingsDescriptor, ShadowError, ShadowMaps, SpotShadow,
    report::ShadowReport,
};

use crate::support::frames::{OmniFrame, RecordFrame, SpotFrame};
use crate::support::gpu::Gpu;
use crate::support::probe::{Point, PointShader};

/// Holds a bind group for a set of lights and a shader that samples them. It remains valid in every frame of the
/// lights.
pub struct Ask {
    bindings: ShadowBindings,
    shader: PointShader,
}

impl Ask {
    /// Makes the shader. `value` is a WGSL expression over `point.position` and `point.normal` that calls the lights'
    /// functions.
    pub fn new(gpu: &Gpu, lights: &[(&str, &ShadowMaps)], value: &str) -> Self {
        let descriptor = ShadowBindingsDescriptor {
            visibility: wgpu::ShaderStages::COMPUTE,
            lights,
            ..Default::default()
        };
        let bindings = ShadowBindings::new(&gpu.device, &descriptor).expect("valid bindings");
        let shader = PointShader::new(gpu, bindings.wgsl(), "f32", value, bindings.layout());
        Self { bindings, shader }
    }

    /// Samples one light by itself.
    pub fn light(gpu: &Gpu, source: &ShadowMaps) -> Self {
        let value = "shadow_light(point.position, point.normal)";
        Self::new(gpu, &[("light", source)], value)
    }

    /// Samples the light in slot `index` of a pool.
    pub fn slot(gpu: &Gpu, pool: &ShadowMaps, index: u32) -> Self {
        let value = format!("shadow_lights({index}u, point.position, point.normal)");
        Self::new(gpu, &[("lights", pool)], &value)
    }

    /// Returns the visibility from each point under the maps of the last submitted frame.
    pub fn points(&self, gpu: &Gpu, points: &[Point]) -> Vec<f32> {
        self.shader.ask(gpu, self.bindings.bind_group(), points)
    }
}

/// Records a frame with `record` and submits it, or submits an empty encoder where the frame is refused.
pub fn submitted<'a>(
    gpu: &Gpu,
    record: impl FnOnce(&mut wgpu::CommandEncoder) -> Result<&'a ShadowReport, ShadowError>,
) -> Result<ShadowReport, ShadowError> {
    let mut encoder = gpu.encoder();
    let report = record(&mut encoder).cloned();
    gpu.submit(encoder);
    report
}

/// Records and submits a frame of a point light.
pub fn record_omni(
    gpu: &Gpu,
    shadow: &mut OmniShadow,
    frame: &OmniFrame<'_>,
) -> Result<ShadowReport, ShadowError> {
    submitted(gpu, |encoder| shadow.record_frame(encoder, frame))
}

/// Records and submits a frame of a spot light.
pub fn record_spot(
    gpu: &Gpu,
    shadow: &mut SpotShadow,
    frame: &SpotFrame<'_>,
) -> Result<ShadowReport, ShadowError> {
    submitted(gpu, |encoder| shadow.record_frame(encoder, frame))
}
