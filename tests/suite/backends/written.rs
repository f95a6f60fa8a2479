//! Tests that naga writes HLSL, Metal's language and GLSL of everything that the library emits, in
//! every version that wgpu asks for. No compiler of those languages reads it here.

use shadow_backends::hlsl::ShaderModel;
use shadow_backends::{Pipeline, glsl, hlsl, msl};
use shadow_support::compositions::Composition;

use crate::suite::backends::{all, failures, report};

/// The shader model is 5.1 where the old compiler is used, and 6.0 to 6.9 with the new one. Several
/// views in one pass need 6.1.
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

/// wgpu takes the newest version that the system knows: 1.2 on macOS 10.12, and 4.0 on macOS 26.
/// Several views in one pass need 2.2.
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

/// Lists the oldest and the newest versions of OpenGL with which wgpu has a device, and those
/// between that can do more.
const DEVICES: [glsl::Device; 9] = [
    glsl::Device::desktop(330, false),
    glsl::Device::desktop(400, true),
    glsl::Device::desktop(450, false),
    glsl::Device::desktop(450, true),
    glsl::Device::WEBGL_2,
    glsl::Device::embedded(300, false),
    glsl::Device::embedded(310, true),
    glsl::Device::embedded(320, false),
    glsl::Device::embedded(320, true),
];

/// Passes of several views are left out, which wgpu does not have on OpenGL.
#[test]
fn glsl_is_written() {
    let wanted = || all().iter().filter(|found| !found.is_multiview());
    let by_samples: Vec<_> = wanted().filter_map(Composition::by_samples).collect();
    let by_gathers: Vec<_> = wanted().map(Composition::without_offsets).collect();
    let mut all_failures = Vec::new();
    for device in DEVICES {
        let write = |_: &Composition, pipeline: &Pipeline| {
            let texts = glsl::write(pipeline, device);
            let texts = texts.map_err(|error| format!("{device:?}: {error}"))?;
            // The writer leaves it to the driver to refuse this.
            let mut sources = texts.iter().map(|text| &text.source);
            if !device.gathers() && sources.any(|source| source.contains("textureGather")) {
                return Err(format!("{device:?} cannot gather"));
            }
            let mut sources = texts.iter().map(|text| &text.source);
            if sources.any(|source| source.contains("textureGatherOffset")) {
                return Err(format!("{device:?} has no such gather of a depth texture"));
            }
            Ok(())
        };
        all_failures.extend(if device.gathers() {
            failures(&by_gathers, write)
        } else {
            failures(&by_samples, write)
        });
    }
    report(&all_failures);
}
