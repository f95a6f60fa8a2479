//! Provides `shadow_sun(position, normal)` for the scene's shader, with its bind group: that of the
//! library or that of the tutorial.

use wgpu_shadows::{
    DirectionalShadow, ShadowBindings, ShadowBindingsDescriptor, error::BindingsError, shader,
};

/// Is the index of the bind group that `shadow_sun` reads.
pub const GROUP: u32 = 1;

/// Holds WGSL with a function `shadow_sun`, and what it reads.
pub struct Lookup {
    pub wgsl: String,
    pub layout: wgpu::BindGroupLayout,
    pub bind_group: wgpu::BindGroup,
}

impl Lookup {
    /// Returns the library's function: filter and bias of the light, and lit wherever no map covers
    /// the position.
    pub fn by_the_library(
        device: &wgpu::Device,
        sun: &DirectionalShadow,
    ) -> Result<Self, BindingsError> {
        let bindings = ShadowBindings::new(
            device,
            &ShadowBindingsDescriptor {
                group: GROUP,
                lights: &[("sun", sun.maps())],
                ..Default::default()
            },
        )?;
        Ok(Self {
            wgsl: bindings.wgsl().to_owned(),
            layout: bindings.layout().clone(),
            bind_group: bindings.bind_group().clone(),
        })
    }

    /// Returns the tutorial's function with its mistake. It also shows how an engine uses the
    /// library's WGSL modules in a bind group of its own: all that they need is the light's uniform
    /// buffer, its map and a sampler.
    pub fn by_mistake(
        device: &wgpu::Device,
        sun: &DirectionalShadow,
    ) -> Result<Self, BindingsError> {
        let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty,
            count: None,
        };
        let view = wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        let map = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Depth,
            view_dimension: wgpu::TextureViewDimension::D2Array,
            multisampled: false,
        };
        let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Comparison);
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("out of range"),
            entries: &[entry(0, view), entry(1, map), entry(2, sampler)],
        });
        // Depth is reversed: a receiver is lit where it is at least as near as the depth in the
        // map.
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("out of range"),
            address_mode_u: wgpu::AddressMode::ClampToEdge,
            address_mode_v: wgpu::AddressMode::ClampToEdge,
            compare: Some(wgpu::CompareFunction::GreaterEqual),
            ..Default::default()
        });
        let bind_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("out of range"),
            layout: &layout,
            entries: &[
                wgpu::BindGroupEntry {
                    binding: 0,
                    resource: sun.maps().uniform_buffer().as_entire_binding(),
                },
                wgpu::BindGroupEntry {
                    binding: 1,
                    resource: wgpu::BindingResource::TextureView(sun.maps().texture_view()),
                },
                wgpu::BindGroupEntry {
                    binding: 2,
                    resource: wgpu::BindingResource::Sampler(&sampler),
                },
            ],
        });
        Ok(Self {
            wgsl: shader::compose(&["bias_manual"])? + include_str!("out_of_range.wgsl"),
            layout,
            bind_group,
        })
    }
}
