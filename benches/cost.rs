//! Measures how the cost of shadows grows with casters, lights, cascades, map size, taps and
//! motion, and compares it with the bare minimum.
//!
//! Run it with `cargo bench --bench cost`. CPU times are those of `ShadowScene::frame` and `record`
//! together, with the allocations made; device times are ratios, run by run, so that they mean the
//! same on every machine. Each table ends with the exponents of its growth.
//!
//! `growth/mod.rs` lists its parts.

use std::process::ExitCode;

use clap::Parser;
use shadow_support::clock::Clock;
use shadow_support::gpu::{Gpu, GpuRequest};

use growth::stage::Stage;
use growth::{card, copies, cpu, device, faces, motion, retained};

mod growth;

/// Measures how the cost of shadows grows.
#[derive(Parser)]
struct Arguments {
    /// Sets the number of repetitions of each measurement, of which the median is reported.
    #[arg(long, default_value_t = 30)]
    repeats: u32,
    /// Sets the largest number of casters.
    #[arg(long, default_value_t = 100_000)]
    casters: u32,
    /// Sets the texels per side of the largest map.
    #[arg(long, default_value_t = 8192)]
    map_size: u32,
    /// Measures the part of this name alone: retained, casters, culling, lights, cascades,
    /// map-sizes, taps, moving-share, static-cache, bare-minimum, copies, yard or faces.
    #[arg(long)]
    only: Option<String>,
    /// Measures for about a minute, and prints the row of this machine for doc/measured_on.md alone.
    #[arg(long)]
    card: bool,
    /// Is passed by `cargo bench`.
    #[arg(long, hide = true)]
    bench: bool,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let mut request = GpuRequest::measuring();
    request.backends = match wgpu::Backends::from_env() {
        Some(backends) => vec![backends],
        None => request.backends,
    };
    let gpu = match Gpu::new(&request) {
        Ok(gpu) => gpu,
        Err(error) => {
            eprintln!("cost: {error}");
            return ExitCode::FAILURE;
        }
    };
    if arguments.card {
        card::row(&Stage {
            clock: Clock::new(&gpu),
            gpu: &gpu,
            repeats: arguments.repeats.max(1),
        });
        return ExitCode::SUCCESS;
    }
    println!("{}", gpu.describe());
    if gpu.is_software() {
        println!("A software rasteriser: device times are ratios of work done on the CPU.");
    }
    let stage = Stage {
        clock: Clock::new(&gpu),
        gpu: &gpu,
        repeats: arguments.repeats.max(1),
    };
    let (casters, map_size) = (arguments.casters, arguments.map_size);
    let parts: [(&str, &dyn Fn()); 13] = [
        ("retained", &|| retained::retained(&stage, casters)),
        ("casters", &|| cpu::casters(&stage, casters)),
        ("culling", &|| cpu::culling(&stage, casters)),
        ("lights", &|| cpu::lights(&stage)),
        ("cascades", &|| device::cascades(&stage)),
        ("map-sizes", &|| device::map_sizes(&stage, map_size)),
        ("taps", &|| device::taps(&stage)),
        ("moving-share", &|| motion::moving_share(&stage)),
        ("static-cache", &|| motion::static_cache(&stage)),
        ("bare-minimum", &|| device::bare_minimum(&stage)),
        ("copies", &|| copies::beside_one_draw(&stage)),
        ("yard", &|| copies::yard(&stage)),
        ("faces", &|| faces::in_one_pass(&stage)),
    ];
    let only = arguments.only.as_deref();
    for (name, measure) in parts {
        if only.is_none_or(|only| only == name) {
            measure();
        }
    }
    ExitCode::SUCCESS
}
