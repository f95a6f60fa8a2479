//! Tests pools with a budget: the most important lights come first, none waits for ever, and
//! deferred ones keep their last map.

use glam::{DVec3, Mat4, Vec3};
use shadow_support::mesh::Mesh;
use shadow_support::probe::Point;
use wgpu_shadows::{
    Aabb, MeshCaster, OmniLight, ShadowCaster, pool::OmniShadowPool, pool::PoolLight,
    report::ViewReport, report::ViewStatus,
};

use crate::fixtures::ask::Ask;
use crate::fixtures::frames::{PoolFrame, RecordFrame};
use crate::fixtures::gpu::{Gpu, gpu};
use crate::fixtures::scene::default_pipeline;
use crate::suite::pool::{bits, frame, lamp, pool, record};

/// Holds lights far from each other, each over a slab of its own that moves.
struct Row {
    pool: OmniShadowPool,
    lights: Vec<PoolLight<OmniLight>>,
    slabs: Vec<MeshCaster>,
    asks: Vec<Ask>,
}

impl Row {
    fn new(gpu: &Gpu, importances: &[f32]) -> Self {
        let mut pool = pool(importances.len() as u32, 128).expect("a valid pool");
        let pipeline = default_pipeline(gpu);
        let (mut lights, mut slabs) = (Vec::new(), Vec::new());
        for (index, importance) in importances.iter().enumerate() {
            let place = Vec3::new(index as f32 * 100.0, 2.0, 0.0);
            let slot = pool.insert().expect("a free slot");
            let mut light = lamp(slot, place.as_dvec3(), *importance);
            // The light reaches the slab below it and nothing else, so that each needs one view per
            // frame.
            light.light.range = 10.0;
            lights.push(light);
            let low = place - Vec3::new(0.2, 1.1, 0.2);
            let slab = Mesh::cuboid(low, low + Vec3::new(0.4, 0.1, 0.4));
            slabs.push(slab.caster(gpu, &pipeline, Mat4::IDENTITY));
        }
        let asks = lights
            .iter()
            .map(|light| Ask::slot(gpu, pool.maps(), light.slot.index()))
            .collect();
        Self {
            pool,
            lights,
            slabs,
            asks,
        }
    }

    fn move_slabs(&mut self, z: f32) {
        for slab in &mut self.slabs {
            let shift = Mat4::from_translation(Vec3::new(0.0, 0.0, z));
            slab.set_transform(shift).expect("a finite matrix");
        }
    }

    /// Returns which lights were drawn; the others must be reported as deferred.
    fn record(&mut self, gpu: &Gpu, max_views: Option<u32>) -> Vec<usize> {
        let casters: Vec<&dyn ShadowCaster> = self.slabs.iter().map(|slab| slab as _).collect();
        let floors: Vec<_> = (0..self.lights.len())
            .map(|index| {
                let middle = Vec3::new(index as f32 * 100.0, 0.0, 0.0);
                Aabb::new(
                    middle - Vec3::new(1.5, 0.1, 1.5),
                    middle + Vec3::new(1.5, 0.0, 1.5),
                )
            })
            .collect();
        let frame = PoolFrame {
            receivers: &floors,
            max_views,
            ..frame(&self.lights, &casters)
        };
        let report = record(gpu, &mut self.pool, &frame).expect("a valid frame");
        let mut drawn = Vec::new();
        for (index, view) in report.views.iter().enumerate() {
            let light = index / 6;
            match view.status {
                ViewStatus::Drawn => drawn.push(light),
                ViewStatus::Empty | ViewStatus::Kept | ViewStatus::Deferred => {}
                status => panic!("{status:?}"),
            }
        }
        assert_eq!(report.passes, u32::from(!drawn.is_empty()));
        drawn
    }

    /// Returns the visibilities along a line under each light.
    fn seen(&self, gpu: &Gpu, light: usize) -> Vec<f32> {
        let points: Vec<_> = (-20..=20)
            .map(|step| Vec3::new(light as f32 * 100.0, 0.0, step as f32 * 0.07))
            .map(|place| Point::new(place, Vec3::Y))
            .collect();
        self.asks[light].points(gpu, &points)
    }
}

