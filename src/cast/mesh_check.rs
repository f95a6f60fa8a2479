//! Checks that what a [`MeshCaster`](crate::MeshCaster) is made of can be drawn in every frame.

use std::ops::Range;

use glam::Mat4;

use crate::cast::CasterPipeline;
use crate::cast::mesh_descriptor::MeshIndices;
use crate::error::CasterError;
use crate::error::DeviceError;
use crate::gpu::capture_device_errors;
use crate::{Aabb, error::DeviceRefusal};

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
    device: &wgpu::Device,
    pipeline: &CasterPipeline,
) -> Result<(), CasterError> {
    let field = "MeshCasterDescriptor::pipeline";
    if pipeline.device() != device {
        return Err(CasterError::OtherDevice { field });
    }
    match pipeline.beyond_a_mesh() {
        None => Ok(()),
        Some(needs) => Err(CasterError::MeshPipeline { needs }),
    }
}

/// Accepts buffers of the pipeline's device that hold the ranges that are drawn.
pub(crate) fn check_buffers(
    pipeline: &CasterPipeline,
    vertices: &wgpu::Buffer,
    indices: &MeshIndices,
) -> Result<(), CasterError> {
    if !vertices.usage().contains(wgpu::BufferUsages::VERTEX) {
        return Err(CasterError::BufferUsage {
            field: "MeshCasterDescriptor::vertices",
            usage: "BufferUsages::VERTEX",
        });
    }
    let drawn = match indices {
        MeshIndices::None { vertices } => {
            check_range("MeshCasterDescriptor::indices.vertices", vertices)?;
            vertices.end
        }
        MeshIndices::Buffer { .. } => 0,
    };
    require(
        "MeshCasterDescriptor::vertices",
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
        check_range("MeshCasterDescriptor::indices.indices", indices)?;
        check_indices(pipeline, buffer, *format, indices)?;
    }
    check_owner(pipeline.device(), vertices, indices)
}

fn check_indices(
    pipeline: &CasterPipeline,
    buffer: &wgpu::Buffer,
    format: wgpu::IndexFormat,
    indices: &Range<u32>,
) -> Result<(), CasterError> {
    let field = "MeshCasterDescriptor::indices.buffer";
    if let Some(expected) = pipeline.strip_index_format() {
        if expected != Some(format) {
            return Err(CasterError::IndexFormat { expected, format });
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
    check(
        "MeshCasterDescriptor::vertices",
        vertices,
        wgpu::BufferUses::VERTEX,
    )?;
    match indices {
        MeshIndices::None { .. } => Ok(()),
        MeshIndices::Buffer { buffer, .. } => check(
            "MeshCasterDescriptor::indices.buffer",
            buffer,
            wgpu::BufferUses::INDEX,
        ),
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
