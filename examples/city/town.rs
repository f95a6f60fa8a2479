//! Generates streets in a grid, blocks between them, and everything on them in one instance buffer.

use std::ops::Range;

use example_support::mesh::{Instance, Mesh, Vertex, cube, sphere, vertex_buffer};
use example_support::phong::Batch;
use glam::{Mat4, Vec2, Vec3};
use shadow_support::random::Random;
use wgpu_shadows::{
    Aabb, CasterPipeline, InstancedMeshCaster, caster::CasterPipelineDescriptor,
    caster::CasterVertex, caster::InstancedMeshCasterDescriptor, caster::MeshIndices,
    caster::ModelTransform, caster::PositionAttribute, error::CasterError,
};

use crate::plot::{self, BLOCK_SIDE, Part, Shape};

/// Is the distance from the middle of one street to the middle of the next.
pub const STREET_SPACING: f32 = BLOCK_SIDE + 14.0;

/// Is the number of blocks along each side of the town.
const BLOCKS: i32 = 18;

/// Is the height of the kerbs.
const KERB: f32 = 0.15;

/// Holds the town. Streets run along x and z; one of each passes through the middle.
pub struct Town {
    /// Holds all buildings: the boxes, and the domes.
    pub casters: [InstancedMeshCaster; 2],
    /// Bounds what only receives: streets and pavements.
    pub ground: Aabb,
    box_mesh: Mesh,
    dome_mesh: Mesh,
    instances: wgpu::Buffer,
    /// Is the index of the first dome. The instances are, in order: ground and pavements, buildings
    /// that are boxes, domes.
    first_dome: u32,
    instance_count: u32,
}

impl Town {
    pub fn new(device: &wgpu::Device) -> Result<Self, CasterError> {
        let mut random = Random::new(5);
        let mut pavements = vec![street()];
        let (mut boxes, mut domes) = (Vec::new(), Vec::new());
        for (column, row) in (0..BLOCKS).flat_map(|x| (0..BLOCKS).map(move |z| (x, z))) {
            let cell = Vec2::new(column as f32, row as f32) + 0.5 - BLOCKS as f32 * 0.5;
            let center = cell * STREET_SPACING;
            let half = Vec2::splat(BLOCK_SIDE * 0.5);
            let slab = Vec3::new(0.46, 0.45, 0.43);
            pavements.push(plot::upright(center, half, 0.0, KERB, slab));
            // Buildings are higher toward the middle.
            let eaves = 9.0 + 16.0 * (-cell.length_squared() / 30.0).exp();
            for part in plot::block(&mut random, center, eaves) {
                match part.shape {
                    Shape::Box => boxes.push(part),
                    Shape::Dome => domes.push(part),
                }
            }
        }
        let first_building = pavements.len() as u32;
        let first_dome = first_building + boxes.len() as u32;
        let parts: Vec<Part> = pavements.into_iter().chain(boxes).chain(domes).collect();
        let instances: Vec<Instance> = parts.iter().map(|part| part.instance).collect();
        let instances = vertex_buffer(device, &instances);
        let box_mesh = Mesh::new(device, &cube());
        let dome_mesh = Mesh::new(device, &sphere(24));
        let pipeline = caster_pipeline(device)?;
        let casters = |mesh, range: Range<u32>| {
            let parts = &parts[range.start as usize..range.end as usize];
            copies(device, &pipeline, mesh, parts)
        };
        let instance_count = parts.len() as u32;
        let casters = [
            casters(&box_mesh, first_building..first_dome)?,
            casters(&dome_mesh, first_dome..instance_count)?,
        ];
        Ok(Self {
            casters,
            ground: ground(),
            box_mesh,
            dome_mesh,
            instances,
            first_dome,
            instance_count,
        })
    }

    /// Returns all of the town in two draws.
    pub fn batches(&self) -> [Batch<'_>; 2] {
        let batch = |mesh, range| Batch {
            mesh,
            instances: &self.instances,
            range,
        };
        [
            batch(&self.box_mesh, 0..self.first_dome),
            batch(&self.dome_mesh, self.first_dome..self.instance_count),
        ]
    }
}

/// Returns the bounds of streets and pavements.
fn ground() -> Aabb {
    let reach = BLOCKS as f32 * 0.5 * STREET_SPACING;
    Aabb::new(
        Vec3::new(-reach, 0.0, -reach),
        Vec3::new(reach, KERB, reach),
    )
}

/// Returns one slab of asphalt under everything.
fn street() -> Part {
    let half = ground().max.x;
    let asphalt = Vec3::new(0.20, 0.20, 0.21);
    plot::upright(Vec2::ZERO, Vec2::splat(half), -1.0, 0.0, asphalt)
}

/// Makes one caster of many buildings, each of which is culled by itself.
fn copies(
    device: &wgpu::Device,
    pipeline: &CasterPipeline,
    mesh: &Mesh,
    parts: &[Part],
) -> Result<InstancedMeshCaster, CasterError> {
    let transforms = parts.iter().map(|part| part.instance.render_from_model);
    let transforms: Vec<Mat4> = transforms.collect();
    let descriptor = InstancedMeshCasterDescriptor {
        label: Some("buildings"),
        pipeline,
        vertices: &mesh.vertices,
        indices: MeshIndices::None {
            vertices: 0..mesh.vertex_count,
        },
        bounds_model: mesh.bounds_model,
        render_from_model: &transforms,
    };
    InstancedMeshCaster::new(device, &descriptor)
}

fn caster_pipeline(device: &wgpu::Device) -> Result<CasterPipeline, CasterError> {
    CasterPipeline::new(
        device,
        &CasterPipelineDescriptor {
            label: Some("building"),
            vertex: CasterVertex::BuiltIn {
                position: PositionAttribute::float32x3(size_of::<Vertex>() as u64),
                model: ModelTransform::INSTANCE_MATRIX,
            },
            ..Default::default()
        },
    )
}
