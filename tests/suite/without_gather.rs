//! Tests a device whose shaders cannot gather, like those of WebGL 2: OpenGL ES 3.0, which Mesa
//! provides to a process whose environment requests it. There the library draws what it draws
//! elsewhere.

use image::RgbaImage;
use shadow_support::readback;
use wgpu_shadows::{Bias, Filter, debug::DebugImage, debug::DebugView, shader};

use crate::fixtures::child;
use crate::fixtures::floor::{SIZE, picture};
use crate::fixtures::gpu::{Gpu, GpuRequest, gpu, has_adapter, own_gpu, vulkan};
use crate::fixtures::lights::{Kind, Light, camera, stage};
use crate::fixtures::picture::{COLOR, color_pass, color_target, fragment_pipeline};
use crate::fixtures::tint::tint;

/// Disables desktop OpenGL and limits OpenGL ES to 3.0. The images that are compared with come from
/// Vulkan, whatever the backend of the run.
const ES_3_0: [(&str, &str); 3] = [
    ("SHADOW_TEST_BACKEND", "vulkan"),
    ("MESA_GL_VERSION_OVERRIDE", "3.0"),
    ("MESA_GLES_VERSION_OVERRIDE", "3.0"),
];

/// Returns the device, or `None` where the machine has no OpenGL, or not Mesa's, which reads these
/// variables.
fn es_3_0() -> Option<Gpu> {
    if !has_adapter(wgpu::Backends::GL) {
        return None;
    }
    let gpu = own_gpu(GpuRequest {
        backend: Some(wgpu::Backends::GL),
        limits: wgpu::Limits::downlevel_webgl2_defaults(),
        ..Default::default()
    });
    let is_mesa = gpu.adapter.driver_info.contains("Mesa");
    assert!(
        !is_mesa || gpu.adapter.driver_info.contains("OpenGL ES 3.0"),
        "{}",
        gpu.describe()
    );
    is_mesa.then_some(gpu)
}

/// Asserts that everything was drawn, or nothing where there is no such device; the latter is not
/// permitted in a run on Mesa's OpenGL.
fn assert_drawn(drawn: usize, all: usize) {
    let adapter = &gpu().adapter;
    let has_mesa = adapter.backend == wgpu::Backend::Gl && adapter.driver_info.contains("Mesa");
    assert!(
        drawn == all || (drawn == 0 && !has_mesa),
        "{drawn} of {all}"
    );
}

/// Returns filters of every kernel, and the sampler's own, which needs no gather.
fn filters(kind: Kind) -> Vec<Filter> {
    let mut filters = vec![
        Filter::default(),
        Filter::Hardware,
        Filter::Nearest,
        Filter::Box,
        Filter::Bilinear { sharpness: 1.0 },
        Filter::Tent5 { sharpness: 1.0 },
        Filter::Tent7 { sharpness: 1.0 },
        Filter::Pcss { light_size: 0.1 },
        Filter::PcssRotated { light_size: 0.1 },
    ];
    if kind.has_cube() {
        filters.push(Filter::DirectionStar { radius: 0.05 });
    }
    filters
}

#[test]
fn lights_draw_without_gather() {
    let name = "suite::without_gather::lights_draw_without_gather";
    if let Some(drawn) = child::counted(name, &ES_3_0, draw_lights) {
        let all: usize = Kind::ALL.iter().map(|kind| filters(*kind).len()).sum();
        assert_drawn(drawn, all);
    }
}

fn draw_lights() -> usize {
    let Some(gpu) = es_3_0() else {
        return 0;
    };
    assert!(!gathers(&gpu), "{} gathers", gpu.describe());
    let mut drawn = 0;
    for kind in Kind::ALL {
        for filter in filters(kind) {
            let pictures = [vulkan(), &gpu].map(|gpu| {
                let light = kind.lit(gpu, &stage(gpu), filter, Bias::Auto);
                picture(gpu, &[(kind, light)], 1, 1)
            });
            assert_same(&pictures, &format!("{kind:?} {filter:?}"));
            drawn += 1;
        }
    }
    drawn
}

