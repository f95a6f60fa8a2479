//! What a caster pipeline is made of: where its vertices and transforms lie, how they are shaded, and what of that can be drawn.

use crate::error::CasterError;
use crate::gpu::DepthFormat;

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
    /// The source may call `shadow_caster_clip(position_render: vec3<f32>) -> vec4<f32>` and must not use `@group(0)`. It is
    /// drawn into one view at a time: a point light with such a caster draws a pass for each face.
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
    /// they touch the ground exactly. `Some(Face::Back)` takes a
    /// third off the cost of closed solids and changes nothing of their shadows; [`is_closed_solid`](crate::is_closed_solid)
    /// tells them.
    pub cull: Option<wgpu::Face>,
    /// Winding of front faces; counter-clockwise in the engine's space unless the model transform mirrors.
    pub front_face: wgpu::FrontFace,
    /// Triangle list or strip.
    pub topology: wgpu::PrimitiveTopology,
    /// Index format for strips with primitive restart; none otherwise.
    pub strip_index_format: Option<wgpu::IndexFormat>,
    /// Formats of the maps that it will be drawn into; not empty. Default `Float32` alone; add `Unorm16` where a light has
    /// such a map. Each format is one more wgpu pipeline.
    pub depth_formats: &'a [DepthFormat],
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
            depth_formats: &[DepthFormat::Float32],
        }
    }
}

impl Default for CasterPipelineDescriptor<'_> {
    fn default() -> Self {
        Self::new()
    }
}

pub(crate) fn check_topology(descriptor: &CasterPipelineDescriptor<'_>) -> Result<(), CasterError> {
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

pub(crate) fn check_position(position: &PositionAttribute) -> Result<(), CasterError> {
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

pub(crate) fn check_model(model: &ModelTransform) -> Result<(), CasterError> {
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
