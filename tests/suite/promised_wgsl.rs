//! Tests that the WGSL has the names that the crate's documentation promises under semver. Shaders
//! such as an engine writes use each of them.

use wgpu_shadows::{Bias, Filter, ShadowBindings, ShadowBindingsDescriptor, shader};

use crate::fixtures::gpu::gpu;
use crate::fixtures::lights::Kind;
use crate::fixtures::wgsl;

/// Asserts that `engine` is valid WGSL after the text of the library.
fn assert_valid(library: String, engine: &str) {
    wgsl::validate(&(library + engine)).unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn emitted_names_are_there() {
    let sun = Kind::Sun {
        cascades: 4,
        blends: false,
    };
    let [sun, lamps] =
        [sun, Kind::Lamps].map(|kind| kind.blank(gpu(), 1, Filter::default(), Bias::Auto));
    let descriptor = ShadowBindingsDescriptor {
        lights: &[("sun", sun.maps()), ("lamps", lamps.maps())],
        ..Default::default()
    };
    let bindings = ShadowBindings::new(&gpu().device, &descriptor).expect("valid bindings");
    let engine = "
fn lit(position: vec3<f32>, camera_position: vec3<f32>, lamp: u32) -> f32 {
    let normal: vec3<f32> = shadow_geometric_normal(position, camera_position - position);
    let sun: f32 = shadow_sun(position, normal);
    let lamps: f32 = shadow_lamps(lamp, position, normal);
    let views: u32 = shadow_view_sun(position) + shadow_view_lamps(lamp, position);
    let layers: u32 = textureNumLayers(shadow_map_sun) + textureNumLayers(shadow_map_lamps);
    let anchors: vec3<f32> = shadow_views_sun[0].anchor + shadow_views_lamps[0].anchor;
    return sun * lamps * f32(views + layers) * anchors.x;
}";
    assert_valid(bindings.wgsl().to_owned(), engine);
}

#[test]
fn names_of_modules_are_there() {
    let filters = [
        "nearest",
        "hardware",
        "box",
        "bilinear",
        "tent3",
        "tent5",
        "tent7",
        "pcss",
        "pcss_rotated",
    ];
    // `compose` writes a module once, even if it is named twice.
    for (access, map) in [
        ("view", "texture_depth_2d_array"),
        ("texels_by_offsets", "texture_depth_2d_array"),
        ("texels_by_samples", "texture_2d_array<f32>"),
    ] {
        let kinds = ["directional", "local"];
        let biases = ["plane", "normal_offset", "manual"];
        for (bias, kind) in biases
            .iter()
            .flat_map(|bias| kinds.map(|kind| (bias, kind)))
        {
            for filter in filters {
                let (map, sampler) = match filter {
                    "hardware" => ("texture_depth_2d_array", "sampler_comparison"),
                    _ => (map, "sampler"),
                };
                let names = [&format!("bias_{bias}"), &format!("filter_{filter}"), access];
                let composed = shader::compose(&names).expect("names of modules");
                let engine = format!(
                    "
@group(1) @binding(0) var map: {map};
@group(1) @binding(1) var map_sampler: {sampler};
@group(1) @binding(2) var<uniform> views: array<ShadowViewUniform, 6>;
fn lit(position: vec3<f32>, normal: vec3<f32>) -> f32 {{
    let receiver: ShadowReceiver = shadow_receiver_{bias}_{kind}(views[1], position, normal);
    let holds: bool = shadow_view_holds(views[1], position);
    var visibility: f32 = shadow_filter_{filter}(map, map_sampler, receiver);
    visibility = shadow_limited_by_depth(views[1], position, visibility);
    visibility = shadow_limited_by_distance(views[1], position, visibility);
    return select(views[1].anchor.x, visibility, receiver.inside && holds);
}}"
                );
                assert_valid(composed, &engine);
            }
        }
    }
    let composed = shader::compose(&["cube_face", "normal"]).expect("names of modules");
    let engine = "
fn face(from_light: vec3<f32>, toward_viewer: vec3<f32>) -> u32 {
    let normal: vec3<f32> = shadow_geometric_normal(from_light, toward_viewer);
    let face: u32 = shadow_cube_face(from_light + normal);
    return face;
}";
    assert_valid(composed, engine);
}
