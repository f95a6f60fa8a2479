//! Faces `wgpu-shadows`: a sun and a lamp, rigid casters, and casters that a skin moves.

use std::error::Error;

use wgpu_shadows::{caster::CasterPipelineDescriptor, caster::CasterVertex, glam::DVec3, *};

use crate::engine::{Actor, SKIN_BUFFERS, SKIN_WGSL};
use crate::scene::{Lights, Scene};

/// Is an actor, which its joints move in the vertex stage.
struct SkinnedCaster<'a> {
    actor: &'a Actor,
    pipeline: &'a CasterPipeline,
}

impl ShadowCaster for SkinnedCaster<'_> {
    fn bounds(&self) -> Aabb {
        self.actor.pose.bounds_render
    }

    fn pipeline(&self) -> &CasterPipeline {
        self.pipeline
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, _view: &ShadowView) {
        pass.set_bind_group(1, &self.actor.group, &[]);
        pass.set_vertex_buffer(0, self.actor.vertices.slice(..));
        pass.set_index_buffer(self.actor.indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..self.actor.index_count, 0, 0..1);
    }

    fn revision(&self) -> Option<Revision> {
        Some(Revision::new(self.actor.id, self.actor.pose_version))
    }

    fn triangles(&self) -> u32 {
        self.actor.index_count / 3
    }

    fn keeps_pass_state(&self) -> bool {
        true
    }
}

/// Owns the lights' shadows, the pipeline of skinned casters, and the rigid casters.
pub struct Shadows {
    scene: ShadowScene,
    skinned: CasterPipeline,
    rigid: Vec<MeshCaster>,
    sun: DirectionalShadow,
    lamp: OmniShadow,
    pub bindings: ShadowBindings,
}

impl Shadows {
    pub fn new(
        device: &wgpu::Device,
        scene: &Scene,
        pose_layout: &wgpu::BindGroupLayout,
    ) -> Result<Self, Box<dyn Error>> {
        let sun = DirectionalShadow::new(device, &Default::default())?;
        let lamp = OmniShadow::new(device, &Default::default())?;
        let skinned = CasterPipelineDescriptor {
            label: Some("skinned caster"),
            vertex: CasterVertex::Wgsl {
                source: &[SKIN_WGSL, include_str!("caster.wgsl")].concat(),
                vertex_entry: "skinned_caster",
                fragment_entry: None,
                buffers: &[Some(SKIN_BUFFERS)],
                bind_group_layouts: &[Some(pose_layout)],
            },
            ..Default::default()
        };
        let lights = [("sun", sun.maps()), ("lamp", lamp.maps())];
        Ok(Self {
            bindings: ShadowBindings::new(
                device,
                &ShadowBindingsDescriptor {
                    group: 2,
                    lights: &lights,
                    ..Default::default()
                },
            )?,
            skinned: CasterPipeline::new(device, &skinned)?,
            rigid: scene.rigid_casters(device)?,
            scene: ShadowScene::new(),
            sun,
            lamp,
        })
    }

    /// Records what changed since the last frame.
    pub fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        actors: &[Actor],
        camera: CameraView,
        lights: &Lights,
    ) -> Result<(), Box<dyn Error>> {
        let pipeline = &self.skinned;
        let skinned = actors.iter().map(|actor| SkinnedCaster { actor, pipeline });
        let skinned: Vec<_> = skinned.collect();
        let mut casters: Vec<&dyn ShadowCaster> = self.rigid.iter().map(|c| c as _).collect();
        casters.extend(skinned.iter().map(|caster| caster as &dyn ShadowCaster));
        let frame = self.scene.frame(&ShadowFrameDescriptor {
            origin: DVec3::ZERO,
            coverage: Coverage::Cameras(&[camera]),
            casters: Casters::List(&casters),
            receivers: &[],
        })?;
        self.sun.record(encoder, &frame, &lights.sun)?;
        self.lamp.record(encoder, &frame, &lights.lamp)?;
        Ok(())
    }

    /// Makes the next frame draw everything.
    pub fn invalidate(&mut self) {
        self.sun.invalidate();
        self.lamp.invalidate();
    }

    /// Returns the passes of the last frame and the bytes of all maps.
    pub fn totals(&self) -> (u32, u64) {
        let reports = [self.sun.maps(), self.lamp.maps()].map(ShadowMaps::report);
        (
            reports.iter().map(|report| report.passes).sum(),
            reports.iter().map(|report| report.bytes_held).sum(),
        )
    }
}
