//! Defines the layout of the uniforms that Rust and WGSL share.

use crate::fit::ShadowView;
use crate::gpu::DepthFormat;
use crate::receive::bias::{BiasScheme, lateral_error_texels};
use crate::receive::{Bias, Filter};
use bytemuck::{Pod, Zeroable};

/// Holds what the WGSL functions read of one view of a light: the bytes of the WGSL struct
/// `ShadowViewUniform` in `wgsl/view.wgsl`.
///
/// [`ShadowMaps::uniform_buffer`](crate::ShadowMaps::uniform_buffer) already holds these for every
/// layer of a light. An engine that keeps them in a buffer of its own copies the bytes of
/// [`ShadowMaps::view_uniforms`](crate::ShadowMaps::view_uniforms) after each frame, for instance
/// with `bytemuck::cast_slice`. Their layout is that of a uniform buffer: an
/// `array<ShadowViewUniform, N>` in WGSL has a stride of [`SIZE_BYTES`](Self::SIZE_BYTES) and no
/// padding.
///
/// The members are read only by the library's own WGSL and may change with every version, so the
/// bytes belong to the WGSL of the same version. [`ShadowMaps::views`](crate::ShadowMaps::views)
/// returns what each view covers.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct ShadowViewUniform {
    /// Maps the plane of the map to texels, and distances to depths.
    pub(crate) mapping: ShadowMapping,
    /// Is the unit vector of render space to the right on the map.
    pub(crate) right: [f32; 3],
    /// Is the ndc depth of the anchor for a directional light; 0 for a local one.
    pub(crate) depth_offset: f32,
    /// Is the unit vector of render space downward on the map.
    pub(crate) down: [f32; 3],
    /// Is the layer of the map.
    pub(crate) layer: u32,
    /// Is the unit vector of render space toward the light along the view's axis.
    pub(crate) toward: [f32; 3],
    /// Is 1 for a local light, which is at the anchor, and 0 for a directional one.
    pub(crate) is_local: f32,
    /// Is a point of render space: the position of a local light; for a directional one a point in
    /// its first view.
    pub(crate) anchor: [f32; 3],
    /// Is the position of the map's first texel in a texel grid that is fixed in the world, modulo
    /// 65536: x in the low 16 bits, y in the high 16 bits.
    pub(crate) grid: u32,
    /// Is the number of texels per side of the layer.
    pub(crate) map_size: f32,
    /// Is the reciprocal of the number of texels per side.
    pub(crate) uv_per_texel: f32,
    /// Is the absolute rounding error of a comparison, in ndc depth.
    pub(crate) depth_error: f32,
    /// Is the error of a lookup's position across the map, in texels.
    pub(crate) lateral_error: f32,
    /// Is the offset along the normal, in texels times |nx| + |ny| of the normal in light space.
    pub(crate) offset_texels: f32,
    /// Is the world distance by which a receiver's plane is moved toward a local light for the
    /// rounding of render coordinates. The shader adds 2^-22 of the receiver's distance from the
    /// light, along the axis on which that is largest. It is 0 for a directional light.
    pub(crate) offset_world: f32,
    /// Is the constant of a manual bias in world units; 0 for the other biases.
    pub(crate) manual_constant: f32,
    /// Is the slope of a manual bias in world units; 0 for the other biases.
    pub(crate) manual_slope: f32,
    /// Turns the weighted sum of a kernel's comparisons into visibility: factor and summand.
    pub(crate) ramp: [f32; 2],
    /// Is the world distance from the anchor beyond which a local light does not reach; at most
    /// 1e18, the value for a directional light.
    pub(crate) range: f32,
    /// Is the square of the range.
    pub(crate) range_squared: f32,
    /// Is the square of the tangent of the half-angle of the cone around the view's axis; 3e38 if
    /// there is no cone.
    pub(crate) cone_tangent_squared: f32,
    /// Is the radius in world units of the direction-space filters; 0 for the other filters.
    pub(crate) sample_radius: f32,
    /// Is the tangent of half the angular diameter of a directional light, or the radius of a local
    /// one in world units; 0 for filters without a light size.
    pub(crate) light_spread: f32,
    /// Is the reciprocal of the distance from the border, in texels, within which a cascade blends
    /// into the next one; 1e30 without blending.
    pub(crate) blend_scale: f32,
    /// Is the position of the first camera in render space. w is 1, or 0 where the frame has no
    /// camera.
    pub(crate) camera: [f32; 4],
    /// Determines where shadows end: a plane for a directional light, and coefficients of the
    /// distance for a local one.
    pub(crate) limit: [f32; 4],
}

/// Maps the plane of a light's map to texels, and distances to depths: the bytes of the WGSL struct
/// `ShadowMapping`. The plane's coordinates are world units in light space for a directional light,
/// and tangents of angles for a local one.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(crate) struct ShadowMapping {
    /// Is the number of texels per unit of the plane.
    pub texel_scale: [f32; 2],
    /// Is the size of a texel in units of the plane.
    pub texel_size: [f32; 2],
    /// Is the ndc depth of a world unit for a directional light, and the world distance of the near
    /// plane for a local one.
    pub depth_scale: f32,
    /// Is the world distance along the normal by which a receiver is moved for the rounding of
    /// render coordinates for a directional light, and the rounding error of a comparison in
    /// relation to the depth for a local one.
    pub rounding: f32,
    /// Is the middle of the part of the map in which positions have shadows, in texel coordinates.
    pub middle: [f32; 2],
    /// Is the position of the anchor, in texels from the middle.
    pub texel_offset: [f32; 2],
    /// Is the distance from the middle, in texels along x and y, within which a lookup stays inside
    /// the view's part of the map, with kernel and bias included, and positions have shadows.
    pub inner: [f32; 2],
}

