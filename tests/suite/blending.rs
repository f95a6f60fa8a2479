//! Tests cascades that blend into each other: there is no step at any border, and the weighted mean
//! is that of the CPU reference.

use glam::{DVec3, Vec3};
use shadow_support::camera::Camera;
use shadow_support::mesh::Mesh;
use shadow_support::probe::Point;
use shadow_support::readback;
use wgpu_shadows::reference::{self, DepthLayer};
use wgpu_shadows::{
    Bias, CascadeLayout, DirectionalLight, DirectionalShadow, DirectionalShadowDescriptor, Filter,
    ShadowBindings, ShadowBindingsDescriptor,
};

use crate::fixtures::frames::{Coverage, DirectionalFrame};
use crate::fixtures::gpu::gpu;
use crate::fixtures::probe::{SunProbe, record};
use crate::fixtures::scene::Scene;

const MAP_SIZE: u32 = 128;

/// Returns planks that float over the floor, across the direction of view, under a sun whose
/// shadows extend along that direction: every border between cascades crosses edges.
fn planks() -> Scene {
    let mut meshes: Vec<_> = (0..6)
        .map(|plank| {
            let x = -4.3 + 1.7 * plank as f32;
            Mesh::cuboid(Vec3::new(x, 2.0, -10.0), Vec3::new(x + 0.8, 2.2, 90.0))
        })
        .collect();
    meshes.push(Mesh::floor(0.0, 100.0));
    Scene::new(gpu(), &meshes)
}

fn sun(blend: f32) -> (DirectionalShadow, SunProbe) {
    let gpu = gpu();
    let mut shadow = DirectionalShadow::new(
        &gpu.device,
        &DirectionalShadowDescriptor {
            map_size: MAP_SIZE,
            layout: CascadeLayout::fixed(3),
            blend,
            ..Default::default()
        },
    )
    .expect("a valid sun");
    let camera = Camera::modern(
        DVec3::new(0.0, 3.0, -6.0),
        DVec3::new(0.6, 0.0, 20.0),
        0.9,
        1.5,
    );
    let scene = planks();
    let frame = DirectionalFrame {
        origin: DVec3::ZERO,
        light: DirectionalLight::new(Vec3::new(0.13, -1.0, 0.4)),
        coverage: Coverage::Camera(camera.view().with_max_distance(50.0)),
        casters: &scene.list(),
        receivers: &[],
    };
    record(gpu, &mut shadow, &frame);
    let probe = SunProbe::new(gpu, &shadow);
    (shadow, probe)
}

/// Returns lines on the floor along the direction of view, in steps of `step`.
fn lines(step: f32) -> Vec<Vec<Point>> {
    (0..80)
        .map(|line| {
            let x = -3.9 + 0.0951 * line as f32;
            (0..(12.0 / step) as u32)
                .map(|index| Point::new(Vec3::new(x, 0.0, index as f32 * step), Vec3::Y))
                .collect()
        })
        .collect()
}

fn steepest(probe: &SunProbe, lines: &[Vec<Point>]) -> f32 {
    lines
        .iter()
        .map(|line| {
            let seen = probe.ask(gpu(), line);
            let steps = seen.windows(2).map(|pair| (pair[1] - pair[0]).abs());
            steps.fold(0.0, f32::max)
        })
        .fold(0.0, f32::max)
}

/// Along the direction of view a step of `d` world units changes a visibility by at most `3 d / s`
/// for each axis of the finest map, with texels of `s` (the default's sharpness, a ramp that is one
/// texel wide), and the weights of two cascades by `d / (blend N s)` each. Without blending, the
/// borders show as larger steps.
#[test]
fn no_border_is_a_step() {
    let step = 1.0 / 4096.0;
    let lines = lines(step);
    let (shadow, probe) = sun(0.2);
    let finest = shadow
        .maps()
        .views()
        .map(|view| view.texel_size_world().min_element())
        .fold(f32::INFINITY, f32::min);
    let per_step = step / finest;
    let allowed = 2.0 * 3.0 * per_step + 2.0 * per_step / (0.2 * MAP_SIZE as f32) + 1e-5;
    let blended = steepest(&probe, &lines);
    let (_, plain) = sun(0.0);
    let plain = steepest(&plain, &lines);
    assert!(blended <= allowed, "{blended} > {allowed}");
    assert!(
        plain > 1.5 * allowed,
        "the scene has borders: {plain}, {allowed}"
    );
}

/// The device's results are those of the CPU reference, from the maps read back, to `1e-3`: texel
/// coordinates err by `14uN`, 1e-4 of a texel, a visibility changes by no more than six per texel,
/// and no comparison is a tie on a floor under floating planks.
#[test]
fn the_mean_is_that_of_the_reference() {
    let (shadow, probe) = sun(0.2);
    let layers: Vec<_> = (0..3)
        .map(|layer| readback::depth_layer(gpu(), shadow.maps().texture(), layer))
        .collect();
    let (mut mixed, mut all) = (0, 0);
    for line in lines(0.05) {
        for (point, seen) in line.iter().zip(probe.ask(gpu(), &line)) {
            let place = Vec3::from_array(point.position).as_dvec3();
            let (mut lit, mut share) = (0.0, 0.0);
            let mut parts = 0;
            for (view, depths) in shadow.maps().view_uniforms().iter().zip(&layers) {
                if share < 1.0 && reference::holds(view, place) {
                    let map = DepthLayer {
                        size: MAP_SIZE,
                        depths,
                    };
                    let filter = Filter::default();
                    let at = reference::receiver(view, filter, Bias::Auto, place, DVec3::Y);
                    let weight = (1.0 - share) * reference::weight(view, place);
                    lit += weight * reference::visibility(filter, &map, &at);
                    share += weight;
                    parts += 1;
                }
            }
            let wanted = if share > 0.0 { lit / share } else { 1.0 };
            assert!(
                (f64::from(seen) - wanted).abs() < 1e-3,
                "{place}: {seen} for {wanted}"
            );
            mixed += usize::from(parts > 1 && wanted > 0.01 && wanted < 0.99);
            all += 1;
        }
    }
    assert!(mixed > 200, "{mixed} of {all} lie between two maps");
}

/// Lights that do not blend have no cost for it: their WGSL contains no weights, nor does that of a
/// single cascade.
#[test]
fn only_cascades_that_blend_have_weights() {
    for (cascades, blend, weighted) in [(3, 0.0, false), (1, 0.2, false), (3, 0.2, true)] {
        let shadow = DirectionalShadow::new(
            &gpu().device,
            &DirectionalShadowDescriptor {
                map_size: 16,
                layout: CascadeLayout::fixed(cascades),
                blend,
                ..Default::default()
            },
        )
        .expect("a valid sun");
        let bindings = ShadowBindings::new(
            &gpu().device,
            &ShadowBindingsDescriptor {
                lights: &[("sun", shadow.maps())],
                ..Default::default()
            },
        )
        .expect("valid bindings");
        let used = bindings.wgsl().matches("shadow_blend_weight(").count() > 1;
        assert_eq!(used, weighted, "{cascades} cascades, blend {blend}");
    }
}
