//! One bind group for a set of lights, and the WGSL for exactly that set.

use crate::error::BindingsError;
use crate::error::DeviceError;
use crate::gpu::{Need, capture_device_errors};
use crate::receive::emit;
use crate::receive::filter::FilterSampler;
use crate::receive::layout::{NamedMaps, create_bind_group, create_layout, used_samplers};
use crate::receive::maps::ShadowMaps;
use crate::receive::texel_access::TexelAccess;
use crate::receive::uniforms::view_uniform_bytes;
use crate::shader;

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
    pub lights: &'a [(&'a str, &'a ShadowMaps)],
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
/// [`ShadowBindings::new`]) and `array<ShadowViewUniform, N>`, for engines that want a lookup of their own beside it.
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
        let lights: Vec<_> = descriptor
            .lights
            .iter()
            .map(|(name, maps)| (*name, maps.sampled()))
            .collect();
        check_names(&lights)?;
        let foreign = |(_, maps): &&(_, &ShadowMaps)| maps.device() != device;
        if let Some((name, _)) = descriptor.lights.iter().find(foreign) {
            return Err(BindingsError::OtherDevice {
                name: (*name).to_owned(),
            });
        }
        let samplers = used_samplers(&lights);
        check_limits(device, descriptor.group, &lights, &samplers)?;
        let access = if samplers.contains(&FilterSampler::Point) {
            TexelAccess::of(device)
        } else {
            TexelAccess::Gathers
        };
        let wgsl = emit::wgsl(descriptor.group, &lights, &samplers, access)?;
        let (layout, bind_group) = capture_device_errors(device, || {
            let (label, visibility) = (descriptor.label, descriptor.visibility);
            let layout = create_layout(device, visibility, label, &lights, &samplers, access);
            let bind_group = create_bind_group(device, label, &lights, &samplers, &layout);
            (layout, bind_group)
        })
        .map_err(|refusal| {
            BindingsError::Device(DeviceError {
                object: "the bind group of the lights",
                refusal,
            })
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

fn check_names(lights: &NamedMaps<'_>) -> Result<(), BindingsError> {
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

fn check_limits(
    device: &wgpu::Device,
    group: u32,
    lights: &NamedMaps<'_>,
    samplers: &[FilterSampler],
) -> Result<(), BindingsError> {
    let limits = device.limits();
    if group >= limits.max_bind_groups {
        return Err(BindingsError::Group {
            group,
            maximum: limits.max_bind_groups,
        });
    }
    let light_count = lights.len() as u64;
    let sampler_count = samplers.len() as u64;
    let most_views = lights.iter().map(|(_, maps)| maps.view_count).max();
    let needs = [
        Need::new(
            "max_sampled_textures_per_shader_stage",
            light_count,
            limits.max_sampled_textures_per_shader_stage,
        ),
        Need::new(
            "max_uniform_buffers_per_shader_stage",
            light_count,
            limits.max_uniform_buffers_per_shader_stage,
        ),
        Need::new(
            "max_samplers_per_shader_stage",
            sampler_count,
            limits.max_samplers_per_shader_stage,
        ),
        Need::new(
            "max_bindings_per_bind_group",
            2 * light_count + sampler_count,
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
