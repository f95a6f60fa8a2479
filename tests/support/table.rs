//! Compares the table of hard cases, `doc/hard_cases.md`, with what the suite measured: the table states what is
//! expected, and what was measured on each backend.
//!
//! Every row is compared as its test measures it, so it holds for runs of a single test and in whatever order tests
//! run. The words must be the same; figures may differ by a factor of 1.5 or by two in their last digit, since other
//! processors and driver versions round differently. On adapters that are not software, only cases and expectations are
//! compared, and so where the number of inputs is not that of the default run. `SHADOW_HARD_CASES=update` writes the
//! table instead, one backend's column per run.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use crate::support::figures::agree;
use crate::support::gpu::{Gpu, gpu};

/// Lists the headings, each with the test files whose cases are below it.
const TOPICS: [(&str, &[&str]); 8] = [
    ("Lit surfaces", &["self_shadow", "light_axes", "creases"]),
    ("Contact", &["contact", "wall_foot", "layers"]),
    (
        "Casters",
        &[
            "thin_casters",
            "meshes",
            "engine_wgsl",
            "near_plane",
            "grounds",
        ],
    ),
    (
        "Spot and point lights",
        &[
            "spot",
            "omni",
            "omni_input",
            "near_lights",
            "endless_lamps",
            "giant_grounds",
            "local_reach",
            "seam_edges",
            "penumbra",
        ],
    ),
    (
        "Size, place and motion",
        &[
            "depth_rounding",
            "depth_steps",
            "far_away",
            "far_lamps",
            "scales",
            "fit_images",
            "cascades",
            "steady",
            "moving_casters",
        ],
    ),
    ("Borders of maps", &["out_of_range", "borders"]),
    (
        "Cameras, bounds and numbers",
        &[
            "extreme_cameras",
            "degenerate",
            "fuzz",
            "fuzz_reference",
            "fuzz_untidy",
            "fuzz_untidy_lamps",
            "fuzz_values",
        ],
    ),
    ("Devices", &["device_loss", "long_run"]),
];

const INTRODUCTION: &str = "# Hard cases

Scenes and inputs that break shadow maps, what this crate promises for each, and what its test suite measured. The suite renders
every one of them on two software drivers, and fails where a promise is broken or where this table no longer says what was
measured: `cargo test`, and `SHADOW_TEST_BACKEND=gl cargo test --test suite`. With `SHADOW_HARD_CASES=update` it rewrites the table.
Random inputs have fixed seeds; `PROPTEST_CASES=10000 cargo test --test suite hard_cases::fuzz` runs ten thousand of each kind.

A *settled* receiver is one whose truth, by rays in double precision, is the same for three texels around. `u` is 2^-24, the
rounding of f32; `N` the texels per side of the map; `P` the distance from the render origin. The scenes are a few metres in size
where no unit is named.
";

const ABSENT: &str = "-";

static FILE: Mutex<()> = Mutex::new(());

#[derive(Clone, Debug, PartialEq)]
struct Row {
    topic: usize,
    case: String,
    expectation: String,
    /// Holds what was measured on Vulkan and on OpenGL.
    measured: [String; 2],
}

#[derive(Default)]
struct Table {
    /// Names the machine on which each column was measured.
    machines: [String; 2],
    rows: Vec<Row>,
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn path() -> PathBuf {
    root().join("doc/hard_cases.md")
}

fn is_update() -> bool {
    std::env::var("SHADOW_HARD_CASES").as_deref() == Ok("update")
}

/// Returns whether this run has another number of inputs, other seeds or more frames than the run of the table.
fn is_another_run() -> bool {
    ["PROPTEST_CASES", "PROPTEST_RNG_SEED", "SHADOW_LONG"]
        .iter()
        .any(|name| std::env::var_os(name).is_some())
}

fn column(gpu: &Gpu) -> usize {
    usize::from(gpu.adapter.backend == wgpu::Backend::Gl)
}

impl Table {
    fn read() -> Self {
        let text = std::fs::read_to_string(path()).unwrap_or_default();
        Self::parse(&text)
    }

