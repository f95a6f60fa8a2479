//! Draws images of a floor by an engine's own shader that samples a set of lights.

use image::RgbaImage;
use wgpu_shadows::{ShadowBindings, ShadowBindingsDescriptor};

use crate::support::gpu::Gpu;
use crate::support::lights::{Kind, Light};
use crate::support::picture::{COLOR, color_pass, color_target};
use crate::support::readback;

/// Is the number of pixels per side.
pub const SIZE: u32 = 24;

/// Draws the mean visibility of the lights over the floor of `support/lights.rs`, seen from above. The lights are in
/// `group`, and each group before it has `buffers` uniform buffers of the engine.
pub fn picture(
    gpu: &Gpu,
    lights: &[(Kind, Box<dyn Light>)],
    group: u32,
    buffers: u32,
) -> RgbaImage {
    let names: Vec<_> = ('a'..).take(lights.len()).map(String::from).collect();
    let sources: Vec<_> = names
        .iter()
        .zip(lights)
        .map(|(name, (_, light))| (name.as_str(), light.maps()))
        .collect();
    let descriptor = ShadowBindingsDescriptor {
        group,
        lights: &sources,
        ..Default::default()
    };
    let bindings = ShadowBindings::new(&gpu.device, &descriptor).expect("valid bindings");
    let calls: Vec<_> = names
        .iter()
        .zip(lights)
        .map(|(name, (kind, _))| kind.call(name, "position", "vec3<f32>(0.0, 1.0, 0.0)"))
        .collect();
    let own: Vec<_> = (0..group)
        .flat_map(|group| (0..buffers).map(move |binding| (group, binding)))
        .collect();
    let declarations: String = own
        .iter()
        .map(|(group, binding)| {
            let slot = format!("@group({group}) @binding({binding})");
            format!("{slot} var<uniform> own_{group}_{binding}: vec4<f32>;\n")
        })
        .collect();
    // The engine's buffers contain zeros, which a compiler cannot know.
    let zeros: String = own
        .iter()
        .map(|(group, binding)| format!(" + own_{group}_{binding}.x"))
        .collect();
    let source = format!(
        "{}{declarations}{}",
        bindings.wgsl(),
        stages(&format!(
            "({}) / {}.0{zeros}",
            calls.join(" + "),
            lights.len()
        ))
    );
    let own_layout = own_layout(gpu, buffers);
    let own_group = own_group(gpu, &own_layout, buffers);
    let mut layouts = vec![Some(&own_layout); group as usize];
    layouts.push(Some(bindings.layout()));
    let pipeline = pipeline(gpu, &source, &layouts);
    let mut groups = vec![&own_group; group as usize];
    groups.push(bindings.bind_group());
    draw(gpu, &pipeline, &groups)
}

/// Returns a vertex stage that covers the target, and a fragment stage that shows `value`, a WGSL expression over
/// `position` on the floor.
pub fn stages(value: &str) -> String {
    format!(
        "
@vertex
fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {{
    let corner = vec2<f32>(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0;
    return vec4<f32>(corner, 0.0, 1.0);
}}

@fragment
fn fragment(@builtin(position) pixel: vec4<f32>) -> @location(0) vec4<f32> {{
    let place = pixel.xy * (3.8 / {SIZE}.0) - 1.9;
    let position = vec3<f32>(place.x, 0.0, place.y);
    return vec4<f32>(vec3<f32>({value}), 1.0);
}}
"
    )
}

pub fn draw(gpu: &Gpu, pipeline: &wgpu::RenderPipeline, groups: &[&wgpu::BindGroup]) -> RgbaImage {
    let target = color_target(gpu, SIZE);
    let mut encoder = gpu.encoder();
    {
        let mut pass = color_pass(&mut encoder, &target);
        pass.set_pipeline(pipeline);
        for (index, group) in (0..).zip(groups) {
            pass.set_bind_group(index, *group, &[]);
        }
        pass.draw(0..3, 0..1);
    }
    gpu.submit(encoder);
    readback::rgba8(gpu, &target)
}

pub fn own_layout(gpu: &Gpu, buffers: u32) -> wgpu::BindGroupLayout {
    let entries: Vec<_> = (0..buffers)
        .map(|binding| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        })
        .collect();
    gpu.device
        .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("the engine's own"),
            entries: &entries,
        })
}

fn own_group(gpu: &Gpu, layout: &wgpu::BindGroupLayout, buffers: u32) -> wgpu::BindGroup {
    let zeros = gpu.buffer(&[0.0_f32; 4], wgpu::BufferUsages::UNIFORM);
    let entries: Vec<_> = (0..buffers)
        .map(|binding| wgpu::BindGroupEntry {
            binding,
            resource: zeros.as_entire_binding(),
        })
        .collect();
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("the engine's own"),
        layout,
        entries: &entries,
    })
}

pub fn pipeline(
    gpu: &Gpu,
    source: &str,
    layouts: &[Option<&wgpu::BindGroupLayout>],
) -> wgpu::RenderPipeline {
    let device = &gpu.device;
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: layouts,
        immediate_size: 0,
    });
    let module = gpu.shader(source);
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vertex"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("fragment"),
            compilation_options: Default::default(),
            targets: &[Some(COLOR.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}
