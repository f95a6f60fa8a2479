//! How one kind of caster is laid out and shaded: the depth-only pipelines.

use std::sync::Arc;

use crate::cast::caster_limits::check_caster;
use crate::cast::cube_pipeline::CubePipelines;
use crate::cast::pipeline_build::{ByFormat, create_pipelines};
use crate::cast::pipeline_descriptor::{
    CasterPipelineDescriptor, CasterVertex, ModelTransform, PositionAttribute, check_model,
    check_position, check_topology,
};
use crate::cast::pipeline_reads::{VertexReads, beyond_a_mesh};
use crate::error::CasterError;
use crate::gpu::{DepthFormat, capture_device_errors};

/// Depth-only pipelines for one kind of caster. Cheap to clone: a handle.
#[derive(Clone, Debug)]
pub struct CasterPipeline {
    variants: Arc<Variants>,
    /// For transforms that mirror: the other winding.
    mirrored: bool,
}

#[derive(Debug)]
struct Variants {
    device: wgpu::Device,
    by_format: ByFormat,
    /// None for the engine's own WGSL.
    built_in: Option<(PositionAttribute, ModelTransform)>,
    /// How vertex buffer 0 is read.
    vertices: VertexReads,
    /// What it takes that a ready-made mesh does not set.
    beyond_a_mesh: Option<String>,
    cube: Option<CubePipelines>,
    topology: wgpu::PrimitiveTopology,
    strip_index_format: Option<wgpu::IndexFormat>,
}

impl PartialEq for CasterPipeline {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.variants, &other.variants) && self.mirrored == other.mirrored
    }
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
        if descriptor.depth_formats.is_empty() {
            return Err(CasterError::NoDepthFormat);
        }
        let built_in = match descriptor.vertex {
            CasterVertex::BuiltIn { position, model } => {
                check_position(&position)?;
                check_model(&model)?;
                Some((position, model))
            }
            CasterVertex::Wgsl { .. } => None,
        };
        check_caster(device, descriptor)?;
        let by_format = capture_device_errors(device, || create_pipelines(device, descriptor))
            .map_err(|refusal| CasterError::Device {
                object: "a caster pipeline",
                refusal,
            })?;
        Ok(Self {
            variants: Arc::new(Variants {
                device: device.clone(),
                by_format,
                built_in,
                vertices: VertexReads::of(&descriptor.vertex),
                beyond_a_mesh: beyond_a_mesh(&descriptor.vertex),
                cube: CubePipelines::of(descriptor),
                topology: descriptor.topology,
                strip_index_format: descriptor.strip_index_format,
            }),
            mirrored: false,
        })
    }

    /// The wgpu pipeline for maps of `format`, for engines that record depth passes of their own; none where
    /// [`CasterPipelineDescriptor::depth_formats`] did not name it.
    pub fn wgpu_pipeline(&self, format: DepthFormat) -> Option<&wgpu::RenderPipeline> {
        let windings = self.variants.by_format[format.index()].as_ref()?;
        Some(&windings[usize::from(self.mirrored)])
    }

    /// The same pipeline for casters whose transform mirrors (negative determinant), so that culling takes the same faces.
    pub fn mirrored(&self) -> Self {
        Self {
            variants: Arc::clone(&self.variants),
            mirrored: !self.mirrored,
        }
    }

    /// Where the built-in vertex stage expects the transform ([`ModelTransform::Identity`] for the engine's own WGSL).
    pub fn model_transform(&self) -> ModelTransform {
        self.variants
            .built_in
            .map_or(ModelTransform::Identity, |(_, model)| model)
    }

    /// Returns the device that it was made on.
    pub(crate) fn device(&self) -> &wgpu::Device {
        &self.variants.device
    }

    /// Returns the pipeline that draws the six faces of a cube in one pass; none for the engine's own WGSL.
    pub(crate) fn six_views(&self) -> Option<&wgpu::RenderPipeline> {
        let variants = &self.variants;
        variants.cube.as_ref()?.get(&variants.device, self.mirrored)
    }

    /// Triangles of so many corners; of a strip, without counting restarts.
    pub(crate) fn triangles_of(&self, corners: u32) -> u32 {
        match self.variants.topology {
            wgpu::PrimitiveTopology::TriangleStrip => corners.saturating_sub(2),
            _ => corners / 3,
        }
    }

    /// For strips, the format that indices must have; none where any will do.
    pub(crate) fn strip_index_format(&self) -> Option<Option<wgpu::IndexFormat>> {
        let is_strip = self.variants.topology == wgpu::PrimitiveTopology::TriangleStrip;
        is_strip.then_some(self.variants.strip_index_format)
    }

    /// Returns the bytes that vertex buffer 0 must have so that `vertices` vertices can be drawn in order, or any through
    /// indices if it is 0.
    pub(crate) fn vertex_bytes(&self, vertices: u32) -> u64 {
        self.variants.vertices.bytes(vertices)
    }

    /// Returns what the pipeline takes that a ready-made mesh does not set.
    pub(crate) fn beyond_a_mesh(&self) -> Option<String> {
        self.variants.beyond_a_mesh.clone()
    }
}
