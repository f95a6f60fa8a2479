//! Six faces of a cube in one pass, on devices that draw several views at once.
//!
//! The pass draws every caster into every face, where six passes draw each caster only into the faces that it touches. It is
//! the cheaper one where most casters touch most faces anyway, as the walls of a room around a lamp do.

use bytemuck::Zeroable;

use crate::ShadowError;
use crate::cast::pipeline_build::six_views_layout;
use crate::cast::recorder::{CasterViewUniform, FACE_COUNT, VIEW_UNIFORM_BYTES, ViewDraws};
use crate::cast::upload::{PendingUpload, UploadBuffer};
use crate::cast::{CasterPipeline, ShadowCaster};

/// Draw calls of the six passes, as a share of six times the casters, from which on the one pass is taken: at one half it
/// shades at most twice the vertices, for a third of the draw calls or fewer.
const LEAST_SHARE: f64 = 0.5;

/// Uniforms of six views for one pass.
#[derive(Debug)]
pub(crate) struct CubePass {
    faces: UploadBuffer,
    bind_group: wgpu::BindGroup,
    /// Scratch: is the caster in any face?
    touched: Vec<bool>,
}

impl CubePass {
    /// None where the device does not draw six views at once, or gains nothing by it.
    pub fn new(device: &wgpu::Device, label: &str) -> Result<Option<Self>, ShadowError> {
        let able = device.features().contains(wgpu::Features::MULTIVIEW)
            && device.limits().max_multiview_view_count >= FACE_COUNT;
        // A software rasteriser has no draw calls to save, and Mesa's llvmpipe (seen in 22.3.6) draws triangles that it clips
        // into the wrong view.
        let hardware = device.adapter_info().device_type != wgpu::DeviceType::Cpu;
        if able && hardware {
            Self::create(device, label).map(Some)
        } else {
            Ok(None)
        }
    }

    fn create(device: &wgpu::Device, label: &str) -> Result<Self, ShadowError> {
        let label = format!("{label} caster faces");
        let bytes = VIEW_UNIFORM_BYTES * u64::from(FACE_COUNT);
        let faces = UploadBuffer::new(device, &label, bytes)?;
        let bind_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(&label),
            layout: &six_views_layout(device),
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: faces.buffer().as_entire_binding(),
            }],
        });
        Ok(Self {
            faces,
            bind_group,
            touched: Vec::new(),
        })
    }

    /// Stages the uniforms of `views`.
    pub fn prepare(
        &self,
        device: &wgpu::Device,
        views: &[ViewDraws],
    ) -> Result<Option<PendingUpload>, ShadowError> {
        // A face without a view keeps nothing: its depth is beyond the clip volume.
        let mut nowhere = CasterViewUniform::zeroed();
        nowhere.clip_from_anchor[3] = [0.0, 0.0, -1.0, 1.0];
        let mut uniforms = [nowhere; FACE_COUNT as usize];
        for draws in views {
            uniforms[draws.view.layer() as usize] = CasterViewUniform::of(&draws.view);
        }
        self.faces.prepare(device, bytemuck::cast_slice(&uniforms))
    }

    pub fn commit(&mut self, encoder: &mut wgpu::CommandEncoder, pending: Option<PendingUpload>) {
        self.faces.commit(encoder, pending);
    }

    pub fn invalidate(&mut self) {
        self.faces.invalidate();
    }

    /// Is one pass the cheaper way to draw these views, and can it?
    pub fn is_worth_it(
        &mut self,
        device: &wgpu::Device,
        views: &[ViewDraws],
        casters: &[&dyn ShadowCaster],
    ) -> bool {
        if !views.iter().all(|draws| draws.drawn) {
            return false;
        }
        self.touched.clear();
        self.touched.resize(casters.len(), false);
        let mut draw_calls = 0;
        for &caster in views.iter().flat_map(|draws| &draws.casters) {
            draw_calls += 1;
            self.touched[caster as usize] = true;
        }
        let touched = self.touched.iter().filter(|touched| **touched).count();
        let enough = f64::from(draw_calls) >= LEAST_SHARE * f64::from(FACE_COUNT) * touched as f64;
        enough
            && touched > 0
            && self
                .touched_casters(casters)
                .all(|caster| caster.pipeline().six_views(device).is_some())
    }

    /// Draws into the six layers of `faces` at once.
    pub fn draw(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        label: &str,
        faces: &wgpu::TextureView,
        first: &ViewDraws,
        casters: &[&dyn ShadowCaster],
    ) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(&format!("{label} six faces")),
            color_attachments: &[],
            depth_stencil_attachment: Some(super::depth_attachment(faces)),
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: std::num::NonZeroU32::new((1 << FACE_COUNT) - 1),
        });
        pass.set_bind_group(0, &self.bind_group, &[]);
        let mut current: Option<&CasterPipeline> = None;
        for caster in self.touched_casters(casters) {
            let pipeline = caster.pipeline();
            if current != Some(pipeline) {
                let Some(six_views) = pipeline.six_views(device) else {
                    continue;
                };
                pass.set_pipeline(six_views);
                current = Some(pipeline);
            }
            caster.draw(&mut pass, &first.view);
        }
    }

    fn touched_casters<'a>(
        &'a self,
        casters: &'a [&'a dyn ShadowCaster],
    ) -> impl Iterator<Item = &'a dyn ShadowCaster> {
        let all = casters.iter().zip(&self.touched);
        all.filter(|(_, touched)| **touched)
            .map(|(caster, _)| *caster)
    }
}
