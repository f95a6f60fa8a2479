//! Contains the WGSL as data: a table of plain modules without directives, what each of them
//! requires, and their union.
//!
//! All names begin with `shadow_`, `Shadow` or `SHADOW_`, so the texts can be concatenated with
//! those of any engine, in any order, and be loaded unchanged as WESL or naga_oil modules. The
//! sampling functions take texture, sampler and view as arguments. No module in [`MODULES`]
//! declares a binding, except the caster modules and those of whole passes.
//!
//! An engine with its own bind groups composes `["bias_plane", "filter_tent3"]` and calls
//! `shadow_filter_tent3(map, map_sampler, shadow_receiver_plane_directional(view, position, normal))`;
//! `shadow_limited_by_depth(view, position, visibility)` then ends shadows at the cameras'
//! `max_distance`. On devices whose shaders cannot gather (OpenGL ES 3.0, WebGL 2) it names
//! `"texels_by_samples"` beside them and binds the maps as `texture_2d_array<f32>`. On every other
//! backend than OpenGL it may name `"texels_by_offsets"`, which makes the filters cheaper.

use crate::error::BindingsError;

/// Holds one WGSL text of the library.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShaderModule {
    /// Is its name in the table: that of the file under `wgsl/` without its extension.
    pub name: &'static str,
    /// Is the WGSL, which contains no directive.
    pub source: &'static str,
    /// Lists the names of the modules whose declarations it uses.
    pub requires: &'static [&'static str],
    /// Is the name of the module that it replaces in a composition that names it. Both make the
    /// same declarations, for different devices.
    pub replaces: Option<&'static str>,
}

macro_rules! module {
    ($name:literal, $file:literal, [$($requires:literal),*]) => {
        ShaderModule {
            name: $name,
            source: include_str!(concat!("../wgsl/", $file)),
            requires: &[$($requires),*],
            replaces: None,
        }
    };
}

pub(crate) const CASTER: ShaderModule = module!("caster", "caster.wgsl", []);
pub(crate) const CASTER_BUILTIN: ShaderModule =
    module!("caster_builtin", "pass/caster_builtin.wgsl", ["caster"]);
pub(crate) const CASTER_MULTIVIEW: ShaderModule =
    module!("caster_multiview", "caster_multiview.wgsl", []);
pub(crate) const CASTER_BUILTIN_MULTIVIEW: ShaderModule = module!(
    "caster_builtin_multiview",
    "pass/caster_builtin_multiview.wgsl",
    ["caster_multiview"]
);
pub(crate) const FULLSCREEN: ShaderModule = module!("fullscreen", "pass/fullscreen.wgsl", []);
pub(crate) const RECT_COPY: ShaderModule =
    module!("rect_copy", "pass/rect_copy.wgsl", ["fullscreen"]);
pub(crate) const DEBUG_VIEW: ShaderModule = module!(
    "debug_view",
    "pass/debug_view.wgsl",
    ["view", "cube_face", "fullscreen"]
);
pub(crate) const CASCADE_TINT: ShaderModule = module!(
    "cascade_tint",
    "pass/cascade_tint.wgsl",
    ["view", "place", "fullscreen"]
);
pub(crate) const ERROR_METER: ShaderModule = module!("error_meter", "pass/error_meter.wgsl", []);
pub(crate) const GATHER_PROBE: ShaderModule =
    module!("gather_probe", "pass/gather_probe.wgsl", ["fullscreen"]);
const TEXELS_BY_OFFSETS: ShaderModule = ShaderModule {
    replaces: Some("texel_blocks"),
    ..module!(
        "texels_by_offsets",
        "texels_by_offsets.wgsl",
        ["view", "texels"]
    )
};
const TEXELS_BY_SAMPLES: ShaderModule = ShaderModule {
    replaces: Some("texels"),
    ..module!("texels_by_samples", "texels_by_samples.wgsl", ["view"])
};

