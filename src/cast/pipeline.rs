//! Defines `CasterPipeline`: the depth-only pipelines of one kind of caster.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::cast::caster_limits::check_caster;
use crate::cast::cube_pipeline::CubePipelines;
use crate::cast::pipeline_build::{ByFormat, create_pipelines};
use crate::cast::pipeline_descriptor::{
    CasterPipelineDescriptor, CasterVertex, ModelTransform, PositionAttribute, check_model,
    check_position, check_primitive,
};
use crate::cast::pipeline_reads::{VertexReads, beyond_a_mesh};
use crate::error::CasterError;
use crate::error::DeviceError;
use crate::gpu::{DepthFormat, capture_device_errors};

/// Holds the depth-only pipelines of one kind of caster. It is a handle and cheap to clone.
#[derive(Clone, Debug)]
pub struct CasterPipeline {
    variants: Arc<Variants>,
    /// Selects the other winding, for transforms that mirror.
    mirrored: bool,
}

#[derive(Debug)]
struct Variants {
    /// Numbers the pipelines in the order of their creation.
    number: u64,
    device: wgpu::Device,
    by_format: ByFormat,
    /// Holds `None` for the engine's own WGSL.
    built_in: Option<(PositionAttribute, ModelTransform)>,
    /// Describes how vertex buffer 0 is read.
    vertices: VertexReads,
    /// Names what the pipeline takes that a ready-made mesh does not set.
    beyond_a_mesh: Option<String>,
    cube: Option<CubePipelines>,
    primitive: wgpu::PrimitiveState,
}

static NEXT_NUMBER: AtomicU64 = AtomicU64::new(0);

impl PartialEq for CasterPipeline {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.variants, &other.variants) && self.mirrored == other.mirrored
    }
}

impl CasterPipeline {
    /// Builds the pipelines; call this once per kind of caster, at load time.
    ///
    /// # Errors
    /// Returns [`CasterError`] for a layout or topology that cannot be drawn, for an empty list of
    /// depth formats, for more than the device's limits allow, or with the device's own message
    /// where it refuses the pipeline (the engine's WGSL does not compile, an entry point is
    /// missing, a layout does not match).
    pub fn new(
        device: &wgpu::Device,
        descriptor: &CasterPipelineDescriptor<'_>,
    ) -> Result<Self, CasterError> {
        check_primitive(&descriptor.primitive)?;
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
            .map_err(|refusal| {
                CasterError::Device(DeviceError {
                    object: "a caster pipeline",
                    refusal,
                })
            })?;
        Ok(Self {
            variants: Arc::new(Variants {
                number: NEXT_NUMBER.fetch_add(1, Ordering::Relaxed),
                device: device.clone(),
                by_format,
                built_in,
                vertices: VertexReads::of(&descriptor.vertex),
                beyond_a_mesh: beyond_a_mesh(&descriptor.vertex),
                cube: CubePipelines::of(descriptor),
                primitive: descriptor.primitive,
            }),
            mirrored: false,
        })
    }

    /// Returns the wgpu pipeline for maps of `format`, for engines that record depth passes of
    /// their own. Returns `None` if [`CasterPipelineDescriptor::depth_formats`] did not name the
    /// format.
    pub fn wgpu_pipeline(&self, format: DepthFormat) -> Option<&wgpu::RenderPipeline> {
        let windings = self.variants.by_format[format.index()].as_ref()?;
        Some(&windings[usize::from(self.mirrored)])
    }

    /// Returns the same pipeline for casters whose transform mirrors (negative determinant), so
    /// that culling removes the same faces.
    pub fn mirrored(&self) -> Self {
        Self {
            variants: Arc::clone(&self.variants),
            mirrored: !self.mirrored,
        }
    }

    /// Returns where the built-in vertex stage expects the transform ([`ModelTransform::Identity`]
    /// for the engine's own WGSL).
    pub fn model_transform(&self) -> ModelTransform {
        self.variants
            .built_in
            .map_or(ModelTransform::Identity, |(_, model)| model)
    }

    /// Returns the device that the pipelines were made on.
    pub(crate) fn device(&self) -> &wgpu::Device {
        &self.variants.device
    }

    /// Returns the pipeline that draws the six faces of a cube in one pass. Returns `None` for the
    /// engine's own WGSL, or where the device refuses it.
    pub(crate) fn multiview_pipeline(&self) -> Option<&wgpu::RenderPipeline> {
        let variants = &self.variants;
        variants.cube.as_ref()?.get(&variants.device, self.mirrored)
    }

    /// Orders pipelines by their creation. Two that draw alike have the same key.
    pub(crate) fn sort_key(&self) -> u64 {
        let culls = self.variants.primitive.cull_mode.is_some();
        self.variants.number << 1 | u64::from(self.mirrored && culls)
    }

    /// Returns whether both name the same wgpu pipelines, which a pass then sets only once.
    pub(crate) fn draws_like(&self, other: &Self) -> bool {
        self.sort_key() == other.sort_key()
    }

    /// Returns the number of triangles that `corners` vertices or indices make; for a strip,
    /// restarts are not counted.
    pub(crate) fn triangles_of(&self, corners: u32) -> u32 {
        match self.variants.primitive.topology {
            wgpu::PrimitiveTopology::TriangleStrip => corners.saturating_sub(2),
            _ => corners / 3,
        }
    }

    /// Returns, for strips, the format that indices must have. Returns `None` for lists, which
    /// accept any format.
    pub(crate) fn strip_index_format(&self) -> Option<Option<wgpu::IndexFormat>> {
        let is_strip = self.variants.primitive.topology == wgpu::PrimitiveTopology::TriangleStrip;
        is_strip.then_some(self.variants.primitive.strip_index_format)
    }

    /// Returns the bytes that vertex buffer 0 must have so that `vertices` vertices can be drawn in
    /// order. If `vertices` is 0, since indices may choose any vertex, only data that step per
    /// instance count.
    pub(crate) fn vertex_bytes(&self, vertices: u32) -> u64 {
        self.variants.vertices.bytes(vertices)
    }

    /// Returns what the pipeline takes that a ready-made mesh does not set.
    pub(crate) fn beyond_a_mesh(&self) -> Option<String> {
        self.variants.beyond_a_mesh.clone()
    }
}
