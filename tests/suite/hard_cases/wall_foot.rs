//! Tests where a wall stands on a floor: its shadow begins at its foot.

use std::f64::consts::SQRT_2;

use glam::{DVec2, DVec3, Vec3};
use shadow_support::mesh::Mesh;
use shadow_support::probe::Point;
use shadow_support::random::Random;
use wgpu_shadows::{
    Aabb, Bias, CascadeLayout, CasterPipeline, DirectionalShadowDescriptor, Filter, ShadowCaster,
    caster::CasterPipelineDescriptor,
};

use super::stage::{Sun, shining};
use super::table;
use crate::fixtures::frames::Coverage;
use crate::fixtures::gpu::gpu;

/// Is the number of receivers per texel, on lines that lead away from the wall.
const STEPS: usize = 16;
/// Is the greatest length of a line in texels.
const LONGEST: f64 = 8.0;
const HEIGHT: f32 = 12.0;

/// Describes what stands on the floor.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Wall {
    /// Is a sheet without thickness.
    Sheet,
    /// Is a solid of which the map contains the far sides, which touch the floor where the shadow
    /// begins.
    BackOfSolid,
}

/// Returns a wall along `along`, whose shaded side begins at the line through `foot`.
fn mesh(wall: Wall, foot: DVec3, along: DVec3, toward_light: DVec3) -> Mesh {
    let (u, up) = ((along * 8.0).as_vec3(), Vec3::Y * HEIGHT);
    let corner = (foot - along * 4.0).as_vec3();
    let sheet = Mesh::sheet(corner, u, up);
    if wall == Wall::Sheet {
        return sheet;
    }
    // The wall is a box 2 thick toward the light: the same sheet, its parallel, a top, a bottom and
    // two sides, with outward faces counter-clockwise.
    let thick = (toward_light * 2.0).as_vec3();
    let at = |k: u32| {
        let pick = |bit: u32, v: Vec3| if k >> bit & 1 == 1 { v } else { Vec3::ZERO };
        corner + pick(0, u) + pick(1, up) + pick(2, thick)
    };
    let faces: [[u32; 4]; 6] = [
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 2, 3, 1],
        [4, 5, 7, 6],
    ];
    let outward = u.cross(up).dot(thick) > 0.0;
    let indices = faces.iter().flat_map(|&[a, b, c, d]| {
        if outward {
            [a, b, c, a, c, d]
        } else {
            [a, c, b, a, d, c]
        }
    });
    Mesh {
        positions: (0..8).map(at).collect(),
        indices: indices.collect(),
    }
}

