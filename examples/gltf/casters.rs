//! The scene's `ShadowCaster`: one per instance, over shared buffers.

use wgpu_shadows::{
    Aabb, CasterPipeline, CasterPipelineDescriptor, CasterVertex, ModelTransform,
    PositionAttribute, Revision, ShadowCaster, ShadowView,
};

use crate::device::Gpu;
use crate::geometry::{Draw, Geometry, INSTANCE_LAYOUT, VERTEX_LAYOUT};
use crate::scene::{Scene, Vertex};

/// An instance of a mesh. The scene does not move, so its version never changes.
pub struct SceneCaster<'a> {
    geometry: &'a Geometry,
    draw: &'a Draw,
    bounds_render: Aabb,
    pipeline: CasterPipeline,
    /// Alpha-masked: its holes let light through.
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

    fn triangles(&self) -> u32 {
        self.draw.indices.len() as u32 / 3
    }

    fn revision(&self) -> Revision {
        Revision::new(self.draw.instance as u64, 0)
    }
}

/// One caster per instance. Both sides of every triangle cast.
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
    let (solid, masked) = (make(&solid)?, make(&masked)?);
    Ok(geometry
        .draws
        .iter()
        .map(|draw| {
            let has_holes = geometry.materials[draw.material].alpha_cutoff > 0.0;
            SceneCaster {
                geometry,
                draw,
                bounds_render: scene.instances[draw.instance].bounds_render,
                pipeline: if has_holes {
                    masked.clone()
                } else {
                    solid.clone()
                },
                masked: has_holes,
            }
        })
        .collect())
}
