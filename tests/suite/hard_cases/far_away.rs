//! Tests worlds that lie far from the world's origin, with and without an engine that renders
//! relative to its camera.

use glam::{DMat3, DVec3};
use shadow_support::probe::Point;
use shadow_support::random::Random;
use wgpu_shadows::{
    Aabb, CascadeLayout, DepthFormat, DirectionalLight, DirectionalShadowDescriptor,
    ShadowViewUniform,
};

use super::stage::{
    MARGIN, Sun, Verdict, any_camera, bounds_of, boxes, level, meshes, scene, shining, world,
};
use super::table;
use crate::fixtures::frames::Coverage;
use crate::fixtures::rounding::U;
use crate::fixtures::view_member::with_member;

const MAP_SIZE: u32 = 256;
const FLOOR_HALF: f32 = 7.4;

/// Returns what a frame at `origin` shows of a scene whose fit has texels and depth steps that are
/// powers of two.
fn look_along(
    light: DVec3,
    origin: DVec3,
    depth_format: DepthFormat,
) -> (Vec<f32>, Vec<ShadowViewUniform>) {
    let mut boxes = boxes();
    // A mast that is as high as the covered box determines the depth range.
    boxes.push((DVec3::new(6.3, 0.0, 6.1), DVec3::new(6.6, 7.3, 6.4)));
    let scene = scene(&meshes(&boxes, FLOOR_HALF, DMat3::IDENTITY, DVec3::ZERO));
    let mut sun = Sun::new(&DirectionalShadowDescriptor {
        map_size: MAP_SIZE,
        depth_format,
        layout: CascadeLayout::fixed(1),
        ..Default::default()
    });
    // The width is 15 under 249 usable texels: 0.0602 each, for which the next size is 1/16; the
    // depth is 15: 16.
    sun.record(
        origin,
        DirectionalLight::new(light.as_vec3()),
        Coverage::Bounds(Aabb::new(glam::Vec3::splat(-7.5), glam::Vec3::splat(7.5))),
        &scene.list(),
        &[],
    );
    let view = *sun.shadow.maps().views().next().expect("a view");
    assert_eq!(view.texel_size_world(), glam::Vec2::splat(1.0 / 16.0));
    let step = view.depth_range_world() / 64.0;
    assert_eq!(step.log2().fract(), 0.0, "{step}");
    let mut random = Random::new(7);
    let points: Vec<_> = (0..2048)
        .map(|_| random.point(DVec3::splat(-7.0), DVec3::new(7.0, 4.0, 7.0)))
        .map(|place| Point::rounded(place, -light))
        .collect();
    // The grid of rotated patterns is fixed in the world, and so it is the only value that differs
    // between positions.
    let uniforms = sun.shadow.maps().view_uniforms().iter();
    let uniforms = uniforms.map(|view| with_member(*view, "grid", 0_u32));
    (sun.ask(&points), uniforms.collect())
}

/// Under light along an axis, a position a power of two away lies a whole number of texels and
/// depth steps away, and all arithmetic of the fit is exact in f64: not one bit of the uniforms or
/// of the visibilities may differ.
#[test]
fn a_world_far_away_is_shadowed_to_the_bit() {
    let axes = [DVec3::NEG_Y, DVec3::X, DVec3::NEG_Z];
    let mut compared = 0;
    let formats = [DepthFormat::Float32, DepthFormat::Unorm16];
    for (light, format) in axes
        .into_iter()
        .flat_map(|axis| formats.map(|format| (axis, format)))
    {
        let (near, near_views) = look_along(light, DVec3::ZERO, format);
        let dark = near.iter().filter(|seen| **seen == 0.0).count();
        assert!(dark > 30 && dark < 2000, "{dark} dark along {light}");
        for exponent in [10, 13, 17, 20, 23, 24] {
            let away = f64::from(exponent).exp2();
            for origin in [DVec3::splat(away), DVec3::new(-away, 2.0 * away, away)] {
                let (far, far_views) = look_along(light, origin, format);
                assert_eq!(
                    bytemuck::cast_slice::<_, u8>(&near_views),
                    bytemuck::cast_slice::<_, u8>(&far_views),
                    "light {light} origin {origin} {format:?}"
                );
                let same = near.iter().zip(&far);
                assert!(
                    same.clone().all(|(a, b)| a.to_bits() == b.to_bits()),
                    "light {light} origin {origin} {format:?}"
                );
                compared += far.len();
            }
        }
    }
    table::record(
        "world coordinates 2^10 to 2^25 with an origin, both depth formats",
        "bit-identical to the world at zero",
        format!("0 bits differ in {compared} visibilities"),
    );
}

