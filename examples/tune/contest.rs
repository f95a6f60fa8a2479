//! Measures every configuration on one scene.

use std::error::Error;

use shadow_support::measure::configuration::{Configuration, Method};
use shadow_support::measure::floor::Floors;
use shadow_support::measure::parallel;
use shadow_support::measure::prober::Prober;
use shadow_support::measure::subject::{Sample, Subject};
use shadow_support::scene::{Light, Scene};
use wgpu_shadows::{Bias, CascadeLayout, Filter};

use crate::options::Options;

/// Is the number of timed runs of each configuration, each next to one of the tutorial's.
const REPEATS: u32 = 3;

/// Measures every filter with every map size and, for suns, cascade layout; and the tutorial's
/// method.
pub fn measure(
    subject: &Subject<'_>,
    prober: &mut Prober<'_>,
    scene: &Scene,
    options: &Options,
) -> Result<Vec<Sample>, Box<dyn Error>> {
    let configurations = configurations(&scene.light, options.quick);
    let mut stopwatch = subject.stopwatch(prober, if options.quick { 1 } else { REPEATS })?;
    let floors = Floors::default();
    let bar = parallel::bar("configurations", configurations.len());
    let mut samples = Vec::new();
    for configuration in &configurations {
        samples.push(subject.measure(prober, configuration, &floors, Some(&mut stopwatch))?);
        bar.inc(1);
    }
    bar.finish_and_clear();
    Ok(samples)
}

fn configurations(light: &Light, quick: bool) -> Vec<Configuration> {
    let map_sizes: &[u32] = if quick {
        &[1024, 2048, 4096]
    } else {
        &[512, 1024, 2048, 4096]
    };
    let layouts: &[CascadeLayout<'_>] = match light {
        Light::Sun { .. } if quick => &[
            CascadeLayout::Automatic { max_cascades: 4 },
            CascadeLayout::fixed(1),
        ],
        Light::Sun { .. } => &[
            CascadeLayout::Automatic { max_cascades: 2 },
            CascadeLayout::Automatic { max_cascades: 4 },
            CascadeLayout::fixed(1),
            CascadeLayout::fixed(2),
            CascadeLayout::fixed(4),
        ],
        Light::Spot { .. } | Light::Point { .. } => &[CascadeLayout::Automatic { max_cascades: 4 }],
    };
    let mut all = Vec::new();
    for filter in filters(light, quick) {
        for &layout in layouts {
            all.extend(map_sizes.iter().map(|&map_size| Configuration {
                method: Method::Library {
                    filter,
                    bias: Bias::Auto,
                },
                map_size,
                fits_camera: true,
                layout,
            }));
        }
    }
    all.extend(map_sizes.iter().map(|&map_size| Configuration {
        map_size,
        ..Configuration::BASELINE
    }));
    all
}

fn filters(light: &Light, quick: bool) -> Vec<Filter> {
    let mut filters = vec![
        Filter::Hardware,
        Filter::Bilinear { sharpness: 1.0 },
        Filter::default(),
        Filter::Tent5 { sharpness: 4.0 },
    ];
    if !quick {
        filters.extend([
            Filter::Nearest,
            Filter::Box,
            Filter::Bilinear { sharpness: 2.0 },
            Filter::Tent3 { sharpness: 1.0 },
            Filter::Tent5 { sharpness: 1.0 },
            Filter::Tent7 { sharpness: 1.0 },
            Filter::Tent7 { sharpness: 5.0 },
        ]);
    }
    if light.is_soft() {
        let light_size = match *light {
            Light::Sun {
                angular_diameter_radians,
                ..
            } => angular_diameter_radians as f32,
            Light::Spot { radius_world, .. } | Light::Point { radius_world, .. } => radius_world,
        };
        filters.push(Filter::Pcss { light_size });
    }
    filters
}
