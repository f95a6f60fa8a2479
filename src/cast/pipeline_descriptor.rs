//! Describes what a caster pipeline is made of: the layout of vertices and transforms and how they
//! are shaded. Also checks that it can be drawn.

use crate::error::CasterError;
use crate::gpu::DepthFormat;

/// Tells the built-in vertex stage where to find positions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PositionAttribute {
    /// Is the number of bytes from one vertex to the next; a multiple of 4.
    pub array_stride: u64,
    /// Is the number of bytes from the start of a vertex to its position; a multiple of 4. The
    /// position must end within `array_stride`.
    pub offset: u64,
    /// May be any float, snorm or unorm format of two to four components. A missing z is 0, and a
    /// fourth component is ignored.
    pub format: wgpu::VertexFormat,
}

impl PositionAttribute {
    /// Makes an attribute of `Float32x3` at the start of vertices of `array_stride` bytes.
    pub const fn float32x3(array_stride: u64) -> Self {
        Self {
            array_stride,
            offset: 0,
            format: wgpu::VertexFormat::Float32x3,
        }
    }
}

/// Tells the built-in vertex stage where to find the transform that takes positions to render
/// space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ModelTransform {
    /// States that positions are in render space already.
    Identity,
    /// Reads four `Float32x4` columns of `render_from_model` from vertex buffer slot 1, stepped
    /// once per instance.
    InstanceMatrix {
        /// Is the number of bytes from one instance to the next; a multiple of 4, at least `offset`
        /// + 64.
        array_stride: u64,
        /// Is the number of bytes from the start of an instance to the matrix; a multiple of 4.
        offset: u64,
    },
}

impl ModelTransform {
    /// Describes tightly packed 64-byte matrices.
    pub const INSTANCE_MATRIX: Self = Self::InstanceMatrix {
        array_stride: 64,
        offset: 0,
    };
}

/// Selects the vertex stage of a caster.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub enum CasterVertex<'a> {
    /// Uses the library's own stage: a position attribute in vertex buffer slot 0 and a model
    /// transform.
    BuiltIn {
        /// Tells where positions are.
        position: PositionAttribute,
        /// Tells where the transform is.
        model: ModelTransform,
    },
    /// Puts the engine's WGSL behind the library's caster module, for skinning, displacement and
    /// alpha masks.
    ///
    /// The source may call `shadow_caster_clip(position_render: vec3<f32>) -> vec4<f32>` and must
    /// not use `@group(0)`. It is drawn into one view at a time: a point light with such a caster
    /// draws a pass for each face.
    Wgsl {
        /// Contains the WGSL with the entry points; the caster module is put before it.
        source: &'a str,
        /// Names the `@vertex` entry point; its `@builtin(position)` is what `shadow_caster_clip`
        /// returned.
        vertex_entry: &'a str,
        /// Names a `@fragment` entry point without outputs, which may `discard`; `None` for opaque
        /// casters.
        fragment_entry: Option<&'a str>,
        /// Lists the vertex buffers, from slot 0.
        buffers: &'a [Option<wgpu::VertexBufferLayout<'a>>],
        /// Lists the layouts of bind groups 1 and up, which the caster sets in its `draw`.
        bind_group_layouts: &'a [Option<&'a wgpu::BindGroupLayout>],
    },
}

/// Describes what a [`CasterPipeline`](crate::CasterPipeline) is made of.
/// [`CasterPipeline::new`](crate::CasterPipeline::new) checks it, and returns
/// [`CasterError`](crate::error::CasterError) for what cannot be drawn.
#[derive(Clone, Copy, Debug)]
pub struct CasterPipelineDescriptor<'a> {
    /// Labels the wgpu objects; "shadow caster" if `None`.
    pub label: wgpu::Label<'a>,
    /// Selects the vertex stage. The default reads tightly packed `Float32x3` positions and one
    /// instance matrix.
    pub vertex: CasterVertex<'a>,
    /// Topology, winding and culling, as wgpu has them.
    ///
    /// The topology is a triangle list or strip; a strip that is drawn through indices needs their
    /// format in `strip_index_format`, and a list must not have one. Front faces are those that
    /// `front_face` says in the engine's space, unless the model transform mirrors. `cull_mode`
    /// names the faces, as seen from the light, that are left out of the map: `None` (the default)
    /// suits every mesh, open sheets included. `Some(Face::Front)` is the classic cure for
    /// peter-panning: it needs closed solids, and light leaks where they touch the ground exactly.
    /// `Some(Face::Back)` takes a third off the cost of closed solids and changes nothing of their
    /// shadows; [`is_closed_solid`](crate::caster::is_closed_solid) tells them. Polygons are
    /// filled, depths are clipped and rasterization is not conservative: a map of outlines, or of
    /// depths beyond its range, is no shadow map.
    pub primitive: wgpu::PrimitiveState,
    /// Lists the formats of the maps that it will be drawn into; not empty. The default is
    /// `Float32` alone; add `Unorm16` where a light has such a map. Each format is one more wgpu
    /// pipeline. A light whose format is missing returns
    /// [`ShadowError::CasterFormat`](crate::ShadowError::CasterFormat) when it is recorded.
    pub depth_formats: &'a [DepthFormat],
}

impl CasterPipelineDescriptor<'_> {
    /// Describes tightly packed `Float32x3` positions and one instance matrix, with nothing culled.
    pub const fn new() -> Self {
        Self {
            label: None,
            vertex: CasterVertex::BuiltIn {
                position: PositionAttribute::float32x3(12),
                model: ModelTransform::INSTANCE_MATRIX,
            },
            primitive: wgpu::PrimitiveState {
                topology: wgpu::PrimitiveTopology::TriangleList,
                strip_index_format: None,
                front_face: wgpu::FrontFace::Ccw,
                cull_mode: None,
                unclipped_depth: false,
                polygon_mode: wgpu::PolygonMode::Fill,
                conservative: false,
            },
            depth_formats: &[DepthFormat::Float32],
        }
    }
}

impl Default for CasterPipelineDescriptor<'_> {
    fn default() -> Self {
        Self::new()
    }
}

pub(crate) fn check_primitive(primitive: &wgpu::PrimitiveState) -> Result<(), CasterError> {
    let topology = primitive.topology;
    let strip = topology == wgpu::PrimitiveTopology::TriangleStrip;
    if !strip && topology != wgpu::PrimitiveTopology::TriangleList {
        return Err(CasterError::Topology { topology });
    }
    if primitive.strip_index_format.is_some() && !strip {
        return Err(CasterError::StripIndexFormat { topology });
    }
    let plain = wgpu::PrimitiveState {
        unclipped_depth: false,
        polygon_mode: wgpu::PolygonMode::Fill,
        conservative: false,
        ..*primitive
    };
    if *primitive != plain {
        return Err(CasterError::Primitive {
            unclipped_depth: primitive.unclipped_depth,
            polygon_mode: primitive.polygon_mode,
            conservative: primitive.conservative,
        });
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
