//! Writes GLSL as wgpu's OpenGL backend does (`wgpu-hal/src/gles/device.rs`, `create_shader` and
//! `create_pipeline_layout`).

use naga::back::glsl::{Options, PipelineOptions, Writer, WriterFlags};
use naga::proc::{BoundsCheckPolicies, BoundsCheckPolicy};

pub use naga::back::glsl::Version;

use crate::{Pipeline, Resource, Text, WriteError};

/// Is an OpenGL device as far as it changes what wgpu writes.
#[derive(Clone, Copy, Debug)]
pub struct Device {
    /// Is the version of GLSL.
    pub version: Version,
    /// States that the device has `GL_EXT_texture_shadow_lod`.
    pub has_shadow_lod: bool,
}

impl Device {
    /// Is WebGL 2.
    pub const WEBGL_2: Self = Self {
        version: Version::Embedded {
            version: 300,
            is_webgl: true,
        },
        has_shadow_lod: false,
    };

    /// Returns desktop OpenGL of this version of GLSL.
    pub const fn desktop(version: u16, has_shadow_lod: bool) -> Self {
        Self {
            version: Version::Desktop(version),
            has_shadow_lod,
        }
    }

    /// Returns OpenGL ES of this version of GLSL.
    pub const fn embedded(version: u16, has_shadow_lod: bool) -> Self {
        let version = Version::Embedded {
            version,
            is_webgl: false,
        };
        Self {
            version,
            has_shadow_lod,
        }
    }

    /// Returns whether shaders can gather from depth textures. Without the extension, naga 30 gives
    /// the gather arguments that no version of GLSL has, and the driver refuses it.
    pub const fn gathers(self) -> bool {
        let has_gather = match self.version {
            Version::Desktop(version) => version >= 400,
            Version::Embedded { version, .. } => version >= 310,
        };
        has_gather && self.has_shadow_lod
    }
}

/// Returns the GLSL of every stage.
///
/// # Errors
/// Returns an error where the writer refuses the shader.
pub fn write(pipeline: &Pipeline, device: Device) -> Result<Vec<Text>, WriteError> {
    let mut writer_flags = WriterFlags::ADJUST_COORDINATE_SPACE | WriterFlags::FORCE_POINT_SIZE;
    writer_flags.set(WriterFlags::TEXTURE_SHADOW_LOD, device.has_shadow_lod);
    let mut options = Options {
        version: device.version,
        writer_flags,
        ..Options::default()
    };
    let mut counts = [0; 3];
    for (binding, resource) in pipeline.bindings() {
        let count = &mut counts[match resource {
            Resource::Uniform => 0,
            Resource::Texture => 1,
            Resource::Sampler => 2,
        }];
        options.binding_map.insert(binding, *count);
        *count += 1;
    }
    let loads_are_checked = matches!(device.version, Version::Desktop(version) if version >= 430);
    let policies = BoundsCheckPolicies {
        index: BoundsCheckPolicy::Unchecked,
        buffer: BoundsCheckPolicy::Unchecked,
        image_load: if loads_are_checked {
            BoundsCheckPolicy::ReadZeroSkipWrite
        } else {
            BoundsCheckPolicy::Unchecked
        },
        binding_array: BoundsCheckPolicy::Unchecked,
    };
    let mut texts = Vec::new();
    for stage in pipeline.stages()? {
        let pipeline_options = PipelineOptions {
            shader_stage: stage.stage,
            entry_point: stage.entry.to_owned(),
            multiview: None,
        };
        let refused = |error| WriteError::refused(stage.entry, &error);
        let mut source = String::new();
        Writer::new(
            &mut source,
            &stage.module,
            &stage.info,
            &options,
            &pipeline_options,
            policies,
        )
        .and_then(|mut writer| writer.write())
        .map_err(refused)?;
        texts.push(Text {
            stage: stage.stage,
            entry: "main".to_owned(),
            source,
        });
    }
    Ok(texts)
}
