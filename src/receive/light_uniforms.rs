//! Computes the uniforms of all views of a light.

use glam::{DVec2, DVec3, Vec3};

use crate::cast::ViewDraws;
use crate::fit::{LightAxes, MapRect, ShadowView, ViewPlacement};
use crate::receive::bias::lateral_error_texels;
use crate::receive::layer_state::{ALL_TEXELS, LayerState, NO_LIMIT};
use crate::receive::uniforms::{ROUNDING_TEXELS, Sampling, ShadowMapping, ShadowViewUniform};

/// Returns a range for the uniforms. An infinite one becomes a distance that no position exceeds
/// and whose square is finite.
fn endless_range(range_world: f64) -> f32 {
    range_world.min(1e18) as f32
}

/// Returns the uniform of a view of a light into which nothing casts. The anchor of a light beyond
/// the range of f32 is clamped to that range.
pub(crate) fn empty_view_uniform(
    layer: u32,
    anchor_render: Vec3,
    range_world: f64,
) -> ShadowViewUniform {
    let range = endless_range(range_world);
    ShadowViewUniform {
        mapping: ShadowMapping::EMPTY,
        layer,
        anchor: anchor_render.clamp(Vec3::MIN, Vec3::MAX).to_array(),
        range,
        range_squared: range * range,
        map_size: 1.0,
        uv_per_texel: 1.0,
        limit: NO_LIMIT,
        ..bytemuck::Zeroable::zeroed()
    }
}

/// Returns the views of each light in turn.
pub(crate) fn lights(
    views: &[ViewDraws],
    views_per_light: u32,
) -> impl Iterator<Item = &[ViewDraws]> {
    let light = move |draws: &ViewDraws| draws.view.index() / views_per_light;
    views.chunk_by(move |a, b| light(a) == light(b))
}

/// Holds what the uniforms of all views of a light have in common, so that shaders can read it from
/// any of them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LightUniforms {
    /// Is the point of render space from which positions start: the light, or a point in the first
    /// view of a directional light.
    anchor_render: Vec3,
    /// Is the largest render coordinate whose rounding any view of a local light allows for; 0 for
    /// a directional one.
    local_render_reach: f64,
}

impl LightUniforms {
    /// Returns what the views of a light have in common. `light` is what it draws into those views
    /// into which something casts, from the first; there is at least one.
    pub(super) fn of(light: &[ViewDraws]) -> Self {
        let local_reaches = light.iter().map(|draws| match draws.view.placement() {
            ViewPlacement::Orthographic { .. } => 0.0,
            ViewPlacement::Perspective { .. } => draws.view.render_reach(),
        });
        Self {
            anchor_render: light[0].view.anchor_render(),
            local_render_reach: local_reaches.fold(0.0, f64::max),
        }
    }

    /// Returns the view with the rounding that its uniform allows for.
    ///
    /// The faces of a cube share the largest rounding of their render coordinates, which differs
    /// only by what their farthest casters add. Cascades share their anchor. Of a position at a
    /// distance `d` from it, the subtraction errs by `u d`, the rounded rows of the rotation and
    /// the products with them by `4√3 u d`, and the scale and offset of a cascade by `u d` each: in
    /// all by less than `10 u d`. By what `d` is larger than under the cascade's own anchor, which
    /// is at most the distance of the two anchors, the reach is larger 2.5 times, since the
    /// rounding is `4u` of the reach.
    pub(super) fn sampled(&self, view: &ShadowView) -> ShadowView {
        let apart = (view.anchor_render() - self.anchor_render).as_dvec3();
        match view.placement() {
            ViewPlacement::Orthographic { .. } => {
                view.over_depths_from(view.render_reach() + 2.5 * apart.length())
            }
            ViewPlacement::Perspective { .. } => view.over_depths_from(self.local_render_reach),
        }
    }

    /// Writes the uniforms of all views of a light. `light` and `layers` are in the order of views,
    /// and `layer_of` returns the layer of a view. Shaders read what the views of a light have in
    /// common from any of them, those into which nothing casts included.
    pub(super) fn fill(
        &self,
        uniforms: &mut [ShadowViewUniform],
        light: &[ViewDraws],
        views_per_light: u32,
        layers: &[LayerState],
        sampling: &Sampling,
        layer_of: impl Fn(u32) -> u32,
    ) {
        let uniform_of = |view: &ShadowView| {
            let found = layers.binary_search_by_key(&view.index(), |base| base.index);
            let base = found.ok().map(|index| &layers[index]);
            let shadowed_texels = base.map_or(ALL_TEXELS, |base| base.shadowed_texels);
            self.view(view, sampling, shadowed_texels)
        };
        let first = light[0].view.index();
        let first = first - first % views_per_light;
        let common = uniform_of(&light[0].view);
        for index in first..first + views_per_light {
            uniforms[index as usize] = ShadowViewUniform {
                mapping: common.mapping.of_empty_view(),
                layer: layer_of(index),
                ..common
            };
        }
        for draws in light {
            uniforms[draws.view.index() as usize] = uniform_of(&draws.view);
        }
    }

