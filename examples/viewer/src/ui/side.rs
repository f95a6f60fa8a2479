//! Shows the settings of one side's shadows.

use egui::{ComboBox, DragValue, Slider, Ui};
use wgpu_shadows::{Bias, CascadeSplit, DepthFormat, Filter, Stability};

use crate::scene::Scene;
use crate::settings::{Covers, SideSettings};
use crate::state::State;

pub fn show(ui: &mut Ui, state: &mut State, scene: &Scene) {
    let side = &mut state.settings.sides[state.edited_side];
    presets(ui, side, scene);
    ui.horizontal(|ui| {
        ui.label("maps cover");
        ui.selectable_value(&mut side.covers, Covers::Camera, "the view");
        ui.selectable_value(&mut side.covers, Covers::Scene, "the scene");
    });
    filter(ui, "filter", &mut side.filter, false);
    bias(ui, &mut side.bias);
    map_size(ui, "texels a side", &mut side.map_size, 8192);
    ui.add(Slider::new(&mut side.cascades, 1..=8).text("cascades"));
    if side.cascades > 1 {
        ui.horizontal(|ui| {
            ui.label("layout");
            ui.selectable_value(&mut side.divides_map, false, "fixed")
                .on_hover_text("A map for each cascade.");
            ui.selectable_value(&mut side.divides_map, true, "found")
                .on_hover_text("One map, divided among the cascades by predicted error.");
        });
        if !side.divides_map {
            split(ui, &mut side.split);
        }
        ui.add(Slider::new(&mut side.blend, 0.0..=0.5).text("blend"));
    }
    ui.horizontal(|ui| {
        let speed = side.max_distance.max(1.0) * 0.02;
        let end = DragValue::new(&mut side.max_distance)
            .range(0.0..=1e6)
            .speed(speed);
        ui.add(end).on_hover_text(
            "The distance from the camera at which shadows end, in world units; 0 for no end.",
        );
        ui.label("farthest shadows");
    });
    if side.max_distance > 0.0 {
        ui.add(Slider::new(&mut side.fade, 0.0..=1.0).text("fade"));
    }
    ui.horizontal(|ui| {
        ui.selectable_value(&mut side.stability, Stability::TightFit, "tight fit");
        let sphere = "bounding sphere";
        ui.selectable_value(&mut side.stability, Stability::BoundingSphere, sphere)
            .on_hover_text("Needs an end of the shadows: set the farthest distance.");
    });
    ui.horizontal(|ui| {
        ui.selectable_value(&mut side.depth_format, DepthFormat::Float32, "32 bits");
        ui.selectable_value(&mut side.depth_format, DepthFormat::Unorm16, "16 bits");
        ui.label("a texel");
    });
    if scene.has_lamps {
        ui.separator();
        filter(ui, "filter of lamps", &mut side.lamp_filter, true);
        map_size(ui, "texels of all lamps", &mut side.lamp_map_size, 4096);
    }
}

fn presets(ui: &mut Ui, side: &mut SideSettings, scene: &Scene) {
    let [textbook, library] = scene.sides;
    ui.horizontal_wrapped(|ui| {
        let mut preset = |name: &str, told: &str, settings: SideSettings| {
            if ui.small_button(name).on_hover_text(told).clicked() {
                *side = settings;
            }
        };
        preset(
            "Textbook",
            "One map of the scene, slope bias, 3×3 box",
            textbook,
        );
        let cheap = SideSettings {
            map_size: 1024,
            filter: Filter::Hardware,
            ..library
        };
        preset("Cheap", "Hardware 2×2, 1024 texels a side", cheap);
        let default = SideSettings {
            filter: Filter::default(),
            ..library
        };
        preset("Default", "The library's default, derived bias", default);
        let accurate = SideSettings {
            map_size: 4096,
            filter: Filter::Tent5 { sharpness: 4.0 },
            ..library
        };
        preset(
            "Accurate",
            "Tent over 6×6 texels, 4096 texels a side",
            accurate,
        );
        let soft = SideSettings {
            filter: Filter::Pcss { light_size: 1.0 },
            ..library
        };
        preset("Soft", "Penumbrae by the size of the light", soft);
    });
}

