//! Records a depth pass over one layer.

use crate::cast::draw_casters::{DrawContext, PassDefaults, draw_casters};
use crate::cast::draw_list::DrawCall;
use crate::cast::shared_layer::SharedLayer;
use crate::cast::{CLEAR, depth_attachment};
use crate::gpu::DepthFormat;

/// States what a view holds before its casters are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Before {
    /// It holds nothing.
    Clear,
    /// It holds the static casters, which have been copied into a layer that is the view's alone,
    /// and are copied into a shared one by the pass.
    StaticCasters,
}

/// Records passes over one layer.
pub(crate) struct LayerPass<'a, 'c> {
    pub encoder: &'a mut wgpu::CommandEncoder,
    pub label: &'a str,
    pub view_group: (&'a wgpu::BindGroup, u32),
    pub format: DepthFormat,
    /// Is present where the view shares its layer with others.
    pub shared_layer: Option<&'a SharedLayer>,
    pub context: DrawContext<'a, 'c>,
}

impl LayerPass<'_, '_> {
    /// Records a pass that makes `calls`.
    pub(super) fn draw(
        &mut self,
        target: &wgpu::TextureView,
        before: Before,
        calls: &[DrawCall<'_>],
    ) {
        // A shared layer keeps the texels of its other views.
        let load = match (self.shared_layer, before) {
            (None, Before::Clear) => CLEAR,
            (Some(_), _) | (None, Before::StaticCasters) => wgpu::LoadOp::Load,
        };
        let mut pass = self.encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(self.label),
            color_attachments: &[],
            depth_stencil_attachment: Some(depth_attachment(target, load)),
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        });
        let (group, offset) = self.view_group;
        let defaults = PassDefaults {
            view_group: group,
            offsets: &[offset],
            texels: self.context.view.texels(),
        };
        if let Some(shared) = self.shared_layer {
            defaults.set_rect(&mut pass);
            match before {
                Before::Clear => shared.clear(&mut pass),
                Before::StaticCasters => shared.copy_static_casters(&mut pass),
            }
        }
        // The planning of the frame has checked that there is a pipeline for the format.
        let format = self.format;
        draw_casters(&mut pass, &defaults, &self.context, calls, |pipeline| {
            pipeline.wgpu_pipeline(format)
        });
    }
}
