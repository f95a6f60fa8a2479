//! How one kind of caster is laid out and shaded: the depth-only pipelines.

use crate::cast::{DEPTH_FORMAT, DeviceRefusal, capture_device_errors};
use crate::error::CasterError;
use crate::shader;

/// Where the built-in vertex stage finds positions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PositionAttribute {
    /// Bytes from one vertex to the next; a multiple of 4.
    pub array_stride: u64,
    /// Bytes from the start of a vertex to its position; a multiple of 4.
    pub offset: u64,
    /// Any float, snorm or unorm format of two to four components; a missing z is 0, a fourth component is ignored.
    pub format: wgpu::VertexFormat,
}

impl PositionAttribute {
    /// `Float32x3` at the start of vertices of `array_stride` bytes.
    pub const fn float32x3(array_stride: u64) -> Self {
        Self {
            array_stride,
            offset: 0,
            format: wgpu::VertexFormat::Float32x3,
        }
    }
}

/// Where the built-in vertex stage finds the transform that takes positions to render space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ModelTransform {
    /// Positions are in render space already.
    Identity,
    /// Four `Float32x4` columns of `render_from_model` in vertex buffer slot 1, stepped once per instance.
    InstanceMatrix {
        /// Bytes from one instance to the next; a multiple of 4, at least `offset` + 64.
        array_stride: u64,
        /// Bytes from the start of an instance to the matrix; a multiple of 4.
        offset: u64,
    },
}

impl ModelTransform {
    /// Tightly packed 64-byte matrices.
    pub const INSTANCE_MATRIX: Self = Self::InstanceMatrix {
        array_stride: 64,
        offset: 0,
    };
}

/// The vertex stage of a caster.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub enum CasterVertex<'a> {
    /// The library's own: a position attribute in vertex buffer slot 0 and a model transform.
    BuiltIn {
        /// Where positions are.
        position: PositionAttribute,
        /// Where the transform is.
        model: ModelTransform,
    },
    /// The engine's WGSL on top of the library's caster module, for skinning, displacement and alpha masks.
    ///
    /// The source may call `shadow_caster_clip(position_render: vec3<f32>) -> vec4<f32>` and must not use `@group(0)`.
    Wgsl {
        /// WGSL with the entry points; the caster module is put before it.
        source: &'a str,
        /// Name of the `@vertex` entry point; its `@builtin(position)` is what `shadow_caster_clip` returned.
        vertex_entry: &'a str,
        /// Name of a `@fragment` entry point without outputs, which may `discard`; none for solid casters.
        fragment_entry: Option<&'a str>,
        /// Vertex buffers, from slot 0.
        buffers: &'a [Option<wgpu::VertexBufferLayout<'a>>],
        /// Layouts of bind groups 1 and up, which the caster sets in its `draw`.
        bind_group_layouts: &'a [Option<&'a wgpu::BindGroupLayout>],
    },
}

/// What a [`CasterPipeline`] is made of.
#[derive(Clone, Copy, Debug)]
pub struct CasterPipelineDescriptor<'a> {
    /// Label of the wgpu objects.
    pub label: wgpu::Label<'a>,
    /// Vertex stage.
    pub vertex: CasterVertex<'a>,
    /// Which faces, as seen from the light, are left out of the map. `None` (the default) suits every mesh, open sheets
    /// included. `Some(Face::Front)` is the classic cure for peter-panning: it needs closed solids, and light leaks where
    /// they touch the ground exactly. `Some(Face::Back)` halves the fragments of closed solids.
    pub cull: Option<wgpu::Face>,
    /// Winding of front faces; counter-clockwise in the engine's space unless the model transform mirrors.
    pub front_face: wgpu::FrontFace,
    /// Triangle list or strip.
    pub topology: wgpu::PrimitiveTopology,
    /// Index format for strips with primitive restart; none otherwise.
    pub strip_index_format: Option<wgpu::IndexFormat>,
}

impl CasterPipelineDescriptor<'_> {
    /// Tightly packed `Float32x3` positions, one instance matrix, nothing culled.
    pub const fn new() -> Self {
        Self {
            label: None,
            vertex: CasterVertex::BuiltIn {
                position: PositionAttribute::float32x3(12),
                model: ModelTransform::INSTANCE_MATRIX,
            },
            cull: None,
            front_face: wgpu::FrontFace::Ccw,
            topology: wgpu::PrimitiveTopology::TriangleList,
            strip_index_format: None,
        }
    }
}

impl Default for CasterPipelineDescriptor<'_> {
    fn default() -> Self {
        Self::new()
    }
}

