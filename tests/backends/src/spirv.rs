//! Writes SPIR-V as wgpu's Vulkan backend does (`wgpu-hal/src/vulkan/adapter.rs`,
//! `device_from_raw`).

use naga::back::spv::{self, Capability};
use naga::proc::{BoundsCheckPolicies, BoundsCheckPolicy};

use crate::{WriteError, parse};

/// Is a Vulkan device as far as it changes what wgpu writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// Has Vulkan 1.3, and robust access to buffers and images: indices into arrays are limited by
    /// the shader, and the rest is left to the device.
    Robust13,
    /// Has Vulkan 1.1 and no robust access: the shader limits everything.
    Plain11,
}

impl Target {
    /// Returns the name of the environment by which SPIR-V's tools know it.
    pub fn environment(self) -> &'static str {
        match self {
            Self::Robust13 => "vulkan1.3",
            Self::Plain11 => "vulkan1.1",
        }
    }
}

/// Lists what wgpu lets shaders use on every device, and on those that draw several views at once.
const CAPABILITIES: [Capability; 8] = [
    Capability::Shader,
    Capability::Matrix,
    Capability::Sampled1D,
    Capability::Image1D,
    Capability::ImageQuery,
    Capability::DerivativeControl,
    Capability::StorageImageExtendedFormats,
    Capability::MultiView,
];

/// Returns the module of `wgsl`, and its SPIR-V with all entry points.
///
/// # Errors
/// Returns an error for WGSL that is not valid, and where SPIR-V cannot be written.
pub fn write(wgsl: &str, target: Target) -> Result<(naga::Module, Vec<u32>), WriteError> {
    let (module, info) = parse(wgsl)?;
    let (lang_version, checked) = match target {
        Target::Robust13 => ((1, 6), BoundsCheckPolicy::Unchecked),
        Target::Plain11 => ((1, 3), BoundsCheckPolicy::Restrict),
    };
    let options = spv::Options {
        lang_version,
        flags: spv::WriterFlags::ADJUST_COORDINATE_SPACE | spv::WriterFlags::CLAMP_FRAG_DEPTH,
        capabilities: Some(CAPABILITIES.into_iter().collect()),
        bounds_check_policies: BoundsCheckPolicies {
            index: BoundsCheckPolicy::Restrict,
            buffer: checked,
            image_load: checked,
            binding_array: BoundsCheckPolicy::Unchecked,
        },
        ..Default::default()
    };
    let words = spv::write_vec(&module, &info, &options, None)
        .map_err(|error| WriteError::refused("all entry points", &error))?;
    Ok((module, words))
}
