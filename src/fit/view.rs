//! Defines `ShadowView`: one depth render of a light, as a value.

use glam::{DMat3, DMat4, DVec2, DVec3, DVec4, Mat4, Vec2, Vec3};

use crate::ShadowError;
use crate::fit::map_rect::{LightSpaceBounds, MapRect};
use crate::fit::{LightAxes, LocalFit};

/// Describes one depth render: a cascade of a directional light, the map of a spot light, a face of a point light.
///
/// All matrices start from coordinates relative to [`ShadowView::anchor_render`], a point of render space inside the
/// view (the light itself where the projection is perspective). Subtracting it first keeps f32 exact to the texel far
/// from the origin. Lengths are in world units, and depths are reversed: near 1, far 0. A view is valid for the
/// `origin` of the frame in which it was made; under another one its shadows are displaced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadowView {
    layer: u32,
    map_size: u32,
    anchor_render: Vec3,
    /// Has reversed depth: near 1, far 0.
    clip_from_anchor: DMat4,
    placement: ViewPlacement,
    /// Is the largest f32 render coordinate that positions inside the view have.
    render_reach: f64,
}

/// Describes what a view covers, in absolute world terms: two views with equal placements render the same map of the
/// same world, wherever render space begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ViewPlacement {
    Orthographic {
        axes: LightAxes,
        bounds: LightSpaceBounds,
    },
    Perspective {
        axes: LightAxes,
        position_world: DVec3,
        /// Is in tangents.
        rect: MapRect,
        /// Is the world distance of the near plane.
        near: f64,
        /// Is the world distance beyond which nothing receives.
        reach: f64,
        /// Is the cosine of the half-angle of a cone; -2 if there is no cone.
        cone_cosine: f64,
    },
}

impl ViewPlacement {
    /// Returns the world distance of the view's farthest corner, or of a local light, from the world's origin.
    fn reach_from_origin(&self) -> f64 {
        match self {
            Self::Orthographic { bounds, .. } => bounds.bounds().reach(),
            Self::Perspective { position_world, .. } => position_world.length(),
        }
    }
}

impl ShadowView {
    /// Returns the orthographic view over light-space bounds, for an engine whose render space begins at `origin`.
    pub(crate) fn orthographic(
        axes: &LightAxes,
        bounds: &LightSpaceBounds,
        origin: DVec3,
        layer: u32,
    ) -> Self {
        let (rect, depth) = (&bounds.rect, &bounds.depth);
        let size = rect.max() - rect.min;
        let light_from_world = axes.light_from_world;
        let world_from_light = light_from_world.transpose();
        let middle = (rect.min + size * 0.5).extend((depth.near + depth.far) * 0.5);
        let anchor_render = (world_from_light * middle - origin).as_vec3();
        // The anchor is rounded to f32; everything after it starts from the rounded one, so nothing is lost.
        let anchor_light = light_from_world * (anchor_render.as_dvec3() + origin);
        let scale = DVec3::new(2.0 / size.x, 2.0 / size.y, 1.0 / depth.length());
        let offset = (anchor_light - rect.min.extend(depth.far)) * scale;
        let linear = DMat3::from_diagonal(scale) * light_from_world;
        let clip_from_anchor = DMat4::from_cols(
            linear.x_axis.extend(0.0),
            linear.y_axis.extend(0.0),
            linear.z_axis.extend(0.0),
            DVec4::new(offset.x - 1.0, offset.y - 1.0, offset.z, 1.0),
        );
        let half = size.extend(depth.length()) * 0.5;
        Self {
            layer,
            map_size: rect.map_size,
            anchor_render,
            clip_from_anchor,
            placement: ViewPlacement::Orthographic {
                axes: *axes,
                bounds: *bounds,
            },
            render_reach: f64::from(anchor_render.abs().max_element()) + half.length(),
        }
    }