/// A depth-only pipeline for one kind of caster. Cheap to clone: a handle.
#[derive(Clone, Debug, PartialEq)]
pub struct CasterPipeline {
    pipeline: wgpu::RenderPipeline,
    /// The same with the other winding, for transforms that mirror; equal where nothing is culled.
    mirrored: wgpu::RenderPipeline,
    model: ModelTransform,
    position: Option<PositionAttribute>,
}

impl CasterPipeline {
    /// Builds the pipeline; do this once per kind of caster, at load time.
    ///
    /// # Errors
    /// [`CasterError`] for a layout or topology that cannot be drawn, or with the device's own words where it refuses the
    /// pipeline (the engine's WGSL does not compile, an entry point is missing, a layout does not match).
    pub fn new(
        device: &wgpu::Device,
        descriptor: &CasterPipelineDescriptor<'_>,
    ) -> Result<Self, CasterError> {
        check_topology(descriptor)?;
        let (position, model) = match descriptor.vertex {
            CasterVertex::BuiltIn { position, model } => {
                check_position(&position)?;
                check_model(&model)?;
                (Some(position), model)
            }
            CasterVertex::Wgsl { .. } => (None, ModelTransform::Identity),
        };
        let create_both = || {
            let pipeline = create(device, descriptor);
            let mirrored = if descriptor.cull.is_some() {
                let front_face = match descriptor.front_face {
                    wgpu::FrontFace::Ccw => wgpu::FrontFace::Cw,
                    wgpu::FrontFace::Cw => wgpu::FrontFace::Ccw,
                };
                create(
                    device,
                    &CasterPipelineDescriptor {
                        front_face,
                        ..*descriptor
                    },
                )
            } else {
                pipeline.clone()
            };
            Self {
                pipeline,
                mirrored,
                model,
                position,
            }
        };
        capture_device_errors(device, create_both).map_err(|refusal| CasterError::Device {
            message: match refusal {
                DeviceRefusal::OutOfMemory => "out of memory".to_owned(),
                DeviceRefusal::Refused(message) => message,
            },
        })
    }

    /// The wgpu pipeline, for engines that record depth passes of their own.
    pub fn wgpu_pipeline(&self) -> &wgpu::RenderPipeline {
        &self.pipeline
    }

    /// The same pipeline for casters whose transform mirrors (negative determinant), so that culling takes the same faces.
    pub fn mirrored(&self) -> Self {
        Self {
            pipeline: self.mirrored.clone(),
            mirrored: self.pipeline.clone(),
            ..*self
        }
    }

    /// Bytes that a vertex buffer must have to hold `vertices`; 0 where the engine lays its own vertices out.
    pub(crate) fn vertex_bytes(&self, vertices: &std::ops::Range<u32>) -> u64 {
        self.position.map_or(0, |position| {
            let last = vertices.end.saturating_sub(1);
            let size = position.offset + position.format.size();
            if vertices.is_empty() {
                0
            } else {
                u64::from(last) * position.array_stride + size
            }
        })
    }

    /// Where the built-in vertex stage expects the transform ([`ModelTransform::Identity`] for the engine's own WGSL).
    pub fn model_transform(&self) -> ModelTransform {
        self.model
    }
}

/// Layout of bind group 0 of every caster pipeline: the view being rendered, chosen by a dynamic offset.
pub(crate) fn view_bind_group_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("shadow caster view"),
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: true,
                min_binding_size: wgpu::BufferSize::new(crate::cast::recorder::VIEW_UNIFORM_BYTES),
            },
            count: None,
        }],
    })
}

fn check_topology(descriptor: &CasterPipelineDescriptor<'_>) -> Result<(), CasterError> {
    let topology = descriptor.topology;
    let strip = topology == wgpu::PrimitiveTopology::TriangleStrip;
    if !strip && topology != wgpu::PrimitiveTopology::TriangleList {
        return Err(CasterError::Topology { topology });
    }
    if descriptor.strip_index_format.is_some() && !strip {
        return Err(CasterError::StripIndexFormat { topology });
    }
    Ok(())
}

fn check_position(position: &PositionAttribute) -> Result<(), CasterError> {
    use wgpu::VertexFormat as F;
    let floats = matches!(
        position.format,
        F::Float32x2
            | F::Float32x3
            | F::Float32x4
            | F::Float16x2
            | F::Float16x4
            | F::Snorm8x2
            | F::Snorm8x4
            | F::Snorm16x2
            | F::Snorm16x4
            | F::Unorm8x2
            | F::Unorm8x4
            | F::Unorm16x2
            | F::Unorm16x4
            | F::Unorm10_10_10_2
    );
    if !floats {
        return Err(CasterError::PositionFormat {
            format: position.format,
        });
    }
    check_attribute(
        "PositionAttribute",
        position.offset,
        position.format.size(),
        position.array_stride,
    )
}

