//! Tests by the Khronos Group's validator that the SPIR-V is valid: drivers trust it without a
//! check.

use shadow_backends::spirv::{self, Target};

use crate::suite::backends::{Tool, all, report};

const VALIDATOR: Tool = Tool {
    program: "spirv-val",
    package: "spirv-tools",
};

#[test]
fn spirv_is_valid() {
    if !VALIDATOR.is_installed() {
        return;
    }
    let mut failures = Vec::new();
    for composition in all() {
        for target in [Target::Robust13, Target::Plain11] {
            let arguments = ["--target-env", target.environment(), "-"];
            let checked = spirv::write(&composition.wgsl, target)
                .map_err(|error| error.to_string())
                .and_then(|(_, words)| VALIDATOR.check(&arguments, bytemuck::cast_slice(&words)));
            if let Err(error) = checked {
                failures.push(format!("{} for {target:?}: {error}", composition.name));
            }
        }
    }
    report(&failures);
}
