//! Defines `DebugView`, which draws depth maps as images.

use bytemuck::{Pod, Zeroable};
use glam::Mat4;

use crate::debug::cascade_tint::CascadeTint;
use crate::debug::limits::check_debug_view;
use crate::error::DeviceError;
use crate::error::{DebugViewError, DeviceRefusal};
use crate::gpu::{FullscreenTarget, capture_device_errors, filled_buffer, fullscreen_pipeline};
use crate::receive::{Selection, ShadowMaps, ShadowViewUniform};
use crate::report::TexelRect;
use crate::shader;

/// Mirrors `ShadowDebugView` in `wgsl/pass/debug_view.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct DebugUniform {
    local: [u32; 4],
    texels: [f32; 4],
}

/// Is the largest number of views that an image shows: the faces of a cube.
const FACES: u32 = 6;

/// Selects what a [`DebugView`] draws of a light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum DebugImage {
    /// Draws the layer of this number, as it is stored in the texture. Of a pool, whose views share
    /// a layer, it draws the part that belongs to the view of this number: of a spot light the
    /// index of its slot, of a point light six times that index and the number of the face.
    Layer(u32),
    /// Draws the six faces of a point light as an unfolded cross that is four cells wide and three
    /// high: -x, -z, +x and +z in the middle row, +y above -z, and -y below it. The cells outside
    /// the cross are mid-grey.
    Cross,
    /// Draws the same cross of one light of a pool, which is given by the index of its slot.
    PoolCross(u32),
}

/// Draws depth maps as grey levels: black at the light, white at the far plane, or for a local
/// light where the last receiver is seen within its range, and where nothing casts. Depths of local
/// lights are shown as linear distance.
#[derive(Debug)]
pub struct DebugView {
    device: wgpu::Device,
    format: wgpu::TextureFormat,
    layer: wgpu::RenderPipeline,
    cross: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
    sampler: wgpu::Sampler,
    /// Is `None` for a format that cannot be blended.
    tint: Option<CascadeTint>,
}

impl DebugView {
    /// Creates a debug view for render passes with one colour target of `format`, no depth
    /// attachment and one sample per pixel.
    ///
    /// # Errors
    /// Returns [`DebugViewError::Format`] for a format to which a shader cannot write floats,
    /// [`DebugViewError::OverDeviceLimit`] for a device whose limits do not suffice, and
    /// [`DebugViewError::Device`] for a device that is lost or out of memory.
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
                let (label, entry) = ("shadow debug view", Some(entry));
                let target = FullscreenTarget::Color(format.into());
                fullscreen_pipeline(device, label, Some(&layout), &module, entry, target)
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

    /// Draws `image` of `maps` over the whole viewport of `pass`; the engine may set the viewport
    /// to a part of its target. Changes the pipeline and bind group 0 of the pass.
    ///
    /// # Errors
    /// Returns [`DebugViewError`] for a layer that the map does not have, for a cross of a light
    /// without a cube, for maps of another device, and for a device that is lost or out of memory.
    /// Nothing is drawn then.
    pub fn draw(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        maps: &ShadowMaps,
        image: DebugImage,
    ) -> Result<(), DebugViewError> {
        self.check_device(maps)?;
        let sampled = maps.sampled();
        // The cascades of a light are shown together, and the views of a pool one by one.
        let shows_shared = sampled.shares_layer && sampled.selection == Selection::Cascades;
        let layers = if shows_shared { 1 } else { sampled.view_count };
        let (pipeline, first_layer) = match image {
            DebugImage::Layer(layer) => (&self.layer, layer),
            DebugImage::Cross => (&self.cross, 0),
            DebugImage::PoolCross(index) => (&self.cross, index.saturating_mul(FACES)),
        };
        let is_cross = !matches!(image, DebugImage::Layer(_));
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
        if shows_shared {
            // A view with casters tells that the layer they share is not empty.
            let holds = |view: &&ShadowViewUniform| view.mapping.texel_size[0] > 0.0;
            views[0] = *shown.iter().find(holds).unwrap_or(&views[0]);
        }
        // White is where the last receiver is seen, however far the light shines.
        for drawn in maps.views() {
            let index = drawn.index().checked_sub(first_layer);
            if let Some(view) = index.and_then(|index| views.get_mut(index as usize)) {
                view.range = view.range.min(drawn.reach_world() as f32);
            }
        }
        let local = shown.iter().any(|view| view.is_local > 0.0);
        let side = views[0].map_size;
        let own = maps.views().find(|view| view.index() == first_layer);
        let own = own.filter(|_| sampled.shares_layer && !shows_shared);
        let header = DebugUniform {
            local: [u32::from(local), 0, 0, 0],
            texels: own.map_or([0.0, 0.0, side, side], |view| {
                let TexelRect { min, size } = view.texels();
                [min.x, min.y, size.x, size.y].map(|texels| texels as f32)
            }),
        };
        let bind_group = self
            .bind_group(&header, &views, sampled.map)
            .map_err(not_made("the bind group of a debug view"))?;
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &bind_group, &[]);
        pass.draw(0..3, 0..1);
        Ok(())
    }

    /// Multiplies the image in the target of `pass` by a colour for the view of `maps` that covers
    /// each pixel: red, green, blue, yellow, cyan, magenta, orange and violet for the first eight
    /// layers, and grey where none of them does.
    ///
    /// `depth` is a view of the image's single-sampled depth texture, which is stretched over the
    /// viewport. `render_from_clip` transforms the camera's clip space to render space: it is the
    /// inverse of `clip_from_view * view_from_render`. Pixels with a depth of 0 or 1 count as sky
    /// and are not tinted. The faces of a point light overlap by a filter's reach, and the first of
    /// them is shown there. Changes the pipeline and bind group 0 of the pass.
    ///
    /// An engine that can change its shader may call `shadow_view_NAME(position)` instead, which
    /// returns the layer that a lookup at the position uses.
    ///
    /// # Errors
    /// Returns [`DebugViewError::Format`] if the target cannot be blended,
    /// [`DebugViewError::OtherDevice`] for maps of another device, and [`DebugViewError::Device`]
    /// for a device that is lost or out of memory and for a `depth` that cannot be sampled. Nothing
    /// is drawn then.
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

/// Returns a conversion of a device's refusal to make `object` to the error of a debug view.
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
