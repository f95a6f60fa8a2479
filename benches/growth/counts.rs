//! Counts what the maps of a frame took.

use wgpu_shadows::report::ShadowReport;

/// Holds sums over the lights of a frame.
#[derive(Clone, Copy, Debug, Default)]
pub struct Counts {
    pub passes: u32,
    pub draws: u32,
    /// Counts the casters that were copied from static-caster caches instead of being drawn.
    pub copied: u32,
    /// Counts the texels of the maps that were drawn again.
    pub texels: u64,
}

impl Counts {
    pub fn add(&mut self, report: &ShadowReport) {
        self.passes += report.passes;
        self.draws += report.draws();
        self.texels += report.texels();
        self.copied += report.views.iter().map(|view| view.copied).sum::<u32>();
    }
}
