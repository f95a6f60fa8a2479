//! `DebugView`: a depth map as a picture for people.

use bytemuck::{Pod, Zeroable};
use glam::Mat4;

use crate::debug::cascade_tint::CascadeTint;
use crate::debug::limits::check_debug_view;
use crate::error::DeviceError;
use crate::error::{DebugViewError, DeviceRefusal};
use crate::gpu::{capture_device_errors, filled_buffer, fullscreen_pipeline};
use crate::receive::{Selection, ShadowMaps, ShadowViewUniform};
use crate::shader;

/// Mirror of `ShadowDebugView` in `wgsl/pass/debug_view.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct DebugUniform {
    local: [u32; 4],
}

/// Views that a picture may need: the faces of a cube.
const FACES: u32 = 6;

/// What of a light to draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum DebugImage {
    /// One layer of the map, as it lies in the texture.
    Layer(u32),
    /// The six faces of a point light as an unfolded cross, four cells wide and three high: -x, -z, +x, +z in the middle row,
    /// +y above and -y below -z.
    Cross,
    /// The same of one light of a pool, by the index of its slot.
    PoolCross(u32),
}

/// Draws depth maps as grey levels: black at the light, white at the far plane, or for a local light where the last receiver is seen
/// within its range, and where nothing casts. Depths of local lights are shown as linear distance.
#[derive(Debug)]
pub struct DebugView {
    device: wgpu::Device,
    format: wgpu::TextureFormat,
    layer: wgpu::RenderPipeline,
    cross: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
    sampler: wgpu::Sampler,
    /// None for a format that cannot be blended.
    tint: Option<CascadeTint>,
}

