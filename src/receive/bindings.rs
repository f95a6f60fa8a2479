//! One bind group for a set of lights, and the WGSL for exactly that set.

use crate::error::BindingsError;
use crate::gpu::{Need, capture_device_errors};
use crate::receive::filter::FilterSampler;
use crate::receive::texel_access::TexelAccess;
use crate::receive::uniforms::view_uniform_bytes;
use crate::receive::{Sampling, ShadowViewUniform, emit};
use crate::shader;

/// What a light gives its receivers: its map, its uniforms, and how to look them up.
///
/// Made by the lights' `source` methods; textures and buffers stay the light's own, so a bind group outlives every frame.
#[derive(Clone, Copy, Debug)]
pub struct ShadowSource<'a> {
    pub(crate) receiver: Receiver<'a>,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Receiver<'a> {
    pub map: &'a wgpu::TextureView,
    pub views: &'a wgpu::Buffer,
    pub view_count: u32,
    /// What `views` holds since the last frame.
    pub uniforms: &'a [ShadowViewUniform],
    pub sampling: Sampling,
    pub selection: Selection,
    pub views_per_light: u32,
    /// A pool: the lights are asked by index.
    pub indexed: bool,
}

/// How a place chooses among a light's views; everything after the choice is the same for all lights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Selection {
    /// The first view that holds the whole kernel: the cascades of a directional light, near to far.
    Cascades,
    /// There is one: a spot.
    OneView,
    /// The face of a cube, by the major axis from the light.
    CubeFace,
}

/// What a [`ShadowBindings`] is made of.
#[derive(Clone, Copy, Debug)]
pub struct ShadowBindingsDescriptor<'a> {
    /// Label of layout and bind group.
    pub label: wgpu::Label<'a>,
    /// Index of the bind group in the engine's pipelines. Default 1.
    pub group: u32,
    /// Stages that call the functions. Default `FRAGMENT`; add `COMPUTE` for volumetric light.
    pub visibility: wgpu::ShaderStages,
    /// The lights by name. A light named `sun` is asked through `shadow_sun(position, normal)`, a pool named `lamps` through
    /// `shadow_lamps(index, position, normal)` with the index of the light's slot. An index that no slot has is lit.
    pub lights: &'a [(&'a str, ShadowSource<'a>)],
}

impl Default for ShadowBindingsDescriptor<'_> {
    fn default() -> Self {
        Self {
            label: None,
            group: 1,
            visibility: wgpu::ShaderStages::FRAGMENT,
            lights: &[],
        }
    }
}

/// A bind group with the maps of a set of lights, and the WGSL that asks them.
///
/// The WGSL has one function per light, `shadow_NAME(position: vec3<f32>, normal: vec3<f32>) -> f32` (for pools
/// `shadow_NAME(index: u32, position: vec3<f32>, normal: vec3<f32>) -> f32`): visibility in [0, 1] of
/// the light from `position` (render space) on a surface with geometric normal `normal` (unit length, on the side that is
/// shaded). Where the map says nothing, beyond its sides or its far plane, it is 1.
///
/// `shadow_geometric_normal(position: vec3<f32>, toward_viewer: vec3<f32>) -> vec3<f32>` is such a normal, from screen-space
/// derivatives, for fragment shaders in uniform control flow. `toward_viewer` is a vector of any length but zero from the surface
/// to the side that is looked at: `camera_position - position`, or the reverse of an orthographic camera's direction. An
/// interpolated shading normal will do too, but errs at silhouettes. Where the camera's projection mirrors does not matter.
///
/// `shadow_view_NAME(position)` (for pools with the index in front) tells which view serves a place, for a tint of cascades or
/// faces: the number of the layer, or the number of layers where none does.
/// The variables `shadow_map_NAME` and `shadow_views_NAME` are the light's own texture (`texture_depth_2d_array`, but see
/// [`ShadowBindings::new`]) and `array<ShadowView, N>`, for engines that want a lookup of their own beside it.
#[derive(Debug)]
pub struct ShadowBindings {
    layout: wgpu::BindGroupLayout,
    bind_group: wgpu::BindGroup,
    group: u32,
    wgsl: String,
}