#[test]
fn the_most_important_are_refreshed_first() {
    let gpu = gpu();
    let mut row = Row::new(gpu, &[1.0, 8.0, 2.0, 4.0]);
    assert_eq!(row.record(gpu, None), [0, 1, 2, 3]);
    assert_eq!(row.record(gpu, None), []);
    let before: Vec<_> = (0..4).map(|light| row.seen(gpu, light)).collect();
    assert!(
        before
            .iter()
            .all(|seen| seen.contains(&0.0) && seen.contains(&1.0))
    );
    row.move_slabs(0.3);
    assert_eq!(row.record(gpu, Some(2)), [1, 3]);
    for (light, before) in before.iter().enumerate() {
        // Deferred lights show their last map to the bit, though their slabs have moved; the others
        // do not.
        let same = bits(&row.seen(gpu, light)) == bits(before);
        assert_eq!(same, light == 0 || light == 2, "light {light}");
    }
    let statuses: Vec<_> = row
        .pool
        .maps()
        .report()
        .views
        .iter()
        .map(|view| view.status)
        .collect();
    let deferred = |light: usize| statuses[6 * light..][..6].contains(&ViewStatus::Deferred);
    assert_eq!([0, 1, 2, 3].map(deferred), [true, false, true, false]);
    // Lights that need nothing any longer take no part in the budget: the deferred ones are
    // refreshed.
    assert_eq!(row.record(gpu, Some(1)), [2]);
    assert_eq!(row.record(gpu, Some(1)), [0]);
    assert_eq!(row.record(gpu, Some(1)), []);
}

/// All lights change in every frame. The urgency of a waiting light grows by its importance in each
/// frame, and that of the others starts again when they are refreshed. With importances of 1 to 8,
/// the least waits 8 frames until it equals the first, and at most as many more as there are others
/// before it.
#[test]
fn none_starves() {
    let gpu = gpu();
    let importances = [1.0, 8.0, 2.0, 4.0];
    for budget in [0, 1] {
        let mut row = Row::new(gpu, &importances);
        let mut last = [0; 4];
        for step in 1..=60 {
            row.move_slabs(step as f32 * 0.005);
            let drawn = row.record(gpu, Some(budget));
            assert_eq!(drawn.len(), 1, "one in every frame, and no more: {drawn:?}");
            last[drawn[0]] = step;
            for (light, importance) in importances.iter().enumerate() {
                let most = (15.0 / importance) as i32 + 4;
                assert!(
                    step - last[light] <= most,
                    "light {light} waits since {}",
                    last[light]
                );
            }
        }
    }
}

/// A light that moves while it is deferred keeps its last map as well, even where its views have
/// something to draw.
#[test]
fn a_deferred_light_answers_from_its_last_place() {
    let gpu = gpu();
    let mut row = Row::new(gpu, &[1.0, 8.0]);
    row.record(gpu, None);
    let before = row.seen(gpu, 0);
    assert!(before.contains(&0.0) && before.contains(&1.0));
    for light in &mut row.lights {
        light.light.position_world += DVec3::new(4.0, 0.5, 0.0);
    }
    row.move_slabs(0.1);
    assert_eq!(row.record(gpu, Some(1)), [1]);
    assert_eq!(bits(&row.seen(gpu, 0)), bits(&before));
}

/// A light that has never been drawn is lit until it is refreshed, and its report says that it is
/// deferred.
#[test]
fn a_new_light_is_lit_until_its_turn() {
    let gpu = gpu();
    let mut row = Row::new(gpu, &[1.0, 8.0]);
    assert_eq!(row.record(gpu, Some(1)), [1]);
    assert!(row.seen(gpu, 0).iter().all(|seen| *seen == 1.0));
    let waits = row.pool.maps().report().views[..6]
        .iter()
        .any(|view| view.status == ViewStatus::Deferred);
    assert!(waits, "{:?}", row.pool.maps().report().views);
    assert_eq!(row.record(gpu, Some(1)), [0]);
    assert!(row.seen(gpu, 0).contains(&0.0));
}

/// A light that was not listed for a frame, and is deferred when it is listed again, shows the map
/// that it had.
#[test]
fn a_light_that_comes_back_shows_its_last_map() {
    let gpu = gpu();
    let mut row = Row::new(gpu, &[1.0, 8.0]);
    row.record(gpu, None);
    let before = row.seen(gpu, 0);
    assert!(before.contains(&0.0) && before.contains(&1.0));
    let away = row.lights.remove(0);
    row.record(gpu, None);
    assert!(row.seen(gpu, 0).iter().all(|seen| *seen == 1.0));
    row.lights.insert(0, away);
    row.move_slabs(0.3);
    assert_eq!(row.record(gpu, Some(1)), [1]);
    assert_eq!(bits(&row.seen(gpu, 0)), bits(&before));
}

