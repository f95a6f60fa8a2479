//! Which meshes are closed solids, of which only the faces toward the light need drawing.

use std::collections::HashMap;

use glam::{DVec3, I64Vec3, Vec3};

use crate::Aabb;

/// Steps of a mesh's extent that tell corners apart.
const STEPS: f64 = (1 << 20) as f64;

/// Is this triangle list a closed solid with its front faces (counter-clockwise) outward? Indices beyond `positions` say no.
///
/// From outside, what is seen first of such a solid is always a front face. So a pipeline with `cull: Some(Face::Back)` draws
/// the same map from half the triangles; anything else (a sheet, a mesh with holes, one inside out) needs both sides. Corners
/// whose positions agree to a millionth of the mesh's extent count as one, whatever their normals: sines do not come back to
/// the bit where they began, and no rasteriser sees so thin a crack. Takes time in proportion to the triangles: ask once, at
/// load time.
///
/// Two things are for the engine to know. A light *inside* a solid sees back faces alone: culled, it shines out. And a
/// surface that passes through itself in such a way that a part of it is inside out is taken for a solid, and so is one with a
/// smaller solid that is inside out and shares a corner with it.
pub fn is_closed_solid(positions: &[Vec3], indices: &[u32]) -> bool {
    let Some(triangles) = welded(positions, indices) else {
        return false;
    };
    // Each edge is walked as often one way as the other, and so bounds nothing.
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
    // Six times the signed volume of each solid, from its first corner so that a distant place costs no precision.
    let mut volumes: HashMap<usize, f64> = HashMap::new();
    for triangle in &triangles {
        let solid = solids.of(triangle[0]);
        let corner = |index: usize| positions[index].as_dvec3() - positions[solid].as_dvec3();
        let [a, b, c]: [DVec3; 3] = triangle.map(corner);
        *volumes.entry(solid).or_default() += a.dot(b.cross(c));
    }
    volumes.values().all(|volume| *volume > 0.0)
}

/// The triangles that have three different corners, by the first index with each corner's position.
fn welded(positions: &[Vec3], indices: &[u32]) -> Option<Vec<[usize; 3]>> {
    let bounds = Aabb::from_points(positions.iter().copied());
    let low = bounds.min.as_dvec3();
    let extent = (bounds.max.as_dvec3() - low).max_element();
    let mut firsts: HashMap<I64Vec3, usize> = HashMap::new();
    let mut first = |index: u32| {
        let index = index as usize;
        let place = (positions.get(index)?.as_dvec3() - low) * (STEPS / extent);
        // Casts saturate, and of what is no number make 0; its volume then is none either.
        Some(*firsts.entry(place.round().as_i64vec3()).or_insert(index))
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

/// Which corners hang together: disjoint sets with halved paths (Tarjan and van Leeuwen 1984).
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
