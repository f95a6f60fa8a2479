//! A field of point lights over a crowd.

use glam::DVec3;
use wgpu_shadows::{
    Coverage, OmniLight, OmniShadow, OmniShadowDescriptor, ShadowCaster, ShadowScene,
};

use super::counts::Counts;
use super::stage;
use crate::support::gpu::Gpu;

/// The golden angle in radians: successive lamps on a spiral keep their distance.
const TURN: f64 = 2.399_963;

/// Shadows of many lamps, with a scene that they share and that is kept from frame to frame.
pub struct Lamps {
    scene: ShadowScene,
    shadows: Vec<OmniShadow>,
}

impl Lamps {
    /// `count` lamps, 256 texels a side of each face.
    pub fn new(gpu: &Gpu, count: u32) -> Self {
        let descriptor = OmniShadowDescriptor {
            map_size: 256,
            ..Default::default()
        };
        let shadow = || OmniShadow::new(&gpu.device, &descriptor).expect("valid shadows");
        Self {
            scene: ShadowScene::new(),
            shadows: (0..count).map(|_| shadow()).collect(),
        }
    }

    /// Makes one frame for all lamps, spread over a square of ground of half the side `half`, records it, and tells what it took.
    pub fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        casters: &[&dyn ShadowCaster],
        half: f32,
    ) -> Counts {
        let frame = self
            .scene
            .frame(&stage::frame(casters, Coverage::Everything))
            .expect("a valid frame");
        let count = self.shadows.len() as f64;
        let mut counts = Counts::default();
        for (index, shadow) in (0..).map(f64::from).zip(&mut self.shadows) {
            let (sin, cos) = (TURN * index).sin_cos();
            let radius = f64::from(half) * (index / count).sqrt();
            let light = OmniLight {
                position_world: DVec3::new(radius * cos, 4.0, radius * sin),
                range: 10.0,
            };
            let report = shadow.record(encoder, &frame, &light);
            counts.add(report.expect("a valid light"));
        }
        counts
    }

    /// The same with every view drawn.
    pub fn record_anew(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        casters: &[&dyn ShadowCaster],
        half: f32,
    ) -> Counts {
        self.shadows.iter_mut().for_each(OmniShadow::invalidate);
        self.record(encoder, casters, half)
    }
}
