//! Which views need drawing this frame, and the passes that draw them.

use crate::cast::cube_pass::{CubePass, PreparedCubePass};
use crate::cast::draw_casters::{DrawnCaster, PassDefaults, draw_casters};
use crate::cast::layer_cache::{LayerCache, Plan, ViewDraws};
use crate::cast::view_uniform::{CasterViewUniform, VIEW_UNIFORM_BYTES, view_layout};
use crate::cast::{CLEAR, CasterPipeline, FrameCasters};
use crate::gpu::{DepthFormat, DepthMap, PendingUpload, UploadBuffer, capture_device_errors};
use crate::{ShadowError, ShadowView};

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
    content: LayerCache,
    /// A texture of one layer for the part that stands still; none before the first use.
    static_cache: Option<DepthMap>,
    /// The device had no room for one.
    has_no_room: bool,
}

/// Everything that could fail, done before the encoder is touched.
pub(crate) struct PreparedViews<'a> {
    upload: Option<PendingUpload>,
    /// In place of a pass for each view.
    cube: Option<PreparedCubePass<'a>>,
    /// The pipelines of the casters of all views that are drawn, one after the other.
    pipelines: Vec<&'a CasterPipeline>,
}

impl PreparedViews<'_> {
    /// Was anything made on the device?
    pub fn uploads(&self) -> bool {
        self.upload.is_some() || self.cube.as_ref().is_some_and(PreparedCubePass::uploads)
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
            content: LayerCache::default(),
            static_cache: None,
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

    /// Returns how many depth passes `draws` needs.
    pub fn passes(&self, draws: &ViewDraws, casters: &FrameCasters<'_>) -> u32 {
        let layer = &self.layers[draws.view.layer() as usize];
        layer.content.plan(draws, casters, self.can_copy).passes()
    }

    /// Does the layer of `view` hold that view, of whatever casters?
    pub fn holds(&self, view: &ShadowView) -> bool {
        self.layers[view.layer() as usize].content.is_of(view)
    }

    /// Device memory of the still parts.
    pub fn bytes(&self) -> u64 {
        let parts = self.layers.iter().filter_map(|l| l.static_cache.as_ref());
        parts.map(DepthMap::bytes).sum()
    }

    /// Plans the frame for `map` and stages the uniforms of `views`. Each view comes to allow for the rounding of the depths
    /// that its layer will hold.
    pub fn prepare<'a>(
        &mut self,
        device: &wgpu::Device,
        map: &DepthMap,
        views: &mut [ViewDraws],
        casters: &FrameCasters<'a>,
    ) -> Result<PreparedViews<'a>, ShadowError> {
        let mut pipelines = Vec::new();
        self.bytes.clear();
        self.bytes
            .resize(self.stride as usize * self.layers.len(), 0);
        for draws in views.iter_mut() {
            let layer = &mut self.layers[draws.view.layer() as usize];
            draws.plan = layer.content.plan(draws, casters, self.can_copy);
            if draws.plan == Plan::RenewStaticCache && !layer.make_static_cache(device, map) {
                draws.plan = Plan::All;
            }
            if draws.plan != Plan::Keep {
                add_pipelines(
                    &mut pipelines,
                    device,
                    map.format(),
                    &draws.casters,
                    casters,
                )?;
            }
            let render_reach = layer.content.render_reach_after(draws);
            draws.view = draws.view.over_depths_from(render_reach);
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
                        pipelines,
                    });
                }
            }
        }
        Ok(PreparedViews {
            upload: self.uniforms.prepare(device, &self.bytes)?,
            cube: None,
            pipelines,
        })
    }

    /// Records what was planned; returns the number of passes.
    ///
    /// What a layer holds is forgotten before anything is drawn into it and known again when its pass is complete: a caster
    /// that panics leaves a layer behind that the next frame draws anew.
    pub fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        map: &DepthMap,
        prepared: PreparedViews<'_>,
        views: &mut [ViewDraws],
        casters: &FrameCasters<'_>,
    ) -> u32 {
        if let (Some(cube), Some(prepared)) = (&mut self.cube, prepared.cube) {
            // All layers are cleared, those of faces that nothing casts into as well.
            let mut contents: Vec<LayerCache> =
                self.layers.iter_mut().map(Layer::take_content).collect();
            for draws in views.iter() {
                contents[draws.view.layer() as usize].replace(draws, casters);
            }
            cube.record(encoder, map, prepared, views, casters);
            for draws in views.iter() {
                let index = draws.view.layer() as usize;
                self.layers[index].content = std::mem::take(&mut contents[index]);
            }
            return 1;
        }
        self.uniforms.commit(encoder, prepared.upload);
        let mut passes = 0;
        let mut pipelines = prepared.pipelines.as_slice();
        for draws in views {
            if draws.plan == Plan::Keep {
                continue;
            }
            let (own_pipelines, others) = pipelines.split_at(draws.casters.len());
            pipelines = others;
            let index = draws.view.layer();
            let layer = &mut self.layers[index as usize];
            let mut content = layer.take_content();
            content.replace(draws, casters);
            let mut pass = LayerPass {
                encoder,
                label: &layer.label,
                view_group: (&self.bind_group, (self.stride * u64::from(index)) as u32),
                format: map.format(),
            };
            let all = draws.casters.iter().zip(own_pipelines);
            let all = all.map(|(&index, &pipeline)| DrawnCaster { index, pipeline });
            let (target, view) = (map.layer_view(index), &draws.view);
            passes += draws.plan.passes();
            match &layer.static_cache {
                Some(part) if draws.plan != Plan::All => {
                    let still = |caster: &DrawnCaster<'_>| content.is_still(caster.index);
                    let still_casters = all.clone().filter(still);
                    if draws.plan == Plan::RenewStaticCache {
                        pass.draw(part.layer_view(0), CLEAR, view, still_casters, casters);
                    } else {
                        for caster in still_casters {
                            draws.copied += 1;
                            draws.copied_triangles +=
                                u64::from(casters.facts(caster.index).triangles);
                        }
                    }
                    pass.encoder.copy_texture_to_texture(
                        part.layer_copy(0),
                        map.layer_copy(index),
                        map.layer_extent(),
                    );
                    let moving = all.filter(|caster| !still(caster));
                    pass.draw(target, wgpu::LoadOp::Load, view, moving, casters);
                }
                _ => pass.draw(target, CLEAR, view, all, casters),
            }
            layer.content = content;
        }
        passes
    }

    /// Forgets what the layers hold, so that every view is drawn again.
    pub fn invalidate(&mut self) {
        for layer in &mut self.layers {
            layer.content = LayerCache::default();
        }
        self.uniforms.invalidate();
        if let Some(cube) = &mut self.cube {
            cube.invalidate();
        }
    }
}

