//! What `ShadowBindings` emits, for every kind of light, every filter and every bias, alone and in company.

use wgpu_shadows::{
    Bias, DirectionalShadow, DirectionalShadowDescriptor, Filter, OmniShadow, OmniShadowDescriptor,
    ShadowBindings, ShadowBindingsDescriptor, ShadowSource, SpotShadow, SpotShadowDescriptor,
};

use crate::support::gpu::gpu;
use crate::support::wgsl;

const BIASES: [Bias; 3] = [
    Bias::Auto,
    Bias::NormalOffset,
    Bias::Manual {
        constant: 0.01,
        slope: 0.1,
    },
];

/// Filters that every kind of light takes.
fn planar() -> Vec<Filter> {
    let soft = Filter::Penumbra { light_size: 0.01 };
    [&Filter::ALL[..], &[soft]].concat()
}

/// Filters that only point lights take.
const DIRECTIONS: [Filter; 2] = [
    Filter::DirectionGrid { radius: 0.1 },
    Filter::DirectionStar { radius: 0.1 },
];

enum Shadow {
    Sun(Box<DirectionalShadow>),
    Spot(SpotShadow),
    Omni(OmniShadow),
}

struct Light {
    name: String,
    shadow: Shadow,
}

impl Light {
    fn source(&self) -> ShadowSource<'_> {
        match &self.shadow {
            Shadow::Sun(sun) => sun.source(),
            Shadow::Spot(spot) => spot.source(),
            Shadow::Omni(omni) => omni.source(),
        }
    }
}

/// A light for every filter and bias that `make` accepts. Maps are one texel: only the WGSL is of interest.
fn lights(kind: &str, filters: &[Filter], make: impl Fn(Filter, Bias) -> Shadow) -> Vec<Light> {
    let with = |filter: Filter, bias: Bias| Light {
        name: format!("{kind} {filter:?} {bias:?}"),
        shadow: make(filter, bias),
    };
    filters
        .iter()
        .flat_map(|filter| BIASES.map(|bias| with(*filter, bias)))
        .collect()
}

fn suns(cascades: u32) -> Vec<Light> {
    lights(&format!("sun of {cascades}"), &planar(), |filter, bias| {
        let descriptor = DirectionalShadowDescriptor {
            map_size: 1,
            cascades,
            filter,
            bias,
            ..Default::default()
        };
        let sun = DirectionalShadow::new(&gpu().device, &descriptor);
        Shadow::Sun(Box::new(sun.expect("a valid sun")))
    })
}

fn spots() -> Vec<Light> {
    lights("spot", &planar(), |filter, bias| {
        let descriptor = SpotShadowDescriptor {
            map_size: 1,
            filter,
            bias,
            ..Default::default()
        };
        Shadow::Spot(SpotShadow::new(&gpu().device, &descriptor).expect("a valid spot"))
    })
}

fn omnis() -> Vec<Light> {
    lights(
        "lamp",
        &[&planar()[..], &DIRECTIONS].concat(),
        |filter, bias| {
            let descriptor = OmniShadowDescriptor {
                map_size: 1,
                filter,
                bias,
                ..Default::default()
            };
            Shadow::Omni(OmniShadow::new(&gpu().device, &descriptor).expect("a valid lamp"))
        },
    )
}

fn emitted(group: u32, lights: &[(&str, ShadowSource<'_>)]) -> String {
    let descriptor = ShadowBindingsDescriptor {
        group,
        lights,
        ..Default::default()
    };
    let bindings = ShadowBindings::new(&gpu().device, &descriptor).expect("valid bindings");
    assert_eq!(bindings.group(), group);
    bindings.wgsl().to_owned()
}

/// naga accepts the text, all its bindings are in `group` at 0, 1, 2 and so on, and there is a function for each name that
/// takes two vectors and returns a float.
fn check(text: &str, group: u32, names: &[&str]) -> Result<(), String> {
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
    for name in names {
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
        let takes_vectors = function.arguments.iter().all(|argument| {
            let inner = &module.types[argument.ty].inner;
            matches!(
                inner,
                naga::TypeInner::Vector {
                    size: naga::VectorSize::Tri,
                    scalar: naga::Scalar::F32
                }
            )
        });
        if !(returns_float && takes_vectors && function.arguments.len() == 2) {
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
    for light in [suns(1), suns(4), spots(), omnis()].iter().flatten() {
        for group in 0..=3 {
            let text = emitted(group, &[("lamp", light.source())]);
            if let Err(error) = check(&text, group, &["lamp"]) {
                failures.push(format!("{} in group {group}: {error}", light.name));
            }
        }
    }
    report(&failures);
}

/// Shared modules appear once, samplers are shared, and names do not collide, for every two lights of different kinds.
#[test]
fn two_lights_validate() {
    let (suns, others) = (suns(4), [spots(), omnis()]);
    let mut failures = Vec::new();
    for sun in &suns {
        for other in others.iter().flatten() {
            let text = emitted(1, &[("sun", sun.source()), ("other_lamp", other.source())]);
            if let Err(error) = check(&text, 1, &["sun", "other_lamp"]) {
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
