//! Shows the panels, and the picture between them.
//!
//! ```text
//! settings.rs  the panel on the left: scene, light, picture
//! side.rs      the settings of one side's shadows
//! results.rs   the panel on the right: cost, report, Rust; truth.rs: the rays
//! view.rs      the picture, its divider, and the camera
//! keys.rs      the keyboard, and its help
//! ```

mod keys;
mod results;
mod settings;
mod side;
mod truth;
mod view;

pub use side::filter_name;
pub use view::left_share;

use crate::engine::Engine;
use crate::state::State;

/// Is the width of both panels in points.
const PANEL_WIDTH: f32 = 292.0;

/// Shows everything.
pub fn show(ui: &mut egui::Ui, state: &mut State, engine: &mut Engine) {
    keys::handle(ui.ctx(), state, engine);
    egui::Panel::left("settings")
        .resizable(false)
        .exact_size(PANEL_WIDTH)
        .show(ui, |ui| {
            scroll(ui, "settings", |ui| settings::show(ui, state, engine))
        });
    egui::Panel::right("results")
        .resizable(false)
        .exact_size(PANEL_WIDTH)
        .show(ui, |ui| {
            scroll(ui, "results", |ui| results::show(ui, state, engine))
        });
    if !state.messages.is_empty() {
        egui::Panel::top("messages").show(ui, |ui| messages(ui, state));
    }
    egui::CentralPanel::no_frame().show(ui, |ui| view::show(ui, state, engine));
    keys::help(ui.ctx(), state);
}

fn scroll(ui: &mut egui::Ui, name: &str, contents: impl FnOnce(&mut egui::Ui)) {
    egui::ScrollArea::vertical()
        .id_salt(name)
        .auto_shrink(false)
        .show(ui, contents);
}

/// Shows what went wrong, until it is closed.
fn messages(ui: &mut egui::Ui, state: &mut State) {
    let mut closed = None;
    for (index, message) in state.messages.iter().enumerate() {
        ui.horizontal_wrapped(|ui| {
            if ui.small_button("Close").clicked() {
                closed = Some(index);
            }
            ui.colored_label(ui.visuals().warn_fg_color, message);
        });
    }
    if let Some(index) = closed {
        state.messages.remove(index);
    }
}

/// Shows a heading above a part of a panel.
fn heading(ui: &mut egui::Ui, text: &str) {
    ui.add_space(6.0);
    ui.label(egui::RichText::new(text).strong().size(14.0));
    ui.separator();
}
