//! Shows the truth by rays: its progress, and the errors of both sides.

use egui::{Grid, ProgressBar, Ui};
use shadow_support::measure::error::Errors;

use super::heading;
use crate::engine::Engine;
use crate::settings::Show;
use crate::state::{Request, State};

pub fn show(ui: &mut Ui, state: &mut State, engine: &Engine) {
    heading(ui, "Truth");
    let progress = engine.truth_progress();
    ui.horizontal(|ui| match progress {
        Some(share) if share < 1.0 => {
            if ui.button("Stop").clicked() {
                state.requests.push(Request::StopTruth);
            }
            ui.add(ProgressBar::new(share).show_percentage());
        }
        _ => {
            let told = "Casts rays on the CPU for what the camera sees of the sun's shadows.";
            if ui.button("Cast rays").on_hover_text(told).clicked() {
                state.requests.push(Request::Truth);
            }
            if progress.is_some() {
                let is_shown = state.settings.show == Show::Difference;
                let mut wanted = is_shown;
                ui.checkbox(&mut wanted, "difference");
                if wanted != is_shown {
                    state.settings.show = if wanted {
                        Show::Difference
                    } else {
                        Show::Scene
                    };
                }
            }
        }
    });
    let errors = [0, 1].map(|side| engine.errors(side));
    if errors.iter().all(Option::is_none) {
        ui.small("Rays tell the error that each setting leaves, while the view stays as it is.");
        return;
    }
    Grid::new("errors")
        .num_columns(3)
        .min_col_width(56.0)
        .show(ui, |ui| {
            ui.label("");
            ui.strong("left");
            ui.strong("right");
            ui.end_row();
            let mut row = |name: &str, told: &str, value: fn(&Errors) -> String| {
                ui.label(name).on_hover_text(told);
                for errors in &errors {
                    ui.label(
                        errors
                            .as_ref()
                            .map_or("-".to_owned(), |errors| value(errors)),
                    );
                }
                ui.end_row();
            };
            row(
                "rmse",
                "Root of the mean squared error of visibility",
                |errors| format!("{:.4}", errors.rmse),
            );
            row("wrong", "Pixels on the wrong side of one half", |errors| {
                percent(errors.misclassified_percent)
            });
            row(
                "acne",
                "Shadow on lit surfaces, away from edges",
                |errors| percent(errors.false_shadow_percent),
            );
            row(
                "peter-panning",
                "Light in contact shadows, away from edges",
                |errors| percent(errors.contact_light_percent),
            );
            row(
                "leaks",
                "Light in other shadows, away from edges",
                |errors| percent(errors.deep_light_percent),
            );
            row(
                "edges, texels",
                "Area on the wrong side per length of edge",
                |errors| format!("{:.2}", errors.edge_aliasing_texels),
            );
            row(
                "shift, texels",
                "Displacement of edges; above 0 where shadows shrank",
                |errors| format!("{:+.2}", errors.edge_shift_texels),
            );
            row(
                "penumbra, rmse",
                "The error where the truth is neither 0 nor 1",
                |errors| {
                    if errors.penumbra_rmse.is_nan() {
                        "none".to_owned()
                    } else {
                        format!("{:.4}", errors.penumbra_rmse)
                    }
                },
            );
        });
    ui.small("In the difference, red is too dark and blue is too bright.");
}

fn percent(percent: f64) -> String {
    format!("{percent:.3} %")
}
