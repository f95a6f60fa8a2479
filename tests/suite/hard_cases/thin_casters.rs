//! Tests casters about as wide as a texel: whether a map contains them depends on chance, but on
//! fair chance, and does not change.

use glam::{DMat2, DVec2, DVec3, Vec2, Vec3};
use shadow_support::mesh::Mesh;
use shadow_support::probe::Point;
use shadow_support::random::Random;
use wgpu_shadows::{Aabb, CascadeLayout, DirectionalShadowDescriptor, Filter};

use super::stage::{Sun, scene, shining};
use super::table;
use crate::fixtures::frames::Coverage;
use crate::fixtures::gpu::gpu;

const TEXEL: f64 = 1.0 / 16.0;
const BARS_ACROSS: i32 = 34;
/// Is the distance in texels from one bar to the next, along both axes.
const SPACING: f64 = 14.0;
/// Is the length of a bar in texels.
const LENGTH: f64 = 6.0;

/// Describes a field of bars `width` texels wide, each at a random position within a texel and
/// rotated by a random angle or not at all.
struct Field {
    mesh: Mesh,
    middles: Vec<DVec2>,
}

impl Field {
    fn new(width: f64, turned: bool) -> Self {
        let mut random = Random::new(61);
        let mut mesh = Mesh::default();
        let mut middles = Vec::new();
        for index in 0..BARS_ACROSS * BARS_ACROSS {
            let cell = DVec2::new(
                f64::from(index % BARS_ACROSS - BARS_ACROSS / 2),
                f64::from(index / BARS_ACROSS - BARS_ACROSS / 2),
            );
            let phase = DVec2::new(random.unit(), random.unit());
            let angle = random.range(0.0, std::f64::consts::TAU);
            let turn = DMat2::from_angle(if turned { angle } else { 0.0 });
            let middle = (cell * SPACING + phase) * TEXEL;
            let first = mesh.positions.len() as u32;
            for (u, v) in [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)] {
                let corner = middle + turn * DVec2::new(u * width, v * LENGTH) * TEXEL;
                mesh.positions
                    .push(DVec3::new(corner.x, 1.0, corner.y).as_vec3());
            }
            mesh.indices
                .extend([0, 1, 2, 0, 2, 3].map(|corner| first + corner));
            middles.push(cell * SPACING * TEXEL);
        }
        Self { mesh, middles }
    }

    /// Returns the number of dark texels around each bar, by sampling the centre of every texel.
    fn dark_texels(&self, sun: &Sun) -> Vec<f64> {
        const AROUND: i32 = 5;
        let side = 2 * AROUND;
        let texels: Vec<_> = (0..side * side)
            .map(|index| (index % side - AROUND, index / side - AROUND))
            .collect();
        let mut points = Vec::new();
        for middle in &self.middles {
            points.extend(texels.iter().map(|(x, z)| {
                let texel = DVec2::new(f64::from(*x), f64::from(*z)) + 0.5;
                let place = *middle + texel * TEXEL;
                Point::rounded(DVec3::new(place.x, 0.0, place.y), DVec3::Y)
            }));
        }
        let seen = sun.ask(&points);
        assert!(seen.iter().all(|seen| *seen == 0.0 || *seen == 1.0));
        seen.chunks(texels.len())
            .map(|bar| bar.iter().filter(|seen| **seen == 0.0).count() as f64)
            .collect()
    }
}

fn record(sun: &mut Sun, field: &Field, nudge: f64) {
    let half = (f64::from(BARS_ACROSS) * SPACING * 0.5 + 3.0) * TEXEL;
    let center = Vec3::new(nudge as f32, 0.0, -nudge as f32);
    let extent = Vec3::new(half as f32, 1.5, half as f32);
    let scene = scene(std::slice::from_ref(&field.mesh));
    sun.record(
        DVec3::ZERO,
        shining(DVec3::NEG_Y),
        Coverage::Bounds(Aabb::new(center - extent, center + extent)),
        &scene.list(),
        &[],
    );
    let view = sun.shadow.maps().views().next().expect("a view");
    assert_eq!(view.texel_size_world(), Vec2::splat(TEXEL as f32));
}

/// Over random positions within a texel, the mean number of texels that a bar darkens is its area,
/// whatever its width and direction: within three standard deviations of the mean, which the spread
/// among 1156 bars gives; where all bars darken alike, within a texel of the bar's border for each
/// hundredth that falls on a texel's centre (snapping moves it by 1/256). From √2 texels on, every
/// bar leaves a mark. A covered box that moves within its light-space bounds changes nothing.
#[test]
fn thin_casters_are_caught_in_proportion_to_their_width() {
    let mut worst: f64 = 0.0;
    let mut sun = Sun::new(&DirectionalShadowDescriptor {
        map_size: 512,
        filter: Filter::Nearest,
        layout: CascadeLayout::fixed(1),
        ..Default::default()
    });
    for turned in [false, true] {
        for width in [0.1, 0.5, 1.0, std::f64::consts::SQRT_2, 2.0] {
            let field = Field::new(width, turned);
            record(&mut sun, &field, 0.0);
            let dark = field.dark_texels(&sun);
            let bars = dark.len() as f64;
            let mean = dark.iter().sum::<f64>() / bars;
            let variance = dark.iter().map(|n| (n - mean).powi(2)).sum::<f64>() / bars;
            let tolerance = (3.0 * (variance / bars).sqrt()).max(0.01 * LENGTH);
            let area = width * LENGTH;
            assert!(
                (mean - area).abs() <= tolerance,
                "{width} texels wide, turned {turned}, on {}: {mean} ± {tolerance} texels for {area}",
                gpu().describe()
            );
            if width >= std::f64::consts::SQRT_2 {
                assert!(dark.iter().all(|texels| *texels > 0.0), "{width} {turned}");
            }
            for nudge in [0.3, -0.4, 0.7] {
                record(&mut sun, &field, nudge * TEXEL);
                assert_eq!(field.dark_texels(&sun), dark, "nudged by {nudge} texels");
            }
            worst = worst.max((mean - area).abs() / tolerance);
        }
    }
    table::record(
        "casters 0.1 to 2 texels wide",
        "mean area of their shadows within 3 sigma of their own, the same in every frame, a mark of each from 1.42 texels on",
        format!("{:.1} sigma at most, 0 changes", 3.0 * worst),
    );
}
