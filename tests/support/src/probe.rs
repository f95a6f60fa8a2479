//! Samples WGSL from a compute shader instead of an engine's fragment shader.

use glam::{DVec3, Vec3};

use crate::bind;
use crate::gpu::Gpu;
use crate::readback;

/// Is a receiver: a position and the geometric normal there, laid out as the shader reads it.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct Point {
    pub position: [f32; 3],
    pad_position: f32,
    pub normal: [f32; 3],
    pad_normal: f32,
}

impl Point {
    pub fn new(position: Vec3, normal: Vec3) -> Self {
        Self {
            position: position.to_array(),
            pad_position: 0.0,
            normal: normal.to_array(),
            pad_normal: 0.0,
        }
    }

    /// Returns the receiver, rounded to what an engine would pass.
    pub fn rounded(position: DVec3, normal: DVec3) -> Self {
        Self::new(position.as_vec3(), normal.as_vec3())
    }
}

/// Holds a compute pipeline that returns one value per point: group 0 is its own, and group 1 is
/// what its WGSL declares there.
#[derive(Clone)]
pub struct PointShader {
    pipeline: wgpu::ComputePipeline,
    points_layout: wgpu::BindGroupLayout,
}

impl PointShader {
    /// Creates the pipeline. `value` is a WGSL expression over `point.position` and `point.normal`,
    /// of type `value_type`.
    pub fn new(
        gpu: &Gpu,
        declarations: &str,
        value_type: &str,
        value: &str,
        group_1: &wgpu::BindGroupLayout,
    ) -> Self {
        let source = format!(
            "{declarations}
struct Point {{
    position: vec3<f32>,
    normal: vec3<f32>,
}}
@group(0) @binding(0) var<storage, read> points: array<Point>;
@group(0) @binding(1) var<storage, read_write> answers: array<{value_type}>;

@compute @workgroup_size(64)
fn ask(@builtin(global_invocation_id) id: vec3<u32>) {{
    if id.x < arrayLength(&points) {{
        let point = points[id.x];
        answers[id.x] = {value};
    }}
}}
"
        );
        let points_layout = points_layout(gpu);
        let layout = gpu
            .device
            .create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some("points"),
                bind_group_layouts: &[Some(&points_layout), Some(group_1)],
                immediate_size: 0,
            });
        let pipeline = gpu
            .device
            .create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some("points"),
                layout: Some(&layout),
                module: &gpu.shader(&source),
                entry_point: Some("ask"),
                compilation_options: Default::default(),
                cache: None,
            });
        Self {
            pipeline,
            points_layout,
        }
    }

    /// Returns one value per point.
    pub fn ask<T: bytemuck::Pod>(
        &self,
        gpu: &Gpu,
        group_1: &wgpu::BindGroup,
        points: &[Point],
    ) -> Vec<T> {
        assert!(
            !points.is_empty(),
            "a question without points proves nothing"
        );
        let output = readback::storage(gpu, (points.len() * size_of::<T>()) as u64);
        let group_0 = points_group(gpu, &self.points_layout, points, &output);
        let mut encoder = gpu.encoder();
        self.record(&mut encoder, &group_0, group_1, points.len() as u32);
        gpu.submit(encoder);
        readback::buffer(gpu, &output)
    }

    /// Records the pass that computes the values of `count` points.
    pub fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        group_0: &wgpu::BindGroup,
        group_1: &wgpu::BindGroup,
        count: u32,
    ) {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, group_0, &[]);
        pass.set_bind_group(1, group_1, &[]);
        pass.dispatch_workgroups(count.div_ceil(64), 1, 1);
    }
}

/// Creates the layout of group 0: the points, and the storage buffer for their values.
pub fn points_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let storage = |read_only| wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Storage { read_only },
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    let types = [storage(true), storage(false)];
    bind::layout(gpu, wgpu::ShaderStages::COMPUTE, &types)
}

/// Creates a group 0 of points and of the buffer for their values, which is made by
/// [`readback::storage`].
pub fn points_group(
    gpu: &Gpu,
    layout: &wgpu::BindGroupLayout,
    points: &[Point],
    output: &wgpu::Buffer,
) -> wgpu::BindGroup {
    let input = gpu.buffer(points, wgpu::BufferUsages::STORAGE);
    let resources = [&input, output].map(wgpu::Buffer::as_entire_binding);
    bind::group(gpu, layout, &resources)
}
