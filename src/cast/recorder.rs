//! Which views need drawing this frame, and the passes that draw them.

use bytemuck::{Pod, Zeroable};

use crate::cast::pipeline_build::view_layout;
use crate::cast::upload::{PendingUpload, UploadBuffer};
use crate::cast::{CasterPipeline, DepthMap, Revision, ShadowCaster};
use crate::fit::ViewPlacement;
use crate::{ShadowError, ShadowView};

/// Mirror of `ShadowCasterView` in `wgsl/caster.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct CasterViewUniform {
    pub clip_from_anchor: [[f32; 4]; 4],
    pub anchor_render: [f32; 3],
    pub map_size: f32,
}

pub(crate) const VIEW_UNIFORM_BYTES: u64 = size_of::<CasterViewUniform>() as u64;

/// One view of this frame and the casters that it needs, by index.
#[derive(Debug)]
pub(crate) struct ViewDraws {
    pub view: ShadowView,
    pub casters: Vec<u32>,
    /// The layer keeps what it holds, whatever has changed.
    pub deferred: bool,
    /// Set by [`Recorder::record`]: false where the layer held this picture already.
    pub drawn: bool,
}

impl ViewDraws {
    pub fn new(view: ShadowView, casters: Vec<u32>) -> Self {
        Self {
            view,
            casters,
            deferred: false,
            drawn: false,
        }
    }

    fn revisions(&self, casters: &[&dyn ShadowCaster]) -> impl Iterator<Item = Revision> {
        self.casters
            .iter()
            .map(|&index| casters[index as usize].revision())
    }
}

/// What a layer of the map holds.
#[derive(Clone, Debug, Default)]
struct Content {
    /// None before the first pass.
    placement: Option<ViewPlacement>,
    revisions: Vec<Revision>,
}

impl Content {
    /// Is it what `draws` would put there?
    fn holds(&self, draws: &ViewDraws, casters: &[&dyn ShadowCaster]) -> bool {
        self.placement == Some(*draws.view.placement())
            && self.revisions.iter().all(Revision::is_stable)
            && self.revisions.iter().copied().eq(draws.revisions(casters))
    }

    /// Takes on what `draws` will put there; false where the layer holds it already.
    fn replace(&mut self, draws: &ViewDraws, casters: &[&dyn ShadowCaster]) -> bool {
        if self.holds(draws, casters) {
            return false;
        }
        self.placement = Some(*draws.view.placement());
        self.revisions.clear();
        self.revisions.extend(draws.revisions(casters));
        true
    }
}

/// Draws views into the layers of a depth map, and remembers what each layer holds.
#[derive(Debug)]
pub(crate) struct Recorder {
    label: String,
    uniforms: UploadBuffer,
    stride: u64,
    bind_group: wgpu::BindGroup,
    contents: Vec<Content>,
}

/// Everything that could fail, done before the encoder is touched.
pub(crate) struct PreparedViews {
    upload: Option<PendingUpload>,
}

impl CasterViewUniform {
    pub fn of(view: &ShadowView) -> Self {
        Self {
            clip_from_anchor: view.clip_from_anchor().to_cols_array_2d(),
            anchor_render: view.anchor_render().to_array(),
            map_size: view.map_size() as f32,
        }
    }
}

impl Recorder {
    /// For maps of `layers` layers.
    pub fn new(device: &wgpu::Device, label: &str, layers: u32) -> Result<Self, ShadowError> {
        let alignment = u64::from(device.limits().min_uniform_buffer_offset_alignment);
        let stride = VIEW_UNIFORM_BYTES.next_multiple_of(alignment);
        let uniforms = UploadBuffer::new(
            device,
            &format!("{label} caster views"),
            stride * u64::from(layers),
        )?;
        let bind_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(&format!("{label} caster views")),
            layout: &view_layout(device),
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                    buffer: uniforms.buffer(),
                    offset: 0,
                    size: wgpu::BufferSize::new(VIEW_UNIFORM_BYTES),
                }),
            }],
        });
        Ok(Self {
            label: label.to_owned(),
            uniforms,
            stride,
            bind_group,
            contents: vec![Content::default(); layers as usize],
        })
    }

    /// Would `draws` need a pass?
    pub fn needs(&self, draws: &ViewDraws, casters: &[&dyn ShadowCaster]) -> bool {
        !self.contents[draws.view.layer() as usize].holds(draws, casters)
    }

    /// Stages the uniforms of `views`.
    pub fn prepare(
        &self,
        device: &wgpu::Device,
        views: &[ViewDraws],
    ) -> Result<PreparedViews, ShadowError> {
        let mut bytes = vec![0; self.stride as usize * self.contents.len()];
        for draws in views {
            let uniform = CasterViewUniform::of(&draws.view);
            let start = self.stride as usize * draws.view.layer() as usize;
            bytes[start..][..size_of_val(&uniform)].copy_from_slice(bytemuck::bytes_of(&uniform));
        }
        Ok(PreparedViews {
            upload: self.uniforms.prepare(device, &bytes)?,
        })
    }

    /// Records a pass for each view whose layer does not hold it already; returns the number of passes.
    pub fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        map: &DepthMap,
        prepared: PreparedViews,
        views: &mut [ViewDraws],
        casters: &[&dyn ShadowCaster],
    ) -> u32 {
        self.uniforms.commit(encoder, prepared.upload);
        let mut passes = 0;
        for draws in views {
            let content = &mut self.contents[draws.view.layer() as usize];
            draws.drawn = !draws.deferred && content.replace(draws, casters);
            if draws.drawn {
                self.draw(encoder, map, draws, casters);
                passes += 1;
            }
        }
        passes
    }

    fn draw(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        map: &DepthMap,
        draws: &ViewDraws,
        casters: &[&dyn ShadowCaster],
    ) {
        let layer = draws.view.layer();
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(&format!("{} layer {layer}", self.label)),
            color_attachments: &[],
            depth_stencil_attachment: Some(super::depth_attachment(map.layer_view(layer))),
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        });
        let offset = (self.stride * u64::from(layer)) as u32;
        pass.set_bind_group(0, &self.bind_group, &[offset]);
        let mut current: Option<&CasterPipeline> = None;
        for &index in &draws.casters {
            let caster = casters[index as usize];
            let pipeline = caster.pipeline();
            if current != Some(pipeline) {
                pass.set_pipeline(pipeline.wgpu_pipeline());
                current = Some(pipeline);
            }
            caster.draw(&mut pass, &draws.view);
        }
    }

    /// Forgets what the layers hold, so that every view is drawn again.
    pub fn invalidate(&mut self) {
        self.contents.fill(Content::default());
        self.uniforms.invalidate();
    }
}
