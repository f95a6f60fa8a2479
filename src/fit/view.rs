//! Defines `ShadowView`: one depth render of a light, as a value.

use glam::{DMat3, DMat4, DVec2, DVec3, DVec4, Mat4, Vec2, Vec3};

use crate::ShadowError;
use crate::fit::axes::{LightAxes, LightSpace};
use crate::fit::map_rect::{LightSpaceBounds, MapRect};
use crate::fit::texel_rect::TexelRect;
use crate::fit::view_placement::ViewPlacement;

/// Describes one depth render: a cascade of a directional light, the map of a spot light, a face of
/// a point light.
///
/// All matrices start from coordinates relative to [`ShadowView::anchor_render`], a point of render
/// space inside the view (the light itself where the projection is perspective). Subtracting it
/// first keeps f32 exact to the texel far from the origin. Lengths are in world units, and depths
/// are reversed: near 1, far 0. A view is valid for the `origin` of the frame in which it was made;
/// under another one its shadows are displaced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadowView {
    /// Is its number among the views of all lights that share the texture.
    index: u32,
    layer: u32,
    /// Counts the texels per side of a layer.
    pub(super) map_size: u32,
    /// Is the rectangle of the layer that it is rendered into.
    texels: TexelRect,
    anchor_render: Vec3,
    /// Has reversed depth: near 1, far 0.
    clip_from_anchor: DMat4,
    pub(super) placement: ViewPlacement,
    /// Is the largest f32 render coordinate, in world units, whose rounding all positions inside
    /// the view may have. For a local light it is the light's own, since the rounding of what it
    /// shines on grows with the distance from it; and `caster_reach` more.
    pub(super) render_reach: f64,
    /// Is the largest world distance, along an axis, of a corner of a drawn caster from a local
    /// light; 0 for a directional one. A large triangle is displaced everywhere by what its corners
    /// are rounded by.
    pub(super) caster_reach: f64,
    /// States that the device clips depth to -1..1, as OpenGL does.
    pub(super) has_symmetric_clip_depth: bool,
    /// Is the world distance from a local light up to which receivers are seen; infinite for a
    /// directional one.
    pub(super) reach: f64,
    /// Is the world distance beyond which a local light does not shine; infinite for a directional
    /// one.
    range: f64,
}

/// Describes the view of a local light.
pub(crate) struct PerspectiveView<'a> {
    pub axes: &'a LightAxes,
    pub position_world: DVec3,
    /// Is in tangents.
    pub rect: &'a MapRect,
    /// Is the world distance of the near plane along the view's axis.
    pub near: f64,
    /// Is the largest world distance, along an axis, of a corner of a drawn caster from the light.
    pub caster_reach: f64,
    /// States that the device clips depth to -1..1, as OpenGL does.
    pub has_symmetric_clip_depth: bool,
    /// Is the world distance up to which receivers are seen.
    pub reach: f64,
    /// Is the world distance beyond which the light does not shine.
    pub range: f64,
    /// Is the cosine of the half-angle of a cone; -2 if there is no cone.
    pub cone_cosine: f64,
}

impl ShadowView {
    /// Returns the orthographic view over light-space bounds, for an engine whose render space
    /// begins at `origin`.
    pub(crate) fn orthographic(
        &LightSpace { axes, origin }: &LightSpace,
        bounds: &LightSpaceBounds,
        layer: u32,
    ) -> Self {
        let (rect, depth) = (&bounds.rect, &bounds.depth);
        let size = rect.max() - rect.min;
        let middle = (rect.min + size * 0.5).extend((depth.near + depth.far) * 0.5);
        let anchor_render = (axes.light_from_world.transpose() * middle - origin).as_vec3();
        Self::orthographic_from(anchor_render, &LightSpace { axes, origin }, bounds, layer)
    }

