//! Contains the loop that makes the draw calls of every kind of depth pass.

use crate::ShadowView;
use crate::cast::draw_list::DrawCall;
use crate::cast::instance_matrices::InstanceMatrices;
use crate::cast::mesh_geometry::MeshGeometry;
use crate::cast::{CasterPipeline, FrameCasters};
use crate::fit::TexelRect;

/// Holds the state of a pass that casters rely on and may change.
pub(crate) struct PassDefaults<'a> {
    /// Is bind group 0: the view or views being rendered.
    pub view_group: &'a wgpu::BindGroup,
    /// Is its dynamic offset, where it has one.
    pub offset: Option<u32>,
    /// Is the viewport and the scissor rectangle.
    pub texels: TexelRect,
}

impl PassDefaults<'_> {
    fn set_group(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_bind_group(0, self.view_group, self.offset.as_slice());
    }

    /// Limits the pass to the rectangle of the view.
    pub(super) fn set_rect(&self, pass: &mut wgpu::RenderPass<'_>) {
        let TexelRect { min, size } = self.texels;
        let [x, y, width, height] = [min.x, min.y, size.x, size.y].map(|texels| texels as f32);
        pass.set_viewport(x, y, width, height, 0.0, 1.0);
        pass.set_scissor_rect(min.x, min.y, size.x, size.y);
    }

    /// Undoes what the engine's own commands may have changed.
    fn restore(&self, pass: &mut wgpu::RenderPass<'_>) {
        self.set_rect(pass);
        self.set_group(pass);
    }
}

/// Is what the draw calls of a pass need besides themselves.
pub(crate) struct DrawContext<'a, 'c> {
    pub casters: &'a FrameCasters<'c>,
    pub matrices: &'a InstanceMatrices,
    pub view: &'a ShadowView,
}

/// Holds what a pass has set, so that nothing is set twice. A caster of the engine's own may have
/// changed all of it.
#[derive(Default)]
struct Bound<'a> {
    pipeline: Option<&'a CasterPipeline>,
    geometry: Option<&'a MeshGeometry>,
    matrices: Option<u32>,
}

/// Makes draw calls one after the other. Each caster of the engine's own finds its pipeline, bind
/// group 0, the view's rectangle as viewport and scissor rectangle, and depths from 0 to 1,
/// whatever the caster before it has set. They are set again only after a caster that may have
/// changed them: in software, setting bind group and scissor rectangle costs several times what a
/// small draw costs. `variant` returns the one of a caster's pipelines that matches the pass; a
/// call for which it returns `None` is left out.
pub(crate) fn draw_casters<'c>(
    pass: &mut wgpu::RenderPass<'_>,
    defaults: &PassDefaults<'_>,
    context: &DrawContext<'_, '_>,
    calls: &[DrawCall<'c>],
    variant: impl Fn(&'c CasterPipeline) -> Option<&'c wgpu::RenderPipeline>,
) {
    defaults.set_group(pass);
    let mut bound = Bound::default();
    for call in calls {
        let pipeline = call.pipeline();
        if !bound
            .pipeline
            .is_some_and(|bound| bound.draws_like(pipeline))
        {
            let Some(variant) = variant(pipeline) else {
                continue;
            };
            pass.set_pipeline(variant);
            bound.pipeline = Some(pipeline);
        }
        match *call {
            DrawCall::Caster { index, .. } => {
                let facts = context.casters.facts(index);
                context.casters.caster(index).draw(pass, context.view);
                if facts.keeps_pass_state && facts.instance.is_none() {
                    (bound.geometry, bound.matrices) = (None, None);
                } else {
                    defaults.restore(pass);
                    bound = Bound::default();
                }
            }
            DrawCall::Instances {
                geometry,
                first,
                count,
                ..
            } => {
                if !bound
                    .geometry
                    .is_some_and(|bound| bound.shares_buffers(geometry))
                {
                    geometry.bind(pass);
                    bound.geometry = Some(geometry);
                }
                let first = first.map_or(0, |first| {
                    if bound.matrices != Some(first.buffer) {
                        let buffer = context.matrices.buffer(first.buffer);
                        pass.set_vertex_buffer(1, buffer.slice(..));
                        bound.matrices = Some(first.buffer);
                    }
                    first.instance
                });
                geometry.draw(pass, first..first + count);
            }
        }
    }
}
