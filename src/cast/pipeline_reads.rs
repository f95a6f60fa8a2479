//! Describes what a caster pipeline reads beyond the view, so that a mesh can be checked against
//! it.

use crate::cast::CasterVertex;

/// Describes how vertex buffer 0 is read.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct VertexReads {
    array_stride: u64,
    /// Is the end of the last attribute within its vertex or instance; 0 where nothing is read.
    last_attribute_end: u64,
    per_instance: bool,
}

impl VertexReads {
    pub(super) fn of(vertex: &CasterVertex<'_>) -> Self {
        match *vertex {
            CasterVertex::BuiltIn { position, .. } => Self {
                array_stride: position.array_stride,
                last_attribute_end: position.offset + position.format.size(),
                per_instance: false,
            },
            CasterVertex::Wgsl { buffers, .. } => {
                let Some(Some(layout)) = buffers.first() else {
                    return Self::default();
                };
                let ends = layout.attributes.iter();
                let ends = ends.map(|read| read.offset.saturating_add(read.format.size()));
                Self {
                    array_stride: layout.array_stride,
                    last_attribute_end: ends.max().unwrap_or(0),
                    per_instance: layout.step_mode == wgpu::VertexStepMode::Instance,
                }
            }
        }
    }

    /// Returns the bytes that the buffer must have for `vertices` vertices of one instance.
    pub(super) fn bytes(&self, vertices: u32) -> u64 {
        let steps = if self.per_instance { 1 } else { vertices };
        match steps.checked_sub(1) {
            Some(last) => u64::from(last)
                .saturating_mul(self.array_stride)
                .saturating_add(self.last_attribute_end),
            None => 0,
        }
    }
}

/// Returns what a vertex stage takes beyond vertex buffer 0 and, for the built-in stages, the
/// matrix in buffer 1.
pub(crate) fn beyond_a_mesh(vertex: &CasterVertex<'_>) -> Option<String> {
    let CasterVertex::Wgsl {
        buffers,
        bind_group_layouts,
        ..
    } = *vertex
    else {
        return None;
    };
    let buffer = buffers.iter().skip(1).position(Option::is_some);
    let group = bind_group_layouts.iter().position(Option::is_some);
    buffer
        .map(|slot| format!("vertex buffer {}", slot + 1))
        .or(group.map(|group| format!("bind group {}", group + 1)))
}
