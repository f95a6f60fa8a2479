//! Tests importances of any finite magnitude: no light with one above zero waits for ever.

use glam::{DVec3, Mat4, Vec3};
use shadow_support::mesh::Mesh;
use wgpu_shadows::{
    Aabb, ShadowCaster, SpotLight, pool::PoolDescriptor, pool::PoolLight, pool::SpotShadowPool,
    report::ViewStatus,
};

use crate::fixtures::frames::{PoolFrame, RecordFrame};
use crate::fixtures::gpu::gpu;
use crate::fixtures::scene::default_pipeline;
use crate::fixtures::watched::Watched;
use crate::suite::pool::frame;

/// Is the least importance that a light counts for, as a fraction of the greatest.
const LEAST_SHARE: f64 = 1.0 / 4096.0;

/// Returns the largest number of frames from one refresh to the next of a light among
/// `importances`, all of which change in every frame under a budget of one view.
///
/// Let `w` be its weight, `W` the greatest, and `n` their number. From the frame `K` on in which
/// `w (1 + K) > (n - 1) W`, a light that precedes it has waited for at least `n - 1` frames, since
/// otherwise its own product is at most `(n - 1) W`. So in `n - 1` such frames all the others are
/// refreshed, once each, and then none is left to precede it.
fn longest_wait(importances: &[f32], light: usize) -> usize {
    let greatest = importances.iter().copied().fold(0.0, f32::max);
    let weight = f64::from(importances[light]).max(f64::from(greatest) * LEAST_SHARE);
    let others = importances.len() - 1;
    (others as f64 * f64::from(greatest) / weight).ceil() as usize + others + 1
}

/// Returns for each light the frames in which it was drawn, of `frames`.
fn drawn(importances: &[f32], max_views: u32, frames: usize) -> Vec<Vec<usize>> {
    let gpu = gpu();
    let descriptor = PoolDescriptor {
        capacity: importances.len() as u32,
        map_size: 64,
        ..Default::default()
    };
    let mut pool = SpotShadowPool::new(&gpu.device, &descriptor).expect("a valid pool");
    let pipeline = default_pipeline(gpu);
    let (mut lights, mut slabs, mut floors) = (Vec::new(), Vec::new(), Vec::new());
    for (index, importance) in importances.iter().enumerate() {
        let place = Vec3::new(index as f32 * 100.0, 2.0, 0.0);
        lights.push(PoolLight {
            slot: pool.insert().expect("a free slot"),
            light: SpotLight {
                position_world: place.as_dvec3(),
                direction: Vec3::NEG_Y,
                outer_angle_radians: 0.6,
                range: 10.0,
            },
            importance: *importance,
        });
        let low = place - Vec3::new(0.2, 1.1, 0.2);
        let slab = Mesh::cuboid(low, low + Vec3::new(0.4, 0.1, 0.4));
        let mut slab = Watched::new(slab.caster(gpu, &pipeline, Mat4::IDENTITY));
        slab.revision = Some(None);
        slabs.push(slab);
        let floor = place.with_y(0.0);
        floors.push(Aabb::new(floor - Vec3::new(1.0, 0.1, 1.0), floor + 1.0));
    }
    let casters: Vec<&dyn ShadowCaster> = slabs.iter().map(|slab| slab as _).collect();
    let mut drawn = vec![Vec::new(); importances.len()];
    let mut encoder = gpu.encoder();
    for step in 0..frames {
        if step % 64 == 63 {
            gpu.submit(std::mem::replace(&mut encoder, gpu.encoder()));
        }
        let frame = PoolFrame {
            origin: DVec3::ZERO,
            receivers: &floors,
            max_views: Some(max_views),
            ..frame(&lights, &casters)
        };
        let report = pool
            .record_frame(&mut encoder, &frame)
            .expect("a valid frame");
        for (index, view) in report.views.iter().enumerate() {
            match view.status {
                ViewStatus::Drawn => drawn[index].push(step),
                status => assert_eq!(status, ViewStatus::Deferred),
            }
        }
    }
    gpu.submit(encoder);
    drawn
}

#[test]
fn none_above_zero_starves_at_any_finite_importance() {
    let sets: [&[f32]; 4] = [
        &[2e38; 3],
        &[f32::MAX; 4],
        &[1e-45; 3],
        &[f32::MAX, 1.0, f32::MIN_POSITIVE, 1e-45],
    ];
    for importances in sets {
        let lights = 0..importances.len();
        let waits: Vec<_> = lights
            .map(|light| longest_wait(importances, light))
            .collect();
        let frames = waits.iter().max().expect("a light") + 8;
        for (light, steps) in drawn(importances, 1, frames).iter().enumerate() {
            let mut before = 0;
            for step in steps.iter().copied().chain([frames]) {
                assert!(
                    step - before <= waits[light],
                    "light {light} of {importances:?} waits from {before} to {step}"
                );
                before = step;
            }
        }
    }
}

/// A light of importance zero is refreshed from what the others leave, however small their
/// importance.
#[test]
fn a_light_at_zero_waits_for_all_others() {
    let steps = drawn(&[0.0, 1e-45, f32::MAX], 1, 200);
    assert_eq!(steps[0], []);
    assert!(!steps[2].is_empty());
    let steps = drawn(&[0.0, 1e-45], 2, 20);
    assert_eq!(steps[0].len(), 20);
}

/// Within the bound importances count as they are: a light with an eighth waits seven frames until
/// it equals the other.
#[test]
fn importances_within_the_bound_count_as_they_are() {
    for scale in [f32::MIN_POSITIVE, 1.0, 4e37] {
        let steps = drawn(&[scale, 8.0 * scale], 1, 160);
        let wanted: Vec<_> = (7..160).step_by(8).collect();
        assert_eq!(steps[0], wanted);
        assert_eq!(steps[1].len(), 140);
    }
}
