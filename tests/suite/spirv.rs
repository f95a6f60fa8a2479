//! Tests by `spirv-val` of the Khronos Group that the SPIR-V of everything that the library emits is valid: drivers trust
//! it without a check.

use std::io::Write;
use std::process::{Command, Stdio};

use shadow_backends::spirv::{self, Target};
use shadow_support::compositions;

use crate::fixtures::gpu::vulkan;

const VALIDATOR: &str = "spirv-val";

/// Returns whether the validator is installed. A run that sets `SHADOW_SPIRV_VAL=required` fails without it.
fn is_installed() -> bool {
    let outcome = Command::new(VALIDATOR).arg("--version").output();
    let required = std::env::var_os("SHADOW_SPIRV_VAL").is_some_and(|v| v == "required");
    assert!(
        outcome.is_ok() || !required,
        "{VALIDATOR} is not installed (Debian: spirv-tools)"
    );
    outcome.is_ok()
}

/// Returns what the validator finds in a module.
fn validate(words: &[u32], target: Target) -> Result<(), String> {
    let mut child = Command::new(VALIDATOR)
        .args(["--target-env", target.environment(), "-"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(|error| error.to_string())?;
    // A validator that stops reading says why on its output.
    let input = child.stdin.take();
    let _ = input.map(|mut input| input.write_all(bytemuck::cast_slice(words)));
    let output = child.wait_with_output().map_err(|e| e.to_string())?;
    if output.status.success() {
        return Ok(());
    }
    let told = [output.stdout, output.stderr].concat();
    Err(String::from_utf8_lossy(&told).into_owned())
}

#[test]
fn spirv_is_valid() {
    if !is_installed() {
        // Written past the harness, which would hold it back.
        let told = "not checked: whether SPIR-V is valid, since spirv-val is not installed";
        let _ = writeln!(std::io::stderr(), "{told}");
        return;
    }
    let mut failures = Vec::new();
    for composition in compositions::all(vulkan()).expect("valid lights") {
        for target in [Target::Robust13, Target::Plain11] {
            let checked = spirv::write(&composition.wgsl, target)
                .map_err(|error| error.to_string())
                .and_then(|(_, words)| validate(&words, target));
            if let Err(error) = checked {
                failures.push(format!("{} for {target:?}: {error}", composition.name));
            }
        }
    }
    let shown = &failures[..failures.len().min(10)];
    assert!(failures.is_empty(), "{}", shown.join("\n"));
}
