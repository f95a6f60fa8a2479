//! Inserts, removes and records lights of a pool in any order.

use std::cell::RefCell;

use glam::DVec3;
use proptest::prelude::*;
use wgpu_shadows::{
    OmniLight, pool::OmniShadowPool, pool::PoolDescriptor, pool::PoolLight, pool::ShadowSlot,
};

use super::fuzz_values::{Counts, number, run};
use crate::fixtures::frames::{PoolFrame, RecordFrame};
use crate::fixtures::gpu::gpu;

/// Lists what may be done with a pool.
#[derive(Clone, Debug)]
enum Step {
    Insert,
    /// Removes a slot that was returned at some time, by this pool or by another.
    Remove(usize),
    /// Records a frame of such slots.
    Record(Vec<usize>, f32),
}

/// Whatever the order, slots are returned once and removed once, and only occupied ones are
/// recorded, each once per frame.
#[test]
fn any_coming_and_going_in_a_pool() {
    let gpu = gpu();
    let counts = Counts::default();
    let descriptor = PoolDescriptor {
        map_size: 8,
        capacity: 3,
        ..Default::default()
    };
    let step = prop_oneof![
        4 => Just(Step::Insert),
        3 => (0..12_usize).prop_map(Step::Remove),
        3 => (prop::collection::vec(0..12_usize, 0..4), number()).prop_map(|(slots, n)| Step::Record(slots, n)),
    ];
    let pools = RefCell::new((
        OmniShadowPool::new(&gpu.device, &descriptor).expect("a pool"),
        OmniShadowPool::new(&gpu.device, &descriptor).expect("a pool"),
    ));
    run(100, prop::collection::vec(step, 1..24), |steps| {
        let (pool, other) = &mut *pools.borrow_mut();
        let stranger = other.insert().expect("the other pool is emptied each time");
        let mut given: Vec<ShadowSlot> = vec![stranger];
        let mut alive: Vec<ShadowSlot> = Vec::new();
        for step in steps {
            match step {
                Step::Insert => {
                    let result = pool.insert();
                    counts.count(&result);
                    prop_assert_eq!(result.is_ok(), alive.len() < 3);
                    if let Ok(slot) = result {
                        prop_assert!(!given.contains(&slot) && slot.index() < 3);
                        prop_assert!(alive.iter().all(|other| other.index() != slot.index()));
                        given.push(slot);
                        alive.push(slot);
                    }
                }
                Step::Remove(index) => {
                    let slot = given[index % given.len()];
                    let result = pool.remove(slot);
                    counts.count(&result);
                    prop_assert_eq!(result.is_ok(), alive.contains(&slot));
                    alive.retain(|other| *other != slot);
                }
                Step::Record(indices, importance) => {
                    let slots: Vec<_> = indices
                        .iter()
                        .map(|index| given[index % given.len()])
                        .collect();
                    let lights: Vec<_> = slots
                        .iter()
                        .map(|slot| PoolLight {
                            slot: *slot,
                            light: OmniLight {
                                position_world: DVec3::ZERO,
                                range: 3.0,
                            },
                            importance,
                        })
                        .collect();
                    let frame = PoolFrame {
                        origin: DVec3::ZERO,
                        lights: &lights,
                        camera: None,
                        casters: &[],
                        receivers: &[],
                        max_views: Some(1),
                    };
                    let mut encoder = gpu.encoder();
                    let result = pool.record_frame(&mut encoder, &frame).map(|_| ());
                    counts.count(&result);
                    gpu.submit(encoder);
                    let once = (1..slots.len()).all(|k| !slots[..k].contains(&slots[k]));
                    let living = slots.iter().all(|slot| alive.contains(slot));
                    let sound = slots.is_empty() || (importance >= 0.0 && importance.is_finite());
                    prop_assert_eq!(result.is_ok(), once && living && sound, "{:?}", result);
                }
            }
        }
        for slot in alive {
            prop_assert!(pool.remove(slot).is_ok());
        }
        prop_assert!(other.remove(stranger).is_ok());
        Ok(())
    });
    counts.finish(
        "any order of insert, remove and record in a pool",
        "living slots alone, each once, no panic, no device error",
    );
}
