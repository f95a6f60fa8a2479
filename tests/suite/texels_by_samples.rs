//! Tests that where shaders cannot gather, and the library samples instead, every filter gives the
//! same visibilities, to the bit, as by the gathers that `filter_parity` compares with the CPU
//! reference.

use shadow_support::bind;
use shadow_support::probe::{Point, PointShader};
use wgpu_shadows::shader::{self, MODULES};
use wgpu_shadows::{ShadowBindings, ShadowBindingsDescriptor};

use crate::fixtures::gpu::{Gpu, gpu};
use crate::fixtures::probe::SunProbe;
use crate::fixtures::wgsl;
use crate::suite::filter_parity::{BIASES, Lit, filters, points, scene};

/// Runs the WGSL that `ShadowBindings` emits for the light where there is no gather, with the
/// layout and group that it needs.
fn by_samples(gpu: &Gpu, lit: &Lit, points: &[Point]) -> Vec<f32> {
    let descriptor = ShadowBindingsDescriptor {
        lights: &[("sun", lit.shadow.maps())],
        ..Default::default()
    };
    let bindings = ShadowBindings::new(&gpu.device, &descriptor).expect("valid bindings");
    let source = |name: &str| {
        let mut modules = MODULES.iter().filter(|module| module.name == name);
        modules.next().expect("a module of the table").source
    };
    let map = "var shadow_map_sun: texture_depth_2d_array;";
    for part in [source("texels"), map] {
        assert!(bindings.wgsl().contains(part), "{part}");
    }
    let text = bindings
        .wgsl()
        .replace(source("texels_by_offsets"), source("texel_blocks"))
        .replace(source("texels"), source("texels_by_samples"))
        .replace(map, "var shadow_map_sun: texture_2d_array<f32>;");
    let types = [
        wgpu::BindingType::Sampler(wgpu::SamplerBindingType::NonFiltering),
        bind::UNIFORM,
        wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: false },
            view_dimension: wgpu::TextureViewDimension::D2Array,
            multisampled: false,
        },
    ];
    let layout = bind::layout(gpu, wgpu::ShaderStages::COMPUTE, &types);
    let sampler = gpu.device.create_sampler(&Default::default());
    let resources = [
        wgpu::BindingResource::Sampler(&sampler),
        lit.shadow.maps().uniform_buffer().as_entire_binding(),
        wgpu::BindingResource::TextureView(lit.shadow.maps().texture_view()),
    ];
    let group = bind::group(gpu, &layout, &resources);
    let value = "shadow_sun(point.position, point.normal)";
    PointShader::new(gpu, &text, "f32", value, &layout).ask(gpu, &group, points)
}

#[test]
fn samples_give_what_gathers_give() {
    let gpu = gpu();
    let scene = scene();
    let mut failures = Vec::new();
    for filter in filters().filter(|filter| filter.compares_each_texel()) {
        for bias in BIASES {
            // The size is not a power of two, so that coordinates are rounded on their way to the
            // sampler, and it is much larger than the kernel.
            let map_size = (93.0 + 9.0 * filter.reach_texels()) as u32;
            let lit = Lit::new(gpu, &scene, map_size, filter, bias);
            let points = points(&scene, u64::from(map_size));
            let wanted = SunProbe::new(gpu, &lit.shadow).ask(gpu, &points);
            let seen = by_samples(gpu, &lit, &points);
            let differ = |(wanted, seen): &(&f32, &f32)| wanted.to_bits() != seen.to_bits();
            let different = wanted.iter().zip(&seen).filter(differ).count();
            let dark = wanted.iter().filter(|wanted| **wanted < 0.5).count();
            if different > 0 || dark < points.len() / 20 {
                let count = points.len();
                failures.push(format!(
                    "{filter:?} {bias:?}: {different} of {count} differ, {dark} are dark"
                ));
            }
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// With the module named, no filter that compares each texel gathers any more, and without it
/// nothing samples a map as floats.
#[test]
fn the_module_takes_the_place_of_gathers() {
    let filters: Vec<_> = MODULES
        .iter()
        .map(|module| module.name)
        .filter(|name| name.starts_with("filter_"))
        .collect();
    assert!(filters.len() >= 9, "{filters:?}");
    for name in filters {
        let gathers = shader::compose(&[name]).expect("a module of the table");
        assert!(!gathers.contains("textureSampleLevel("), "{name}");
        let samples = shader::compose(&["texels_by_samples", name]).expect("modules of the table");
        assert!(!samples.contains("textureGather("), "{name}");
        wgsl::validate(&samples).unwrap_or_else(|error| panic!("{name}: {error}"));
    }
}
