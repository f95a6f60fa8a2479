//! Defines the depth texture that a light owns, with one layer per view.

use crate::error::DeviceError;
use crate::gpu::{DepthFormat, capture_device_errors};
use crate::{ShadowError, error::DeviceRefusal};

/// Holds a layered depth texture, with one attachment per layer and one texture view of them all.
#[derive(Debug)]
pub(crate) struct DepthMap {
    format: DepthFormat,
    texture: wgpu::Texture,
    array_view: wgpu::TextureView,
    layer_views: Vec<wgpu::TextureView>,
}

impl DepthMap {
    /// Makes a map of `size` texels per side with `layers` layers. `field` is the path of the size
    /// in the caller's descriptor.
    pub(crate) fn new(
        device: &wgpu::Device,
        label: &str,
        field: &'static str,
        size: u32,
        layers: u32,
        format: DepthFormat,
    ) -> Result<Self, ShadowError> {
        let limits = device.limits();
        if size == 0 {
            return Err(ShadowError::OutOfRange {
                field,
                rule: "at least 1",
                value: size.to_string(),
            });
        }
        if size > limits.max_texture_dimension_2d {
            return Err(ShadowError::OverDeviceLimit {
                field,
                limit: "max_texture_dimension_2d",
                maximum: limits.max_texture_dimension_2d.into(),
                value: size.into(),
            });
        }
        let allocated = allocated_layers(device, layers.into()) as u32;
        let extent = wgpu::Extent3d {
            width: size,
            height: size,
            depth_or_array_layers: allocated,
        };
        let create = || {
            let texture = device.create_texture(&wgpu::TextureDescriptor {
                label: Some(&format!("{label} depth map")),
                size: extent,
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: format.texture_format(),
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT
                    | wgpu::TextureUsages::TEXTURE_BINDING
                    | wgpu::TextureUsages::COPY_SRC
                    | wgpu::TextureUsages::COPY_DST,
                view_formats: &[],
            });
            let array_view = texture.create_view(&wgpu::TextureViewDescriptor {
                label: Some(&format!("{label} depth map, all layers")),
                dimension: Some(wgpu::TextureViewDimension::D2Array),
                ..Default::default()
            });
            let layer_views = (0..layers)
                .map(|layer| {
                    texture.create_view(&wgpu::TextureViewDescriptor {
                        label: Some(&format!("{label} depth map, layer {layer}")),
                        dimension: Some(wgpu::TextureViewDimension::D2),
                        base_array_layer: layer,
                        array_layer_count: Some(1),
                        ..Default::default()
                    })
                })
                .collect();
            Self {
                format,
                texture,
                array_view,
                layer_views,
            }
        };
        capture_device_errors(device, create).map_err(|refusal| match refusal {
            DeviceRefusal::OutOfMemory => ShadowError::OutOfMemory {
                field,
                bytes: bytes(size, allocated, format),
            },
            refusal => ShadowError::Device(DeviceError {
                object: "the depth map",
                refusal,
            }),
        })
    }

    pub(crate) fn texture(&self) -> &wgpu::Texture {
        &self.texture
    }

    pub(crate) fn array_view(&self) -> &wgpu::TextureView {
        &self.array_view
    }

    pub(crate) fn layer_view(&self, layer: u32) -> &wgpu::TextureView {
        &self.layer_views[layer as usize]
    }

    /// Returns one layer as the source or target of a copy of [`DepthMap::layer_extent`].
    pub(crate) fn layer_copy(&self, layer: u32) -> wgpu::TexelCopyTextureInfo<'_> {
        wgpu::TexelCopyTextureInfo {
            texture: &self.texture,
            mip_level: 0,
            origin: wgpu::Origin3d {
                x: 0,
                y: 0,
                z: layer,
            },
            aspect: wgpu::TextureAspect::All,
        }
    }

    pub(crate) fn layer_extent(&self) -> wgpu::Extent3d {
        wgpu::Extent3d {
            width: self.size(),
            height: self.size(),
            depth_or_array_layers: 1,
        }
    }

    pub(crate) fn size(&self) -> u32 {
        self.texture.width()
    }

    pub(crate) fn format(&self) -> DepthFormat {
        self.format
    }

    /// Returns the device memory of all layers in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        bytes(
            self.size(),
            self.texture.depth_or_array_layers(),
            self.format,
        )
    }
}

/// Returns how many layers to allocate so that `layers` of them can be bound as an array. wgpu's
/// OpenGL backend makes a texture of one layer a plain 2D texture, and a square one of a multiple
/// of six layers a cube map; an array binding then reads nothing. One more layer, which is never
/// used, keeps it an array.
pub(crate) fn allocated_layers(device: &wgpu::Device, layers: u64) -> u64 {
    let opengl = device.adapter_info().backend == wgpu::Backend::Gl;
    let not_an_array = layers == 1 || layers.is_multiple_of(6);
    layers + u64::from(opengl && not_an_array)
}

fn bytes(size: u32, layers: u32, format: DepthFormat) -> u64 {
    u64::from(size) * u64::from(size) * u64::from(layers) * format.bytes_per_texel()
}