impl ShadowMapping {
    /// Is the mapping of a view into which nothing casts: it covers no position.
    pub(crate) const EMPTY: Self = Self {
        texel_scale: [0.0; 2],
        texel_size: [0.0; 2],
        depth_scale: 0.0,
        rounding: 0.0,
        middle: [0.0; 2],
        texel_offset: [1e30; 2],
        inner: [0.0; 2],
    };

    /// Returns the mapping of a view of the same light into which nothing casts. Shaders read what
    /// the views of a local light have in common from any of them.
    pub(crate) fn of_empty_view(self) -> Self {
        Self {
            middle: self.middle,
            inner: self.inner,
            ..Self::EMPTY
        }
    }
}

impl ShadowViewUniform {
    /// Is the size in bytes, and the stride in an array: a multiple of 16, as uniform buffers
    /// require.
    pub const SIZE_BYTES: u64 = size_of::<Self>() as u64;
}

/// Returns the size in bytes of the uniforms of `views` views.
pub(crate) fn view_uniform_bytes(views: u64) -> u64 {
    views * ShadowViewUniform::SIZE_BYTES
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

/// Bounds the distance in texels by which rounding may move a lookup: the error `6uN` is 1/350 of a
/// texel at N = 8192.
pub(crate) const ROUNDING_TEXELS: f64 = 1.0 / 64.0;

impl Sampling {
    /// Returns the settings for maps of 32 bits without blending.
    pub(crate) fn new(filter: Filter, bias: Bias) -> Self {
        Self {
            filter,
            bias,
            depth_format: DepthFormat::Float32,
            blend: 0.0,
            fade: 0.0,
        }
    }

    /// Returns the height in world units above which a caster that lies on a surface always casts
    /// onto it: the gap that the bias can leave, and two steps of the map's format. One step is
    /// added to the receiver's depth, and by another the caster may be stored too far away.
    pub(crate) fn max_peter_panning_world(&self, view: &ShadowView) -> f32 {
        let step = self.depth_format.step_ndc() * f64::from(view.depth_range_world());
        self.bias.max_peter_panning_world(self.filter, view) + 2.0 * step as f32
    }

    /// Returns the height above a surface, in texels, below which a caster may leave no shadow on
    /// it, at the worst angle.
    pub(crate) fn gap_texels(&self) -> f64 {
        let reach = self.bias.offset_texels(self.filter) + self.filter.reach_texels();
        reach * std::f64::consts::SQRT_2
    }

    /// Returns the offset along the normal that a lookup adds, in texels times |nx| + |ny| of the
    /// normal in light space: that of the bias, and the lateral error where all texels are compared
    /// with one reference depth. A tangent plane has a reference depth per texel, and allows for
    /// the lateral error in those.
    pub(crate) fn lookup_offset_texels(&self, view: &ShadowView) -> f64 {
        let offset = self.bias.offset_texels(self.filter);
        match self.bias.scheme(self.filter) {
            BiasScheme::NormalOffset => offset + lateral_error_texels(view),
            BiasScheme::Plane | BiasScheme::Manual => offset,
        }
    }

    /// Returns the number of texels by which a lookup may deviate from the position of its
    /// receiver: the filter's reach, the distance across the map by which an offset along the
    /// normal can move it, and rounding.
    pub(crate) fn border_texels(&self) -> f64 {
        let sideways = self.bias.offset_texels(self.filter) * std::f64::consts::SQRT_2;
        self.filter.reach_texels() + sideways + ROUNDING_TEXELS
    }

    /// Returns the number of whole texels that a fitted map keeps free on every side, so that no
    /// kernel leaves it.
    pub(crate) fn margin_texels(&self) -> u32 {
        self.border_texels().ceil() as u32
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::mem::offset_of;

    use super::{ShadowMapping, ShadowViewUniform, Zeroable};
    use crate::shader;

    /// Returns the offset and the size of the named members of a Rust struct.
    macro_rules! members {
        ($struct:ty: $($member:ident)*) => {{
            let value = <$struct>::zeroed();
            BTreeMap::from([$((
                stringify!($member),
                (offset_of!($struct, $member), size_of_val(&value.$member)),
            )),*])
        }};
    }

    /// Checks that every member has the offset, the size and the name in Rust that it has in WGSL.
    /// The structs have the same size, so that arrays of them have the same stride.
    #[test]
    fn rust_and_wgsl_have_one_layout() {
        let views = members!(
            ShadowViewUniform: mapping right depth_offset down layer toward is_local anchor grid
            map_size uv_per_texel depth_error lateral_error offset_texels offset_world
            manual_constant manual_slope ramp range range_squared cone_tangent_squared sample_radius
            light_spread blend_scale camera limit
        );
        let mappings = members!(
            ShadowMapping: texel_scale texel_size depth_scale rounding middle texel_offset inner
        );
        for (name, in_rust, size) in [
            ("ShadowViewUniform", views, size_of::<ShadowViewUniform>()),
            ("ShadowMapping", mappings, size_of::<ShadowMapping>()),
        ] {
            let source = shader::compose(&["view"]).expect("a module of the table");
            let module = naga::front::wgsl::parse_str(&source).expect("valid WGSL");
            let mut types = module.types.iter().map(|(_, ty)| ty);
            let found = types.find(|ty| ty.name.as_deref() == Some(name));
            let Some(naga::TypeInner::Struct { members, span }) = found.map(|ty| &ty.inner) else {
                panic!("no struct {name}");
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
            assert_eq!(*span as usize, size);
            let bytes: usize = in_rust.values().map(|(_, size)| size).sum();
            assert_eq!(bytes, size, "padding would be uploaded uninitialised");
            assert_eq!(span % 16, 0, "the stride of an array in a uniform buffer");
        }
    }
}
