//! The WGSL of a set of lights: the modules in use, the group's number, the bindings, and one function per light.

use std::fmt::Write;

use crate::error::BindingsError;
use crate::receive::Bias;
use crate::receive::filter::FilterSampler;
use crate::receive::layout::{NamedMaps, map_access, views_binding};
use crate::receive::sampled_maps::{SampledMaps, Selection};
use crate::receive::texel_access::TexelAccess;
use crate::shader;

/// Returns the text for `lights` in bind group `group`, whose filters take `samplers`, on a device with `access` to texels.
pub(crate) fn wgsl(
    group: u32,
    lights: &NamedMaps<'_>,
    samplers: &[FilterSampler],
    access: TexelAccess,
) -> Result<String, BindingsError> {
    let mut modules = vec!["normal"];
    if samplers.contains(&FilterSampler::Point) {
        modules.extend(access.module());
    }
    for (_, maps) in lights {
        let SampledMaps {
            sampling,
            selection,
            ..
        } = *maps;
        modules.push(sampling.filter.wgsl().0);
        modules.push(sampling.bias.scheme(sampling.filter).module());
        if selection == Selection::CubeFace {
            modules.push("cube_face");
            modules.extend(sampling.filter.directions().map(|_| "filter_direction"));
        }
    }
    let mut text = shader::compose(&modules)?;
    // Writing to a String does not fail.
    let _ = writeln!(text, "\nconst SHADOW_GROUP: u32 = {}u;", group);
    for (binding, sampler) in samplers.iter().enumerate() {
        let (name, ty) = sampler_names(*sampler);
        let _ = writeln!(
            text,
            "@group(SHADOW_GROUP) @binding({binding}) var {name}: {ty};"
        );
    }
    for (light, (name, maps)) in lights.iter().enumerate() {
        let binding = views_binding(samplers, light);
        text += &light_wgsl(name, maps, binding, access);
    }
    Ok(text)
}

/// Bindings and functions of one light.
fn light_wgsl(name: &str, maps: &SampledMaps<'_>, binding: u32, access: TexelAccess) -> String {
    let count = maps.view_count;
    let (parameter, argument) = if maps.indexed {
        ("index: u32, ", "index, ")
    } else {
        ("", "")
    };
    let choice = match maps.selection {
        Selection::Cascades => first_that_covers(name, maps),
        Selection::OneView => view_that_holds(name, maps, String::new()),
        Selection::CubeFace => face_that_holds(name, maps),
    };
    let blends = maps.sampling.blend > 0.0 && count > 1;
    let lookup = match maps.sampling.filter.directions() {
        None if blends => blended_lookup(name, maps),
        None => single_lookup(name, maps, argument),
        Some((offsets, samples)) => mean_lookup(name, maps, argument, offsets, samples),
    };
    format!(
        "
@group(SHADOW_GROUP) @binding({binding}) var<uniform> shadow_views_{name}: array<ShadowView, {count}>;
@group(SHADOW_GROUP) @binding({map}) var shadow_map_{name}: {map_type};

// The view, and so the layer, that serves a place; {count} where none does.
fn shadow_view_{name}({parameter}position: vec3<f32>) -> u32 {{
{choice}    return {count}u;
}}

// Visibility in [0, 1]; 1 where no view serves the place.
fn shadow_{name}({parameter}position: vec3<f32>, normal: vec3<f32>) -> f32 {{
{lookup}}}
",
        map = binding + 1,
        map_type = map_access(maps, access).map_wgsl(),
    )
}

/// The first of a light's cascades that covers the place. A directional light has neither range nor cone to ask for.
fn first_that_covers(name: &str, maps: &SampledMaps<'_>) -> String {
    let count = maps.view_count;
    format!(
        "    for (var view = 0u; view < {count}u; view++) {{
        if shadow_view_covers(shadow_views_{name}[view], position) {{
            return view;
        }}
    }}
"
    )
}

/// The face on which the place lies as seen from the light, if it holds it.
fn face_that_holds(name: &str, maps: &SampledMaps<'_>) -> String {
    let any = any_view(maps);
    let face = format!(" + shadow_cube_face(position - shadow_views_{name}[{any}].anchor)");
    view_that_holds(name, maps, face)
}

/// The light's first view, or so many after it, if it holds the place.
fn view_that_holds(name: &str, maps: &SampledMaps<'_>, after_first: String) -> String {
    let count = maps.view_count;
    let first = first_view(maps);
    format!(
        "    let view = {first}{after_first};
    if view < {count}u && shadow_view_holds(shadow_views_{name}[view], position) {{
        return view;
    }}
"
    )
}

