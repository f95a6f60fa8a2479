//! Builds the tutorial's scene.

use example_support::textbook::{
    BIAS_CONSTANT, BIAS_SLOPE, EYE, FIELD_OF_VIEW_RADIANS, TARGET, TOWARD_SUN, parts,
};
use wgpu_shadows::Bias;

use super::{Model, Scene, day};
use crate::settings::SideSettings;
use crate::viewpoint::Viewpoint;

pub fn scene() -> Scene {
    let models = parts()
        .into_iter()
        .map(|(mesh, instance)| Model::solid(mesh, vec![instance]))
        .collect();
    let viewpoint = Viewpoint::new(EYE, TARGET, FIELD_OF_VIEW_RADIANS);
    let textbook = SideSettings {
        bias: Bias::Manual {
            constant: BIAS_CONSTANT,
            slope: BIAS_SLOPE,
        },
        ..SideSettings::textbook(6.5)
    };
    Scene {
        sun_degrees: 0.0,
        extent: 10.0,
        sides: [textbook, SideSettings::library()],
        ..day("textbook", models, viewpoint, TOWARD_SUN)
    }
}
