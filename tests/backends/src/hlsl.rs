//! Writes HLSL as wgpu's DirectX 12 backend does (`wgpu-hal/src/dx12/device.rs`, `load_shader` and
//! `create_pipeline_layout`).

use naga::ShaderStage;
use naga::back::hlsl::{
    BindTarget, FragmentEntryPoint, Options, PipelineOptions, SamplerHeapBindTargets,
    SamplerIndexBufferKey, Writer,
};

pub use naga::back::hlsl::ShaderModel;

use crate::{Pipeline, Resource, Text, WriteError};

/// Returns the HLSL of every stage.
///
/// # Errors
/// Returns an error where the writer refuses the shader.
pub fn write(pipeline: &Pipeline, model: ShaderModel) -> Result<Vec<Text>, WriteError> {
    let options = options(pipeline, model);
    let mut texts = Vec::new();
    for stage in pipeline.stages()? {
        // A vertex stage returns what the fragment stage takes, in its order.
        let fragment = match (stage.stage, &pipeline.fragment) {
            (ShaderStage::Vertex, Some(name)) => {
                let found = FragmentEntryPoint::new(&pipeline.module, name);
                Some(found.ok_or_else(|| WriteError::Entry(name.clone()))?)
            }
            _ => None,
        };
        let pipeline_options = PipelineOptions {
            entry_point: Some((stage.stage, stage.entry.to_owned())),
        };
        let mut text = String::new();
        let mut writer = Writer::new(&mut text, &options, &pipeline_options);
        let reflection = writer
            .write(&stage.module, &stage.info, fragment.as_ref())
            .map_err(|error| WriteError::refused(stage.entry, &error))?;
        for name in reflection.entry_point_names {
            texts.push(Text {
                stage: stage.stage,
                entry: name.map_err(|error| WriteError::refused(stage.entry, &error))?,
                source: text.clone(),
            });
        }
    }
    Ok(texts)
}

/// Returns the options of the pipeline's layout: registers are numbered through all groups, and
/// samplers within theirs.
fn options(pipeline: &Pipeline, model: ShaderModel) -> Options {
    let mut constants = target(0);
    let mut views = target(0);
    let mut options = Options {
        shader_model: model,
        fake_missing_bindings: false,
        sampler_heap_target: SamplerHeapBindTargets {
            standard_samplers: target(0),
            comparison_samplers: target(2048),
        },
        ..Options::default()
    };
    let bindings = pipeline.bindings();
    for group in bindings.chunk_by(|(one, _), (other, _)| one.group == other.group) {
        let mut samplers = 0;
        for (binding, resource) in group {
            let bound = match resource {
                Resource::Uniform => next(&mut constants),
                Resource::Texture => next(&mut views),
                Resource::Sampler => {
                    samplers += 1;
                    BindTarget {
                        space: 255,
                        ..target(samplers - 1)
                    }
                }
            };
            options.binding_map.insert(*binding, bound);
        }
        if samplers > 0 {
            let key = SamplerIndexBufferKey {
                group: group[0].0.group,
            };
            options
                .sampler_buffer_binding_map
                .insert(key, next(&mut views));
        }
    }
    options.special_constants_binding = Some(constants);
    options
}

fn target(register: u32) -> BindTarget {
    BindTarget {
        register,
        ..BindTarget::default()
    }
}

/// Returns a register and moves on to the next one.
fn next(register: &mut BindTarget) -> BindTarget {
    let found = *register;
    register.register += 1;
    found
}
