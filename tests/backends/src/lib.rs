//! Writes WGSL in the languages of wgpu's backends, with the options of `wgpu-hal` 30, so that what
//! a backend would refuse is seen on machines that do not have it.
//!
//! ```text
//! spirv.rs   Vulkan
//! hlsl.rs    DirectX 12
//! msl.rs     Metal
//! glsl.rs    OpenGL, OpenGL ES and WebGL 2
//! ```

pub mod glsl;
pub mod hlsl;
pub mod msl;
pub mod spirv;

use std::fmt::Display;

pub use naga::ShaderStage;
use naga::back::pipeline_constants::process_overrides;
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use naga::{Module, TypeInner};

/// States why a shader could not be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WriteError {
    /// The WGSL is not valid.
    #[error("{0}")]
    Wgsl(String),
    /// The text has no such entry point.
    #[error("no entry point {0:?}")]
    Entry(String),
    /// The writer refuses the shader.
    #[error("{entry}: {reason}")]
    Refused {
        /// Is the name of the entry point.
        entry: String,
        /// Is the writer's message.
        reason: String,
    },
}

impl WriteError {
    fn refused(entry: &str, reason: &dyn Display) -> Self {
        Self::Refused {
            entry: entry.to_owned(),
            reason: reason.to_string(),
        }
    }
}

/// Is a valid module with the entry points of a pipeline.
#[derive(Debug)]
pub struct Pipeline {
    module: Module,
    info: ModuleInfo,
    vertex: String,
    fragment: Option<String>,
}

/// Is what a backend's compiler is given for a stage.
#[derive(Clone, Debug)]
pub struct Text {
    /// Is the stage.
    pub stage: ShaderStage,
    /// Is the name of the entry point in the text.
    pub entry: String,
    /// Is the shader.
    pub source: String,
}

/// Is a module that is reduced to one entry point, as backends write it.
struct Stage<'a> {
    module: Module,
    info: ModuleInfo,
    stage: ShaderStage,
    entry: &'a str,
}

impl Pipeline {
    /// Parses `wgsl`. A depth pass has no fragment stage.
    ///
    /// # Errors
    /// Returns an error for WGSL that is not valid.
    pub fn new(wgsl: &str, vertex: &str, fragment: Option<&str>) -> Result<Self, WriteError> {
        let (module, info) = parse(wgsl)?;
        Ok(Self {
            module,
            info,
            vertex: vertex.to_owned(),
            fragment: fragment.map(str::to_owned),
        })
    }

    /// Returns the stages, first the vertex stage.
    fn stages(&self) -> Result<Vec<Stage<'_>>, WriteError> {
        let vertex = (ShaderStage::Vertex, self.vertex.as_str());
        let fragment = self.fragment.as_deref();
        let fragment = fragment.map(|entry| (ShaderStage::Fragment, entry));
        let stages = [vertex].into_iter().chain(fragment);
        let stages = stages.map(|(stage, entry)| {
            let entries = &self.module.entry_points;
            let is_entry = |found: &naga::EntryPoint| found.stage == stage && found.name == entry;
            if !entries.iter().any(is_entry) {
                return Err(WriteError::Entry(entry.to_owned()));
            }
            let reduced = process_overrides(
                &self.module,
                &self.info,
                Some((stage, entry)),
                &Default::default(),
            );
            let (module, info) = reduced.map_err(|error| WriteError::refused(entry, &error))?;
            Ok(Stage {
                module: module.into_owned(),
                info: info.into_owned(),
                stage,
                entry,
            })
        });
        stages.collect()
    }

    /// Returns the bindings in the order of the pipeline's layout.
    fn bindings(&self) -> Vec<(naga::ResourceBinding, Resource)> {
        let variables = self.module.global_variables.iter();
        let bound = variables.filter_map(|(_, variable)| {
            let resource = match &self.module.types[variable.ty].inner {
                TypeInner::Sampler { .. } => Resource::Sampler,
                TypeInner::Image { .. } => Resource::Texture,
                _ => Resource::Uniform,
            };
            Some((variable.binding?, resource))
        });
        let mut bindings: Vec<_> = bound.collect();
        bindings.sort_by_key(|(binding, _)| (binding.group, binding.binding));
        bindings
    }
}

/// Tells what a binding is, as backends number them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Resource {
    Uniform,
    Texture,
    Sampler,
}

/// Parses and validates WGSL.
fn parse(wgsl: &str) -> Result<(Module, ModuleInfo), WriteError> {
    let module = naga::front::wgsl::parse_str(wgsl)
        .map_err(|error| WriteError::Wgsl(error.emit_to_string(wgsl)))?;
    let info = Validator::new(ValidationFlags::all(), Capabilities::all())
        .validate(&module)
        .map_err(|error| WriteError::Wgsl(error.emit_to_string(wgsl)))?;
    Ok((module, info))
}
