//! How the cost of shadows grows: with casters, lights, cascades, map size and taps; and beside the bare minimum.
//!
//! `cargo bench --bench cost`. CPU times are those of `record` and of what an engine cannot avoid, with the allocations made;
//! device times are ratios, run by run, so that they mean the same on every machine. Each table ends with the exponents of its
//! growth.
//!
//! ```text
//! support/growth_cpu.rs     casters and lights
//! support/growth_device.rs  cascades, map sizes, taps, and the bare minimum
//! support/cube.rs           a point light's faces in one pass and in a pass each
//! support/growth.rs         tables and exponents
//! support/stage.rs          what they share; crowd.rs: many boxes as casters
//! support/processor.rs      time and allocations on the CPU
//! support/clock.rs          time on the device
//! ```

use std::process::ExitCode;

use clap::Parser;

use support::clock::Clock;
use support::gpu::Gpu;
use support::stage::Stage;
use support::{cube, growth_cpu, growth_device};

#[allow(dead_code, reason = "shared with the other bench, which uses the rest")]
mod support {
    //! What the bench is made of.

    pub mod chart;
    pub mod clock;
    pub mod configuration;
    pub mod crowd;
    pub mod cube;
    pub mod gpu;
    pub mod growth;
    pub mod growth_cpu;
    pub mod growth_device;
    pub mod library;
    pub mod mesh;
    pub mod probe;
    pub mod processor;
    pub mod random;
    pub mod scene;
    pub mod stage;
    pub mod statistics;
    pub mod technique;
    pub mod textbook;
}

/// How the cost of shadows grows.
#[derive(Parser)]
struct Arguments {
    /// Repetitions of each measurement, of which the median counts.
    #[arg(long, default_value_t = 30)]
    repeats: u32,
    /// Most casters.
    #[arg(long, default_value_t = 100_000)]
    casters: u32,
    /// Largest map, texels per side.
    #[arg(long, default_value_t = 8192)]
    map_size: u32,
    /// Passed by `cargo bench`.
    #[arg(long, hide = true)]
    bench: bool,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let gpu = match Gpu::new() {
        Ok(gpu) => gpu,
        Err(error) => {
            eprintln!("cost: {error}");
            return ExitCode::FAILURE;
        }
    };
    println!("{}", gpu.describe());
    if gpu.is_software() {
        println!("A software rasteriser: device times are ratios of work done on the CPU.");
    }
    let stage = Stage {
        clock: Clock::new(&gpu),
        gpu: &gpu,
        repeats: arguments.repeats.max(1),
    };
    growth_cpu::casters(&stage, arguments.casters);
    growth_cpu::lights(&stage);
    growth_device::cascades(&stage);
    growth_device::map_sizes(&stage, arguments.map_size);
    growth_device::taps(&stage);
    growth_device::bare_minimum(&stage);
    cube::faces(&stage);
    ExitCode::SUCCESS
}
