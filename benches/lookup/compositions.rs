//! Lists the shaders that are compiled: the lookups that the library emits, the textbook's, none,
//! and the vertex stages of depth passes.

use std::error::Error;

use shadow_support::compositions::{self, Composition, Kind, lookup};
use shadow_support::gpu::{Gpu, GpuRequest};

const TEXTBOOK: &str = include_str!("textbook.wgsl");
const TEXTBOOK_CUBE: &str = include_str!("textbook_cube.wgsl");
const NOTHING: &str = "
fn visibility(position: vec3<f32>, normal: vec3<f32>) -> f32 {
    return position.x + normal.x;
}
";

/// Lists the kinds of light.
const KINDS: [Kind; 12] = [
    Kind::Sun(1),
    Kind::Sun(2),
    Kind::Sun(3),
    Kind::Sun(4),
    Kind::Sun(8),
    Kind::Blended(4),
    Kind::Spot { fade: 0.0 },
    Kind::Spot { fade: 0.2 },
    Kind::Point { fade: 0.0 },
    Kind::Point { fade: 0.2 },
    Kind::Spots { fade: 0.0 },
    Kind::Points { fade: 0.0 },
];

/// Returns all shaders. The library emits its own on a device, which is any that can gather.
pub fn all() -> Result<Vec<Composition>, Box<dyn Error>> {
    let gpu = Gpu::new(&GpuRequest::default())?;
    let mut all = vec![
        lookup("nothing", NOTHING.to_owned()),
        lookup("textbook 3x3", TEXTBOOK.to_owned()),
        lookup("textbook cube", TEXTBOOK_CUBE.to_owned()),
    ];
    all.extend(compositions::lookups(&gpu, &KINDS)?);
    all.extend(compositions::depth_passes()?);
    Ok(all)
}