/// Returns the distances in texels from the foot, as the light sees them, at which the last
/// receiver is half lit, and at which the last is lit at all.
fn gaps(sun: &mut Sun, wall: Wall, elevation: f64, heading: f64, random: &mut Random) -> DVec2 {
    let gpu = gpu();
    let along = DVec3::new(heading.cos(), 0.0, heading.sin());
    // The light comes obliquely across the wall.
    let aside = DVec3::Y.cross(along);
    let level = (aside + along * random.range(-0.7, 0.7)).normalize();
    let light = level * elevation.cos() - DVec3::Y * elevation.sin();
    let foot = random.point(DVec3::new(-0.1, 0.0, -0.1), DVec3::new(0.1, 0.0, 0.1));
    let cull = (wall == Wall::BackOfSolid).then_some(wgpu::Face::Front);
    let pipeline = |cull| {
        let descriptor = CasterPipelineDescriptor {
            primitive: wgpu::PrimitiveState {
                cull_mode: cull,
                ..Default::default()
            },
            ..CasterPipelineDescriptor::new()
        };
        CasterPipeline::new(&gpu.device, &descriptor).expect("a valid pipeline")
    };
    let wall = mesh(wall, foot, along, -aside).caster(gpu, &pipeline(cull), glam::Mat4::IDENTITY);
    let floor = Mesh::floor(0.0, 5.0).caster(gpu, &pipeline(None), glam::Mat4::IDENTITY);
    let casters: [&dyn ShadowCaster; 2] = [&wall, &floor];
    let cover = Aabb::new(Vec3::new(-5.0, -0.5, -5.0), Vec3::new(5.0, HEIGHT, 5.0));
    let coverage = Coverage::Bounds(cover);
    sun.record(DVec3::ZERO, shining(light), coverage, &casters, &[]);
    let texel = sun.texel();
    // Behind the foot the light sees the floor shortened.
    let line = along.reject_from_normalized(light).normalize();
    let shortened = aside
        .reject_from_normalized(light)
        .reject_from_normalized(line)
        .length();
    // The line is no longer than the wall's shadow and the covered floor.
    let long = (LONGEST
        .min(2.5 * shortened / texel)
        .min(0.8 * f64::from(HEIGHT) * elevation.cos() / texel)
        * STEPS as f64) as usize;
    assert!(long > 2 * STEPS, "{long} receivers on a line");
    let mut points = Vec::new();
    for _ in 0..24 {
        let start = foot + along * random.range(-1.5, 1.5);
        points.extend((1..=long).map(|step| {
            let behind = step as f64 / STEPS as f64 * texel / shortened;
            Point::rounded(start + aside * behind, DVec3::Y)
        }));
    }
    let seen = sun.ask(&points);
    let mut worst = DVec2::ZERO;
    for line in seen.chunks(long) {
        let last = |least: f32| line.iter().rposition(|seen| *seen > least);
        let texels = |index: Option<usize>| index.map_or(0.0, |i| (i + 1) as f64 / STEPS as f64);
        worst = worst.max(DVec2::new(texels(last(0.5)), texels(last(1.0 / 255.0))));
    }
    worst
}

/// Seen along the light, a texel has the depth of its centre, half a diagonal away at most, so the
/// middle of the edge lies within 0.71 texels of the foot; the residual offset moves it by 0.1 √2
/// sin² cos ≤ 0.06, and receivers are 1/16 apart. Light comes in as far as the kernel reaches, √2
/// K, and no farther: under the derived bias there is no strip of light at a foot, at any elevation
/// of the light.
#[test]
fn shadows_begin_at_the_foot_of_a_wall() {
    let step = 1.0 / STEPS as f64;
    let mut worst = DVec2::ZERO;
    let mut looks = 0;
    for wall in [Wall::Sheet, Wall::BackOfSolid] {
        for filter in Filter::PLANAR.iter().copied().chain([Filter::default()]) {
            for bias in [Bias::Auto, Bias::NormalOffset] {
                let mut sun = Sun::new(&DirectionalShadowDescriptor {
                    map_size: 256,
                    filter,
                    bias,
                    layout: CascadeLayout::fixed(1),
                    ..Default::default()
                });
                let mut random = Random::new(71);
                for elevation in [5.0, 15.0, 30.0, 45.0, 60.0, 75.0, 85.0_f64] {
                    for heading in [0.0, 0.4, 0.785, 2.0, 4.1] {
                        let angle = elevation.to_radians();
                        let gaps = gaps(&mut sun, wall, angle, heading, &mut random);
                        let limits = DVec2::new(0.71, SQRT_2 * filter.reach_texels()) + 0.06 + step;
                        assert!(
                            gaps.cmple(limits).all(),
                            "{wall:?} {filter:?} {bias:?} elevation {elevation} heading {heading} on {}: {gaps} of {limits}",
                            gpu().describe()
                        );
                        worst = worst.max(DVec2::new(gaps.x, gaps.y / limits.y));
                        looks += 1;
                    }
                }
            }
        }
    }
    table::record(
        "the foot of a wall, and of a solid whose far sides alone are in the map, light at 5 to 85 degrees",
        "the shadow's edge within 0.84 texels of the foot, no light beyond the kernel's reach",
        format!(
            "edge within {:.2} texels, light within {:.2} of the reach, in {looks} views",
            worst.x, worst.y
        ),
    );
}
