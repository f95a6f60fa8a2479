//! Draws the six faces of a cube in one multiview pass, on devices that support it.

use std::ops::Range;

use bytemuck::Zeroable;

use crate::ShadowError;
use crate::cast::cube_rule::one_pass_casters;
use crate::cast::draw_casters::{DrawContext, PassDefaults, draw_casters};
use crate::cast::draw_list::DrawLists;
use crate::cast::instance_matrices::InstanceMatrices;
use crate::cast::layer_cache::ViewDraws;
use crate::cast::view_uniform::{CasterViewUniform, VIEW_UNIFORM_BYTES, multiview_layout};
use crate::cast::{CasterPipeline, FrameCasters};
use crate::error::DeviceError;
use crate::fit::TexelRect;
use crate::gpu::{
    ALL_FACES_MASK, DepthMap, FACE_COUNT, Upload, UploadBuffer, capture_device_errors,
    supports_cube_multiview,
};

/// Holds the uniforms of the six faces of one pass.
#[derive(Debug)]
pub(crate) struct CubePass {
    label: String,
    faces: UploadBuffer,
    bind_group: wgpu::BindGroup,
}

/// Is one pass that is the cheaper way to draw, with everything made that could fail.
pub(crate) struct PreparedCubePass {
    uniforms: [CasterViewUniform; FACE_COUNT as usize],
    /// Lists the casters of all faces.
    casters: Vec<u32>,
    /// Is the range of their draw calls in the lists of the frame.
    calls: Range<usize>,
}

impl PreparedCubePass {
    /// Returns the number of draw calls of the pass.
    pub(super) fn draws(&self) -> u32 {
        self.calls.len() as u32
    }
}

impl CubePass {
    /// Returns `None` where the device does not draw six faces at once, or not correctly.
    pub(super) fn new(device: &wgpu::Device, label: &str) -> Result<Option<Self>, ShadowError> {
        if !supports_cube_multiview(device) {
            return Ok(None);
        }
        let label = format!("{label} six faces");
        let bytes = VIEW_UNIFORM_BYTES * u64::from(FACE_COUNT);
        let faces = UploadBuffer::new(device, &label, bytes)?;
        let create = || {
            device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some(&label),
                layout: &multiview_layout(device),
                entries: &[wgpu::BindGroupEntry {
                    binding: 0,
                    resource: faces.buffer().as_entire_binding(),
                }],
            })
        };
        let bind_group = capture_device_errors(device, create).map_err(|refusal| {
            ShadowError::Device(DeviceError {
                object: "the bind group of the casters",
                refusal,
            })
        })?;
        Ok(Some(Self {
            label,
            faces,
            bind_group,
        }))
    }

    /// Lists one pass for `views`, all of which are to be drawn whole. Returns `None` where a pass
    /// for each is cheaper, or where a caster cannot be drawn into six faces at once; `lists` and
    /// `matrices` then hold remains.
    pub(super) fn prepare<'a>(
        &self,
        device: &wgpu::Device,
        views: &[ViewDraws],
        casters: &FrameCasters<'a>,
        lists: &mut DrawLists<'a>,
        matrices: &mut InstanceMatrices,
    ) -> Option<PreparedCubePass> {
        let union = one_pass_casters(views, casters)?;
        let drawn = union.iter().copied();
        let is_ready = |_, pipeline: &CasterPipeline| {
            let is_ready = pipeline.device() == device && pipeline.multiview_pipeline().is_some();
            is_ready.then_some(()).ok_or(())
        };
        let calls = lists.add(drawn, casters, matrices, is_ready).ok()?;
        // A face without a view stays empty: this matrix places every vertex at a depth beyond the
        // clip volume.
        let mut clipped_away = CasterViewUniform::zeroed();
        clipped_away.clip_from_anchor[3] = [0.0, 0.0, -1.0, 1.0];
        let mut uniforms = [clipped_away; FACE_COUNT as usize];
        for draws in views {
            uniforms[draws.view.index() as usize] = CasterViewUniform::of(&draws.view);
        }
        Some(PreparedCubePass {
            uniforms,
            casters: union,
            calls,
        })
    }

    /// Returns the upload that the pass needs.
    pub(super) fn upload<'a>(&'a self, prepared: &'a PreparedCubePass) -> Option<Upload<'a>> {
        self.faces.upload(bytemuck::cast_slice(&prepared.uniforms))
    }

    /// Draws into the six layers of `map` at once. Each view's list of casters becomes the list of
    /// what was drawn into it.
    pub(super) fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        map: &DepthMap,
        prepared: PreparedCubePass,
        views: &mut [ViewDraws],
        lists: &DrawLists<'_>,
        (casters, matrices): (&FrameCasters<'_>, &InstanceMatrices),
    ) {
        self.faces
            .set_written(bytemuck::cast_slice(&prepared.uniforms));
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(&self.label),
            color_attachments: &[],
            depth_stencil_attachment: Some(super::depth_attachment(map.array_view(), super::CLEAR)),
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: ALL_FACES_MASK,
        });
        let defaults = PassDefaults {
            view_group: &self.bind_group,
            offset: None,
            texels: TexelRect::whole(map.size()),
        };
        let context = DrawContext {
            casters,
            matrices,
            view: &views[0].view,
        };
        draw_casters(
            &mut pass,
            &defaults,
            &context,
            lists.calls(prepared.calls.clone()),
            CasterPipeline::multiview_pipeline,
        );
        for draws in views {
            draws.casters.clear();
            draws.casters.extend_from_slice(&prepared.casters);
            draws.calls = prepared.calls.clone();
        }
    }

    pub(super) fn invalidate(&mut self) {
        self.faces.invalidate();
    }
}
