//! Writes every WGSL text that the library emits into a folder, for other compilers to read: lookups of every kind of
//! light with every filter and bias, of two lights, all passes, and each module with what it requires.
//!
//! `cargo run --example emitted_wgsl -- FOLDER` writes into `target/emitted_wgsl` if no folder is named. Beside each
//! pipeline's WGSL lies the GLSL that wgpu makes of it for WebGL 2, and `index.json` names all files and entry points.

use std::error::Error;
use std::fs;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use example_support::arguments;
use serde_json::{Value, json};
use shadow_backends::{Pipeline, glsl};
use shadow_support::compositions::{self, Composition};
use shadow_support::gpu::{Gpu, GpuRequest};
use wgpu_shadows::shader::{self, MODULES};

/// Writes every WGSL text that the library emits.
#[derive(Parser)]
struct Arguments {
    /// Names the folder.
    #[arg(default_value = "target/emitted_wgsl")]
    folder: PathBuf,
}

fn main() -> ExitCode {
    arguments::run("emitted_wgsl", run)
}

fn run(arguments: Arguments) -> Result<(), Box<dyn Error>> {
    let folder = arguments.folder;
    fs::create_dir_all(&folder)?;
    let write = |name: &str, extension: &str, text: &str| {
        let file = format!("{}.{extension}", name.replace(' ', "-"));
        fs::write(folder.join(&file), text).map(|()| file)
    };
    let mut index = Vec::new();
    for module in MODULES {
        let name = format!("module {}", module.name);
        let file = write(&name, "wgsl", &shader::compose(&[module.name])?)?;
        let is_multiview = module.name.contains("multiview");
        index.push(json!({ "name": name, "wgsl": file, "multiview": is_multiview }));
    }
    let gpu = Gpu::new(&GpuRequest::default())?;
    for composition in compositions::all(&gpu)? {
        let name = &composition.name;
        let file = write(name, "wgsl", &composition.wgsl)?;
        let mut webgl_2 = Value::Null;
        if let Some([vertex, fragment]) = webgl_2_texts(&composition)? {
            let files = [
                write(name, "vert", &vertex)?,
                write(name, "frag", &fragment)?,
            ];
            webgl_2 = json!(files);
        }
        index.push(json!({
            "name": name,
            "wgsl": file,
            "vertex": composition.vertex,
            "fragment": composition.fragment,
            "multiview": composition.is_multiview(),
            "webgl2": webgl_2,
        }));
    }
    let file = folder.join("index.json");
    fs::write(&file, serde_json::to_string_pretty(&index)?)?;
    println!("wrote {} texts, and {}", index.len(), file.display());
    Ok(())
}

/// Returns the vertex and the fragment shader of WebGL 2, where wgpu can make them.
fn webgl_2_texts(composition: &Composition) -> Result<Option<[String; 2]>, Box<dyn Error>> {
    if composition.is_multiview() {
        return Ok(None);
    }
    let Some(Composition {
        wgsl,
        vertex,
        fragment,
        ..
    }) = composition.by_samples()
    else {
        return Ok(None);
    };
    let pipeline = Pipeline::new(&wgsl, vertex, fragment)?;
    let texts = glsl::write(&pipeline, glsl::Device::WEBGL_2)?;
    let mut texts: Vec<_> = texts.into_iter().map(|text| text.source).collect();
    // A pass that draws depth alone has a fragment shader that does nothing, which WebGL wants and wgpu adds.
    if fragment.is_none() {
        texts.push("#version 300 es\nprecision lowp float;\nvoid main() {}\n".to_owned());
    }
    Ok(texts.try_into().ok())
}
