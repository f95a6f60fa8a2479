//! Builds scenes of many lamps.

use example_support::hall::{self, lights::Lights};
use glam::{DVec3, Vec3};
use shadow_support::camera;
use shadow_support::mesh::Mesh;
use shadow_support::random::Random;
use wgpu_shadows::{CameraView, OmniLight, SpotLight};

/// Is the number of lamps on each side of the street, and the distance from one to the next.
const LAMPS_PER_SIDE: usize = 100;
const LAMP_DISTANCE: f32 = 9.0;

/// Holds the lamps of a scene, which are all of one kind.
pub enum Lamps {
    Spots(Vec<SpotLight>),
    Points(Vec<OmniLight>),
}

/// Is a scene of many lamps, in metres.
pub struct LampScene {
    pub name: &'static str,
    pub meshes: Vec<Mesh>,
    pub lamps: Lamps,
    pub camera: CameraView,
}

/// Returns the scenes in the order of the table.
pub fn all() -> Vec<LampScene> {
    vec![many_lights(), street()]
}

/// Returns the hall of the example `many_lights` with its 32 point lights.
fn many_lights() -> LampScene {
    let parts = hall::parts();
    let meshes = parts.iter().map(|(vertices, instance)| {
        let place = |vertex: &example_support::mesh::Vertex| {
            instance.render_from_model.transform_point3(vertex.position)
        };
        Mesh {
            positions: vertices.iter().map(place).collect(),
            indices: (0..vertices.len() as u32).collect(),
        }
    });
    LampScene {
        name: "many_lights",
        meshes: meshes.collect(),
        lamps: Lamps::Points(
            Lights::at(0.0)
                .lamps
                .iter()
                .map(|lamp| lamp.light())
                .collect(),
        ),
        camera: camera::looking(hall::EYE, hall::TARGET, hall::FIELD_OF_VIEW_RADIANS),
    }
}

/// Returns a street of 900 metres with 200 lamps, parked cars, fences, bins and people.
fn street() -> LampScene {
    let mut random = Random::new(31);
    let length = LAMPS_PER_SIDE as f32 * LAMP_DISTANCE;
    let mut meshes = vec![Mesh::sheet(
        Vec3::new(-20.0, 0.0, 10.0),
        Vec3::X * 40.0,
        Vec3::NEG_Z * (length + 20.0),
    )];
    let mut lamps = Vec::new();
    for side in [-1.0_f32, 1.0] {
        for index in 0..LAMPS_PER_SIDE {
            let z = -LAMP_DISTANCE * index as f32;
            let post = Vec3::new(6.0 * side, 0.0, z);
            meshes.push(Mesh::standing_box(post, Vec3::new(0.14, 5.2, 0.14), 0.0));
            lamps.push(SpotLight {
                position_world: (post + Vec3::new(-0.6 * side, 5.4, 0.0)).as_dvec3(),
                direction: Vec3::new(-0.15 * side, -1.0, 0.0),
                outer_angle_radians: 1.05,
                range: 13.0,
            });
            let mut put = |x: [f32; 2], size: Vec3, turn: f32| {
                let foot = Vec3::new(
                    side * random.between(x[0], x[1]),
                    0.0,
                    z + random.between(-4.0, 4.0),
                );
                meshes.push(Mesh::standing_box(foot, size, turn));
            };
            put([3.6, 4.4], Vec3::new(1.7, 1.4, 4.1), 0.03);
            put([6.6, 7.2], Vec3::new(0.6, 1.0, 0.6), 0.4);
            put([5.0, 8.0], Vec3::new(0.35, 1.75, 0.3), 1.1);
            put([0.0, 2.5], Vec3::new(0.35, 1.7, 0.3), 0.7);
            for post in 0..6 {
                let foot = Vec3::new(8.2 * side, 0.0, z + 1.5 * post as f32);
                meshes.push(Mesh::standing_box(foot, Vec3::new(0.06, 1.1, 0.06), 0.0));
            }
        }
        for house in 0..(length / 18.0) as u32 {
            let foot = Vec3::new(14.0 * side, 0.0, -18.0 * house as f32);
            let height = 5.0 + (house * 7 % 5) as f32;
            meshes.push(Mesh::standing_box(foot, Vec3::new(9.0, height, 16.5), 0.0));
        }
    }
    LampScene {
        name: "street",
        meshes,
        lamps: Lamps::Spots(lamps),
        camera: camera::looking(Vec3::new(2.2, 2.1, 4.0), Vec3::new(-0.8, 0.6, -14.0), 0.9),
    }
}

impl LampScene {
    /// Returns the number of views of all lamps.
    pub fn views(&self) -> u32 {
        match &self.lamps {
            Lamps::Spots(lamps) => lamps.len() as u32,
            Lamps::Points(lamps) => 6 * lamps.len() as u32,
        }
    }

    /// Returns the position and the range of each lamp, and the axis and the cosine of its cone.
    pub fn places(&self) -> Vec<(DVec3, f64, DVec3, f64)> {
        match &self.lamps {
            Lamps::Spots(lamps) => lamps
                .iter()
                .map(|lamp| {
                    let cosine = f64::from(lamp.outer_angle_radians).cos();
                    let axis = lamp.direction.as_dvec3().normalize();
                    (lamp.position_world, f64::from(lamp.range), axis, cosine)
                })
                .collect(),
            Lamps::Points(lamps) => lamps
                .iter()
                .map(|lamp| (lamp.position_world, f64::from(lamp.range), DVec3::Y, -2.0))
                .collect(),
        }
    }
}
