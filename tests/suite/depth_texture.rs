//! Tests the depth texture that an engine receives: what its getters return, and that it can be
//! copied.

use glam::{DVec3, Vec3};
use shadow_support::mesh::Mesh;
use shadow_support::readback;
use wgpu_shadows::{
    Aabb, CascadeLayout, DirectionalLight, DirectionalShadow, DirectionalShadowDescriptor,
};

use crate::fixtures::frames::{Coverage, DirectionalFrame};
use crate::fixtures::gpu::vulkan;
use crate::fixtures::probe::record;
use crate::fixtures::scene::Scene;

/// A copy of the layer and a shader's samples of it agree bit for bit. (wgpu's OpenGL backend does
/// not copy depth textures.)
#[test]
fn the_texture_can_be_copied() {
    const SIZE: u32 = 64;
    let gpu = vulkan();
    let scene = Scene::new(gpu, &[Mesh::sphere(Vec3::Y, 1.0, 8)]);
    let descriptor = DirectionalShadowDescriptor {
        map_size: SIZE,
        layout: CascadeLayout::fixed(2),
        ..Default::default()
    };
    let mut shadow = DirectionalShadow::new(&gpu.device, &descriptor).expect("a valid sun");
    let frame = DirectionalFrame {
        origin: DVec3::ZERO,
        light: DirectionalLight::new(Vec3::new(0.3, -1.0, 0.1)),
        coverage: Coverage::Bounds(Aabb::new(Vec3::splat(-2.0), Vec3::splat(2.0))),
        casters: &scene.list(),
        receivers: &[],
    };
    let report = record(gpu, &mut shadow, &frame);
    let texture = shadow.maps().texture();
    assert_eq!(texture.format(), wgpu::TextureFormat::Depth32Float);
    assert_eq!((texture.width(), texture.height()), (SIZE, SIZE));
    assert_eq!(texture.depth_or_array_layers(), 2);
    assert_eq!(report.bytes_held, u64::from(SIZE * SIZE * 4 * 2));
    let staging = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("copied depths"),
        size: u64::from(SIZE * SIZE * 4),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.encoder();
    encoder.copy_texture_to_buffer(
        wgpu::TexelCopyTextureInfo {
            aspect: wgpu::TextureAspect::DepthOnly,
            ..texture.as_image_copy()
        },
        wgpu::TexelCopyBufferInfo {
            buffer: &staging,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(SIZE * 4),
                rows_per_image: None,
            },
        },
        wgpu::Extent3d {
            width: SIZE,
            height: SIZE,
            depth_or_array_layers: 1,
        },
    );
    gpu.submit(encoder);
    let copied: Vec<f32> = readback::buffer(gpu, &staging);
    let gathered = readback::depth_layer(gpu, texture, 0);
    assert!(copied.iter().any(|depth| *depth > 0.0));
    assert!(copied == gathered, "a copy and a look differ");
}
