//! Provides small generated meshes, as casters for the library and as triangles in f64 for the truth.

use glam::{DVec3, Mat4, Vec3};
use wgpu_shadows::{
    Aabb, CasterPipeline, DepthFormat, MeshCaster, ShadowCaster, caster::CasterPipelineDescriptor,
    caster::MeshCasterDescriptor, caster::MeshIndices,
};

use crate::support::gpu::Gpu;

/// Is an indexed triangle list; outward faces are counter-clockwise.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    pub positions: Vec<Vec3>,
    pub indices: Vec<u32>,
}

impl Mesh {
    /// Returns a closed box.
    pub fn cuboid(min: Vec3, max: Vec3) -> Self {
        let positions = (0..8)
            .map(|corner| {
                let pick = |axis: usize| {
                    if corner >> axis & 1 == 1 {
                        max[axis]
                    } else {
                        min[axis]
                    }
                };
                Vec3::new(pick(0), pick(1), pick(2))
            })
            .collect();
        // Each row lists the four corners of a face, counter-clockwise from outside.
        let faces: [[u32; 4]; 6] = [
            [0, 4, 6, 2],
            [1, 3, 7, 5],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 2, 3, 1],
            [4, 5, 7, 6],
        ];
        let indices = faces
            .iter()
            .flat_map(|&[a, b, c, d]| [a, b, c, a, c, d])
            .collect();
        Self { positions, indices }
    }

    /// Returns a flat sheet of two triangles that faces `u × v`.
    pub fn sheet(corner: Vec3, u: Vec3, v: Vec3) -> Self {
        Self {
            positions: vec![corner, corner + u, corner + u + v, corner + v],
            indices: vec![0, 1, 2, 0, 2, 3],
        }
    }

    /// Returns a level square floor at height `y` that extends `half` from the middle and faces up.
    pub fn floor(y: f32, half: f32) -> Self {
        Self::sheet(
            Vec3::new(-half, y, -half),
            Vec3::new(0.0, 0.0, 2.0 * half),
            Vec3::new(2.0 * half, 0.0, 0.0),
        )
    }

    /// Returns a closed sphere of `rings` by `2 * rings` patches.
    pub fn sphere(center: Vec3, radius: f32, rings: u32) -> Self {
        let columns = 2 * rings;
        let mut mesh = Self::default();
        for ring in 0..=rings {
            let latitude = std::f32::consts::PI * ring as f32 / rings as f32;
            for column in 0..=columns {
                let longitude = std::f32::consts::TAU * column as f32 / columns as f32;
                let unit = Vec3::new(
                    latitude.sin() * longitude.cos(),
                    latitude.cos(),
                    latitude.sin() * longitude.sin(),
                );
                mesh.positions.push(center + radius * unit);
            }
        }
        for ring in 0..rings {
            for column in 0..columns {
                let here = ring * (columns + 1) + column;
                let below = here + columns + 1;
                // At the poles one of the two triangles has no area, hence no normal.
                if ring > 0 {
                    mesh.indices.extend([here, here + 1, below + 1]);
                }
                if ring + 1 < rings {
                    mesh.indices.extend([here, below + 1, below]);
                }
            }
        }
        mesh
    }

    pub fn bounds(&self) -> Aabb {
        Aabb::from_points(self.positions.iter().copied())
    }

    /// Returns the triangles in render space.
    pub fn triangles(&self, render_from_model: &Mat4) -> Vec<Triangle> {
        let matrix = render_from_model.as_dmat4();
        let corner =
            |&index: &u32| matrix.transform_point3(self.positions[index as usize].as_dvec3());
        self.indices
            .chunks(3)
            .map(|triangle| Triangle([0, 1, 2].map(|k| corner(&triangle[k]))))
            .collect()
    }

    /// Creates a caster of this mesh.
    pub fn caster(&self, gpu: &Gpu, pipeline: &CasterPipeline, transform: Mat4) -> MeshCaster {
        MeshCaster::new(
            &gpu.device,
            &MeshCasterDescriptor {
                label: None,
                pipeline,
                vertices: &gpu.buffer(&self.positions, wgpu::BufferUsages::VERTEX),
                indices: MeshIndices::Buffer {
                    buffer: gpu.buffer(&self.indices, wgpu::BufferUsages::INDEX),
                    format: wgpu::IndexFormat::Uint32,
                    indices: 0..self.indices.len() as u32,
                    base_vertex: 0,
                },
                bounds_model: self.bounds(),
                render_from_model: transform,
            },
        )
        .expect("a valid mesh")
    }
}

/// Holds casters of the default pipeline, and the triangles of which they consist.
pub struct Scene {
    pub casters: Vec<MeshCaster>,
    pub triangles: Vec<Triangle>,
}

impl Scene {
    pub fn new(gpu: &Gpu, meshes: &[Mesh]) -> Self {
        let pipeline = default_pipeline(gpu);
        Self {
            casters: meshes
                .iter()
                .map(|mesh| mesh.caster(gpu, &pipeline, Mat4::IDENTITY))
                .collect(),
            triangles: meshes
                .iter()
                .flat_map(|mesh| mesh.triangles(&Mat4::IDENTITY))
                .collect(),
        }
    }

    pub fn list(&self) -> Vec<&dyn ShadowCaster> {
        self.casters
            .iter()
            .map(|caster| caster as &dyn ShadowCaster)
            .collect()
    }
}

/// Creates the default pipeline, for maps of both depth formats.
pub fn default_pipeline(gpu: &Gpu) -> CasterPipeline {
    let descriptor = CasterPipelineDescriptor {
        depth_formats: &[DepthFormat::Float32, DepthFormat::Unorm16],
        ..CasterPipelineDescriptor::new()
    };
    CasterPipeline::new(&gpu.device, &descriptor).expect("a valid pipeline")
}

/// Is a triangle in render space, in f64.
#[derive(Clone, Copy, Debug)]
pub struct Triangle(pub [DVec3; 3]);

impl Triangle {
    pub fn normal(&self) -> DVec3 {
        let [a, b, c] = self.0;
        (b - a).cross(c - a).normalize()
    }

    /// Returns the point with barycentric coordinates made from two numbers in 0..1, evenly spread.
    pub fn point(&self, s: f64, t: f64) -> DVec3 {
        let [a, b, c] = self.0;
        let root = s.sqrt();
        a * (1.0 - root) + b * (root * (1.0 - t)) + c * (root * t)
    }

    /// Returns the distance along a ray at which it hits the triangle, from either side (Möller and Trumbore 1997).
    pub fn hit(&self, from: DVec3, direction: DVec3) -> Option<f64> {
        let [a, b, c] = self.0;
        let (edge_b, edge_c) = (b - a, c - a);
        let across = direction.cross(edge_c);
        let determinant = edge_b.dot(across);
        if determinant == 0.0 {
            return None;
        }
        let to_start = from - a;
        let s = to_start.dot(across) / determinant;
        let turned = to_start.cross(edge_b);
        let t = direction.dot(turned) / determinant;
        (s >= 0.0 && t >= 0.0 && s + t <= 1.0).then(|| edge_c.dot(turned) / determinant)
    }
}

/// Returns the truth: whether anything lies between `point` and the light, farther than `skip` along the ray.
pub fn occluded(triangles: &[Triangle], point: DVec3, toward_light: DVec3, skip: f64) -> bool {
    triangles
        .iter()
        .any(|triangle| triangle.hit(point, toward_light).is_some_and(|t| t > skip))
}
