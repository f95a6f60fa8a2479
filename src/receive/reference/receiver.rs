//! Computes where a receiver lies in a view's map, and how its bias moves it.

use glam::{DVec2, DVec3, Vec2, Vec3};

use crate::receive::bias::BiasScheme;
use crate::receive::reference::Receiver;
use crate::receive::{Bias, Filter, ShadowViewUniform};

/// Is the steepest gradient in depth per texel: `SHADOW_MAX_GRADIENT` of `wgsl/bias_plane.wgsl`.
const MAX_GRADIENT: f64 = 1e4;

/// Is `SHADOW_POSITION_ROUNDING` of `wgsl/raised_plane.wgsl`.
const POSITION_ROUNDING: f64 = 2.0 * f32::EPSILON as f64;

/// Is the least weight of a cascade. It is above 0, so that every position within a cascade has a
/// weighted mean.
const LEAST_WEIGHT: f64 = 1.0 / 4096.0;

/// Returns the receiver at `position` (render space) with the geometric normal `normal` (unit
/// length, on the shaded side), as the shader computes it for a light with this filter and bias.
pub fn receiver(
    view: &ShadowViewUniform,
    filter: Filter,
    bias: Bias,
    position: DVec3,
    normal: DVec3,
) -> Receiver {
    let map = Map::of(view);
    let position_light = map.light_from_render(position - map.anchor);
    let normal_light = map.light_from_render(normal);
    let moved = match (bias.scheme(filter), map.is_local) {
        (BiasScheme::Plane, false) => directional_plane(&map, position_light, normal_light),
        (BiasScheme::Plane, true) => local_plane(&map, position_light, normal_light),
        (BiasScheme::NormalOffset, false) => {
            directional_normal_offset(&map, position_light, normal_light)
        }
        (BiasScheme::NormalOffset, true) => local_normal_offset(&map, position_light, normal_light),
        (BiasScheme::Manual, _) => manual(&map, position_light, normal_light),
    };
    Receiver {
        texel: moved.texel_from_middle + Vec2::from_array(view.mapping.middle).as_dvec2(),
        depth: moved.depth,
        gradient: moved.gradient,
        penumbra: f64::from(view.light_spread) / map.depth_scale * map.texel_scale,
        grid: view.grid,
        inside: holds(view, position),
    }
}

/// Returns whether the map of `view` covers `position` (render space), as `shadow_view_holds` in
/// `wgsl/place.wgsl` does: within its sides, not beyond its far plane, and for a local light in
/// front of it and within its cone and range. A position that no view covers is lit.
pub fn holds(view: &ShadowViewUniform, position: DVec3) -> bool {
    let map = Map::of(view);
    let position_light = map.light_from_render(position - map.anchor);
    let texel = map.texel_from_middle(position_light);
    let inner = Vec2::from_array(view.mapping.inner).as_dvec2();
    let within = texel.abs().cmplt(inner).all();
    if map.is_local {
        let tangents = position_light.truncate() / position_light.z;
        within
            && position_light.z < 0.0
            && position_light.length_squared() < f64::from(view.range_squared)
            && tangents.length_squared() < f64::from(view.cone_tangent_squared)
    } else {
        within && map.depth(position_light) >= 0.0
    }
}

/// Returns the weight, from 1/4096 to 1, of a cascade at a `position` (render space) that it
/// covers, where cascades blend. It is the `shadow_blend_weight` of `wgsl/place.wgsl`.
pub fn weight(view: &ShadowViewUniform, position: DVec3) -> f64 {
    let map = Map::of(view);
    let texel = map.texel_from_middle(map.light_from_render(position - map.anchor));
    let from_border = Vec2::from_array(view.mapping.inner).as_dvec2() - texel.abs();
    let share = from_border.min_element() * f64::from(view.blend_scale);
    // A share of NaN gives the least weight.
    if share >= LEAST_WEIGHT {
        share.min(1.0)
    } else {
        LEAST_WEIGHT
    }
}

