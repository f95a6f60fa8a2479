//! Emits the WGSL of a set of lights: the modules that they use, the bindings, and the functions of
//! each light.

use crate::error::BindingsError;
use crate::receive::Bias;
use crate::receive::filter::FilterSampler;
use crate::receive::layout::{NamedMaps, map_access, views_binding};
use crate::receive::sampled_maps::{SampledMaps, Selection};
use crate::receive::template;
use crate::receive::texel_access::TexelAccess;
use crate::shader;

/// Returns the WGSL for `lights` in bind group `group`. `samplers` lists the samplers that their
/// filters use, in the order of their bindings. `access` states how shaders of the device read
/// single texels.
pub(crate) fn wgsl(
    group: u32,
    lights: &NamedMaps<'_>,
    samplers: &[FilterSampler],
    access: TexelAccess,
) -> Result<String, BindingsError> {
    let mut text = shader::compose(&modules(lights, samplers, access))?;
    text += &template::Group {
        group: &format!("{group}u"),
    }
    .fill();
    for (binding, sampler) in samplers.iter().enumerate() {
        let (sampler, sampler_type) = sampler_names(*sampler);
        text += &template::Sampler {
            sampler_binding: &binding.to_string(),
            sampler,
            sampler_type,
        }
        .fill();
    }
    for (light, (name, maps)) in lights.iter().enumerate() {
        let views_binding = views_binding(samplers, light);
        text += &template::Bindings {
            views_binding: &views_binding.to_string(),
            map_binding: &(views_binding + 1).to_string(),
            name,
            array_length: &maps.view_count.to_string(),
            map_type: map_access(maps, access).map_wgsl(),
        }
        .fill();
        text += &place_functions(name, maps);
        text += &visibility_function(name, maps);
    }
    Ok(text)
}

/// Returns the names of the modules that the lights' functions call.
fn modules(
    lights: &NamedMaps<'_>,
    samplers: &[FilterSampler],
    access: TexelAccess,
) -> Vec<&'static str> {
    let mut modules = vec!["normal"];
    if samplers.contains(&FilterSampler::Point) {
        modules.extend(access.module());
    }
    for (_, maps) in lights {
        let (sampling, selection) = (maps.sampling, maps.selection);
        modules.push(sampling.filter.wgsl().0);
        modules.push(sampling.bias.scheme(sampling.filter).module());
        if selection == Selection::CubeFace {
            modules.push("cube_face");
            modules.extend(sampling.filter.directions().map(|_| "filter_direction"));
        }
    }
    modules
}

/// Returns the functions that find where a position falls in the light's maps.
fn place_functions(name: &str, maps: &SampledMaps<'_>) -> String {
    let index = index(maps);
    let first_view = &first_view(maps);
    let any_view = &any_view(maps);
    let view_count = &view_count(maps);
    let mut text = match maps.selection {
        Selection::Cascades => cascades(name, index, maps.view_count),
        Selection::OneView => template::OneView {
            name,
            index,
            first_view,
            any_view,
            view_count,
        }
        .fill(),
        Selection::CubeFace => template::CubeFace {
            name,
            index,
            first_view,
            any_view,
            inner_view: if maps.shares_layer { "view" } else { any_view },
            view_count,
        }
        .fill(),
    };
    text += &template::View {
        name,
        index,
        view_count,
    }
    .fill();
    text
}

/// Returns the functions that find where a position falls in `count` cascades, written out from the
/// last to the first.
fn cascades(name: &str, index: &str, count: u32) -> String {
    let mut next = count.saturating_sub(1).to_string();
    let mut text = template::LastCascade { name, next: &next }.fill();
    for cascade in (0..count.saturating_sub(1)).rev() {
        let cascade = cascade.to_string();
        text += &template::Cascade {
            name,
            cascade: &cascade,
            next: &next,
        }
        .fill();
        next = cascade;
    }
    text += &template::Cascades {
        name,
        index,
        cascade: "0",
    }
    .fill();
    text
}

/// Returns the function `shadow_NAME`, which looks up the light's visibility.
fn visibility_function(name: &str, maps: &SampledMaps<'_>) -> String {
    let sampling = maps.sampling;
    let index = index(maps);
    let any_view = &any_view(maps);
    let kind = match maps.selection {
        Selection::Cascades => "directional",
        Selection::OneView | Selection::CubeFace => "local",
    };
    let bias = &format!("{}_{kind}", sampling.bias.scheme(sampling.filter).name());
    let (filter, sampler) = sampling.filter.wgsl();
    let (sampler, _) = sampler_names(sampler);
    let (weight, faded) = match maps.selection {
        Selection::Cascades => ("weight_by_depth", "faded"),
        Selection::OneView | Selection::CubeFace if sampling.fade > 0.0 => {
            ("weight_by_distance", "faded")
        }
        Selection::OneView | Selection::CubeFace => ("not_weighted", "not_faded"),
    };
    let layer = if maps.shares_layer {
        "0u"
    } else {
        "place.layer"
    };
    if let Some((pattern, sample_count)) = sampling.filter.directions() {
        let (surface, normal) = match sampling.bias {
            Bias::Manual { .. } => ("sphere", ""),
            Bias::Auto | Bias::NormalOffset => ("plane", "normal"),
        };
        return template::MeanLookup {
            name,
            index,
            any_view,
            pattern,
            sample_count: &format!("{sample_count}u"),
            sample_count_f32: &format!("{sample_count}.0"),
            surface,
            normal,
            bias,
            filter,
            sampler,
            weight,
            faded,
            layer,
        }
        .fill();
    }
    if sampling.blend > 0.0 && maps.view_count > 1 {
        return template::BlendedLookup {
            name,
            index,
            view_count: &view_count(maps),
            bias,
            filter,
            sampler,
            weight,
            faded,
            layer,
        }
        .fill();
    }
    template::SingleLookup {
        name,
        index,
        any_view,
        bias,
        filter,
        sampler,
        weight,
        faded,
        layer,
    }
    .fill()
}

/// Returns the name of the parameter by which a pool's functions select a light. It is empty for a
/// single light.
fn index(maps: &SampledMaps<'_>) -> &'static str {
    if maps.indexed { "index" } else { "" }
}

/// Returns the number of all views as a WGSL expression.
fn view_count(maps: &SampledMaps<'_>) -> String {
    format!("{}u", maps.view_count)
}

/// Returns the first view of the light as a WGSL expression. For an index that no slot of the pool
/// has, its value is the number of all views. The index is clamped before the multiplication,
/// because not every product fits in 32 bits.
fn first_view(maps: &SampledMaps<'_>) -> String {
    limited_view(maps, maps.view_count / maps.views_per_light)
}

/// Returns a view of the light as a WGSL expression, for reading what all views of the light have
/// in common. For an index that no slot of the pool has, its value is a view of another light.
fn any_view(maps: &SampledMaps<'_>) -> String {
    limited_view(maps, maps.view_count / maps.views_per_light - 1)
}

/// Returns the first view of the light at the pool's index, or of the one at `last_index` where the
/// index is greater.
fn limited_view(maps: &SampledMaps<'_>, last_index: u32) -> String {
    if maps.indexed {
        format!("min(index, {last_index}u) * {}u", maps.views_per_light)
    } else {
        "0u".to_owned()
    }
}

/// Returns the name and the type of a sampler's variable.
fn sampler_names(sampler: FilterSampler) -> (&'static str, &'static str) {
    match sampler {
        FilterSampler::Comparison => ("shadow_comparison_sampler", "sampler_comparison"),
        FilterSampler::Point => ("shadow_point_sampler", "sampler"),
    }
}
