//! Defines the view that asks a rasterizer what lies on one ray from a receiver to a light.
//!
//! A view of a single texel, whose middle is the ray, is covered by a triangle exactly where the
//! triangle meets the ray: rasterizers sample at the middle of a texel. With the far plane at the
//! receiver and the near plane at the light, a depth above 0 tells that something lies between.

use glam::{DVec2, DVec3, UVec2, Vec3};

use crate::fit::boxes::Boxes;
use crate::fit::map_rect::{DepthRange, LightSpaceBounds, MapRect};
use crate::fit::texel_rect::TexelRect;
use crate::fit::view_rounding::{UNIT_ROUNDOFF, position_error_world};
use crate::fit::{LightAxes, LightSpace};
use crate::{Aabb, ShadowView};

/// Is the width of the texel as a share of the distance `R` of the farthest corner that is drawn
/// into it: 2⁻¹³.
///
/// Rasterizers snap corners to 1/256 of a texel (WebGPU's backends guarantee no finer grid), which
/// moves an edge by up to 1/512 texel along each axis; f32 moves it by some `4u R` whatever the
/// width. Both are equal where the width is `4u R · 512 = 2⁻¹³ R`. A finer texel gains nothing, and
/// clip coordinates stay within ±2¹⁴, inside the guard bands of rasterizers, so that no triangle is
/// clipped at the sides.
const TEXEL_SHARE: f64 = 1.0 / 8192.0;

/// Is the rounding of a triangle in such a view, in units of `u R`: 5 for the three products and
/// sums of the vertex stage, with rounded coefficients; 6 for the snapping, `√2 · 4`; 5 for the
/// depth that is interpolated between the corners. The rounding of the positions themselves comes
/// on top of it.
const TRIANGLE_ROUNDING: f64 = 16.0;

/// Is a ray from a point of a surface toward a light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShadowRay {
    /// Is the point of the surface, in render space.
    pub start_render: Vec3,
    /// Is the unit direction toward the light.
    pub toward_light: DVec3,
    /// Is the cosine of the angle between the surface's normal and the ray, above 0.
    pub cosine: f64,
    /// Is the world distance of the light; infinite for a directional one.
    pub length: f64,
}

/// Tells how far the bounds of what a ray meets extend.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RayReach {
    /// Is the world distance of the farthest corner from the start.
    pub farthest_corner: f64,
    /// Is the distance along the ray of the corner nearest to the light.
    pub nearest_to_light: f64,
}

/// Is the view along a ray.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RayView {
    pub view: ShadowView,
    /// Is the world height above the receiver's surface up to which the view sees nothing, which
    /// is also how far the ray may be off to its sides.
    pub blind_height_world: f64,
}

impl ShadowRay {
    /// Adds to `met` the casters whose bounds the ray meets. Returns how far these extend; `None`
    /// where there are none.
    pub(crate) fn find(&self, casters: &Boxes<'_>, met: &mut Vec<u32>) -> Option<RayReach> {
        let mut found = (None, met);
        casters.walk(
            &mut found,
            |_, around| self.meets(around),
            |(reach, met), index, bounds| {
                if self.meets(bounds) {
                    met.push(index);
                    let wider = self.extent(bounds);
                    let before = reach.unwrap_or(wider);
                    *reach = Some(RayReach {
                        farthest_corner: before.farthest_corner.max(wider.farthest_corner),
                        nearest_to_light: before.nearest_to_light.max(wider.nearest_to_light),
                    });
                }
            },
        );
        found.0
    }

