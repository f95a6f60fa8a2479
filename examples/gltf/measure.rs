//! Measures the times of the shadow passes and of the shading pass over a number of frames.

use example_support::gltf_file::scene::Scene;
use serde_json::{Value, json};
use shadow_support::{clock::Clock, gpu::Gpu};
use wgpu_shadows::ShadowCaster;

use crate::casters::SceneCaster;
use crate::geometry::Geometry;
use crate::lights::SceneLights;
use crate::options::Options;
use crate::render::Renderer;

/// Holds milliseconds per frame.
pub struct Times {
    timer: &'static str,
    shadow_passes: Vec<f64>,
    shading_pass: Vec<f64>,
}

impl Times {
    pub fn to_json(&self) -> Value {
        json!({
            "timer": self.timer,
            "shadow_passes_ms": summary(&self.shadow_passes),
            "shading_pass_ms": summary(&self.shading_pass),
        })
    }
}

/// Renders the frames; the last one stays in the renderer's targets. Every frame draws every map
/// again, so that there is something to measure.
pub fn frames(
    gpu: &Gpu,
    scene: &Scene,
    geometry: &Geometry,
    casters: &[SceneCaster<'_>],
    lights: &mut SceneLights,
    renderer: &Renderer,
    options: &Options,
) -> Result<Times, String> {
    let casters: Vec<&dyn ShadowCaster> = casters.iter().map(|c| c as &dyn ShadowCaster).collect();
    let clock = Clock::new(gpu);
    let mut times = Times {
        timer: if gpu.has_timestamps {
            "timestamps"
        } else {
            "wall clock"
        },
        shadow_passes: Vec::new(),
        shading_pass: Vec::new(),
    };
    renderer.write_uniforms(gpu, scene, lights);
    for _ in 0..options.frames {
        lights.invalidate();
        let shadows = clock.try_seconds(|encoder| lights.record(encoder, scene, &casters))?;
        let shading = clock.try_seconds(|encoder| {
            renderer.shade(encoder, geometry, lights);
            Ok(())
        })?;
        times.shadow_passes.push(1e3 * shadows);
        times.shading_pass.push(1e3 * shading);
    }
    Ok(times)
}

/// Returns the median and the spread (the middle half of the frames).
fn summary(times: &[f64]) -> Value {
    let mut sorted = times.to_vec();
    sorted.sort_by(f64::total_cmp);
    let quantile = |share: f64| {
        let last = sorted.len().saturating_sub(1);
        sorted.get((last as f64 * share).round() as usize)
    };
    json!({
        "frames": times.len(),
        "median": quantile(0.5),
        "lower_quartile": quantile(0.25),
        "upper_quartile": quantile(0.75),
    })
}