    /// Returns the view of a local light through a rectangle of tangents.
    pub(crate) fn perspective(
        axes: &LightAxes,
        position_world: DVec3,
        rect: &MapRect,
        fit: &LocalFit,
        cone_cosine: f64,
        origin: DVec3,
        layer: u32,
    ) -> Self {
        let (near, reach) = (fit.near, fit.reach);
        let anchor_render = (position_world - origin).as_vec3();
        let size = rect.max() - rect.min;
        // clip = 2 (tangent - min) / size * w - w, with w = -z and tangent * w = x or y; depth * w = near.
        let scale = 2.0 / size;
        let shift = DVec2::ONE + rect.min * scale;
        let clip_from_light = DMat4::from_cols(
            DVec4::new(scale.x, 0.0, 0.0, 0.0),
            DVec4::new(0.0, scale.y, 0.0, 0.0),
            DVec4::new(shift.x, shift.y, 0.0, -1.0),
            DVec4::new(0.0, 0.0, near, 0.0),
        );
        let light_from_anchor = DMat4::from_mat3(axes.light_from_world);
        Self {
            layer,
            map_size: rect.map_size,
            anchor_render,
            clip_from_anchor: clip_from_light * light_from_anchor,
            placement: ViewPlacement::Perspective {
                axes: *axes,
                position_world,
                rect: *rect,
                near,
                reach,
                cone_cosine,
            },
            render_reach: f64::from(anchor_render.abs().max_element()) + reach,
        }
    }

    /// Returns the same view of the same world, for a render space that begins at `origin`.
    pub(crate) fn rebased(&self, origin: DVec3) -> Self {
        match &self.placement {
            ViewPlacement::Orthographic { axes, bounds } => {
                Self::orthographic(axes, bounds, origin, self.layer)
            }
            ViewPlacement::Perspective {
                position_world,
                reach,
                ..
            } => {
                let anchor_render = (*position_world - origin).as_vec3();
                Self {
                    anchor_render,
                    render_reach: f64::from(anchor_render.abs().max_element()) + reach,
                    ..*self
                }
            }
        }
    }

    /// Returns the largest render coordinate, in world units, that positions inside the view have.
    pub(crate) const fn render_reach(&self) -> f64 {
        self.render_reach
    }

    /// Returns the same view over depths that were computed from render coordinates up to `render_reach`, perhaps under
    /// another origin: whatever is compared with them must allow for their rounding as well.
    pub(crate) const fn over_depths_from(self, render_reach: f64) -> Self {
        Self {
            render_reach: self.render_reach.max(render_reach),
            ..self
        }
    }

    /// Returns whether depths of this view that were computed from render coordinates up to `render_reach` are as good
    /// as new ones: their rounding is at most twice that of new ones, or at most [`KEPT_ROUNDING_TEXELS`]. So a map is
    /// kept while the origin moves with a camera, and drawn again, finer, before the rounding of distant coordinates
    /// becomes visible.
    pub(crate) fn may_keep_depths_from(&self, render_reach: f64) -> bool {
        let finest_texel_world = match &self.placement {
            ViewPlacement::Orthographic { bounds, .. } => bounds.rect.texel.min_element(),
            ViewPlacement::Perspective { rect, near, .. } => rect.texel.min_element() * near,
        };
        let rounding_world = position_error_world(render_reach);
        rounding_world <= 2.0 * self.position_error_world()
            || rounding_world <= KEPT_ROUNDING_TEXELS * finest_texel_world
    }

