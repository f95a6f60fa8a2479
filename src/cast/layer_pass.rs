//! Records a depth pass over one layer.

use crate::cast::depth_attachment;
use crate::cast::draw_casters::{DrawContext, PassDefaults, draw_casters};
use crate::cast::draw_list::DrawCall;
use crate::gpu::DepthFormat;

/// Records passes over one layer.
pub(crate) struct LayerPass<'a, 'c> {
    pub encoder: &'a mut wgpu::CommandEncoder,
    pub label: &'a str,
    pub view_group: (&'a wgpu::BindGroup, u32),
    pub format: DepthFormat,
    /// Clears the rectangle of a view that shares its layer with others.
    pub rect_clear: Option<&'a wgpu::RenderPipeline>,
    pub context: DrawContext<'a, 'c>,
}

impl LayerPass<'_, '_> {
    /// Draws into `target`, the view of a whole layer.
    pub fn draw(
        &mut self,
        target: &wgpu::TextureView,
        load: wgpu::LoadOp<f32>,
        calls: &[DrawCall<'_>],
    ) {
        // The texels of the other views in the layer are kept.
        let attachment_load = match self.rect_clear {
            Some(_) => wgpu::LoadOp::Load,
            None => load,
        };
        let mut pass = self.encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(self.label),
            color_attachments: &[],
            depth_stencil_attachment: Some(depth_attachment(target, attachment_load)),
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
        if let (Some(pipeline), wgpu::LoadOp::Clear(_)) = (self.rect_clear, load) {
            defaults.set_rect(&mut pass);
            pass.set_pipeline(pipeline);
            pass.draw(0..3, 0..1);
        }
        // The planning of the frame has checked that there is a pipeline for the format.
        let format = self.format;
        draw_casters(&mut pass, &defaults, &self.context, calls, |pipeline| {
            pipeline.wgpu_pipeline(format)
        });
    }
}
