//! Describes a view of a light's maps in a frame.

use glam::Vec3;

use crate::report::SliceReport;

/// Is the uniform's `limit` for shadows that end where the maps end: their weight is one
/// everywhere.
pub(crate) const NO_LIMIT: [f32; 4] = [0.0, 0.0, 0.0, 1.0];

/// Is the region of texels in which positions have shadows, for shadows that end where the map
/// ends.
pub(crate) const ALL_TEXELS: [f32; 4] = [
    f32::NEG_INFINITY,
    f32::NEG_INFINITY,
    f32::INFINITY,
    f32::INFINITY,
];

/// Describes a view of a light of this frame, with the values that its uniform has where nothing
/// casts into it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LayerState {
    /// Is the index of the view, which is also its layer unless views share one.
    pub index: u32,
    /// Is the position of a local light; zero for a directional one.
    pub anchor_render: Vec3,
    /// Is the world distance beyond which the light does not shine; infinite for a directional one.
    pub range_world: f64,
    /// Is where the light's shadows end, as the uniform has it.
    pub limit: [f32; 4],
    /// Bounds the texels of the view in which positions have shadows, in addition to its bounds:
    /// least x and y, greatest x and y.
    pub shadowed_texels: [f32; 4],
    /// States that the layer needed drawing and was deferred.
    pub deferred: bool,
    /// Describes the slice of a camera's view that the layer covers as a cascade.
    pub slice: Option<SliceReport>,
}

impl LayerState {
    /// Returns the state of a view of a directional light without a limit to its shadows.
    pub(crate) fn directional(index: u32, slice: Option<SliceReport>) -> Self {
        Self {
            index,
            anchor_render: Vec3::ZERO,
            range_world: f64::INFINITY,
            limit: NO_LIMIT,
            shadowed_texels: ALL_TEXELS,
            deferred: false,
            slice,
        }
    }
}
