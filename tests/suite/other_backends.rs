//! Tests that everything that the library emits can be written in the languages of DirectX 12, Metal and every version of
//! OpenGL, with the options with which wgpu writes it. No compiler of those reads it here.

use std::sync::OnceLock;

use shadow_backends::glsl::Version;
use shadow_backends::hlsl::ShaderModel;
use shadow_backends::{Pipeline, glsl, hlsl, msl};
use shadow_support::compositions::{self, Composition};

use crate::fixtures::gpu::vulkan;

/// Returns everything that the library emits on a device that can gather.
fn all() -> &'static [Composition] {
    static ALL: OnceLock<Vec<Composition>> = OnceLock::new();
    ALL.get_or_init(|| compositions::all(vulkan()).expect("valid lights"))
}

/// Parses each composition and writes it; a failure names the composition.
fn failures<'a>(
    compositions: impl IntoIterator<Item = &'a Composition>,
    mut write: impl FnMut(&Composition, &Pipeline) -> Result<(), String>,
) -> Vec<String> {
    let mut failures = Vec::new();
    for composition in compositions {
        let outcome = Pipeline::new(&composition.wgsl, composition.vertex, composition.fragment)
            .map_err(|error| error.to_string())
            .and_then(|pipeline| write(composition, &pipeline));
        if let Err(error) = outcome {
            failures.push(format!("{}: {error}", composition.name));
        }
    }
    failures
}

fn report(failures: &[String]) {
    let shown = &failures[..failures.len().min(10)];
    let count = failures.len();
    assert!(
        failures.is_empty(),
        "{count} failures\n{}",
        shown.join("\n")
    );
}

/// The shader model is 5.1 where the old compiler is used, and 6.0 to 6.9 with the new one. Several views in one pass
/// need 6.1.
#[test]
fn hlsl_is_written() {
    let failures = failures(all(), |composition, pipeline| {
        let oldest = if composition.is_multiview() {
            ShaderModel::V6_1
        } else {
            ShaderModel::V5_1
        };
        for model in [oldest, ShaderModel::V6_9] {
            hlsl::write(pipeline, model).map_err(|error| format!("{model:?}: {error}"))?;
        }
        Ok(())
    });
    report(&failures);
}

/// wgpu takes the newest version that the system knows: 1.2 on macOS 10.12, and 4.0 on macOS 26. Several views in one
/// pass need 2.2.
#[test]
fn msl_is_written() {
    let failures = failures(all(), |composition, pipeline| {
        let oldest = if composition.is_multiview() {
            (2, 2)
        } else {
            (1, 2)
        };
        for version in [oldest, (2, 4), (3, 1), (4, 0)] {
            msl::write(pipeline, version).map_err(|error| format!("{version:?}: {error}"))?;
        }
        Ok(())
    });
    report(&failures);
}

/// Lists versions of GLSL, from the oldest with which wgpu has a device to the newest that it uses.
const GLSL: [Version; 7] = [
    Version::Desktop(330),
    Version::Desktop(400),
    Version::Desktop(450),
    glsl::WEBGL_2,
    Version::Embedded {
        version: 300,
        is_webgl: false,
    },
    Version::Embedded {
        version: 310,
        is_webgl: false,
    },
    Version::Embedded {
        version: 320,
        is_webgl: false,
    },
];

/// Passes of several views are left out, which wgpu does not have on OpenGL.
#[test]
fn glsl_is_written() {
    let wanted = || {
        let all = all().iter();
        all.filter(|composition| !composition.is_multiview())
    };
    let by_samples: Vec<_> = wanted().filter_map(Composition::by_samples).collect();
    let by_gathers: Vec<_> = wanted().map(Composition::without_offsets).collect();
    let mut all_failures = Vec::new();
    for version in GLSL {
        let write = |_: &Composition, pipeline: &Pipeline| {
            let texts = glsl::write(pipeline, version);
            let texts = texts.map_err(|error| format!("{version:?}: {error}"))?;
            // The writer leaves it to the driver to refuse this.
            let gathers = texts.iter().any(|text| text.contains("textureGather"));
            if gathers && !glsl::gathers(version) {
                return Err(format!("{version:?} has no gather"));
            }
            if texts
                .iter()
                .any(|text| text.contains("textureGatherOffset"))
            {
                return Err(format!(
                    "{version:?} has no gather of a depth texture with an offset"
                ));
            }
            Ok(())
        };
        all_failures.extend(if glsl::gathers(version) {
            failures(&by_gathers, write)
        } else {
            failures(&by_samples, write)
        });
    }
    report(&all_failures);
}
