//! Tests boxes made of numbers of which some are NaN: a broken box stays broken, in whatever order
//! it is combined with others.

use glam::{Mat4, Vec3};
use wgpu_shadows::Aabb;

/// Returns two points, and the same with a NaN in one coordinate of either, in both orders.
fn with_nan() -> impl Iterator<Item = [Vec3; 3]> {
    let whole = [Vec3::new(-1.0, 2.0, -3.0), Vec3::new(4.0, 5.0, 6.0)];
    (0..9).map(move |place| {
        let mut broken = Vec3::new(0.5, 0.25, f32::INFINITY);
        broken[place % 3] = f32::NAN;
        let mut points = [whole[0], whole[1], broken];
        points.rotate_left(place / 3);
        points
    })
}

fn assert_broken(bounds: Aabb, what: &str) {
    assert!(!bounds.is_finite(), "{what}: {bounds:?}");
    assert!(!bounds.is_empty(), "{what}: {bounds:?}");
}

#[test]
fn a_point_that_is_no_number_breaks_its_box() {
    for points in with_nan() {
        let what = format!("{points:?}");
        assert_broken(Aabb::from_points(points), &what);
        assert_broken(
            Aabb::from_points(points.into_iter().rev()),
            &format!("the reverse of {what}"),
        );
    }
    assert_broken(Aabb::from_points([Vec3::NAN]), "NaN alone");
}

/// One coordinate of twelve is NaN; the other box is finite, empty, or neither.
#[test]
fn a_union_with_a_broken_box_is_broken() {
    let others = [
        Aabb::new(Vec3::splat(-1.0), Vec3::splat(2.0)),
        Aabb::new(Vec3::splat(2.0), Vec3::splat(-1.0)),
        Aabb::EMPTY,
        Aabb::new(Vec3::NEG_INFINITY, Vec3::INFINITY),
    ];
    for (place, other) in (0..6).flat_map(|place| others.map(|other| (place, other))) {
        for (low, high) in [(-3.0, 3.0), (3.0, -3.0)] {
            let mut broken = Aabb::new(Vec3::splat(low), Vec3::splat(high));
            let corner = if place < 3 {
                &mut broken.min
            } else {
                &mut broken.max
            };
            corner[place % 3] = f32::NAN;
            let what = format!("{broken:?} and {other:?}");
            assert_broken(broken, &what);
            assert_broken(broken.union(other), &what);
            assert_broken(other.union(broken), &what);
            assert_broken(broken.transformed(&Mat4::IDENTITY), &what);
        }
    }
}

/// A matrix with a NaN or an infinity in any element of its upper three rows breaks a box around
/// the origin, and leaves an empty box empty.
#[test]
fn a_broken_matrix_breaks_boxes() {
    let around = Aabb::new(Vec3::new(-1.0, -2.0, -3.0), Vec3::new(1.0, 2.0, 3.0));
    for element in (0..16).filter(|element| element % 4 != 3) {
        for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            let mut elements = Mat4::IDENTITY.to_cols_array();
            elements[element] = value;
            let matrix = Mat4::from_cols_array(&elements);
            assert_broken(around.transformed(&matrix), &format!("{matrix}"));
            assert_eq!(Aabb::EMPTY.transformed(&matrix), Aabb::EMPTY);
        }
    }
}

#[test]
fn whole_boxes_are_as_they_were() {
    let points = [Vec3::new(-1.0, 2.0, -3.0), Vec3::new(4.0, -5.0, 6.0)];
    let bounds = Aabb::from_points(points);
    let wanted = Aabb::new(Vec3::new(-1.0, -5.0, -3.0), Vec3::new(4.0, 2.0, 6.0));
    assert_eq!(bounds, wanted);
    assert_eq!(Aabb::from_points([]), Aabb::EMPTY);
    assert_eq!(bounds.union(Aabb::EMPTY), wanted);
    assert_eq!(Aabb::EMPTY.union(bounds), wanted);
    let shift = Mat4::from_translation(Vec3::ONE);
    let moved = Aabb::new(wanted.min + 1.0, wanted.max + 1.0);
    assert_eq!(bounds.transformed(&shift), moved);
}