fn check_model(model: &ModelTransform) -> Result<(), CasterError> {
    match *model {
        ModelTransform::Identity => Ok(()),
        ModelTransform::InstanceMatrix {
            array_stride,
            offset,
        } => check_attribute("ModelTransform::InstanceMatrix", offset, 64, array_stride),
    }
}

fn check_attribute(
    field: &'static str,
    offset: u64,
    size: u64,
    array_stride: u64,
) -> Result<(), CasterError> {
    let inside = offset
        .checked_add(size)
        .is_some_and(|end| end <= array_stride);
    if inside && offset.is_multiple_of(4) && array_stride.is_multiple_of(4) {
        Ok(())
    } else {
        Err(CasterError::VertexLayout {
            field,
            offset,
            size,
            array_stride,
        })
    }
}

fn create(
    device: &wgpu::Device,
    descriptor: &CasterPipelineDescriptor<'_>,
) -> wgpu::RenderPipeline {
    match descriptor.vertex {
        CasterVertex::BuiltIn { position, model } => {
            let position_attribute = [wgpu::VertexAttribute {
                format: position.format,
                offset: position.offset,
                shader_location: 0,
            }];
            let position_layout = wgpu::VertexBufferLayout {
                array_stride: position.array_stride,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &position_attribute,
            };
            let (entry, matrix) = match model {
                ModelTransform::Identity => ("shadow_caster_vertex_identity", None),
                ModelTransform::InstanceMatrix {
                    array_stride,
                    offset,
                } => (
                    "shadow_caster_vertex_instance",
                    Some((array_stride, offset)),
                ),
            };
            let columns = [1, 2, 3, 4].map(|location| wgpu::VertexAttribute {
                format: wgpu::VertexFormat::Float32x4,
                offset: matrix.map_or(0, |(_, offset)| offset) + 16 * u64::from(location - 1),
                shader_location: location,
            });
            let matrix_layout = matrix.map(|(array_stride, _)| wgpu::VertexBufferLayout {
                array_stride,
                step_mode: wgpu::VertexStepMode::Instance,
                attributes: &columns,
            });
            let layouts = [Some(position_layout), matrix_layout];
            let used = if matrix.is_some() { 2 } else { 1 };
            let source = format!("{}{}", shader::CASTER.source, shader::CASTER_BUILTIN.source);
            create_from(
                device,
                descriptor,
                &source,
                entry,
                None,
                &layouts[..used],
                &[],
            )
        }
        CasterVertex::Wgsl {
            source,
            vertex_entry,
            fragment_entry,
            buffers,
            bind_group_layouts,
        } => {
            let source = format!("{}{source}", shader::CASTER.source);
            create_from(
                device,
                descriptor,
                &source,
                vertex_entry,
                fragment_entry,
                buffers,
                bind_group_layouts,
            )
        }
    }
}

fn create_from(
    device: &wgpu::Device,
    descriptor: &CasterPipelineDescriptor<'_>,
    source: &str,
    vertex_entry: &str,
    fragment_entry: Option<&str>,
    buffers: &[Option<wgpu::VertexBufferLayout<'_>>],
    bind_group_layouts: &[Option<&wgpu::BindGroupLayout>],
) -> wgpu::RenderPipeline {
    let label = descriptor.label.unwrap_or("shadow caster");
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(label),
        source: wgpu::ShaderSource::Wgsl(source.into()),
    });
    let view_layout = view_bind_group_layout(device);
    let mut groups = vec![Some(&view_layout)];
    groups.extend_from_slice(bind_group_layouts);
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(label),
        bind_group_layouts: &groups,
        immediate_size: 0,
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(label),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some(vertex_entry),
            compilation_options: Default::default(),
            buffers,
        },
        primitive: wgpu::PrimitiveState {
            topology: descriptor.topology,
            strip_index_format: descriptor.strip_index_format,
            front_face: descriptor.front_face,
            cull_mode: descriptor.cull,
            ..Default::default()
        },
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH_FORMAT,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::GreaterEqual),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState::default(),
        fragment: fragment_entry.map(|entry| wgpu::FragmentState {
            module: &module,
            entry_point: Some(entry),
            compilation_options: Default::default(),
            targets: &[],
        }),
        multiview_mask: None,
        cache: None,
    })
}
