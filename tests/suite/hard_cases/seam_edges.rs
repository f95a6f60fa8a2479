//! Tests edges of shadows on the seams and corners of a point light's cube: they are as accurate as
//! in the middle of its faces.

use glam::{DVec3, Vec3};
use shadow_support::mesh::Mesh;
use shadow_support::probe::Point;
use shadow_support::random::Random;
use wgpu_shadows::{Aabb, Filter, OmniLight, OmniShadow, OmniShadowDescriptor};

use super::stage::scene;
use super::table;
use crate::fixtures::ask::{Ask, record_omni};
use crate::fixtures::frames::OmniFrame;
use crate::fixtures::gpu::gpu;

const EVERYWHERE: [Aabb; 1] = [Aabb::new(Vec3::splat(-20.0), Vec3::splat(20.0))];
const MAP_SIZE: u32 = 256;

/// Returns directions to the middle of faces, of edges and to corners, each slightly displaced so
/// that texels lie differently.
fn directions(sums: &[usize], random: &mut Random) -> Vec<DVec3> {
    let mut found = Vec::new();
    for index in 0..27_u32 {
        let axis = |divisor: u32| f64::from(index / divisor % 3) - 1.0;
        let direction = DVec3::new(axis(1), axis(3), axis(9));
        let sum = direction.abs().element_sum() as usize;
        if sums.contains(&sum) {
            found.push(direction.normalize() + random.direction() * 0.01);
        }
    }
    found
}

/// Returns the mean difference from the truth around the outline of a square plate that faces the
/// light in `direction`, in texels of a face's middle: the area between the shadow's edge and the
/// true one, over the length of the outline.
fn edge_error(lamp: &mut OmniShadow, ask: &Ask, direction: DVec3, random: &mut Random) -> f64 {
    let gpu = gpu();
    let axis = direction.normalize();
    let u = axis
        .any_orthonormal_vector()
        .rotate_axis(axis, random.range(0.0, 1.5));
    let v = axis.cross(u);
    let half = 0.35;
    let corner = axis * 2.0 - (u + v) * half;
    let plate = Mesh::sheet(
        corner.as_vec3(),
        (u * 2.0 * half).as_vec3(),
        (v * 2.0 * half).as_vec3(),
    );
    let scene = scene(&[plate]);
    let frame = OmniFrame {
        origin: DVec3::ZERO,
        light: OmniLight {
            position_world: DVec3::ZERO,
            range: 12.0,
        },
        camera: None,
        casters: &scene.list(),
        receivers: &EVERYWHERE,
    };
    lamp.reset_history();
    record_omni(gpu, lamp, &frame).expect("a frame");
    // The receivers are on a square twice as far away, around its true shadow, which is twice as
    // large.
    let texel = 2.0 / f64::from(MAP_SIZE);
    let band = 6.0 * texel * 4.0;
    let wide = 2.0 * half + band;
    let (mut points, mut truth) = (Vec::new(), Vec::new());
    for _ in 0..12_000 {
        let (a, b) = (random.range(-wide, wide), random.range(-wide, wide));
        points.push(Point::rounded(axis * 4.0 + u * a + v * b, -axis));
        truth.push(if a.abs().max(b.abs()) < 2.0 * half {
            0.0
        } else {
            1.0
        });
    }
    let seen = ask.points(gpu, &points);
    let pairs = seen.iter().zip(&truth);
    let sum: f64 = pairs
        .map(|(seen, truth): (&f32, &f64)| (f64::from(*seen) - truth).abs())
        .sum();
    let area = sum / points.len() as f64 * (2.0 * wide).powi(2);
    area / (8.0 * 2.0 * half) / (4.0 * texel)
}

/// Texels are narrower in angle toward seams, so shadows there should be no less accurate than in
/// the middle: the error is at most 1.2 times as large, which allows for the spread of six, twelve
/// and eight samples.
#[test]
fn edges_at_seams_are_as_true_as_elsewhere() {
    let gpu = gpu();
    let mut words = Vec::new();
    for filter in [
        Filter::default(),
        Filter::Bilinear { sharpness: 1.0 },
        Filter::Tent7 { sharpness: 1.0 },
    ] {
        let descriptor = OmniShadowDescriptor {
            map_size: MAP_SIZE,
            filter,
            ..Default::default()
        };
        let mut lamp = OmniShadow::new(&gpu.device, &descriptor).expect("a lamp");
        let ask = Ask::light(gpu, lamp.maps());
        let mut random = Random::new(101);
        let [middle, edge, corner] = [1, 2, 3].map(|sum| {
            let directions = directions(&[sum], &mut random);
            let sum: f64 = directions
                .iter()
                .map(|direction| edge_error(&mut lamp, &ask, *direction, &mut random))
                .sum();
            sum / directions.len() as f64
        });
        assert!(
            middle > 0.05,
            "{filter:?}: {middle} texels, too good to be true"
        );
        for (name, error) in [("edges", edge), ("corners", corner)] {
            assert!(
                error <= 1.2 * middle,
                "{filter:?} at {name} on {}: {error} for {middle}",
                gpu.describe()
            );
        }
        words.push(format!("{middle:.2}, {edge:.2}, {corner:.2}"));
    }
    table::record(
        "edges of shadows across the seams and corners of a cube",
        "mean error at most 1.2 times that in the middle of a face",
        format!(
            "texels in middles, at edges, at corners: {}",
            words.join("; ")
        ),
    );
}
