//! Measures how far a surface point is from the edge of a shadow, by rings of rays on its tangent
//! plane.
//!
//! Distances are measured across the light's rays, as a shadow map sees them, so that they can be
//! divided by the size of a texel.

use glam::DVec3;

use crate::scene::Scene;
use crate::truth::{LightInWorld, World};

/// Holds the radii of the rings in world units.
#[derive(Clone, Copy, Debug)]
pub struct Rings {
    least: f64,
    greatest: f64,
    rays: u32,
}

/// Is the ratio of the radius of a ring to that of the one before; the last one found is refined by
/// halving.
const RATIO: f64 = 1.6;
const HALVINGS: u32 = 4;

impl Rings {
    /// Returns radii from a fraction of the finest texel in use to some texels of the coarsest.
    pub fn of_scene(scene: &Scene, rays: u32) -> Self {
        Self::of_diameter(scene.diameter(), rays)
    }

    /// Returns the same for a scene of this size in world units.
    pub fn of_diameter(diameter: f64, rays: u32) -> Self {
        Self {
            least: diameter / 40_000.0,
            greatest: diameter / 40.0,
            rays,
        }
    }
}

/// Returns the distance to the nearest edge, to within a few percent for straight edges; infinite
/// where no ring meets one.
pub fn distance(world: &World, position: DVec3, normal: DVec3, rings: &Rings) -> f64 {
    if rings.rays == 0 {
        return f64::INFINITY;
    }
    let here = world.is_hidden(position, normal);
    let ring_changes = |radius: f64, turn: f64| {
        (0..rings.rays).any(|step| {
            let angle = std::f64::consts::TAU * (f64::from(step) + turn) / f64::from(rings.rays);
            let place = on_plane(world.light(), position, normal, radius, angle);
            place.is_some_and(|place| {
                world.is_hidden(place, normal) != here
                    // What lies behind another surface is no edge on this one.
                    && world.is_clear(position, place, normal)
            })
        })
    };
    let mut inner = 0.0;
    let mut outer = rings.least;
    let mut turn = 0.0;
    while !ring_changes(outer, turn) {
        inner = outer;
        outer *= RATIO;
        // Rings are rotated against each other, so that a thin shadow does not pass through all of
        // them unnoticed.
        turn = (turn + 0.618_034) % 1.0;
        if outer > rings.greatest {
            return f64::INFINITY;
        }
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (inner + outer);
        if ring_changes(middle, turn) {
            outer = middle;
        } else {
            inner = middle;
        }
    }
    0.5 * (inner + outer)
}

/// Returns the position on the tangent plane that lies `radius` to the side of `position`, across
/// the light's rays; `None` where the ray there does not meet the plane before the light.
fn on_plane(
    light: &LightInWorld,
    position: DVec3,
    normal: DVec3,
    radius: f64,
    angle: f64,
) -> Option<DVec3> {
    let (toward_light, reach) = light.toward_light_from(position);
    let (across, along) = toward_light.any_orthonormal_pair();
    let beside = (across * angle.cos() + along * angle.sin()) * radius;
    let ray = match light {
        LightInWorld::Far { .. } => toward_light,
        LightInWorld::Near { .. } => toward_light * reach - beside,
    };
    let facing = normal.dot(ray);
    (facing > 0.0).then(|| position + beside - ray * (normal.dot(beside) / facing))
}
