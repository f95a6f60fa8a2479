//! Draws views of one texel each, side by side in one layer, in a single pass.

use std::ops::Range;

use crate::cast::draw_list::{DrawCall, DrawLists};
use crate::cast::instance_matrices::InstanceMatrices;
use crate::cast::layer_pass::{PassFrame, begin_pass};
use crate::cast::view_uniform::ViewUniforms;
use crate::cast::{CLEAR, CasterPipeline, FrameCasters};
use crate::gpu::{DepthFormat, DepthMap, Upload};
use crate::{ShadowError, ShadowView};

/// Holds the texels of the views and what draws them.
#[derive(Debug)]
pub(crate) struct RayPass {
    label: String,
    map: DepthMap,
    uniforms: ViewUniforms,
    matrices: InstanceMatrices,
}

/// Is a view of one texel with the casters to be drawn into it.
#[derive(Clone, Debug)]
pub(crate) struct RayDraws {
    pub view: ShadowView,
    /// Is the part of a list of casters that are drawn.
    pub casters: Range<usize>,
}

/// Holds the draw calls of a frame.
pub(crate) struct PreparedRays<'a> {
    lists: DrawLists<'a>,
    /// Has one entry per view.
    calls: Vec<Range<usize>>,
}

/// Counts what a frame draws.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct RayCost {
    pub draws: u32,
    pub triangles: u64,
}

impl RayPass {
    /// Makes room for `rays` views, whose number comes from the field of this path.
    pub(crate) fn new(
        device: &wgpu::Device,
        label: &str,
        field: &'static str,
        rays: u32,
        format: DepthFormat,
    ) -> Result<Self, ShadowError> {
        // The square is the smallest that holds all of them.
        let side = rays.isqrt() + u32::from(rays.isqrt().pow(2) < rays);
        Ok(Self {
            label: label.to_owned(),
            map: DepthMap::new(device, label, field, side, 1, format)?,
            uniforms: ViewUniforms::new(device, label, rays)?,
            matrices: InstanceMatrices::new(device, label),
        })
    }

    /// Returns the map that holds a texel for each view, row by row.
    pub(crate) fn map(&self) -> &DepthMap {
        &self.map
    }

    /// Finds the draw calls and the uniforms of a frame. `met` is the list of casters that the
    /// views have parts of; the views are numbered in their order.
    pub(crate) fn prepare<'a>(
        &mut self,
        device: &wgpu::Device,
        rays: &[RayDraws],
        met: &[u32],
        casters: &FrameCasters<'a>,
    ) -> Result<PreparedRays<'a>, ShadowError> {
        self.matrices.clear();
        self.uniforms.clear(rays.len());
        let mut lists = DrawLists::default();
        let format = self.map.format();
        let check = |index: u32, pipeline: &CasterPipeline| {
            casters.check_pipeline(index, pipeline, device, format)
        };
        let mut calls = Vec::with_capacity(rays.len());
        for ray in rays {
            self.uniforms.set(ray.view.index(), &ray.view);
            let drawn = met[ray.casters.clone()].iter().copied();
            calls.push(lists.add(drawn, casters, &mut self.matrices, check)?);
        }
        self.matrices.prepare(device)?;
        Ok(PreparedRays { lists, calls })
    }

    /// Adds what must be copied before the pass.
    pub(crate) fn add_uploads<'a>(&'a self, uploads: &mut Vec<Upload<'a>>) {
        uploads.extend(self.uniforms.upload());
        uploads.extend(self.matrices.uploads());
    }

    /// Records the pass, after the uploads. Texels without a view are cleared.
    pub(crate) fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        prepared: &PreparedRays<'_>,
        rays: &[RayDraws],
        casters: &FrameCasters<'_>,
    ) -> RayCost {
        self.uniforms.set_written();
        let frame = PassFrame {
            casters,
            matrices: &self.matrices,
            lists: &prepared.lists,
            uniforms: &self.uniforms,
            format: self.map.format(),
        };
        let mut pass = begin_pass(encoder, &self.label, self.map.layer_view(0), CLEAR);
        let mut cost = RayCost::default();
        for (ray, calls) in rays.iter().zip(&prepared.calls) {
            frame.defaults(&ray.view).set_rect(&mut pass);
            frame.draw(&mut pass, &ray.view, calls);
            let calls = prepared.lists.calls(calls.clone());
            cost.draws += calls.len() as u32;
            cost.triangles += triangles(calls, casters);
        }
        cost
    }

    /// Forgets what was uploaded, so that the next frame uploads everything.
    pub(crate) fn invalidate(&mut self) {
        self.uniforms.invalidate();
    }
}

fn triangles(calls: &[DrawCall<'_>], casters: &FrameCasters<'_>) -> u64 {
    let of_call = |call: &DrawCall<'_>| match call {
        DrawCall::Caster { index, .. } => u64::from(casters.facts(*index).triangles),
        DrawCall::Instances {
            geometry, count, ..
        } => u64::from(geometry.triangles()) * u64::from(*count),
    };
    calls.iter().map(of_call).sum()
}
