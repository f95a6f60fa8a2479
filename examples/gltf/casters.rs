//! Implements the scene's `ShadowCaster`: one per instance, over shared buffers.

use example_support::gltf_file::scene::{Mesh, Scene, Vertex};
use glam::Vec3;
use shadow_support::gpu::Gpu;
use wgpu_shadows::{
    Aabb, CasterPipeline, Revision, ShadowCaster, ShadowView, caster::CasterPipelineDescriptor,
    caster::CasterShape, caster::CasterVertex, caster::ModelTransform, caster::PositionAttribute,
    caster::caster_shape, caster::is_closed_solid,
};

use crate::geometry::{Draw, Geometry, INSTANCE_LAYOUT, VERTEX_LAYOUT};

/// Is an instance of a mesh. The scene does not move, so its version never changes.
pub struct SceneCaster<'a> {
    geometry: &'a Geometry,
    draw: &'a Draw,
    bounds_render: Aabb,
    shape_render: CasterShape,
    pipeline: CasterPipeline,
    /// States that it is alpha-masked: its holes let light through.
    masked: bool,
}

impl ShadowCaster for SceneCaster<'_> {
    fn bounds(&self) -> Aabb {
        self.bounds_render
    }

    fn pipeline(&self) -> &CasterPipeline {
        &self.pipeline
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, _view: &ShadowView) {
        if self.masked {
            pass.set_bind_group(1, &self.geometry.material_groups[self.draw.material], &[]);
        }
        self.geometry.draw(pass, self.draw);
    }

    fn shape(&self) -> CasterShape {
        self.shape_render
    }

    fn keeps_pass_state(&self) -> bool {
        true
    }

    fn triangles(&self) -> u32 {
        self.draw.indices.len() as u32 / 3
    }

    fn revision(&self) -> Option<Revision> {
        Some(Revision::new(self.draw.instance as u64, 0))
    }
}

/// Returns one caster per instance. Both sides of every triangle cast, except for closed solids,
/// whose back faces are never the first that the light meets.
pub fn scene_casters<'a>(
    gpu: &Gpu,
    scene: &Scene,
    geometry: &'a Geometry,
) -> Result<Vec<SceneCaster<'a>>, String> {
    let solid = CasterPipelineDescriptor {
        label: Some("solid caster"),
        vertex: CasterVertex::BuiltIn {
            position: PositionAttribute::float32x3(size_of::<Vertex>() as u64),
            model: ModelTransform::INSTANCE_MATRIX,
        },
        ..Default::default()
    };
    let closed = CasterPipelineDescriptor {
        label: Some("closed caster"),
        primitive: wgpu::PrimitiveState {
            cull_mode: Some(wgpu::Face::Back),
            ..Default::default()
        },
        ..solid
    };
    let masked = CasterPipelineDescriptor {
        label: Some("masked caster"),
        vertex: CasterVertex::Wgsl {
            source: include_str!("caster_masked.wgsl"),
            vertex_entry: "leaf_vertex",
            fragment_entry: Some("leaf_fragment"),
            buffers: &[Some(VERTEX_LAYOUT), Some(INSTANCE_LAYOUT)],
            bind_group_layouts: &[Some(&geometry.material_layout)],
        },
        ..Default::default()
    };
    let make = |descriptor| {
        CasterPipeline::new(&gpu.device, descriptor).map_err(|error| error.to_string())
    };
    let (solid, closed, masked) = (make(&solid)?, make(&closed)?, make(&masked)?);
    let closed_mirrored = closed.mirrored();
    let is_closed: Vec<bool> = scene.meshes.iter().map(is_closed_mesh).collect();
    let shapes: Vec<CasterShape> = scene.meshes.iter().map(mesh_shape).collect();
    Ok(geometry
        .draws
        .iter()
        .map(|draw| {
            let has_holes = geometry.materials[draw.material].alpha_cutoff > 0.0;
            let instance = &scene.instances[draw.instance];
            SceneCaster {
                geometry,
                draw,
                bounds_render: instance.bounds_render,
                shape_render: shapes[instance.mesh].transformed(&instance.render_from_model),
                pipeline: match (has_holes, is_closed[instance.mesh], draw.mirrored) {
                    (true, ..) => &masked,
                    (false, false, _) => &solid,
                    (false, true, false) => &closed,
                    (false, true, true) => &closed_mirrored,
                }
                .clone(),
                masked: has_holes,
            }
        })
        .collect())
}

fn is_closed_mesh(mesh: &Mesh) -> bool {
    is_closed_solid(&positions(mesh), &mesh.indices)
}

fn mesh_shape(mesh: &Mesh) -> CasterShape {
    caster_shape(&positions(mesh), &mesh.indices)
}

fn positions(mesh: &Mesh) -> Vec<Vec3> {
    let vertices = mesh.vertices.iter();
    vertices.map(|vertex| vertex.position.into()).collect()
}
