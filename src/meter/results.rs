//! Gathers the results of frames into estimates.

use crate::meter::estimate::RunningMean;
use crate::meter::measured::{MeasuredError, MeasuredPlace};
use crate::meter::places::{Place, RayAnswer};

/// Holds what is remembered of the results.
#[derive(Debug)]
pub(super) struct Results {
    squared: RunningMean,
    false_shadow: RunningMean,
    false_light: RunningMean,
    /// Holds the worst places with the number of their frame.
    worst: Vec<(u64, MeasuredPlace)>,
    last: Vec<MeasuredPlace>,
    frames: u64,
    resets: u64,
    window_frames: u32,
}

impl Results {
    pub(super) fn new(window_frames: u32) -> Self {
        Self {
            squared: RunningMean::default(),
            false_shadow: RunningMean::default(),
            false_light: RunningMean::default(),
            worst: Vec::new(),
            last: Vec::new(),
            frames: 0,
            resets: 0,
            window_frames,
        }
    }

    /// Adds the results of a frame's places, `[f32; 4]` each: the visibility, and the depths of two
    /// rays.
    pub(super) fn add_frame(&mut self, places: &[Place], bytes: &[u8]) {
        self.frames += 1;
        let factor = (-1.0 / f64::from(self.window_frames)).exp();
        let means = [
            &mut self.squared,
            &mut self.false_shadow,
            &mut self.false_light,
        ];
        means.into_iter().for_each(|mean| mean.scale(factor));
        self.last.clear();
        for (place, result) in places.iter().zip(bytes.chunks_exact(size_of::<[f32; 4]>())) {
            let [visibility, first, second, _]: [f32; 4] = bytemuck::pod_read_unaligned(result);
            self.add(place, visibility, [first, second]);
        }
        self.keep_worst();
    }

    fn add(&mut self, place: &Place, visibility: f32, depths: [f32; 2]) {
        let lit = |ray: usize| match place.rays[ray] {
            RayAnswer::Lit => 1.0,
            RayAnswer::Blocked => 0.0,
            // The map is cleared to the far plane, which is at the receiver.
            RayAnswer::Drawn => f64::from(u8::from(depths[ray] <= 0.0)),
        };
        let rays = [lit(0), lit(1)];
        let by_rays = 0.5 * (rays[0] + rays[1]);
        let seen = f64::from(visibility);
        // A visibility that is no number is as wrong as it can be.
        let seen = if seen.is_finite() {
            seen
        } else {
            1.0 - by_rays
        };
        self.squared.add((seen - rays[0]) * (seen - rays[1]));
        self.false_shadow.add((1.0 - seen) * by_rays);
        self.false_light.add(seen * (1.0 - by_rays));
        self.last.push(MeasuredPlace {
            position_world: place.position_world,
            normal: place.normal,
            slot: place.slot,
            visibility,
            visibility_by_rays: by_rays as f32,
        });
    }

    /// Keeps the worst of the places that are not forgotten.
    fn keep_worst(&mut self) {
        let (now, window) = (self.frames, u64::from(self.window_frames));
        self.worst.retain(|(frame, _)| frame + window > now);
        let wrong = self.last.iter().filter(|place| place.error() > 0.0);
        self.worst.extend(wrong.map(|place| (now, *place)));
        // The sort is stable; of equally wrong places the newer ones come first.
        self.worst.sort_by(|(frame, a), (other_frame, b)| {
            let by_error = b.error().total_cmp(&a.error());
            by_error.then(other_frame.cmp(frame))
        });
        self.worst.truncate(MeasuredError::MOST_WORST);
    }

    pub(super) fn measured(&self) -> MeasuredError {
        MeasuredError {
            rmse: self.squared.estimate().sqrt(),
            false_shadow: self.false_shadow.estimate(),
            false_light: self.false_light.estimate(),
            samples: self.squared.effective_samples(),
            worst: self.worst.iter().map(|(_, place)| *place).collect(),
        }
    }

    pub(super) fn last_places(&self) -> &[MeasuredPlace] {
        &self.last
    }

    /// Returns how often everything was forgotten.
    pub(super) fn resets(&self) -> u64 {
        self.resets
    }

    pub(super) fn reset(&mut self) {
        *self = Self {
            resets: self.resets + 1,
            ..Self::new(self.window_frames)
        };
    }
}
