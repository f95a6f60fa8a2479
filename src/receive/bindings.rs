//! Creates one bind group for a set of lights, and the WGSL for exactly that set.

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

/// Describes what a [`ShadowBindings`] is made of.
#[derive(Clone, Copy, Debug)]
pub struct ShadowBindingsDescriptor<'a> {
    /// Labels the bind group and its layout; "shadow bindings" if `None`, the default.
    pub label: wgpu::Label<'a>,
    /// Is the index of the bind group in the engine's pipelines, below the device's
    /// `max_bind_groups`. The default is 1.
    pub group: u32,
    /// Lists the shader stages that call the functions. The default is `FRAGMENT`; add `COMPUTE`
    /// for volumetric light, for example. A pipeline that calls them from a stage missing here
    /// fails validation.
    pub visibility: wgpu::ShaderStages,
    /// Lists the lights by name; the default is none. A light named `sun` is sampled by
    /// `shadow_sun(position, normal)`, and a pool named `lamps` by
    /// `shadow_lamps(index, position, normal)` with the index of the light's slot. For an index
    /// that no slot has, the result is lit. [`BindingsError::Name`] states which names are
    /// permitted.
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

/// Holds a bind group with the maps of a set of lights, and the WGSL that samples them.
///
/// The WGSL has one function per light,
/// `shadow_NAME(position: vec3<f32>, normal: vec3<f32>) -> f32` (for pools
/// `shadow_NAME(index: u32, position: vec3<f32>, normal: vec3<f32>) -> f32`). It returns the
/// visibility in [0, 1] of the light from `position` (render space) on a surface with the geometric
/// normal `normal` (unit length, on the side that is shaded). Where no map covers the position, it
/// returns 1.
///
/// `shadow_geometric_normal(position: vec3<f32>, toward_viewer: vec3<f32>) -> vec3<f32>` returns
/// such a normal, computed from screen-space derivatives, for fragment shaders in uniform control
/// flow. `toward_viewer` is a vector of any length but zero from the surface to the side that is
/// looked at: `camera_position - position`, or the reverse of an orthographic camera's view
/// direction. An interpolated shading normal also works, but fails at silhouettes. The result is
/// the same for projections that mirror.
///
/// `shadow_view_NAME(position)` (for pools with the index as its first argument) returns the layer
/// of the view that covers a position, or the number of layers where none does. It serves to tint
/// cascades or faces.
///
/// The variables `shadow_map_NAME` and `shadow_views_NAME` are the light's texture
/// (`texture_depth_2d_array`, but see [`ShadowBindings::new`]) and its uniforms
/// (`array<ShadowViewUniform, N>`), for engines that add lookups of their own.
#[derive(Debug)]
pub struct ShadowBindings {
    layout: wgpu::BindGroupLayout,
    bind_group: wgpu::BindGroup,
    group: u32,
    wgsl: String,
}

impl ShadowBindings {
    /// Creates layout, bind group and WGSL. This is needed once for a set of lights; frames need no
    /// update.
    ///
    /// Where the device's shaders cannot gather (OpenGL ES 3.0, WebGL 2), the maps of all filters
    /// but [`Filter::Hardware`](crate::Filter::Hardware) are bound as `texture_2d_array<f32>`, and
    /// each gather becomes four samples: visibilities are the same, at up to four times as many
    /// texture instructions.
    ///
    /// # Errors
    /// Returns [`BindingsError`] for names that are not permitted or not distinct, for lights that
    /// exceed the device's limits, for lights of another device, and for a device that is lost or
    /// out of memory.
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

    /// Returns the layout of the bind group. The engine's pipeline layouts need it at index
    /// [`ShadowBindings::group`].
    pub fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    /// Returns the bind group, to be set at index [`ShadowBindings::group`] while surfaces are
    /// shaded.
    pub fn bind_group(&self) -> &wgpu::BindGroup {
        &self.bind_group
    }

    /// Returns the index of the bind group.
    pub fn group(&self) -> u32 {
        self.group
    }

    /// Returns the WGSL for exactly this set of lights. It contains no directives and can be put
    /// before or after the engine's own.
    pub fn wgsl(&self) -> &str {
        &self.wgsl
    }
}

/// Accepts names that can become part of WGSL identifiers and differ from each other.
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

/// Returns whether an identifier that is emitted for a light of this name could coincide with one
/// of the library's own: of a module, a sampler, or the map, views or functions of another light.
fn is_taken(name: &str) -> bool {
    const PREFIXES: [&str; 6] = [
        "view_",
        "views_",
        "map_",
        "place_of_",
        "axes_of_",
        "cascade_",
    ];
    let identifiers = PREFIXES.map(|prefix| format!("shadow_{prefix}{name}"));
    let own = format!("shadow_{name}");
    let in_modules = shader::MODULES.iter().any(|module| {
        let mut words = module
            .source
            .split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
        words.any(|word| word == own || identifiers.iter().any(|identifier| identifier == word))
    });
    in_modules
        || ["point_sampler", "comparison_sampler"].contains(&name)
        || PREFIXES.iter().any(|prefix| name.starts_with(prefix))
}

/// Accepts sets of lights for whose bindings the device's limits suffice.
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
