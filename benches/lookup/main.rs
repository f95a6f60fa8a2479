//! Tells what lookups cost on real instruction sets, without a GPU: Mesa's compiler for AMD chips
//! says how many registers, instructions and cycles each comes to.
//!
//! `cargo bench --bench lookup` prints a table, `-- --csv` all of it as CSV. `-- --check` fails
//! where a figure has worsened by more than 3 % against `doc/lookup_cost.csv`, and `-- --update`
//! writes that file. The figures depend on the version of the driver alone, which is that of Debian
//! 12.
//!
//! The compiler's model counts the body of a loop eightfold, so the figures of penumbrae, of
//! filters by direction and of blending cascades compare only with each other.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;
use shadow_isa::Table;

mod compositions;
mod figures;

/// Lists a chip of each instruction set that the driver's version compiles for and that WebGPU runs
/// on: RDNA 2, RDNA 1, RDNA 3, GCN 5 and GCN 4.
const FAMILIES: [&str; 5] = ["NAVI21", "NAVI10", "GFX1100", "VEGA10", "POLARIS10"];

/// Tells what lookups cost on real instruction sets.
#[derive(Parser)]
struct Arguments {
    /// Prints every figure as CSV.
    #[arg(long)]
    csv: bool,
    /// Fails where a figure has worsened against the table in doc/lookup_cost.csv.
    #[arg(long)]
    check: bool,
    /// Writes the table in doc/lookup_cost.csv.
    #[arg(long)]
    update: bool,
    /// Compiles for these chips only.
    #[arg(long = "family", value_name = "NAME", default_values_t = FAMILIES.map(str::to_owned))]
    families: Vec<String>,
    /// Compiles the shaders in a folder under the driver that the environment names.
    #[arg(long, hide = true)]
    compile: Option<PathBuf>,
    /// Is given by cargo.
    #[arg(long, hide = true)]
    bench: bool,
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(code) => code,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> Result<ExitCode, Box<dyn Error>> {
    if let Some(folder) = &arguments.compile {
        figures::print(folder)?;
        return Ok(ExitCode::SUCCESS);
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let compositions = compositions::all()?;
    let folder = root.join("target/lookup");
    let table = figures::of(&compositions, &arguments.families, &folder)?;
    if arguments.csv {
        print!("{}", table.csv());
        eprintln!("compiled by {}", table.driver);
    } else if !arguments.check {
        for family in &arguments.families {
            println!("{}", table.readable(family));
        }
    }
    let path = root.join("doc/lookup_cost.csv");
    if arguments.update {
        fs::write(&path, format!("# {}\n{}", table.driver, table.csv()))?;
        println!("wrote {}", path.display());
    }
    if arguments.check {
        let before = Table::parse(&fs::read_to_string(&path)?)?;
        let worse = table.worse_than(&before);
        if !worse.is_empty() {
            eprint!("{worse}");
            eprintln!("error: cargo bench --bench lookup -- --update accepts it, if that is meant");
            return Ok(ExitCode::FAILURE);
        }
        println!(
            "{} figures are as good as in {}",
            table.rows.len(),
            path.display()
        );
    }
    Ok(ExitCode::SUCCESS)
}
