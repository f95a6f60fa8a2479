//! Six faces of a cube in one pass, on devices that draw several views at once.

use bytemuck::Zeroable;

use crate::ShadowError;
use crate::cast::content::ViewDraws;
use crate::cast::cube_rule::one_pass_casters;
use crate::cast::multiview::{FACE_COUNT, SIX_VIEWS, draws_six_views};
use crate::cast::pipeline_build::six_views_layout;
use crate::cast::recorder::{CasterViewUniform, VIEW_UNIFORM_BYTES, draw_casters};
use crate::cast::upload::{PendingUpload, UploadBuffer};
use crate::cast::{ShadowCaster, capture_device_errors};

/// Uniforms of six views for one pass.
#[derive(Debug)]
pub(crate) struct CubePass {
    label: String,
    faces: UploadBuffer,
    bind_group: wgpu::BindGroup,
}

/// One pass that is the cheaper way, with everything made that could fail.
pub(crate) struct PreparedCubePass {
    upload: Option<PendingUpload>,
    /// All casters of all faces.
    casters: Vec<u32>,
}

impl PreparedCubePass {
    /// Was anything made on the device?
    pub fn uploads(&self) -> bool {
        self.upload.is_some()
    }
}

impl CubePass {
    /// None where the device does not draw six views at once, or not rightly.
    pub fn new(device: &wgpu::Device, label: &str) -> Result<Option<Self>, ShadowError> {
        if !draws_six_views(device) {
            return Ok(None);
        }
        let label = format!("{label} six faces");
        let bytes = VIEW_UNIFORM_BYTES * u64::from(FACE_COUNT);
        let faces = UploadBuffer::new(device, &label, bytes)?;
        let create = || {
            device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some(&label),
                layout: &six_views_layout(device),
                entries: &[wgpu::BindGroupEntry {
                    binding: 0,
                    resource: faces.buffer().as_entire_binding(),
                }],
            })
        };
        let bind_group =
            capture_device_errors(device, create).map_err(|refusal| ShadowError::Device {
                object: "the bind group of the casters",
                refusal,
            })?;
        Ok(Some(Self {
            label,
            faces,
            bind_group,
        }))
    }

    /// Stages one pass for `views`, all of which are to be drawn whole; none where a pass each is cheaper, or a caster cannot be
    /// drawn into six views at once.
    pub fn prepare(
        &self,
        device: &wgpu::Device,
        views: &[ViewDraws],
        casters: &[&dyn ShadowCaster],
    ) -> Result<Option<PreparedCubePass>, ShadowError> {
        let Some(union) = one_pass_casters(views, casters) else {
            return Ok(None);
        };
        let mut pipelines = union
            .iter()
            .map(|&index| casters[index as usize].pipeline());
        if !pipelines.all(|pipeline| pipeline.six_views(device).is_some()) {
            return Ok(None);
        }
        // A face without a view keeps nothing: its depth is beyond the clip volume.
        let mut nowhere = CasterViewUniform::zeroed();
        nowhere.clip_from_anchor[3] = [0.0, 0.0, -1.0, 1.0];
        let mut uniforms = [nowhere; FACE_COUNT as usize];
        for draws in views {
            uniforms[draws.view.layer() as usize] = CasterViewUniform::of(&draws.view);
        }
        Ok(Some(PreparedCubePass {
            upload: self
                .faces
                .prepare(device, bytemuck::cast_slice(&uniforms))?,
            casters: union,
        }))
    }

    /// Draws into the six layers of `map` at once. Each view's list becomes what was drawn into it.
    pub fn record(
        &mut self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        map: &wgpu::TextureView,
        prepared: PreparedCubePass,
        views: &mut [ViewDraws],
        casters: &[&dyn ShadowCaster],
    ) {
        self.faces.commit(encoder, prepared.upload);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(&self.label),
            color_attachments: &[],
            depth_stencil_attachment: Some(super::depth_attachment(map, super::CLEAR)),
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: SIX_VIEWS,
        });
        pass.set_bind_group(0, &self.bind_group, &[]);
        let drawn = prepared.casters.iter().copied();
        draw_casters(&mut pass, &views[0].view, drawn, casters, |pipeline| {
            pipeline.six_views(device)
        });
        for draws in views {
            draws.casters.clone_from(&prepared.casters);
        }
    }

    pub fn invalidate(&mut self) {
        self.faces.invalidate();
    }
}
