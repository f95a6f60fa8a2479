//! Lists the shaders of the library as an engine compiles them: every lookup that it emits, with
//! the stages of a pipeline around it, and the passes that it draws itself.

mod kind;

use std::error::Error;

use wgpu_shadows::shader::{self, MODULES};
use wgpu_shadows::{Bias, Filter};

pub use kind::Kind;

use crate::gpu::Gpu;

/// Is a shader with its entry points.
#[derive(Clone, Debug)]
pub struct Composition {
    pub name: String,
    pub wgsl: String,
    pub vertex: &'static str,
    /// Is `None` for a depth pass.
    pub fragment: Option<&'static str>,
}

const STAGES: &str = include_str!("stages.wgsl");

/// Lists the biases.
pub const BIASES: [Bias; 3] = [
    Bias::Auto,
    Bias::NormalOffset,
    Bias::Manual {
        constant: 0.01,
        slope: 0.1,
    },
];

/// Lists the filters that all kinds of light accept in addition to [`Filter::PLANAR`].
const SOFT: [Filter; 2] = [
    Filter::Pcss { light_size: 0.01 },
    Filter::PcssRotated { light_size: 0.01 },
];

/// Lists the filters that only point lights have.
const DIRECTIONS: [Filter; 2] = [
    Filter::DirectionGrid { radius: 0.1 },
    Filter::DirectionStar { radius: 0.04 },
];

/// Returns the filters of a kind of light, with those of point lights if it has a cube. Their
/// parameters do not change the shader.
pub fn filters(has_cube: bool) -> impl Iterator<Item = Filter> {
    let directions = if has_cube { &DIRECTIONS[..] } else { &[] };
    let filters = Filter::PLANAR.iter().chain(&SOFT).chain(directions);
    filters.copied()
}

/// Returns the name of a lookup of a kind of light.
pub fn name(kind: &str, filter: Filter, bias: Bias) -> String {
    let bias = match bias {
        Bias::NormalOffset => " normal_offset",
        Bias::Manual { .. } => " manual",
        _ => "",
    };
    format!("{kind} {}{bias}", filter_name(filter))
}

/// Returns the name of a filter as in those of compositions.
fn filter_name(filter: Filter) -> &'static str {
    match filter {
        Filter::Nearest => "nearest",
        Filter::Hardware => "hardware",
        Filter::Box => "box",
        Filter::Bilinear { .. } => "bilinear",
        Filter::Tent3 { .. } => "tent3",
        Filter::Tent5 { .. } => "tent5",
        Filter::Tent7 { .. } => "tent7",
        Filter::Pcss { .. } => "pcss",
        Filter::PcssRotated { .. } => "pcss_rotated",
        Filter::DirectionGrid { .. } => "grid",
        Filter::DirectionStar { .. } => "star",
        _ => "other",
    }
}

/// Returns the text of `wgsl`, which defines `visibility(position, normal)`, with stages around it.
pub fn lookup(name: &str, wgsl: String) -> Composition {
    Composition {
        name: name.to_owned(),
        wgsl: wgsl + STAGES,
        vertex: "vertex",
        fragment: Some("fragment"),
    }
}

/// Returns the lookup of a single light, for every kind of `kinds` with every filter and bias.
/// `gpu` is any device that can gather.
pub fn lookups(gpu: &Gpu, kinds: &[Kind]) -> Result<Vec<Composition>, Box<dyn Error>> {
    let mut all = Vec::new();
    for &kind in kinds {
        for filter in filters(kind.has_cube()) {
            for bias in BIASES {
                let wgsl = kind::one_light(gpu, kind, (filter, bias))?;
                all.push(lookup(&name(&kind.name(), filter, bias), wgsl));
            }
        }
    }
    Ok(all)
}

