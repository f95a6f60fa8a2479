//! Tests the biases of local lights on the device against the CPU reference: the position of a
//! receiver in the map, its depth, its gradient, and whether the map covers it.
//!
//! The tolerance is a first-order bound of f32 arithmetic. Every rounding of a sum or a product
//! acts as a relative change, of at most u = 2^-24, of something that an input was multiplied by or
//! added to, so that it can be attributed to inputs. No input passes through more than
//! [`ROUNDINGS`] operations. So each number of the position, the normal and the uniform is changed
//! by that many times u of its magnitude, and the changes of the reference's results are summed.

use glam::{DVec2, DVec3, Vec3};
use shadow_support::gpu::Gpu;
use shadow_support::probe::{Point, PointShader};
use shadow_support::random::Random;
use wgpu_shadows::reference::{self, Receiver};
use wgpu_shadows::{Bias, Filter, ShadowViewUniform, shader};

use crate::fixtures::gpu::gpu;
use crate::fixtures::lights::{Kind, stage};
use crate::fixtures::rounding::U;
use crate::fixtures::view_member::{member, with_member};
use crate::suite::filter_parity::{BIASES, place};

/// Bounds the operations between an input and a result: three for light space, three for the plane
/// of the map, four for the height of the tangent plane, and ten for offset, gradient and depth,
/// some of which count twice because their operands do.
const ROUNDINGS: f64 = 24.0;

const POINTS: usize = 4000;

/// Lists the members of the uniform that the arithmetic reads, with the number of their components.
const MEMBERS: [(&str, usize); 14] = [
    ("mapping.texel_scale", 2),
    ("mapping.texel_offset", 2),
    ("mapping.texel_size", 2),
    ("mapping.depth_scale", 1),
    ("mapping.rounding", 1),
    ("right", 3),
    ("down", 3),
    ("toward", 3),
    ("mapping.middle", 2),
    ("offset_texels", 1),
    ("offset_world", 1),
    ("lateral_error", 1),
    ("manual_constant", 1),
    ("manual_slope", 1),
];

/// Is a receiver of the reference as numbers: texel, depth, gradient.
fn numbers(receiver: &Receiver) -> [f64; 5] {
    [
        receiver.texel.x,
        receiver.texel.y,
        receiver.depth,
        receiver.gradient.x,
        receiver.gradient.y,
    ]
}

/// Returns how far rounding may take each number of a receiver.
fn tolerance(
    of: &impl Fn(&ShadowViewUniform, DVec3, DVec3) -> Receiver,
    view: &ShadowViewUniform,
    position: DVec3,
    normal: DVec3,
) -> [f64; 5] {
    let exact = numbers(&of(view, position, normal));
    let mut sum = exact.map(|number| 4.0 * U * number.abs());
    let mut add = |changed: Receiver| {
        for ((sum, exact), changed) in sum.iter_mut().zip(exact).zip(numbers(&changed)) {
            *sum += (changed - exact).abs();
        }
    };
    let anchor = Vec3::from_array(member(view, "anchor")).as_dvec3();
    let step = ROUNDINGS * U;
    for axis in DVec3::AXES {
        let reach = (position - anchor).dot(axis).abs();
        add(of(view, position + axis * reach * step, normal));
        let along = normal.dot(axis);
        add(of(view, position, normal + axis * along * step));
    }
    for (name, components) in MEMBERS {
        for component in 0..components {
            let mut values = vec![0.0_f32; components];
            match components {
                1 => values[0] = member(view, name),
                2 => values.copy_from_slice(&member::<[f32; 2]>(view, name)),
                _ => values.copy_from_slice(&member::<[f32; 3]>(view, name)),
            }
            values[component] *= 1.0 + step as f32;
            let changed = match components {
                1 => with_member(*view, name, values[0]),
                2 => with_member(*view, name, [values[0], values[1]]),
                _ => with_member(*view, name, [values[0], values[1], values[2]]),
            };
            add(of(&changed, position, normal));
        }
    }
    sum
}

/// Returns receivers around the light, with any normals, and on the floor and the box.
fn points(seed: u64, light: DVec3) -> Vec<Point> {
    let mut random = Random::new(seed);
    let reach = DVec3::splat(6.0);
    (0..POINTS)
        .map(|index| {
            if index % 2 == 0 {
                return Point::rounded(light + random.point(-reach, reach), random.direction());
            }
            let floor = DVec3::new(random.range(-2.0, 2.0), 0.0, random.range(-2.0, 2.0));
            Point::rounded(floor, DVec3::Y)
        })
        .collect()
}

