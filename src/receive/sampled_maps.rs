//! What a lookup needs to know of a light's maps.

use crate::receive::{Sampling, ShadowViewUniform};

/// The maps of a light as its WGSL and its bind group see them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SampledMaps<'a> {
    /// All layers as an array.
    pub map: &'a wgpu::TextureView,
    /// Uniform buffer with one view a layer.
    pub views: &'a wgpu::Buffer,
    pub view_count: u32,
    /// What `views` holds since the last frame.
    pub uniforms: &'a [ShadowViewUniform],
    pub sampling: Sampling,
    pub selection: Selection,
    pub views_per_light: u32,
    /// The maps are those of a pool, whose lights are looked up by index.
    pub indexed: bool,
}

/// How a place chooses among a light's views; everything after the choice is the same for all lights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Selection {
    /// The first view that holds the whole kernel: the cascades of a directional light, near to far.
    Cascades,
    /// There is one: a spot.
    OneView,
    /// The face of a cube, by the major axis from the light.
    CubeFace,
}
