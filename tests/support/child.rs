//! Runs tests in processes of their own: a driver that crashes there fails one test, and the run continues.

use std::process::Command;

const MARK: &str = "SHADOW_TEST_CHILD";

/// Runs `body` in a child process, with `variables` in its environment, and returns the count that it returned.
///
/// `test` is the full name of the test that calls this. The child is this same binary, which is told to run that test
/// alone; there the call runs `body`. If the child fails, crashes, or runs nothing, its output is part of the panic
/// message.
pub fn counted(
    test: &str,
    variables: &[(&str, &str)],
    body: impl FnOnce() -> usize,
) -> Option<usize> {
    if std::env::var_os(MARK).is_some() {
        println!("\n{MARK} {}", body());
        return None;
    }
    let binary = std::env::current_exe().expect("the path of the test binary");
    let output = Command::new(binary)
        .args([test, "--exact", "--nocapture", "--test-threads=1"])
        .env(MARK, "1")
        .envs(variables.iter().copied())
        .output()
        .expect("the test binary starts");
    let text = String::from_utf8_lossy(&output.stdout);
    let told = || format!("{text}{}", String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{}\n{}", output.status, told());
    let count = text
        .lines()
        .find_map(|line| line.strip_prefix(MARK)?.trim().parse().ok());
    Some(count.unwrap_or_else(|| panic!("the child ran nothing\n{}", told())))
}
