//! Parses the command line, and prints errors in one line.

use std::error::Error;
use std::process::ExitCode;

use clap::Parser;

/// Parses the command line and runs the example `name` with it. An error is printed in one line.
pub fn run<A: Parser>(
    name: &str,
    example: impl FnOnce(A) -> Result<(), Box<dyn Error>>,
) -> ExitCode {
    let arguments = match A::try_parse() {
        Ok(arguments) => arguments,
        Err(help) if !help.use_stderr() => {
            print!("{help}");
            return ExitCode::SUCCESS;
        }
        Err(error) => {
            let text = error.to_string();
            let line = text.lines().next().unwrap_or("bad arguments");
            eprintln!("{name}: {}", line.trim_start_matches("error: "));
            return ExitCode::FAILURE;
        }
    };
    match example(arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{name}: {error}");
            ExitCode::FAILURE
        }
    }
}
