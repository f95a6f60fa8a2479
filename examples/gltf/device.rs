//! Provides adapter and device, and reads images back.

use std::path::Path;

use crate::options::Backend;

/// Is a device without a window.
pub struct Gpu {
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    pub adapter_info: wgpu::AdapterInfo,
    /// States that timestamps can be written between passes.
    pub timestamps: bool,
}

impl Gpu {
    /// Uses the wanted backend, or the first that has an adapter.
    pub fn new(wanted: Option<Backend>) -> Result<Self, String> {
        // Vulkan comes first: merely looking for an OpenGL display makes some drivers write to stderr.
        let backends: &[wgpu::Backends] = match wanted {
            Some(Backend::Vulkan) => &[wgpu::Backends::VULKAN],
            Some(Backend::Gl) => &[wgpu::Backends::GL],
            None => &[wgpu::Backends::PRIMARY, wgpu::Backends::SECONDARY],
        };
        let adapter = backends.iter().find_map(|&backends| {
            let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
            descriptor.backends = backends;
            let instance = wgpu::Instance::new(descriptor);
            pollster::block_on(instance.request_adapter(&Default::default())).ok()
        });
        let adapter = adapter.ok_or(
            "no graphics adapter was found (on Debian: apt-get install mesa-vulkan-drivers)",
        )?;
        let timing =
            wgpu::Features::TIMESTAMP_QUERY | wgpu::Features::TIMESTAMP_QUERY_INSIDE_ENCODERS;
        let timestamps = adapter.features().contains(timing);
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("gltf example"),
            required_features: adapter.features() & (timing | wgpu::Features::MULTIVIEW),
            required_limits: adapter.limits(),
            ..Default::default()
        }))
        .map_err(|error| format!("no device: {error}"))?;
        Ok(Self {
            device,
            queue,
            adapter_info: adapter.get_info(),
            timestamps,
        })
    }

    /// Waits for everything that was submitted.
    pub fn wait(&self) -> Result<(), String> {
        self.device
            .poll(wgpu::PollType::wait_indefinitely())
            .map(|_| ())
            .map_err(|error| format!("the device stopped: {error}"))
    }

    /// Returns the bytes of a mappable buffer.
    pub fn read_buffer(&self, buffer: &wgpu::Buffer) -> Result<Vec<u8>, String> {
        let slice = buffer.slice(..);
        slice.map_async(wgpu::MapMode::Read, |_| {});
        self.wait()?;
        let bytes = slice
            .get_mapped_range()
            .map_err(|error| format!("cannot read back: {error}"))?
            .to_vec();
        buffer.unmap();
        Ok(bytes)
    }

    /// Returns the rows of a texture without padding.
    pub fn read_texture(&self, texture: &wgpu::Texture) -> Result<Vec<u8>, String> {
        let texel_bytes = texture.format().block_copy_size(None).unwrap_or(4);
        let row = texture.width() * texel_bytes;
        let padded = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("read back"),
            size: u64::from(padded) * u64::from(texture.height()),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder = self.device.create_command_encoder(&Default::default());
        encoder.copy_texture_to_buffer(
            texture.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &buffer,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(padded),
                    rows_per_image: None,
                },
            },
            texture.size(),
        );
        self.queue.submit([encoder.finish()]);
        let bytes = self.read_buffer(&buffer)?;
        Ok(bytes
            .chunks_exact(padded as usize)
            .flat_map(|padded_row| padded_row[..row as usize].iter().copied())
            .collect())
    }
}

/// Writes an image, with its path in the error.
pub fn save_png(path: &Path, picture: &image::DynamicImage) -> Result<(), String> {
    picture
        .save_with_format(path, image::ImageFormat::Png)
        .map_err(|error| format!("cannot write {}: {error}", path.display()))
}
