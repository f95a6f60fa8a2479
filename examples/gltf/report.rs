//! Writes the report of a run, as JSON.

use example_support::gltf_file::scene::Scene;
use serde_json::{Value, json};
use shadow_support::gpu::Gpu;
use wgpu_shadows::report::ShadowReport;

use crate::lights::SceneLights;
use crate::measure::Times;

/// Returns scene, adapter, what each set of maps did in the last frame, and times.
pub fn report(gpu: &Gpu, scene: &Scene, lights: &SceneLights, times: &Times) -> Value {
    let described: Vec<Value> = lights
        .lights
        .iter()
        .map(|light| {
            json!({
                "kind": format!("{:?}", light.kind),
                "direction": light.direction.to_array(),
            })
        })
        .collect();
    let maps: Vec<Value> = lights
        .reports()
        .map(|(name, report, served)| maps_report(name, report, &served))
        .collect();
    json!({
        "adapter": gpu.adapter.name,
        "backend": gpu.adapter.backend.to_string(),
        "instances": scene.instances.len(),
        "triangles": scene.triangle_count(),
        "lights": described,
        "maps": maps,
        "times": times.to_json(),
    })
}

fn maps_report(name: &str, report: &ShadowReport, lights: &[usize]) -> Value {
    let views: Vec<Value> = report
        .views
        .iter()
        .map(|view| {
            json!({
                "layer": view.layer,
                "texels": [view.texels.min.to_array(), view.texels.size.to_array()],
                "depth_far": view.slice.map(|slice| slice.depth_far),
                "status": format!("{:?}", view.status),
                "casters": view.casters,
                "triangles": view.triangles,
                "culled": view.culled,
                "texel_size_world": view.texel_size_world.to_array(),
                "depth_range_world": view.depth_range_world,
                "max_peter_panning_world": view.max_peter_panning_world,
                "map_utilization": view.slice.map(|slice| slice.map_utilization),
                "texels_across_image": view.slice.map(|slice| slice.texels_across_image.to_array()),
            })
        })
        .collect();
    json!({
        "name": name,
        "lights": lights,
        "views": views,
        "passes": report.passes,
        "predicted_error": report.predicted_error,
        "draws": report.draws(),
        "bytes_held": report.bytes_held,
    })
}
