//! Tests a static scene under a moving camera: what does not move in the world keeps its shadow.

use std::f64::consts::TAU;

use glam::{DMat3, DVec3};
use shadow_support::camera::Camera;
use wgpu_shadows::{CascadeLayout, DirectionalShadowDescriptor, ShadowView};

use super::stage::{Sun, boxes, differ, level, meshes, scene, shining, world};
use super::table;
use crate::fixtures::frames::Coverage;
use crate::fixtures::rounding::U;
use crate::fixtures::town::town;

const LIGHT: DVec3 = DVec3::new(0.37, -1.0, 0.21);

/// Returns a camera that jitters by a fraction of a texel and turns by a fraction of a pixel.
fn trembling(frame: u32) -> Camera {
    let t = f64::from(frame);
    let tremble = DVec3::new((t * 0.71).sin(), (t * 0.53).cos(), (t * 0.37).sin()) * 0.004;
    let turn = DVec3::new((t * 0.29).sin(), 0.0, (t * 0.43).cos()) * 0.01;
    let eye = DVec3::new(4.2, 5.1, 8.3) + tremble;
    Camera::modern(eye, DVec3::new(0.2, 0.4, -0.3) + turn, 0.9, 1.6)
}

/// Returns positions of the floor in and around the boxes' shadows.
fn samples() -> Vec<DVec3> {
    world(LIGHT, trembling(0))
        .floor_around_shadows(1024)
        .into_iter()
        .map(|place| place.as_vec3().as_dvec3())
        .collect()
}

/// As long as the fitted views are the same, no sample changes by a bit, wherever the world lies;
/// and they are the same in all but a twentieth of the frames.
#[test]
fn a_trembling_camera_leaves_shadows_alone() {
    let scene = scene(&meshes(&boxes(), 40.0, DMat3::IDENTITY, DVec3::ZERO));
    let points = level(&samples(), DVec3::ZERO);
    let mut words = Vec::new();
    for away in [0.0, 1e3, 1e6] {
        let mut sun = Sun::of_size(512);
        let mut last: Option<(Vec<_>, Vec<f32>)> = None;
        let mut moved = 0;
        for frame in 0..200 {
            sun.record(
                DVec3::new(1.0, 0.1, -0.7) * away,
                shining(LIGHT),
                Coverage::Camera(trembling(frame).view()),
                &scene.list(),
                &[],
            );
            let now = (
                sun.shadow.maps().views().copied().collect(),
                sun.ask(&points),
            );
            let partial = now.1.iter().filter(|seen| **seen > 0.0 && **seen < 1.0);
            assert!(partial.count() > 10, "samples on edges of shadows");
            if let Some((views, seen)) = last {
                if views == now.0 {
                    assert_eq!(seen, now.1, "frame {frame} at {away}");
                } else {
                    moved += 1;
                }
            }
            last = Some(now);
        }
        assert!(moved <= 10, "{moved} of 200 windows moved at {away}");
        words.push(format!("{moved} windows moved at {away:.0e}"));
    }
    table::record(
        "a camera that trembles by less than a texel, 200 frames",
        "no sample changes while the window stays; at most 10 windows move",
        format!("0 samples changed; {}", words.join(", ")),
    );
}

/// An engine that renders relative to its camera gives every sample new f32 coordinates in every
/// frame. They err by `4u` of the distance each, and texel coordinates by `14uN` more; a sample
/// changes by no more than the sharpness of three per texel and axis. Only where a comparison is a
/// tie can more change: at most one sample in five hundred.
#[test]
fn a_trembling_origin_leaves_shadows_alone() {
    let samples = samples();
    let mut words = Vec::new();
    for away in [0.0, 1e3, 1e6] {
        let mut sun = Sun::of_size(512);
        let mut first: Option<Vec<f32>> = None;
        let (mut flips, mut texel) = (0, None);
        for frame in 0..60 {
            // The camera's position is in f32, exact in f64; coordinates relative to it are
            // rounded.
            let mut camera = trembling(frame);
            let eye = camera.pose.eye;
            camera.pose.eye = DVec3::ZERO;
            let scene = scene(&meshes(&boxes(), 40.0, DMat3::IDENTITY, -eye));
            sun.record(
                DVec3::new(1.0, 0.1, -0.7) * away + eye,
                shining(LIGHT),
                Coverage::Camera(camera.view()),
                &scene.list(),
                &[],
            );
            let seen = sun.ask(&level(&samples, -eye));
            // Light-space bounds of another size give another image.
            if texel != Some(sun.texel()) {
                texel = Some(sun.texel());
                first = None;
            }
            let first = first.get_or_insert_with(|| seen.clone());
            let reach = 12.0;
            let rounding = 4.0 * U * reach / sun.texel() + 14.0 * U * 512.0;
            let band = (2.0 * 2.0 * 3.0 * rounding) as f32;
            let pairs = seen.iter().zip(&*first);
            flips += pairs.filter(|(a, b)| differ(**a, **b, band)).count();
        }
        let all = 60 * samples.len();
        assert!(flips * 500 <= all, "{flips} of {all} at {away}");
        words.push(format!("{flips} of {all} at {away:.0e}"));
    }
    table::record(
        "an origin that trembles with the camera, 60 frames",
        "at most 1 in 500 answers changes beyond rounding",
        words.join(", "),
    );
}

