//! Tests what `ShadowBindings` emits for every kind of light, every filter and every bias, alone
//! and combined.

use shadow_support::compositions::{BIASES, filters};
use wgpu_shadows::{ShadowBindings, ShadowBindingsDescriptor, ShadowMaps};

use crate::fixtures::gpu::gpu;
use crate::fixtures::lights::{Kind, Light};
use crate::fixtures::wgsl;

struct Named {
    name: String,
    kind: Kind,
    light: Box<dyn Light>,
}

/// Returns a light of a kind for every filter and bias that it accepts. Maps are one texel, since
/// only the WGSL is of interest.
fn every_way(kind: Kind) -> Vec<Named> {
    filters(kind.has_cube())
        .flat_map(|filter| BIASES.map(|bias| (filter, bias)))
        .map(|(filter, bias)| Named {
            name: format!("{kind:?} {filter:?} {bias:?}"),
            kind,
            light: kind.blank(gpu(), 1, filter, bias),
        })
        .collect()
}

fn emitted(group: u32, lights: &[(&str, &ShadowMaps)]) -> String {
    let descriptor = ShadowBindingsDescriptor {
        group,
        lights,
        ..Default::default()
    };
    let bindings = ShadowBindings::new(&gpu().device, &descriptor).expect("valid bindings");
    assert_eq!(bindings.group(), group);
    bindings.wgsl().to_owned()
}

/// Checks that naga and WGSL's grammar accept the text, that all its bindings are in `group` at 0,
/// 1, 2 and so on, and that there is a function for each light that takes two vectors, after an
/// index where the light is a pool's, and returns a float.
fn check(text: &str, group: u32, lights: &[(&str, Kind)]) -> Result<(), String> {
    let module = wgsl::validate(text)?;
    let mut bindings = Vec::new();
    for (_, variable) in module.global_variables.iter() {
        let binding = variable.binding.ok_or("a global without a binding")?;
        if binding.group != group {
            return Err(format!("{:?} is in group {}", variable.name, binding.group));
        }
        bindings.push(binding.binding);
    }
    bindings.sort_unstable();
    if bindings != (0..bindings.len() as u32).collect::<Vec<_>>() {
        return Err(format!("bindings {bindings:?}"));
    }
    for (name, kind) in lights {
        let wanted = format!("shadow_{name}");
        let mut functions = module.functions.iter().map(|(_, function)| function);
        let found = functions.find(|function| function.name.as_deref() == Some(&wanted));
        let function = found.ok_or(format!("no function {wanted}"))?;
        let result = function
            .result
            .as_ref()
            .ok_or(format!("{wanted} returns nothing"))?;
        let returns_float = matches!(
            module.types[result.ty].inner,
            naga::TypeInner::Scalar(naga::Scalar::F32)
        );
        let is_vector = |inner: &naga::TypeInner| {
            matches!(
                inner,
                naga::TypeInner::Vector {
                    size: naga::VectorSize::Tri,
                    scalar: naga::Scalar::F32
                }
            )
        };
        let arguments: Vec<_> = function
            .arguments
            .iter()
            .map(|argument| &module.types[argument.ty].inner)
            .collect();
        let takes = match (kind, &arguments[..]) {
            (Kind::Spots | Kind::Lamps, [index, position, normal]) => {
                let is_index = matches!(index, naga::TypeInner::Scalar(naga::Scalar::U32));
                is_index && is_vector(position) && is_vector(normal)
            }
            (Kind::Sun { .. } | Kind::Spot | Kind::Lamp, [position, normal]) => {
                is_vector(position) && is_vector(normal)
            }
            _ => false,
        };
        if !(returns_float && takes) {
            return Err(format!("{wanted} has another signature"));
        }
    }
    Ok(())
}

fn report(failures: &[String]) {
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn one_light_validates_in_every_group() {
    let mut failures = Vec::new();
    for light in Kind::ALL.into_iter().flat_map(every_way) {
        for group in 0..=3 {
            let text = emitted(group, &[("lamp", light.light.maps())]);
            if let Err(error) = check(&text, group, &[("lamp", light.kind)]) {
                failures.push(format!("{} in group {group}: {error}", light.name));
            }
        }
    }
    report(&failures);
}

/// For every two lights of different kinds, shared modules appear once, samplers are shared, and
/// names do not collide.
#[test]
fn two_lights_validate() {
    let [_, _, sun, others @ ..] = Kind::ALL;
    let suns = every_way(sun);
    let mut failures = Vec::new();
    for other in others.into_iter().flat_map(every_way) {
        for sun in &suns {
            let lights = [("sun", sun), ("other_lamp", &other)];
            let text = emitted(1, &lights.map(|(name, light)| (name, light.light.maps())));
            if let Err(error) = check(&text, 1, &lights.map(|(name, light)| (name, light.kind))) {
                failures.push(format!("{} with {}: {error}", sun.name, other.name));
            }
        }
    }
    report(&failures);
}

/// An engine without lights still has the geometric normal.
#[test]
fn no_light_validates() {
    let text = emitted(2, &[]);
    check(&text, 2, &[]).unwrap_or_else(|error| panic!("{error}"));
    assert!(text.contains("fn shadow_geometric_normal("));
}
