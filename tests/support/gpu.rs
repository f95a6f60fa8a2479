//! Provides one device for all tests of the run, which reports every error that no test expects.

use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

/// Holds a device, its queue, and the words by which a failure names the machine on which it happened.
pub struct Gpu {
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    pub adapter: wgpu::AdapterInfo,
    /// Allows one submission at a time: the OpenGL backend gives up when it waits long for its only context.
    submitting: Mutex<()>,
}

/// Describes what an instance and a device need beyond the defaults.
#[derive(Default)]
pub struct GpuRequest {
    pub features: wgpu::Features,
    pub limits: wgpu::Limits,
    /// Is the backend; `None` for that of the run.
    pub backend: Option<wgpu::Backends>,
}

/// Returns the shared device.
pub fn gpu() -> &'static Gpu {
    static SHARED: OnceLock<Gpu> = OnceLock::new();
    SHARED.get_or_init(|| Gpu::new(GpuRequest::default()))
}

/// Returns a shared Vulkan device, whatever the backend of the run, for what wgpu's OpenGL backend cannot do.
pub fn vulkan() -> &'static Gpu {
    static SHARED: OnceLock<Gpu> = OnceLock::new();
    if gpu().adapter.backend == wgpu::Backend::Vulkan {
        return gpu();
    }
    SHARED.get_or_init(|| {
        Gpu::new(GpuRequest {
            backend: Some(wgpu::Backends::VULKAN),
            ..Default::default()
        })
    })
}

impl Gpu {
    /// Creates a device of its own, for tests that need other features or limits than the default.
    pub fn new(request: GpuRequest) -> Self {
        let adapter = adapter(&request);
        Self::of(&adapter, &request)
    }

    /// Returns whether the machine has an adapter of one of these backends.
    pub fn is_there(backends: wgpu::Backends) -> bool {
        !adapters(backends).is_empty()
    }

    /// Creates two devices of one instance: wgpu distinguishes the objects of one from those of the other.
    pub fn two() -> [Self; 2] {
        let request = GpuRequest::default();
        let adapter = adapter(&request);
        [(); 2].map(|()| Self::of(&adapter, &request))
    }

    fn of(adapter: &wgpu::Adapter, request: &GpuRequest) -> Self {
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("shadow tests"),
            required_features: request.features,
            required_limits: request.limits.clone(),
            ..Default::default()
        }))
        .unwrap_or_else(|error| panic!("{}: {error}", adapter.get_info().name));
        // The handler runs on the thread whose call failed, so the panic fails that thread's test and no other.
        device.on_uncaptured_error(Arc::new(|error: wgpu::Error| {
            panic!("uncaptured device error: {error}")
        }));
        Self {
            adapter: adapter.get_info(),
            device,
            queue,
            submitting: Mutex::new(()),
        }
    }

    /// Returns "name (driver) over backend", for messages.
    pub fn describe(&self) -> String {
        let info = &self.adapter;
        format!("{} ({}) over {}", info.name, info.driver_info, info.backend)
    }

    pub fn encoder(&self) -> wgpu::CommandEncoder {
        self.device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default())
    }

    /// Submits the commands of `encoder` and waits until the device has executed them.
    pub fn submit(&self, encoder: wgpu::CommandEncoder) {
        let _turn = self.turn();
        let index = self.queue.submit([encoder.finish()]);
        self.device
            .poll(wgpu::PollType::Wait {
                submission_index: Some(index),
                timeout: None,
            })
            .expect("the device finishes its work");
    }

    /// Creates a buffer that contains `contents`.
    pub fn buffer(
        &self,
        contents: &[impl bytemuck::NoUninit],
        usage: wgpu::BufferUsages,
    ) -> wgpu::Buffer {
        use wgpu::util::DeviceExt;
        self.device
            .create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: None,
                contents: bytemuck::cast_slice(contents),
                usage,
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

fn adapter(request: &GpuRequest) -> wgpu::Adapter {
    let backends = request.backend.unwrap_or_else(backends);
    let adapters = adapters(backends);
    // A software adapter gives every machine the same pixels, so it is preferred.
    let software =
        |adapter: &&wgpu::Adapter| adapter.get_info().device_type == wgpu::DeviceType::Cpu;
    adapters
        .iter()
        .find(software)
        .or(adapters.first())
        .cloned()
        .unwrap_or_else(|| {
            panic!(
                "no {backends:?} adapter. On Debian and Ubuntu a software one comes with `apt-get install \
                 mesa-vulkan-drivers` (Vulkan) or `libegl1 libgl1-mesa-dri` (OpenGL)."
            )
        })
}

fn adapters(backends: wgpu::Backends) -> Vec<wgpu::Adapter> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends,
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    });
    pollster::block_on(instance.enumerate_adapters(backends))
}

fn backends() -> wgpu::Backends {
    match std::env::var("SHADOW_TEST_BACKEND").as_deref() {
        Err(_) | Ok("vulkan") => wgpu::Backends::VULKAN,
        Ok("gl") => wgpu::Backends::GL,
        Ok(other) => panic!("SHADOW_TEST_BACKEND must be vulkan or gl, got {other:?}"),
    }
}
