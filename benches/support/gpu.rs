//! Provides a device without a window, and reads its results.

use wgpu::util::{BufferInitDescriptor, DeviceExt};

/// Holds adapter, device and queue.
pub struct Gpu {
    pub adapter: wgpu::AdapterInfo,
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    /// States that timestamps can be written between passes.
    pub has_timestamps: bool,
}

impl Gpu {
    /// Uses the first Vulkan adapter, a software one where there is nothing better, and any other backend where there
    /// is no Vulkan.
    pub fn new() -> Result<Self, String> {
        let backends = [wgpu::Backends::VULKAN, wgpu::Backends::PRIMARY];
        let adapter = backends.iter().find_map(|&backends| {
            let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
            descriptor.backends = backends;
            let instance = wgpu::Instance::new(descriptor);
            pollster::block_on(instance.request_adapter(&Default::default())).ok()
        });
        let adapter = adapter.ok_or(
            "no graphics adapter; on Debian and Ubuntu `apt-get install mesa-vulkan-drivers` brings one in software",
        )?;
        let timing =
            wgpu::Features::TIMESTAMP_QUERY | wgpu::Features::TIMESTAMP_QUERY_INSIDE_ENCODERS;
        let has_timestamps = adapter.features().contains(timing);
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("bench"),
            required_features: adapter.features() & (timing | wgpu::Features::MULTIVIEW),
            required_limits: adapter.limits(),
            ..Default::default()
        }))
        .map_err(|error| format!("no device: {error}"))?;
        Ok(Self {
            adapter: adapter.get_info(),
            device,
            queue,
            has_timestamps,
        })
    }

    /// Returns "name (kind, driver) over backend".
    pub fn describe(&self) -> String {
        let info = &self.adapter;
        format!(
            "{} ({:?}, {}) over {}",
            info.name, info.device_type, info.driver_info, info.backend
        )
    }

    /// Returns whether it is a software rasterizer, whose milliseconds say nothing about a GPU's.
    pub fn is_software(&self) -> bool {
        self.adapter.device_type == wgpu::DeviceType::Cpu
    }

    pub fn encoder(&self) -> wgpu::CommandEncoder {
        self.device.create_command_encoder(&Default::default())
    }

    /// Submits the commands of `encoder` and waits until the device has executed them.
    pub fn submit(&self, encoder: wgpu::CommandEncoder) {
        self.queue.submit([encoder.finish()]);
        self.wait();
    }

    fn wait(&self) {
        self.device
            .poll(wgpu::PollType::wait_indefinitely())
            .expect("the device finishes its work");
    }

    /// Creates a buffer that contains `contents`.
    pub fn buffer(
        &self,
        contents: &[impl bytemuck::NoUninit],
        usage: wgpu::BufferUsages,
    ) -> wgpu::Buffer {
        self.device.create_buffer_init(&BufferInitDescriptor {
            label: None,
            contents: bytemuck::cast_slice(contents),
            usage,
        })
    }

    /// Creates an empty buffer of `bytes`.
    pub fn empty_buffer(&self, bytes: u64, usage: wgpu::BufferUsages) -> wgpu::Buffer {
        self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: bytes,
            usage,
            mapped_at_creation: false,
        })
    }

    /// Creates a shader module from WGSL.
    pub fn shader(&self, source: &str) -> wgpu::ShaderModule {
        self.device
            .create_shader_module(wgpu::ShaderModuleDescriptor {
                label: None,
                source: wgpu::ShaderSource::Wgsl(source.into()),
            })
    }

    /// Returns the contents of a buffer created with `COPY_SRC`.
    pub fn read<T: bytemuck::Pod>(&self, buffer: &wgpu::Buffer) -> Vec<T> {
        let readable = self.empty_buffer(
            buffer.size(),
            wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        );
        let mut encoder = self.encoder();
        encoder.copy_buffer_to_buffer(buffer, 0, &readable, 0, buffer.size());
        self.queue.submit([encoder.finish()]);
        readable.map_async(wgpu::MapMode::Read, .., |_| ());
        self.wait();
        let bytes = readable
            .get_mapped_range(..)
            .expect("the buffer is mapped")
            .to_vec();
        bytes
            .chunks_exact(size_of::<T>())
            .map(bytemuck::pod_read_unaligned)
            .collect()
    }
}
