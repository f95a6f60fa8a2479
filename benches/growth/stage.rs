//! What the measurements of growth share.

use glam::{DVec3, Vec3};
use wgpu_shadows::{
    CameraView, Coverage, DirectionalFrame, DirectionalLight, DirectionalShadow,
    DirectionalShadowDescriptor, Filter, ShadowCaster,
};

use super::clock::Clock;
use super::processor;
use crate::support::camera;
use crate::support::gpu::Gpu;
use crate::support::statistics::Spread;

/// A device, its clock, and how often everything is repeated.
pub struct Stage<'a> {
    pub gpu: &'a Gpu,
    pub clock: Clock<'a>,
    pub repeats: u32,
}

/// The sun of all measurements.
pub const SUN: DirectionalLight = DirectionalLight::new(Vec3::new(-0.5, -1.0, -0.3));

impl Stage<'_> {
    /// A sun's shadows.
    pub fn sun(&self, map_size: u32, cascades: u32, filter: Filter) -> DirectionalShadow {
        let descriptor = DirectionalShadowDescriptor {
            map_size,
            cascades,
            filter,
            ..Default::default()
        };
        DirectionalShadow::new(&self.gpu.device, &descriptor).expect("a valid light")
    }

    /// `record` on the CPU, in an encoder that is then thrown away; of a frame that changed, or of one that did not.
    pub fn record_effort(
        &self,
        shadow: &mut DirectionalShadow,
        frame: &DirectionalFrame<'_>,
        changed: bool,
    ) -> processor::Effort {
        let mut first = self.gpu.encoder();
        record_anew(self.gpu, shadow, &mut first, frame);
        self.gpu.submit(first);
        processor::measure(
            self.repeats,
            || self.gpu.encoder(),
            |encoder| {
                if changed {
                    shadow.invalidate();
                }
                shadow
                    .record(&self.gpu.device, encoder, frame)
                    .map(|report| report.passes)
                    .expect("a valid frame")
            },
        )
    }

    /// Device time of one thing divided by that of another, run by run.
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

/// Records a frame with every view drawn.
pub fn record_anew(
    gpu: &Gpu,
    shadow: &mut DirectionalShadow,
    encoder: &mut wgpu::CommandEncoder,
    frame: &DirectionalFrame<'_>,
) {
    shadow.invalidate();
    shadow
        .record(&gpu.device, encoder, frame)
        .expect("a valid frame");
}

/// A frame of [`SUN`].
pub fn frame<'a>(casters: &'a [&'a dyn ShadowCaster], coverage: Coverage) -> DirectionalFrame<'a> {
    DirectionalFrame {
        origin: DVec3::ZERO,
        light: SUN,
        coverage,
        casters,
        receivers: &[],
    }
}

/// A camera at the edge of a square of ground, that sees to its far end.
pub fn to_the_horizon(half: f32) -> CameraView {
    camera::looking(Vec3::new(0.0, 3.0, half), Vec3::new(0.0, 0.0, -half), 0.9)
}
