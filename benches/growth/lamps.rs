//! Provides a field of point lights over a crowd.

use glam::DVec3;
use shadow_support::gpu::Gpu;
use wgpu_shadows::{
    Casters, Coverage, OmniLight, OmniShadow, OmniShadowDescriptor, ShadowCaster,
    ShadowFrameDescriptor, ShadowScene,
};

use super::counts::Counts;
use super::stage;

/// Is the golden angle in radians: successive lights on a spiral keep their distance.
const TURN: f64 = 2.399_963;

/// Holds the shadows of many point lights, with a scene that they share and that is reused from
/// frame to frame.
pub struct Lamps {
    scene: ShadowScene,
    shadows: Vec<OmniShadow>,
}

impl Lamps {
    /// Makes `count` lights with 256 texels per side of each face.
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

    /// Makes one frame for all lights, which are spread over a square of ground of half the side
    /// `half`, records it, and returns its counts.
    pub fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        casters: Casters<'_>,
        half: f32,
    ) -> Counts {
        let frame = ShadowFrameDescriptor {
            casters,
            ..stage::frame(&[], Coverage::Everything)
        };
        let frame = self.scene.frame(&frame).expect("a valid frame");
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

    /// Records such a frame with every view drawn.
    pub fn record_anew(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        casters: &[&dyn ShadowCaster],
        half: f32,
    ) -> Counts {
        self.shadows.iter_mut().for_each(OmniShadow::invalidate);
        self.record(encoder, Casters::List(casters), half)
    }
}
