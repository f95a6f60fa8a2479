//! Records the engine's passes: the image with four samples per pixel, and the visibility alone
//! with one, for measuring.

use std::error::Error;

use example_support::camera::Camera;
use example_support::phong::{Batch, Lighting, Phong, PhongDescriptor, Picture};
use glam::Vec3;
use shadow_support::gpu::Gpu;
use shadow_support::readback;

use crate::lookup::{GROUP, Lookup};
use crate::scene::Scene;

/// Is the width and height of the images.
pub const SIZE: [u32; 2] = [960, 540];

/// Is what a pass draws.
struct Output {
    fragment_entry: &'static str,
    format: wgpu::TextureFormat,
    sample_count: u32,
}

const PICTURE: Output = Output {
    fragment_entry: "fragment_picture",
    format: wgpu::TextureFormat::Rgba8UnormSrgb,
    sample_count: 4,
};

const VISIBILITY: Output = Output {
    fragment_entry: "fragment_visibility",
    format: wgpu::TextureFormat::Rgba8Unorm,
    sample_count: 1,
};

/// Holds the scene as drawn with one lookup.
pub struct Painted {
    /// Is stored row by row, four bytes per pixel.
    pub picture: Vec<u8>,
    /// Is stored row by row, one value per pixel, at its centre, to 1/255.
    pub visibility: Vec<f32>,
}

/// Draws the scene as `camera` sees it, after the commands of `encoder`, submits, and reads both
/// outputs back.
pub fn paint(
    gpu: &Gpu,
    scene: &Scene,
    camera: &Camera,
    lookup: &Lookup,
    mut encoder: wgpu::CommandEncoder,
) -> Result<Painted, Box<dyn Error>> {
    let lighting = Lighting {
        light: scene.toward_light.extend(0.0),
        light_color: Vec3::ONE,
        light_range: f32::INFINITY,
        ambient: Vec3::splat(0.2),
        sky: Vec3::new(0.45, 0.55, 0.70),
    };
    let mut draw = |output: &Output| {
        let phong = Phong::new(
            gpu,
            &PhongDescriptor {
                visibility_wgsl: &lookup.wgsl,
                fragment_wgsl: include_str!("scene.wgsl"),
                fragment_entry: output.fragment_entry,
                shadow_group: GROUP,
                shadow_layout: &lookup.layout,
                format: output.format,
                sample_count: output.sample_count,
            },
        );
        let target = gpu.target(output.format, SIZE, 1);
        let batches = scene.objects().map(Batch::from);
        phong.draw(
            gpu,
            &mut encoder,
            &Picture {
                camera,
                lighting: &lighting,
                shadows: &lookup.bind_group,
                target: &target,
            },
            batches,
        );
        target
    };
    let picture = draw(&PICTURE);
    let visibility = draw(&VISIBILITY);

    let picture = readback::texels(gpu, encoder, &picture)?;
    let encoder = gpu.device.create_command_encoder(&Default::default());
    let visibility = readback::texels(gpu, encoder, &visibility)?;
    Ok(Painted {
        picture,
        visibility: visibility
            .chunks_exact(4)
            .map(|pixel| f32::from(pixel[0]) / 255.0)
            .collect(),
    })
}
