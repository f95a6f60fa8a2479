//! Samples the library's WGSL from a compute shader instead of an engine's fragment shader.

use glam::{DVec3, Vec3};
use wgpu_shadows::{
    DirectionalShadow, ShadowBindings, ShadowBindingsDescriptor, report::ShadowReport,
};

use crate::support::frames::{DirectionalFrame, RecordFrame};
use crate::support::gpu::Gpu;
use crate::support::readback;

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

/// Holds a compute pipeline that returns one value per point: group 0 is its own, and group 1 is what its WGSL declares
/// there.
pub struct PointShader {
    pipeline: wgpu::ComputePipeline,
    points_layout: wgpu::BindGroupLayout,
}

impl PointShader {
    /// Creates the pipeline. `value` is a WGSL expression over `point.position` and `point.normal`, of type
    /// `value_type`.
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
        let storage = |binding, read_only| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Storage { read_only },
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        };
        let points_layout = gpu
            .device
            .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: Some("points"),
                entries: &[storage(0, true), storage(1, false)],
            });
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
        let input = gpu.buffer(points, wgpu::BufferUsages::STORAGE);
        let output = readback::storage(gpu, (points.len() * size_of::<T>()) as u64);
        let group_0 = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("points"),
            layout: &self.points_layout,
            entries: &[
                wgpu::BindGroupEntry {
                    binding: 0,
                    resource: input.as_entire_binding(),
                },
                wgpu::BindGroupEntry {
                    binding: 1,
                    resource: output.as_entire_binding(),
                },
            ],
        });
        let mut encoder = gpu.encoder();
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, &group_0, &[]);
            pass.set_bind_group(1, group_1, &[]);
            pass.dispatch_workgroups((points.len() as u32).div_ceil(64), 1, 1);
        }
        gpu.submit(encoder);
        readback::buffer(gpu, &output)
    }
}

/// Samples one directional light through `ShadowBindings`, as an engine would. It remains valid in every frame of the
/// light.
pub struct SunProbe {
    bindings: ShadowBindings,
    shader: PointShader,
}

impl SunProbe {
    pub fn new(gpu: &Gpu, shadow: &DirectionalShadow) -> Self {
        let bindings = ShadowBindings::new(
            &gpu.device,
            &ShadowBindingsDescriptor {
                visibility: wgpu::ShaderStages::COMPUTE,
                lights: &[("sun", shadow.maps())],
                ..Default::default()
            },
        )
        .expect("valid bindings");
        let shader = PointShader::new(
            gpu,
            bindings.wgsl(),
            "f32",
            "shadow_sun(point.position, point.normal)",
            bindings.layout(),
        );
        Self { bindings, shader }
    }

    /// Returns the visibility of the light from each point, under the map of the last submitted frame.
    pub fn ask(&self, gpu: &Gpu, points: &[Point]) -> Vec<f32> {
        self.shader.ask(gpu, self.bindings.bind_group(), points)
    }
}

/// Records a frame and submits it.
pub fn record(
    gpu: &Gpu,
    shadow: &mut DirectionalShadow,
    frame: &DirectionalFrame<'_>,
) -> ShadowReport {
    let mut encoder = gpu.encoder();
    let report = shadow
        .record_frame(&mut encoder, frame)
        .expect("a valid frame")
        .clone();
    gpu.submit(encoder);
    report
}