/// Returns whether a pipeline of the device can gather from a map.
fn gathers(gpu: &Gpu) -> bool {
    let source = shader::compose(&["filter_nearest", "texels"]).expect("a module of the table")
        + "
@group(0) @binding(0) var map: texture_depth_2d_array;
@group(0) @binding(1) var map_sampler: sampler;

@vertex
fn vertex() -> @builtin(position) vec4<f32> {
    return vec4<f32>(0.0);
}

@fragment
fn fragment() -> @location(0) vec4<f32> {
    var receiver: ShadowReceiver;
    return vec4<f32>(shadow_filter_nearest(map, map_sampler, receiver));
}
";
    let scope = gpu.device.push_error_scope(wgpu::ErrorFilter::Internal);
    let module = gpu.shader(&source);
    let _pipeline = fragment_pipeline(gpu, &module, None);
    pollster::block_on(scope.pop()).is_none()
}

#[test]
fn debug_views_draw_without_gather() {
    let name = "suite::without_gather::debug_views_draw_without_gather";
    if let Some(drawn) = child::counted(name, &ES_3_0, draw_debug_views) {
        assert_drawn(drawn, 3);
    }
}

fn draw_debug_views() -> usize {
    let Some(gpu) = es_3_0() else {
        return 0;
    };
    let gpus = [vulkan(), &gpu];
    let [_, cascades, _, _, lamp, ..] = Kind::ALL;
    let pictures = [(cascades, DebugImage::Layer(1)), (lamp, DebugImage::Cross)];
    for (kind, what) in pictures {
        let drawn = gpus.map(|gpu| {
            let light = kind.lit(gpu, &stage(gpu), Filter::default(), Bias::Auto);
            debug_picture(gpu, &*light, what)
        });
        assert_same(&drawn, &format!("{what:?} of {kind:?}"));
    }
    let tints = gpus.map(|gpu| {
        let light = cascades.lit(gpu, &stage(gpu), Filter::default(), Bias::Auto);
        tinted(gpu, &*light)
    });
    assert_same(&tints, "the tint of cascades");
    3
}

fn debug_picture(gpu: &Gpu, light: &dyn Light, what: DebugImage) -> RgbaImage {
    let view = DebugView::new(&gpu.device, COLOR).expect("a renderable format");
    let target = color_target(gpu, SIZE);
    let mut encoder = gpu.encoder();
    {
        let mut pass = color_pass(&mut encoder, &target);
        view.draw(&mut pass, light.maps(), what)
            .expect("a layer of the map");
    }
    gpu.submit(encoder);
    readback::rgba8(gpu, &target)
}

/// Returns the tint of a white image of a wall at some distance, across the borders of cascades.
fn tinted(gpu: &Gpu, light: &dyn Light) -> RgbaImage {
    // The camera's depth is 0.1 / distance.
    tint(gpu, light.maps(), &camera(), SIZE, 0.1 / 5.5)
}

/// Asserts that the pixels are the same, up to a step of 8 bits, and that there is more than one
/// grey or colour.
fn assert_same([wanted, seen]: &[RgbaImage; 2], name: &str) {
    let pixels = || wanted.pixels().zip(seen.pixels());
    let differ = pixels()
        .filter(|(wanted, seen)| {
            let mut channels = wanted.0.iter().zip(seen.0);
            channels.any(|(wanted, seen)| wanted.abs_diff(seen) > 1)
        })
        .count();
    assert_eq!(differ, 0, "{name}: of {} pixels", pixels().count());
    let first = wanted.get_pixel(0, 0);
    assert!(
        wanted.pixels().any(|pixel| pixel != first),
        "{name}: {first:?} all over"
    );
}
