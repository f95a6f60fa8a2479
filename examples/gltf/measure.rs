//! Measures the times of the shadow passes and of the shading pass over a number of frames.

use std::time::Instant;

use serde_json::{Value, json};
use wgpu_shadows::ShadowCaster;

use crate::casters::SceneCaster;
use crate::device::Gpu;
use crate::geometry::Geometry;
use crate::lights::SceneLights;
use crate::options::Options;
use crate::render::Renderer;
use crate::scene::Scene;

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

/// Renders the frames; the last one stays in the renderer's targets. Every frame draws every map again, so that there
/// is something to measure.
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
    let timer = Timer::new(gpu);
    let mut times = Times {
        timer: if gpu.timestamps {
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
        times
            .shadow_passes
            .push(timer.time(gpu, |encoder| lights.record(encoder, scene, &casters))?);
        times.shading_pass.push(timer.time(gpu, |encoder| {
            renderer.shade(encoder, geometry, lights);
            Ok(())
        })?);
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

/// Writes timestamps around commands where the device has them, and otherwise uses the wall clock around submission and
/// completion.
struct Timer {
    queries: Option<(wgpu::QuerySet, wgpu::Buffer)>,
}

impl Timer {
    fn new(gpu: &Gpu) -> Self {
        let queries = gpu.timestamps.then(|| {
            let set = gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("times"),
                ty: wgpu::QueryType::Timestamp,
                count: 2,
            });
            let resolved = gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("times"),
                size: 16,
                usage: wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
                mapped_at_creation: false,
            });
            (set, resolved)
        });
        Self { queries }
    }

    /// Returns the milliseconds that the recorded commands take.
    fn time(
        &self,
        gpu: &Gpu,
        record: impl FnOnce(&mut wgpu::CommandEncoder) -> Result<(), String>,
    ) -> Result<f64, String> {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let Some((set, resolved)) = &self.queries else {
            record(&mut encoder)?;
            gpu.wait()?;
            let start = Instant::now();
            gpu.queue.submit([encoder.finish()]);
            gpu.wait()?;
            return Ok(start.elapsed().as_secs_f64() * 1e3);
        };
        encoder.write_timestamp(set, 0);
        record(&mut encoder)?;
        encoder.write_timestamp(set, 1);
        encoder.resolve_query_set(set, 0..2, resolved, 0);
        let readable = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("times read back"),
            size: 16,
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        encoder.copy_buffer_to_buffer(resolved, 0, &readable, 0, 16);
        gpu.queue.submit([encoder.finish()]);
        let bytes = gpu.read_buffer(&readable)?;
        let ticks: &[u64] = bytemuck::cast_slice(&bytes);
        let period = f64::from(gpu.queue.get_timestamp_period());
        Ok(ticks[1].saturating_sub(ticks[0]) as f64 * period * 1e-6)
    }
}
