//! The WGSL of a set of lights: the modules in use, the group's number, the bindings, and one function per light.

use std::fmt::Write;

use crate::error::BindingsError;
use crate::receive::bindings::{ShadowBindingsDescriptor, views_binding};
use crate::receive::filter::FilterSampler;
use crate::receive::{Bias, Receiver, Selection};
use crate::shader;

/// The text for `descriptor`, whose filters take `samplers`.
pub(crate) fn wgsl(
    descriptor: &ShadowBindingsDescriptor<'_>,
    samplers: &[FilterSampler],
) -> Result<String, BindingsError> {
    let mut modules = vec!["normal"];
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
        text += &light_wgsl(name, &source.receiver, views_binding(samplers, light));
    }
    Ok(text)
}

/// Bindings and function of one light.
fn light_wgsl(name: &str, receiver: &Receiver<'_>, binding: u32) -> String {
    let count = receiver.view_count;
    let per_light = receiver.views_per_light;
    let (parameter, first) = if receiver.indexed {
        ("index: u32, ", format!("index * {per_light}u"))
    } else {
        ("", "0u".to_owned())
    };
    let guard = if receiver.indexed {
        format!(
            "    if index >= {}u {{\n        return 1.0;\n    }}\n",
            count / per_light
        )
    } else {
        String::new()
    };
    let body = match receiver.selection {
        Selection::FirstInside => first_inside(name, receiver),
        Selection::CubeFace => match receiver.sampling.filter.directions() {
            None => cube_face(name, receiver),
            Some((offsets, samples)) => cube_directions(name, receiver, offsets, samples),
        },
    };
    format!(
        "
@group(SHADOW_GROUP) @binding({binding}) var<uniform> shadow_views_{name}: array<ShadowView, {count}>;
@group(SHADOW_GROUP) @binding({map}) var shadow_map_{name}: texture_depth_2d_array;

// Visibility in [0, 1]; 1 where the map says nothing.
fn shadow_{name}({parameter}position: vec3<f32>, normal: vec3<f32>) -> f32 {{
{guard}    let first = {first};
{body}}}
",
        map = binding + 1,
    )
}

/// The first view that holds the whole kernel.
fn first_inside(name: &str, receiver: &Receiver<'_>) -> String {
    let per_light = receiver.views_per_light;
    let make_receiver = make_receiver(receiver);
    let lookup = lookup(name, receiver);
    format!(
        "    for (var i = 0u; i < {per_light}u; i++) {{
        let receiver = {make_receiver}(shadow_views_{name}[first + i], position, normal);
        if receiver.inside {{
            return {lookup};
        }}
    }}
    return 1.0;
"
    )
}

/// The face on which the place lies as seen from the light.
fn cube_face(name: &str, receiver: &Receiver<'_>) -> String {
    let make_receiver = make_receiver(receiver);
    let lookup = lookup(name, receiver);
    format!(
        "    let face = shadow_cube_face(position - shadow_views_{name}[first].anchor);
    let receiver = {make_receiver}(shadow_views_{name}[first + face], position, normal);
    if !receiver.inside {{
        return 1.0;
    }}
    return {lookup};
"
    )
}

/// The mean over directions around the place's own, each on its own face.
fn cube_directions(name: &str, receiver: &Receiver<'_>, offsets: &str, samples: u32) -> String {
    let make_receiver = make_receiver(receiver);
    let lookup = lookup(name, receiver);
    let meets = match receiver.sampling.bias {
        Bias::Manual { .. } => "shadow_direction_on_sphere(from_light, offset)",
        Bias::Auto | Bias::NormalOffset => "shadow_direction_on_plane(from_light, normal, offset)",
    };
    format!(
        "    let anchor = shadow_views_{name}[first].anchor;
    let from_light = position - anchor;
    if length(from_light) > shadow_views_{name}[first].range {{
        return 1.0;
    }}
    let radius = shadow_direction_radius(shadow_views_{name}[first], position);
    var lit = 0.0;
    for (var i = 0u; i < {samples}u; i++) {{
        let offset = {offsets}(i) * radius;
        let place = {meets};
        let face = first + shadow_cube_face(place);
        let receiver = {make_receiver}(shadow_views_{name}[face], anchor + place, normal);
        if receiver.inside {{
            lit += {lookup};
        }} else {{
            lit += 1.0;
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