    fn parse(text: &str) -> Self {
        let mut table = Self::default();
        let mut topic = 0;
        for line in text.lines() {
            if let Some(heading) = line.strip_prefix("## ") {
                topic = TOPICS
                    .iter()
                    .position(|(name, _)| *name == heading)
                    .unwrap_or(0);
            } else if let Some(machine) = line.strip_prefix("- Vulkan: ") {
                machine.clone_into(&mut table.machines[0]);
            } else if let Some(machine) = line.strip_prefix("- OpenGL: ") {
                machine.clone_into(&mut table.machines[1]);
            } else if let Some(row) = line.strip_prefix("| ").and_then(|l| l.strip_suffix(" |")) {
                let cells: Vec<_> = row.split(" | ").map(str::to_owned).collect();
                if let Ok([case, expectation, vulkan, opengl]) = <[String; 4]>::try_from(cells) {
                    if case != "case" {
                        table.rows.push(Row {
                            topic,
                            case,
                            expectation,
                            measured: [vulkan, opengl],
                        });
                    }
                }
            }
        }
        table
    }

    fn text(&self) -> String {
        let [vulkan, opengl] = &self.machines;
        let mut text = format!("{INTRODUCTION}\n- Vulkan: {vulkan}\n- OpenGL: {opengl}\n");
        for (topic, (name, _)) in TOPICS.iter().enumerate() {
            let rows = self.rows.iter().filter(|row| row.topic == topic);
            let lines: Vec<_> = rows
                .map(|row| {
                    let [vulkan, opengl] = &row.measured;
                    format!(
                        "| {} | {} | {vulkan} | {opengl} |\n",
                        row.case, row.expectation
                    )
                })
                .collect();
            if !lines.is_empty() {
                text += &format!("\n## {name}\n\n");
                text += "| case | expectation | measured on Vulkan | measured on OpenGL |\n|---|---|---|---|\n";
                text += &lines.concat();
            }
        }
        text
    }

    /// Replaces a row's cells, and keeps those of the other backend.
    fn put(&mut self, topic: usize, case: &str, expectation: &str, column: usize, measured: &str) {
        let old = self.rows.iter().position(|row| row.case == case);
        let mut row = match old {
            Some(index) => self.rows.remove(index),
            None => Row {
                topic,
                case: case.to_owned(),
                expectation: String::new(),
                measured: [ABSENT, ABSENT].map(str::to_owned),
            },
        };
        row.topic = topic;
        expectation.clone_into(&mut row.expectation);
        measured.clone_into(&mut row.measured[column]);
        self.rows.push(row);
        self.rows.sort_by(|a, b| a.case.cmp(&b.case));
    }

