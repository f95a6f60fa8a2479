//! Makes the pipelines that draw the six faces of a cube in one multiview pass.

use std::sync::OnceLock;

use crate::cast::pipeline_build;
use crate::cast::pipeline_build::BothWindings;
use crate::cast::pipeline_descriptor::{
    CasterPipelineDescriptor, CasterVertex, ModelTransform, PositionAttribute,
};
use crate::gpu::{DepthFormat, capture_device_errors};

/// Is the format of the maps of point lights.
const CUBE_FORMAT: DepthFormat = DepthFormat::Float32;

/// Holds what the pipelines are made from, and the pipelines once they have been needed for the
/// first time.
#[derive(Debug)]
pub(crate) struct CubePipelines {
    position: PositionAttribute,
    model: ModelTransform,
    primitive: wgpu::PrimitiveState,
    /// Holds `None` where the device refused to make them.
    made: OnceLock<Option<BothWindings>>,
}

impl CubePipelines {
    /// Returns `None` for the engine's own WGSL, whose vertex entry does not take a view index.
    pub(super) fn of(descriptor: &CasterPipelineDescriptor<'_>) -> Option<Self> {
        let CasterVertex::BuiltIn { position, model } = descriptor.vertex else {
            return None;
        };
        Some(Self {
            position,
            model,
            primitive: descriptor.primitive,
            made: OnceLock::new(),
        })
    }

    /// Returns the pipeline for transforms that mirror, or the one for all others. `device` is the
    /// one that the caster's other pipelines were made on, and has `Features::MULTIVIEW`. Returns
    /// `None` where the device refuses to make them.
    pub(super) fn get(
        &self,
        device: &wgpu::Device,
        mirrored: bool,
    ) -> Option<&wgpu::RenderPipeline> {
        let make = || {
            capture_device_errors(device, || self.make(device))
                .ok()
                .flatten()
        };
        let pipelines = self.made.get_or_init(make).as_ref()?;
        Some(&pipelines[usize::from(mirrored)])
    }

    fn make(&self, device: &wgpu::Device) -> Option<BothWindings> {
        let descriptor = CasterPipelineDescriptor {
            label: Some("shadow caster, six faces"),
            vertex: CasterVertex::BuiltIn {
                position: self.position,
                model: self.model,
            },
            primitive: self.primitive,
            depth_formats: &[CUBE_FORMAT],
        };
        let mut by_format =
            pipeline_build::multiview_pipelines(device, &descriptor, &self.position, &self.model);
        by_format[CUBE_FORMAT.index()].take()
    }
}
