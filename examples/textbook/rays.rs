//! Holds the scene as rays see it: three boxes and a floor, in double precision.

use example_support::mesh::Object;
use glam::{DMat4, DVec3};

use crate::scene::Scene;

/// Is a ray through the scene: `origin + t * direction`.
#[derive(Clone, Copy)]
pub struct Ray {
    pub origin: DVec3,
    pub direction: DVec3,
}

/// Is the point where a ray first meets a surface.
pub struct Hit {
    pub t: f64,
    pub normal: DVec3,
    /// Is the index of the cube; `None` for the floor.
    pub cube: Option<usize>,
}

/// Holds floor and cubes.
pub struct World {
    floor: DMat4,
    cubes: Vec<DMat4>,
}

impl World {
    pub fn new(scene: &Scene) -> Self {
        let matrix = |object: &Object| object.render_from_model.as_dmat4();
        Self {
            floor: matrix(&scene.floor),
            cubes: scene.cubes.iter().map(matrix).collect(),
        }
    }

    /// Returns the first surface along `ray`, which starts outside all cubes and above the floor.
    pub fn first_hit(&self, ray: Ray) -> Option<Hit> {
        let cubes = self.cubes.iter().enumerate();
        cubes
            .filter_map(|(index, cube)| enter_cube(cube, index, ray))
            .chain(meet_floor(&self.floor, ray))
            .min_by(|one, other| one.t.total_cmp(&other.t))
    }

    /// Returns whether a cube other than `own` blocks `ray`. A convex body does not shadow the side
    /// that it turns to the light, and the floor is below everything.
    pub fn is_blocked(&self, ray: Ray, own: Option<usize>) -> bool {
        let cubes = self.cubes.iter().enumerate();
        cubes
            .filter(|(index, _)| Some(*index) != own)
            .any(|(index, cube)| enter_cube(cube, index, ray).is_some())
    }
}

/// Intersects by the slab method: a ray is inside the cube from -1 to 1 where it is between all
/// three pairs of opposite sides.
fn enter_cube(render_from_model: &DMat4, index: usize, ray: Ray) -> Option<Hit> {
    let model_from_render = render_from_model.inverse();
    let origin = model_from_render.transform_point3(ray.origin);
    let direction = model_from_render.transform_vector3(ray.direction);
    let one_side = (DVec3::NEG_ONE - origin) / direction;
    let other_side = (DVec3::ONE - origin) / direction;
    let enters = one_side.min(other_side);
    let t = enters.max_element();
    let leaves = one_side.max(other_side).min_element();
    let normal_model = -direction.signum() * DVec3::from(enters.cmpge(DVec3::splat(t)));
    (0.0 < t && t <= leaves).then(|| Hit {
        t,
        normal: render_from_model
            .transform_vector3(normal_model)
            .normalize(),
        cube: Some(index),
    })
}

/// Intersects the square from -1 to 1 at height 0, from above.
fn meet_floor(render_from_model: &DMat4, ray: Ray) -> Option<Hit> {
    let model_from_render = render_from_model.inverse();
    let origin = model_from_render.transform_point3(ray.origin);
    let direction = model_from_render.transform_vector3(ray.direction);
    let t = -origin.y / direction.y;
    let place = origin + direction * t;
    let hits = direction.y < 0.0 && t > 0.0 && place.x.abs() <= 1.0 && place.z.abs() <= 1.0;
    hits.then_some(Hit {
        t,
        normal: DVec3::Y,
        cube: None,
    })
}
