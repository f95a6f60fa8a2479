//! Which views need drawing this frame, and the passes that draw them.

use bytemuck::{Pod, Zeroable};

use crate::cast::content::{Content, Plan, ViewDraws};
use crate::cast::cube_pass::{CubePass, PreparedCubePass};
use crate::cast::pipeline_build::view_layout;
use crate::cast::upload::{PendingUpload, UploadBuffer};
use crate::cast::{
    CLEAR, CasterPipeline, DepthFormat, DepthMap, ShadowCaster, capture_device_errors,
};
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

/// Draws views into the layers of a depth map, and remembers what each layer holds.
#[derive(Debug)]
pub(crate) struct Recorder {
    uniforms: UploadBuffer,
    bytes: Vec<u8>,
    stride: u64,
    bind_group: wgpu::BindGroup,
    layers: Vec<Layer>,
    /// wgpu's OpenGL backend copies no depth textures; there all casters of a view are drawn again.
    can_copy: bool,
    /// Where the layers are the faces of a cube and the device can draw them at once.
    cube: Option<CubePass>,
}

#[derive(Debug)]
struct Layer {
    label: String,
    content: Content,
    /// A texture of one layer for the part that stands still; none before the first use.
    still_part: Option<DepthMap>,
    /// The device had no room for one.
    has_no_room: bool,
}

/// Everything that could fail, done before the encoder is touched.
pub(crate) struct PreparedViews {
    upload: Option<PendingUpload>,
    /// In place of a pass for each view.
    cube: Option<PreparedCubePass>,
}

impl PreparedViews {
    /// Was anything made on the device?
    pub fn uploads(&self) -> bool {
        self.upload.is_some() || self.cube.as_ref().is_some_and(PreparedCubePass::uploads)
    }
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
    /// For maps of `layers` layers; `is_cube` where they are the six faces of one.
    pub fn new(
        device: &wgpu::Device,
        label: &str,
        layers: u32,
        is_cube: bool,
    ) -> Result<Self, ShadowError> {
        let alignment = u64::from(device.limits().min_uniform_buffer_offset_alignment);
        let stride = VIEW_UNIFORM_BYTES.next_multiple_of(alignment);
        let uniforms = UploadBuffer::new(
            device,
            &format!("{label} caster views"),
            stride * u64::from(layers),
        )?;
        let create = || {
            device.create_bind_group(&wgpu::BindGroupDescriptor {
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
            })
        };
        let bind_group =
            capture_device_errors(device, create).map_err(|refusal| ShadowError::Device {
                object: "the bind group of the casters",
                refusal,
            })?;
        let layers = (0..layers).map(|layer| Layer {
            label: format!("{label} layer {layer}"),
            content: Content::default(),
            still_part: None,
            has_no_room: false,
        });
        Ok(Self {
            uniforms,
            bytes: Vec::new(),
            stride,
            bind_group,
            layers: layers.collect(),
            can_copy: device.adapter_info().backend != wgpu::Backend::Gl,
            cube: if is_cube {
                CubePass::new(device, label)?
            } else {
                None
            },
        })
    }

    /// Would `draws` need a pass?
    pub fn needs(&self, draws: &ViewDraws, casters: &[&dyn ShadowCaster]) -> bool {
        !self.layers[draws.view.layer() as usize]
            .content
            .holds(draws, casters)
    }

    /// Does the layer of `view` hold that view, of whatever casters?
    pub fn holds(&self, view: &ShadowView) -> bool {
        self.layers[view.layer() as usize].content.is_of(view)
    }

    /// Device memory of the still parts.
    pub fn bytes(&self) -> u64 {
        let parts = self.layers.iter().filter_map(|l| l.still_part.as_ref());
        parts.map(DepthMap::bytes).sum()
    }