/// First view of a light; for an index that no slot of the pool has, the end of all views. The index is limited before it is
/// multiplied: 32 bits do not hold every product.
fn first_view(maps: &SampledMaps<'_>) -> String {
    let (count, per_light) = (maps.view_count, maps.views_per_light);
    if maps.indexed {
        format!("min(index, {}u) * {per_light}u", count / per_light)
    } else {
        "0u".to_owned()
    }
}

/// A view of the light, for what all its views have in common; for an index that no slot has, one of another light.
fn any_view(maps: &SampledMaps<'_>) -> String {
    let (count, per_light) = (maps.view_count, maps.views_per_light);
    if maps.indexed {
        format!("min(index, {}u) * {per_light}u", count / per_light - 1)
    } else {
        "0u".to_owned()
    }
}

fn single_lookup(name: &str, maps: &SampledMaps<'_>, argument: &str) -> String {
    let count = maps.view_count;
    let make_receiver = make_receiver(maps);
    let lookup = lookup(name, maps);
    format!(
        "    let view = shadow_view_{name}({argument}position);
    if view == {count}u {{
        return 1.0;
    }}
    let receiver = {make_receiver}(shadow_views_{name}[view], position, normal);
    return {lookup};
"
    )
}

/// The mean of all cascades that hold the place, weighted from near to far: a cascade takes what the ones before it leave, and
/// less toward its border. Continuous wherever a border lies.
fn blended_lookup(name: &str, maps: &SampledMaps<'_>) -> String {
    let count = maps.view_count;
    let make_receiver = make_receiver(maps);
    let lookup = lookup(name, maps);
    format!(
        "    var lit = 0.0;
    var share = 0.0;
    for (var view = shadow_view_{name}(position); view < {count}u && share < 1.0; view++) {{
        if shadow_view_covers(shadow_views_{name}[view], position) {{
            let weight = (1.0 - share) * shadow_view_weight(shadow_views_{name}[view], position);
            let receiver = {make_receiver}(shadow_views_{name}[view], position, normal);
            lit += weight * {lookup};
            share += weight;
        }}
    }}
    return select(1.0, lit / share, share > 0.0);
"
    )
}

/// The mean over directions around the place's own, each on its own face. What varies is the comparison's left side, by `>=`, for
/// the sake of the driver that `shadow_view_holds` tells of.
fn mean_lookup(
    name: &str,
    maps: &SampledMaps<'_>,
    argument: &str,
    offsets: &str,
    samples: u32,
) -> String {
    let count = maps.view_count;
    let any = any_view(maps);
    let make_receiver = make_receiver(maps);
    let lookup = lookup(name, maps);
    let meets = match maps.sampling.bias {
        Bias::Manual { .. } => "shadow_direction_on_sphere(from_light, offset)",
        Bias::Auto | Bias::NormalOffset => "shadow_direction_on_plane(from_light, normal, offset)",
    };
    format!(
        "    let light = shadow_views_{name}[{any}];
    let from_light = position - light.anchor;
    if length(from_light) >= light.range {{
        return 1.0;
    }}
    let radius = {offsets}_radius(light, position);
    var lit = 0.0;
    for (var i = 0u; i < {samples}u; i++) {{
        let offset = {offsets}(i) * radius;
        let place = {meets} + light.anchor;
        let view = shadow_view_{name}({argument}place);
        if view == {count}u {{
            lit += 1.0;
        }} else {{
            let receiver = {make_receiver}(shadow_views_{name}[view], place, normal);
            lit += {lookup};
        }}
    }}
    return lit / {samples}.0;
"
    )
}

fn make_receiver(maps: &SampledMaps<'_>) -> &'static str {
    let sampling = &maps.sampling;
    sampling.bias.scheme(sampling.filter).function()
}

fn lookup(name: &str, maps: &SampledMaps<'_>) -> String {
    let (filter, sampler) = maps.sampling.filter.wgsl();
    let sampler = sampler_names(sampler).0;
    format!("shadow_{filter}(shadow_map_{name}, {sampler}, receiver)")
}

fn sampler_names(sampler: FilterSampler) -> (&'static str, &'static str) {
    match sampler {
        FilterSampler::Comparison => ("shadow_comparison_sampler", "sampler_comparison"),
        FilterSampler::Point => ("shadow_point_sampler", "sampler"),
    }
}