/// Returns lookups of two lights in one bind group: a sun and a point light, the latter with every
/// filter and bias, and the former with another one each time.
pub fn pairs(gpu: &Gpu) -> Result<Vec<Composition>, Box<dyn Error>> {
    let samplings =
        |kind: Kind| filters(kind.has_cube()).flat_map(|filter| BIASES.map(|bias| (filter, bias)));
    let sun = Kind::Sun(4);
    let point = Kind::Point { fade: 0.0 };
    let suns: Vec<_> = samplings(sun).collect();
    let mut all = Vec::new();
    for (index, of_point) in samplings(point).enumerate() {
        // The step has no factor in common with the number of suns, so that each has its turn.
        let of_sun = suns[(index * 4 + 5) % suns.len()];
        let sampled = [(sun, of_sun), (point, of_point)];
        let names = sampled.map(|(kind, (filter, bias))| name(&kind.name(), filter, bias));
        all.push(lookup(
            &names.join(" and "),
            kind::two_lights(gpu, sampled)?,
        ));
    }
    Ok(all)
}

/// Returns the built-in vertex stages of casters.
pub fn depth_passes() -> Result<Vec<Composition>, Box<dyn Error>> {
    let mut all = Vec::new();
    for module in ["caster_builtin", "caster_builtin_multiview"] {
        for (model, vertex) in [
            ("identity", "shadow_caster_vertex_identity"),
            ("instance", "shadow_caster_vertex_instance"),
        ] {
            all.push(Composition {
                name: format!("depth {module} {model}"),
                wgsl: shader::compose(&[module])?,
                vertex,
                fragment: None,
            });
        }
    }
    Ok(all)
}

/// Returns the passes that the library draws over a whole viewport.
pub fn fullscreen_passes() -> Result<Vec<Composition>, Box<dyn Error>> {
    let passes = [
        ("debug_view", "shadow_debug_layer"),
        ("debug_view", "shadow_debug_cross"),
        ("cascade_tint", "shadow_tint_fragment"),
        ("gather_probe", "shadow_probe_fragment"),
        ("rect_copy", "shadow_copy_fragment"),
    ];
    let pass = |(module, fragment)| {
        Ok(Composition {
            name: format!("pass {fragment}"),
            wgsl: shader::compose(&[module])?,
            vertex: "shadow_fullscreen_vertex",
            fragment: Some(fragment),
        })
    };
    passes.into_iter().map(pass).collect()
}

/// Returns everything that the library emits on a device that can gather: the lookups of every kind
/// of light and of two lights, the depth passes, and the passes over a whole viewport.
pub fn all(gpu: &Gpu) -> Result<Vec<Composition>, Box<dyn Error>> {
    let mut all = lookups(gpu, &Kind::EVERY)?;
    all.extend(pairs(gpu)?);
    all.extend(depth_passes()?);
    all.extend(fullscreen_passes()?);
    Ok(all)
}

impl Composition {
    /// Returns whether it needs a device that draws several views at once.
    pub fn is_multiview(&self) -> bool {
        self.wgsl.contains("@builtin(view_index)")
    }

    /// Returns whether it needs a device whose shaders can gather.
    pub fn gathers(&self) -> bool {
        self.wgsl.contains("textureGather(")
    }

    /// Returns the lookup as the library emits it for OpenGL, where gathers take no offset.
    pub fn without_offsets(&self) -> Self {
        let source = |name| MODULES.iter().find(|module| module.name == name);
        let mut lookup = self.clone();
        if let (Some(offsets), Some(blocks)) = (source("texels_by_offsets"), source("texel_blocks"))
        {
            lookup.wgsl = lookup.wgsl.replace(offsets.source, blocks.source);
        }
        lookup
    }

    /// Returns the lookup as the library emits it on a device whose shaders cannot gather, or
    /// `None` for one that compares some maps by the sampler and reads the texels of others, and
    /// for the probe.
    pub fn by_samples(&self) -> Option<Self> {
        if !self.gathers() {
            return Some(self.clone());
        }
        let source = |name| MODULES.iter().find(|module| module.name == name);
        let [gathering, sampling] = ["texels", "texels_by_samples"].map(source);
        let (gathering, sampling) = (gathering?.source, sampling?.source);
        if !self.wgsl.contains(gathering) || self.wgsl.contains(": sampler_comparison;") {
            return None;
        }
        let wgsl = self.without_offsets().wgsl.replace(gathering, sampling);
        Some(Self {
            name: format!("{} by_samples", self.name),
            wgsl: wgsl.replace(": texture_depth_2d_array;", ": texture_2d_array<f32>;"),
            ..self.clone()
        })
    }
}