    /// Returns the same view with its matrices relative to `anchor_render`, a point inside it.
    pub(super) fn orthographic_from(
        anchor_render: Vec3,
        &LightSpace { axes, origin }: &LightSpace,
        bounds: &LightSpaceBounds,
        layer: u32,
    ) -> Self {
        let (rect, depth) = (&bounds.rect, &bounds.depth);
        let size = rect.max() - rect.min;
        let light_from_world = axes.light_from_world;
        // The anchor is rounded to f32; everything after it starts from the rounded one, so nothing
        // is lost.
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
            index: layer,
            layer,
            map_size: rect.size_texels.max_element(),
            texels: TexelRect {
                size: rect.size_texels,
                ..TexelRect::default()
            },
            anchor_render,
            clip_from_anchor,
            placement: ViewPlacement::Orthographic {
                axes,
                bounds: *bounds,
            },
            render_reach: f64::from(anchor_render.abs().max_element()) + half.length(),
            caster_reach: 0.0,
            has_symmetric_clip_depth: false,
            reach: f64::INFINITY,
            range: f64::INFINITY,
        }
    }

    /// Returns the same view, rendered into a rectangle of the first layer of a texture of
    /// `map_size` texels a side, which it shares with other views.
    pub(crate) fn in_shared_layer(self, texels: TexelRect, map_size: u32) -> Self {
        Self {
            layer: 0,
            map_size,
            texels,
            ..self
        }
    }

    /// Returns the view of a local light through a rectangle of tangents.
    pub(crate) fn perspective(local: &PerspectiveView<'_>, origin: DVec3, layer: u32) -> Self {
        let &PerspectiveView {
            axes,
            position_world,
            rect,
            near,
            caster_reach,
            has_symmetric_clip_depth,
            reach,
            range,
            cone_cosine,
        } = local;
        let anchor_render = (position_world - origin).as_vec3();
        let size = rect.max() - rect.min;
        // clip = 2 (tangent - min) / size * w - w, with w = -z and tangent * w = x or y; depth * w
        // = near.
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
            index: layer,
            layer,
            map_size: rect.size_texels.max_element(),
            texels: TexelRect {
                size: rect.size_texels,
                ..TexelRect::default()
            },
            anchor_render,
            clip_from_anchor: clip_from_light * light_from_anchor,
            placement: ViewPlacement::Perspective {
                axes: *axes,
                position_world,
                rect: *rect,
                near,
                cone_cosine,
            },
            render_reach: local_render_reach(anchor_render, caster_reach),
            caster_reach,
            has_symmetric_clip_depth,
            reach,
            range,
        }
    }

    /// Returns the same view of the same world, for a render space that begins at `origin`.
    pub(crate) fn rebased(&self, origin: DVec3) -> Self {
        match &self.placement {
            ViewPlacement::Orthographic { axes, bounds } => {
                let axes = *axes;
                Self {
                    layer: self.layer,
                    map_size: self.map_size,
                    texels: self.texels,
                    ..Self::orthographic(&LightSpace { axes, origin }, bounds, self.index)
                }
            }
            ViewPlacement::Perspective { position_world, .. } => {
                let anchor_render = (*position_world - origin).as_vec3();
                Self {
                    anchor_render,
                    render_reach: local_render_reach(anchor_render, self.caster_reach),
                    ..*self
                }
            }
        }
    }

    /// Returns the view if its matrices and its position can be expressed in f32. The fit has
    /// checked whether f64 suffices for the position.
    pub(crate) fn checked(self) -> Result<Self, ShadowError> {
        // The square must fit as well: matrices hold reciprocals and products of these.
        let largest = f64::from(f32::MAX).sqrt();
        let extent = f64::from(self.texel_size_world().max_element()) * f64::from(self.map_size);
        let extent = extent.max(f64::from(self.depth_range_world()));
        let small = f64::from(self.texel_size_world().min_element());
        // The far corners of casters are clipped away; they need not be represented well.
        let distance = match &self.placement {
            ViewPlacement::Orthographic { .. } => self.render_reach,
            ViewPlacement::Perspective { .. } => {
                f64::from(self.anchor_render.abs().max_element()) + self.reach
            }
        };
        let fits = extent < largest
            && distance < largest
            && small > largest.recip()
            && f64::from(self.depth_range_world()) > largest.recip()
            && self.clip_from_anchor().is_finite();
        if fits {
            Ok(self)
        } else {
            Err(ShadowError::ViewNotRepresentable {
                extent_world: extent,
                distance_world: distance,
                coordinate_world: self.placement.reach_from_origin(),
            })
        }
    }

    /// Returns the layer of the light's depth texture that this view is rendered into.
    pub const fn layer(&self) -> u32 {
        self.layer
    }

    /// Returns the number of the view among all views of its light or pool.
    pub(crate) const fn index(&self) -> u32 {
        self.index
    }

    /// Returns the rectangle of the layer that this view is rendered into: all of it, but where the
    /// cascades of a light or the views of a pool share a layer.
    pub const fn texels(&self) -> TexelRect {
        self.texels
    }

    /// Returns the number of texels per side of a layer of the light's depth texture.
    pub const fn map_size(&self) -> u32 {
        self.map_size
    }

    /// Returns the point of render space that the matrices' coordinates are relative to.
    pub const fn anchor_render(&self) -> Vec3 {
        self.anchor_render
    }

    /// Returns the matrix to clip space (z in [0, 1], near 1, far 0) from `position_render -
    /// anchor_render`.
    pub fn clip_from_anchor(&self) -> Mat4 {
        self.clip_from_anchor.as_mat4()
    }

    /// Returns the matrix to clip space from render space. Prefer [`ShadowView::clip_from_anchor`]
    /// where coordinates are large: this one shifts shadows by the rounding of large f32
    /// coordinates.
    pub fn clip_from_render(&self) -> Mat4 {
        let shift = DMat4::from_translation(-self.anchor_render.as_dvec3());
        (self.clip_from_anchor * shift).as_mat4()
    }

    /// Returns the world size of a texel along the map's x and y: constant for an orthographic
    /// view. For a perspective one it is that at the farthest receiver that is seen within the
    /// light's range, where texels are largest.
    pub fn texel_size_world(&self) -> Vec2 {
        match &self.placement {
            ViewPlacement::Orthographic { bounds, .. } => bounds.rect.texel.as_vec2(),
            ViewPlacement::Perspective { rect, .. } => (rect.texel * self.reach).as_vec2(),
        }
    }

    /// Returns the world distance from the near plane to the far plane, or for a local light to the
    /// farthest receiver that is seen within its range, rounded up to a quantized size step.
    pub fn depth_range_world(&self) -> f32 {
        match &self.placement {
            ViewPlacement::Orthographic { bounds, .. } => bounds.depth.length() as f32,
            ViewPlacement::Perspective { near, .. } => (self.reach - near) as f32,
        }
    }

    /// Returns the position of the layer's first texel in a grid of such texels that is fixed in
    /// the world (for a local light around it), modulo 65536: x in the low half, y, which grows
    /// downward, in the high.
    pub(crate) fn world_grid(&self) -> u32 {
        let rect = self.placement.rect();
        let first = DVec2::new(rect.min.x, -rect.max().y) / rect.texel;
        let first = first - self.texels.min.as_dvec2();
        let wrapped = first.round().rem_euclid(DVec2::splat(65_536.0));
        wrapped.x as u32 | (wrapped.y as u32) << 16
    }

    pub(crate) fn placement(&self) -> &ViewPlacement {
        &self.placement
    }

    /// Returns the matrix to texel coordinates of the view's rectangle (origin top left, centres at
    /// halves), ndc depth and w, from anchor-relative coordinates.
    pub(crate) fn texel_from_anchor(&self) -> DMat4 {
        let half = self.texels.size.as_dvec2() * 0.5;
        let texel_from_clip = DMat4::from_cols(
            DVec4::new(half.x, 0.0, 0.0, 0.0),
            DVec4::new(0.0, -half.y, 0.0, 0.0),
            DVec4::new(0.0, 0.0, 1.0, 0.0),
            DVec4::new(half.x, half.y, 0.0, 1.0),
        );
        texel_from_clip * self.clip_from_anchor
    }

    /// Returns the shorter side, in world units, of a texel at a position of render space; `None`
    /// where the map does not cover it.
    pub(crate) fn texel_size_at(&self, position_render: DVec3) -> Option<f64> {
        let relative = position_render - self.anchor_render.as_dvec3();
        let clip = self.clip_from_anchor * relative.extend(1.0);
        let covers = clip.w > 0.0 && clip.truncate().truncate().abs().max_element() <= clip.w;
        // An orthographic view has w = 1.
        let rect = self.placement.rect();
        covers.then(|| rect.texel.min_element() * clip.w)
    }

    /// Returns the world distance from a local light up to which receivers are seen and beyond
    /// which casters are left out; infinite for a directional one.
    pub(crate) const fn reach_world(&self) -> f64 {
        self.reach
    }

    /// Returns the world distance beyond which a local light does not shine; infinite for a
    /// directional one.
    pub(crate) const fn range_world(&self) -> f64 {
        self.range
    }

    /// Returns the world distance from a local light up to which receivers are seen; 0 for a
    /// directional one.
    pub(super) fn depth_range_from_light(&self) -> f64 {
        match &self.placement {
            ViewPlacement::Orthographic { .. } => 0.0,
            ViewPlacement::Perspective { .. } => self.reach,
        }
    }

    /// Returns the cosine of the half-angle of a cone; -2 if there is no cone.
    pub(crate) fn cone_cosine(&self) -> f64 {
        match &self.placement {
            ViewPlacement::Orthographic { .. } => -2.0,
            ViewPlacement::Perspective { cone_cosine, .. } => *cone_cosine,
        }
    }
}

/// Returns the render coordinate whose rounding all positions inside a local light's view may have,
/// however close to the light. It is the light's own, and the distance of the farthest corner of a
/// caster: a triangle is displaced, at its middle as well, by what its corners are rounded by. That
/// comes to `2u` of their distance in the vertex stage, which adds two products of that size, and
/// to as much where the triangle is clipped at the sides of the map.
fn local_render_reach(anchor_render: Vec3, caster_reach: f64) -> f64 {
    f64::from(anchor_render.abs().max_element()) + caster_reach
}
