//! Shows the settings of the whole picture, and those of one side.

use egui::{ComboBox, Slider, Ui};

use super::{heading, side};
use crate::address;
use crate::engine::Engine;
use crate::scene;
use crate::settings::Show;
use crate::state::{Request, State};

pub fn show(ui: &mut Ui, state: &mut State, engine: &Engine) {
    scene_choice(ui, state, engine);
    light(ui, state);
    picture(ui, state, engine);
    heading(ui, "Shadows");
    ui.horizontal(|ui| {
        ui.selectable_value(&mut state.edited_side, 0, "Left side");
        ui.selectable_value(&mut state.edited_side, 1, "Right side");
        if ui
            .button("Exchange")
            .on_hover_text("Exchanges left and right.")
            .clicked()
        {
            state.settings.sides.swap(0, 1);
        }
    });
    side::show(ui, state, engine.scene());
}

fn scene_choice(ui: &mut Ui, state: &mut State, engine: &Engine) {
    heading(ui, "Scene");
    ui.horizontal(|ui| {
        ComboBox::from_id_salt("scene")
            .selected_text(&engine.scene().name)
            .show_ui(ui, |ui| {
                for name in scene::NAMES {
                    let is_shown = engine.scene().name == name;
                    if ui.selectable_label(is_shown, name).clicked() {
                        state.requests.push(Request::Scene(name.to_owned()));
                    }
                }
            });
        if engine.scene().moves() {
            ui.checkbox(&mut state.is_moving, "moves");
        }
        if ui.button("Keys").clicked() {
            state.is_help_open = !state.is_help_open;
        }
    });
    let told = "Copies all settings, as the page has them in its address and --address takes them.";
    if ui
        .small_button("Copy settings")
        .on_hover_text(told)
        .clicked()
    {
        ui.ctx().copy_text(address::write(&state.settings));
    }
    ui.small("Drop a .glb file on the window to see it.");
    for note in &engine.scene().notes {
        ui.small(note);
    }
}

fn light(ui: &mut Ui, state: &mut State) {
    heading(ui, "Light");
    ui.horizontal(|ui| {
        let hour = Slider::new(&mut state.hour, 6.0..=18.0)
            .text("o'clock")
            .fixed_decimals(1);
        if ui
            .add(hour)
            .on_hover_text("Time of a day in spring at 40 degrees north")
            .changed()
        {
            state.settings.set_hour(state.hour);
        }
        ui.checkbox(&mut state.day_passes, "day");
    });
    let settings = &mut state.settings;
    ui.add(Slider::new(&mut settings.elevation_degrees, -5.0..=90.0).text("° high"));
    ui.add(Slider::new(&mut settings.azimuth_degrees, 0.0..=360.0).text("° around"));
    let size = Slider::new(&mut settings.sun_degrees, 0.0..=20.0)
        .text("° wide")
        .logarithmic(true)
        .smallest_positive(0.05);
    ui.add(size).on_hover_text(
        "The angular diameter of the light: 0.53° is the sun's. The truth has its penumbrae, and \
         so have the filters Pcss and PcssRotated.",
    );
}

fn picture(ui: &mut Ui, state: &mut State, engine: &Engine) {
    heading(ui, "Picture");
    let has_lamps = engine.scene().has_lamps;
    let settings = &mut state.settings;
    ComboBox::from_label("shown")
        .selected_text(name(settings.show))
        .show_ui(ui, |ui| {
            let mut choices = vec![
                Show::Scene,
                Show::Visibility,
                Show::Cascades,
                Show::SunMap(0),
                Show::Truth,
                Show::Difference,
            ];
            if has_lamps {
                choices.extend([Show::SpotMap(0), Show::LampCross(0)]);
            }
            for choice in choices {
                ui.selectable_value(&mut settings.show, choice, name(choice));
            }
        });
    let most = match settings.show {
        Show::SunMap(_) => engine.layers(0),
        Show::SpotMap(_) => engine.layers(1),
        Show::LampCross(_) => engine.layers(2) / 6,
        _ => 0,
    };
    if let Show::SunMap(number) | Show::SpotMap(number) | Show::LampCross(number) =
        &mut settings.show
    {
        let last = most.saturating_sub(1);
        *number = (*number).min(last);
        ui.add(Slider::new(number, 0..=last).text("number"));
    }
    ui.checkbox(
        &mut settings.is_split,
        "left and right side, with a divider to drag",
    );
    ui.add(
        Slider::new(&mut settings.picture_scale, 0.25..=2.0)
            .text("pixels per pixel")
            .step_by(0.25),
    );
}

fn name(show: Show) -> &'static str {
    match show {
        Show::Scene => "Scene",
        Show::Visibility => "Visibility of the sun",
        Show::Cascades => "Cascades, tinted",
        Show::SunMap(_) => "Map of a cascade",
        Show::SpotMap(_) => "Map of a spot",
        Show::LampCross(_) => "Cube of a lamp",
        Show::Truth => "Truth by rays",
        Show::Difference => "Difference from the truth",
    }
}
