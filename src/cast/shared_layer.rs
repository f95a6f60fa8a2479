//! Clears rectangles of a layer that several views share, and copies static casters into them.
//!
//! A render pass clears and a copy of depths fills whole layers, so both are draws here.

use crate::ShadowError;
use crate::error::DeviceError;
use crate::gpu::{
    DepthFormat, DepthMap, FullscreenTarget, Need, capture_device_errors, fullscreen_pipeline,
};
use crate::shader;

/// Holds the pipelines of a layer that is divided among views, and the texture in which these views
/// cache their static casters.
#[derive(Debug)]
pub(crate) struct SharedLayer {
    clear: wgpu::RenderPipeline,
    copy: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
    sampler: wgpu::Sampler,
    /// Is `None` before its first use.
    static_cache: Option<SharedStaticCache>,
    /// States that the device could not make one.
    static_cache_failed: bool,
}

/// Holds the depths of static casters, in the rectangles that their views have in the layer.
#[derive(Debug)]
struct SharedStaticCache {
    map: DepthMap,
    /// Binds the map for the copy.
    bind_group: wgpu::BindGroup,
}

impl SharedLayer {
    pub(super) fn new(
        device: &wgpu::Device,
        label: &str,
        format: DepthFormat,
    ) -> Result<Self, ShadowError> {
        let label = &format!("{label} shared layer");
        let create = || {
            let layout = create_layout(device, label);
            let module = create_module(device, label);
            let pipeline = |layout, fragment| {
                let target = FullscreenTarget::Depth(format.texture_format());
                fullscreen_pipeline(device, label, layout, &module, fragment, target)
            };
            Self {
                clear: pipeline(None, None),
                copy: pipeline(Some(&layout), Some("shadow_copy_fragment")),
                sampler: device.create_sampler(&wgpu::SamplerDescriptor {
                    label: Some(label),
                    ..Default::default()
                }),
                layout,
                static_cache: None,
                static_cache_failed: false,
            }
        };
        capture_device_errors(device, create).map_err(|refusal| {
            ShadowError::Device(DeviceError {
                object: "the pipelines of a shared layer",
                refusal,
            })
        })
    }

    /// Makes the texture of the static casters for `map` if there is none. Returns false where the
    /// device could not make it; all casters are then drawn.
    pub(super) fn make_static_cache(
        &mut self,
        device: &wgpu::Device,
        label: &str,
        map: &DepthMap,
    ) -> bool {
        if self.static_cache.is_none() && !self.static_cache_failed {
            let label = format!("{label} static casters");
            let made = DepthMap::new(device, &label, "map_size", map.size(), 1, map.format());
            self.static_cache = made.ok().and_then(|map| {
                let create = || {
                    device.create_bind_group(&wgpu::BindGroupDescriptor {
                        label: Some(&label),
                        layout: &self.layout,
                        entries: &[
                            wgpu::BindGroupEntry {
                                binding: 0,
                                resource: wgpu::BindingResource::TextureView(map.array_view()),
                            },
                            wgpu::BindGroupEntry {
                                binding: 1,
                                resource: wgpu::BindingResource::Sampler(&self.sampler),
                            },
                        ],
                    })
                };
                let bind_group = capture_device_errors(device, create).ok()?;
                Some(SharedStaticCache { map, bind_group })
            });
            self.static_cache_failed = self.static_cache.is_none();
        }
        self.static_cache.is_some()
    }

    /// Returns the texture of the static casters, if there is one.
    pub(super) fn static_cache(&self) -> Option<&DepthMap> {
        self.static_cache.as_ref().map(|cache| &cache.map)
    }

    /// Sets the depths within the scissor rectangle of a pass to the far plane.
    pub(super) fn clear(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_pipeline(&self.clear);
        pass.draw(0..3, 0..1);
    }

    /// Sets the depths within the scissor rectangle of a pass to those of the static casters. It
    /// replaces bind group 0.
    pub(super) fn copy_static_casters(&self, pass: &mut wgpu::RenderPass<'_>) {
        let Some(cache) = &self.static_cache else {
            return;
        };
        pass.set_pipeline(&self.copy);
        pass.set_bind_group(0, &cache.bind_group, &[]);
        pass.draw(0..3, 0..1);
    }
}

/// Returns what the bind group needs that copies the static casters.
pub(crate) fn shared_layer_group(limits: &wgpu::Limits) -> [Need; 4] {
    [
        Need::new("max_bind_groups", 1u32, limits.max_bind_groups),
        Need::new(
            "max_bindings_per_bind_group",
            2u32,
            limits.max_bindings_per_bind_group,
        ),
        Need::new(
            "max_sampled_textures_per_shader_stage",
            1u32,
            limits.max_sampled_textures_per_shader_stage,
        ),
        Need::new(
            "max_samplers_per_shader_stage",
            1u32,
            limits.max_samplers_per_shader_stage,
        ),
    ]
}

fn create_module(device: &wgpu::Device, label: &str) -> wgpu::ShaderModule {
    let source = shader::compose(&[shader::RECT_COPY.name]).unwrap_or_default();
    device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(label),
        source: wgpu::ShaderSource::Wgsl(source.into()),
    })
}

fn create_layout(device: &wgpu::Device, label: &str) -> wgpu::BindGroupLayout {
    let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty,
        count: None,
    };
    let map = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: false },
        view_dimension: wgpu::TextureViewDimension::D2Array,
        multisampled: false,
    };
    let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::NonFiltering);
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(label),
        entries: &[entry(0, map), entry(1, sampler)],
    })
}