    /// Returns the view along the ray, in the texel `texel` of a map of `map_size` texels a side.
    /// Returns `None` where rounding leaves nothing to be seen between receiver and light, or where
    /// the view cannot be represented. `depth_step_ndc` is how far storing a depth may move it.
    pub(crate) fn view(
        &self,
        reach: &RayReach,
        origin: DVec3,
        (index, texel, map_size): (u32, UVec2, u32),
        depth_step_ndc: f64,
    ) -> Option<RayView> {
        let is_local = self.length.is_finite();
        let farthest = if is_local {
            reach.farthest_corner.max(self.length)
        } else {
            reach.farthest_corner
        };
        let rounding = self.rounding_world(farthest);
        let far = rounding / self.cosine;
        let near = if is_local {
            self.length
        } else {
            reach.nearest_to_light + rounding
        };
        let depth_length = near - far;
        if depth_length.is_nan() || depth_length <= 0.0 {
            return None;
        }
        let axes = LightAxes::new(-self.toward_light, DVec3::Y);
        let start_light = axes.light_from_world * (self.start_render.as_dvec3() + origin);
        let width = farthest * TEXEL_SHARE;
        let bounds = LightSpaceBounds {
            rect: MapRect {
                min: start_light.truncate() - 0.5 * width,
                texel: DVec2::splat(width),
                size_texels: UVec2::ONE,
            },
            depth: DepthRange {
                far: start_light.z + far,
                near: start_light.z + near,
            },
        };
        // Relative to the receiver, depths near it are rounded least.
        let space = LightSpace { axes, origin };
        let view = ShadowView::orthographic_from(self.start_render, &space, &bounds, index);
        let rect = TexelRect {
            min: texel,
            size: UVec2::ONE,
        };
        Some(RayView {
            view: view.checked().ok()?.in_shared_layer(rect, map_size),
            blind_height_world: rounding + depth_step_ndc * depth_length * self.cosine,
        })
    }

    /// Returns how far rounding moves a triangle whose corners are up to `distance` away.
    fn rounding_world(&self, distance: f64) -> f64 {
        let coordinate = f64::from(self.start_render.abs().max_element()) + distance;
        position_error_world(coordinate) + TRIANGLE_ROUNDING * UNIT_ROUNDOFF * distance
    }

    fn extent(&self, bounds: &Aabb) -> RayReach {
        let start = self.start_render.as_dvec3();
        let (min, max) = (bounds.min.as_dvec3() - start, bounds.max.as_dvec3() - start);
        let toward = self.toward_light;
        RayReach {
            farthest_corner: min.abs().max(max.abs()).length(),
            nearest_to_light: (min * toward).max(max * toward).element_sum(),
        }
    }

    /// Returns whether geometry within `bounds` may lie on the ray, whatever the rounding, and
    /// beyond the far plane of the view. Flat ground does not hide itself, and a ray from it need
    /// not draw it.
    fn meets(&self, bounds: &Aabb) -> bool {
        let margin = self.rounding_world(self.extent(bounds).farthest_corner);
        let start = self.start_render.as_dvec3();
        // No component of the reciprocal is infinite, so that no product is NaN.
        let away_from_zero = |along: f64| along.abs().max(1e-30).copysign(along);
        let inverse = self.toward_light.map(away_from_zero).recip();
        let (min, max) = (bounds.min.as_dvec3() - start, bounds.max.as_dvec3() - start);
        let ends = |margin: f64| {
            let (low, high) = ((min - margin) * inverse, (max + margin) * inverse);
            [low.min(high).max_element(), low.max(high).min_element()]
        };
        let [enters, leaves] = ends(margin);
        let [_, leaves_exactly] = ends(0.0);
        enters.max(0.0) <= leaves.min(self.length) && leaves_exactly > margin / self.cosine
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ray_along_an_axis_meets_the_boxes_on_it() {
        let ray = ShadowRay {
            start_render: Vec3::new(1.0, 0.0, 2.0),
            toward_light: DVec3::Y,
            cosine: 1.0,
            length: 10.0,
        };
        let cube = |middle: Vec3| Aabb::new(middle - 0.5, middle + 0.5);
        assert!(ray.meets(&cube(Vec3::new(1.0, 5.0, 2.0))));
        assert!(ray.meets(&cube(Vec3::new(1.5, 5.0, 2.0))), "on its side");
        assert!(!ray.meets(&cube(Vec3::new(1.6, 5.0, 2.0))), "beside");
        assert!(!ray.meets(&cube(Vec3::new(1.0, 11.0, 2.0))), "beyond");
        assert!(!ray.meets(&cube(Vec3::new(1.0, -1.0, 2.0))), "behind");
        assert!(!ray.meets(&cube(Vec3::new(1.0, -0.5, 2.0))), "below");
        assert!(ray.meets(&cube(Vec3::new(1.0, -0.49, 2.0))), "around");
    }
}
