//! Starts the page: the canvas, the address, dropped files, and words where WebGPU is missing.

use std::fmt::Display;
use std::process::ExitCode;
use std::sync::Arc;

use wasm_bindgen::prelude::*;
use wasm_bindgen_futures::{JsFuture, spawn_local};
use web_sys::{DragEvent, HtmlCanvasElement};
use winit::event_loop::{EventLoop, EventLoopProxy};
use winit::platform::web::{EventLoopExtWebSys, WindowAttributesExtWebSys};
use winit::window::Window;

use crate::address;
use crate::settings::Settings;
use crate::state::Request;
use crate::window::{self as viewer_window, App, Arrival};

/// Runs the page.
pub fn main() -> ExitCode {
    std::panic::set_hook(Box::new(|panic| {
        let text = panic.to_string();
        log(&text);
        tell_failure(&text);
    }));
    let address = window().location().hash().unwrap_or_default();
    let canvas = document()
        .get_element_by_id("viewer")
        .and_then(|element| element.dyn_into::<HtmlCanvasElement>().ok());
    let attributes = Window::default_attributes().with_canvas(canvas);
    if let Err(error) = viewer_window::run(address, None, attributes) {
        tell_failure(&error);
    }
    ExitCode::SUCCESS
}

/// Starts the loop, which goes on for as long as the page is there.
pub fn run_app(event_loop: EventLoop<Arrival>, app: App) -> Result<(), String> {
    event_loop.spawn_app(app);
    Ok(())
}

/// Runs what makes the device beside the page.
pub fn spawn(work: impl Future<Output = ()> + 'static) {
    spawn_local(work);
}

/// Listens to files that are dropped on the page.
pub fn before_run(proxy: &EventLoopProxy<Arrival>) {
    let over = Closure::<dyn FnMut(DragEvent)>::new(|event: DragEvent| event.prevent_default());
    let proxy = proxy.clone();
    let drop = Closure::<dyn FnMut(DragEvent)>::new(move |event: DragEvent| {
        event.prevent_default();
        let files = event.data_transfer().and_then(|data| data.files());
        let Some(file) = files.and_then(|files| files.get(0)) else {
            return;
        };
        let proxy = proxy.clone();
        spawn_local(async move {
            let name = file.name();
            if let Ok(buffer) = JsFuture::from(file.array_buffer()).await {
                let bytes = js_sys::Uint8Array::new(&buffer).to_vec();
                let request = Request::File { name, bytes };
                // The page is closing where nobody receives this.
                let _ = proxy.send_event(Arrival::Request(request));
            }
        });
    });
    for (name, listener) in [("dragover", over), ("drop", drop)] {
        let function = listener.into_js_value();
        // A page that cannot listen takes no files.
        let _ = document().add_event_listener_with_callback(name, function.unchecked_ref());
    }
}

/// Writes a message for whoever develops the page.
pub fn log(message: &str) {
    web_sys::console::error_1(&message.into());
}

/// Is words in place of the canvas.
pub struct Notice;

impl Notice {
    /// Shows the words.
    pub fn new(_: Arc<Window>, text: &str) -> Option<Self> {
        tell_failure(text);
        Some(Self)
    }

    /// Does nothing: the page draws its own words.
    pub fn draw(&mut self) {}
}

/// Tells a failure in place of the canvas.
fn tell_failure(error: &str) {
    if let Some(element) = document().get_element_by_id("failure") {
        element.set_text_content(Some(error));
        // The element is hidden until it has something to tell.
        let _ = element.remove_attribute("hidden");
    }
}

/// Copies a text to the browser's clipboard, which egui leaves to its host.
pub fn copy(text: &str) {
    let copied = window().navigator().clipboard().write_text(text);
    spawn_local(async move {
        if JsFuture::from(copied).await.is_err() {
            log("The browser does not let the page copy.");
        }
    });
}

/// Keeps the settings in the address, without a new entry in the history.
pub fn keep_address(settings: &Settings) {
    let hash = format!("#{}", address::write(settings));
    if window().location().hash().is_ok_and(|own| own == hash) {
        return;
    }
    if let Ok(history) = window().history() {
        // A browser may refuse it where it comes too often; the next frame tries again.
        let _ = history.replace_state_with_url(&JsValue::NULL, "", Some(&hash));
    }
}

/// Returns what to do where no adapter is found.
pub fn no_adapter(error: &dyn Display) -> String {
    log(&error.to_string());
    "This browser offers WebGPU, but no adapter to draw with. Chrome and Edge from 113 on have one \
     where they trust the driver of the GPU, as do Safari from 26 on and Firefox from 141 on \
     Windows; under Linux, Chromium may need --enable-unsafe-webgpu --enable-features=Vulkan."
        .to_owned()
}

fn window() -> web_sys::Window {
    web_sys::window().expect("a page has a window")
}

fn document() -> web_sys::Document {
    window().document().expect("a page has a document")
}
