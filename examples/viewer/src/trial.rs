//! Tries both sides against the truth: rays first, then the drawn visibilities, read back whenever
//! the settings of a side change.

use std::time::Duration;

use egui::{ColorImage, TextureHandle, TextureId, TextureOptions};
use example_support::camera::Camera;
use example_support::phong::Lighting;
use shadow_support::gpu::Gpu;
use shadow_support::measure::error::Errors;

use crate::picture::draw_visibility;
use crate::readback::{Readback, copy_texture};
use crate::scene::Scene;
use crate::settings::{Settings, Show, SideSettings};
use crate::side::{Side, VISIBILITY_FORMAT};
use crate::stage::Stage;
use crate::truth::{Subject, Truth, Verdict};

/// Is how long rays are cast between two frames.
const SLICE: Duration = Duration::from_millis(30);

/// Holds the truth and what was found with it.
#[derive(Default)]
pub struct Trial {
    truth: Option<Truth>,
    truth_texture: Option<TextureHandle>,
    sides: [SideTrial; 2],
}

#[derive(Default)]
struct SideTrial {
    /// Holds the settings that were measured or are being measured.
    settings: Option<SideSettings>,
    waiting: Option<Readback>,
    verdict: Option<Verdict>,
    texture: Option<TextureHandle>,
}

impl Trial {
    /// Begins with what the camera sees now.
    pub fn begin(
        &mut self,
        scene: &Scene,
        settings: &Settings,
        time: f32,
        size: [u32; 2],
    ) -> Result<(), String> {
        let subject = Subject::new(settings, time, size);
        let camera = settings.viewpoint.camera(subject.size(), 0.0);
        *self = Self {
            truth: Some(Truth::new(scene, subject, &camera)?),
            ..Self::default()
        };
        Ok(())
    }

    /// Returns the size of the measured picture.
    pub fn subject_size(&self) -> Option<[u32; 2]> {
        self.truth.as_ref().map(|truth| truth.subject.size())
    }

    pub fn progress(&self) -> Option<f32> {
        self.truth.as_ref().map(Truth::progress)
    }

    pub fn errors(&self, side: usize) -> Option<&Errors> {
        self.sides[side]
            .verdict
            .as_ref()
            .map(|verdict| &verdict.errors)
    }

    /// Goes on, and returns whether there is more to do.
    pub fn work(
        &mut self,
        gpu: &Gpu,
        settings: &Settings,
        time: f32,
        sides: [Option<(&Side, &Camera)>; 2],
        stage: &Stage,
        lighting: &Lighting,
    ) -> Result<bool, String> {
        let Some(truth) = &mut self.truth else {
            return Ok(false);
        };
        let size = truth.subject.size();
        if truth.subject != truth.subject.again(settings, time) {
            // What the rays tell is no longer what the camera sees.
            *self = Self::default();
            return Ok(false);
        }
        if !truth.advance(SLICE) {
            return Ok(true);
        }
        let mut wants_more = false;
        for (own, side) in self.sides.iter_mut().zip(sides) {
            let Some((side, camera)) = side else { continue };
            if let Some(result) = own.waiting.as_ref().and_then(|waiting| waiting.poll(gpu)) {
                own.waiting = None;
                own.verdict = Some(truth.judge(side, &result?));
                own.texture = None;
            }
            if own.waiting.is_none() && own.settings.as_ref() != Some(side.settings()) {
                own.settings = Some(*side.settings());
                let mut encoder = gpu.encoder();
                let target = gpu.target(VISIBILITY_FORMAT, size, 1);
                draw_visibility(gpu, &mut encoder, &target, (side, camera), stage, lighting);
                let copied = copy_texture(gpu, &mut encoder, &target);
                gpu.queue.submit([encoder.finish()]);
                own.waiting = Some(copied.read());
            }
            wants_more |= own.waiting.is_some();
        }
        Ok(wants_more)
    }

    /// Returns the truth, or a side's difference from it.
    pub fn texture(
        &mut self,
        context: &egui::Context,
        show: Show,
        side: usize,
    ) -> Option<TextureId> {
        let truth = self.truth.as_ref().filter(|truth| truth.is_done())?;
        let own = &mut self.sides[side];
        let make = |pixels: Vec<u8>| {
            let size = truth.subject.size().map(|side| side as usize);
            let image = ColorImage::from_rgba_unmultiplied(size, &pixels);
            context.load_texture("truth", image, TextureOptions::NEAREST)
        };
        let texture = if show == Show::Truth {
            let texture = &mut self.truth_texture;
            texture.get_or_insert_with(|| make(truth.picture()))
        } else {
            let verdict = own.verdict.as_ref()?;
            let texture = &mut own.texture;
            texture.get_or_insert_with(|| make(truth.difference(verdict)))
        };
        Some(texture.id())
    }
}
