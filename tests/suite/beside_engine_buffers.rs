//! Calls the emitted functions in render pipelines whose other bind groups contain uniform buffers
//! of the engine. Whatever buffers precede those of the lights, an image is drawn, and always the
//! same one.
//!
//! Vulkan drivers have crashed here, so the drawing is done in a process of its own, and with
//! Vulkan whatever the backend of the run.

use std::collections::BTreeSet;

use image::RgbaImage;
use wgpu_shadows::{Bias, Filter, shader};

use crate::fixtures::child;
use crate::fixtures::floor::{draw, own_layout, picture, pipeline, stages};
use crate::fixtures::gpu::{Gpu, vulkan};
use crate::fixtures::lights::{Kind, Light, stage};

type Set = Vec<Kind>;

/// Returns each kind twice, and sets of different kinds, among them one with all kinds.
fn sets() -> Vec<Set> {
    let [sun, cascades, _, spot, lamp, spots, lamps] = Kind::ALL;
    let alike = Kind::ALL.map(|kind| vec![kind; 2]);
    let mixed = [
        vec![sun, spot, lamp],
        vec![cascades, spots, lamps, spot],
        vec![spot; 4],
        Kind::ALL.to_vec(),
    ];
    alike.into_iter().chain(mixed).collect()
}

/// Returns the default filter, the sampler's own, and for sets of cubes the direction-space
/// filters.
fn filters(set: &Set) -> Vec<Filter> {
    let mut filters = vec![Filter::default(), Filter::Hardware];
    if set.iter().all(|kind| kind.has_cube()) {
        filters.push(Filter::DirectionStar { radius: 0.05 });
    }
    filters
}

/// Lists the group of the lights and the number of engine buffers in each group before it. They
/// cover all groups that every WebGPU device has, and put two lights of one kind at every position
/// from the first to the eleventh of the stage's buffers.
const LAYOUTS: [(u32, u32); 6] = [(0, 0), (1, 1), (2, 1), (1, 3), (3, 1), (3, 3)];

/// Returns the layouts whose number of buffers a stage can have.
fn layouts(set: &Set) -> impl Iterator<Item = (u32, u32)> {
    let most = wgpu::Limits::default().max_uniform_buffers_per_shader_stage;
    let left = most - set.len() as u32;
    LAYOUTS
        .into_iter()
        .filter(move |(group, buffers)| group * buffers <= left)
}

/// Returns the number of images that [`draw_all`] draws.
fn combinations() -> usize {
    let of_set = |set: &Set| filters(set).len() * layouts(set).count();
    sets().iter().map(of_set).sum()
}

#[test]
fn any_lights_draw_behind_any_buffers() {
    let name = "suite::beside_engine_buffers::any_lights_draw_behind_any_buffers";
    if let Some(drawn) = child::counted(name, &[], draw_all) {
        assert_eq!(drawn, combinations());
    }
}

fn draw_all() -> usize {
    let gpu = vulkan();
    let stage = stage(gpu);
    let mut drawn = 0;
    for set in sets() {
        for filter in filters(&set) {
            let lights: Vec<_> = set
                .iter()
                .map(|kind| (*kind, kind.lit(gpu, &stage, filter, Bias::Auto)))
                .collect();
            let mut wanted = None;
            for (group, buffers) in layouts(&set) {
                // The last line before a crash then tells which combination it was.
                let name = format!("{set:?} {filter:?} in group {group}, {buffers} before");
                println!("{name}");
                let seen = picture(gpu, &lights, group, buffers);
                let wanted = wanted.get_or_insert_with(|| seen.clone());
                assert!(seen == *wanted, "{name}: another picture");
                drawn += 1;
            }
            assert_both_greys(&wanted.expect("a picture"), &format!("{set:?} {filter:?}"));
        }
    }
    drawn
}

/// Lists the bias schemes with the WGSL that an engine with its own bindings calls.
const BIASES: [(Bias, &str); 3] = [
    (Bias::Auto, "plane"),
    (Bias::NormalOffset, "normal_offset"),
    (
        Bias::Manual {
            constant: 0.02,
            slope: 0.1,
        },
        "manual",
    ),
];

/// Is the number of uniform buffers of the engine before the view.
const BEFORE_OWN_VIEW: std::ops::Range<u32> = 0..9;

