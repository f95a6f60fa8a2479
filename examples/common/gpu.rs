//! Provides a device without a window, and reads images from it.

use std::error::Error;

/// Holds device and queue.
pub struct Gpu {
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
}

impl Gpu {
    /// Uses the adapter that wgpu prefers, of the backends that the variable `WGPU_BACKEND` names.
    pub fn new() -> Result<Self, Box<dyn Error>> {
        let options = wgpu::InstanceDescriptor::new_without_display_handle_from_env();
        let adapter = wgpu::Instance::new(options).request_adapter(&Default::default());
        let adapter = pollster::block_on(adapter).map_err(|_| {
            "no graphics adapter; one in software comes with `apt-get install mesa-vulkan-drivers` (.ci/with-vulkan)"
        })?;
        let (device, queue) = pollster::block_on(adapter.request_device(&Default::default()))?;
        Ok(Self { device, queue })
    }

    /// Creates a texture to draw to and, with one sample per pixel, to read back.
    pub fn target(
        &self,
        format: wgpu::TextureFormat,
        [width, height]: [u32; 2],
        sample_count: u32,
    ) -> wgpu::Texture {
        // Multisampled textures cannot be read back, and on OpenGL a texture that can be copied from would not be
        // resolved.
        let readable = if sample_count == 1 {
            wgpu::TextureUsages::COPY_SRC
        } else {
            wgpu::TextureUsages::empty()
        };
        self.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("target"),
            size: wgpu::Extent3d {
                width,
                height,
                depth_or_array_layers: 1,
            },
            mip_level_count: 1,
            sample_count,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | readable,
            view_formats: &[],
        })
    }

    /// Submits `encoder`, waits, and reads `texture` (four bytes per pixel) row by row.
    pub fn read(
        &self,
        mut encoder: wgpu::CommandEncoder,
        texture: &wgpu::Texture,
    ) -> Result<Vec<u8>, Box<dyn Error>> {
        let row = 4 * texture.width();
        let padded_row = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("read back"),
            size: u64::from(padded_row) * u64::from(texture.height()),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        encoder.copy_texture_to_buffer(
            texture.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &buffer,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(padded_row),
                    rows_per_image: None,
                },
            },
            texture.size(),
        );
        self.queue.submit([encoder.finish()]);
        buffer.map_async(wgpu::MapMode::Read, .., |_| ());
        self.device.poll(wgpu::PollType::wait_indefinitely())?;
        let bytes = buffer.get_mapped_range(..)?;
        Ok(bytes
            .chunks_exact(padded_row as usize)
            .flat_map(|padded| &padded[..row as usize])
            .copied()
            .collect())
    }
}
