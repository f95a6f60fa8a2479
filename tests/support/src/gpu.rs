//! Provides devices without a window.

use std::sync::{Mutex, MutexGuard, PoisonError};

use wgpu::util::{BufferInitDescriptor, DeviceExt};

/// Holds a device, its queue, and the words by which a message names the machine.
pub struct Gpu {
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    pub adapter: wgpu::AdapterInfo,
    /// States that timestamps can be written between passes.
    pub has_timestamps: bool,
    /// Allows one submission at a time: the OpenGL backend gives up when it waits long for its only
    /// context.
    submitting: Mutex<()>,
}

/// Describes the adapter that is wanted, and what its device needs.
pub struct GpuRequest {
    /// Lists sets of backends; the first that has an adapter is used.
    pub backends: Vec<wgpu::Backends>,
    /// States that a software adapter is preferred, which gives every machine the same pixels;
    /// otherwise wgpu's preference decides.
    pub prefers_software: bool,
    /// Are the features without which there is no device.
    pub features: wgpu::Features,
    /// Are the features that are enabled where the adapter has them.
    pub optional_features: wgpu::Features,
    /// Are the limits; `None` for all that the adapter has.
    pub limits: Option<wgpu::Limits>,
}

/// Are the features with which timestamps can be written between passes.
pub const TIMESTAMPS: wgpu::Features =
    wgpu::Features::TIMESTAMP_QUERY.union(wgpu::Features::TIMESTAMP_QUERY_INSIDE_ENCODERS);

impl Default for GpuRequest {
    /// Asks for wgpu's preferred adapter among the backends that the variable `WGPU_BACKEND` names,
    /// and for a device with the features and limits that every engine can have.
    fn default() -> Self {
        Self {
            backends: vec![wgpu::Backends::from_env().unwrap_or_default()],
            prefers_software: false,
            features: wgpu::Features::empty(),
            optional_features: wgpu::Features::empty(),
            limits: Some(wgpu::Limits::default()),
        }
    }
}

impl GpuRequest {
    /// Asks for all that measurements can use: timestamps, several views per pass, and the
    /// adapter's own limits; of Vulkan, or of another backend where there is no Vulkan. Merely
    /// looking for an OpenGL display makes some drivers write to stderr, so that one comes last.
    pub fn measuring() -> Self {
        Self {
            backends: vec![
                wgpu::Backends::VULKAN,
                wgpu::Backends::PRIMARY,
                wgpu::Backends::SECONDARY,
            ],
            optional_features: TIMESTAMPS | wgpu::Features::MULTIVIEW,
            limits: None,
            ..Self::default()
        }
    }

    /// Returns the adapter on which this request finds its device.
    pub fn adapter(&self) -> Result<wgpu::Adapter, String> {
        let found = self.backends.iter().find_map(|&backends| {
            if self.prefers_software {
                let adapters = adapters(backends);
                let is_software = |adapter: &&wgpu::Adapter| {
                    adapter.get_info().device_type == wgpu::DeviceType::Cpu
                };
                let software = adapters.iter().find(is_software);
                return software.or(adapters.first()).cloned();
            }
            let adapter = instance(backends).request_adapter(&Default::default());
            pollster::block_on(adapter).ok()
        });
        found.ok_or_else(|| {
            let backends = self.backends.iter().copied().collect::<wgpu::Backends>();
            format!(
                "no graphics adapter for {backends:?}; on Debian and Ubuntu a software one comes \
                 with `apt-get install mesa-vulkan-drivers` (Vulkan) or `libegl1 \
                 libgl1-mesa-dri` (OpenGL)"
            )
        })
    }
}

/// Returns all adapters of these backends.
pub fn adapters(backends: wgpu::Backends) -> Vec<wgpu::Adapter> {
    pollster::block_on(instance(backends).enumerate_adapters(backends))
}

fn instance(backends: wgpu::Backends) -> wgpu::Instance {
    wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends,
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    })
}

impl Gpu {
    /// Creates a device, or returns in one line why there is none.
    pub fn new(request: &GpuRequest) -> Result<Self, String> {
        Self::of(&request.adapter()?, request)
    }

    /// Creates a device of `adapter`.
    pub fn of(adapter: &wgpu::Adapter, request: &GpuRequest) -> Result<Self, String> {
        let optional = adapter.features() & request.optional_features;
        let required_features = request.features | optional;
        let limits = request.limits.clone();
        let device = adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("wgpu-shadows"),
            required_features,
            required_limits: limits.unwrap_or_else(|| adapter.limits()),
            ..Default::default()
        });
        let (device, queue) = pollster::block_on(device)
            .map_err(|error| format!("no device of {}: {error}", adapter.get_info().name))?;
        Ok(Self::from_device(adapter.get_info(), device, queue))
    }

    /// Makes one of a device that exists already: that of a window, for example.
    pub fn from_device(
        adapter: wgpu::AdapterInfo,
        device: wgpu::Device,
        queue: wgpu::Queue,
    ) -> Self {
        Self {
            has_timestamps: device.features().contains(TIMESTAMPS),
            device,
            queue,
            adapter,
            submitting: Mutex::new(()),
        }
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
        self.device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default())
    }

    /// Submits the commands of `encoder` and waits until the device has executed them.
    pub fn submit(&self, encoder: wgpu::CommandEncoder) {
        self.try_submit(encoder)
            .expect("the device finishes its work");
    }

    /// Does the same, and returns the error of a device that does not finish.
    pub fn try_submit(&self, encoder: wgpu::CommandEncoder) -> Result<(), String> {
        let _turn = self.turn();
        let index = self.queue.submit([encoder.finish()]);
        self.device
            .poll(wgpu::PollType::Wait {
                submission_index: Some(index),
                timeout: None,
            })
            .map(|_| ())
            .map_err(|error| format!("the device stopped: {error}"))
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

    /// Creates a zeroed buffer of `bytes`.
    pub fn empty_buffer(&self, bytes: u64, usage: wgpu::BufferUsages) -> wgpu::Buffer {
        self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: bytes,
            usage,
            mapped_at_creation: false,
        })
    }

    /// Creates a texture to draw to and, with one sample per pixel, to read back.
    pub fn target(
        &self,
        format: wgpu::TextureFormat,
        [width, height]: [u32; 2],
        sample_count: u32,
    ) -> wgpu::Texture {
        // Multisampled textures cannot be read back, and on OpenGL a texture that can be copied
        // from would not be resolved.
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

    /// Creates a shader module from WGSL.
    pub fn shader(&self, source: &str) -> wgpu::ShaderModule {
        self.device
            .create_shader_module(wgpu::ShaderModuleDescriptor {
                label: None,
                source: wgpu::ShaderSource::Wgsl(source.into()),
            })
    }

    fn turn(&self) -> MutexGuard<'_, ()> {
        // A test that panicked while it held the lock has left nothing half done.
        self.submitting
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
    }
}