impl ShadowBindings {
    /// Makes layout, bind group and WGSL. Do this once for a set of lights; per frame there is nothing to update.
    ///
    /// Where the device's shaders cannot gather (OpenGL ES 3.0, WebGL 2), the maps of all filters but
    /// [`Filter::Hardware`](crate::Filter::Hardware) are `texture_2d_array<f32>`, and each gather is four samples: the same
    /// visibilities at up to four times the lookups.
    ///
    /// # Errors
    /// [`BindingsError`] for names that are not WGSL identifiers or not distinct, for sets that exceed the device's limits, and
    /// for a device that is lost, out of memory, or not the lights' own.
    pub fn new(
        device: &wgpu::Device,
        descriptor: &ShadowBindingsDescriptor<'_>,
    ) -> Result<Self, BindingsError> {
        check_names(descriptor.lights)?;
        let samplers = used_samplers(descriptor.lights);
        check_limits(device, descriptor, &samplers)?;
        let access = if samplers.contains(&FilterSampler::Point) {
            TexelAccess::of(device)
        } else {
            TexelAccess::Gathers
        };
        let wgsl = emit::wgsl(descriptor, &samplers, access)?;
        let (layout, bind_group) = capture_device_errors(device, || {
            let layout = create_layout(device, descriptor, &samplers, access);
            let bind_group = create_bind_group(device, descriptor, &samplers, &layout);
            (layout, bind_group)
        })
        .map_err(|refusal| BindingsError::Device {
            object: "the bind group of the lights",
            refusal,
        })?;
        Ok(Self {
            layout,
            bind_group,
            group: descriptor.group,
            wgsl,
        })
    }

    /// Layout for the engine's pipeline layouts, at index [`ShadowBindings::group`].
    pub fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    /// The bind group to set while surfaces are shaded.
    pub fn bind_group(&self) -> &wgpu::BindGroup {
        &self.bind_group
    }

    /// Index of the bind group.
    pub fn group(&self) -> u32 {
        self.group
    }

    /// WGSL for exactly this set, without directives: put it before or after the engine's own.
    pub fn wgsl(&self) -> &str {
        &self.wgsl
    }
}

type Lights<'a> = [(&'a str, ShadowSource<'a>)];

fn check_names(lights: &Lights<'_>) -> Result<(), BindingsError> {
    for (index, (name, _)) in lights.iter().enumerate() {
        let starts = name.starts_with(|c: char| c.is_ascii_lowercase());
        let body = name
            .chars()
            .all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_');
        let ends = name.ends_with(|c: char| c.is_ascii_lowercase());
        let taken = is_taken(name);
        if !(starts && body && ends) || name.contains("__") || taken {
            return Err(BindingsError::Name {
                name: (*name).to_owned(),
            });
        }
        if lights[..index].iter().any(|(other, _)| other == name) {
            return Err(BindingsError::DuplicateName {
                name: (*name).to_owned(),
            });
        }
    }
    Ok(())
}

/// Would what is emitted for a light meet a name of the library's own: of a module, a sampler, or another light's map or views?
fn is_taken(name: &str) -> bool {
    let identifiers =
        ["", "view_", "views_", "map_"].map(|prefix| format!("shadow_{prefix}{name}"));
    let in_modules = shader::MODULES.iter().any(|module| {
        let mut words = module
            .source
            .split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
        words.any(|word| identifiers.iter().any(|identifier| identifier == word))
    });
    in_modules
        || ["point_sampler", "comparison_sampler"].contains(&name)
        || name.starts_with("map_")
        || name.starts_with("view_")
        || name.starts_with("views_")
}