impl DebugView {
    /// For passes with one colour target of `format`, no depth attachment and one sample.
    ///
    /// # Errors
    /// [`DebugViewError::Format`] for a format that floats cannot be drawn to, [`DebugViewError::OverDeviceLimit`] for a device
    /// that was created with too low limits, [`DebugViewError::Device`] for one that is lost or out of memory.
    pub fn new(device: &wgpu::Device, format: wgpu::TextureFormat) -> Result<Self, DebugViewError> {
        let floats = matches!(
            format.sample_type(None, Some(device.features())),
            Some(wgpu::TextureSampleType::Float { .. })
        );
        let features = format.guaranteed_format_features(device.features());
        let renderable = features
            .allowed_usages
            .contains(wgpu::TextureUsages::RENDER_ATTACHMENT);
        let blendable = features
            .flags
            .contains(wgpu::TextureFormatFeatureFlags::BLENDABLE);
        if !(floats && renderable) {
            return Err(DebugViewError::Format { format });
        }
        let views = if blendable {
            CascadeTint::VIEWS.max(FACES as usize)
        } else {
            FACES as usize
        };
        check_debug_view(device, format, views as u64)?;
        let create = || {
            let layout = create_layout(device);
            let source = shader::compose(&[shader::DEBUG_VIEW.name]).unwrap_or_default();
            let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some("shadow debug view"),
                source: wgpu::ShaderSource::Wgsl(source.into()),
            });
            let pipeline = |entry| {
                let target = format.into();
                fullscreen_pipeline(device, "shadow debug view", &layout, &module, entry, target)
            };
            Self {
                device: device.clone(),
                format,
                layer: pipeline("shadow_debug_layer"),
                cross: pipeline("shadow_debug_cross"),
                sampler: device.create_sampler(&wgpu::SamplerDescriptor {
                    label: Some("shadow debug view"),
                    ..Default::default()
                }),
                layout,
                tint: blendable.then(|| CascadeTint::new(device, format)),
            }
        };
        capture_device_errors(device, create).map_err(not_made("the pipelines of a debug view"))
    }

    /// Draws `picture` of `maps` over the whole viewport of `pass`, which the engine may set to a corner of its window. Sets
    /// pipeline and bind group 0.
    ///
    /// # Errors
    /// [`DebugViewError`] for a layer that the map does not have, a cross of a light without a cube, or a device that is lost,
    /// out of memory, or not the light's own; nothing is drawn then.
    pub fn draw(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        maps: &ShadowMaps,
        picture: DebugImage,
    ) -> Result<(), DebugViewError> {
        self.check_device(maps)?;
        let sampled = maps.sampled();
        let layers = sampled.view_count;
        let (pipeline, first_layer) = match picture {
            DebugImage::Layer(layer) => (&self.layer, layer),
            DebugImage::Cross => (&self.cross, 0),
            DebugImage::PoolCross(index) => (&self.cross, index.saturating_mul(FACES)),
        };
        let is_cross = !matches!(picture, DebugImage::Layer(_));
        if is_cross && sampled.selection != Selection::CubeFace {
            return Err(DebugViewError::NotACube { layers });
        }
        if first_layer >= layers {
            return Err(DebugViewError::Layer {
                layer: first_layer,
                layers,
            });
        }
        let mut views = [ShadowViewUniform::zeroed(); FACES as usize];
        let shown = &sampled.uniforms[first_layer as usize..];
        for (view, uniform) in views.iter_mut().zip(shown) {
            *view = *uniform;
        }
        // White is where the last receiver is seen, however far the light shines.
        for drawn in maps.views() {
            let index = drawn.layer().checked_sub(first_layer);
            if let Some(view) = index.and_then(|index| views.get_mut(index as usize)) {
                view.range = view.range.min(drawn.reach_world() as f32);
            }
        }
        let local = shown.iter().any(|view| view.light[3] > 0.0);
        let header = DebugUniform {
            local: [u32::from(local), 0, 0, 0],
        };
        let bind_group = self
            .bind_group(&header, &views, sampled.map)
            .map_err(not_made("the bind group of a debug view"))?;
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &bind_group, &[]);
        pass.draw(0..3, 0..1);
        Ok(())
    }

    /// Multiplies the picture in `pass` by a colour for the view of `maps` that serves each pixel: red, green, blue, yellow,
    /// cyan, magenta, orange, violet for the first eight layers, grey where none does. `depth` is a single-sampled depth
    /// texture of the picture, of the viewport's shape, and `render_from_clip` the inverse of its camera's matrix; depths of 0
    /// and 1 count as sky. The faces of a point light overlap by a filter's reach, and there the first is shown. Sets pipeline
    /// and bind group 0.
    ///
    /// Where an engine can change its shader instead, `shadow_view_NAME(position)` says the same.
    ///
    /// # Errors
    /// [`DebugViewError::Format`] where the target cannot be blended; [`DebugViewError::Device`] for a device that is lost,
    /// out of memory, or not the light's own, or a `depth` that it cannot sample. Nothing is drawn then.
    pub fn draw_cascades(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        maps: &ShadowMaps,
        depth: &wgpu::TextureView,
        render_from_clip: Mat4,
    ) -> Result<(), DebugViewError> {
        self.check_device(maps)?;
        let tint = self.tint.as_ref().ok_or(DebugViewError::Format {
            format: self.format,
        })?;
        tint.draw(&self.device, pass, &maps.sampled(), depth, render_from_clip)
            .map_err(not_made("the bind group of a debug view"))
    }

    fn check_device(&self, maps: &ShadowMaps) -> Result<(), DebugViewError> {
        if *maps.device() == self.device {
            Ok(())
        } else {
            Err(DebugViewError::OtherDevice)
        }
    }

    fn bind_group(
        &self,
        header: &DebugUniform,
        views: &[ShadowViewUniform],
        map: &wgpu::TextureView,
    ) -> Result<wgpu::BindGroup, DeviceRefusal> {
        let upload = |contents: &[u8]| {
            let usage = wgpu::BufferUsages::UNIFORM;
            filled_buffer(&self.device, "shadow debug view", contents, usage)
        };
        let header = upload(bytemuck::bytes_of(header))?;
        let views = upload(bytemuck::cast_slice(views))?;
        let resources = [
            header.as_entire_binding(),
            views.as_entire_binding(),
            wgpu::BindingResource::TextureView(map),
            wgpu::BindingResource::Sampler(&self.sampler),
        ];
        let entries: Vec<_> = (0..)
            .zip(resources)
            .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
            .collect();
        capture_device_errors(&self.device, || {
            self.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("shadow debug view"),
                layout: &self.layout,
                entries: &entries,
            })
        })
    }
}

fn not_made(object: &'static str) -> impl Fn(DeviceRefusal) -> DebugViewError {
    move |refusal| DebugViewError::Device(DeviceError { object, refusal })
}

fn create_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let uniform = |binding, bytes: usize| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: wgpu::BufferSize::new(bytes as u64),
        },
        count: None,
    };
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("shadow debug view"),
        entries: &[
            uniform(0, size_of::<DebugUniform>()),
            uniform(1, FACES as usize * size_of::<ShadowViewUniform>()),
            wgpu::BindGroupLayoutEntry {
                binding: 2,
                visibility: wgpu::ShaderStages::FRAGMENT,
                ty: wgpu::BindingType::Texture {
                    sample_type: wgpu::TextureSampleType::Float { filterable: false },
                    view_dimension: wgpu::TextureViewDimension::D2Array,
                    multisampled: false,
                },
                count: None,
            },
            wgpu::BindGroupLayoutEntry {
                binding: 3,
                visibility: wgpu::ShaderStages::FRAGMENT,
                ty: wgpu::BindingType::Sampler(wgpu::SamplerBindingType::NonFiltering),
                count: None,
            },
        ],
    })
}
