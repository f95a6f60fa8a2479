//! Draws a shadow map as an image.

use std::error::Error;

use shadow_support::{gpu::Gpu, readback};
use wgpu_shadows::{ShadowMaps, debug::DebugImage, debug::DebugView};

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// Draws `what` of `source` after the commands of `encoder`, submits, and reads the image back:
/// four bytes per pixel.
pub fn draw(
    gpu: &Gpu,
    mut encoder: wgpu::CommandEncoder,
    source: &ShadowMaps,
    what: DebugImage,
    size: [u32; 2],
) -> Result<Vec<u8>, Box<dyn Error>> {
    let target = gpu.target(FORMAT, size, 1);
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("map"),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &target.create_view(&Default::default()),
            depth_slice: None,
            resolve_target: None,
            ops: Default::default(),
        })],
        ..Default::default()
    });
    let debug_view = DebugView::new(&gpu.device, FORMAT)?;
    debug_view.draw(&mut pass, source, what)?;
    drop(pass);
    Ok(readback::texels(gpu, encoder, &target)?)
}