/// Samplers that the set's filters take, in binding order.
fn used_samplers(lights: &Lights<'_>) -> Vec<FilterSampler> {
    [FilterSampler::Comparison, FilterSampler::Point]
        .into_iter()
        .filter(|&sampler| {
            lights
                .iter()
                .any(|(_, source)| source.receiver.sampling.filter.wgsl().1 == sampler)
        })
        .collect()
}

fn check_limits(
    device: &wgpu::Device,
    descriptor: &ShadowBindingsDescriptor<'_>,
    samplers: &[FilterSampler],
) -> Result<(), BindingsError> {
    let limits = device.limits();
    if descriptor.group >= limits.max_bind_groups {
        return Err(BindingsError::Group {
            group: descriptor.group,
            maximum: limits.max_bind_groups,
        });
    }
    let lights = descriptor.lights.len() as u64;
    let sampler_count = samplers.len() as u64;
    let views = descriptor.lights.iter();
    let most_views = views.map(|(_, source)| source.receiver.view_count).max();
    let needs = [
        Need::new(
            "max_sampled_textures_per_shader_stage",
            lights,
            limits.max_sampled_textures_per_shader_stage,
        ),
        Need::new(
            "max_uniform_buffers_per_shader_stage",
            lights,
            limits.max_uniform_buffers_per_shader_stage,
        ),
        Need::new(
            "max_samplers_per_shader_stage",
            sampler_count,
            limits.max_samplers_per_shader_stage,
        ),
        Need::new(
            "max_bindings_per_bind_group",
            2 * lights + sampler_count,
            limits.max_bindings_per_bind_group,
        ),
        Need::new(
            "max_uniform_buffer_binding_size",
            view_uniform_bytes(most_views.unwrap_or(0).into()),
            limits.max_uniform_buffer_binding_size,
        ),
    ];
    match Need::first_unmet(needs) {
        None => Ok(()),
        Some(need) => Err(BindingsError::OverDeviceLimit {
            limit: need.limit,
            needed: need.needed,
            maximum: need.maximum,
        }),
    }
}

/// Bindings are numbered: samplers first, then uniforms and map of each light.
pub(crate) fn views_binding(samplers: &[FilterSampler], light: usize) -> u32 {
    (samplers.len() + 2 * light) as u32
}

/// How a light's map is bound on a device with `access` to texels: for the comparing sampler always as a depth texture.
pub(crate) fn map_access(receiver: &Receiver<'_>, access: TexelAccess) -> TexelAccess {
    match receiver.sampling.filter.wgsl().1 {
        FilterSampler::Comparison => TexelAccess::Gathers,
        FilterSampler::Point => access,
    }
}

fn create_layout(
    device: &wgpu::Device,
    descriptor: &ShadowBindingsDescriptor<'_>,
    samplers: &[FilterSampler],
    access: TexelAccess,
) -> wgpu::BindGroupLayout {
    let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: descriptor.visibility,
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
    for (light, (_, source)) in descriptor.lights.iter().enumerate() {
        let bytes = view_uniform_bytes(source.receiver.view_count.into());
        let views = views_binding(samplers, light);
        entries.push(entry(
            views,
            wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: false,
                min_binding_size: wgpu::BufferSize::new(bytes),
            },
        ));
        let map = map_access(&source.receiver, access).map_binding();
        entries.push(entry(views + 1, map));
    }
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: descriptor.label.or(Some("shadow bindings")),
        entries: &entries,
    })
}

fn create_bind_group(
    device: &wgpu::Device,
    descriptor: &ShadowBindingsDescriptor<'_>,
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
    for (light, (_, source)) in descriptor.lights.iter().enumerate() {
        let views = views_binding(samplers, light);
        entries.push(wgpu::BindGroupEntry {
            binding: views,
            resource: source.receiver.views.as_entire_binding(),
        });
        entries.push(wgpu::BindGroupEntry {
            binding: views + 1,
            resource: wgpu::BindingResource::TextureView(source.receiver.map),
        });
    }
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: descriptor.label.or(Some("shadow bindings")),
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
