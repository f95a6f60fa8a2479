//! Defines what is drawn: boxes and balls on a floor, three lights and a camera.

use std::error::Error;

use example_support::camera::Camera;
use example_support::mesh::{Instance, Mesh, copies_pipeline, cube, sphere};
use glam::{EulerRot, Mat4, Quat, Vec3};
use shadow_support::triangle::Triangle;
use wgpu_shadows::caster::{MeshCasterDescriptor, MeshIndices};
use wgpu_shadows::{DepthFormat, DirectionalLight, MeshCaster, OmniLight, SpotLight};

pub const TOWARD_SUN: Vec3 = Vec3::new(0.6, 1.0, 0.35);

/// Are the lights as the library takes them.
pub struct Lights {
    pub sun: DirectionalLight,
    pub spot: SpotLight,
    pub lamp: OmniLight,
}

/// Is one object: the index of its mesh, and how it is drawn.
pub struct Placed {
    pub mesh: usize,
    pub render_from_model: Mat4,
    pub albedo: Vec3,
}

pub struct Scene {
    pub meshes: [Mesh; 2],
    pub objects: Vec<Placed>,
    /// Are the indices of the objects that moved in this frame.
    pub moved: Vec<usize>,
}

impl Scene {
    pub fn new(device: &wgpu::Device) -> Self {
        let mut objects = vec![Placed {
            mesh: 0,
            render_from_model: Mat4::from_scale_rotation_translation(
                Vec3::new(9.0, 0.1, 9.0),
                Quat::IDENTITY,
                Vec3::new(0.0, -0.1, 0.0),
            ),
            albedo: Vec3::splat(0.75),
        }];
        for index in 0..24_u32 {
            let angle = index as f32 * 2.4;
            let radius = 0.9 + 0.27 * index as f32;
            let tilt = if index.is_multiple_of(3) { 0.5 } else { 0.0 };
            let height = 0.3 + 0.25 * (index % 4) as f32;
            objects.push(Placed {
                mesh: (index % 2) as usize,
                render_from_model: Mat4::from_scale_rotation_translation(
                    Vec3::new(0.28, height, 0.22),
                    Quat::from_euler(EulerRot::YXZ, angle, tilt, 0.0),
                    Vec3::new(radius * angle.cos(), height, radius * angle.sin()),
                ),
                albedo: Vec3::new(0.8, 0.35 + 0.02 * index as f32, 0.3),
            });
        }
        let mut scene = Self {
            meshes: [cube(), sphere(24)].map(|vertices| Mesh::new(device, &vertices)),
            objects,
            moved: Vec::new(),
        };
        scene.advance(0);
        scene
    }

    /// Moves one of the balls.
    pub fn advance(&mut self, frame: u32) {
        let angle = frame as f32 * 0.1;
        let place = Vec3::new(
            1.6 * angle.cos(),
            1.3 + 0.5 * (2.0 * angle).sin(),
            1.6 * angle.sin(),
        );
        let ball = Mat4::from_scale_rotation_translation(Vec3::splat(0.45), Quat::IDENTITY, place);
        self.moved.clear();
        if std::mem::replace(&mut self.objects[2].render_from_model, ball) != ball {
            self.moved.push(2);
        }
    }

    pub fn instance(&self, index: usize) -> Instance {
        Instance {
            render_from_model: self.objects[index].render_from_model,
            albedo: self.objects[index].albedo,
            checker: 0.0,
        }
    }

    pub fn casters(&self, device: &wgpu::Device) -> Result<Vec<MeshCaster>, Box<dyn Error>> {
        let pipeline = copies_pipeline(device, &[DepthFormat::Float32])?;
        let caster = |object: &Placed| {
            let mesh = &self.meshes[object.mesh];
            MeshCaster::new(
                device,
                &MeshCasterDescriptor {
                    label: Some("object"),
                    pipeline: &pipeline,
                    vertices: &mesh.vertices,
                    indices: MeshIndices::None {
                        vertices: 0..mesh.vertex_count,
                    },
                    bounds_model: mesh.bounds_model,
                    render_from_model: object.render_from_model,
                },
            )
        };
        Ok(self.objects.iter().map(caster).collect::<Result<_, _>>()?)
    }

    /// Returns all triangles, for rays.
    pub fn triangles(&self) -> Vec<Triangle> {
        let meshes = [cube(), sphere(24)];
        let of = |object: &Placed| {
            let place = object.render_from_model.as_dmat4();
            let corners = meshes[object.mesh].chunks_exact(3);
            let triangle = move |corners: &[example_support::mesh::Vertex]| {
                let corner =
                    |index: usize| place.transform_point3(corners[index].position.as_dvec3());
                Triangle([corner(0), corner(1), corner(2)])
            };
            corners.map(triangle).collect::<Vec<_>>()
        };
        self.objects.iter().flat_map(of).collect()
    }
}

impl Lights {
    pub fn new() -> Self {
        let spot = Vec3::new(-5.0, 5.0, 2.5);
        Self {
            sun: DirectionalLight::new(-TOWARD_SUN),
            spot: SpotLight {
                position_world: spot.as_dvec3(),
                direction: Vec3::new(-0.5, 0.0, 0.5) - spot,
                outer_angle_radians: 0.5,
                range: 14.0,
            },
            lamp: OmniLight {
                position_world: Vec3::new(0.3, 1.6, -0.4).as_dvec3(),
                range: 7.0,
            },
        }
    }
}

pub fn camera(size: [u32; 2]) -> Camera {
    Camera::new(
        Vec3::new(-4.5, 5.2, 7.5),
        Vec3::new(0.0, 0.2, 0.3),
        0.75,
        size,
    )
}
