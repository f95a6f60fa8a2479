//! A ready-made caster: a vertex buffer, perhaps an index buffer, and a matrix.

use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};

use glam::Mat4;

use crate::cast::{CasterPipeline, ModelTransform, Revision, ShadowCaster, filled_buffer};
use crate::error::CasterError;
use crate::{Aabb, ShadowView};

/// What of its buffers a [`MeshCaster`] draws.
#[derive(Clone, Debug)]
pub enum MeshIndices {
    /// Vertices in order.
    None {
        /// Range of vertices.
        vertices: Range<u32>,
    },
    /// Through an index buffer created with `BufferUsages::INDEX`.
    Buffer {
        /// The buffer.
        buffer: wgpu::Buffer,
        /// Its format.
        format: wgpu::IndexFormat,
        /// Range of indices.
        indices: Range<u32>,
        /// Added to every index.
        base_vertex: i32,
    },
}

/// What a [`MeshCaster`] is made of.
#[derive(Clone, Debug)]
pub struct MeshCasterDescriptor<'a> {
    /// Label of the transform buffer.
    pub label: wgpu::Label<'a>,
    /// A pipeline with the built-in vertex stage. Where it culls and the transform mirrors, its mirrored twin is used.
    pub pipeline: &'a CasterPipeline,
    /// Vertices laid out as the pipeline says, created with `BufferUsages::VERTEX`.
    pub vertices: &'a wgpu::Buffer,
    /// What to draw.
    pub indices: MeshIndices,
    /// Bounds of the drawn vertices in model space.
    pub bounds_model: Aabb,
    /// Render space from model space: affine and finite.
    pub render_from_model: Mat4,
}

/// A mesh with one transform. Its revision changes when the transform does, so that still meshes keep their maps.
#[derive(Debug)]
pub struct MeshCaster {
    pipeline: CasterPipeline,
    vertices: wgpu::Buffer,
    indices: MeshIndices,
    bounds_model: Aabb,
    bounds_render: Aabb,
    transform: Option<wgpu::Buffer>,
    render_from_model: Mat4,
    id: u64,
    version: u64,
}

static NEXT_ID: AtomicU64 = AtomicU64::new(0);

impl MeshCaster {
    /// Keeps handles of the buffers; nothing is copied but the matrix.
    ///
    /// # Errors
    /// [`CasterError`] for a non-finite matrix, a buffer without its usage flag, index and vertex ranges that a buffer does
    /// not hold, or a device that is lost or out of memory. (A mesh that needs no matrix makes nothing on the device.)
    pub fn new(
        device: &wgpu::Device,
        descriptor: &MeshCasterDescriptor<'_>,
    ) -> Result<Self, CasterError> {
        check_matrix(&descriptor.render_from_model)?;
        check_buffers(descriptor)?;
        let has_matrix = matches!(
            descriptor.pipeline.model_transform(),
            ModelTransform::InstanceMatrix { .. }
        );
        let transform = has_matrix
            .then(|| {
                filled_buffer(
                    device,
                    descriptor.label.unwrap_or("shadow mesh caster"),
                    &matrix_bytes(descriptor.pipeline, &descriptor.render_from_model),
                    wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
                )
            })
            .transpose()
            .map_err(|refusal| CasterError::Device {
                object: "the transform of a mesh",
                refusal,
            })?;
        let mirrors = descriptor.render_from_model.determinant() < 0.0;
        let bounds_render = if has_matrix {
            descriptor
                .bounds_model
                .transformed(&descriptor.render_from_model)
        } else {
            descriptor.bounds_model
        };
        Ok(Self {
            pipeline: if has_matrix && mirrors {
                descriptor.pipeline.mirrored()
            } else {
                descriptor.pipeline.clone()
            },
            vertices: descriptor.vertices.clone(),
            indices: descriptor.indices.clone(),
            bounds_model: descriptor.bounds_model,
            bounds_render,
            transform,
            render_from_model: descriptor.render_from_model,
            id: NEXT_ID.fetch_add(1, Ordering::Relaxed),
            version: 0,
        })
    }

    /// Moves the mesh. A transform equal to the present one changes nothing. Without an instance matrix in its pipeline the
    /// mesh stands in render space and does not move.
    ///
    /// # Errors
    /// [`CasterError::NotFinite`] for a non-finite matrix; the mesh stays where it was.
    pub fn set_transform(
        &mut self,
        queue: &wgpu::Queue,
        render_from_model: Mat4,
    ) -> Result<(), CasterError> {
        check_matrix(&render_from_model)?;
        let Some(buffer) = &self.transform else {
            return Ok(());
        };
        if render_from_model == self.render_from_model {
            return Ok(());
        }
        queue.write_buffer(buffer, 0, &matrix_bytes(&self.pipeline, &render_from_model));
        if (render_from_model.determinant() < 0.0) != (self.render_from_model.determinant() < 0.0) {
            self.pipeline = self.pipeline.mirrored();
        }
        self.render_from_model = render_from_model;
        self.bounds_render = self.bounds_model.transformed(&render_from_model);
        self.version += 1;
        Ok(())
    }

