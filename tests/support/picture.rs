//! Creates small targets to draw into.

use crate::support::gpu::Gpu;

pub const COLOR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// Creates a square colour texture that can be read back.
pub fn color_target(gpu: &Gpu, size: u32) -> wgpu::Texture {
    texture(gpu, size, COLOR, wgpu::TextureUsages::COPY_SRC)
}

/// Creates a depth texture of the same size.
pub fn depth_target(gpu: &Gpu, size: u32) -> wgpu::Texture {
    let format = wgpu::TextureFormat::Depth32Float;
    texture(gpu, size, format, wgpu::TextureUsages::empty())
}

fn texture(
    gpu: &Gpu,
    size: u32,
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> wgpu::Texture {
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("test target"),
        size: wgpu::Extent3d {
            width: size,
            height: size,
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: usage | wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    })
}

/// Begins a pass over `target`, cleared to opaque black.
pub fn color_pass<'a>(
    encoder: &'a mut wgpu::CommandEncoder,
    target: &wgpu::Texture,
) -> wgpu::RenderPass<'a> {
    pass(encoder, target, None)
}

/// Begins such a pass with a depth attachment, cleared to 1.
pub fn scene_pass<'a>(
    encoder: &'a mut wgpu::CommandEncoder,
    target: &wgpu::Texture,
    depth: &wgpu::Texture,
) -> wgpu::RenderPass<'a> {
    pass(encoder, target, Some(depth))
}

fn pass<'a>(
    encoder: &'a mut wgpu::CommandEncoder,
    target: &wgpu::Texture,
    depth: Option<&wgpu::Texture>,
) -> wgpu::RenderPass<'a> {
    let color = target.create_view(&Default::default());
    let depth = depth.map(|depth| depth.create_view(&Default::default()));
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("test picture"),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &color,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                store: wgpu::StoreOp::Store,
            },
        })],
        depth_stencil_attachment: depth.as_ref().map(|view| {
            wgpu::RenderPassDepthStencilAttachment {
                view,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(1.0),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }
        }),
        timestamp_writes: None,
        occlusion_query_set: None,
        multiview_mask: None,
    })
}
