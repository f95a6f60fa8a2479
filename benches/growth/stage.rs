//! Provides what the measurements of growth share.

use glam::{DVec3, Vec3};
use shadow_support::camera;
use shadow_support::clock::Clock;
use shadow_support::gpu::Gpu;
use shadow_support::measure::statistics::Spread;
use wgpu_shadows::{
    CameraView, CascadeLayout, Casters, Coverage, DirectionalLight, DirectionalShadow,
    DirectionalShadowDescriptor, Filter, ShadowCaster, ShadowFrameDescriptor, ShadowScene,
    report::ShadowReport,
};

use super::processor;

/// Holds a device, its clock, and the number of repetitions.
pub struct Stage<'a> {
    pub gpu: &'a Gpu,
    pub clock: Clock<'a>,
    pub repeats: u32,
}

/// Is the sun of all measurements.
const SUN: DirectionalLight = DirectionalLight::new(Vec3::new(-0.5, -1.0, -0.3));

/// Holds the sun's shadows, with a scene that is reused from frame to frame.
pub struct Sun {
    scene: ShadowScene,
    pub shadow: DirectionalShadow,
}

impl Sun {
    /// Makes a frame and records it.
    pub fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        frame: &ShadowFrameDescriptor<'_, '_>,
    ) -> &ShadowReport {
        let frame = self.scene.frame(frame).expect("a valid frame");
        let report = self.shadow.record(encoder, &frame, &SUN);
        report.expect("a valid light")
    }

    /// Records such a frame with every view drawn.
    pub fn record_anew(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        frame: &ShadowFrameDescriptor<'_, '_>,
    ) {
        self.shadow.invalidate();
        self.record(encoder, frame);
    }
}

impl Stage<'_> {
    /// Makes the sun's shadows.
    pub fn sun(&self, map_size: u32, cascades: u32, filter: Filter) -> Sun {
        let descriptor = DirectionalShadowDescriptor {
            map_size,
            layout: CascadeLayout::fixed(cascades),
            filter,
            ..Default::default()
        };
        let shadow = DirectionalShadow::new(&self.gpu.device, &descriptor);
        Sun {
            scene: ShadowScene::new(),
            shadow: shadow.expect("valid shadows"),
        }
    }

    /// Measures `frame` and `record` on the CPU, in an encoder that is then dropped, for a frame
    /// that changed or for one that did not.
    pub fn record_effort(
        &self,
        sun: &mut Sun,
        frame: &ShadowFrameDescriptor<'_, '_>,
        changed: bool,
    ) -> processor::Effort {
        let mut first = self.gpu.encoder();
        sun.record_anew(&mut first, frame);
        self.gpu.submit(first);
        processor::measure(
            self.repeats,
            || self.gpu.encoder(),
            |encoder| {
                if changed {
                    sun.shadow.invalidate();
                }
                sun.record(encoder, frame).passes
            },
        )
    }

    /// Returns the device time of one thing divided by that of another, run by run.
    pub fn ratio(
        &self,
        mut own: impl FnMut(&mut wgpu::CommandEncoder),
        mut other: impl FnMut(&mut wgpu::CommandEncoder),
    ) -> Spread {
        // The first run of each warms up.
        self.clock.seconds(&mut other);
        self.clock.seconds(&mut own);
        Spread::of((0..self.repeats).map(|_| {
            let before = self.clock.seconds(&mut other);
            self.clock.seconds(&mut own) / before
        }))
    }
}

/// Returns the descriptor of a frame.
pub fn frame<'d, 'c>(
    casters: &'c [&'c dyn ShadowCaster],
    coverage: Coverage<'d>,
) -> ShadowFrameDescriptor<'d, 'c> {
    ShadowFrameDescriptor {
        origin: DVec3::ZERO,
        coverage,
        casters: Casters::List(casters),
        receivers: &[],
    }
}

/// Returns a camera at the edge of a square of ground that sees to its far end.
pub fn to_the_horizon(half: f32) -> CameraView {
    camera::looking(Vec3::new(0.0, 3.0, half), Vec3::new(0.0, 0.0, -half), 0.9)
}
