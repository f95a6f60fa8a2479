//! Finds which of many points of a plane are in a rectangle.

use glam::DVec2;

/// Is the number of cells along each axis.
const CELLS: usize = 16;

/// Holds the indices of points, sorted by the cell of a grid around all points.
#[derive(Clone, Debug, Default)]
pub(crate) struct PointGrid {
    min: DVec2,
    cells_per_unit: DVec2,
    /// Is where the indices of each cell begin in the list, cell by cell along x.
    starts: Vec<u32>,
    indices: Vec<u32>,
}

impl PointGrid {
    /// Replaces the points, which must be finite.
    pub(super) fn fill(&mut self, points: impl Iterator<Item = DVec2> + Clone) {
        let (mut min, mut max) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for point in points.clone() {
            (min, max) = (min.min(point), max.max(point));
        }
        self.min = min;
        // All points are in one column or row where they have one coordinate in common.
        self.cells_per_unit = (CELLS as f64 / (max - min)).map(finite_or_zero);
        self.starts.clear();
        self.starts.resize(CELLS * CELLS + 1, 0);
        let mut count = 0;
        for point in points.clone() {
            let cell = self.cell_at(point);
            self.starts[cell + 1] += 1;
            count += 1;
        }
        for cell in 0..CELLS * CELLS {
            self.starts[cell + 1] += self.starts[cell];
        }
        self.indices.clear();
        self.indices.resize(count, 0);
        // Every start moves to the end of its cell, which is where the next cell starts.
        for (index, point) in (0..).zip(points) {
            let cell = self.cell_at(point);
            self.indices[self.starts[cell] as usize] = index;
            self.starts[cell] += 1;
        }
        self.starts.rotate_right(1);
        self.starts[0] = 0;
    }

    /// Returns the indices of all points in a rectangle, and of some that are near it. The corners
    /// may be infinite.
    pub(super) fn near(&self, min: DVec2, max: DVec2) -> impl Iterator<Item = usize> + '_ {
        let (low, high) = (self.cell(min), self.cell(max));
        let rows = low[1]..=high[1];
        rows.flat_map(move |row| {
            let start = self.starts[row * CELLS + low[0]] as usize;
            let end = self.starts[row * CELLS + high[0] + 1] as usize;
            self.indices[start..end].iter().map(|index| *index as usize)
        })
    }

    fn cell_at(&self, point: DVec2) -> usize {
        let [x, y] = self.cell(point);
        y * CELLS + x
    }

    /// Returns the nearest cell along each axis. A conversion to an integer saturates.
    fn cell(&self, point: DVec2) -> [usize; 2] {
        let cell = (point - self.min) * self.cells_per_unit;
        [cell.x, cell.y].map(|cell| (cell as usize).min(CELLS - 1))
    }
}

fn finite_or_zero(value: f64) -> f64 {
    if value.is_finite() { value } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// No point in a rectangle is missing, whatever the points and the rectangle: spread out, in
    /// one place, or in a row.
    #[test]
    fn every_point_in_a_rectangle_is_found() {
        let mut grid = PointGrid::default();
        let mut place = DVec2::ZERO;
        for round in 0..300 {
            let flat = [DVec2::ONE, DVec2::X, DVec2::ZERO][round % 3];
            let mut point = || {
                place = (place + DVec2::new(0.754_877_666_2, 0.569_840_290_9)).fract();
                place * 4.0 - 2.0
            };
            let points: Vec<DVec2> = (0..round).map(|_| point() * flat).collect();
            grid.fill(points.iter().copied());
            let (a, b) = (point() * 2.0, point() * 2.0);
            let (mut min, mut max) = (a.min(b), a.max(b));
            if round % 7 == 0 {
                min.x = f64::NEG_INFINITY;
            }
            if round % 11 == 0 {
                max = DVec2::INFINITY;
            }
            let found: Vec<usize> = grid.near(min, max).collect();
            for (index, point) in points.iter().enumerate() {
                let inside = min.cmple(*point).all() && point.cmple(max).all();
                assert!(!inside || found.contains(&index), "{point} in {min}, {max}");
            }
            let all: std::collections::BTreeSet<_> = found.iter().collect();
            assert_eq!(all.len(), found.len(), "a point is found once");
        }
    }
}
