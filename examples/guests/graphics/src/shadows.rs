//! Faces `wgpu-shadows`: a pool of all lights of the engine's scene, and a caster for each entity.

use graphics::wgpu::{self, util::DeviceExt};
use graphics::{Entity, MeshExtension, Scene};
use lin_alg::f32::{Mat4, Vec3};
use wgpu_shadows::{caster::*, glam, pool::*, *};

/// Is the number of lights that may have shadows. The others light everything.
const LIGHTS: u32 = 8;

/// Is WGSL that the engine's shader calls for each light.
const VISIBILITY: &str = "
fn light_visibility(light: i32, position: vec3<f32>, toward_viewer: vec3<f32>) -> f32 {
    return shadow_lamps(u32(light), position, shadow_geometric_normal(position, toward_viewer));
}
";

pub struct Shadows {
    device: wgpu::Device,
    scene: ShadowScene,
    pipeline: CasterPipeline,
    casters: Vec<MeshCaster>,
    lamps: OmniShadowPool,
    slots: Vec<ShadowSlot>,
    bindings: ShadowBindings,
    wgsl: String,
}

/// Makes the engine's extension.
pub fn make(device: &wgpu::Device) -> Box<dyn MeshExtension> {
    let pool = PoolDescriptor {
        capacity: LIGHTS,
        ..Default::default()
    };
    let mut lamps = OmniShadowPool::new(device, &pool).expect("a device for the pool");
    let slots = (0..LIGHTS).map(|_| lamps.insert().expect("a free slot"));
    let slots = slots.collect();
    let descriptor = ShadowBindingsDescriptor {
        group: 2,
        lights: &[("lamps", lamps.maps())],
        ..Default::default()
    };
    let bindings = ShadowBindings::new(device, &descriptor).expect("a free bind group");
    let pipeline = CasterPipeline::new(device, &Default::default()).expect("a pipeline");
    Box::new(Shadows {
        device: device.clone(),
        scene: ShadowScene::new(),
        pipeline,
        casters: Vec::new(),
        wgsl: bindings.wgsl().to_owned() + VISIBILITY,
        lamps,
        slots,
        bindings,
    })
}

impl MeshExtension for Shadows {
    fn wgsl(&self) -> &str {
        &self.wgsl
    }

    fn bind_group_layout(&self) -> &wgpu::BindGroupLayout {
        self.bindings.layout()
    }

    fn bind_group(&self) -> &wgpu::BindGroup {
        self.bindings.bind_group()
    }

    fn prepare(&mut self, encoder: &mut wgpu::CommandEncoder, scene: &Scene) {
        if let Err(error) = self.record(encoder, scene) {
            eprintln!("no new shadows: {error}");
        }
    }
}

impl Shadows {
    fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        scene: &Scene,
    ) -> Result<(), Box<dyn std::error::Error>> {
        if self.casters.len() != scene.entities.len() {
            self.casters = self.casters_of(scene)?;
        }
        for (caster, entity) in self.casters.iter_mut().zip(&scene.entities) {
            caster.set_transform(matrix(&world_from_model(entity)))?;
        }
        let casters: Vec<&dyn ShadowCaster> = self.casters.iter().map(|c| c as _).collect();
        let view = matrix(&scene.camera.view_mat());
        let camera = CameraView::new(view, matrix(&scene.camera.proj_mat));
        let frame = self.scene.frame(&ShadowFrameDescriptor {
            origin: glam::DVec3::ZERO,
            coverage: Coverage::Cameras(&[camera]),
            casters: Casters::List(&casters),
            receivers: &[],
        })?;
        let lights = scene.lighting.point_lights.iter().zip(&self.slots);
        let lights = lights.map(|(light, &slot)| PoolLight {
            slot,
            light: OmniLight {
                position_world: vector(light.position).as_dvec3(),
                range: f32::INFINITY,
            },
            importance: 1.0,
        });
        let lights: Vec<_> = lights.collect();
        self.lamps.record(encoder, &frame, &lights, None)?;
        Ok(())
    }

    /// Returns a caster for each entity; those of one mesh share its buffers.
    fn casters_of(&self, scene: &Scene) -> Result<Vec<MeshCaster>, error::CasterError> {
        let buffer = |contents: &[u8], usage| {
            let label = Some("caster mesh");
            let descriptor = wgpu::util::BufferInitDescriptor {
                label,
                contents,
                usage,
            };
            self.device.create_buffer_init(&descriptor)
        };
        let meshes = scene.meshes.iter().map(|mesh| {
            let positions = mesh.vertices.iter().flat_map(|vertex| vertex.position);
            let positions: Vec<u8> = positions.flat_map(f32::to_ne_bytes).collect();
            let indices = mesh.indices.iter().map(|&index| index as u32);
            let indices: Vec<u8> = indices.flat_map(u32::to_ne_bytes).collect();
            let corners = mesh.vertices.iter().map(|vertex| vertex.position.into());
            (
                buffer(&positions, wgpu::BufferUsages::VERTEX),
                buffer(&indices, wgpu::BufferUsages::INDEX),
                Aabb::from_points(corners),
            )
        });
        let meshes: Vec<_> = meshes.collect();
        let casters = scene.entities.iter().map(|entity| {
            let (vertices, indices, bounds_model) = &meshes[entity.mesh];
            MeshCaster::new(
                &self.device,
                &MeshCasterDescriptor {
                    label: None,
                    pipeline: &self.pipeline,
                    vertices,
                    indices: MeshIndices::Buffer {
                        buffer: indices.clone(),
                        format: wgpu::IndexFormat::Uint32,
                        indices: 0..scene.meshes[entity.mesh].indices.len() as u32,
                        base_vertex: 0,
                    },
                    bounds_model: *bounds_model,
                    render_from_model: matrix(&world_from_model(entity)),
                },
            )
        });
        casters.collect()
    }
}

/// Returns the matrix with which the engine draws an entity.
fn world_from_model(entity: &Entity) -> Mat4 {
    let scale = entity.scale;
    let scale = entity
        .scale_partial
        .unwrap_or(Vec3::new(scale, scale, scale));
    let pivot = entity.pivot.unwrap_or(Vec3::new_zero());
    Mat4::new_translation(entity.position)
        * Mat4::new_translation(pivot)
        * entity.orientation.to_matrix()
        * Mat4::new_translation(-pivot)
        * Mat4::new_scaler_partial(scale)
}

fn matrix(matrix: &Mat4) -> glam::Mat4 {
    glam::Mat4::from_cols_array(&matrix.data)
}

fn vector(vector: Vec3) -> glam::Vec3 {
    glam::Vec3::new(vector.x, vector.y, vector.z)
}
