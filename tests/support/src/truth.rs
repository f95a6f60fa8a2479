//! Computes the truth by rays through the triangles, in double precision.

use glam::{DVec3, Mat4};
use parry3d_f64::math::Vec3 as ParryVec3;
use parry3d_f64::query::Ray;
use parry3d_f64::shape::{CompositeShapeRef, TriMesh};

use crate::scene::{Light, Scene};
use crate::triangle::Triangle;

/// Holds the triangles of a scene, and its light, in render space.
pub struct World {
    mesh: TriMesh,
    normals: Vec<DVec3>,
    /// Is the distance at which rays start from the surface that they leave, along its normal: far
    /// above rounding, far below any feature.
    lift: f64,
    light: LightInWorld,
}

/// Is the light in render space.
#[derive(Clone, Copy, Debug)]
pub enum LightInWorld {
    Far {
        /// Has unit length.
        toward_light: DVec3,
        /// Is the tangent of half the angular diameter.
        disc_tangent: f64,
    },
    Near {
        position: DVec3,
        range: f64,
        /// Is the radius of the ball that shines; its disc faces every receiver.
        radius: f64,
        /// Is the axis of the cone and the cosine of its half-angle; -2 if there is no cone.
        axis: DVec3,
        cone_cosine: f64,
    },
}

/// Is a surface point that a ray met.
#[derive(Clone, Copy, Debug)]
pub struct Hit {
    pub distance: f64,
    /// Is the geometric normal of unit length, on the side from which the ray came.
    pub normal: DVec3,
}

impl World {
    pub fn new(scene: &Scene) -> Self {
        let triangles: Vec<Triangle> = scene
            .meshes
            .iter()
            .flat_map(|mesh| mesh.triangles(&Mat4::IDENTITY))
            .collect();
        Self::from_triangles(
            &triangles,
            scene.diameter(),
            LightInWorld::new(&scene.light, scene.origin),
        )
    }

    /// Makes the world. `diameter` is the size of the scene, from which the least distance of rays
    /// is derived. Triangles without area, which no ray meets and which have no normal, are left
    /// out; at least one other must remain.
    pub fn from_triangles(triangles: &[Triangle], diameter: f64, light: LightInWorld) -> Self {
        let with_normals: Vec<([DVec3; 3], DVec3)> = triangles
            .iter()
            .filter_map(|triangle| Some((triangle.0, triangle.try_normal()?)))
            .collect();
        let corners = with_normals.iter().flat_map(|(triangle, _)| triangle);
        let indices = (0..with_normals.len() as u32)
            .map(|triangle| [0, 1, 2].map(|corner| 3 * triangle + corner))
            .collect();
        Self {
            mesh: TriMesh::new(corners.copied().map(to_parry).collect(), indices)
                .expect("a mesh with triangles"),
            normals: with_normals.iter().map(|(_, normal)| *normal).collect(),
            lift: 1e-9 * diameter,
            light,
        }
    }

    pub fn light(&self) -> &LightInWorld {
        &self.light
    }

    /// Returns the nearest surface along a ray, up to a distance of `reach`.
    pub fn first_hit(&self, from: DVec3, direction: DVec3, reach: f64) -> Option<Hit> {
        let (triangle, distance) = self.cast(from, direction, reach)?;
        let normal = self.normals[triangle as usize];
        Some(Hit {
            distance,
            normal: if normal.dot(direction) > 0.0 {
                -normal
            } else {
                normal
            },
        })
    }

    /// Returns the distance from a surface point to the first thing between it and the middle of
    /// the light; `None` where it is lit.
    pub fn occluder(&self, position: DVec3, normal: DVec3) -> Option<f64> {
        let (direction, reach) = self.light.toward_light_from(position);
        self.occluder_along(position, normal, direction, reach)
    }

    /// Returns whether the middle of the light is hidden from a surface point.
    pub fn is_hidden(&self, position: DVec3, normal: DVec3) -> bool {
        self.occluder(position, normal).is_some()
    }

    /// Returns whether there is nothing between two positions on one tangent plane.
    pub fn is_clear(&self, from: DVec3, to: DVec3, normal: DVec3) -> bool {
        let way = to - from;
        let (direction, reach) = (way.normalize(), way.length());
        self.occluder_along(from, normal, direction, reach)
            .is_none()
    }

