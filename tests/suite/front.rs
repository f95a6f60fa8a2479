//! Tests that the configurations that the library ships are worth their cost: nothing that it can
//! do is both cheaper and closer to the truth.
//!
//! `cargo bench --bench speed_vs_error` measures this in full; here it is measured on small images
//! and with counts alone. The cost is [`shadow_support::technique::Cost::frame_work`], and the
//! error is the root of the mean squared error against rays cast in double precision.

use shadow_support::gpu::{Gpu, GpuRequest};
use shadow_support::measure::configuration::{self, Configuration, Extent};
use shadow_support::measure::floor::Floors;
use shadow_support::measure::overall::{self, Overall};
use shadow_support::measure::pixels::Effort;
use shadow_support::measure::prober::Prober;
use shadow_support::measure::subject::Subject;
use shadow_support::scenes;
use wgpu_shadows::{
    Bias, DirectionalShadowDescriptor, Filter, OmniShadowDescriptor, SpotShadowDescriptor,
};

/// Omits the rings of rays around each pixel, which distinguish errors at edges from others but do
/// not change their sum.
const EFFORT: Effort = Effort {
    picture: [160, 90],
    disc_side: 1,
    ring_rays: 0,
};

/// Measures every filter and map size with the derived bias, fitted to the camera, over all scenes
/// with hard shadows.
fn measured() -> Vec<Overall> {
    let gpu = Gpu::new(&GpuRequest::measuring()).expect("an adapter");
    let mut prober = Prober::new(&gpu);
    let mut configurations = configuration::all(Extent::Full, &[512, 1024, 2048, 4096]);
    configurations
        .retain(|configuration| configuration.fits_camera && configuration.has_derived_bias());
    let mut samples = Vec::new();
    for scene in scenes::all() {
        if scene.light.is_soft() {
            continue;
        }
        let subject = Subject::new(&prober, &scene, &EFFORT).expect("a view of lit surfaces");
        for configuration in &configurations {
            if configuration.suits(&scene.light) {
                let sample = subject.measure(&mut prober, configuration, &Floors::default(), None);
                samples.push(sample.expect("a valid configuration"));
            }
        }
    }
    overall::of(&samples)
}

#[test]
fn presets_are_on_the_pareto_front() {
    let entries = measured();
    // Ten filters suit every light, each with four sizes.
    assert!(entries.len() >= 40, "only {} measured", entries.len());
    for (name, preset) in Configuration::presets() {
        if let Err(blame) = overall::judge(&entries, &preset) {
            panic!("{name}: {blame}");
        }
    }
}

/// The presets have the default's other fields, which is how the configurations are measured.
#[test]
fn presets_differ_from_the_default_in_filter_and_map_size_alone() {
    let default = DirectionalShadowDescriptor::default();
    for preset in [
        DirectionalShadowDescriptor::CHEAP,
        DirectionalShadowDescriptor::ACCURATE,
    ] {
        let like_default = DirectionalShadowDescriptor {
            filter: default.filter,
            map_size: default.map_size,
            ..preset
        };
        assert_eq!(like_default, default);
    }
}

/// Spot lights and the faces of point lights have half the texels per side of a sun's map, which is
/// how the configurations are measured.
#[test]
fn local_lights_default_to_the_filter_and_half_the_map_of_a_sun() {
    let sun = DirectionalShadowDescriptor::default();
    let spot = SpotShadowDescriptor::default();
    let lamp = OmniShadowDescriptor::default();
    let expected: (Filter, Bias, u32) = (sun.filter, sun.bias, sun.map_size / 2);
    assert_eq!((spot.filter, spot.bias, spot.map_size), expected);
    assert_eq!((lamp.filter, lamp.bias, lamp.map_size), expected);
}
