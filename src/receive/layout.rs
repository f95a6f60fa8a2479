//! The bind group of a set of lights: samplers first, then uniforms and map of each light.

use crate::receive::filter::FilterSampler;
use crate::receive::sampled_maps::SampledMaps;
use crate::receive::texel_access::TexelAccess;
use crate::receive::view_uniform_bytes;

/// Lights by name.
pub(crate) type NamedMaps<'a> = [(&'a str, SampledMaps<'a>)];

/// Samplers that the set's filters take, in binding order.
pub(crate) fn used_samplers(lights: &NamedMaps<'_>) -> Vec<FilterSampler> {
    [FilterSampler::Comparison, FilterSampler::Point]
        .into_iter()
        .filter(|&sampler| {
            lights
                .iter()
                .any(|(_, maps)| maps.sampling.filter.wgsl().1 == sampler)
        })
        .collect()
}

/// Returns the number of the binding with the uniforms of a light; its map follows.
pub(crate) fn views_binding(samplers: &[FilterSampler], light: usize) -> u32 {
    (samplers.len() + 2 * light) as u32
}

/// How a light's map is bound on a device with `access` to texels: for the comparing sampler always as a depth texture.
pub(crate) fn map_access(maps: &SampledMaps<'_>, access: TexelAccess) -> TexelAccess {
    match maps.sampling.filter.wgsl().1 {
        FilterSampler::Comparison => TexelAccess::Gathers,
        FilterSampler::Point => access,
    }
}

pub(crate) fn create_layout(
    device: &wgpu::Device,
    visibility: wgpu::ShaderStages,
    label: Option<&str>,
    lights: &NamedMaps<'_>,
    samplers: &[FilterSampler],
    access: TexelAccess,
) -> wgpu::BindGroupLayout {
    let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
        binding,
        visibility,
        ty,
        count: None,
    };
    let mut entries: Vec<_> = samplers
        .iter()
        .enumerate()
        .map(|(binding, sampler)| {
            let ty = match sampler {
                FilterSampler::Comparison => wgpu::SamplerBindingType::Comparison,
                FilterSampler::Point => wgpu::SamplerBindingType::NonFiltering,
            };
            entry(binding as u32, wgpu::BindingType::Sampler(ty))
        })
        .collect();
    for (light, (_, maps)) in lights.iter().enumerate() {
        let bytes = view_uniform_bytes(maps.view_count.into());
        let views = views_binding(samplers, light);
        entries.push(entry(
            views,
            wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: false,
                min_binding_size: wgpu::BufferSize::new(bytes),
            },
        ));
        let map = map_access(maps, access).map_binding();
        entries.push(entry(views + 1, map));
    }
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: label.or(Some("shadow bindings")),
        entries: &entries,
    })
}

pub(crate) fn create_bind_group(
    device: &wgpu::Device,
    label: Option<&str>,
    lights: &NamedMaps<'_>,
    samplers: &[FilterSampler],
    layout: &wgpu::BindGroupLayout,
) -> wgpu::BindGroup {
    let made: Vec<_> = samplers
        .iter()
        .map(|sampler| create_sampler(device, *sampler))
        .collect();
    let mut entries: Vec<_> = made
        .iter()
        .enumerate()
        .map(|(binding, sampler)| wgpu::BindGroupEntry {
            binding: binding as u32,
            resource: wgpu::BindingResource::Sampler(sampler),
        })
        .collect();
    for (light, (_, maps)) in lights.iter().enumerate() {
        let views = views_binding(samplers, light);
        entries.push(wgpu::BindGroupEntry {
            binding: views,
            resource: maps.views.as_entire_binding(),
        });
        entries.push(wgpu::BindGroupEntry {
            binding: views + 1,
            resource: wgpu::BindingResource::TextureView(maps.map),
        });
    }
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: label.or(Some("shadow bindings")),
        layout,
        entries: &entries,
    })
}

fn create_sampler(device: &wgpu::Device, sampler: FilterSampler) -> wgpu::Sampler {
    let comparison = sampler == FilterSampler::Comparison;
    let filter = if comparison {
        wgpu::FilterMode::Linear
    } else {
        wgpu::FilterMode::Nearest
    };
    device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("shadow sampler"),
        mag_filter: filter,
        min_filter: filter,
        // Reversed depth: lit where the receiver is at least as near as what the map holds.
        compare: comparison.then_some(wgpu::CompareFunction::GreaterEqual),
        ..Default::default()
    })
}
