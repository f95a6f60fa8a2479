//! Checks that what ready-made casters are made of can be drawn in every frame.

use std::ops::Range;

use glam::Mat4;

use crate::cast::CasterPipeline;
use crate::cast::mesh_descriptor::MeshIndices;
use crate::error::CasterError;
use crate::error::DeviceError;
use crate::gpu::capture_device_errors;
use crate::{Aabb, error::DeviceRefusal};

/// Holds the paths of the fields of a descriptor, for errors.
#[derive(Debug)]
pub(crate) struct MeshFields {
    pub pipeline: &'static str,
    pub vertices: &'static str,
    pub vertex_range: &'static str,
    pub index_buffer: &'static str,
    pub index_format: &'static str,
    pub index_range: &'static str,
    pub bounds_model: &'static str,
}

pub(crate) const MESH: MeshFields = MeshFields {
    pipeline: "MeshCasterDescriptor::pipeline",
    vertices: "MeshCasterDescriptor::vertices",
    vertex_range: "MeshCasterDescriptor::indices.vertices",
    index_buffer: "MeshCasterDescriptor::indices.buffer",
    index_format: "MeshCasterDescriptor::indices.format",
    index_range: "MeshCasterDescriptor::indices.indices",
    bounds_model: "MeshCasterDescriptor::bounds_model",
};

pub(crate) const INSTANCED_MESH: MeshFields = MeshFields {
    pipeline: "InstancedMeshCasterDescriptor::pipeline",
    vertices: "InstancedMeshCasterDescriptor::vertices",
    vertex_range: "InstancedMeshCasterDescriptor::indices.vertices",
    index_buffer: "InstancedMeshCasterDescriptor::indices.buffer",
    index_format: "InstancedMeshCasterDescriptor::indices.format",
    index_range: "InstancedMeshCasterDescriptor::indices.indices",
    bounds_model: "InstancedMeshCasterDescriptor::bounds_model",
};

pub(crate) fn check_matrix(render_from_model: &Mat4) -> Result<(), CasterError> {
    if render_from_model.is_finite() {
        Ok(())
    } else {
        Err(CasterError::NotFinite {
            field: "MeshCasterDescriptor::render_from_model",
            value: render_from_model.to_string(),
        })
    }
}

/// Accepts bounds that are finite or empty.
pub(crate) fn check_bounds(field: &'static str, bounds: &Aabb) -> Result<(), CasterError> {
    if bounds.is_empty() || bounds.is_finite() {
        Ok(())
    } else {
        Err(CasterError::NotFinite {
            field,
            value: format!("{}..{}", bounds.min, bounds.max),
        })
    }
}

/// Accepts pipelines of `device` for which a mesh sets everything that they read.
pub(crate) fn check_pipeline(
    fields: &MeshFields,
    device: &wgpu::Device,
    pipeline: &CasterPipeline,
) -> Result<(), CasterError> {
    let field = fields.pipeline;
    if pipeline.device() != device {
        return Err(CasterError::OtherDevice { field });
    }
    match pipeline.beyond_a_mesh() {
        None => Ok(()),
        Some(needs) => Err(CasterError::MeshPipeline { field, needs }),
    }
}

/// Accepts buffers of the pipeline's device that hold the ranges that are drawn.
pub(crate) fn check_buffers(
    fields: &MeshFields,
    pipeline: &CasterPipeline,
    vertices: &wgpu::Buffer,
    indices: &MeshIndices,
) -> Result<(), CasterError> {
    if !vertices.usage().contains(wgpu::BufferUsages::VERTEX) {
        return Err(CasterError::BufferUsage {
            field: fields.vertices,
            usage: "BufferUsages::VERTEX",
        });
    }
    let drawn = match indices {
        MeshIndices::None { vertices } => {
            check_range(fields.vertex_range, vertices)?;
            vertices.end
        }
        MeshIndices::Buffer { .. } => 0,
    };
    require(
        fields.vertices,
        pipeline.vertex_bytes(drawn).max(1),
        vertices.size(),
    )?;
    if let MeshIndices::Buffer {
        buffer,
        format,
        indices,
        ..
    } = indices
    {
        check_range(fields.index_range, indices)?;
        check_indices(fields, pipeline, buffer, *format, indices)?;
    }
    check_owner(fields, pipeline.device(), vertices, indices)
}

fn check_indices(
    fields: &MeshFields,
    pipeline: &CasterPipeline,
    buffer: &wgpu::Buffer,
    format: wgpu::IndexFormat,
    indices: &Range<u32>,
) -> Result<(), CasterError> {
    let field = fields.index_buffer;
    if let Some(expected) = pipeline.strip_index_format() {
        if expected != Some(format) {
            return Err(CasterError::IndexFormat {
                field: fields.index_format,
                expected,
                format,
            });
        }
    }
    if !buffer.usage().contains(wgpu::BufferUsages::INDEX) {
        return Err(CasterError::BufferUsage {
            field,
            usage: "BufferUsages::INDEX",
        });
    }
    let index_bytes = match format {
        wgpu::IndexFormat::Uint16 => 2,
        wgpu::IndexFormat::Uint32 => 4,
    };
    require(field, u64::from(indices.end) * index_bytes, buffer.size())
}

/// Accepts buffers of `device`. A buffer does not tell which device it belongs to; wgpu reports a
/// mismatch when an encoder that uses the buffer is finished, so this finishes an encoder that is
/// then thrown away.
fn check_owner(
    fields: &MeshFields,
    device: &wgpu::Device,
    vertices: &wgpu::Buffer,
    indices: &MeshIndices,
) -> Result<(), CasterError> {
    let check = |field, buffer, state| {
        let commands = || {
            let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor {
                label: Some("shadow mesh caster"),
            });
            let transition = wgpu::BufferTransition { buffer, state };
            encoder.transition_resources(std::iter::once(transition), std::iter::empty());
            encoder.finish()
        };
        match capture_device_errors(device, commands) {
            Ok(_) => Ok(()),
            Err(refusal @ DeviceRefusal::Refused(_)) => Err(CasterError::Buffer { field, refusal }),
            Err(refusal) => Err(CasterError::Device(DeviceError {
                object: "a mesh",
                refusal,
            })),
        }
    };
    check(fields.vertices, vertices, wgpu::BufferUses::VERTEX)?;
    match indices {
        MeshIndices::None { .. } => Ok(()),
        MeshIndices::Buffer { buffer, .. } => {
            check(fields.index_buffer, buffer, wgpu::BufferUses::INDEX)
        }
    }
}

fn check_range(field: &'static str, range: &Range<u32>) -> Result<(), CasterError> {
    if range.is_empty() {
        Err(CasterError::EmptyRange {
            field,
            start: range.start,
            end: range.end,
        })
    } else {
        Ok(())
    }
}

fn require(field: &'static str, needed: u64, got: u64) -> Result<(), CasterError> {
    if needed <= got {
        Ok(())
    } else {
        Err(CasterError::BufferTooSmall { field, needed, got })
    }
}
