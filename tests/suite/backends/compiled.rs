//! Tests by the Khronos Group's compiler that the texts for DirectX 12 and OpenGL are valid. It
//! reads HLSL and GLSL; what a vendor's compiler makes of them is not tested.

use std::fs;
use std::path::Path;

use shadow_backends::hlsl::ShaderModel;
use shadow_backends::{Pipeline, ShaderStage, Text, glsl, hlsl};
use shadow_support::compositions::Composition;

use crate::suite::backends::{Tool, all, failures, report};

const COMPILER: Tool = Tool {
    program: "glslangValidator",
    package: "glslang-tools",
};

/// Returns whether the vertex stage need not be compiled: those of lookups are all the same.
fn is_known(composition: &Composition, text: &Text) -> bool {
    let first = &all()[0];
    let is_lookup = composition.vertex == first.vertex && composition.name != first.name;
    is_lookup && text.stage == ShaderStage::Vertex
}

/// Returns the name of a stage for the compiler.
fn stage(text: &Text) -> &'static str {
    match text.stage {
        ShaderStage::Vertex => "vert",
        _ => "frag",
    }
}

#[test]
fn hlsl_compiles() {
    if !COMPILER.is_installed() {
        return;
    }
    // The compiler has no index of a view in HLSL.
    let compositions = all().iter().filter(|found| !found.is_multiview());
    let failures = failures(compositions, |composition, pipeline| {
        let texts = hlsl::write(pipeline, ShaderModel::V5_1).map_err(|e| e.to_string())?;
        for text in texts.iter().filter(|text| !is_known(composition, text)) {
            let (stage, entry) = (stage(text), &text.entry);
            let to_nowhere = ["-D", "-V", "-o", "/dev/null"];
            let arguments = ["--stdin", "-S", stage, "-e", entry];
            let arguments = [&to_nowhere[..], &arguments].concat();
            COMPILER.check(&arguments, text.source.as_bytes())?;
        }
        Ok(())
    });
    report(&failures);
}

/// Lists the oldest desktop OpenGL and the newest OpenGL ES, both without the extension that
/// gathers need: Debian 12's compiler does not know it. WebGL 2 is tested in a browser.
const DEVICES: [(&str, glsl::Device); 2] = [
    ("gl-330", glsl::Device::desktop(330, false)),
    ("es-320", glsl::Device::embedded(320, false)),
];

#[test]
fn glsl_compiles() {
    if !COMPILER.is_installed() {
        return;
    }
    let wanted = all().iter().filter(|found| !found.is_multiview());
    let by_samples: Vec<_> = wanted.filter_map(Composition::by_samples).collect();
    let mut all_failures = Vec::new();
    for (device_name, device) in DEVICES {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(device_name);
        fs::create_dir_all(&folder).expect("a folder for the texts");
        let mut files = Vec::new();
        let write = |composition: &Composition, pipeline: &Pipeline| {
            let texts = glsl::write(pipeline, device).map_err(|error| error.to_string())?;
            for text in texts.iter().filter(|text| !is_known(composition, text)) {
                let name = composition.name.replace(' ', "-");
                let file = folder.join(format!("{name}.{}", stage(text)));
                fs::write(&file, &text.source).map_err(|error| error.to_string())?;
                files.push(file.to_string_lossy().into_owned());
            }
            Ok(())
        };
        all_failures.extend(failures(&by_samples, write));
        // The compiler takes longer to start than to read a text. It names the files that it
        // refuses.
        for files in files.chunks(50) {
            let files: Vec<_> = files.iter().map(String::as_str).collect();
            all_failures.extend(COMPILER.check(&files, &[]).err());
        }
    }
    report(&all_failures);
}
