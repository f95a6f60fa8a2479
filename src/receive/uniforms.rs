//! Defines the layout of the uniforms that Rust and WGSL share.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use crate::fit::ShadowView;
use crate::gpu::DepthFormat;
use crate::receive::bias::lateral_error_texels;
use crate::receive::{Bias, Filter};

/// Holds what the WGSL functions read of one view of a light: the bytes of the WGSL struct `ShadowViewUniform` in
/// `wgsl/view.wgsl`.
///
/// [`ShadowMaps::uniform_buffer`](crate::ShadowMaps::uniform_buffer) already holds these for every layer of a light. An
/// engine that keeps them in a buffer of its own copies the bytes of
/// [`ShadowMaps::view_uniforms`](crate::ShadowMaps::view_uniforms) after each frame, for instance with
/// `bytemuck::cast_slice`. Their layout is that of a uniform buffer: an `array<ShadowViewUniform, N>` in WGSL has a
/// stride of [`SIZE_BYTES`](Self::SIZE_BYTES) and no padding.
///
/// The members are read only by the library's own WGSL and may change with every version, so the bytes belong to the
/// WGSL of the same version. [`ShadowMaps::views`](crate::ShadowMaps::views) returns what each view covers.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct ShadowViewUniform {
    /// Transforms coordinates relative to the anchor to homogeneous texel x, texel y, ndc depth and w; stored as
    /// columns.
    pub(crate) texel_from_anchor: [[f32; 4]; 4],
    /// Is the row of the inverse transpose that gives a plane's component along texel x.
    pub(crate) plane_across: [f32; 4],
    /// Is the row that gives a plane's component along texel y.
    pub(crate) plane_down: [f32; 4],
    /// Is the row that gives a plane's component along ndc depth.
    pub(crate) plane_depth: [f32; 4],
    /// Is the unit vector toward the light along the view's axis, in render space. w is 1 for a local light, which is
    /// at the anchor, and 0 for a directional one.
    pub(crate) light: [f32; 4],
    /// Is a point of render space inside the view; for a local light, the light's position.
    pub(crate) anchor: [f32; 3],
    /// Is the layer of the map.
    pub(crate) layer: u32,
    /// Bounds the texel coordinates at which a lookup stays inside the map, with kernel and bias included: least x,
    /// least y, greatest x, greatest y. The least ones exceed the greatest ones where nothing casts into the view.
    pub(crate) inner: [f32; 4],
    /// Is the number of texels per side.
    pub(crate) map_size: f32,
    /// Is the absolute rounding error of a comparison, in ndc depth.
    pub(crate) depth_error: f32,
    /// Is the rounding error of a comparison in relation to the depth.
    pub(crate) depth_error_relative: f32,
    /// Is the error of a lookup's position across the map, in texels.
    pub(crate) lateral_error: f32,
    /// Is the offset along the normal, in texels times |nx| + |ny| of the normal in light space.
    pub(crate) offset_texels: f32,
    /// Is the world distance by which a receiver's plane is moved for the rounding of render coordinates: along the
    /// normal, or toward a local light. For a local light, 2^-22 of the receiver's distance from it is added, along the
    /// axis on which that is largest.
    pub(crate) offset_world: f32,
    /// Is the constant of a manual bias in world units; 0 for the other biases.
    pub(crate) manual_constant: f32,
    /// Is the slope of a manual bias in world units; 0 for the other biases.
    pub(crate) manual_slope: f32,
    /// Is the edge sharpness of the filter; 1 leaves its ramp as it is.
    pub(crate) sharpness: f32,
    /// Is the world distance from the anchor beyond which a local light does not reach; at most 1e18, the
    /// value for a directional light.
    pub(crate) range: f32,
    /// Is the cosine of the half-angle of the cone around the view's axis; -2 if there is no cone.
    pub(crate) cone_cosine: f32,
    /// Is the radius in world units of the direction-space filters; 0 for the other filters.
    pub(crate) sample_radius: f32,
    /// Is the position of the first camera in render space. w is 1, or 0 where the frame has no camera.
    pub(crate) camera: [f32; 4],
    /// Is the radius of a penumbra in texels along x and y, per difference of ndc depth between occluder and receiver;
    /// 0 for filters without a light size.
    pub(crate) penumbra: [f32; 2],
    /// Is the distance from the border, in texels, within which a cascade blends into the next one; 0 without blending.
    pub(crate) fade_texels: f32,
    /// Is the position of the map's first texel in a texel grid that is fixed in the world, modulo 65536: x in the low
    /// 16 bits, y in the high 16 bits.
    pub(crate) grid: u32,
    /// Determines where shadows end: a plane for a directional light, and coefficients of the distance for a local one.
    pub(crate) limit: [f32; 4],
}

impl ShadowViewUniform {
    /// Is the size in bytes, and the stride in an array: a multiple of 16, as uniform buffers require.
    pub const SIZE_BYTES: u64 = size_of::<Self>() as u64;
}

/// Returns the size in bytes of the uniforms of `views` views.
pub(crate) fn view_uniform_bytes(views: u64) -> u64 {
    views * ShadowViewUniform::SIZE_BYTES
}

/// Returns a range for the uniforms. An infinite one becomes a distance that no position exceeds and whose square is
/// finite.
pub(crate) fn endless_range(range_world: f64) -> f32 {
    range_world.min(1e18) as f32
}

/// Holds the settings with which the maps of a light are sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sampling {
    pub filter: Filter,
    pub bias: Bias,
    pub depth_format: DepthFormat,
    /// Is the fraction of a cascade's width over which it blends into the next one.
    pub blend: f32,
    /// Is the fraction of the distance at which shadows end, over which they fade to light.
    pub fade: f32,
}

