//! Builds the wgpu objects of caster pipelines: layouts, vertex state, depth state.

use std::num::NonZeroU32;

use crate::cast::pipeline_descriptor::{
    CasterPipelineDescriptor, CasterVertex, ModelTransform, PositionAttribute,
};
use crate::cast::view_uniform::{multiview_layout, view_layout};
use crate::gpu::{ALL_FACES_MASK, DepthFormat};
use crate::shader;

/// Holds the pipeline as described, and the one with the other winding; both are the same where
/// nothing is culled.
pub(crate) type BothWindings = [wgpu::RenderPipeline; 2];

/// Holds pipelines by [`DepthFormat::index`], and `None` for a format that the descriptor does not
/// name.
pub(crate) type ByFormat = [Option<BothWindings>; DepthFormat::ALL.len()];

/// Creates the pipelines for all formats that `descriptor` names.
pub(crate) fn create_pipelines(
    device: &wgpu::Device,
    descriptor: &CasterPipelineDescriptor<'_>,
) -> ByFormat {
    match descriptor.vertex {
        CasterVertex::BuiltIn { position, model } => {
            let source = [shader::CASTER.source, shader::CASTER_BUILTIN.source].concat();
            built_in(device, descriptor, &source, &position, &model, None)
        }
        CasterVertex::Wgsl {
            source,
            vertex_entry,
            fragment_entry,
            buffers,
            bind_group_layouts,
        } => {
            let source = [shader::CASTER.source, source].concat();
            let stages = Stages {
                source: &source,
                vertex_entry,
                fragment_entry,
                buffers,
                bind_group_layouts,
                multiview_mask: None,
            };
            create_by_format(device, descriptor, &stages)
        }
    }
}

/// Creates pipelines with the built-in vertex stage that draw six faces in one multiview pass.
pub(crate) fn multiview_pipelines(
    device: &wgpu::Device,
    descriptor: &CasterPipelineDescriptor<'_>,
    position: &PositionAttribute,
    model: &ModelTransform,
) -> ByFormat {
    let modules = [shader::CASTER_MULTIVIEW, shader::CASTER_BUILTIN_MULTIVIEW];
    let source = modules.map(|module| module.source).concat();
    built_in(device, descriptor, &source, position, model, ALL_FACES_MASK)
}

fn built_in(
    device: &wgpu::Device,
    descriptor: &CasterPipelineDescriptor<'_>,
    source: &str,
    position: &PositionAttribute,
    model: &ModelTransform,
    multiview_mask: Option<NonZeroU32>,
) -> ByFormat {
    let position_attribute = [wgpu::VertexAttribute {
        format: position.format,
        offset: position.offset,
        shader_location: 0,
    }];
    let positions = Some(wgpu::VertexBufferLayout {
        array_stride: position.array_stride,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: &position_attribute,
    });
    let mut stages = Stages {
        source,
        vertex_entry: "shadow_caster_vertex_identity",
        fragment_entry: None,
        buffers: std::slice::from_ref(&positions),
        bind_group_layouts: &[],
        multiview_mask,
    };
    let ModelTransform::InstanceMatrix {
        array_stride,
        offset,
    } = *model
    else {
        return create_by_format(device, descriptor, &stages);
    };
    let columns = [0, 1, 2, 3].map(|column| wgpu::VertexAttribute {
        format: wgpu::VertexFormat::Float32x4,
        offset: offset + 16 * u64::from(column),
        shader_location: 1 + column,
    });
    let matrices = Some(wgpu::VertexBufferLayout {
        array_stride,
        step_mode: wgpu::VertexStepMode::Instance,
        attributes: &columns,
    });
    let buffers = [positions.clone(), matrices];
    stages.vertex_entry = "shadow_caster_vertex_instance";
    stages.buffers = &buffers;
    create_by_format(device, descriptor, &stages)
}

/// Holds what differs between the built-in stages and the engine's own.
struct Stages<'a> {
    source: &'a str,
    vertex_entry: &'a str,
    fragment_entry: Option<&'a str>,
    buffers: &'a [Option<wgpu::VertexBufferLayout<'a>>],
    bind_group_layouts: &'a [Option<&'a wgpu::BindGroupLayout>],
    multiview_mask: Option<NonZeroU32>,
}

fn create_by_format(
    device: &wgpu::Device,
    descriptor: &CasterPipelineDescriptor<'_>,
    stages: &Stages<'_>,
) -> ByFormat {
    let label = descriptor.label.unwrap_or("shadow caster");
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(label),
        source: wgpu::ShaderSource::Wgsl(stages.source.into()),
    });
    let view_layout = match stages.multiview_mask {
        None => view_layout(device),
        Some(_) => multiview_layout(device),
    };
    let mut groups = vec![Some(&view_layout)];
    groups.extend_from_slice(stages.bind_group_layouts);
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(label),
        bind_group_layouts: &groups,
        immediate_size: 0,
    });
    let create = |format: DepthFormat, front_face| {
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(label),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some(stages.vertex_entry),
                compilation_options: Default::default(),
                buffers: stages.buffers,
            },
            primitive: wgpu::PrimitiveState {
                front_face,
                ..descriptor.primitive
            },
            depth_stencil: Some(wgpu::DepthStencilState {
                format: format.texture_format(),
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::GreaterEqual),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            }),
            multisample: wgpu::MultisampleState::default(),
            fragment: stages.fragment_entry.map(|entry| wgpu::FragmentState {
                module: &module,
                entry_point: Some(entry),
                compilation_options: Default::default(),
                targets: &[],
            }),
            multiview_mask: stages.multiview_mask,
            cache: None,
        })
    };
    let both = |format| {
        let described = create(format, descriptor.primitive.front_face);
        let mirrored = match (
            descriptor.primitive.cull_mode,
            descriptor.primitive.front_face,
        ) {
            (None, _) => described.clone(),
            (Some(_), wgpu::FrontFace::Ccw) => create(format, wgpu::FrontFace::Cw),
            (Some(_), wgpu::FrontFace::Cw) => create(format, wgpu::FrontFace::Ccw),
        };
        [described, mirrored]
    };
    DepthFormat::ALL.map(|format| {
        descriptor
            .depth_formats
            .contains(&format)
            .then(|| both(format))
    })
}
