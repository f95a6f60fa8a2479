//! The table of hard cases: what is expected, what was measured, and on what.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use crate::support::gpu::gpu;

static ROWS: Mutex<BTreeMap<String, [String; 2]>> = Mutex::new(BTreeMap::new());

fn path() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("target/hard_cases.md")
}

/// Adds a row and writes the table as it then is: after the last test it is whole, in whatever order they ran.
pub fn record(case: &str, expectation: &str, measured: String) {
    let mut rows = ROWS.lock().unwrap_or_else(PoisonError::into_inner);
    rows.insert(case.to_owned(), [expectation.to_owned(), measured]);
    let backend = gpu().describe();
    let head = "| case | expectation | measured | on |\n|---|---|---|---|\n".to_owned();
    let text = rows
        .iter()
        .fold(head, |text, (case, [expectation, measured])| {
            text + &format!("| {case} | {expectation} | {measured} | {backend} |\n")
        });
    std::fs::write(path(), text).expect("a writable target directory");
}

/// A recorded case is in the file, once, with the words of its last record.
#[test]
fn the_table_holds_what_was_recorded() {
    let (case, expectation) = ("the table itself", "holds every case once");
    record(case, expectation, "first".to_owned());
    record(case, expectation, "one row".to_owned());
    let _rows = ROWS.lock().unwrap_or_else(PoisonError::into_inner);
    let text = std::fs::read_to_string(path()).expect("a readable file");
    let row = format!(
        "| {case} | {expectation} | one row | {} |",
        gpu().describe()
    );
    assert_eq!(
        text.lines().filter(|line| **line == row).count(),
        1,
        "{text}"
    );
    assert_eq!(text.matches(case).count(), 1, "{text}");
}