    /// Returns the view if its matrices and its position can be expressed in f32. The fit has checked whether f64
    /// suffices for the position.
    pub(crate) fn checked(self) -> Result<Self, ShadowError> {
        // The square must fit as well: matrices hold reciprocals and products of these.
        let largest = f64::from(f32::MAX).sqrt();
        let extent = f64::from(self.texel_size_world().max_element()) * f64::from(self.map_size);
        let extent = extent.max(f64::from(self.depth_range_world()));
        let small = f64::from(self.texel_size_world().min_element());
        let fits = extent < largest
            && self.render_reach < largest
            && small > largest.recip()
            && f64::from(self.depth_range_world()) > largest.recip()
            && self.clip_from_anchor().is_finite();
        if fits {
            Ok(self)
        } else {
            Err(ShadowError::ViewNotRepresentable {
                extent_world: extent,
                distance_world: self.render_reach,
                coordinate_world: self.placement.reach_from_origin(),
            })
        }
    }

    /// Returns the layer of the light's depth texture that this view is rendered into.
    pub const fn layer(&self) -> u32 {
        self.layer
    }

    /// Returns the number of texels per side of the map.
    pub const fn map_size(&self) -> u32 {
        self.map_size
    }

    /// Returns the point of render space that the matrices' coordinates are relative to.
    pub const fn anchor_render(&self) -> Vec3 {
        self.anchor_render
    }

    /// Returns the matrix to clip space (z in [0, 1], near 1, far 0) from `position_render - anchor_render`.
    pub fn clip_from_anchor(&self) -> Mat4 {
        self.clip_from_anchor.as_mat4()
    }

    /// Returns the matrix to clip space from render space. Prefer [`ShadowView::clip_from_anchor`] where coordinates
    /// are large: this one shifts shadows by the rounding of large f32 coordinates.
    pub fn clip_from_render(&self) -> Mat4 {
        let shift = DMat4::from_translation(-self.anchor_render.as_dvec3());
        (self.clip_from_anchor * shift).as_mat4()
    }

    /// Returns the world size of a texel along the map's x and y: constant for an orthographic view, at the end of the
    /// light's reach for a perspective one, where it is largest.
    pub fn texel_size_world(&self) -> Vec2 {
        match &self.placement {
            ViewPlacement::Orthographic { bounds, .. } => bounds.rect.texel.as_vec2(),
            ViewPlacement::Perspective { rect, reach, .. } => (rect.texel * *reach).as_vec2(),
        }
    }

    /// Returns the world distance from the near plane to the far plane, or to the end of the light's reach.
    pub fn depth_range_world(&self) -> f32 {
        match &self.placement {
            ViewPlacement::Orthographic { bounds, .. } => bounds.depth.length() as f32,
            ViewPlacement::Perspective { near, reach, .. } => (reach - near) as f32,
        }
    }

    /// Returns the radius of a penumbra in texels per difference of ndc depth between occluder and receiver, for a
    /// directional light of `light_size` radians across or a local one of `light_size` world units in radius.
    pub(crate) fn penumbra_texels(&self, light_size: f64) -> DVec2 {
        match &self.placement {
            ViewPlacement::Orthographic { bounds, .. } => {
                bounds.depth.length() * (light_size * 0.5).tan() / bounds.rect.texel
            }
            ViewPlacement::Perspective { rect, near, .. } => light_size / near / rect.texel,
        }
    }

    /// Returns the position of the first texel in a grid of such texels that is fixed in the world (for a local light
    /// around it), modulo 65536: x in the low half, y, which grows downward, in the high.
    pub(crate) fn world_grid(&self) -> u32 {
        let rect = match &self.placement {
            ViewPlacement::Orthographic { bounds, .. } => &bounds.rect,
            ViewPlacement::Perspective { rect, .. } => rect,
        };
        let first = DVec2::new(rect.min.x, -rect.max().y) / rect.texel;
        let wrapped = first.round().rem_euclid(DVec2::splat(65_536.0));
        wrapped.x as u32 | (wrapped.y as u32) << 16
    }

    pub(crate) fn placement(&self) -> &ViewPlacement {
        &self.placement
    }

