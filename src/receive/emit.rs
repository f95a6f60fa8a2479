//! The WGSL of a set of lights: the modules in use, the group's number, the bindings, and one function per light.

use std::fmt::Write;

use crate::error::BindingsError;
use crate::receive::bindings::{ShadowBindingsDescriptor, map_access, views_binding};
use crate::receive::filter::FilterSampler;
use crate::receive::texel_access::TexelAccess;
use crate::receive::{Bias, Receiver, Selection};
use crate::shader;

/// The text for `descriptor`, whose filters take `samplers`, on a device with `access` to texels.
pub(crate) fn wgsl(
    descriptor: &ShadowBindingsDescriptor<'_>,
    samplers: &[FilterSampler],
    access: TexelAccess,
) -> Result<String, BindingsError> {
    let mut modules = vec!["normal"];
    if samplers.contains(&FilterSampler::Point) {
        modules.extend(access.module());
    }
    for (_, source) in descriptor.lights {
        let Receiver {
            sampling,
            selection,
            ..
        } = source.receiver;
        modules.push(sampling.filter.wgsl().0);
        modules.push(sampling.bias.scheme(sampling.filter).module());
        if selection == Selection::CubeFace {
            modules.push("cube_face");
            modules.extend(sampling.filter.directions().map(|_| "filter_direction"));
        }
    }
    let mut text = shader::compose(&modules)?;
    // Writing to a String does not fail.
    let _ = writeln!(text, "\nconst SHADOW_GROUP: u32 = {}u;", descriptor.group);
    for (binding, sampler) in samplers.iter().enumerate() {
        let (name, ty) = sampler_names(*sampler);
        let _ = writeln!(
            text,
            "@group(SHADOW_GROUP) @binding({binding}) var {name}: {ty};"
        );
    }
    for (light, (name, source)) in descriptor.lights.iter().enumerate() {
        let binding = views_binding(samplers, light);
        text += &light_wgsl(name, &source.receiver, binding, access);
    }
    Ok(text)
}

/// Bindings and functions of one light.
fn light_wgsl(name: &str, receiver: &Receiver<'_>, binding: u32, access: TexelAccess) -> String {
    let count = receiver.view_count;
    let (parameter, argument) = if receiver.indexed {
        ("index: u32, ", "index, ")
    } else {
        ("", "")
    };
    let choice = match receiver.selection {
        Selection::Cascades => first_that_covers(name, receiver),
        Selection::OneView => view_that_holds(name, receiver, String::new()),
        Selection::CubeFace => face_that_holds(name, receiver),
    };
    let blends = receiver.sampling.blend > 0.0 && count > 1;
    let lookup = match receiver.sampling.filter.directions() {
        None if blends => blended_lookup(name, receiver),
        None => single_lookup(name, receiver, argument),
        Some((offsets, samples)) => mean_lookup(name, receiver, argument, offsets, samples),
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
        map_type = map_access(receiver, access).map_wgsl(),
    )
}

/// The first of a light's cascades that covers the place. A directional light has neither range nor cone to ask for.
fn first_that_covers(name: &str, receiver: &Receiver<'_>) -> String {
    let count = receiver.view_count;
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
fn face_that_holds(name: &str, receiver: &Receiver<'_>) -> String {
    let any = any_view(receiver);
    let face = format!(" + shadow_cube_face(position - shadow_views_{name}[{any}].anchor)");
    view_that_holds(name, receiver, face)
}

/// The light's first view, or so many after it, if it holds the place.
fn view_that_holds(name: &str, receiver: &Receiver<'_>, after_first: String) -> String {
    let count = receiver.view_count;
    let first = first_view(receiver);
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
fn first_view(receiver: &Receiver<'_>) -> String {
    let (count, per_light) = (receiver.view_count, receiver.views_per_light);
    if receiver.indexed {
        format!("min(index, {}u) * {per_light}u", count / per_light)
    } else {
        "0u".to_owned()
    }
}

/// A view of the light, for what all its views have in common; for an index that no slot has, one of another light.
fn any_view(receiver: &Receiver<'_>) -> String {
    let (count, per_light) = (receiver.view_count, receiver.views_per_light);
    if receiver.indexed {
        format!("min(index, {}u) * {per_light}u", count / per_light - 1)
    } else {
        "0u".to_owned()
    }
}

fn single_lookup(name: &str, receiver: &Receiver<'_>, argument: &str) -> String {
    let count = receiver.view_count;
    let make_receiver = make_receiver(receiver);
    let lookup = lookup(name, receiver);
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
fn blended_lookup(name: &str, receiver: &Receiver<'_>) -> String {
    let count = receiver.view_count;
    let make_receiver = make_receiver(receiver);
    let lookup = lookup(name, receiver);
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
    receiver: &Receiver<'_>,
    argument: &str,
    offsets: &str,
    samples: u32,
) -> String {
    let count = receiver.view_count;
    let any = any_view(receiver);
    let make_receiver = make_receiver(receiver);
    let lookup = lookup(name, receiver);
    let meets = match receiver.sampling.bias {
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

fn make_receiver(receiver: &Receiver<'_>) -> &'static str {
    let sampling = &receiver.sampling;
    sampling.bias.scheme(sampling.filter).function()
}

fn lookup(name: &str, receiver: &Receiver<'_>) -> String {
    let (filter, sampler) = receiver.sampling.filter.wgsl();
    let sampler = sampler_names(sampler).0;
    format!("shadow_{filter}(shadow_map_{name}, {sampler}, receiver)")
}

fn sampler_names(sampler: FilterSampler) -> (&'static str, &'static str) {
    match sampler {
        FilterSampler::Comparison => ("shadow_comparison_sampler", "sampler_comparison"),
        FilterSampler::Point => ("shadow_point_sampler", "sampler"),
    }
}