/// An encoder that is dropped takes the maps with it: a light that is deferred after `invalidate`
/// has none, and is lit. The map that is still in its layer was drawn from another position.
#[test]
fn a_light_whose_map_was_thrown_away_is_lit_until_its_turn() {
    let gpu = gpu();
    let mut row = Row::new(gpu, &[1.0, 8.0]);
    row.record(gpu, None);
    for light in &mut row.lights {
        light.light.position_world.z += 0.5;
    }
    let lights = row.lights.clone();
    let casters: Vec<&dyn ShadowCaster> = row.slabs.iter().map(|slab| slab as _).collect();
    let mut thrown_away = gpu.encoder();
    row.pool
        .record_frame(&mut thrown_away, &frame(&lights, &casters))
        .expect("a valid frame");
    drop(thrown_away);
    row.pool.invalidate();
    assert_eq!(row.record(gpu, Some(1)), [1]);
    let seen = row.seen(gpu, 0);
    assert!(seen.iter().all(|seen| *seen == 1.0), "{seen:?}");
    assert_eq!(row.record(gpu, Some(1)), [0]);
    assert!(row.seen(gpu, 0).contains(&0.0));
}

/// The state of a pool, as text, is as long after 300 frames as after 100, though a light waits
/// through all of them with fewer views to draw than it shows. (Numbers in it grow by some digits.)
#[test]
fn waiting_costs_no_memory() {
    let gpu = gpu();
    let mut row = Row::new(gpu, &[0.0, 8.0]);
    // The casters are all around the first light, for the first frame only.
    let lamp = Vec3::Y * 2.0;
    let around = [Vec3::X, Vec3::NEG_X, Vec3::Z, Vec3::NEG_Z].map(|way| {
        let middle = lamp + way * 1.5;
        Mesh::cuboid(middle - 0.1, middle + 0.1).caster(gpu, &default_pipeline(gpu), Mat4::IDENTITY)
    });
    let lights = row.lights.clone();
    let mut lengths = Vec::new();
    for step in 0..300 {
        row.move_slabs(step as f32 * 1e-4);
        let mut casters: Vec<&dyn ShadowCaster> = row.slabs.iter().map(|slab| slab as _).collect();
        let mut max_views = Some(1);
        if step == 0 {
            casters.extend(around.iter().map(|caster| caster as &dyn ShadowCaster));
            max_views = None;
        }
        let frame = PoolFrame {
            max_views,
            ..frame(&lights, &casters)
        };
        let report = record(gpu, &mut row.pool, &frame).expect("a valid frame");
        let waits = |view: &ViewReport| view.status == ViewStatus::Deferred;
        assert_eq!(report.views.iter().any(waits), step > 0);
        if step % 100 == 99 {
            lengths.push(format!("{:?}", row.pool).len());
        }
    }
    assert!(lengths[2] < lengths[0] + 400, "{lengths:?}");
}

/// A view whose static-caster cache is drawn as well counts twice.
#[test]
fn no_frame_draws_more_views_than_the_budget() {
    let gpu = gpu();
    let pipeline = default_pipeline(gpu);
    let mut pool = pool(4, 512).expect("a valid pool");
    let lights: Vec<_> = (0..4)
        .map(|index| {
            let slot = pool.insert().expect("a free slot");
            let mut light = lamp(slot, DVec3::new(index as f64 * 0.1, 2.0, 0.0), 1.0);
            light.light.range = 10.0;
            light
        })
        .collect();
    let boxes: Vec<_> = (0..12)
        .map(|index| {
            let low = Vec3::new(index as f32 * 0.1 - 0.6, 0.9, 0.3);
            Mesh::cuboid(low, low + 0.05).caster(gpu, &pipeline, Mat4::IDENTITY)
        })
        .collect();
    let mut mover = Mesh::cuboid(Vec3::new(0.0, 0.8, -0.2), Vec3::new(0.1, 0.9, -0.1)).caster(
        gpu,
        &pipeline,
        Mat4::IDENTITY,
    );
    let floor = Aabb::new(Vec3::new(-1.5, -0.1, -1.5), Vec3::new(1.5, 0.0, 1.5));
    let (mut copied, mut renewed) = (0, 0);
    for step in 0..120 {
        let shift = Vec3::Z * 0.002 * step as f32;
        mover
            .set_transform(Mat4::from_translation(shift))
            .expect("a finite matrix");
        let mut casters: Vec<&dyn ShadowCaster> = vec![&mover];
        casters.extend(boxes.iter().map(|caster| caster as &dyn ShadowCaster));
        let frame = PoolFrame {
            receivers: &[floor],
            max_views: Some(2),
            ..frame(&lights, &casters)
        };
        let report = record(gpu, &mut pool, &frame).expect("a valid frame");
        let drawn = report.views.iter();
        let drawn = drawn.filter(|view| view.status == ViewStatus::Drawn);
        let drawn = drawn.count() as u32;
        // The second pass is that over the static-caster caches, of one view at least.
        let rendered = drawn + report.passes.saturating_sub(1);
        assert!(rendered <= 2, "{rendered} views in {step}");
        renewed += u32::from(report.passes == 2);
        copied += report.views.iter().map(|view| view.copied).sum::<u32>();
    }
    assert!(renewed > 0, "static casters are cached");
    assert!(copied > 0, "static casters are copied");
}
