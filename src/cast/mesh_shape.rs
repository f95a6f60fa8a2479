//! Recognises meshes that cannot shadow themselves.

use glam::{DVec3, Vec3};

use crate::Aabb;
use crate::cast::is_closed_solid;
use crate::fit::CasterShape;

/// Is the largest number of triangles of a mesh that is examined for convexity: each of them is
/// compared with every vertex. Finer meshes count as [`CasterShape::Any`].
const MAX_TRIANGLES: usize = 4096;

/// Is the distance from a plane, as a fraction of the mesh's extent, within which a vertex counts
/// as lying on the plane: sines and rotations in f32 have errors of this size.
const TOLERANCE: f64 = 1.0 / (1 << 20) as f64;

/// Returns what [`ShadowCaster::shape`](crate::ShadowCaster::shape) of a triangle list should
/// return in the space of its `positions`; [`CasterShape::transformed`] takes the result to render
/// space. Every three `indices` are a triangle, and an incomplete last one is ignored.
///
/// The shape is [`CasterShape::Convex`] for a mesh that lies in a plane, even with holes, and for a
/// closed solid ([`is_closed_solid`]) that has no vertex in front of any of its faces. It is
/// [`CasterShape::Cuboid`] for such a solid if its volume is that of its bounds. It is
/// [`CasterShape::Any`], which is always correct, for all other meshes, for those of more than 4096
/// triangles, and for indices without a position. The function compares each triangle with every
/// vertex: call it once, at load time.
pub fn caster_shape(positions: &[Vec3], indices: &[u32]) -> CasterShape {
    let has_positions = indices
        .iter()
        .all(|&index| (index as usize) < positions.len());
    let triangles = indices.len() / 3;
    if !has_positions || triangles == 0 || triangles > MAX_TRIANGLES {
        return CasterShape::Any;
    }
    let used = || indices.iter().map(|&index| positions[index as usize]);
    let bounds = Aabb::from_points(used());
    if !bounds.is_finite() {
        return CasterShape::Any;
    }
    let size = bounds.max.as_dvec3() - bounds.min.as_dvec3();
    let tolerance = TOLERANCE * size.max_element();
    let faces = || {
        indices.chunks_exact(3).map(|corners| {
            let corner = |index: usize| positions[corners[index] as usize].as_dvec3();
            [corner(0), corner(1), corner(2)]
        })
    };
    // The largest triangle defines the plane of a flat mesh best.
    let area_normal = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a);
    let largest = faces().max_by(|a, b| {
        let area = |face: &[DVec3; 3]| area_normal(*face).length_squared();
        area(a).total_cmp(&area(b))
    });
    let in_front_of = |face: [DVec3; 3]| {
        let normal = area_normal(face).normalize_or_zero();
        used().map(move |point| normal.dot(point.as_dvec3() - face[0]))
    };
    let is_flat = largest.is_some_and(|face| in_front_of(face).all(|d| d.abs() <= tolerance));
    if is_flat {
        return CasterShape::Convex;
    }
    let is_convex = is_closed_solid(positions, indices)
        && faces().all(|face| in_front_of(face).all(|distance| distance <= tolerance));
    if !is_convex {
        return CasterShape::Any;
    }
    let center = bounds.min.as_dvec3();
    let volume = faces().map(|[a, b, c]| (a - center).dot((b - center).cross(c - center)) / 6.0);
    // Where the volume of a convex solid is smaller than that of its box by less than this, the
    // solid is no farther from any corner of the box than the cube root of six times as much.
    if volume.sum::<f64>() >= size.element_product() * (1.0 - 3.0 * TOLERANCE) {
        CasterShape::Cuboid
    } else {
        CasterShape::Convex
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{Mat4, Quat};

    const CUBE: [u32; 36] = [
        0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6,
        1, 3, 5, 3, 7, 5,
    ];

    fn corners() -> Vec<Vec3> {
        let bounds = Aabb::new(Vec3::new(-500.0, -1.0, -30.0), Vec3::new(500.0, 0.0, 30.0));
        (0..8).map(|index| bounds.corner(index)).collect()
    }

    #[test]
    fn a_slab_is_a_cuboid_and_a_turned_one_convex() {
        let slab = corners();
        assert_eq!(caster_shape(&slab, &CUBE), CasterShape::Cuboid);
        let turn = Mat4::from_quat(Quat::from_rotation_y(0.3));
        let turned: Vec<Vec3> = slab.iter().map(|&p| turn.transform_point3(p)).collect();
        assert_eq!(caster_shape(&turned, &CUBE), CasterShape::Convex);
        assert_eq!(CasterShape::Cuboid.transformed(&turn), CasterShape::Convex);
        let quarter = Mat4::from_cols(glam::Vec4::Z, glam::Vec4::Y, -glam::Vec4::X, glam::Vec4::W);
        assert_eq!(
            CasterShape::Cuboid.transformed(&quarter),
            CasterShape::Cuboid
        );
    }

    /// Checks that a dented slab, an open one, two slabs in one mesh and one with reversed faces
    /// have the shape `Any`.
    #[test]
    fn what_can_shadow_itself_promises_nothing() {
        let slab = corners();
        let mut dented = slab.clone();
        dented.push(Vec3::new(0.0, -0.5, 0.0));
        // The side at y = 0 is divided around its middle, which lies deeper.
        let side = [2_u32, 6, 7, 3];
        let without_side = CUBE
            .chunks(3)
            .filter(|face| !face.iter().all(|corner| side.contains(corner)));
        let mut dented_faces: Vec<u32> = without_side.flatten().copied().collect();
        for edge in 0..4 {
            dented_faces.extend([side[edge], side[(edge + 1) % 4], 8]);
        }
        assert!(is_closed_solid(&dented, &dented_faces));
        assert_eq!(caster_shape(&dented, &dented_faces), CasterShape::Any);
        assert_eq!(caster_shape(&slab, &CUBE[..30]), CasterShape::Any);
        let mut two = slab.clone();
        two.extend(slab.iter().map(|corner| *corner + Vec3::new(0.0, 5.0, 0.0)));
        let both: Vec<u32> = CUBE
            .iter()
            .copied()
            .chain(CUBE.map(|index| index + 8))
            .collect();
        assert_eq!(caster_shape(&two, &both), CasterShape::Any);
        let reversed: Vec<u32> = CUBE.iter().rev().copied().collect();
        assert_eq!(caster_shape(&slab, &reversed), CasterShape::Any);
        assert_eq!(caster_shape(&slab, &[0, 1, 9]), CasterShape::Any);
        assert_eq!(caster_shape(&slab, &[]), CasterShape::Any);
    }

    #[test]
    fn a_leaning_sheet_is_convex() {
        let turn = Mat4::from_quat(Quat::from_rotation_x(0.7));
        let sheet = [Vec3::ZERO, Vec3::X, Vec3::Z, Vec3::new(1.0, 0.0, 1.0)];
        let sheet = sheet.map(|corner| turn.transform_point3(corner * 40.0));
        assert_eq!(
            caster_shape(&sheet, &[0, 1, 2, 2, 1, 3]),
            CasterShape::Convex
        );
    }
}
