//! Tests what everything that the library emits becomes on wgpu's backends, with the options with
//! which wgpu writes it. None of these tests depends on the backend of the run.

mod compiled;
mod spirv;
mod written;

use std::io::Write;
use std::process::{Command, Stdio};
use std::sync::OnceLock;

use shadow_backends::Pipeline;
use shadow_support::compositions::{self, Composition};

use crate::fixtures::gpu::vulkan;

/// Returns everything that the library emits on a device that can gather.
fn all() -> &'static [Composition] {
    static ALL: OnceLock<Vec<Composition>> = OnceLock::new();
    ALL.get_or_init(|| compositions::all(vulkan()).expect("valid lights"))
}

/// Parses each composition and checks its pipeline; a failure names the composition.
fn failures<'a>(
    compositions: impl IntoIterator<Item = &'a Composition>,
    mut check: impl FnMut(&Composition, &Pipeline) -> Result<(), String>,
) -> Vec<String> {
    let mut failures = Vec::new();
    for composition in compositions {
        let Composition {
            wgsl,
            vertex,
            fragment,
            ..
        } = composition;
        let outcome = Pipeline::new(wgsl, vertex, *fragment)
            .map_err(|error| error.to_string())
            .and_then(|pipeline| check(composition, &pipeline));
        if let Err(error) = outcome {
            failures.push(format!("{}: {error}", composition.name));
        }
    }
    failures
}

/// Fails with the first failures.
fn report(failures: &[String]) {
    let shown = &failures[..failures.len().min(10)];
    let count = failures.len();
    assert!(
        failures.is_empty(),
        "{count} failures\n{}",
        shown.join("\n")
    );
}

/// Is a program that checks shaders.
struct Tool {
    program: &'static str,
    /// Is the package that holds it, on Debian.
    package: &'static str,
}

impl Tool {
    /// Returns whether the program is installed. Where it is not, that is told, and a run that sets
    /// `SHADOW_SHADER_TOOLS=required` fails.
    fn is_installed(&self) -> bool {
        let is_installed = Command::new(self.program).arg("--version").output().is_ok();
        let required = std::env::var_os("SHADOW_SHADER_TOOLS").is_some_and(|v| v == "required");
        let Self { program, package } = self;
        let told = format!("{program} is not installed (Debian: {package})");
        assert!(is_installed || !required, "{told}");
        if !is_installed {
            // This is written past the harness, which holds back what passing tests print.
            let _ = writeln!(std::io::stderr(), "not checked, since {told}");
        }
        is_installed
    }

    /// Runs the program with `input`, and returns what it says where it fails.
    fn check(&self, arguments: &[&str], input: &[u8]) -> Result<(), String> {
        let mut child = Command::new(self.program)
            .args(arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|error| error.to_string())?;
        // A program that stops reading says why.
        let _ = child.stdin.take().map(|mut stdin| stdin.write_all(input));
        let output = child.wait_with_output().map_err(|e| e.to_string())?;
        if output.status.success() {
            return Ok(());
        }
        let told = [output.stdout, output.stderr].concat();
        Err(String::from_utf8_lossy(&told).trim().to_owned())
    }
}
