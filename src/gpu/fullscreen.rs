//! Makes the pipelines of passes over a whole viewport.

/// Selects what a pass over a whole viewport writes.
#[derive(Clone, Debug)]
pub(crate) enum FullscreenTarget {
    /// Writes one colour target, without a depth attachment.
    Color(wgpu::ColorTargetState),
    /// Writes all depths of an attachment of this format, without a colour target: those that the
    /// fragment stage returns, or the far plane of reversed depth where there is no such stage.
    Depth(wgpu::TextureFormat),
}

/// Makes a pipeline for passes with one sample, whose draw of three vertices covers the viewport.
/// `module` contains `wgsl/pass/fullscreen.wgsl` and `fragment_entry`. The caller's error scope
/// captures device errors.
pub(crate) fn fullscreen_pipeline(
    device: &wgpu::Device,
    label: &str,
    layout: Option<&wgpu::BindGroupLayout>,
    module: &wgpu::ShaderModule,
    fragment_entry: Option<&str>,
    target: FullscreenTarget,
) -> wgpu::RenderPipeline {
    let layouts: Vec<_> = layout.into_iter().map(Some).collect();
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(label),
        bind_group_layouts: &layouts,
        immediate_size: 0,
    });
    let (targets, depth_stencil) = match target {
        FullscreenTarget::Color(target) => (vec![Some(target)], None),
        FullscreenTarget::Depth(format) => (
            Vec::new(),
            Some(wgpu::DepthStencilState {
                format,
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Always),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            }),
        ),
    };
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(label),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("shadow_fullscreen_vertex"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil,
        multisample: wgpu::MultisampleState::default(),
        fragment: fragment_entry.map(|entry| wgpu::FragmentState {
            module,
            entry_point: Some(entry),
            compilation_options: Default::default(),
            targets: &targets,
        }),
        multiview_mask: None,
        cache: None,
    })
}