const WALK_FRAMES: u32 = 400;

/// Counts, for each of four cascades, the frames of a walk in which light-space bounds move, and
/// those in which their texels take another size. The camera walks (1.5 units a second at 60
/// frames) and turns (20 degrees a second) through a town.
fn changes_in_a_walk(map_size: u32, layout: CascadeLayout<'_>) -> [[usize; 4]; 2] {
    let scene = scene(&town(29));
    let mut sun = Sun::new(&DirectionalShadowDescriptor {
        map_size,
        layout,
        ..Default::default()
    });
    let mut last = [None; 4];
    let (mut moved, mut rescaled) = ([0_usize; 4], [0_usize; 4]);
    for frame in 0..WALK_FRAMES {
        let time = f64::from(frame) / 60.0;
        let eye = DVec3::new(-20.0 + 1.5 * time, 1.7, 1.0);
        let angle = TAU * time * 20.0 / 360.0;
        let target = eye + DVec3::new(angle.cos(), -0.03, angle.sin());
        let camera = Camera::modern(eye, target, 1.0, 16.0 / 9.0).view();
        sun.record(
            DVec3::ZERO,
            shining(LIGHT),
            Coverage::Camera(camera.with_max_distance(120.0)),
            &scene.list(),
            &[],
        );
        for (cascade, view) in sun.shadow.maps().views().copied().enumerate() {
            let size = |view: ShadowView| view.texel_size_world();
            if let Some(before) = last[cascade].replace(view) {
                moved[cascade] += usize::from(before != view);
                rescaled[cascade] += usize::from(size(before) != size(view));
            }
        }
    }
    [moved, rescaled]
}

/// Light-space bounds that keep their texel size move by whole texels, which is invisible; those
/// that take another size step are visible, and of the four cascades' bounds at most a twentieth do
/// so from one frame to the next. The same holds where the layout of the cascades is found.
#[test]
fn windows_rarely_change_in_a_walk_through_a_town() {
    let share = |changes: [usize; 4]| {
        let all = changes.iter().sum::<usize>();
        100.0 * all as f64 / f64::from(4 * WALK_FRAMES)
    };
    for (case, map_size, layout) in [
        (
            "a walk through a town, four cascades",
            256,
            CascadeLayout::fixed(4),
        ),
        (
            "a walk through a town, a layout that is found for as many texels",
            512,
            CascadeLayout::Automatic { max_cascades: 4 },
        ),
    ] {
        let [moved, rescaled] = changes_in_a_walk(map_size, layout);
        table::record(
            case,
            "at most 5 % of windows change their texels from frame to frame",
            format!(
                "{:.1} % change texels {rescaled:?}, {:.1} % move {moved:?}",
                share(rescaled),
                share(moved)
            ),
        );
        assert!(share(rescaled) <= 5.0, "{case}: {rescaled:?}");
        // Bounds that followed every motion of the camera would move in every frame.
        assert!(share(moved) <= 20.0, "{case}: {moved:?}");
    }
}

/// Light-space bounds move by whole texels: where the texel size stays, what the camera sees before
/// and after keeps its shadow to the rounding of texel coordinates (`56uN` in all, times the
/// sharpness), except for ties of comparisons: one in five hundred.
#[test]
fn a_window_that_moves_leaves_shadows_alone() {
    const MAP_SIZE: u32 = 512;
    let scene = scene(&meshes(&boxes(), 40.0, DMat3::IDENTITY, DVec3::ZERO));
    let samples = samples();
    let points = level(&samples, DVec3::ZERO);
    let band = (168.0 * U * f64::from(MAP_SIZE)) as f32 + 1e-5;
    let mut sun = Sun::of_size(MAP_SIZE);
    let mut last: Option<(ShadowView, Vec<f32>, Camera)> = None;
    let (mut moves, mut compared, mut changed) = (0, 0, 0);
    for frame in 0..240 {
        let t = f64::from(frame) * 0.05;
        let eye = DVec3::new(t.sin() * 4.0, 3.5, 5.0 + t.cos());
        let camera = Camera::modern(eye, DVec3::new(t.cos(), 0.4, -0.3), 0.7, 1.6);
        // Without a history, extents shrink at once, so that they change more often.
        sun.shadow.reset_history();
        let coverage = Coverage::Camera(camera.view());
        sun.record(DVec3::ZERO, shining(LIGHT), coverage, &scene.list(), &[]);
        let view = *sun.shadow.maps().views().next().expect("a view");
        let seen = sun.ask(&points);
        if let Some((before, seen_before, camera_before)) = &last
            && *before != view
            && before.texel_size_world() == view.texel_size_world()
        {
            moves += 1;
            for ((place, a), b) in samples.iter().zip(&seen).zip(seen_before) {
                let in_both = [&camera, camera_before]
                    .iter()
                    .all(|camera| camera.sees(*place, f64::INFINITY, 0.001));
                if in_both {
                    compared += 1;
                    changed += usize::from(differ(*a, *b, band));
                }
            }
        }
        last = Some((view, seen, camera));
    }
    assert!(moves >= 10 && compared > 2000, "{moves} {compared}");
    table::record(
        "windows that move",
        "at most 1 in 500 visible samples changes beyond rounding",
        format!("{changed} of {compared} in {moves} moves"),
    );
    assert!(changed * 500 <= compared, "{changed} of {compared}");
}
