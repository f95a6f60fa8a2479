//! Shows what the shadows cost, what the library reports, and the descriptor as Rust.

use egui::{Grid, RichText, Ui};
use wgpu_shadows::report::{ShadowReport, SliceReport, ViewStatus};

use super::{heading, truth};
use crate::engine::{Cost, Engine};
use crate::state::State;

pub fn show(ui: &mut Ui, state: &mut State, engine: &mut Engine) {
    cost(ui, engine);
    truth::show(ui, state, engine);
    report(ui, state, engine);
    rust(ui, state, engine);
}

fn cost(ui: &mut Ui, engine: &Engine) {
    heading(ui, "Cost of a frame");
    let costs = [0, 1].map(|side| engine.cost(side));
    Grid::new("cost")
        .num_columns(3)
        .min_col_width(56.0)
        .show(ui, |ui| {
            ui.label("");
            ui.strong("left");
            ui.strong("right");
            ui.end_row();
            let mut row = |name: &str, told: &str, value: fn(&Cost) -> String| {
                ui.label(name).on_hover_text(told);
                for cost in &costs {
                    ui.label(cost.as_ref().map_or("-".to_owned(), value));
                }
                ui.end_row();
            };
            row("passes", "Depth passes of the last frame", |cost| {
                cost.passes.to_string()
            });
            row(
                "draws",
                "Draw calls in those passes: one for all copies of a mesh in a map",
                |cost| cost.draws.to_string(),
            );
            row("triangles", "Triangles drawn in those passes", |cost| {
                count(cost.triangles)
            });
            row(
                "texels drawn",
                "Texels of the maps that were drawn",
                |cost| count(cost.texels),
            );
            row("memory", "Of maps and caches", |cost| {
                format!("{:.1} MB", cost.bytes as f64 / 1e6)
            });
            row(
                "record, CPU",
                "Checks, fit, cull, and the recording of the passes",
                |cost| format!("{:.2} ms", cost.record_ms),
            );
            row(
                "maps, device",
                "By timestamps, of the last frame that had any",
                |cost| match cost.device_ms {
                    Some(ms) => format!("{ms:.2} ms"),
                    None => "unknown".to_owned(),
                },
            );
        });
    ui.small("What does not change is kept: draws are zero where nothing moves.");
}

/// Returns a number in thousands or millions where it is large.
fn count(number: u64) -> String {
    match number {
        0..10_000 => number.to_string(),
        10_000..10_000_000 => format!("{:.0} k", number as f64 / 1e3),
        _ => format!("{:.1} M", number as f64 / 1e6),
    }
}

fn report(ui: &mut Ui, state: &State, engine: &Engine) {
    egui::CollapsingHeader::new(RichText::new("Report").strong().size(14.0))
        .default_open(true)
        .show(ui, |ui| {
            for (name, report) in engine.reports(state.edited_side) {
                if report.views.len() > 8 {
                    summary(ui, name, report);
                } else {
                    views(ui, name, report, engine.picture_size()[1]);
                }
                for broken in &report.broken_bounds {
                    ui.label(format!("left out: {broken:?}"));
                }
            }
        });
}

fn views(ui: &mut Ui, name: &str, report: &ShadowReport, height: u32) {
    Grid::new(name).num_columns(5).striped(true).show(ui, |ui| {
        for title in [name, "casters", "culled", "texel", "gap"] {
            ui.small(title);
        }
        ui.end_row();
        for (index, view) in report.views.iter().enumerate() {
            let status = format!("{index} {:?}", view.status).to_lowercase();
            ui.small(status);
            ui.small(view.casters.to_string());
            ui.small(view.culled.to_string());
            ui.small(length(view.texel_size_world.max_element()))
                .on_hover_text("World size of a texel");
            ui.small(length(view.max_peter_panning_world))
                .on_hover_text("Largest gap that the bias can leave under a caster");
            ui.end_row();
        }
    });
    for (index, view) in report.views.iter().enumerate() {
        let Some(slice) = &view.slice else { continue };
        ui.small(format!("{index}: {}", slice_text(slice, height)));
    }
    if let Some(error) = report.predicted_error {
        ui.small(format!("predicted error of the layout: {error:.4}"));
    }
}

fn slice_text(slice: &SliceReport, height: u32) -> String {
    let texels = slice.texels_per_pixel(height);
    format!(
        "{} to {} away; {:.0} % of the map; {:.1} to {:.1} texels a pixel",
        length(slice.depth_near),
        length(slice.depth_far),
        100.0 * slice.map_utilization,
        texels.x,
        texels.y
    )
}

fn summary(ui: &mut Ui, name: &str, report: &ShadowReport) {
    let of = |status| {
        report
            .views
            .iter()
            .filter(|view| view.status == status)
            .count()
    };
    ui.small(format!(
        "{name}: {} views; {} drawn, {} kept, {} deferred, {} empty",
        report.views.len(),
        of(ViewStatus::Drawn),
        of(ViewStatus::Kept),
        of(ViewStatus::Deferred),
        of(ViewStatus::Empty),
    ));
}

/// Returns a length in world units, which count as metres.
fn length(metres: f32) -> String {
    if metres >= 1.0 {
        format!("{metres:.2}")
    } else {
        format!("{metres:.4}")
    }
}

fn rust(ui: &mut Ui, state: &State, engine: &Engine) {
    heading(ui, "Rust");
    let text = engine.rust(&state.settings, state.edited_side);
    if ui.button("Copy as Rust").clicked() {
        ui.ctx().copy_text(text.clone());
    }
    let mut shown = text.as_str();
    ui.add(
        egui::TextEdit::multiline(&mut shown)
            .code_editor()
            .desired_width(f32::INFINITY)
            .desired_rows(4),
    );
}
