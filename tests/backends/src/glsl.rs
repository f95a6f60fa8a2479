//! Writes GLSL as wgpu's OpenGL backend does (`wgpu-hal/src/gles/device.rs`, `create_shader` and
//! `create_pipeline_layout`).

use naga::back::glsl::{Options, PipelineOptions, Writer, WriterFlags};
use naga::proc::{BoundsCheckPolicies, BoundsCheckPolicy};

pub use naga::back::glsl::Version;

use crate::{Pipeline, Resource, WriteError};

/// Is the version of WebGL 2.
pub const WEBGL_2: Version = Version::Embedded {
    version: 300,
    is_webgl: true,
};

/// Returns whether shaders of this version can gather.
pub fn gathers(version: Version) -> bool {
    match version {
        Version::Desktop(version) => version >= 400,
        Version::Embedded { version, .. } => version >= 310,
    }
}

/// Returns the GLSL of every stage, as for a device with none of the extensions that wgpu asks for,
/// first of the vertex stage.
///
/// # Errors
/// Returns an error where the writer refuses the shader.
pub fn write(pipeline: &Pipeline, version: Version) -> Result<Vec<String>, WriteError> {
    let mut options = Options {
        version,
        writer_flags: WriterFlags::ADJUST_COORDINATE_SPACE | WriterFlags::FORCE_POINT_SIZE,
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
    let loads_are_checked = matches!(version, Version::Desktop(version) if version >= 430);
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
    let stages = pipeline.stages()?;
    let texts = stages.iter().map(|stage| {
        let pipeline_options = PipelineOptions {
            shader_stage: stage.stage,
            entry_point: stage.entry.to_owned(),
            multiview: None,
        };
        let refused = |error| WriteError::refused(stage.entry, &error);
        let mut text = String::new();
        Writer::new(
            &mut text,
            &stage.module,
            &stage.info,
            &options,
            &pipeline_options,
            policies,
        )
        .map_err(refused)?
        .write()
        .map_err(refused)?;
        Ok(text)
    });
    texts.collect()
}
