//! Tests the CPU reference of `Filter::Pcss` and `Filter::PcssRotated` against the closed form.

use glam::DVec2;
use wgpu_shadows::Filter;
use wgpu_shadows::reference::{self, DepthLayer, Receiver};

use super::penumbra::{Profile, STEPS, beyond_chord};

/// The CPU reference agrees with the closed form as well, so that a wrong device cannot be hidden
/// by a wrong reference: over an ideal map, with either pattern.
#[test]
fn the_reference_spreads_as_the_closed_form() {
    const SIZE: u32 = 128;
    let depths: Vec<f32> = (0..SIZE * SIZE)
        .map(|texel| if texel % SIZE < SIZE / 2 { 0.875 } else { 0.5 })
        .collect();
    let map = DepthLayer {
        size: SIZE,
        depths: &depths,
    };
    let radius = 20.0;
    let light_size = 1.0;
    for filter in [
        Filter::Pcss { light_size },
        Filter::PcssRotated { light_size },
    ] {
        let mut square = 0.0;
        for step in 0..STEPS {
            let t = Profile::across(step);
            let receiver = Receiver {
                texel: DVec2::new(f64::from(SIZE / 2) + t * radius, 61.3),
                depth: 0.5,
                gradient: DVec2::ZERO,
                penumbra: DVec2::splat(radius / 0.375),
                grid: 0x0003_0007,
                inside: true,
            };
            let seen = reference::visibility(filter, &map, &receiver);
            square += (seen - beyond_chord(t)).powi(2) / STEPS as f64;
        }
        assert!(square.sqrt() <= 0.05, "rmse {}", square.sqrt());
    }
}
