//! Divides the layer of a pool among the views of its lights, from frame to frame.

use crate::fit::{
    FRAMES_BETWEEN_PREDICTIONS, Hold, LARGEST_TEXEL_PIXELS, Packing, SquareSizes, TexelRect,
    ViewNeed, Wanted, root_mean_error, side_texels,
};

/// Is the factor by which a need may shrink from one prediction to the next. A camera that looks
/// away for a moment finds most of the texels again.
const SHRINK: f64 = 0.75;

/// Is the number of texels per side below which squares are not divided further, unless the lights
/// of the pool are too many: the border that a filter needs would take too much of them.
const LEAST_SIDE_TEXELS: u32 = 16;

/// Is the weight of a view on which no ray has fallen, in relation to the mean of a ray. What is
/// seen there is smaller than the distance of rays in the image, and may be nothing: the mean of
/// such a view is below one ray, and its texels are few but not none.
const UNSEEN_WEIGHT: f64 = 0.25;

/// Holds the squares of the views of a pool, and how large they ought to be.
#[derive(Clone, Debug)]
pub(crate) struct PoolLayer {
    map_size: u32,
    /// Is how often the side of the layer can be halved; so many squares have room for all views.
    finest: u32,
    packing: Packing,
    sizes: SquareSizes,
    /// Holds the levels of views for whose size there is no room at present.
    interim: Vec<Option<u32>>,
    needs: Vec<ViewNeed>,
    /// Counts the frames since the last prediction.
    frames: u32,
    /// States that another prediction for the same frame would change nothing.
    settled: bool,
    pub predicted_error: Option<f64>,
}

/// Is what a frame asks for a view of a listed light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Request {
    pub view: usize,
    /// States that something casts into it.
    pub draws: bool,
    /// States that its light is refreshed in this frame.
    pub refreshed: bool,
}

/// Lists the views that a placement has affected.
#[derive(Debug, Default)]
pub(crate) struct Placed {
    /// Lists views whose texels now belong to others.
    pub given_up: Vec<usize>,
    /// Lists views that get another size than was wanted.
    pub interim: Vec<usize>,
}

impl PoolLayer {
    /// Makes an empty layer for so many views; `None` where it has not a texel for each.
    pub(super) fn new(map_size: u32, views: usize) -> Option<Self> {
        let room = |level: &u32| 1u64 << (2 * level) >= views as u64;
        let needed = (0..32).find(room)?;
        if side_texels(map_size, needed) == 0 {
            return None;
        }
        let finer = |level: &u32| side_texels(map_size, *level) >= LEAST_SIDE_TEXELS;
        let finest = (needed..16).take_while(finer).last().unwrap_or(needed);
        Some(Self {
            map_size,
            finest,
            packing: Packing::new(views),
            sizes: SquareSizes::default(),
            interim: vec![None; views],
            needs: vec![ViewNeed::default(); views],
            frames: 0,
            settled: false,
            predicted_error: None,
        })
    }

    pub(super) fn map_size(&self) -> u32 {
        self.map_size
    }

    /// Returns the level that a view is to have.
    fn level(&self, view: usize) -> u32 {
        let level = self.interim[view].or(self.sizes.level(view));
        level.unwrap_or(self.finest)
    }

    /// Returns the number of texels per side that a view is to have.
    pub(super) fn side(&self, view: usize) -> u32 {
        side_texels(self.map_size, self.level(view))
    }

    /// Returns the texels of a view, if it has as many as it is to have.
    pub(super) fn texels(&self, view: usize) -> Option<TexelRect> {
        let square = self.packing.square(view)?;
        (square.level == self.level(view)).then(|| square.texels(self.map_size))
    }

    /// Takes the texels of a view for others.
    pub(super) fn release(&mut self, view: usize) {
        self.packing.set(view, None);
        self.interim[view] = None;
        self.needs[view] = ViewNeed::default();
        self.sizes.release(view);
        self.settled = false;
    }

    /// Discards what was seen in earlier frames.
    pub(super) fn reset_history(&mut self) {
        self.needs.fill(ViewNeed::default());
        self.frames = FRAMES_BETWEEN_PREDICTIONS;
        self.settled = false;
    }

    /// Counts a frame for which the lights are fitted anew, and returns whether a prediction is
    /// due.
    pub(super) fn count_frame(&mut self) -> bool {
        self.settled = false;
        self.frames += 1;
        self.frames >= FRAMES_BETWEEN_PREDICTIONS
    }

