//! Reads all layers of a texture as bytes, by a copy: fast enough for thousands of frames, but not available on OpenGL.

use crate::support::gpu::Gpu;

pub struct TextureBytes {
    texture: wgpu::Texture,
    buffer: wgpu::Buffer,
    bytes_per_row: u32,
}

impl TextureBytes {
    /// Makes a reader for rows of a multiple of 256 bytes.
    pub fn new(gpu: &Gpu, texture: &wgpu::Texture) -> Self {
        let texel = match texture.format() {
            wgpu::TextureFormat::Depth16Unorm => 2,
            _ => 4,
        };
        let bytes_per_row = texture.width() * texel;
        let layers = u64::from(texture.depth_or_array_layers());
        Self {
            texture: texture.clone(),
            buffer: gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("texture bytes"),
                size: u64::from(bytes_per_row) * u64::from(texture.height()) * layers,
                usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
                mapped_at_creation: false,
            }),
            bytes_per_row,
        }
    }

    pub fn copy(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.copy_texture_to_buffer(
            self.texture.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &self.buffer,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(self.bytes_per_row),
                    rows_per_image: Some(self.texture.height()),
                },
            },
            self.texture.size(),
        );
    }

    /// Returns what commands that the device has executed have copied, layer by layer.
    pub fn read(&self, gpu: &Gpu) -> Vec<Vec<u8>> {
        let slice = self.buffer.slice(..);
        slice.map_async(wgpu::MapMode::Read, |mapped| {
            mapped.expect("a mapped buffer")
        });
        gpu.device
            .poll(wgpu::PollType::wait_indefinitely())
            .expect("the device finishes its work");
        let layer_bytes = self.bytes_per_row as usize * self.texture.height() as usize;
        let mapped = slice.get_mapped_range().expect("a mapped buffer");
        let layers = mapped.chunks(layer_bytes).map(<[u8]>::to_vec).collect();
        drop(mapped);
        self.buffer.unmap();
        layers
    }
}
