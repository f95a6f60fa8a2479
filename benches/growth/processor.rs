//! Measures time and allocations of work on the CPU.

use std::alloc::System;
use std::time::Instant;

use shadow_support::measure::statistics::Spread;
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};

/// Counts what the program allocates.
#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// Holds what one call takes.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    pub microseconds: f64,
    pub allocations: f64,
}

/// Returns medians over `repeats` calls of `work`; `prepare` runs before each and is not counted.
pub fn measure<P, R>(
    repeats: u32,
    mut prepare: impl FnMut() -> P,
    mut work: impl FnMut(&mut P) -> R,
) -> Effort {
    let runs: Vec<(f64, f64)> = (0..repeats)
        .map(|_| {
            let mut prepared = prepare();
            let region = Region::new(ALLOCATOR);
            let start = Instant::now();
            let result = work(&mut prepared);
            let microseconds = start.elapsed().as_secs_f64() * 1e6;
            let change = region.change();
            drop(result);
            let allocations = change.allocations + change.reallocations;
            (microseconds, allocations as f64)
        })
        .collect();
    let efforts = runs.into_iter().map(|(microseconds, allocations)| Effort {
        microseconds,
        allocations,
    });
    median(&efforts.collect::<Vec<_>>())
}

/// Returns the medians of some efforts, NaN if there are none.
pub fn median(efforts: &[Effort]) -> Effort {
    if efforts.is_empty() {
        return Effort {
            microseconds: f64::NAN,
            allocations: f64::NAN,
        };
    }
    Effort {
        microseconds: Spread::of(efforts.iter().map(|effort| effort.microseconds)).median,
        allocations: Spread::of(efforts.iter().map(|effort| effort.allocations)).median,
    }
}
