//! Tests the biases on the device against the CPU reference: the position of a receiver in the map,
//! its depth, its gradient, and whether the map covers it.

use glam::DVec2;
use shadow_support::probe::PointShader;
use wgpu_shadows::reference;
use wgpu_shadows::{Bias, Filter, shader};

use crate::fixtures::gpu::{Gpu, gpu};
use crate::fixtures::rounding::band;
use crate::suite::filter_parity::{BIASES, Lit, at_border, place, points, scene};

/// Writes a receiver as two vectors: texel, depth, covered or not; gradient.
const RAW: &str = "
@group(1) @binding(0) var<uniform> view: ShadowViewUniform;

fn raw(receiver: ShadowReceiver) -> array<vec4<f32>, 2> {
    let inside = select(0.0, 1.0, receiver.inside);
    return array<vec4<f32>, 2>(
        vec4<f32>(receiver.texel, receiver.depth, inside),
        vec4<f32>(receiver.gradient, 0.0, 0.0),
    );
}
";

fn module_of(bias: Bias) -> (&'static str, &'static str) {
    match bias {
        Bias::Auto => ("bias_plane", "shadow_receiver_plane_directional"),
        Bias::NormalOffset => (
            "bias_normal_offset",
            "shadow_receiver_normal_offset_directional",
        ),
        _ => ("bias_manual", "shadow_receiver_manual_directional"),
    }
}

/// Creates one bind group with the light's own uniform buffer.
pub(super) fn view_group(
    gpu: &Gpu,
    buffer: &wgpu::Buffer,
) -> (wgpu::BindGroupLayout, wgpu::BindGroup) {
    let layout = gpu
        .device
        .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("view"),
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::COMPUTE,
                ty: wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
                count: None,
            }],
        });
    let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("view"),
        layout: &layout,
        entries: &[wgpu::BindGroupEntry {
            binding: 0,
            resource: buffer.as_entire_binding(),
        }],
    });
    (layout, group)
}

#[test]
fn receivers_are_those_of_the_reference() {
    let gpu = gpu();
    let scene = scene();
    // Reaches and map sizes differ, and with them light-space bounds, borders and gradients.
    let kinds = [
        (Filter::Bilinear { sharpness: 1.0 }, 93),
        (Filter::Tent7 { sharpness: 2.0 }, 1024),
    ];
    for (filter, map_size) in kinds {
        for bias in BIASES {
            let lit = Lit::new(gpu, &scene, map_size, filter, bias);
            let (module, function) = module_of(bias);
            let wgsl = shader::compose(&[module]).expect("a module of the table") + RAW;
            let (layout, group) = view_group(gpu, lit.shadow.maps().uniform_buffer());
            let call = format!("raw({function}(view, point.position, point.normal))");
            let shader = PointShader::new(gpu, &wgsl, "array<vec4<f32>, 2>", &call, &layout);
            let points = points(&scene, 5);
            let answers: Vec<[f32; 8]> = shader.ask(gpu, &group, &points);
            // These are the largest fractions of the bands that the errors of texel and depth take
            // up.
            let mut used = (0.0_f64, 0.0_f64);
            let (mut edge_on, mut outside) = (0, 0);
            for (point, answer) in points.iter().zip(answers) {
                let (position, normal) = place(point);
                let reference = reference::receiver(&lit.view, filter, bias, position, normal);
                let Some(band) = band(&lit.view, filter, bias, position, normal, &reference) else {
                    edge_on += 1;
                    continue;
                };
                let [x, y, depth, inside, gradient_x, gradient_y, ..] = answer.map(f64::from);
                let texel_error = (DVec2::new(x, y) - reference.texel).abs();
                let gradient_error =
                    (DVec2::new(gradient_x, gradient_y) - reference.gradient).abs();
                let depth_error = (depth - reference.depth).abs();
                used.0 = used.0.max((texel_error / band.texel).max_element());
                used.1 = used.1.max(depth_error / band.depth);
                let context =
                    format!("{filter:?} {bias:?} {point:?}\n{answer:?}\n{reference:?}\n{band:?}");
                assert!(texel_error.cmple(band.texel).all(), "{context}");
                assert!(depth_error <= band.depth, "{context}");
                assert!(gradient_error.cmple(band.gradient).all(), "{context}");
                let undecided = at_border(&lit.view, position, &band);
                assert!(
                    undecided || (inside == 1.0) == reference.inside,
                    "{context}"
                );
                outside += usize::from(inside == 0.0);
            }
            // A band that no error comes near would hide mistakes as large as itself.
            assert!(used.0 > 0.05 && used.1 > 0.05, "{used:?} of the bands");
            // Random positions with random normals are rarely edge-on, and a quarter of the points
            // lie far around the map.
            assert!(edge_on <= 3, "{edge_on} receivers edge on");
            assert!(outside > points.len() / 20, "{outside} receivers outside");
        }
    }
}