fn check(gpu: &Gpu, kind: Kind, filter: Filter, bias: Bias, scheme: &str) -> (usize, usize) {
    let light = kind.lit(gpu, &stage(gpu), filter, bias);
    let views = light.maps().view_uniforms();
    let count = views.len();
    let face = match kind {
        Kind::Lamp => "shadow_cube_face(point.position - views[0].anchor)",
        _ => "0",
    };
    let wgsl = shader::compose(&[&format!("bias_{scheme}"), "cube_face"]).expect("modules")
        + &format!(
            "
@group(1) @binding(0) var<uniform> views: array<ShadowViewUniform, {count}>;

fn raw(receiver: ShadowReceiver) -> array<vec4<f32>, 2> {{
    return array<vec4<f32>, 2>(
        vec4<f32>(receiver.texel, receiver.depth, select(0.0, 1.0, receiver.inside)),
        vec4<f32>(receiver.gradient, 0.0, 0.0),
    );
}}
"
        );
    let (layout, group) =
        crate::suite::receiver_parity::view_group(gpu, light.maps().uniform_buffer());
    let call =
        format!("raw(shadow_receiver_{scheme}_local(views[{face}], point.position, point.normal))");
    let shader = PointShader::new(gpu, &wgsl, "array<vec4<f32>, 2>", &call, &layout);
    let anchor = Vec3::from_array(member(&views[0], "anchor")).as_dvec3();
    let points = points(9, anchor);
    let answers: Vec<[f32; 8]> = shader.ask(gpu, &group, &points);
    let of = |view: &ShadowViewUniform, position, normal| {
        reference::receiver(view, filter, bias, position, normal)
    };
    let (mut compared, mut inside_count, mut used) = (0, 0, [0.0_f64; 5]);
    for (point, answer) in points.iter().zip(answers) {
        let (position, normal) = place(point);
        let view = match kind {
            Kind::Lamp => &views[face_of(position - anchor)],
            _ => &views[0],
        };
        let reference = of(view, position, normal);
        let tolerance = tolerance(&of, view, position, normal);
        let answer = answer.map(f64::from);
        let seen = [answer[0], answer[1], answer[2], answer[4], answer[5]];
        let wanted = numbers(&reference);
        let inside = answer[3] == 1.0;
        let context = format!(
            "{kind:?} {filter:?} {bias:?} {point:?}\n{seen:?}\n{reference:?}\n{tolerance:?}"
        );
        // What decides whether a view covers a position is compared where rounding does not decide.
        let middle = DVec2::from(member::<[f32; 2]>(view, "mapping.middle").map(f64::from));
        let inner = DVec2::from(member::<[f32; 2]>(view, "mapping.inner").map(f64::from));
        let margin = ((reference.texel - middle).abs() - inner)
            .abs()
            .min_element();
        if inside != reference.inside {
            assert!(margin < 1.0, "{context}");
            continue;
        }
        // A receiver that the view does not cover has no meaning, nor has one where rounding
        // decides whether it is past the horizon of its surface.
        let decided = tolerance[2] < 0.25;
        if !inside || !decided {
            continue;
        }
        inside_count += 1;
        compared += 1;
        for (index, ((seen, wanted), allowed)) in seen.iter().zip(wanted).zip(tolerance).enumerate()
        {
            let error = (seen - wanted).abs();
            assert!(error <= allowed, "{index}: {error} of {allowed}: {context}");
            if allowed > 0.0 {
                used[index] = used[index].max(error / allowed);
            }
        }
    }
    // A band that no error comes near would hide mistakes as large as itself.
    assert!(used[0] > 0.01 && used[2] > 0.01, "{used:?} of the bands");
    (compared, inside_count)
}

/// Returns the face of the cube by the definition: the axis of the largest component.
fn face_of(from_light: DVec3) -> usize {
    let axis = from_light.abs().max_position();
    2 * axis + usize::from(from_light[axis] < 0.0)
}

#[test]
fn local_receivers_are_those_of_the_reference() {
    let gpu = gpu();
    let schemes = ["plane", "normal_offset", "manual"];
    for kind in [Kind::Spot, Kind::Lamp] {
        for filter in [
            Filter::Bilinear { sharpness: 1.0 },
            Filter::Tent7 { sharpness: 2.0 },
        ] {
            for (bias, scheme) in BIASES.into_iter().zip(schemes) {
                let (compared, inside) = check(gpu, kind, filter, bias, scheme);
                assert!(
                    compared > POINTS / 8,
                    "{kind:?} {scheme}: {compared} of {inside}"
                );
            }
        }
    }
}
