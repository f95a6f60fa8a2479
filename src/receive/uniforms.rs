//! The layout that Rust and WGSL share.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use crate::fit::ShadowView;
use crate::gpu::DepthFormat;
use crate::receive::bias::lateral_error_texels;
use crate::receive::{Bias, Filter};

/// Mirror of `ShadowView` in `wgsl/view.wgsl`: what an engine with its own bind groups puts into a uniform buffer.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct ShadowViewUniform {
    /// Homogeneous texel x, texel y, depth and w from coordinates relative to the anchor; columns.
    pub texel_from_anchor: [[f32; 4]; 4],
    /// Row of the inverse transpose that gives a plane's component along texel x.
    pub plane_across: [f32; 4],
    /// The same along texel y.
    pub plane_down: [f32; 4],
    /// The same along depth.
    pub plane_depth: [f32; 4],
    /// Toward the light along the view's axis; w is 1 for a local light, whose place is the anchor, and 0 for a directional one.
    pub light: [f32; 4],
    /// A point of render space inside the view.
    pub anchor: [f32; 3],
    /// Layer of the map.
    pub layer: u32,
    /// Texels between which a lookup stays inside the map, kernel and bias included: x and y from, x and y to.
    pub inner: [f32; 4],
    /// Texels per side.
    pub map_size: f32,
    /// Absolute rounding error of a comparison in ndc depth.
    pub depth_error: f32,
    /// Rounding error of a comparison relative to the depth.
    pub depth_error_relative: f32,
    /// Error across the map in texels.
    pub lateral_error: f32,
    /// Offset along the normal in texels times |nx| + |ny|.
    pub offset_texels: f32,
    /// World distance by which a receiver's plane is moved for the rounding of render coordinates: along the normal, or toward a
    /// local light. Around that, 2^-22 of the receiver's distance along the axis on which it is largest is added.
    pub offset_world: f32,
    /// Manual bias: constant, world units.
    pub manual_constant: f32,
    /// Manual bias: slope, world units.
    pub manual_slope: f32,
    /// Edge sharpness.
    pub sharpness: f32,
    /// World distance from the anchor beyond which a local light does not shine; huge for an endless one and a directional one.
    pub range: f32,
    /// Cosine of the half-angle of a cone around the view's axis; -2 for none.
    pub cone_cosine: f32,
    /// Radius in world units of the direction-space filters.
    pub sample_radius: f32,
    /// The viewer in render space; w is 1, or 0 where no viewer is known.
    pub viewer: [f32; 4],
    /// Texels along x and y over which a light with size spreads a penumbra, per difference of ndc depth.
    pub penumbra: [f32; 2],
    /// Texels from the border within which a cascade gives way to the next; 0 for an end without one.
    pub fade_texels: f32,
    /// Where the first texel lies in a grid that is fixed in the world, modulo 65536: x in the low half, y in the high.
    pub grid: u32,
}

/// Bytes of the uniforms of `views` views.
pub(crate) fn view_uniform_bytes(views: u64) -> u64 {
    views * size_of::<ShadowViewUniform>() as u64
}

/// A range for the uniforms: an endless one becomes a distance that none exceeds and whose square is finite.
pub(crate) fn endless_range(range_world: f64) -> f32 {
    range_world.min(1e18) as f32
}

/// How the maps of a light are looked up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sampling {
    pub filter: Filter,
    pub bias: Bias,
    pub depth_format: DepthFormat,
    /// Share of a cascade's width in which it gives way to the next.
    pub blend: f32,
}

/// What rounding may move a lookup by: 6uN is 1/350 of a texel at N = 8192.
const ROUNDING_TEXELS: f64 = 1.0 / 64.0;

impl Sampling {
    /// Of maps of 32 bits that do not blend.
    pub fn new(filter: Filter, bias: Bias) -> Self {
        Self {
            filter,
            bias,
            depth_format: DepthFormat::Float32,
            blend: 0.0,
        }
    }

    /// Height in world units above which a caster that lies on a surface always casts onto it: what the bias leaves open, and
    /// two steps of the map's format: one by which a receiver is set back, and one by which the caster may be stored too far.
    pub fn max_peter_panning_world(&self, view: &ShadowView) -> f32 {
        let step = self.depth_format.step_ndc() * f64::from(view.depth_range_world());
        self.bias.max_peter_panning_world(self.filter, view) + 2.0 * step as f32
    }

    /// Texels by which a lookup may leave the place of its receiver: the filter's reach, the way that an offset along the
    /// normal can lead across the map, and rounding.
    pub fn border_texels(&self) -> f64 {
        let sideways = self.bias.offset_texels(self.filter) * std::f64::consts::SQRT_2;
        self.filter.reach_texels() + sideways + ROUNDING_TEXELS
    }

    /// Whole texels kept free on every side of a fitted map so that no kernel leaves it.
    pub fn margin_texels(&self) -> u32 {
        self.border_texels().ceil() as u32
    }
}

/// A view that nothing casts into: no receiver is inside it. The anchor of a light that lies farther away than f32 reaches is
/// as far away as f32 does.
pub(crate) fn empty_view_uniform(layer: u32, anchor_render: Vec3) -> ShadowViewUniform {
    ShadowViewUniform {
        inner: [1.0, 1.0, 0.0, 0.0],
        layer,
        anchor: anchor_render.clamp(Vec3::MIN, Vec3::MAX).to_array(),
        map_size: 1.0,
        ..ShadowViewUniform::zeroed()
    }
}

/// The uniform of `view`.
pub(crate) fn view_uniform(view: &ShadowView, sampling: &Sampling) -> ShadowViewUniform {
    let texel_from_anchor = view.texel_from_anchor();
    // A plane is a row vector and goes through the inverse: plane_texel = plane_render * inverse(texel_from_anchor). Its
    // component along texel x is a product with the inverse's first column.
    let anchor_from_texel = texel_from_anchor.inverse();
    let size = f64::from(view.map_size());
    // Where a map is smaller than its borders, only its middle remains.
    let border = (sampling.border_texels() - ROUNDING_TEXELS).min(size * 0.5);
    let inner = [border, border, size - border, size - border].map(|texel| texel as f32);
    let (depth_error, depth_error_relative) = view.depth_error_ndc();
    let (manual_constant, manual_slope) = sampling.bias.manual();
    ShadowViewUniform {
        texel_from_anchor: texel_from_anchor.as_mat4().to_cols_array_2d(),
        plane_across: anchor_from_texel.col(0).as_vec4().to_array(),
        plane_down: anchor_from_texel.col(1).as_vec4().to_array(),
        plane_depth: anchor_from_texel.col(2).as_vec4().to_array(),
        light: view.light_axis().as_vec4().to_array(),
        anchor: view.anchor_render().to_array(),
        layer: view.layer(),
        inner,
        map_size: view.map_size() as f32,
        depth_error: (depth_error + sampling.depth_format.step_ndc()) as f32,
        depth_error_relative: depth_error_relative as f32,
        lateral_error: lateral_error_texels(view) as f32,
        offset_texels: sampling.bias.offset_texels(sampling.filter) as f32,
        offset_world: view.position_error_world() as f32,
        manual_constant,
        manual_slope,
        sharpness: sampling.filter.sharpness(),
        range: endless_range(view.range_world()),
        cone_cosine: view.cone_cosine() as f32,
        sample_radius: sampling.filter.radius_world(),
        viewer: [0.0; 4],
        penumbra: view
            .penumbra_texels(f64::from(sampling.filter.light_size()))
            .as_vec2()
            .to_array(),
        fade_texels: sampling.blend * view.map_size() as f32,
        grid: view.world_grid(),
    }
}
