//! A field of point lights over a crowd.

use glam::DVec3;
use wgpu_shadows::{OmniFrame, OmniLight, OmniShadow, OmniShadowDescriptor, ShadowCaster};

use super::counts::Counts;
use crate::support::gpu::Gpu;

/// The golden angle in radians: successive lamps on a spiral keep their distance.
const TURN: f64 = 2.399_963;

/// Shadows of `count` lamps, 256 texels a side of each face.
pub fn make(gpu: &Gpu, count: u32) -> Vec<OmniShadow> {
    let descriptor = OmniShadowDescriptor {
        map_size: 256,
        ..Default::default()
    };
    (0..count)
        .map(|_| OmniShadow::new(&gpu.device, &descriptor).expect("a valid light"))
        .collect()
}

/// Records a frame of lamps spread over a square of ground of half the side `half`, and tells what it took.
pub fn record(
    gpu: &Gpu,
    encoder: &mut wgpu::CommandEncoder,
    lamps: &mut [OmniShadow],
    casters: &[&dyn ShadowCaster],
    half: f32,
) -> Counts {
    let count = lamps.len() as f64;
    let mut counts = Counts::default();
    for (index, lamp) in (0..).map(f64::from).zip(lamps) {
        let (sin, cos) = (TURN * index).sin_cos();
        let radius = f64::from(half) * (index / count).sqrt();
        let frame = OmniFrame {
            origin: DVec3::ZERO,
            light: OmniLight {
                position_world: DVec3::new(radius * cos, 4.0, radius * sin),
                range: 10.0,
            },
            camera: None,
            casters,
            receivers: &[],
        };
        let report = lamp.record(&gpu.device, encoder, &frame);
        counts.add(report.expect("a valid frame"));
    }
    counts
}