    /// Returns the uniform of one of the light's views, in which positions have shadows within
    /// `shadowed_texels`: least x, least y, greatest x, greatest y in texel
    /// coordinates of the view's rectangle.
    pub(super) fn view(
        &self,
        view: &ShadowView,
        sampling: &Sampling,
        shadowed_texels: [f32; 4],
    ) -> ShadowViewUniform {
        let view = self.sampled(view);
        let size = view.texels().size.as_dvec2();
        // Only the middle of a map that is smaller than its borders remains.
        let border = DVec2::splat(sampling.border_texels() - ROUNDING_TEXELS).min(size * 0.5);
        let [left, top, right, bottom] = shadowed_texels.map(f64::from);
        let least = DVec2::new(left, top).max(border);
        let greatest = DVec2::new(right, bottom).min(size - border);
        let middle = (least + greatest) * 0.5;
        let (depth_error, depth_error_relative) = view.depth_error_ndc();
        let (manual_constant, manual_slope) = sampling.bias.manual();
        let light_size = f64::from(sampling.filter.light_size());
        let range = endless_range(view.range_world());
        let blend_texels = f64::from(sampling.blend) * size.min_element();
        let layer_size = f64::from(view.map_size());
        let plane = Plane::of(&view, self.anchor_render, middle);
        let offset_world = view.position_error_world();
        ShadowViewUniform {
            mapping: ShadowMapping {
                rounding: if plane.is_local {
                    depth_error_relative
                } else {
                    offset_world
                } as f32,
                middle: (middle + view.texels().min.as_dvec2()).as_vec2().to_array(),
                inner: ((greatest - least) * 0.5).as_vec2().to_array(),
                ..plane.mapping
            },
            right: plane.axes.right().as_vec3().to_array(),
            depth_offset: plane.depth_offset as f32,
            down: (-plane.axes.up()).as_vec3().to_array(),
            layer: view.layer(),
            toward: plane.axes.toward_light().as_vec3().to_array(),
            is_local: f32::from(u8::from(plane.is_local)),
            anchor: self.anchor_render.to_array(),
            grid: view.world_grid(),
            map_size: layer_size as f32,
            uv_per_texel: layer_size.recip() as f32,
            depth_error: (depth_error + sampling.depth_format.step_ndc()) as f32,
            lateral_error: lateral_error_texels(&view) as f32,
            offset_texels: sampling.lookup_offset_texels(&view) as f32,
            offset_world: if plane.is_local { offset_world } else { 0.0 } as f32,
            manual_constant,
            manual_slope,
            ramp: sampling.filter.ramp().map(|number| number as f32),
            range,
            range_squared: range * range,
            cone_tangent_squared: cone_tangent_squared(view.cone_cosine()),
            sample_radius: sampling.filter.radius_world(),
            light_spread: if plane.is_local {
                light_size
            } else {
                (light_size * 0.5).tan()
            } as f32,
            blend_scale: blend_texels.recip().min(1e30) as f32,
            camera: [0.0; 4],
            limit: NO_LIMIT,
        }
    }
}

/// Returns the square of the tangent of a cone's half-angle, given its cosine.
fn cone_tangent_squared(cosine: f64) -> f32 {
    if cosine > 0.0 {
        (cosine.powi(-2) - 1.0).min(3e38) as f32
    } else {
        3e38
    }
}

/// Describes the plane of a view's map.
struct Plane {
    axes: LightAxes,
    is_local: bool,
    mapping: ShadowMapping,
    depth_offset: f64,
}

impl Plane {
    /// Returns the plane of `view` for positions relative to `anchor_render`, whose texels are
    /// counted from `middle`.
    fn of(view: &ShadowView, anchor_render: Vec3, middle: DVec2) -> Self {
        match view.placement() {
            ViewPlacement::Orthographic { axes, bounds } => {
                let apart = anchor_render.as_dvec3() - view.anchor_render().as_dvec3();
                let at_anchor: DVec3 = view.texel_from_anchor().transform_point3(apart);
                let depth_scale = bounds.depth.length().recip();
                let offset = at_anchor.truncate() - middle;
                Self {
                    axes: *axes,
                    is_local: false,
                    mapping: mapping(&bounds.rect, offset, depth_scale),
                    depth_offset: at_anchor.z,
                }
            }
            ViewPlacement::Perspective {
                axes, rect, near, ..
            } => {
                let corner = DVec2::new(-rect.min.x, rect.max().y) / rect.texel;
                Self {
                    axes: *axes,
                    is_local: true,
                    mapping: mapping(rect, corner - middle, *near),
                    depth_offset: 0.0,
                }
            }
        }
    }
}

fn mapping(rect: &MapRect, texel_offset: DVec2, depth_scale: f64) -> ShadowMapping {
    ShadowMapping {
        texel_scale: rect.texel.recip().as_vec2().to_array(),
        texel_size: rect.texel.as_vec2().to_array(),
        depth_scale: depth_scale as f32,
        texel_offset: texel_offset.as_vec2().to_array(),
        ..ShadowMapping::EMPTY
    }
}
