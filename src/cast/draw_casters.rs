//! Contains the loop that draws casters in every kind of depth pass.

use crate::ShadowView;
use crate::cast::{CasterPipeline, FrameCasters};
use crate::fit::TexelRect;

/// Is a caster that a pass draws.
#[derive(Clone, Copy)]
pub(crate) struct DrawnCaster<'a> {
    /// Is its index in the engine's list.
    pub index: u32,
    pub pipeline: &'a CasterPipeline,
}

/// Holds the state of a pass that casters rely on and may change.
pub(crate) struct PassDefaults<'a> {
    /// Is bind group 0: the view or views being rendered.
    pub view_group: &'a wgpu::BindGroup,
    pub offsets: &'a [u32],
    /// Is the viewport and the scissor rectangle.
    pub texels: TexelRect,
}

impl PassDefaults<'_> {
    fn set_group(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_bind_group(0, self.view_group, self.offsets);
    }

    /// Limits the pass to the rectangle of the view.
    pub fn set_rect(&self, pass: &mut wgpu::RenderPass<'_>) {
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

/// Draws casters one after the other. Each caster finds its pipeline, bind group 0, the view's
/// rectangle as viewport and scissor rectangle, and depths from 0 to 1, whatever the caster before
/// it has set. They are set again only after a caster that may have changed them: in software,
/// setting bind group and scissor rectangle costs several times what a small draw costs. `variant`
/// returns the one of a caster's pipelines that matches the pass; a caster for which it returns
/// `None` is left out.
pub(crate) fn draw_casters<'c>(
    pass: &mut wgpu::RenderPass<'_>,
    defaults: &PassDefaults<'_>,
    view: &ShadowView,
    drawn: impl Iterator<Item = DrawnCaster<'c>>,
    casters: &FrameCasters<'_>,
    variant: impl Fn(&'c CasterPipeline) -> Option<&'c wgpu::RenderPipeline>,
) {
    defaults.set_group(pass);
    let mut current: Option<&CasterPipeline> = None;
    for DrawnCaster { index, pipeline } in drawn {
        if current != Some(pipeline) {
            let Some(variant) = variant(pipeline) else {
                continue;
            };
            pass.set_pipeline(variant);
            current = Some(pipeline);
        }
        casters.caster(index).draw(pass, view);
        if !casters.facts(index).keeps_pass_state {
            defaults.restore(pass);
            current = None;
        }
    }
}
