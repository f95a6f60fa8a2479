//! Recognises closed solids: meshes of which only the faces toward the light need drawing.

use std::collections::HashMap;

use glam::{DVec3, I64Vec3, Vec3};

use crate::Aabb;

/// Is the number of grid steps over the mesh's extent; corners that round to one grid point count
/// as one.
const STEPS: f64 = (1 << 20) as f64;

/// Returns whether a triangle list is a closed solid with its front faces (counter-clockwise)
/// outward. `positions` may be in any space and unit; every three `indices` are a triangle, and an
/// incomplete last one is ignored. Returns false if an index is not less than the length of
/// `positions`.
///
/// From outside, the first surface that a ray meets of such a solid is always a front face. So a
/// pipeline that culls with `Some(Face::Back)` draws the same map from half the triangles; any
/// other mesh (a sheet, a mesh with holes, one that is inside out) needs both sides. Positions are
/// rounded to a grid of 2²⁰ steps over the largest side of the mesh's bounds, and corners that
/// round to one grid point count as one, whatever their normals: sines do not come back to the bit
/// where they began, and no rasteriser sees a crack as thin as a millionth of the extent. The
/// function takes time in proportion to the triangles: call it once, at load time.
///
/// Two cases are for the engine to know. A light *inside* a solid sees back faces alone: if they
/// are culled, it shines out through the solid. And the function returns true for a surface that
/// passes through itself in such a way that a part of it is inside out, as it does for a solid that
/// shares a corner with a smaller solid that is inside out.
pub fn is_closed_solid(positions: &[Vec3], indices: &[u32]) -> bool {
    let Some(triangles) = welded(positions, indices) else {
        return false;
    };
    // In a closed surface each edge is walked as often one way as the other, so that no edge is a
    // border.
    let mut balance: HashMap<(usize, usize), i64> = HashMap::new();
    let mut solids = Groups::new(positions.len());
    for &[a, b, c] in &triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let forward = if from < to { 1 } else { -1 };
            *balance.entry((from.min(to), from.max(to))).or_default() += forward;
            solids.join(from, to);
        }
    }
    if triangles.is_empty() || balance.values().any(|balance| *balance != 0) {
        return false;
    }
    // This is six times the signed volume of each solid, from its first corner so that a distant
    // position costs no precision.
    let mut volumes: HashMap<usize, f64> = HashMap::new();
    for triangle in &triangles {
        let solid = solids.of(triangle[0]);
        let corner = |index: usize| positions[index].as_dvec3() - positions[solid].as_dvec3();
        let [a, b, c]: [DVec3; 3] = triangle.map(corner);
        *volumes.entry(solid).or_default() += a.dot(b.cross(c));
    }
    volumes.values().all(|volume| *volume > 0.0)
}

/// Returns the triangles that have three different corners; each corner is named by the first index
/// with its position. Returns `None` if an index has no position.
fn welded(positions: &[Vec3], indices: &[u32]) -> Option<Vec<[usize; 3]>> {
    let bounds = Aabb::from_points(positions.iter().copied());
    let low = bounds.min.as_dvec3();
    let extent = (bounds.max.as_dvec3() - low).max_element();
    let mut firsts: HashMap<I64Vec3, usize> = HashMap::new();
    let mut first = |index: u32| {
        let index = index as usize;
        let position = (positions.get(index)?.as_dvec3() - low) * (STEPS / extent);
        // Casts saturate and turn NaN into 0; the volume of such a mesh is NaN as well, and not
        // above 0.
        Some(*firsts.entry(position.round().as_i64vec3()).or_insert(index))
    };
    let mut triangles = Vec::with_capacity(indices.len() / 3);
    for corners in indices.chunks_exact(3) {
        let [a, b, c] = [first(corners[0])?, first(corners[1])?, first(corners[2])?];
        if a != b && b != c && c != a {
            triangles.push([a, b, c]);
        }
    }
    Some(triangles)
}

/// Finds which corners are connected: disjoint sets with halved paths (Tarjan and van Leeuwen
/// 1984).
struct Groups {
    parents: Vec<usize>,
}

impl Groups {
    fn new(count: usize) -> Self {
        Self {
            parents: (0..count).collect(),
        }
    }

    fn of(&mut self, mut index: usize) -> usize {
        while self.parents[index] != index {
            self.parents[index] = self.parents[self.parents[index]];
            index = self.parents[index];
        }
        index
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.of(a), self.of(b));
        self.parents[a.max(b)] = a.min(b);
    }
}
