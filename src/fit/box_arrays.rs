//! Compares many boxes with a region at once: their coordinates in arrays, which processors compare
//! several at a time.

use glam::{DVec3, Vec3};

use crate::Aabb;
use crate::fit::region::HalfSpaces;

/// Holds boxes around a point, in f32. They are wider than the boxes that were added by more than
/// the rounding of a comparison.
#[derive(Debug, Default)]
pub(crate) struct BoxArrays {
    centers: [Vec<f32>; 3],
    halves: [Vec<f32>; 3],
    /// Holds the distance by which each box reaches into the region of a question. It is reused for
    /// its memory.
    depths: Vec<f32>,
}

impl BoxArrays {
    pub(super) fn clear(&mut self) {
        let arrays = self.centers.iter_mut().chain(&mut self.halves);
        arrays.for_each(Vec::clear);
    }

    /// Adds a box that is not empty; `point` is the one that all boxes are held relative to.
    pub(super) fn push(&mut self, bounds: &Aabb, point: DVec3) {
        let (min, max) = (bounds.min.as_dvec3() - point, bounds.max.as_dvec3() - point);
        let (center, half) = ((min + max) * 0.5, (max - min) * 0.5);
        // A distance is a sum of six products and an offset, of factors that are rounded to f32:
        // 16 ulps of the sum of all coordinates are more than twice what it can be off. Halves have
        // weights of 1 or more together.
        let size = center.abs().element_sum() + half.element_sum();
        let coordinate = point.abs().max_element() + size;
        let wider = 16.0 * f64::from(f32::EPSILON) * size + 64.0 * f64::EPSILON * coordinate;
        let (center, half) = (center.as_vec3(), (half + wider).as_vec3());
        for axis in 0..3 {
            self.centers[axis].push(center[axis]);
            self.halves[axis].push(half[axis]);
        }
    }

    /// Fills `found` with the numbers of the boxes, counted in the order in which they were added,
    /// that may reach into `region`. `point` is that of the boxes. None is missing for which
    /// [`HalfSpaces::relation`] tells anything but that it is outside.
    pub(super) fn find_in(&mut self, region: &HalfSpaces, point: DVec3, found: &mut Vec<u32>) {
        let count = self.centers[0].len();
        self.depths.clear();
        self.depths.resize(count, f32::INFINITY);
        let [x, y, z] = self.centers.each_ref().map(|values| &values[..count]);
        let [a, b, c] = self.halves.each_ref().map(|values| &values[..count]);
        let depths = &mut self.depths[..count];
        for plane in region.as_slice() {
            let offset = plane.offset + plane.normal.dot(point);
            // The offset is rounded as well, and was a difference of coordinates.
            let offset = offset + 4.0 * f64::from(f32::EPSILON) * offset.abs();
            let (normal, offset): (Vec3, f32) = (plane.normal.as_vec3(), offset as f32);
            let reach = normal.abs();
            for i in 0..count {
                let distance = normal.x * x[i] + normal.y * y[i] + normal.z * z[i] + offset;
                let depth = distance + reach.x * a[i] + reach.y * b[i] + reach.z * c[i];
                depths[i] = if depth < depths[i] { depth } else { depths[i] };
            }
        }
        found.clear();
        let reaches = |(index, depth): (u32, &f32)| (*depth >= 0.0).then_some(index);
        found.extend((0..).zip(self.depths.iter()).filter_map(reaches));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::region::{HalfSpace, Relation};

    /// Checks that no box is missed that is in the region, at coordinates up to 1e7 and for boxes
    /// that only touch it, and that few are found beside those.
    #[test]
    fn all_boxes_in_a_region_are_found() {
        let mut state = 7_u64;
        let mut random = || {
            // xorshift64 (Marsaglia 2003).
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            state as f64 / u64::MAX as f64 * 2.0 - 1.0
        };
        let (mut inside, mut needless, mut all) = (0, 0, 0);
        for far in [0.0, 1.0, 1e4, 1e7] {
            for size in [1e-3, 1.0, 1e3] {
                let point = DVec3::new(random(), random(), random()) * far;
                let mut region = HalfSpaces::default();
                for _ in 0..5 {
                    let normal = DVec3::new(random(), random(), random()).normalize();
                    let offset = -normal.dot(point) + random().abs() * size * 0.1;
                    region.push(HalfSpace { normal, offset });
                }
                let mut arrays = BoxArrays::default();
                let mut boxes = Vec::new();
                for _ in 0..2000 {
                    let center = point + DVec3::new(random(), random(), random()) * size;
                    let half = DVec3::new(random(), random(), random()).abs() * size * 0.1;
                    boxes.push(Aabb::new(
                        (center - half).as_vec3(),
                        (center + half).as_vec3(),
                    ));
                }
                boxes.iter().for_each(|bounds| arrays.push(bounds, point));
                let mut found = Vec::new();
                arrays.find_in(&region, point, &mut found);
                for (index, bounds) in (0..).zip(&boxes) {
                    let is_found = found.binary_search(&index).is_ok();
                    let is_in = region.relation(bounds) != Relation::Outside;
                    assert!(is_found || !is_in, "box {index} at {far}, size {size}");
                    inside += u32::from(is_in);
                    // Where positions are coarser than the boxes, wider boxes say nothing.
                    let resolved = size > 1e-4 * far;
                    needless += u32::from(is_found && !is_in && resolved);
                    all += u32::from(resolved);
                }
            }
        }
        assert!(inside > 1000, "{inside}");
        // Boxes are wider by some 1e-5 of their distance.
        assert!(needless < all / 500, "{needless} of {all}");
    }
}
