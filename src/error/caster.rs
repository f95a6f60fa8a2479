//! Defines what caster pipelines and meshes refuse.

use thiserror::Error;

use crate::error::{DeviceError, DeviceRefusal};

/// Tells why [`CasterPipeline::new`](crate::CasterPipeline::new),
/// [`MeshCaster::new`](crate::MeshCaster::new),
/// [`InstancedMeshCaster::new`](crate::InstancedMeshCaster::new) or a later change of a mesh
/// failed.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum CasterError {
    /// The built-in vertex stage cannot read the position attribute as floats.
    #[error(
        "PositionAttribute::format must be a float, snorm or unorm format of 2 to 4 components, got {format:?}"
    )]
    PositionFormat {
        /// Is the format in the descriptor.
        format: wgpu::VertexFormat,
    },
    /// An attribute does not end within its vertex, or its offset or stride is not a multiple of 4
    /// bytes.
    #[error(
        "{field}: offset {offset} + {size} bytes must lie inside the stride of {array_stride} bytes, and offset and stride must be multiples of 4"
    )]
    VertexLayout {
        /// Is the path of the field.
        field: &'static str,
        /// Is the offset of the attribute in bytes.
        offset: u64,
        /// Is the size of the attribute in bytes.
        size: u64,
        /// Is the stride of the attribute's buffer in bytes.
        array_stride: u64,
    },
    /// A pipeline or the matrices of instances need more of a resource than the limits with which
    /// the device was created allow.
    #[error("{field}: the device's {limit} must be at least {value}, and it is {maximum}")]
    OverDeviceLimit {
        /// Is the path of the field.
        field: &'static str,
        /// Is the name of the limit in `wgpu::Limits`.
        limit: &'static str,
        /// Is the limit of the device, in its own unit.
        maximum: u64,
        /// Is the amount that is needed, in the same unit.
        value: u64,
    },
    /// The list of depth formats is empty, so that the pipeline could be used with no map.
    #[error("CasterPipelineDescriptor::depth_formats must not be empty")]
    NoDepthFormat,
    /// A strip index format is given with a topology that is not a strip.
    #[error(
        "CasterPipelineDescriptor::primitive.strip_index_format goes with strip topologies only, got {topology:?}"
    )]
    StripIndexFormat {
        /// Is the topology in the descriptor.
        topology: wgpu::PrimitiveTopology,
    },
    /// The primitive state draws outlines or points, does not clip depths, or rasterizes
    /// conservatively. None of these gives a correct shadow map.
    #[error(
        "CasterPipelineDescriptor::primitive must fill polygons, clip depths and not be conservative, got {polygon_mode:?}, unclipped_depth {unclipped_depth}, conservative {conservative}"
    )]
    Primitive {
        /// Is the value in the descriptor; it must be false.
        unclipped_depth: bool,
        /// Is the value in the descriptor; it must be `PolygonMode::Fill`.
        polygon_mode: wgpu::PolygonMode,
        /// Is the value in the descriptor; it must be false.
        conservative: bool,
    },
    /// The topology is one of lines or points. Only triangles cast a shadow for which a receiver's
    /// bias can be derived.
    #[error(
        "CasterPipelineDescriptor::primitive.topology must be a triangle topology, got {topology:?}"
    )]
    Topology {
        /// Is the topology in the descriptor.
        topology: wgpu::PrimitiveTopology,
    },
    /// An object was made on another device than the one that is passed.
    #[error("{field} must have been made on the device that is passed")]
    OtherDevice {
        /// Is the path of the field.
        field: &'static str,
    },
    /// The device cannot use a buffer: most often because the buffer belongs to another device, or
    /// because its creation failed.
    #[error("{field} cannot be used on the device: {refusal}")]
    Buffer {
        /// Is the path of the field.
        field: &'static str,
        /// Tells why the device cannot use the buffer.
        refusal: DeviceRefusal,
    },
    /// The pipeline has the engine's own vertex stage, and this reads vertex buffers or bind groups
    /// that a ready-made mesh does not set.
    #[error(
        "{field} must take no more than vertex buffer 0 and no bind group of its own, got one that takes {needs}"
    )]
    MeshPipeline {
        /// Is the path of the field.
        field: &'static str,
        /// Names what else the pipeline reads, such as "vertex buffer 1" or "bind group 1".
        needs: String,
    },
    /// The pipeline reads no matrix for each instance, so that all copies would lie in one place.
    #[error("{field} must have the built-in vertex stage with an instance matrix")]
    NoInstanceMatrix {
        /// Is the path of the field.
        field: &'static str,
    },
    /// The device did not create an object: it is lost or out of memory, or it refused the object.
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// A number that must be finite is NaN or infinite.
    #[error("{field} must be finite, got {value}")]
    NotFinite {
        /// Is the path of the field.
        field: &'static str,
        /// Is the value, formatted.
        value: String,
    },
    /// A buffer is too small for the range of indices or vertices that is drawn from it.
    #[error("{field} must hold {needed} bytes, got {got}")]
    BufferTooSmall {
        /// Is the path of the field.
        field: &'static str,
        /// Is the number of bytes that the range needs.
        needed: u64,
        /// Is the number of bytes that the buffer has.
        got: u64,
    },
    /// A range of indices or vertices is empty, or ends before it begins.
    #[error("{field} must not be empty, got {start}..{end}")]
    EmptyRange {
        /// Is the path of the field.
        field: &'static str,
        /// Is the start of the range.
        start: u32,
        /// Is the end of the range, one past its last element.
        end: u32,
    },
    /// The indices have another format than the one with which the pipeline restarts its strips.
    #[error(
        "{field} must be the strip index format of the pipeline ({expected:?}), got {format:?}"
    )]
    IndexFormat {
        /// Is the path of the field.
        field: &'static str,
        /// Is the pipeline's strip index format.
        expected: Option<wgpu::IndexFormat>,
        /// Is the mesh's index format.
        format: wgpu::IndexFormat,
    },
    /// A buffer was created without the usage that drawing with it needs.
    #[error("{field} must be created with {usage}")]
    BufferUsage {
        /// Is the path of the field.
        field: &'static str,
        /// Is the name of the missing usage flag.
        usage: &'static str,
    },
    /// A call names instances that the caster does not have.
    #[error("{field} must lie in the {count} instances of the caster, got {start}..{end}")]
    NoSuchInstance {
        /// Is the name of the parameter.
        field: &'static str,
        /// Is the first index that the call names.
        start: usize,
        /// Is one past the last index that the call names.
        end: usize,
        /// Is the number of instances of the caster.
        count: usize,
    },
}