    /// Returns the fraction of the light that a surface point sees: exact for lights without
    /// extent, otherwise the mean over `side * side` stratified points of its disc. Where the rim
    /// and a coarse grid agree, so does everything between.
    pub fn visibility(&self, position: DVec3, normal: DVec3, side: u32) -> f64 {
        let (toward_light, reach) = self.light.toward_light_from(position);
        let disc_tangent = self.light.disc_tangent_from(reach);
        if disc_tangent == 0.0 {
            return f64::from(u8::from(!self.is_hidden(position, normal)));
        }
        let (across, along) = toward_light.any_orthonormal_pair();
        let sees = |[x, y]: [f64; 2]| {
            let on_disc = (across * x + along * y) * disc_tangent;
            let way = toward_light + on_disc;
            self.occluder_along(position, normal, way.normalize(), reach * way.length())
                .is_none()
        };
        let rim = (0..24).map(|step| {
            let angle = std::f64::consts::TAU * f64::from(step) / 24.0;
            [angle.cos(), angle.sin()]
        });
        let coarse = rim.chain(disc_points(6));
        let seen = coarse.clone().filter(|&place| sees(place)).count();
        if seen == 0 {
            return 0.0;
        }
        if seen == coarse.count() {
            return 1.0;
        }
        let seen = disc_points(side).filter(|&place| sees(place)).count();
        seen as f64 / f64::from(side * side)
    }

    fn occluder_along(
        &self,
        position: DVec3,
        normal: DVec3,
        direction: DVec3,
        reach: f64,
    ) -> Option<f64> {
        let start = position + normal * self.lift;
        self.cast(start, direction, reach)
            .map(|(_, distance)| distance)
    }

    fn cast(&self, from: DVec3, direction: DVec3, reach: f64) -> Option<(u32, f64)> {
        let ray = Ray::new(to_parry(from), to_parry(direction));
        CompositeShapeRef(&self.mesh).cast_local_ray(&ray, reach, false)
    }
}

impl LightInWorld {
    pub fn new(light: &Light, origin: DVec3) -> Self {
        match *light {
            Light::Sun {
                direction,
                angular_diameter_radians,
            } => Self::Far {
                toward_light: -direction.as_dvec3().normalize(),
                disc_tangent: (angular_diameter_radians * 0.5).tan(),
            },
            Light::Spot {
                position_world,
                direction,
                outer_angle_radians,
                range,
                radius_world,
            } => Self::Near {
                position: position_world - origin,
                range: f64::from(range),
                radius: f64::from(radius_world),
                axis: direction.as_dvec3().normalize(),
                cone_cosine: f64::from(outer_angle_radians).cos(),
            },
            Light::Point {
                position_world,
                range,
                radius_world,
            } => Self::Near {
                position: position_world - origin,
                range: f64::from(range),
                radius: f64::from(radius_world),
                axis: DVec3::Y,
                cone_cosine: -2.0,
            },
        }
    }

    /// Returns the tangent of half the angle under which the light is seen from a distance of
    /// `reach`.
    fn disc_tangent_from(&self, reach: f64) -> f64 {
        match *self {
            Self::Far { disc_tangent, .. } => disc_tangent,
            Self::Near { radius, .. } => radius / reach,
        }
    }

    /// Returns the unit direction toward the middle of the light, and the distance to it.
    pub fn toward_light_from(&self, position: DVec3) -> (DVec3, f64) {
        match *self {
            Self::Far { toward_light, .. } => (toward_light, f64::INFINITY),
            Self::Near {
                position: light, ..
            } => {
                let way = light - position;
                (way.normalize(), way.length())
            }
        }
    }

    /// Returns whether the light shines on a position at all, with nothing in between.
    pub fn reaches(&self, place: DVec3) -> bool {
        match *self {
            Self::Far { .. } => true,
            Self::Near {
                position,
                range,
                axis,
                cone_cosine,
                ..
            } => {
                let way = place - position;
                way.length() < range && way.normalize().dot(axis) > cone_cosine
            }
        }
    }
}

/// Returns the middles of `side * side` patches of equal area on the unit disc (the concentric map
/// of Shirley and Chiu 1997).
fn disc_points(side: u32) -> impl Iterator<Item = [f64; 2]> + Clone {
    let place = move |index: u32| 2.0 * (f64::from(index) + 0.5) / f64::from(side) - 1.0;
    (0..side * side).map(move |index| {
        let (x, y) = (place(index % side), place(index / side));
        let quarter = std::f64::consts::FRAC_PI_4;
        let (radius, angle) = if x.abs() > y.abs() {
            (x, quarter * y / x)
        } else if y != 0.0 {
            (y, 2.0 * quarter - quarter * x / y)
        } else {
            (0.0, 0.0)
        };
        [radius * angle.cos(), radius * angle.sin()]
    })
}

/// Converts to the ray caster's own version of the vector library.
fn to_parry(vector: DVec3) -> ParryVec3 {
    ParryVec3::from_array(vector.to_array())
}
