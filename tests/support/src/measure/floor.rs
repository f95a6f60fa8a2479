//! Computes the least edge aliasing that a filter can have: straight edges at random positions and
//! angles, through the library's CPU reference.

use std::f64::consts::TAU;

use glam::DVec2;
use wgpu_shadows::Filter;
use wgpu_shadows::reference::{DepthLayer, Receiver, visibility};

use crate::random::Random;

const SIDE: u32 = 24;
const EDGES: u32 = 150;
const PLACES: u32 = 200;

/// Holds the floors of a set of filters.
#[derive(Clone, Debug, Default)]
pub struct Floors(Vec<(Filter, f64)>);

impl Floors {
    pub fn of(filters: impl IntoIterator<Item = Filter>) -> Self {
        let mut floors = Self::default();
        for filter in filters {
            if floors.get(filter).is_none() {
                floors.0.push((filter, edge_aliasing_texels(filter)));
            }
        }
        floors
    }

    /// Returns the least edge aliasing of a filter in the set.
    pub fn get(&self, filter: Filter) -> Option<f64> {
        let known = self.0.iter().find(|(other, _)| *other == filter);
        known.map(|(_, texels)| *texels)
    }
}

/// Returns the area on the wrong side of one half per length of a straight edge, in texels, for a
/// map whose texels are hidden where their middle is.
fn edge_aliasing_texels(filter: Filter) -> f64 {
    let mut random = Random::new(21);
    // The samples extend as far to either side as the filter's result can differ from the truth.
    let reach = filter.reach_texels() + 0.5;
    let mut wrong = 0u32;
    for _ in 0..EDGES {
        let (sin, cos) = (TAU * random.unit()).sin_cos();
        let across = DVec2::new(cos, sin);
        let middle = f64::from(SIDE) * 0.5 + DVec2::new(random.unit(), random.unit());
        let hidden = |place: DVec2| (place - middle).dot(across) > 0.0;
        let depths: Vec<f32> = (0..SIDE * SIDE)
            .map(|texel| {
                let center = DVec2::new(f64::from(texel % SIDE), f64::from(texel / SIDE)) + 0.5;
                // Depth is reversed: what is nearer to the light is greater.
                if hidden(center) { 1.0 } else { 0.0 }
            })
            .collect();
        let layer = DepthLayer {
            size: SIDE,
            depths: &depths,
        };
        for _ in 0..PLACES {
            let to_side = reach * (2.0 * random.unit() - 1.0);
            let along = 2.0 * random.unit() - 1.0;
            let place = middle + across * to_side + across.perp() * along;
            let receiver = Receiver {
                texel: place,
                depth: 0.5,
                gradient: DVec2::ZERO,
                penumbra: DVec2::ZERO,
                grid: 0,
                inside: true,
            };
            let lit = visibility(filter, &layer, &receiver) >= 0.5;
            wrong += u32::from(lit == hidden(place));
        }
    }
    2.0 * reach * f64::from(wrong) / f64::from(EDGES * PLACES)
}