/// The modules work with one view as a uniform of the engine's own, behind as many other buffers.
#[test]
fn own_views_draw_behind_any_buffers() {
    let name = "suite::beside_engine_buffers::own_views_draw_behind_any_buffers";
    if let Some(drawn) = child::counted(name, &[], draw_own) {
        assert_eq!(drawn, 2 * BIASES.len() * BEFORE_OWN_VIEW.count());
    }
}

fn draw_own() -> usize {
    let gpu = vulkan();
    let stage = stage(gpu);
    let [sun, _, _, spot, ..] = Kind::ALL;
    let mut drawn = 0;
    for (kind, view) in [(sun, "directional"), (spot, "local")] {
        for (bias, scheme) in BIASES {
            let light = kind.lit(gpu, &stage, Filter::Nearest, bias);
            let mut wanted = None;
            for before in BEFORE_OWN_VIEW {
                let name = format!("{kind:?} {bias:?} behind {before}");
                println!("{name}");
                let seen = own_picture(gpu, &*light, scheme, view, before);
                let wanted = wanted.get_or_insert_with(|| seen.clone());
                assert!(seen == *wanted, "{name}: another picture");
                drawn += 1;
            }
            assert_both_greys(&wanted.expect("a picture"), scheme);
        }
    }
    drawn
}

fn own_picture(gpu: &Gpu, light: &dyn Light, scheme: &str, kind: &str, before: u32) -> RgbaImage {
    let device = &gpu.device;
    let bias = format!("bias_{scheme}");
    let modules = shader::compose(&[&bias, "filter_nearest"]).expect("modules of the table");
    let zeros: String = (0..before)
        .map(|index| format!(" + own_{index}.x"))
        .collect();
    let own: String = (0..before)
        .map(|index| format!("@group(0) @binding({index}) var<uniform> own_{index}: vec4<f32>;\n"))
        .collect();
    let source = format!(
        "{modules}{own}
@group(0) @binding({before}) var<uniform> own_view: ShadowViewUniform;
@group(1) @binding(0) var own_map: texture_depth_2d_array;
@group(1) @binding(1) var own_sampler: sampler;

fn own_light(position: vec3<f32>, normal: vec3<f32>) -> f32 {{
    let receiver = shadow_receiver_{scheme}_{kind}(own_view, position, normal);
    if !receiver.inside {{
        return 1.0;
    }}
    return shadow_filter_nearest(own_map, own_sampler, receiver);
}}
{}",
        stages(&format!(
            "own_light(position, vec3<f32>(0.0, 1.0, 0.0)){zeros}"
        ))
    );
    let buffers = own_layout(gpu, before + 1);
    let texture = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Depth,
        view_dimension: wgpu::TextureViewDimension::D2Array,
        multisampled: false,
    };
    let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::NonFiltering);
    let entries = [(0, texture), (1, sampler)].map(|(binding, ty)| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty,
        count: None,
    });
    let map = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("the engine's own"),
        entries: &entries,
    });
    let zero = gpu.buffer(&[0.0_f32; 4], wgpu::BufferUsages::UNIFORM);
    let entries: Vec<_> = (0..=before)
        .map(|binding| wgpu::BindGroupEntry {
            binding,
            resource: if binding < before {
                zero.as_entire_binding()
            } else {
                light.maps().uniform_buffer().as_entire_binding()
            },
        })
        .collect();
    let buffer_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("the engine's own"),
        layout: &buffers,
        entries: &entries,
    });
    let map_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("the engine's own"),
        layout: &map,
        entries: &[
            wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::TextureView(light.maps().texture_view()),
            },
            wgpu::BindGroupEntry {
                binding: 1,
                resource: wgpu::BindingResource::Sampler(
                    &device.create_sampler(&Default::default()),
                ),
            },
        ],
    });
    let pipeline = pipeline(gpu, &source, &[Some(&buffers), Some(&map)]);
    draw(gpu, &pipeline, &[&buffer_group, &map_group])
}

/// Asserts that an image contains both shadow and light; an image without both proves nothing.
fn assert_both_greys(picture: &RgbaImage, name: &str) {
    let greys: BTreeSet<_> = picture.pixels().map(|pixel| pixel.0[0]).collect();
    assert!(greys.len() > 1, "{name}: {greys:?}");
}