/// Holds the members of a view's uniform that describe its map, in f64.
struct Map<'a> {
    view: &'a ShadowViewUniform,
    is_local: bool,
    anchor: DVec3,
    texel_scale: DVec2,
    texel_offset: DVec2,
    texel_size: DVec2,
    depth_scale: f64,
    rounding: f64,
    offset_texels: f64,
    lateral_error: f64,
    depth_error: f64,
}

/// Describes a receiver that a bias has moved.
struct Moved {
    texel_from_middle: DVec2,
    depth: f64,
    gradient: DVec2,
}

impl<'a> Map<'a> {
    fn of(view: &'a ShadowViewUniform) -> Self {
        let mapping = &view.mapping;
        Self {
            view,
            is_local: view.is_local > 0.0,
            anchor: Vec3::from_array(view.anchor).as_dvec3(),
            texel_scale: Vec2::from_array(mapping.texel_scale).as_dvec2(),
            texel_offset: Vec2::from_array(mapping.texel_offset).as_dvec2(),
            texel_size: Vec2::from_array(mapping.texel_size).as_dvec2(),
            depth_scale: f64::from(mapping.depth_scale),
            rounding: f64::from(mapping.rounding),
            offset_texels: f64::from(view.offset_texels),
            lateral_error: f64::from(view.lateral_error),
            depth_error: f64::from(view.depth_error),
        }
    }

    /// Returns a vector along the axes of light space.
    fn light_from_render(&self, vector: DVec3) -> DVec3 {
        let rows = [self.view.right, self.view.down, self.view.toward];
        DVec3::from_array(rows.map(|row| Vec3::from_array(row).as_dvec3().dot(vector)))
    }

    /// Returns where a position of light space falls in the map, in texels from its middle.
    fn texel_from_middle(&self, position_light: DVec3) -> DVec2 {
        let plane = if self.is_local {
            position_light.truncate() / -position_light.z
        } else {
            position_light.truncate()
        };
        plane * self.texel_scale + self.texel_offset
    }

    /// Returns the ndc depth of a position of light space.
    fn depth(&self, position_light: DVec3) -> f64 {
        if self.is_local {
            self.depth_scale / -position_light.z
        } else {
            position_light.z * self.depth_scale + f64::from(self.view.depth_offset)
        }
    }

    /// Returns the depth by which rounding may displace a plane with this gradient.
    fn slack(&self, gradient: DVec2) -> f64 {
        self.lateral_error * (gradient.x.abs() + gradient.y.abs()) + self.depth_error
    }

    /// Returns the world distance by which a plane at a signed distance of `height` from a local
    /// light is moved toward it for rounding, as `shadow_local_rounding` of
    /// `wgsl/raised_plane.wgsl` does.
    fn local_rounding(&self, position_light: DVec3, height: f64) -> f64 {
        let rounding = f64::from(self.view.offset_world)
            + POSITION_ROUNDING * position_light.abs().max_element();
        rounding.min(0.5 * height.abs())
    }

    /// Returns a receiver that a bias has moved to `light`.
    fn moved(&self, position_light: DVec3, slack: f64, gradient: DVec2) -> Moved {
        Moved {
            texel_from_middle: self.texel_from_middle(position_light),
            depth: self.depth(position_light) + slack,
            gradient,
        }
    }
}

fn directional_plane(map: &Map<'_>, position_light: DVec3, normal_light: DVec3) -> Moved {
    let rise = normal_light.truncate() * map.texel_size;
    let offset = map.offset_texels * rise.abs().element_sum() + map.rounding;
    let gradient = if normal_light.z.abs() > 0.0 {
        limited(-rise / normal_light.z * map.depth_scale)
    } else {
        DVec2::ZERO
    };
    map.moved(
        position_light + normal_light * offset,
        map.slack(gradient),
        gradient,
    )
}

