//! Defines the steps: what each changes in the tutorial's set-up, and what it shows.

use example_support::textbook::{BIAS_CONSTANT, BIAS_SLOPE};
use wgpu_shadows::{Bias, CascadeLayout, DirectionalShadowDescriptor, Filter};

use crate::scene::MapRegion;
use crate::viewpoint::Viewpoint;

/// Is the number of texels per side, as in the tutorial.
const MAP_SIZE: u32 = 1024;

/// Selects what a step draws.
#[derive(Clone, Copy)]
pub enum Show {
    /// Draws the scene, with the library's lookup.
    Scene,
    /// Draws the scene, with a lookup that does not test whether the map covers the position.
    OutOfRangeMistake,
    /// Draws the map itself.
    DepthMap,
}

/// Is one image.
pub struct Step {
    pub file: &'static str,
    /// States what the image shows.
    pub sentence: &'static str,
    pub shadow: DirectionalShadowDescriptor<'static>,
    /// Selects the faces left out of the map.
    pub cull: Option<wgpu::Face>,
    pub region: MapRegion,
    pub viewpoint: Viewpoint,
    pub show: Show,
}

/// Returns a step of the tutorial, hard-edged, with a manual bias.
const fn textbook(file: &'static str, sentence: &'static str, constant: f32, slope: f32) -> Step {
    Step {
        file,
        sentence,
        shadow: DirectionalShadowDescriptor {
            label: Some("textbook"),
            map_size: MAP_SIZE,
            layout: CascadeLayout::fixed(1),
            filter: Filter::Nearest,
            bias: Bias::Manual { constant, slope },
            ..DirectionalShadowDescriptor::CHEAP
        },
        cull: None,
        region: MapRegion::FixedBox,
        viewpoint: Viewpoint::Close,
        show: Show::Scene,
    }
}

/// Returns all steps, in order.
pub fn steps() -> Vec<Step> {
    let slope_bias = |file, sentence| textbook(file, sentence, BIAS_CONSTANT, BIAS_SLOPE);
    let boxed = |step: Step| Step {
        shadow: DirectionalShadowDescriptor {
            filter: Filter::Box,
            ..step.shadow
        },
        ..step
    };
    vec![
        textbook(
            "01-no-bias.png",
            "Acne: each surface is compared with its own depth, rounded to a texel, and half of it loses.",
            0.0,
            0.0,
        ),
        textbook(
            "02-constant-bias.png",
            "A constant bias clears the floor and the tops; the cubes' sides, steep to the light, stay speckled.",
            BIAS_CONSTANT,
            0.0,
        ),
        slope_bias(
            "03-slope-bias.png",
            "A bias that grows with the slope clears the steep sides too.",
        ),
        textbook(
            "04-peter-panning.png",
            "Too much bias: the green cube's shadow begins a step away from its corner, and the small cube has lost its own.",
            1.05,
            0.0,
        ),
        Step {
            cull: Some(wgpu::Face::Front),
            ..textbook(
                "05-front-face-culling.png",
                "Only back faces in the map, and no bias at all: no acne, and the shadows touch their cubes again.",
                0.0,
                0.0,
            )
        },
        Step {
            viewpoint: Viewpoint::Wide,
            show: Show::OutOfRangeMistake,
            ..slope_bias(
                "06-out-of-range-wrong.png",
                "Seen from further back: where the map ends, darkness begins, for nobody asked whether the map reaches that far.",
            )
        },
        Step {
            viewpoint: Viewpoint::Wide,
            ..slope_bias(
                "07-out-of-range-right.png",
                "The same with the question asked: what the map knows nothing of is lit.",
            )
        },
        boxed(slope_bias(
            "08-percentage-closer-filter.png",
            "The mean of 3x3 comparisons: the stairs along the edges become steps of a ninth.",
        )),
        Step {
            show: Show::DepthMap,
            ..boxed(slope_bias(
                "09-depth-map.png",
                "The map itself: dark near the light, white at its far plane.",
            ))
        },
        Step {
            file: "10-derived.png",
            sentence: "The library's own way: a derived bias, its default filter and a map fitted to what the camera sees.",
            shadow: DirectionalShadowDescriptor {
                map_size: MAP_SIZE,
                layout: CascadeLayout::fixed(1),
                ..Default::default()
            },
            cull: None,
            region: MapRegion::Camera,
            viewpoint: Viewpoint::Close,
            show: Show::Scene,
        },
    ]
}
