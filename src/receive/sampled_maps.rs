//! Describes a light's maps as lookups need them.

use crate::receive::{Sampling, ShadowViewUniform};

/// Describes the maps of a light to the code that emits its WGSL and creates its bind group.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SampledMaps<'a> {
    /// Is a view of all layers as an array.
    pub map: &'a wgpu::TextureView,
    /// Is the uniform buffer, with one entry per view.
    pub views: &'a wgpu::Buffer,
    pub view_count: u32,
    /// Holds the contents of `views` as of the last frame.
    pub uniforms: &'a [ShadowViewUniform],
    pub sampling: Sampling,
    pub selection: Selection,
    pub views_per_light: u32,
    /// States that all views are rectangles of the first layer.
    pub shares_layer: bool,
    /// States that the maps are those of a pool, whose lights are selected by index.
    pub indexed: bool,
}

/// Tells how a position selects one of a light's views. Everything after that is the same for all
/// lights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Selection {
    /// Selects the first view that contains the whole kernel: the cascades of a directional light,
    /// from near to far.
    Cascades,
    /// Selects the only view: that of a spot light.
    OneView,
    /// Selects a face of a cube by the major axis of the vector from the light.
    CubeFace,
}
