//! Shows the viewer in a window, or on the canvas of a page.

use std::sync::Arc;
use std::time::Duration;

use egui::ViewportId;
use shadow_support::gpu::{Gpu, TIMESTAMPS};
use web_time::Instant;
use winit::application::ApplicationHandler;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop, EventLoopProxy};
use winit::window::{Window, WindowAttributes, WindowId};

use crate::device_errors::DeviceErrors;
use crate::host;
use crate::state::Request;
use crate::viewer::Viewer;

/// Is the least time between two writings of the address: browsers refuse more.
const ADDRESS_PAUSE: Duration = Duration::from_millis(500);

/// Is what comes to the window from beside its events.
pub enum Arrival {
    /// The device is there, or there is none.
    Made(Box<Result<Shown, String>>, Arc<Window>),
    /// A panel asks for something: a file was dropped on the page.
    #[cfg_attr(not(target_arch = "wasm32"), expect(dead_code))]
    Request(Request),
}

/// Holds a window with its viewer.
pub struct Shown {
    window: Arc<Window>,
    surface: wgpu::Surface<'static>,
    configuration: wgpu::SurfaceConfiguration,
    input: egui_winit::State,
    viewer: Viewer,
    errors: DeviceErrors,
}

/// Answers the events of the window.
pub struct App {
    proxy: EventLoopProxy<Arrival>,
    /// Holds the settings that the window begins with.
    address: String,
    first_request: Option<Request>,
    attributes: WindowAttributes,
    shown: Option<Shown>,
    /// Is shown instead where there is no device.
    notice: Option<host::Notice>,
    /// Is when the address was last written.
    address_kept: Instant,
    /// Is when the next frame is wanted, if not at once.
    next_frame: Option<Instant>,
    /// Is why there is no viewer in the window.
    pub failure: Option<String>,
}

/// Shows the window until it is closed. `address` holds settings as the page does.
pub fn run(
    address: String,
    first_request: Option<Request>,
    attributes: WindowAttributes,
) -> Result<(), String> {
    let event_loop = EventLoop::with_user_event().build();
    let event_loop = event_loop.map_err(|error| format!("no window: {error}"))?;
    let app = App {
        proxy: event_loop.create_proxy(),
        address,
        first_request,
        attributes,
        shown: None,
        notice: None,
        address_kept: Instant::now(),
        next_frame: None,
        failure: None,
    };
    host::before_run(&app.proxy);
    host::run_app(event_loop, app)
}

impl ApplicationHandler<Arrival> for App {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        if self.shown.is_some() || self.notice.is_some() {
            return;
        }
        let window = match event_loop.create_window(self.attributes.clone()) {
            Ok(window) => Arc::new(window),
            Err(error) => {
                self.failure = Some(format!("no window: {error}"));
                event_loop.exit();
                return;
            }
        };
        let (proxy, address) = (self.proxy.clone(), self.address.clone());
        let display = event_loop.owned_display_handle();
        host::spawn(async move {
            let made = Shown::new(window.clone(), Box::new(display), &address).await;
            // The loop is gone where nobody receives this.
            let _ = proxy.send_event(Arrival::Made(Box::new(made), window));
        });
    }

    fn user_event(&mut self, event_loop: &ActiveEventLoop, arrival: Arrival) {
        match arrival {
            Arrival::Made(made, window) => match *made {
                Ok(mut shown) => {
                    shown
                        .viewer
                        .state
                        .requests
                        .extend(self.first_request.take());
                    // On a page the canvas may have found its size meanwhile.
                    let size = shown.window.inner_size();
                    shown.resize([size.width, size.height]);
                    shown.window.request_redraw();
                    self.shown = Some(shown);
                }
                Err(error) => {
                    host::log(&error);
                    self.notice = host::Notice::new(window, &error);
                    self.failure = Some(error);
                    if self.notice.is_none() {
                        event_loop.exit();
                    }
                }
            },
            Arrival::Request(request) => {
                if let Some(shown) = &mut self.shown {
                    shown.viewer.state.requests.push(request);
                    shown.window.request_redraw();
                }
            }
        }
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(shown) = &mut self.shown else {
            match (event, &mut self.notice) {
                (WindowEvent::CloseRequested, _) => event_loop.exit(),
                (WindowEvent::RedrawRequested, Some(notice)) => notice.draw(),
                _ => {}
            }
            return;
        };
        if shown.input.on_window_event(&shown.window, &event).repaint {
            shown.window.request_redraw();
        }
        match event {
            WindowEvent::CloseRequested => event_loop.exit(),
            WindowEvent::Resized(size) => shown.resize([size.width, size.height]),
            WindowEvent::RedrawRequested => {
                let mut wait = shown.redraw();
                if self.address_kept.elapsed() > ADDRESS_PAUSE {
                    self.address_kept = Instant::now();
                    host::keep_address(&shown.viewer.state.settings);
                } else if cfg!(target_arch = "wasm32") {
                    // A later frame keeps what this one may not.
                    wait = wait.min(ADDRESS_PAUSE);
                }
                // A time that no clock reaches is no time.
                self.next_frame = Instant::now().checked_add(wait);
            }
            _ => {}
        }
    }

    fn about_to_wait(&mut self, event_loop: &ActiveEventLoop) {
        let Some(shown) = &self.shown else { return };
        match self.next_frame {
            Some(next) if next <= Instant::now() => {
                self.next_frame = None;
                shown.window.request_redraw();
                event_loop.set_control_flow(ControlFlow::Wait);
            }
            Some(next) => event_loop.set_control_flow(ControlFlow::WaitUntil(next)),
            None => event_loop.set_control_flow(ControlFlow::Wait),
        }
    }
}

