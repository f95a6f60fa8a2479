//! Defines what is drawn: three characters that walk in a circle between posts, a sun, a lamp and a
//! camera.

use std::error::Error;
use std::f32::consts::TAU;

use example_support::camera::Camera;
use example_support::mesh::{Instance, Object, Vertex, copies_pipeline, cube};
use glam::{Mat4, Quat, Vec3};
use shadow_support::triangle::Triangle;
use wgpu_shadows::{DepthFormat, DirectionalLight, MeshCaster, OmniLight};

use crate::character::{Character, Pose};

pub const TOWARD_SUN: Vec3 = Vec3::new(0.7, 0.9, 0.35);

const ACTORS: usize = 3;

/// Is the radius of the circle in which the characters walk, and the time for a round. A step of
/// each leg is as long as a second of the animation.
const WALK_RADIUS: f32 = 1.7;
const SECONDS_PER_ROUND: f32 = 9.0;

/// Are the lights as the library takes them.
pub struct Lights {
    pub sun: DirectionalLight,
    pub lamp: OmniLight,
}

pub struct Scene {
    pub character: Character,
    pub rigid: Vec<Object>,
}

impl Scene {
    pub fn new(device: &wgpu::Device) -> Result<Self, Box<dyn Error>> {
        let mesh = cube();
        let rigid = instances();
        let rigid = rigid
            .into_iter()
            .map(|instance| Object::new(device, &mesh, instance));
        Ok(Self {
            character: Character::load(include_bytes!("../character.glb"))?,
            rigid: rigid.collect(),
        })
    }

    /// Returns the poses of the characters.
    pub fn poses(&self, seconds: f32) -> Vec<Pose> {
        let pose = |index: usize| {
            let share = index as f32 / ACTORS as f32;
            let angle = TAU * (share + seconds / SECONDS_PER_ROUND);
            let place = WALK_RADIUS * Vec3::new(angle.cos(), 0.0, -angle.sin());
            // The characters walk toward +z, which is the tangent of the circle at angle π.
            let turn = Quat::from_rotation_y(angle + TAU / 2.0);
            let render_from_model = Mat4::from_rotation_translation(turn, place);
            self.character.pose(seconds + share, render_from_model)
        };
        (0..ACTORS).map(pose).collect()
    }

    pub fn rigid_casters(&self, device: &wgpu::Device) -> Result<Vec<MeshCaster>, Box<dyn Error>> {
        let pipeline = copies_pipeline(device, &[DepthFormat::Float32])?;
        let casters = self
            .rigid
            .iter()
            .map(|object| object.caster(device, &pipeline));
        Ok(casters.collect::<Result<_, _>>()?)
    }

    /// Returns all triangles, for rays.
    pub fn triangles(&self, poses: &[Pose]) -> Vec<Triangle> {
        let mut triangles = Vec::new();
        let mesh = cube();
        for object in &self.rigid {
            let place = object.render_from_model.as_dmat4();
            let corner = |vertex: &Vertex| place.transform_point3(vertex.position.as_dvec3());
            let corners = mesh.chunks_exact(3);
            triangles.extend(corners.map(|c| Triangle([0, 1, 2].map(|i| corner(&c[i])))));
        }
        let character = &self.character;
        for pose in poses {
            let corner = |index: &u32| {
                let vertex = &character.vertices[*index as usize];
                character.position(vertex, pose).as_dvec3()
            };
            let corners = character.indices.chunks_exact(3);
            triangles.extend(corners.map(|c| Triangle([0, 1, 2].map(|i| corner(&c[i])))));
        }
        triangles
    }
}

/// Returns a ground and a ring of posts.
fn instances() -> Vec<Instance> {
    let mut instances = vec![Instance {
        render_from_model: Mat4::from_scale_rotation_translation(
            Vec3::new(9.0, 0.1, 9.0),
            Quat::IDENTITY,
            Vec3::new(0.0, -0.1, 0.0),
        ),
        albedo: Vec3::splat(0.72),
        checker: 0.0,
    }];
    for index in 0..8 {
        let angle = TAU * (index as f32 + 0.15) / 8.0;
        instances.push(Instance {
            render_from_model: Mat4::from_scale_rotation_translation(
                Vec3::new(0.09, 0.5 + 0.1 * (index % 3) as f32, 0.09),
                Quat::from_rotation_y(-angle),
                Vec3::new(2.9 * angle.cos(), 0.5, 2.9 * angle.sin()),
            ),
            albedo: Vec3::new(0.55, 0.4, 0.3),
            checker: 0.0,
        });
    }
    instances
}

impl Lights {
    pub fn new() -> Self {
        Self {
            sun: DirectionalLight::new(-TOWARD_SUN),
            lamp: OmniLight {
                position_world: Vec3::new(0.1, 1.5, -0.1).as_dvec3(),
                range: 7.0,
            },
        }
    }
}

pub fn camera(size: [u32; 2]) -> Camera {
    Camera::new(
        Vec3::new(-2.6, 3.2, 5.6),
        Vec3::new(0.0, 0.6, 0.0),
        0.75,
        size,
    )
}