    /// Render space from model space.
    pub fn render_from_model(&self) -> Mat4 {
        self.render_from_model
    }

    /// Says that the buffers' contents have changed, and where they lie now.
    pub fn geometry_changed(&mut self, bounds_model: Aabb) {
        self.bounds_model = bounds_model;
        self.bounds_render = match self.transform {
            Some(_) => bounds_model.transformed(&self.render_from_model),
            None => bounds_model,
        };
        self.version += 1;
    }
}

impl ShadowCaster for MeshCaster {
    fn bounds(&self) -> Aabb {
        self.bounds_render
    }

    fn pipeline(&self) -> &CasterPipeline {
        &self.pipeline
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, _view: &ShadowView) {
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        if let Some(transform) = &self.transform {
            pass.set_vertex_buffer(1, transform.slice(..));
        }
        match &self.indices {
            MeshIndices::None { vertices } => pass.draw(vertices.clone(), 0..1),
            MeshIndices::Buffer {
                buffer,
                format,
                indices,
                base_vertex,
            } => {
                pass.set_index_buffer(buffer.slice(..), *format);
                pass.draw_indexed(indices.clone(), *base_vertex, 0..1);
            }
        }
    }

    fn same_in_every_view(&self) -> bool {
        true
    }

    fn triangles(&self) -> u32 {
        let corners = match &self.indices {
            MeshIndices::None { vertices } => vertices.len(),
            MeshIndices::Buffer { indices, .. } => indices.len(),
        };
        self.pipeline.triangles_of(corners as u32)
    }

    fn revision(&self) -> Revision {
        Revision::of_mesh(self.id, self.version)
    }
}

/// The matrix at the place where the pipeline reads it.
fn matrix_bytes(pipeline: &CasterPipeline, matrix: &Mat4) -> Vec<u8> {
    let (array_stride, offset) = match pipeline.model_transform() {
        ModelTransform::Identity => (64, 0),
        ModelTransform::InstanceMatrix {
            array_stride,
            offset,
        } => (array_stride as usize, offset as usize),
    };
    let mut bytes = vec![0; array_stride];
    bytes[offset..offset + 64].copy_from_slice(bytemuck::bytes_of(matrix));
    bytes
}

fn check_matrix(render_from_model: &Mat4) -> Result<(), CasterError> {
    if render_from_model.is_finite() {
        Ok(())
    } else {
        Err(CasterError::NotFinite {
            field: "MeshCasterDescriptor::render_from_model",
            value: render_from_model.to_string(),
        })
    }
}

fn check_buffers(descriptor: &MeshCasterDescriptor<'_>) -> Result<(), CasterError> {
    let vertices = descriptor.vertices;
    if !vertices.usage().contains(wgpu::BufferUsages::VERTEX) {
        return Err(CasterError::BufferUsage {
            field: "MeshCasterDescriptor::vertices",
            usage: "BufferUsages::VERTEX",
        });
    }
    match &descriptor.indices {
        MeshIndices::None { vertices: range } => {
            check_range("MeshCasterDescriptor::indices.vertices", range)?;
            require(
                "MeshCasterDescriptor::vertices",
                descriptor.pipeline.vertex_bytes(range).max(1),
                vertices.size(),
            )
        }
        MeshIndices::Buffer {
            buffer,
            format,
            indices,
            ..
        } => {
            check_range("MeshCasterDescriptor::indices.indices", indices)?;
            require("MeshCasterDescriptor::vertices", 1, vertices.size())?;
            if let Some(expected) = descriptor.pipeline.strip_index_format() {
                if expected != Some(*format) {
                    return Err(CasterError::IndexFormat {
                        expected,
                        format: *format,
                    });
                }
            }
            if !buffer.usage().contains(wgpu::BufferUsages::INDEX) {
                return Err(CasterError::BufferUsage {
                    field: "MeshCasterDescriptor::indices.buffer",
                    usage: "BufferUsages::INDEX",
                });
            }
            let index_bytes = match format {
                wgpu::IndexFormat::Uint16 => 2,
                wgpu::IndexFormat::Uint32 => 4,
            };
            require(
                "MeshCasterDescriptor::indices.buffer",
                u64::from(indices.end) * index_bytes,
                buffer.size(),
            )
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