    /// Returns the matrix to texel coordinates (origin top left, centres at halves), ndc depth and w, from
    /// anchor-relative coordinates.
    pub(crate) fn texel_from_anchor(&self) -> DMat4 {
        let half = f64::from(self.map_size) * 0.5;
        let texel_from_clip = DMat4::from_cols(
            DVec4::new(half, 0.0, 0.0, 0.0),
            DVec4::new(0.0, -half, 0.0, 0.0),
            DVec4::new(0.0, 0.0, 1.0, 0.0),
            DVec4::new(half, half, 0.0, 1.0),
        );
        texel_from_clip * self.clip_from_anchor
    }

    /// Returns the direction toward the light along the view's axis, and in w whether the light is local (1) or
    /// directional (0).
    pub(crate) fn light_axis(&self) -> DVec4 {
        match &self.placement {
            ViewPlacement::Orthographic { axes, .. } => axes.toward_light().extend(0.0),
            ViewPlacement::Perspective { axes, .. } => axes.toward_light().extend(1.0),
        }
    }

    /// Returns the world distance beyond which a local light does not reach; infinite for a directional one.
    pub(crate) fn reach_world(&self) -> f64 {
        match &self.placement {
            ViewPlacement::Orthographic { .. } => f64::INFINITY,
            ViewPlacement::Perspective { reach, .. } => *reach,
        }
    }

    /// Returns the cosine of the half-angle of a cone; -2 if there is no cone.
    pub(crate) fn cone_cosine(&self) -> f64 {
        match &self.placement {
            ViewPlacement::Orthographic { .. } => -2.0,
            ViewPlacement::Perspective { cone_cosine, .. } => *cone_cosine,
        }
    }

    /// Returns the rounding error of a depth comparison as ndc depth, absolute and relative to the depth: one ulp (2u)
    /// for storing and comparing and `4u` for the transform. Orthographic depths err relative to their range;
    /// perspective ones relative to themselves, but for the rasteriser's interpolation, which errs by the largest depth
    /// of a triangle.
    pub(crate) fn depth_error_ndc(&self) -> (f64, f64) {
        match &self.placement {
            ViewPlacement::Orthographic { .. } => (6.0 * UNIT_ROUNDOFF, 0.0),
            ViewPlacement::Perspective { .. } => (2.0 * UNIT_ROUNDOFF, 6.0 * UNIT_ROUNDOFF),
        }
    }

    /// Returns the worst rounding error of a depth comparison in world units: what [`ShadowView::depth_error_ndc`]
    /// comes to.
    pub(crate) fn depth_error_world(&self) -> f64 {
        let (absolute, relative) = self.depth_error_ndc();
        match &self.placement {
            ViewPlacement::Orthographic { bounds, .. } => absolute * bounds.depth.length(),
            // Since depth = near / w, a depth error e is w² / near · e of distance.
            ViewPlacement::Perspective { near, reach, .. } => {
                reach * reach / near * absolute + reach * relative
            }
        }
    }

    /// Returns the rounding error of the render coordinates that casters and receivers start from, in world units: `4u`
    /// of the largest.
    pub(crate) fn position_error_world(&self) -> f64 {
        position_error_world(self.render_reach)
    }

    /// Returns the rounding error of a lookup's arithmetic across the map, in texels: `6uN`.
    pub(crate) fn lateral_error_texels(&self) -> f64 {
        6.0 * UNIT_ROUNDOFF * f64::from(self.map_size)
    }
}

/// Is the rounding, in texels, that kept depths may have whatever new ones would have: the offset along the normal that
/// allows for it is then far below the residual offset of a tenth of a texel.
const KEPT_ROUNDING_TEXELS: f64 = 1.0 / 64.0;

/// Returns the rounding error in world units of coordinates up to `render_reach`: `4u` of it.
pub(crate) fn position_error_world(render_reach: f64) -> f64 {
    4.0 * UNIT_ROUNDOFF * render_reach
}

/// Is u of f32: half an ulp of one.
const UNIT_ROUNDOFF: f64 = f32::EPSILON as f64 * 0.5;
