//! Finds which filter, map size and number of cascades suit a scene of your own, measured against
//! ray-traced truth.
//!
//! ```text
//! cargo run --release --example tune -- FILE.glb
//! ```
//! casts rays through the file's triangles in double precision, shadows one of its lights with
//! every configuration, and prints what each costs and how far it errs, the Pareto front of the
//! two, and the descriptor to paste. Table, chart and image go to `target/tune`. Without a file,
//! boxes under a sun are measured.
//!
//! ```text
//! options.rs           the command line
//! subject.rs           the file's triangles, light and camera as a scene to measure
//! contest.rs           every configuration, measured
//! choice.rs            which to take
//! paste.rs             its Rust
//! table.rs             all of them as a table, CSV, chart and image
//! ../support           loads the file
//! ../../tests/support  casts rays, measures, draws charts
//! ```

use example_support::arguments;
use shadow_support::gpu::{Gpu, GpuRequest};
use shadow_support::measure::prober::Prober;
use shadow_support::measure::subject::Subject;

mod choice;
mod contest;
mod options;
mod paste;
mod subject;
mod table;

use std::error::Error;
use std::process::ExitCode;
use std::time::Instant;

use choice::Choice;
use options::Options;

fn main() -> ExitCode {
    arguments::run("tune", run)
}

fn run(options: Options) -> Result<(), Box<dyn Error>> {
    let scene = subject::scene(&options)?;
    // This comes before the long work, so that a wrong folder does not cost it.
    std::fs::create_dir_all(&options.out)
        .map_err(|error| format!("cannot make {}: {error}", options.out.display()))?;
    let gpu = Gpu::new(&GpuRequest::measuring())?;
    println!("{}", gpu.describe());
    let start = Instant::now();
    let mut prober = Prober::new(&gpu);
    let subject = Subject::new(&prober, &scene, &options.effort())?;
    table::print_pixels(&subject, options.picture_size());
    let samples = contest::measure(&subject, &mut prober, &scene, &options)?;
    println!(
        "{} configurations measured in {:.0} s",
        samples.len(),
        start.elapsed().as_secs_f64()
    );
    let choice = Choice::of(&samples, options.work)?;
    let table = table::Table::new(&samples, &choice, &scene.light);
    table.print();
    choice.print(&scene.light);
    table.write(&options.out, &subject, &mut prober)?;
    Ok(())
}