    /// Returns whether the next frame can leave all sizes as they are without a prediction: none is
    /// due, or nothing has changed since the last one, which would have the same result.
    pub(super) fn keeps_sizes(&self, is_same_frame: bool) -> bool {
        self.frames + 1 < FRAMES_BETWEEN_PREDICTIONS || (self.settled && is_same_frame)
    }

    /// Counts a frame for which no light is fitted anew. A prediction that is due counts as made.
    pub(super) fn keep_sizes(&mut self, is_same_frame: bool) {
        self.settled &= is_same_frame;
        self.frames = (self.frames + 1) % FRAMES_BETWEEN_PREDICTIONS;
    }

    /// Returns whether a view that something casts into has never been considered.
    pub(super) fn is_new(&self, view: usize) -> bool {
        self.sizes.level(view).is_none()
    }

    /// Chooses sizes. `seen` holds, for each view that something casts into, its side in tangents
    /// and what the cameras see of it; without a camera all have the same size.
    pub(super) fn choose(
        &mut self,
        seen: &[Option<(f64, ViewNeed)>],
        has_camera: bool,
        points: usize,
    ) {
        let before = (self.needs.clone(), self.sizes.clone());
        for (need, seen) in self.needs.iter_mut().zip(seen) {
            let now = seen.map_or(ViewNeed::default(), |(_, now)| now);
            *need = now.or_shrunk(need, SHRINK);
        }
        let rays: u32 = self.needs.iter().map(|need| need.points).sum();
        let weights = self.needs.iter().map(|need| need.weight).sum::<f64>();
        let least = if weights > 0.0 {
            UNSEEN_WEIGHT * weights / f64::from(rays.max(1))
        } else {
            1.0
        };
        let wanted = |(need, seen): (&ViewNeed, &Option<(f64, ViewNeed)>)| {
            let (size, _) = (*seen)?;
            Some(Wanted {
                weight: need.weight.max(least),
                size: size.max(1e-6),
            })
        };
        let wanted: Vec<_> = self.needs.iter().zip(seen).map(wanted).collect();
        if has_camera {
            self.sizes.choose(&wanted, self.finest);
        } else {
            self.sizes.share_equally(&wanted, self.finest);
        }
        let kept_out = self.interim.iter().any(Option::is_some);
        self.interim.fill(None);
        self.settled = !kept_out && before == (self.needs.clone(), self.sizes.clone());
        self.frames = 0;
        let error = |(view, seen): (usize, &Option<(f64, ViewNeed)>)| {
            let (size, now) = (*seen)?;
            let texel = size / f64::from(self.side(view));
            Some((now.weight * texel).min(now.edges * LARGEST_TEXEL_PIXELS))
        };
        let sum: f64 = seen.iter().enumerate().filter_map(error).sum();
        self.predicted_error = has_camera.then(|| root_mean_error(sum, points));
    }

    /// Gives each view of a refreshed light the texels that it is to have, with at most
    /// `most_moved` others that have to move and be rendered again; `None` sets no limit. The views
    /// of lights that are not refreshed keep what they have. Where there is no room, a view keeps
    /// its present size, or gets a smaller one than it is to have.
    ///
    /// Without a limit there is always room: squares are taken from the largest to the smallest.
    pub(super) fn place(&mut self, requests: &[Request], most_moved: Option<u32>) -> Placed {
        let mut holds = vec![Hold::Idle; self.needs.len()];
        let mut pending: Vec<(u32, usize)> = Vec::new();
        for request in requests {
            let level = self.level(request.view);
            let square = self.packing.square(request.view);
            let changes = square.is_none_or(|square| square.level != level);
            holds[request.view] = match request {
                Request {
                    refreshed: false, ..
                } => Hold::Fixed,
                Request { draws: false, .. } => Hold::Idle,
                _ if changes && most_moved.is_some() => Hold::Fixed,
                _ => Hold::Movable,
            };
            if !(request.refreshed && request.draws && changes) {
                continue;
            }
            match square {
                Some(square) if square.level < level => {
                    self.packing
                        .set(request.view, Some(square.first_part(level)));
                }
                _ => pending.push((level, request.view)),
            }
        }
        pending.sort_unstable();
        let mut left = most_moved.unwrap_or(u32::MAX);
        let mut placed = Placed::default();
        for (level, view) in pending {
            let old = self.packing.square(view);
            let end = old.map_or(self.finest + 1, |old| old.level);
            let found = (level..end).find(|level| {
                self.make_room(view, *level, &mut left, &holds, &mut placed.given_up)
            });
            let actual = found.or(old.map(|old| old.level));
            if actual != Some(level) {
                self.interim[view] = actual;
                self.settled = false;
                placed.interim.push(view);
            }
        }
        placed
    }

