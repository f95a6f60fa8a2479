//! Passes any names, groups, stages, modules, formats and images to the bindings and debug views.

use proptest::prelude::*;
use wgpu_shadows::{
    OmniShadow, OmniShadowDescriptor, ShadowBindings, ShadowBindingsDescriptor, debug::DebugImage,
    debug::DebugView, pool::OmniShadowPool, pool::PoolDescriptor, pool::SpotShadowPool, shader,
};

use super::fuzz_values::{Counts, matrix, run};
use super::stage::Sun;
use crate::fixtures::gpu::gpu;
use crate::fixtures::picture::{color_pass, color_target};
use crate::fixtures::wgsl;

/// Generates letters, digits and underscores, a few of the library's own names, and any text.
fn name() -> impl Strategy<Value = String> {
    prop_oneof![
        6 => "[a-z][a-z0-9_]{0,6}[a-z]",
        2 => "[a-z_0-9]{0,5}",
        1 => prop::sample::select(vec!["plane", "gather", "map_sun", "views_a", "point_sampler", "fn", "var", "array", "select", "loop"]).prop_map(str::to_owned),
        1 => any::<String>(),
    ]
}

/// Any names, group, stages and lights give a bind group whose WGSL compiles, or an error; any
/// modules give a composition that compiles, or an error.
#[test]
fn any_bindings_are_taken_or_refused() {
    let gpu = gpu();
    let counts = Counts::default();
    let sun = Sun::of_size(4);
    let descriptor = OmniShadowDescriptor {
        map_size: 4,
        ..Default::default()
    };
    let lamp = OmniShadow::new(&gpu.device, &descriptor).expect("a lamp");
    let descriptor = PoolDescriptor {
        map_size: 4,
        capacity: 2,
        ..Default::default()
    };
    let pool = SpotShadowPool::new(&gpu.device, &descriptor).expect("a pool");
    let sources = [sun.shadow.maps(), lamp.maps(), pool.maps()];
    let group = prop_oneof![4 => 0..4_u32, 1 => any::<u32>()];
    let lights = prop::collection::vec((name(), 0..3_usize), 0..4);
    let known: Vec<_> = shader::MODULES
        .iter()
        .map(|module| module.name.to_owned())
        .collect();
    let module = prop_oneof![8 => prop::sample::select(known), 1 => name()];
    let all = (lights, group, 0..8_u32, prop::collection::vec(module, 0..5));
    run(200, all, |(lights, group, stages, modules)| {
        let lights: Vec<_> = lights
            .iter()
            .map(|(name, kind)| (name.as_str(), sources[*kind]))
            .collect();
        let descriptor = ShadowBindingsDescriptor {
            label: None,
            group,
            visibility: wgpu::ShaderStages::from_bits_truncate(stages),
            lights: &lights,
        };
        let result = ShadowBindings::new(&gpu.device, &descriptor);
        counts.count(&result);
        if let Ok(bindings) = result {
            let valid = wgsl::validate(bindings.wgsl());
            prop_assert!(
                valid.is_ok(),
                "{:?}: {:?}",
                lights.iter().map(|l| l.0).collect::<Vec<_>>(),
                valid.err()
            );
        }
        let modules: Vec<_> = modules.iter().map(String::as_str).collect();
        let result = shader::compose(&modules);
        counts.count(&result);
        Ok(())
    });
    counts.finish(
        "any names, groups, stages and lights of a bind group, any list of modules",
        "WGSL that compiles or an error, no panic, no device error",
    );
}

/// Any target format and image is drawn, or refused.
#[test]
fn any_debug_picture_is_drawn_or_refused() {
    use wgpu::TextureFormat as F;
    let gpu = gpu();
    let counts = Counts::default();
    let sun = Sun::of_size(8);
    let descriptor = OmniShadowDescriptor {
        map_size: 8,
        ..Default::default()
    };
    let lamp = OmniShadow::new(&gpu.device, &descriptor).expect("a lamp");
    let descriptor = PoolDescriptor {
        map_size: 8,
        capacity: 2,
        ..Default::default()
    };
    let pool = OmniShadowPool::new(&gpu.device, &descriptor).expect("a pool");
    let sources = [sun.shadow.maps(), lamp.maps(), pool.maps()];
    let view = DebugView::new(&gpu.device, F::Rgba8Unorm).expect("a debug view");
    let target = color_target(gpu, 4);
    let depth = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("depth"),
        size: target.size(),
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: F::Depth32Float,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    // One of these is the depth of an image, and two are not.
    let depths = [
        depth.create_view(&Default::default()),
        color_target(gpu, 4).create_view(&Default::default()),
        sun.shadow.maps().texture_view().clone(),
    ];
    let formats = prop::sample::select(vec![
        F::R8Unorm,
        F::R8Snorm,
        F::R8Uint,
        F::R16Float,
        F::R16Unorm,
        F::Rg8Sint,
        F::Rgba8Unorm,
        F::Rgba8UnormSrgb,
        F::Bgra8Unorm,
        F::Rgb10a2Unorm,
        F::Rgb10a2Uint,
        F::Rg11b10Ufloat,
        F::Rgb9e5Ufloat,
        F::R32Float,
        F::Rgba32Float,
        F::Rgba16Float,
        F::Rgba16Snorm,
        F::R64Uint,
        F::Stencil8,
        F::Depth16Unorm,
        F::Depth24Plus,
        F::Depth32FloatStencil8,
        F::NV12,
        F::Bc1RgbaUnorm,
        F::Bc6hRgbUfloat,
        F::Etc2Rgb8Unorm,
        F::Rgba32Sint,
    ]);
    let layer = prop_oneof![3 => 0..14_u32, 1 => any::<u32>()];
    run(
        200,
        (formats, 0..3_usize, 0..3_usize, layer, matrix()),
        |(format, light, kind, layer, matrix)| {
            counts.count(&DebugView::new(&gpu.device, format));
            let picture = match kind {
                0 => DebugImage::Layer(layer),
                1 => DebugImage::Cross,
                _ => DebugImage::PoolCross(layer),
            };
            let mut encoder = gpu.encoder();
            {
                let mut pass = color_pass(&mut encoder, &target);
                let source = sources[light];
                counts.count(&view.draw(&mut pass, source, picture));
                counts.count(&view.draw_cascades(&mut pass, source, &depths[kind], matrix));
            }
            gpu.submit(encoder);
            Ok(())
        },
    );
    counts.finish(
        "any target format and picture of a debug view",
        "drawn or refused, no panic, no device error",
    );
}
