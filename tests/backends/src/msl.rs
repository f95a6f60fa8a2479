//! Writes Metal's shading language as wgpu's Metal backend does (`wgpu-hal/src/metal/device.rs`,
//! `load_shader` and `create_pipeline_layout`).

use naga::back::msl::{
    AttributeMapping, BindSamplerTarget, BindTarget, EntryPointResourceMap, EntryPointResources,
    Options, PipelineOptions, Slot, VertexBufferMapping, VertexBufferStepMode, write_string,
};
use naga::proc::{BoundsCheckPolicies, BoundsCheckPolicy};
use naga::{Binding, ShaderStage, TypeInner, VectorSize};
use wgpu::VertexFormat;

use crate::{Pipeline, Resource, Stage, Text, WriteError};

/// Is the number of buffer slots; vertex buffers take the last of them.
const BUFFERS: u32 = 31;

/// Returns the text of every stage in a version of the language.
///
/// # Errors
/// Returns an error where the writer refuses the shader.
pub fn write(pipeline: &Pipeline, version: (u8, u8)) -> Result<Vec<Text>, WriteError> {
    let mut texts = Vec::new();
    for stage in pipeline.stages()? {
        let options = Options {
            lang_version: version,
            fake_missing_bindings: false,
            per_entry_point_map: EntryPointResourceMap::from([(
                stage.entry.to_owned(),
                resources(pipeline, &stage),
            )]),
            bounds_check_policies: BoundsCheckPolicies {
                index: BoundsCheckPolicy::Restrict,
                buffer: BoundsCheckPolicy::Restrict,
                image_load: BoundsCheckPolicy::Restrict,
                binding_array: BoundsCheckPolicy::Unchecked,
            },
            ..Options::default()
        };
        let pipeline_options = PipelineOptions {
            entry_point: Some((stage.stage, stage.entry.to_owned())),
            allow_and_force_point_size: false,
            vertex_pulling_transform: true,
            vertex_buffer_mappings: vec![vertex_buffer(&stage)],
            ..PipelineOptions::default()
        };
        let (text, info) = write_string(&stage.module, &stage.info, &options, &pipeline_options)
            .map_err(|error| WriteError::refused(stage.entry, &error))?;
        for name in info.entry_point_names {
            texts.push(Text {
                stage: stage.stage,
                entry: name.map_err(|error| WriteError::refused(stage.entry, &error))?,
                source: text.clone(),
            });
        }
    }
    Ok(texts)
}

/// Returns the slots of the pipeline's layout, which every binding has in every stage.
fn resources(pipeline: &Pipeline, stage: &Stage<'_>) -> EntryPointResources {
    let mut resources = EntryPointResources::default();
    let (mut buffers, mut textures, mut samplers): (Slot, Slot, Slot) = (0, 0, 0);
    let next = |counter: &mut Slot| {
        *counter += 1;
        Some(*counter - 1)
    };
    for (binding, resource) in pipeline.bindings() {
        let mut target = BindTarget::default();
        match resource {
            Resource::Uniform => target.buffer = next(&mut buffers),
            Resource::Texture => target.texture = next(&mut textures),
            Resource::Sampler => {
                target.sampler = next(&mut samplers).map(BindSamplerTarget::Resource);
            }
        }
        resources.resources.insert(binding, target);
    }
    if stage.stage == ShaderStage::Vertex {
        resources.sizes_buffer = Some(buffers);
    }
    resources
}

/// Returns a buffer that interleaves all attributes of a vertex stage.
fn vertex_buffer(stage: &Stage<'_>) -> VertexBufferMapping {
    let entries = stage.module.entry_points.iter();
    let arguments = entries.flat_map(|entry| &entry.function.arguments);
    let attributes = arguments.filter_map(|argument| {
        let Some(Binding::Location { location, .. }) = argument.binding else {
            return None;
        };
        let format = match stage.module.types[argument.ty].inner {
            TypeInner::Vector {
                size: VectorSize::Tri,
                ..
            } => VertexFormat::Float32x3,
            _ => VertexFormat::Float32x4,
        };
        Some(AttributeMapping {
            shader_location: location,
            offset: 16 * location,
            format,
        })
    });
    VertexBufferMapping {
        id: BUFFERS - 1,
        stride: 256,
        step_mode: VertexBufferStepMode::ByVertex,
        attributes: attributes.collect(),
    }
}
