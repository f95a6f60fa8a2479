//! `ShadowView`: one depth render of a light, as a value.

use glam::{DMat3, DMat4, DVec3, DVec4, Mat4, Vec2, Vec3};

use crate::fit::LightAxes;
use crate::fit::window::OrthoWindow;

/// One depth render: a cascade of a sun, the map of a spot, a face of a point light.
///
/// All matrices start from coordinates relative to [`ShadowView::anchor_render`], a point of render space inside the view (the
/// light itself where the projection is perspective). Subtracting it first keeps f32 exact to the texel far from the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadowView {
    layer: u32,
    map_size: u32,
    anchor_render: Vec3,
    /// Reversed depth: near 1, far 0.
    clip_from_anchor: DMat4,
    placement: ViewPlacement,
    /// Largest f32 render coordinate that positions inside the view have.
    render_reach: f64,
}

/// What a view looks at, in absolute world terms: two views with one placement see the same picture of the same world,
/// wherever render space begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ViewPlacement {
    Orthographic {
        axes: LightAxes,
        window: OrthoWindow,
    },
}

impl ShadowView {
    /// The view of an orthographic window, for an engine whose render space begins at `origin`.
    pub(crate) fn orthographic(
        axes: &LightAxes,
        window: &OrthoWindow,
        origin: DVec3,
        layer: u32,
    ) -> Self {
        let size = window.max() - window.min;
        let light_from_world = axes.light_from_world;
        let world_from_light = light_from_world.transpose();
        let middle = (window.min + size * 0.5).extend((window.near + window.far) * 0.5);
        let anchor_render = (world_from_light * middle - origin).as_vec3();
        // The anchor is rounded to f32; everything after it starts from the rounded one, so nothing is lost.
        let anchor_light = light_from_world * (anchor_render.as_dvec3() + origin);
        let scale = DVec3::new(2.0 / size.x, 2.0 / size.y, 1.0 / window.depth_range());
        let offset = (anchor_light - window.min.extend(window.far)) * scale;
        let linear = DMat3::from_diagonal(scale) * light_from_world;
        let clip_from_anchor = DMat4::from_cols(
            linear.x_axis.extend(0.0),
            linear.y_axis.extend(0.0),
            linear.z_axis.extend(0.0),
            DVec4::new(offset.x - 1.0, offset.y - 1.0, offset.z, 1.0),
        );
        let half = size.extend(window.depth_range()) * 0.5;
        Self {
            layer,
            map_size: window.map_size,
            anchor_render,
            clip_from_anchor,
            placement: ViewPlacement::Orthographic {
                axes: *axes,
                window: *window,
            },
            render_reach: f64::from(anchor_render.abs().max_element()) + half.length(),
        }
    }

    /// Layer of the light's depth texture that this view is rendered into.
    pub const fn layer(&self) -> u32 {
        self.layer
    }

    /// Texels per side of the map.
    pub const fn map_size(&self) -> u32 {
        self.map_size
    }

    /// The point of render space that the matrices' coordinates are relative to.
    pub const fn anchor_render(&self) -> Vec3 {
        self.anchor_render
    }

    /// Clip space (z in [0, 1], near 1, far 0) from `position_render - anchor_render`.
    pub fn clip_from_anchor(&self) -> Mat4 {
        self.clip_from_anchor.as_mat4()
    }

    /// Clip space from render space in one matrix. Prefer [`ShadowView::clip_from_anchor`] where coordinates are large.
    pub fn clip_from_render(&self) -> Mat4 {
        let shift = DMat4::from_translation(-self.anchor_render.as_dvec3());
        (self.clip_from_anchor * shift).as_mat4()
    }

    /// World size of a texel along the map's x and y: constant for an orthographic view.
    pub fn texel_size_world(&self) -> Vec2 {
        match &self.placement {
            ViewPlacement::Orthographic { window, .. } => window.texel.as_vec2(),
        }
    }

    /// World distance between the far and the near plane.
    pub fn depth_range_world(&self) -> f32 {
        match &self.placement {
            ViewPlacement::Orthographic { window, .. } => window.depth_range() as f32,
        }
    }

    pub(crate) fn placement(&self) -> &ViewPlacement {
        &self.placement
    }

    /// Texel coordinates (origin top left, centres at halves), ndc depth and w, from anchor-relative coordinates.
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

    /// Toward the light, homogeneous and relative to the anchor: `w` 0 for a direction, 1 for a place.
    pub(crate) fn light_from_anchor(&self) -> DVec4 {
        match &self.placement {
            ViewPlacement::Orthographic { axes, .. } => axes.toward_light().extend(0.0),
        }
    }

    /// Rounding error of a depth comparison, as ndc depth: `(absolute, relative to the depth itself)`.
    ///
    /// `q + 4u` of the depth range for storing and comparing (q one ulp of f32 at 1, u half of it), and `4u` of the render
    /// coordinates that both sides start from.
    pub(crate) fn depth_error_ndc(&self) -> (f64, f64) {
        let unit = f64::from(f32::EPSILON) * 0.5;
        match &self.placement {
            ViewPlacement::Orthographic { window, .. } => {
                let reach = self.render_reach / window.depth_range();
                (6.0 * unit + 4.0 * unit * reach, 0.0)
            }
        }
    }

    /// Rounding error of a lookup across the map, in texels: `6uN` for the arithmetic and `4u` of the render coordinates.
    pub(crate) fn lateral_error_texels(&self) -> f64 {
        let unit = f64::from(f32::EPSILON) * 0.5;
        match &self.placement {
            ViewPlacement::Orthographic { window, .. } => {
                6.0 * unit * f64::from(self.map_size)
                    + 4.0 * unit * self.render_reach / window.texel.min_element()
            }
        }
    }
}