/// Lists every WGSL text of the library.
pub const MODULES: &[ShaderModule] = &[
    module!("view", "view.wgsl", []),
    module!("place", "place.wgsl", ["view"]),
    module!("raised_plane", "raised_plane.wgsl", ["view", "place"]),
    module!(
        "bias_plane",
        "bias_plane.wgsl",
        ["view", "place", "raised_plane"]
    ),
    module!(
        "bias_normal_offset",
        "bias_normal_offset.wgsl",
        ["view", "place", "raised_plane"]
    ),
    module!("bias_manual", "bias_manual.wgsl", ["view", "place"]),
    module!("texels", "texels.wgsl", ["view"]),
    module!("texel_blocks", "texel_blocks.wgsl", ["view", "texels"]),
    TEXELS_BY_OFFSETS,
    TEXELS_BY_SAMPLES,
    module!("gather", "gather.wgsl", ["view", "texels"]),
    module!(
        "filter_nearest",
        "filter_nearest.wgsl",
        ["view", "texels", "gather"]
    ),
    module!("filter_hardware", "filter_hardware.wgsl", ["view"]),
    module!(
        "filter_box",
        "filter_box.wgsl",
        ["view", "texels", "texel_blocks", "gather"]
    ),
    module!(
        "filter_bilinear",
        "filter_bilinear.wgsl",
        ["view", "texels", "gather"]
    ),
    module!(
        "filter_tent3",
        "filter_tent3.wgsl",
        ["view", "texels", "texel_blocks", "gather"]
    ),
    module!(
        "filter_tent5",
        "filter_tent5.wgsl",
        ["view", "texels", "texel_blocks", "gather"]
    ),
    module!(
        "filter_tent7",
        "filter_tent7.wgsl",
        ["view", "texels", "texel_blocks", "gather"]
    ),
    module!(
        "filter_pcss",
        "filter_pcss.wgsl",
        ["view", "texels", "gather", "filter_tent3"]
    ),
    module!(
        "filter_pcss_rotated",
        "filter_pcss_rotated.wgsl",
        ["view", "texels", "filter_pcss"]
    ),
    module!("filter_direction", "filter_direction.wgsl", ["view"]),
    module!("cube_face", "cube_face.wgsl", []),
    module!("normal", "normal.wgsl", []),
    CASTER,
    CASTER_BUILTIN,
    CASTER_MULTIVIEW,
    CASTER_BUILTIN_MULTIVIEW,
    FULLSCREEN,
    RECT_COPY,
    DEBUG_VIEW,
    CASCADE_TINT,
    ERROR_METER,
    GATHER_PROBE,
];

/// Returns the texts of the named modules and of all modules that they require, each once, in the
/// order of the table. A module that replaces another is included instead of the other.
///
/// # Errors
/// Returns [`BindingsError::UnknownModule`] for a name that is not in [`MODULES`], and
/// [`BindingsError::ConflictingModules`] for a module that goes with one that another of the names
/// replaces: `texels_by_offsets` gathers, and `texels_by_samples` is for devices that cannot.
pub fn compose(names: &[&str]) -> Result<String, BindingsError> {
    let mut wanted = [false; MODULES.len()];
    let mut open: Vec<&str> = names.to_vec();
    while let Some(name) = open.pop() {
        let index = MODULES
            .iter()
            .position(|module| module.name == name)
            .ok_or_else(|| BindingsError::UnknownModule {
                name: name.to_owned(),
            })?;
        if !wanted[index] {
            wanted[index] = true;
            open.extend_from_slice(MODULES[index].requires);
        }
    }
    let chosen = || {
        let with_choice = MODULES.iter().zip(wanted);
        with_choice
            .filter(|(_, wanted)| *wanted)
            .map(|(module, _)| module)
    };
    let replacement = |name| chosen().find(|other| other.replaces == Some(name));
    for module in chosen().filter(|module| module.replaces.is_some()) {
        let mut required = module.requires.iter();
        if let Some(other) = required.find_map(|name| replacement(name)) {
            return Err(BindingsError::ConflictingModules {
                name: module.name,
                other: other.name,
            });
        }
    }
    Ok(chosen()
        .filter(|module| replacement(module.name).is_none())
        .map(|module| module.source)
        .collect())
}
