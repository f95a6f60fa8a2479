//! Handles the keyboard, and tells about it.

use egui::Key;
use glam::Vec3;

use crate::engine::Engine;
use crate::scene;
use crate::settings::Show;
use crate::state::{Request, State};

/// Lists what the help tells.
const HELP: [(&str, &str); 13] = [
    ("drag", "turns around the scene"),
    ("right drag", "looks around"),
    ("middle drag, Shift drag", "moves across the view"),
    ("wheel", "goes nearer or farther"),
    ("W A S D, Q E", "fly; with Shift faster"),
    ("Home", "returns to where the scene begins"),
    ("1 to 6", "show the built-in scenes"),
    ("Space", "lets everything move, or stop"),
    ("V", "shows scene, visibility, cascades, map in turn"),
    ("X", "shows both sides or one"),
    ("T", "casts rays for the truth"),
    ("C", "copies the shown descriptor as Rust"),
    ("P", "saves a picture of the window"),
];

/// Handles the keys that are pressed, unless a text or a number takes them.
pub fn handle(context: &egui::Context, state: &mut State, engine: &Engine) {
    if context.egui_wants_keyboard_input() {
        return;
    }
    context.input(|input| fly(input, state));
    let pressed = |key| context.input(|input| input.key_pressed(key) && !input.modifiers.command);
    if pressed(Key::F1) || pressed(Key::H) {
        state.is_help_open = !state.is_help_open;
    }
    if pressed(Key::Escape) {
        state.is_help_open = false;
    }
    if pressed(Key::Home) {
        state.settings.viewpoint = engine.scene().viewpoint;
    }
    let digits = [
        Key::Num1,
        Key::Num2,
        Key::Num3,
        Key::Num4,
        Key::Num5,
        Key::Num6,
    ];
    if let Some(number) = digits.into_iter().position(&pressed) {
        state.request_scene(number);
    }
    if pressed(Key::Space) {
        let moves = state.is_moving || state.day_passes;
        state.is_moving = !moves && engine.scene().moves();
        state.day_passes = !moves && !engine.scene().moves();
    }
    if pressed(Key::V) {
        state.settings.show = match state.settings.show {
            Show::Scene => Show::Visibility,
            Show::Visibility => Show::Cascades,
            Show::Cascades => Show::SunMap(0),
            _ => Show::Scene,
        };
    }
    if pressed(Key::X) {
        state.settings.is_split = !state.settings.is_split;
    }
    if pressed(Key::T) {
        state.requests.push(Request::Truth);
    }
    if pressed(Key::C) {
        context.copy_text(engine.rust(&state.settings, state.edited_side));
    }
    if pressed(Key::P) {
        state.requests.push(Request::Screenshot);
    }
}

fn fly(input: &egui::InputState, state: &mut State) {
    if input.modifiers.command {
        return;
    }
    let axis = |ahead, back| f32::from(input.key_down(ahead)) - f32::from(input.key_down(back));
    let way = Vec3::new(
        axis(Key::D, Key::A),
        axis(Key::E, Key::Q),
        axis(Key::W, Key::S),
    );
    if way != Vec3::ZERO {
        let speed = if input.modifiers.shift { 2.0 } else { 0.4 };
        state
            .settings
            .viewpoint
            .fly(way.normalize() * speed * input.stable_dt.min(0.1));
    }
}

/// Returns whether a key is held that moves the camera.
pub fn is_flying(context: &egui::Context) -> bool {
    let keys = [Key::W, Key::A, Key::S, Key::D, Key::Q, Key::E];
    !context.egui_wants_keyboard_input()
        && context.input(|input| {
            !input.modifiers.command && keys.into_iter().any(|key| input.key_down(key))
        })
}

/// Shows the help, if it is open.
pub fn help(context: &egui::Context, state: &mut State) {
    egui::Window::new("Keys and mouse")
        .open(&mut state.is_help_open)
        .collapsible(false)
        .resizable(false)
        .anchor(egui::Align2::CENTER_CENTER, egui::Vec2::ZERO)
        .show(context, |ui| {
            egui::Grid::new("keys").num_columns(2).show(ui, |ui| {
                for (keys, what) in HELP {
                    ui.strong(keys);
                    ui.label(what);
                    ui.end_row();
                }
                ui.strong("drop a file");
                ui.label("shows a glTF file");
                ui.end_row();
            });
            ui.separator();
            ui.label(format!("Built-in scenes: {}.", scene::NAMES.join(", ")));
            ui.label("F1 or H shows this again.");
        });
}
