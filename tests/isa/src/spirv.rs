//! Turns WGSL into the SPIR-V that wgpu gives to the driver.

use naga::back::spv;
use naga::proc::{BoundsCheckPolicies, BoundsCheckPolicy};
use naga::valid::{Capabilities, ValidationFlags, Validator};

use crate::IsaError;

/// Returns the module of `wgsl` and its SPIR-V.
///
/// The options are those of wgpu 30 on a device with robust access to buffers and images: buffers
/// are left to the device, and indices into arrays are limited by the shader.
pub fn write(wgsl: &str) -> Result<(naga::Module, Vec<u32>), IsaError> {
    let module = naga::front::wgsl::parse_str(wgsl)
        .map_err(|error| IsaError::Wgsl(error.emit_to_string(wgsl)))?;
    let info = Validator::new(ValidationFlags::all(), Capabilities::all())
        .validate(&module)
        .map_err(|error| IsaError::Wgsl(error.emit_to_string(wgsl)))?;
    let options = spv::Options {
        lang_version: (1, 6),
        flags: spv::WriterFlags::ADJUST_COORDINATE_SPACE | spv::WriterFlags::CLAMP_FRAG_DEPTH,
        bounds_check_policies: BoundsCheckPolicies {
            index: BoundsCheckPolicy::Restrict,
            buffer: BoundsCheckPolicy::Unchecked,
            image_load: BoundsCheckPolicy::Unchecked,
            binding_array: BoundsCheckPolicy::Unchecked,
        },
        ..Default::default()
    };
    let words = spv::write_vec(&module, &info, &options, None)
        .map_err(|error| IsaError::Wgsl(error.to_string()))?;
    Ok((module, words))
}