impl Shown {
    /// Makes device and viewer for a window.
    async fn new(
        window: Arc<Window>,
        display: Box<dyn wgpu::wgt::WgpuHasDisplayHandle>,
        address: &str,
    ) -> Result<Self, String> {
        let instance = wgpu::Instance::new(
            wgpu::InstanceDescriptor::new_with_display_handle_from_env(display),
        );
        let surface = instance
            .create_surface(window.clone())
            .map_err(|error| host::no_adapter(&error))?;
        let request = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            compatible_surface: Some(&surface),
            ..Default::default()
        };
        let adapter = instance.request_adapter(&request).await;
        let adapter = adapter.map_err(|error| host::no_adapter(&error))?;
        let device = adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("viewer"),
            required_features: adapter.features() & TIMESTAMPS,
            required_limits: limits(&adapter),
            ..Default::default()
        });
        let (device, queue) = device
            .await
            .map_err(|error| format!("no device: {error}"))?;
        let size = window.inner_size();
        let [width, height] = [size.width.max(1), size.height.max(1)];
        let mut configuration = surface
            .get_default_config(&adapter, width, height)
            .ok_or("the adapter cannot draw to the window")?;
        // The panels are mixed in sRGB codes.
        let formats = surface.get_capabilities(&adapter).formats;
        let plain = formats.iter().find(|format| !format.is_srgb());
        configuration.format = plain.copied().unwrap_or(configuration.format);
        configuration.desired_maximum_frame_latency = 1;
        surface.configure(&device, &configuration);
        let awake = window.clone();
        let errors = DeviceErrors::listen(&device, move || awake.request_redraw());
        let gpu = Gpu::from_device(adapter.get_info(), device, queue);
        let most = gpu.device.limits().max_texture_dimension_2d as usize;
        let viewer = Viewer::new(gpu, configuration.format, address)?;
        let input = egui_winit::State::new(
            viewer.context.clone(),
            ViewportId::ROOT,
            &*window,
            Some(window.scale_factor() as f32),
            None,
            Some(most),
        );
        Ok(Self {
            window,
            surface,
            configuration,
            input,
            viewer,
            errors,
        })
    }

    fn resize(&mut self, [width, height]: [u32; 2]) {
        if width == 0 || height == 0 {
            return;
        }
        let most = self.viewer.gpu().device.limits().max_texture_dimension_2d;
        self.configuration.width = width.min(most);
        self.configuration.height = height.min(most);
        self.surface
            .configure(&self.viewer.gpu().device, &self.configuration);
        self.window.request_redraw();
    }

    /// Draws a frame, and returns the time until the next one.
    fn redraw(&mut self) -> Duration {
        use wgpu::CurrentSurfaceTexture as Current;
        let texture = match self.surface.get_current_texture() {
            Current::Success(texture) | Current::Suboptimal(texture) => texture,
            Current::Outdated | Current::Lost => {
                self.surface
                    .configure(&self.viewer.gpu().device, &self.configuration);
                return Duration::ZERO;
            }
            _ => return Duration::from_millis(100),
        };
        for message in self.errors.take() {
            self.viewer.state.tell(message);
        }
        let input = self.input.take_egui_input(&self.window);
        let view = texture.texture.create_view(&Default::default());
        let size = [texture.texture.width(), texture.texture.height()];
        let result = self.viewer.frame(input, &view, size);
        for command in &result.output.commands {
            if let egui::OutputCommand::CopyText(text) = command {
                host::copy(text);
            }
        }
        self.input
            .handle_platform_output(&self.window, result.output);
        self.window.pre_present_notify();
        self.viewer.gpu().queue.present(texture);
        result.repaint_after
    }
}

/// Returns limits that every engine can have, but for the size of textures.
fn limits(adapter: &wgpu::Adapter) -> wgpu::Limits {
    let own = adapter.limits();
    wgpu::Limits::default()
        .or_worse_values_from(&own)
        .using_resolution(own)
}