impl Layer {
    /// Takes away what is known of the layer, which from now on holds nothing that can be relied on.
    fn take_content(&mut self) -> LayerCache {
        std::mem::take(&mut self.content)
    }

    /// False where the device has no room for one: then all casters are drawn.
    fn make_static_cache(&mut self, device: &wgpu::Device, map: &DepthMap) -> bool {
        if self.static_cache.is_none() && !self.has_no_room {
            let label = format!("{} still part", self.label);
            self.static_cache =
                DepthMap::new(device, &label, "map_size", map.size(), 1, map.format()).ok();
            self.has_no_room = self.static_cache.is_none();
        }
        self.static_cache.is_some()
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
        drawn: impl Iterator<Item = DrawnCaster<'c>>,
        casters: &FrameCasters<'_>,
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
        let defaults = PassDefaults {
            view_group: group,
            offsets: &[offset],
            map_size: view.map_size(),
        };
        // That there is a pipeline for the format was checked when the frame was planned.
        let of_format = |pipeline: &'c CasterPipeline| pipeline.wgpu_pipeline(self.format);
        draw_casters(&mut pass, &defaults, view, drawn, casters, of_format);
    }
}

/// Adds the pipelines of a view's casters to `pipelines`, each of which must have been made on `device` and for `format`.
fn add_pipelines<'a>(
    pipelines: &mut Vec<&'a CasterPipeline>,
    device: &wgpu::Device,
    format: DepthFormat,
    drawn: &[u32],
    casters: &FrameCasters<'a>,
) -> Result<(), ShadowError> {
    let field = casters.field;
    for &index in drawn {
        let pipeline = casters.caster(index).pipeline();
        let index = index as usize;
        if pipeline.device() != device {
            return Err(ShadowError::CasterDevice { field, index });
        }
        if pipeline.wgpu_pipeline(format).is_none() {
            return Err(ShadowError::CasterFormat {
                field,
                index,
                format,
            });
        }
        pipelines.push(pipeline);
    }
    Ok(())
}