    /// Plans the frame for `map` and stages the uniforms of `views`. `field` is the path of the casters.
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        map: &DepthMap,
        views: &mut [ViewDraws],
        casters: &[&dyn ShadowCaster],
        field: &'static str,
    ) -> Result<PreparedViews, ShadowError> {
        self.bytes.clear();
        self.bytes
            .resize(self.stride as usize * self.layers.len(), 0);
        for draws in views.iter_mut() {
            let layer = &mut self.layers[draws.view.layer() as usize];
            draws.plan = layer.content.plan(draws, casters, self.can_copy);
            if draws.plan == Plan::RenewStill && !layer.make_still_part(device, map) {
                draws.plan = Plan::All;
            }
            if draws.plan != Plan::Keep {
                check_formats(map, &draws.casters, casters, field)?;
            }
            let uniform = CasterViewUniform::of(&draws.view);
            let start = self.stride as usize * draws.view.layer() as usize;
            self.bytes[start..][..size_of_val(&uniform)]
                .copy_from_slice(bytemuck::bytes_of(&uniform));
        }
        if let Some(cube) = &self.cube {
            if views.iter().all(|draws| draws.plan == Plan::All) {
                if let Some(cube) = cube.prepare(device, views, casters)? {
                    return Ok(PreparedViews {
                        upload: None,
                        cube: Some(cube),
                    });
                }
            }
        }
        Ok(PreparedViews {
            upload: self.uniforms.prepare(device, &self.bytes)?,
            cube: None,
        })
    }

    /// Records what was planned; returns the number of passes.
    pub fn record(
        &mut self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        map: &DepthMap,
        prepared: PreparedViews,
        views: &mut [ViewDraws],
        casters: &[&dyn ShadowCaster],
    ) -> u32 {
        if let (Some(cube), Some(prepared)) = (&mut self.cube, prepared.cube) {
            let mut drawn = views.iter().peekable();
            for (layer, index) in self.layers.iter_mut().zip(0..) {
                match drawn.next_if(|draws| draws.view.layer() == index) {
                    Some(draws) => layer.content.replace(draws, casters),
                    // It is cleared with the others.
                    None => layer.content = Content::default(),
                }
            }
            cube.record(device, encoder, map.array_view(), prepared, views, casters);
            return 1;
        }
        self.uniforms.commit(encoder, prepared.upload);
        let mut passes = 0;
        for draws in views {
            let index = draws.view.layer();
            let offset = (self.stride * u64::from(index)) as u32;
            let layer = &mut self.layers[index as usize];
            if draws.plan == Plan::Keep {
                continue;
            }
            layer.content.replace(draws, casters);
            let mut pass = LayerPass {
                encoder,
                label: &layer.label,
                view_group: (&self.bind_group, offset),
                format: map.format(),
            };
            let still = |caster: &u32| layer.content.is_still(*caster);
            let all = draws.casters.iter().copied();
            passes += 1;
            match &layer.still_part {
                Some(part) if draws.plan != Plan::All => {
                    let still_casters = all.clone().filter(still);
                    if draws.plan == Plan::RenewStill {
                        pass.draw(
                            part.layer_view(0),
                            CLEAR,
                            &draws.view,
                            still_casters,
                            casters,
                        );
                        passes += 1;
                    } else {
                        for index in still_casters {
                            draws.copied += 1;
                            draws.copied_triangles +=
                                u64::from(casters[index as usize].triangles());
                        }
                    }
                    pass.encoder.copy_texture_to_texture(
                        part.layer_copy(0),
                        map.layer_copy(index),
                        map.layer_extent(),
                    );
                    let moving = all.filter(|caster| !still(caster));
                    pass.draw(
                        map.layer_view(index),
                        wgpu::LoadOp::Load,
                        &draws.view,
                        moving,
                        casters,
                    );
                }
                _ => pass.draw(map.layer_view(index), CLEAR, &draws.view, all, casters),
            }
        }
        passes
    }

    /// Forgets what the layers hold, so that every view is drawn again.
    pub fn invalidate(&mut self) {
        for layer in &mut self.layers {
            layer.content = Content::default();
        }
        self.uniforms.invalidate();
        if let Some(cube) = &mut self.cube {
            cube.invalidate();
        }
    }
}

impl Layer {
    /// False where the device has no room for one: then all casters are drawn.
    fn make_still_part(&mut self, device: &wgpu::Device, map: &DepthMap) -> bool {
        if self.still_part.is_none() && !self.has_no_room {
            let label = format!("{} still part", self.label);
            self.still_part =
                DepthMap::new(device, &label, "map_size", map.size(), 1, map.format()).ok();
            self.has_no_room = self.still_part.is_none();
        }
        self.still_part.is_some()
    }
}

/// A pass over one layer.
struct LayerPass<'a> {
    encoder: &'a mut wgpu::CommandEncoder,
    label: &'a str,
    view_group: (&'a wgpu::BindGroup, u32),
    format: DepthFormat,
}

impl LayerPass<'_> {
    fn draw<'c>(
        &mut self,
        target: &wgpu::TextureView,
        load: wgpu::LoadOp<f32>,
        view: &ShadowView,
        drawn: impl Iterator<Item = u32>,
        casters: &'c [&'c dyn ShadowCaster],
    ) {
        let mut pass = self.encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(self.label),
            color_attachments: &[],
            depth_stencil_attachment: Some(super::depth_attachment(target, load)),
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        });
        let (group, offset) = self.view_group;
        pass.set_bind_group(0, group, &[offset]);
        // That there is a pipeline for the format was checked when the frame was planned.
        let of_format = |pipeline: &'c CasterPipeline| pipeline.wgpu_pipeline(self.format);
        draw_casters(&mut pass, view, drawn, casters, of_format);
    }
}

/// Draws casters one after the other, and sets a pipeline only where it is another than before. `variant` is what of a caster's
/// pipelines goes with the pass; without one the caster is left out.
pub(crate) fn draw_casters<'c>(
    pass: &mut wgpu::RenderPass<'_>,
    view: &ShadowView,
    drawn: impl Iterator<Item = u32>,
    casters: &'c [&'c dyn ShadowCaster],
    variant: impl Fn(&'c CasterPipeline) -> Option<&'c wgpu::RenderPipeline>,
) {
    let mut current: Option<&CasterPipeline> = None;
    for index in drawn {
        let caster = casters[index as usize];
        let pipeline = caster.pipeline();
        if current != Some(pipeline) {
            let Some(variant) = variant(pipeline) else {
                continue;
            };
            pass.set_pipeline(variant);
            current = Some(pipeline);
        }
        caster.draw(pass, view);
    }
}

/// Have all casters of a view pipelines for the map's format?
fn check_formats(
    map: &DepthMap,
    drawn: &[u32],
    casters: &[&dyn ShadowCaster],
    field: &'static str,
) -> Result<(), ShadowError> {
    let format = map.format();
    let refused = drawn.iter().find(|&&index| {
        let pipeline = casters[index as usize].pipeline();
        pipeline.wgpu_pipeline(format).is_none()
    });
    refused.map_or(Ok(()), |&index| {
        Err(ShadowError::CasterFormat {
            field,
            index: index as usize,
            format,
        })
    })
}