/// Bounds the distance in texels by which rounding may move a lookup: the error `6uN` is 1/350 of a texel at N = 8192.
const ROUNDING_TEXELS: f64 = 1.0 / 64.0;

impl Sampling {
    /// Returns the settings for maps of 32 bits without blending.
    pub fn new(filter: Filter, bias: Bias) -> Self {
        Self {
            filter,
            bias,
            depth_format: DepthFormat::Float32,
            blend: 0.0,
            fade: 0.0,
        }
    }

    /// Returns the height in world units above which a caster that lies on a surface always casts onto it: the gap that
    /// the bias can leave, and two steps of the map's format. One step is added to the receiver's depth, and by another
    /// the caster may be stored too far away.
    pub fn max_peter_panning_world(&self, view: &ShadowView) -> f32 {
        let step = self.depth_format.step_ndc() * f64::from(view.depth_range_world());
        self.bias.max_peter_panning_world(self.filter, view) + 2.0 * step as f32
    }

    /// Returns the height above a surface, in texels, below which a caster may leave no shadow on it, at the worst
    /// angle.
    pub fn gap_texels(&self) -> f64 {
        let reach = self.bias.offset_texels(self.filter) + self.filter.reach_texels();
        reach * std::f64::consts::SQRT_2
    }

    /// Returns the number of texels by which a lookup may deviate from the position of its receiver: the filter's
    /// reach, the distance across the map by which an offset along the normal can move it, and rounding.
    pub fn border_texels(&self) -> f64 {
        let sideways = self.bias.offset_texels(self.filter) * std::f64::consts::SQRT_2;
        self.filter.reach_texels() + sideways + ROUNDING_TEXELS
    }

    /// Returns the number of whole texels that a fitted map keeps free on every side, so that no kernel leaves it.
    pub fn margin_texels(&self) -> u32 {
        self.border_texels().ceil() as u32
    }
}

/// Is the uniform's `limit` for shadows that end where the maps end: their weight is one everywhere.
pub(crate) const NO_LIMIT: [f32; 4] = [0.0, 0.0, 0.0, 1.0];

/// Returns the uniform of a view into which nothing casts: no receiver is inside it. The anchor of a light beyond the
/// range of f32 is clamped to that range.
pub(crate) fn empty_view_uniform(layer: u32, anchor_render: Vec3) -> ShadowViewUniform {
    ShadowViewUniform {
        inner: [1.0, 1.0, 0.0, 0.0],
        layer,
        anchor: anchor_render.clamp(Vec3::MIN, Vec3::MAX).to_array(),
        map_size: 1.0,
        limit: NO_LIMIT,
        ..ShadowViewUniform::zeroed()
    }
}

/// Returns the uniform of `view`.
pub(crate) fn view_uniform(view: &ShadowView, sampling: &Sampling) -> ShadowViewUniform {
    let texel_from_anchor = view.texel_from_anchor();
    // A plane is a row vector and is transformed by the inverse: plane_texel = plane_render *
    // inverse(texel_from_anchor). Its component along texel x is the product with the inverse's first column.
    let anchor_from_texel = texel_from_anchor.inverse();
    let size = f64::from(view.map_size());
    // Only the middle of a map that is smaller than its borders remains.
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
        camera: [0.0; 4],
        penumbra: view
            .penumbra_texels(f64::from(sampling.filter.light_size()))
            .as_vec2()
            .to_array(),
        fade_texels: sampling.blend * view.map_size() as f32,
        grid: view.world_grid(),
        limit: NO_LIMIT,
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::mem::offset_of;

    use super::{ShadowViewUniform, Zeroable};
    use crate::shader;

    /// Checks that every member has the offset, the size and the name in Rust that it has in WGSL. The structs have the
    /// same size, so that arrays of them have the same stride.
    #[test]
    fn rust_and_wgsl_have_one_layout() {
        macro_rules! members {
            ($($member:ident)*) => {{
                let value = ShadowViewUniform::zeroed();
                BTreeMap::from([$((
                    stringify!($member),
                    (offset_of!(ShadowViewUniform, $member), size_of_val(&value.$member)),
                )),*])
            }};
        }
        let in_rust = members!(
            texel_from_anchor plane_across plane_down plane_depth light anchor layer inner map_size depth_error
            depth_error_relative lateral_error offset_texels offset_world manual_constant manual_slope sharpness range
            cone_cosine sample_radius camera penumbra fade_texels grid limit
        );
        let source = shader::compose(&["view"]).expect("a module of the table");
        let module = naga::front::wgsl::parse_str(&source).expect("valid WGSL");
        let mut types = module.types.iter().map(|(_, ty)| ty);
        let uniform = types.find(|ty| ty.name.as_deref() == Some("ShadowViewUniform"));
        let Some(naga::TypeInner::Struct { members, span }) = uniform.map(|ty| &ty.inner) else {
            panic!("no struct ShadowViewUniform");
        };
        let in_wgsl: BTreeMap<_, _> = members
            .iter()
            .map(|member| {
                let size = module.types[member.ty].inner.size(module.to_ctx());
                let name = member.name.as_deref().expect("a named member");
                (name, (member.offset as usize, size as usize))
            })
            .collect();
        assert_eq!(in_rust, in_wgsl);
        assert_eq!(u64::from(*span), ShadowViewUniform::SIZE_BYTES);
        let bytes: usize = in_rust.values().map(|(_, size)| size).sum();
        assert_eq!(
            bytes, *span as usize,
            "padding would be uploaded uninitialised"
        );
        assert_eq!(span % 16, 0, "the stride of an array in a uniform buffer");
    }
}
