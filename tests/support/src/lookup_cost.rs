//! Tells what a lookup costs on a real instruction set, from the table that
//! `cargo bench --bench lookup -- --update` writes.
//!
//! The cost is the compiler's inverse throughput on RDNA 2: SIMD cycles per wave of 32 pixels where
//! enough waves run. Its model counts the body of every loop eightfold, so filters that loop are
//! costed by the samples that they take at most.

use std::sync::LazyLock;

use shadow_isa::Table;
use wgpu_shadows::{Bias, CascadeLayout, Filter};

use crate::compositions;
use crate::scene::Light;

/// Is the chip of which costs are told.
pub const FAMILY: &str = "NAVI21";

/// Is the number of pixels of a wave.
const WAVE: f64 = 32.0;

/// Returns the cycles per pixel of a lookup by the library.
pub fn library(light: &Light, layout: CascadeLayout<'_>, filter: Filter, bias: Bias) -> f64 {
    let kind = match light {
        Light::Sun { .. } => format!("sun_{}", most_cascades(layout)),
        Light::Spot { .. } => "spot".to_owned(),
        Light::Point { .. } => "point".to_owned(),
    };
    let cycles = |filter| of(&compositions::name(&kind, filter, bias));
    match filter {
        Filter::DirectionGrid { .. } => 64.0 * cycles(Filter::Nearest),
        Filter::DirectionStar { .. } => 20.0 * cycles(Filter::Nearest),
        // There are 24 blocks of four texels in search of occluders, and 32 of a disk. The tent
        // gathers four blocks where the bilinear filter gathers one, so that a block costs a third
        // of their difference.
        Filter::Pcss { .. } | Filter::PcssRotated { .. } => {
            let tent = cycles(Filter::Tent3 { sharpness: 1.0 });
            let block = (tent - cycles(Filter::Bilinear { sharpness: 1.0 })) / 3.0;
            tent + 56.0 * block
        }
        _ => cycles(filter),
    }
}

/// Returns the cycles per pixel of the textbook's lookup in a flat map.
pub fn textbook_flat() -> f64 {
    of("textbook 3x3")
}

/// Returns the cycles per pixel of the textbook's lookup in a cube map, of so many samples.
pub fn textbook_cube(samples: u32) -> f64 {
    of("textbook cube") * f64::from(samples)
}

/// Returns the cycles per pixel of a shader in the table.
///
/// # Panics
/// Panics for a shader that is not in the table.
fn of(composition: &str) -> f64 {
    static TABLE: LazyLock<Table> = LazyLock::new(|| {
        let text = include_str!("../../../doc/lookup_cost.csv");
        Table::parse(text).unwrap_or_else(|error| panic!("doc/lookup_cost.csv: {error}"))
    });
    let mut rows = TABLE.rows.iter();
    let found = rows.find(|row| row.family == FAMILY && row.composition == composition);
    let Some(row) = found else {
        panic!("doc/lookup_cost.csv has no {composition} on {FAMILY}");
    };
    row.figures.inverse_throughput as f64 / WAVE
}

/// Returns the number of cascades among which a lookup chooses.
pub fn most_cascades(layout: CascadeLayout<'_>) -> u32 {
    match layout {
        CascadeLayout::Automatic { max_cascades } => max_cascades,
        CascadeLayout::Fixed { cascades, .. } => cascades,
        _ => 1,
    }
}