    /// Places a view and those that have to move for it; returns false, with nothing changed, where
    /// that is impossible.
    fn make_room(
        &mut self,
        view: usize,
        level: u32,
        left: &mut u32,
        holds: &[Hold],
        given_up: &mut Vec<usize>,
    ) -> bool {
        let before = (self.packing.clone(), *left, given_up.len());
        self.packing.set(view, None);
        let mut waiting = vec![(level, view)];
        while let Some(&(level, view)) = waiting.iter().min() {
            waiting.retain(|other| *other != (level, view));
            let Some(displaced) = self.packing.place(view, level, *left, |view| holds[view]) else {
                self.packing = before.0;
                *left = before.1;
                given_up.truncate(before.2);
                return false;
            };
            *left = left.saturating_sub(displaced.moved.len() as u32);
            given_up.extend(displaced.idle.iter().map(|(view, _)| *view));
            let moved = displaced.moved.iter();
            waiting.extend(moved.map(|(view, level)| (*level, *view)));
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Is a sequence that is the same in every run.
    struct Sequence(u64);

    impl Sequence {
        fn below(&mut self, count: u64) -> u64 {
            self.0 = self
                .0
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (self.0 >> 33) % count
        }
    }

    /// Through thousands of frames of any needs and budgets, the texels of all views are apart, a
    /// view that waits keeps its own, and without a budget every view has what it is to have.
    #[test]
    fn texels_are_never_shared_and_never_taken_from_views_that_wait() {
        const VIEWS: usize = 24;
        let mut random = Sequence(3);
        let mut layer = PoolLayer::new(500, VIEWS).expect("a texel for each");
        let mut weights = [1.0; VIEWS];
        let (mut moved, mut waits, mut refused) = (0, 0, 0);
        for _ in 0..6000 {
            for weight in &mut weights {
                if random.below(20) == 0 {
                    *weight = 10.0_f64.powi(random.below(5) as i32) - 1.0;
                }
            }
            let drawn: Vec<bool> = weights.iter().map(|weight| *weight > 0.0).collect();
            let seen: Vec<_> = weights
                .iter()
                .map(|weight| {
                    let need = ViewNeed {
                        weight: *weight,
                        edges: 1.0,
                        points: 3,
                    };
                    (*weight > 0.0).then_some((1.0, need))
                })
                .collect();
            let has_new = (0..VIEWS).any(|view| drawn[view] && layer.is_new(view));
            if layer.count_frame() || has_new || random.below(4) == 0 {
                layer.choose(&seen, random.below(9) > 0, 100);
            }
            let spare = (random.below(5) > 0).then(|| random.below(6) as u32);
            let requests: Vec<Request> = (0..VIEWS)
                .filter(|_| random.below(30) > 0)
                .collect::<Vec<_>>()
                .into_iter()
                .map(|view| Request {
                    view,
                    draws: drawn[view],
                    refreshed: spare.is_none() || random.below(3) > 0,
                })
                .collect();
            let before = layer.packing.clone();
            let placed = layer.place(&requests, spare);
            let mut displaced = 0;
            for request in &requests {
                let (was, is) = (
                    before.square(request.view),
                    layer.packing.square(request.view),
                );
                if !request.refreshed {
                    assert_eq!(was, is, "a view that waits keeps its texels");
                    waits += 1;
                } else if request.draws {
                    let kept_level = was.zip(is).is_some_and(|(was, is)| was.level == is.level);
                    displaced += u32::from(kept_level && was != is);
                    assert!(spare.is_some() || layer.texels(request.view).is_some());
                    refused += u32::from(is.is_none());
                }
            }
            assert!(spare.is_none_or(|spare| displaced <= spare));
            assert!(spare.is_some() || placed.interim.is_empty());
            moved += displaced;
            let squares = (0..VIEWS).filter_map(|view| layer.packing.square(view));
            let rects: Vec<TexelRect> = squares.map(|square| square.texels(500)).collect();
            for (index, a) in rects.iter().enumerate() {
                for b in &rects[..index] {
                    let meets = a.min.cmplt(b.min + b.size) & b.min.cmplt(a.min + a.size);
                    assert!(!meets.all(), "{a:?} {b:?}");
                }
            }
        }
        assert!(moved > 50 && waits > 1000, "{moved} {waits} {refused}");
    }
}
