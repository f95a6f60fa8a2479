//! Defines the bind group of a set of lights: first the samplers that their filters use, then the
//! uniforms and the map of each light.

use crate::receive::filter::FilterSampler;
use crate::receive::sampled_maps::SampledMaps;
use crate::receive::texel_access::TexelAccess;
use crate::receive::view_uniform_bytes;

/// Holds the lights of a set, each with the name in which its WGSL functions end.
pub(crate) type NamedMaps<'a> = [(&'a str, SampledMaps<'a>)];

/// Returns the samplers that the filters of `lights` use. A sampler's index in the list is the
/// number of its binding.
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

/// Returns the number of the binding with the uniforms of the light at index `light`; the next
/// binding is its map.
pub(crate) fn views_binding(samplers: &[FilterSampler], light: usize) -> u32 {
    (samplers.len() + 2 * light) as u32
}

/// Returns how a light's map is bound on a device whose shaders read single texels by `access`. A
/// filter that uses the comparison sampler needs a depth texture on every device.
pub(crate) fn map_access(maps: &SampledMaps<'_>, access: TexelAccess) -> TexelAccess {
    match maps.sampling.filter.wgsl().1 {
        FilterSampler::Comparison => TexelAccess::Gathers,
        FilterSampler::Point => access,
    }
}

/// Creates the layout of the bind group. The caller's error scope captures device errors.
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

/// Creates the samplers and the bind group for `layout`. The caller's error scope captures device
/// errors.
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

/// Creates a sampler that clamps to the edge. It is linear for comparisons, and nearest for gathers
/// and single samples.
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
        // Depth is reversed, so a receiver is lit where its depth is at least the one in the map.
        compare: comparison.then_some(wgpu::CompareFunction::GreaterEqual),
        ..Default::default()
    })
}