fn filter(ui: &mut Ui, label: &str, filter: &mut Filter, is_cube: bool) {
    let sharpness = if filter.sharpness() > 1.0 {
        filter.sharpness()
    } else {
        3.0
    };
    let mut choices = vec![
        Filter::Nearest,
        Filter::Hardware,
        Filter::Box,
        Filter::Bilinear { sharpness },
        Filter::Tent3 { sharpness },
        Filter::Tent5 { sharpness },
        Filter::Tent7 { sharpness },
        Filter::Pcss { light_size: 1.0 },
        Filter::PcssRotated { light_size: 1.0 },
    ];
    if is_cube {
        choices.push(Filter::DirectionGrid { radius: 0.1 });
        choices.push(Filter::DirectionStar { radius: 0.04 });
    }
    ComboBox::from_label(label)
        .selected_text(filter_name(*filter))
        .show_ui(ui, |ui| {
            for choice in choices {
                let is_chosen = filter_name(*filter) == filter_name(choice);
                if ui
                    .selectable_label(is_chosen, filter_name(choice))
                    .clicked()
                {
                    *filter = choice;
                }
            }
        });
    match filter {
        Filter::Bilinear { sharpness }
        | Filter::Tent3 { sharpness }
        | Filter::Tent5 { sharpness }
        | Filter::Tent7 { sharpness } => {
            ui.add(
                Slider::new(sharpness, 1.0..=12.0)
                    .text("sharpness")
                    .step_by(0.25),
            );
        }
        Filter::DirectionGrid { radius } | Filter::DirectionStar { radius } => {
            ui.add(
                Slider::new(radius, 0.005..=0.5)
                    .text("radius")
                    .logarithmic(true),
            );
        }
        _ => {}
    }
}

/// Returns the name of a filter's kind.
pub fn filter_name(filter: Filter) -> String {
    let text = format!("{filter:?}");
    text.split([' ', '{']).next().unwrap_or_default().to_owned()
}

fn bias(ui: &mut Ui, bias: &mut Bias) {
    let manual = match *bias {
        Bias::Manual { .. } => *bias,
        _ => Bias::Manual {
            constant: 0.03,
            slope: 0.3,
        },
    };
    ui.horizontal(|ui| {
        ui.label("bias");
        ui.selectable_value(bias, Bias::Auto, "derived");
        ui.selectable_value(bias, Bias::NormalOffset, "normal offset");
        ui.selectable_value(bias, manual, "manual");
    });
    if let Bias::Manual { constant, slope } = bias {
        for (value, name) in [(constant, "constant"), (slope, "slope")] {
            let slider = Slider::new(value, 0.0..=100.0)
                .text(name)
                .logarithmic(true)
                .smallest_positive(1e-4);
            ui.add(slider);
        }
    }
}

fn split(ui: &mut Ui, split: &mut CascadeSplit<'static>) {
    let practical = match *split {
        CascadeSplit::Practical { .. } => *split,
        _ => CascadeSplit::Practical { lambda: 0.5 },
    };
    ui.horizontal(|ui| {
        ui.label("split");
        ui.selectable_value(split, CascadeSplit::Logarithmic, "logarithmic");
        ui.selectable_value(split, CascadeSplit::Uniform, "uniform");
        ui.selectable_value(split, practical, "between");
    });
    if let CascadeSplit::Practical { lambda } = split {
        ui.add(Slider::new(lambda, 0.0..=1.0).text("lambda"));
    }
}

fn map_size(ui: &mut Ui, label: &str, size: &mut u32, most: u32) {
    ComboBox::from_label(label)
        .selected_text(size.to_string())
        .show_ui(ui, |ui| {
            let sizes = (6..14)
                .map(|power| 1_u32 << power)
                .filter(|size| *size <= most);
            for choice in sizes {
                ui.selectable_value(size, choice, choice.to_string());
            }
        });
}