fn directional_normal_offset(map: &Map<'_>, position_light: DVec3, normal_light: DVec3) -> Moved {
    let across = normal_light.truncate().abs() * map.texel_size;
    let offset = map.offset_texels * across.element_sum() + map.rounding;
    map.moved(
        position_light + normal_light * offset,
        map.depth_error,
        DVec2::ZERO,
    )
}

fn local_plane(map: &Map<'_>, position_light: DVec3, normal_light: DVec3) -> Moved {
    let height = normal_light.dot(position_light);
    let rounding = map.local_rounding(position_light, height);
    let rise = normal_light.truncate() * map.texel_size;
    let wanted = map.offset_texels * -position_light.z * rise.abs().element_sum();
    let offset = wanted.min(0.5 * (height.abs() - rounding));
    let plane = raised_plane(
        map,
        position_light,
        normal_light,
        &Lift { rounding, offset },
    );
    let gradient = limited(plane.gradient);
    Moved {
        depth: plane.depth + map.slack(gradient),
        gradient,
        ..plane
    }
}

fn local_normal_offset(map: &Map<'_>, position_light: DVec3, normal_light: DVec3) -> Moved {
    let height = normal_light.dot(position_light);
    let rounding = map.local_rounding(position_light, height);
    let rise = normal_light.truncate() * map.texel_size;
    let per_w = map.offset_texels * rise.abs().element_sum();
    let growth = per_w * (-normal_light.z).max(0.0);
    let offset = per_w * -position_light.z * (1.0 + 2.0 * growth);
    if growth >= 0.5 || offset + rounding >= height.abs() {
        return Moved {
            texel_from_middle: map.texel_from_middle(position_light),
            depth: 2.0,
            gradient: DVec2::ZERO,
        };
    }
    let plane = raised_plane(
        map,
        position_light,
        normal_light,
        &Lift { rounding, offset },
    );
    Moved {
        depth: plane.depth + map.depth_error,
        gradient: DVec2::ZERO,
        ..plane
    }
}

/// Describes how far a plane is moved under a local light, in world units.
struct Lift {
    /// Is the distance toward the light.
    rounding: f64,
    /// Is the distance along the normal.
    offset: f64,
}

/// Returns the receiver on its tangent plane under a local light, after the plane has been moved.
/// The receiver moves across the map by the tangents of the offset.
fn raised_plane(map: &Map<'_>, position_light: DVec3, normal_light: DVec3, lift: &Lift) -> Moved {
    let height = normal_light.dot(position_light);
    let moved = height - lift.rounding.copysign(height) + lift.offset;
    let shift = normal_light.truncate() * (lift.offset / -position_light.z) * map.texel_scale;
    let depth = map.depth(position_light);
    let (gradient, raised) = if moved.abs() > 0.0 {
        let gradient = normal_light.truncate() * map.texel_size * map.depth_scale / moved;
        (gradient, depth * height / moved)
    } else {
        (DVec2::ZERO, depth)
    };
    Moved {
        texel_from_middle: map.texel_from_middle(position_light) + shift,
        depth: raised + gradient.dot(shift) + depth * map.rounding,
        gradient,
    }
}

fn manual(map: &Map<'_>, position_light: DVec3, normal_light: DVec3) -> Moved {
    let toward_light = if map.is_local {
        -position_light.normalize()
    } else {
        DVec3::Z
    };
    let slope = f64::from(map.view.manual_slope) * (1.0 - normal_light.dot(toward_light));
    let distance = slope.max(f64::from(map.view.manual_constant));
    let moved = map.moved(position_light + toward_light * distance, 0.0, DVec2::ZERO);
    if map.is_local && distance >= position_light.length() {
        return Moved {
            texel_from_middle: map.texel_from_middle(position_light),
            depth: 2.0,
            ..moved
        };
    }
    moved
}

/// Returns a gradient whose components are finite.
fn limited(gradient: DVec2) -> DVec2 {
    gradient.clamp(DVec2::splat(-MAX_GRADIENT), DVec2::splat(MAX_GRADIENT))
}