/// Returns positions on the floor, most of them in and around shadows.
fn floor_places(light: DVec3) -> Vec<DVec3> {
    let world = world(light, any_camera());
    let mut random = Random::new(23);
    let anywhere =
        (0..700).map(|_| random.point(DVec3::new(-6.5, 0.0, -6.5), DVec3::new(6.5, 0.0, 6.5)));
    let mut places: Vec<_> = world.floor_around_shadows(1400).into_iter().collect();
    places.extend(anywhere);
    places.retain(|place| place.abs().max_element() < 6.8);
    places
        .iter()
        .map(|place| place.as_vec3().as_dvec3())
        .collect()
}

fn lights() -> [DVec3; 3] {
    [
        DVec3::new(0.31, -1.0, 0.22),
        DVec3::new(-0.9, -0.7, 0.4),
        DVec3::new(0.05, -1.0, -0.6),
    ]
}

/// At other distances the grid of texels lies differently on the scene, so edges may move within a
/// kernel; every receiver whose truth is the same for three texels around is correct.
#[test]
fn a_world_anywhere_far_away_is_shadowed_as_the_truth_says() {
    let mut all = Verdict::default();
    for light in lights() {
        let world = world(light, any_camera());
        let scene = scene(&meshes(&boxes(), FLOOR_HALF, DMat3::IDENTITY, DVec3::ZERO));
        let places = floor_places(light);
        let points = level(&places, DVec3::ZERO);
        for away in [0.0, 1e3, 1e4, 1e5, 1e6, 1e7] {
            let mut sun = Sun::of_size(MAP_SIZE);
            let origin = DVec3::new(1.0, -0.3, 0.77) * away;
            sun.record(
                origin,
                shining(world.light),
                Coverage::Bounds(bounds_of(&meshes(
                    &boxes(),
                    FLOOR_HALF,
                    DMat3::IDENTITY,
                    DVec3::ZERO,
                ))),
                &scene.list(),
                &[],
            );
            let seen = sun.ask(&points);
            let verdict = Verdict::of(&world, &places, &seen, sun.texel(), MARGIN);
            verdict.assert_right(&format!("light {light} origin {origin}"));
            all.add(&verdict);
        }
    }
    table::record(
        "world coordinates 1e3 to 1e7 with an origin, oblique light",
        "settled receivers as the truth says",
        all.words(),
    );
}

/// Without an origin, f32 coordinates of a scene `P` away are off by half an ulp each, at most
/// `2uP` together for caster and receiver on each axis, and the bias grows by `4uP`: settled
/// receivers have that much more around them, and no surface shadows itself. Beyond 1e5 the scene
/// is a hundred times as large, since an f32 has steps of one unit at 1e7.
#[test]
fn render_coordinates_far_away_err_by_no_more_than_their_rounding() {
    let mut all = Verdict::default();
    let mut most: f64 = 0.0;
    for light in lights() {
        let world = world(light, any_camera());
        let places = floor_places(light);
        for (away, unit) in [
            (1e3, 1.0),
            (1e4, 1.0),
            (1e5, 1.0),
            (1e6, 100.0),
            (1e7, 100.0),
        ] {
            let shift = DVec3::new(1.0, 0.0, 0.77) * away;
            let meshes = meshes(&boxes(), FLOOR_HALF, DMat3::IDENTITY * unit, shift);
            let scene = scene(&meshes);
            let mut sun = Sun::of_size(MAP_SIZE);
            sun.record(
                DVec3::ZERO,
                shining(world.light),
                Coverage::Bounds(bounds_of(&meshes)),
                &scene.list(),
                &[],
            );
            let texel = sun.texel();
            let rounding = 8.0 * U * away / texel;
            most = most.max(rounding);
            let scaled: Vec<_> = places.iter().map(|place| *place * unit).collect();
            let seen = sun.ask(&level(&scaled, shift));
            let verdict = Verdict::of(&world, &places, &seen, texel / unit, MARGIN + rounding);
            verdict.assert_right(&format!("light {light} at {away} without an origin"));
            all.add(&verdict);
        }
    }
    table::record(
        "render coordinates 1e3 to 1e7 without an origin",
        "settled receivers as the truth says, 8uP more around them",
        format!("{}, rounding up to {most:.2} texels", all.words()),
    );
}
