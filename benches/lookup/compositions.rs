//! Lists the shaders that are compiled: every lookup that the library emits, the textbook's, none, and
//! the vertex stages of depth passes.

use std::error::Error;

use shadow_support::gpu::{Gpu, GpuRequest};
use shadow_support::lookup_cost;
use wgpu_shadows::pool::{OmniShadowPool, PoolDescriptor, SpotShadowPool};
use wgpu_shadows::{
    Bias, DirectionalShadow, DirectionalShadowDescriptor, Filter, OmniShadow, OmniShadowDescriptor,
    ShadowBindings, ShadowBindingsDescriptor, ShadowMaps, SpotShadow, SpotShadowDescriptor, shader,
};

/// Is a shader with the entry points that are compiled.
pub struct Composition {
    pub name: String,
    pub wgsl: String,
    pub vertex: &'static str,
    /// Is `None` for a depth pass.
    pub fragment: Option<&'static str>,
}

const FRAME: &str = include_str!("frame.wgsl");
const TEXTBOOK: &str = include_str!("textbook.wgsl");
const TEXTBOOK_CUBE: &str = include_str!("textbook_cube.wgsl");
const NOTHING: &str = "
fn visibility(position: vec3<f32>, normal: vec3<f32>) -> f32 {
    return position.x + normal.x;
}
";

/// Reads the index of a pool's light from a uniform, as in a loop over the lights of a tile.
const POOL_INDEX: &str = "
@group(0) @binding(0) var<uniform> light_index: vec4<u32>;
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
    Kind::Spots,
    Kind::Points,
];

#[derive(Clone, Copy)]
enum Kind {
    Sun(u32),
    Blended(u32),
    Spot { fade: f32 },
    Point { fade: f32 },
    Spots,
    Points,
}

const BIASES: [Bias; 3] = [
    Bias::Auto,
    Bias::NormalOffset,
    Bias::Manual {
        constant: 0.01,
        slope: 0.1,
    },
];

/// Lists the filters of all kinds of light. The sharpness does not change the shader.
const FILTERS: [Filter; 9] = [
    Filter::Nearest,
    Filter::Hardware,
    Filter::Box,
    Filter::Bilinear { sharpness: 1.0 },
    Filter::Tent3 { sharpness: 3.0 },
    Filter::Tent5 { sharpness: 1.0 },
    Filter::Tent7 { sharpness: 1.0 },
    Filter::Pcss { light_size: 0.01 },
    Filter::PcssRotated { light_size: 0.01 },
];

/// Lists the filters that only point lights have.
const DIRECTIONS: [Filter; 2] = [
    Filter::DirectionGrid { radius: 0.1 },
    Filter::DirectionStar { radius: 0.04 },
];

/// Returns all shaders. The library emits its own on a device, which is any that can gather.
pub fn all() -> Result<Vec<Composition>, Box<dyn Error>> {
    let gpu = Gpu::new(&GpuRequest::default())?;
    let mut all = vec![
        lookup("nothing", NOTHING.to_owned()),
        lookup("textbook 3x3", TEXTBOOK.to_owned()),
        lookup("textbook cube", TEXTBOOK_CUBE.to_owned()),
    ];
    for kind in KINDS {
        let directions = match kind {
            Kind::Point { .. } | Kind::Points => &DIRECTIONS[..],
            _ => &[],
        };
        for &filter in FILTERS.iter().chain(directions) {
            for bias in BIASES {
                let name = lookup_cost::composition(&kind.name(), filter, bias);
                all.push(lookup(&name, kind.wgsl(&gpu, filter, bias)?));
            }
        }
    }
    for (module, model, vertex) in [
        (
            "caster_builtin",
            "identity",
            "shadow_caster_vertex_identity",
        ),
        (
            "caster_builtin",
            "instance",
            "shadow_caster_vertex_instance",
        ),
        (
            "caster_builtin_multiview",
            "identity",
            "shadow_caster_vertex_identity",
        ),
        (
            "caster_builtin_multiview",
            "instance",
            "shadow_caster_vertex_instance",
        ),
    ] {
        all.push(Composition {
            name: format!("depth {module} {model}"),
            wgsl: shader::compose(&[module])?,
            vertex,
            fragment: None,
        });
    }
    Ok(all)
}

fn lookup(name: &str, wgsl: String) -> Composition {
    Composition {
        name: name.to_owned(),
        wgsl: wgsl + FRAME,
        vertex: "vertex",
        fragment: Some("fragment"),
    }
}

impl Kind {
    fn name(self) -> String {
        match self {
            Self::Sun(cascades) => format!("sun_{cascades}"),
            Self::Blended(cascades) => format!("sun_{cascades}_blended"),
            Self::Spot { fade } => format!("spot{}", fading(fade)),
            Self::Point { fade } => format!("point{}", fading(fade)),
            Self::Spots => "spot_pool".to_owned(),
            Self::Points => "point_pool".to_owned(),
        }
    }

    /// Returns the WGSL of a light of this kind with a function `visibility`.
    fn wgsl(self, gpu: &Gpu, filter: Filter, bias: Bias) -> Result<String, Box<dyn Error>> {
        let device = &gpu.device;
        // The size of the map does not change the shader.
        let map_size = 16;
        let bindings = |maps: &ShadowMaps| {
            let lights = &[("light", maps)];
            let descriptor = ShadowBindingsDescriptor {
                lights,
                ..Default::default()
            };
            ShadowBindings::new(device, &descriptor).map(|bindings| bindings.wgsl().to_owned())
        };
        let pool = PoolDescriptor {
            capacity: 16,
            map_size,
            filter,
            bias,
            ..Default::default()
        };
        let sun = |cascades, blend| {
            let descriptor = DirectionalShadowDescriptor {
                map_size,
                cascades,
                blend,
                filter,
                bias,
                ..Default::default()
            };
            DirectionalShadow::new(device, &descriptor)
        };
        let (wgsl, index) = match self {
            Self::Sun(cascades) => (bindings(sun(cascades, 0.0)?.maps())?, ""),
            Self::Blended(cascades) => (bindings(sun(cascades, 0.1)?.maps())?, ""),
            Self::Spot { fade } => {
                let descriptor = SpotShadowDescriptor {
                    map_size,
                    filter,
                    bias,
                    fade,
                    ..Default::default()
                };
                let spot = SpotShadow::new(device, &descriptor)?;
                (bindings(spot.maps())?, "")
            }
            Self::Point { fade } => {
                let descriptor = OmniShadowDescriptor {
                    map_size,
                    filter,
                    bias,
                    fade,
                    ..Default::default()
                };
                let point = OmniShadow::new(device, &descriptor)?;
                (bindings(point.maps())?, "")
            }
            Self::Spots => {
                let spots = SpotShadowPool::new(device, &pool)?;
                (bindings(spots.maps())? + POOL_INDEX, "light_index.x, ")
            }
            Self::Points => {
                let points = OmniShadowPool::new(device, &pool)?;
                (bindings(points.maps())? + POOL_INDEX, "light_index.x, ")
            }
        };
        Ok(format!(
            "{wgsl}
fn visibility(position: vec3<f32>, normal: vec3<f32>) -> f32 {{
    return shadow_light({index}position, normal);
}}
"
        ))
    }
}

fn fading(fade: f32) -> &'static str {
    if fade > 0.0 { "_fading" } else { "" }
}
