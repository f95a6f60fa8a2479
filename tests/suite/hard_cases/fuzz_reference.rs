//! Passes any numbers to the functions that need no device: the CPU reference of the shader, and
//! boxes.

use std::cell::Cell;

use glam::DVec2;
use proptest::prelude::*;
use wgpu_shadows::reference::{DepthLayer, Receiver, holds, receiver, visibility, weight};
use wgpu_shadows::{Aabb, ShadowViewUniform};

use super::fuzz_values::{bias, bounds, filter, matrix, number, run, vector};
use super::table;
use crate::fixtures::view_member::{member, with_member};

/// Generates uniforms of any numbers, and as often whole sizes of maps.
fn uniform() -> impl Strategy<Value = ShadowViewUniform> {
    let words = size_of::<ShadowViewUniform>() / 4;
    let size = prop_oneof![(1..8_u8).prop_map(f32::from), number()];
    (prop::collection::vec(number(), words), size).prop_map(|(numbers, size)| {
        let view = bytemuck::pod_read_unaligned(bytemuck::cast_slice(&numbers));
        with_member(view, "map_size", size)
    })
}

/// Receivers of any numbers, those that the CPU reference returns among them, are sampled over maps
/// of any size, complete or with texels missing.
#[test]
fn any_numbers_in_the_reference_get_a_visibility() {
    let (answers, inside) = (Cell::new(0), Cell::new(0));
    let place = (vector(), vector(), vector(), vector());
    let depths = prop::collection::vec(number(), 0..50);
    let size = prop_oneof![6 => 0..8_u32, 1 => any::<u32>()];
    let all = (uniform(), filter(), bias(), place, depths, size);
    run(300, all, |(view, filter, bias, place, depths, size)| {
        let (position, normal, texel, gradient) = place;
        let (position, normal) = (position.as_dvec3(), normal.as_dvec3());
        let map = DepthLayer {
            size,
            depths: &depths,
        };
        let any = Receiver {
            texel: texel.truncate().abs().as_dvec2(),
            depth: f64::from(texel.z),
            gradient: gradient.truncate().as_dvec2(),
            penumbra: DVec2::splat(f64::from(gradient.z)),
            grid: member(&view, "grid"),
            inside: true,
        };
        let reference = receiver(&view, filter, bias, position, normal);
        let reference_inside = Receiver {
            inside: true,
            ..reference
        };
        for receiver in [reference, reference_inside, any] {
            let seen = visibility(filter, &map, &receiver);
            let sound = (0.0..=1.0).contains(&seen);
            prop_assert!(sound, "{} of {:?} {:?}", seen, filter, receiver);
            answers.set(answers.get() + 1);
            inside.set(inside.get() + usize::from(seen < 1.0));
        }
        prop_assert!(reference.inside == holds(&view, position));
        let weight = weight(&view, position);
        prop_assert!((0.0..=1.0).contains(&weight), "{}", weight);
        Ok(())
    });
    assert!(inside.get() > 50, "{} in shadow", inside.get());
    table::record(
        "any numbers in the reference of the shader's arithmetic",
        "visibilities and weights in 0..=1, no panic",
        format!(
            "{} answers, {} in shadow, 0 broken",
            answers.get(),
            inside.get()
        ),
    );
}

/// Boxes have any numbers: a union contains both, the transform of a box by a finite matrix is a
/// box, and a broken box is not finite.
#[test]
fn any_numbers_in_boxes() {
    let whole = Cell::new(0);
    run(300, (bounds(), bounds(), matrix()), |(a, b, matrix)| {
        let union = a.union(b);
        let moved = a.transformed(&matrix);
        if a.is_finite() && b.is_finite() && !a.is_empty() && !b.is_empty() {
            whole.set(whole.get() + 1);
            prop_assert!(union.is_finite() && !union.is_empty());
            prop_assert!(union.min.cmple(a.min).all() && union.max.cmpge(b.max).all());
            prop_assert_eq!(Aabb::from_points([a.min, a.max, b.min, b.max]), union);
            prop_assert_eq!(a.union(Aabb::EMPTY), a);
            prop_assert!(!moved.is_finite() || !moved.is_empty());
        }
        if a.is_empty() {
            prop_assert!(
                moved.is_empty() || !moved.is_finite(),
                "{:?} of {:?}",
                moved,
                a
            );
        }
        Ok(())
    });
    assert!(whole.get() > 50, "{}", whole.get());
    table::record(
        "any numbers in boxes and in the matrices that move them",
        "whole boxes stay whole, empty ones empty, no panic",
        format!("{} whole of 300, 0 broken", whole.get()),
    );
}
