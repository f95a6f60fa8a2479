//! Shows the shadows of wgpu-shadows in a window, and in a page of a browser.
//!
//! `cargo run --release -p viewer -- [FILE.glb]` opens the window; `.ci/viewer-page` builds and
//! serves the page.
//!
//! ```text
//! host/            the command line; the page
//! window.rs        the window or canvas, and its events; offscreen.rs: a picture without one
//! viewer.rs        a frame: panels, shadows, picture
//! state.rs         what panels change; settings.rs: what an address keeps
//! address.rs       settings as text; descriptor.rs: as the library's descriptors and as Rust
//! viewpoint.rs     the camera
//! scene/           the scenes, as triangles
//! engine.rs        the scene on the device, and both sides of the picture
//! stage.rs, side.rs, leaves.rs, lamps.rs, picture.rs
//! trial.rs         both sides against the truth; truth.rs: rays
//! readback.rs, device_clock.rs, device_errors.rs
//! ui/              the panels
//! ```

mod address;
mod descriptor;
mod device_clock;
mod device_errors;
mod engine;
mod host;
mod lamps;
mod leaves;
#[cfg(not(target_arch = "wasm32"))]
mod offscreen;
mod picture;
mod readback;
mod scene;
mod settings;
mod side;
mod stage;
mod state;
mod trial;
mod truth;
mod ui;
mod viewer;
mod viewpoint;
mod window;

use std::process::ExitCode;

fn main() -> ExitCode {
    host::main()
}
