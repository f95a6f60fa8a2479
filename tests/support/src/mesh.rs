//! Generates triangle meshes, as casters for the library and as triangles in f64 for the truth.

use glam::{Mat3, Mat4, Vec3};
use wgpu_shadows::{
    Aabb, CasterPipeline, MeshCaster, caster::CasterPipelineDescriptor, caster::CasterVertex,
    caster::MeshCasterDescriptor, caster::MeshIndices, caster::ModelTransform,
    caster::PositionAttribute,
};

use crate::gpu::Gpu;
use crate::triangle::Triangle;

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
                let takes_max = [0, 1, 2].map(|axis| corner >> axis & 1 == 1);
                Vec3::select(glam::BVec3::from_array(takes_max), max, min)
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

    /// Returns a closed box that stands at `foot` (the middle of its lower face) and is rotated
    /// about its upright axis.
    pub fn standing_box(foot: Vec3, size: Vec3, turn_radians: f32) -> Self {
        let half = Vec3::new(size.x * 0.5, 0.0, size.z * 0.5);
        let mut mesh = Self::cuboid(-half, half.with_y(size.y));
        let turned = Mat3::from_rotation_y(turn_radians);
        for position in &mut mesh.positions {
            *position = turned * *position + foot;
        }
        mesh
    }

    /// Returns a closed rod of `sides` sides between two positions.
    pub fn rod(from: Vec3, to: Vec3, radius: f32, sides: u32) -> Self {
        let (across, along) = (to - from).normalize().any_orthonormal_pair();
        let mut mesh = Self::default();
        for end in [from, to] {
            for side in 0..sides {
                let angle = std::f32::consts::TAU * side as f32 / sides as f32;
                let out = across * angle.cos() + along * angle.sin();
                mesh.positions.push(end + out * radius);
            }
        }
        for side in 0..sides {
            let next = (side + 1) % sides;
            let (a, b, c, d) = (side, next, next + sides, side + sides);
            mesh.indices.extend([a, b, c, a, c, d]);
            if side > 0 && side + 1 < sides {
                mesh.indices.extend([0, next, side, sides, d, c]);
            }
        }
        mesh
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

    /// Returns a closed sphere of `rings` by `2 * rings` patches, with its corners on the true
    /// sphere.
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

    /// Returns the surface `y = height(x, z)` over a square from `-half` to `half`, in `cells` by
    /// `cells` squares.
    pub fn terrain(half: f32, cells: u32, height: impl Fn(f32, f32) -> f32) -> Self {
        let mut mesh = Self::default();
        let place = |index: u32| 2.0 * half * index as f32 / cells as f32 - half;
        for row in 0..=cells {
            for column in 0..=cells {
                let (x, z) = (place(column), place(row));
                mesh.positions.push(Vec3::new(x, height(x, z), z));
            }
        }
        for row in 0..cells {
            for column in 0..cells {
                let here = row * (cells + 1) + column;
                let below = here + cells + 1;
                mesh.indices
                    .extend([here, below, below + 1, here, below + 1, here + 1]);
            }
        }
        mesh
    }

    /// Returns this mesh and another as one.
    pub fn joined(mut self, other: Self) -> Self {
        let first = self.positions.len() as u32;
        self.positions.extend(other.positions);
        self.indices
            .extend(other.indices.iter().map(|index| first + index));
        self
    }

    pub fn bounds(&self) -> Aabb {
        Aabb::from_points(self.positions.iter().copied())
    }

    /// Returns the triangles in render space; under the identity, exactly as the device gets them.
    pub fn triangles(&self, render_from_model: &Mat4) -> Vec<Triangle> {
        let matrix = render_from_model.as_dmat4();
        let corner =
            |&index: &u32| matrix.transform_point3(self.positions[index as usize].as_dvec3());
        self.indices
            .chunks(3)
            .map(|triangle| Triangle([0, 1, 2].map(|k| corner(&triangle[k]))))
            .collect()
    }

    /// Creates a caster of this mesh, for pipelines with positions of 12 bytes.
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

/// Creates the pipeline of casters whose positions, of 12 bytes, are in render space already.
pub fn render_space_pipeline(gpu: &Gpu) -> CasterPipeline {
    let descriptor = CasterPipelineDescriptor {
        vertex: CasterVertex::BuiltIn {
            position: PositionAttribute::float32x3(12),
            model: ModelTransform::Identity,
        },
        ..Default::default()
    };
    CasterPipeline::new(&gpu.device, &descriptor).expect("a valid pipeline")
}