    /// Returns why the table differs from what was measured, if it does.
    fn fault(
        &self,
        case: &str,
        expectation: &str,
        measured: Option<(usize, &str)>,
    ) -> Option<String> {
        let Some(row) = self.rows.iter().find(|row| row.case == case) else {
            return Some(format!("no row {case:?}"));
        };
        if row.expectation != expectation {
            return Some(format!(
                "{case:?} is expected to be {:?} there, and {expectation:?} in the test",
                row.expectation
            ));
        }
        let (column, measured) = measured?;
        let written = &row.measured[column];
        (!agree(written, measured))
            .then(|| format!("{case:?}: {written:?} there, measured {measured:?}"))
    }
}

/// Compares what a test has measured with its row of the table, or writes it there. Tests call it last, so that the
/// table never contains unexpected results. The case is a literal that one test only names.
#[track_caller]
pub fn record(case: &str, expectation: &str, measured: impl AsRef<str>) {
    let measured = measured.as_ref();
    for cell in [case, expectation, measured] {
        assert!(!cell.contains(['|', '\n']), "a cell of a table: {cell:?}");
    }
    let file = Path::new(std::panic::Location::caller().file());
    let stem = file
        .file_stem()
        .and_then(|stem| stem.to_str())
        .expect("a file with a name");
    let topic = TOPICS.iter().position(|(_, files)| files.contains(&stem));
    let topic = topic.unwrap_or_else(|| panic!("{stem} has no heading"));
    let gpu = gpu();
    let comparable = gpu.adapter.device_type == wgpu::DeviceType::Cpu && !is_another_run();
    let column = column(gpu);
    let fault = {
        let _turn = FILE.lock().unwrap_or_else(PoisonError::into_inner);
        let mut table = Table::read();
        if is_update() {
            assert!(
                comparable,
                "the table is of the default run on software adapters"
            );
            let info = &gpu.adapter;
            table.machines[column] = format!("{} {}", info.name, info.driver_info)
                .trim()
                .to_owned();
            table.put(topic, case, expectation, column, measured);
            std::fs::write(path(), table.text()).expect("a writable table");
        }
        table.fault(case, expectation, comparable.then_some((column, measured)))
    };
    if let Some(fault) = fault {
        panic!(
            "doc/hard_cases.md has {fault}\nSHADOW_HARD_CASES=update accepts it (on {})",
            gpu.describe()
        );
    }
}

/// Every case of the table is recorded by one test, and no row is left from a case that was removed. (It reads the
/// tests' sources, since a run may include only a few of them.)
#[test]
fn every_row_has_its_test() {
    fn sources(folder: &Path, found: &mut Vec<(PathBuf, String)>) {
        for entry in std::fs::read_dir(folder).expect("a readable folder") {
            let path = entry.expect("a readable entry").path();
            if path.is_dir() {
                sources(&path, found);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let text = std::fs::read_to_string(&path).expect("a readable file");
                found.push((path, text));
            }
        }
    }
    let mut found = Vec::new();
    sources(&root().join("tests/suite"), &mut found);
    let tests_of = |case: &str| {
        let literal = format!("\"{case}\"");
        found
            .iter()
            .map(|(_, text)| text.matches(&literal).count())
            .sum::<usize>()
    };
    let _turn = FILE.lock().unwrap_or_else(PoisonError::into_inner);
    let mut table = Table::read();
    if is_update() {
        table.rows.retain(|row| tests_of(&row.case) > 0);
        std::fs::write(path(), table.text()).expect("a writable table");
    }
    for row in &table.rows {
        assert_eq!(tests_of(&row.case), 1, "tests that record {:?}", row.case);
    }
    let cases: BTreeSet<_> = table.rows.iter().map(|row| &row.case).collect();
    assert_eq!(cases.len(), table.rows.len(), "each case once");
    if !is_update() {
        let text = std::fs::read_to_string(path()).expect("doc/hard_cases.md");
        assert_eq!(text, table.text(), "doc/hard_cases.md is as it was written");
    }
}

/// What is written can be read again, and differences from what was measured are found.
#[test]
fn the_table_keeps_what_it_is_given() {
    let mut table = Table::default();
    table.put(1, "b", "holds", 0, "4 of 9");
    table.put(0, "a", "holds", 1, "x");
    table.put(1, "b", "holds still", 1, "5 of 9");
    let again = Table::parse(&table.text());
    assert_eq!(again.rows, table.rows);
    assert_eq!(again.rows[1].measured, ["4 of 9", "5 of 9"]);
    assert_eq!(again.fault("b", "holds still", Some((0, "4 of 9"))), None);
    assert_eq!(again.fault("b", "holds still", None), None);
    assert!(again.fault("b", "holds", None).is_some());
    assert!(
        again
            .fault("b", "holds still", Some((0, "9 of 9")))
            .is_some()
    );
    assert!(
        again.fault("a", "holds", Some((0, "x"))).is_some(),
        "never measured there"
    );
    assert!(again.fault("c", "holds", None).is_some());
}
