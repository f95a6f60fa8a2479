//! Shows the picture and its divider, and moves the camera.

use egui::{Color32, PointerButton, Rect, Sense, Stroke, Ui, pos2, vec2};
use glam::Vec2;

use super::keys::is_flying;
use crate::engine::Engine;
use crate::settings::Show;
use crate::state::State;

/// Is half the width, in points, in which the divider can be taken.
const GRIP: f32 = 8.0;

pub fn show(ui: &mut Ui, state: &mut State, engine: &mut Engine) {
    let rect = ui.available_rect_before_wrap();
    let response = ui.allocate_rect(rect, Sense::click_and_drag());
    let is_dragged = move_divider(ui, rect, state);
    let is_turned = !is_dragged && move_camera(ui, &response, rect, state);
    let wheel = ui.input(|input| input.smooth_scroll_delta().y);
    let is_zoomed = response.hovered() && wheel != 0.0;
    if is_zoomed {
        state.settings.viewpoint.zoom((-wheel * 0.004).exp());
    }
    if response.clicked() {
        // Keys belong to the camera again.
        ui.memory_mut(|memory| {
            if let Some(id) = memory.focused() {
                memory.surrender_focus(id);
            }
        });
    }
    state.is_in_motion = is_turned
        || is_zoomed
        || is_flying(ui.ctx())
        || state.day_passes
        || (state.is_moving && engine.scene().moves());

    let pixels = rect.size() * ui.pixels_per_point() * state.picture_scale();
    let limit = engine.largest_picture();
    let side = |length: f32| (length.round() as u32).clamp(16, limit);
    match engine.picture([side(pixels.x), side(pixels.y)]) {
        Ok(picture) => {
            let all = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            ui.painter().image(picture, rect, all, Color32::WHITE);
        }
        Err(error) => state.tell(error),
    }
    overlays(ui, rect, state, engine);
    divider(ui, rect, state, engine);
    hints(ui, rect, engine);
}

/// Shows the truth, or the difference from it, over the picture.
fn overlays(ui: &Ui, rect: Rect, state: &State, engine: &mut Engine) {
    let show = state.settings.show;
    if !matches!(show, Show::Truth | Show::Difference) {
        return;
    }
    let share = left_share(state);
    for (side, [start, end]) in [[0.0, share], [share, 1.0]].into_iter().enumerate() {
        if let Some(texture) = engine.truth_texture(ui.ctx(), show, side) {
            let part = Rect::from_min_max(
                pos2(rect.left() + start * rect.width(), rect.top()),
                pos2(rect.left() + end * rect.width(), rect.bottom()),
            );
            let uv = Rect::from_min_max(pos2(start, 0.0), pos2(end, 1.0));
            ui.painter().image(texture, part, uv, Color32::WHITE);
        }
    }
}

/// Returns the share of the picture that the left side has.
pub fn left_share(state: &State) -> f32 {
    if state.settings.is_split {
        state.settings.divider
    } else if state.edited_side == 0 {
        1.0
    } else {
        0.0
    }
}

fn move_divider(ui: &Ui, rect: Rect, state: &mut State) -> bool {
    if !state.settings.is_split {
        return false;
    }
    let x = rect.left() + state.settings.divider * rect.width();
    let grip = Rect::from_min_max(pos2(x - GRIP, rect.top()), pos2(x + GRIP, rect.bottom()));
    let id = ui.scope_id().with("divider");
    let response = ui
        .interact(grip, id, Sense::drag())
        .on_hover_and_drag_cursor(egui::CursorIcon::ResizeHorizontal);
    if let (true, Some(place)) = (response.dragged(), response.interact_pointer_pos()) {
        let share = (place.x - rect.left()) / rect.width();
        state.settings.divider = share.clamp(0.02, 0.98);
    }
    response.dragged()
}

fn move_camera(ui: &Ui, response: &egui::Response, rect: Rect, state: &mut State) -> bool {
    let drag = response.drag_delta() / rect.height();
    let drag = Vec2::new(drag.x, drag.y);
    if drag == Vec2::ZERO {
        return false;
    }
    let viewpoint = &mut state.settings.viewpoint;
    let is_shifted = ui.input(|input| input.modifiers.shift);
    if response.dragged_by(PointerButton::Secondary) {
        viewpoint.look(drag);
    } else if response.dragged_by(PointerButton::Middle) || is_shifted {
        viewpoint.pan(drag);
    } else {
        viewpoint.orbit(drag);
    }
    true
}

/// Draws the divider and what is on its sides.
fn divider(ui: &Ui, rect: Rect, state: &State, engine: &Engine) {
    let settings = &state.settings;
    let painter = ui.painter();
    if settings.is_split {
        let x = rect.left() + settings.divider * rect.width();
        let line = [pos2(x, rect.top()), pos2(x, rect.bottom())];
        painter.line_segment(line, Stroke::new(3.0, Color32::from_black_alpha(160)));
        painter.line_segment(line, Stroke::new(1.0, Color32::WHITE));
        painter.circle(
            pos2(x, rect.center().y),
            6.0,
            Color32::WHITE,
            Stroke::new(1.5, Color32::from_gray(40)),
        );
        label(
            ui,
            pos2(x - 10.0, rect.top() + 10.0),
            egui::Align2::RIGHT_TOP,
            &engine.title(settings, 0),
        );
        label(
            ui,
            pos2(x + 10.0, rect.top() + 10.0),
            egui::Align2::LEFT_TOP,
            &engine.title(settings, 1),
        );
    } else {
        let title = engine.title(settings, state.edited_side);
        label(
            ui,
            rect.left_top() + vec2(10.0, 10.0),
            egui::Align2::LEFT_TOP,
            &title,
        );
    }
}

fn hints(ui: &Ui, rect: Rect, engine: &Engine) {
    let corner = rect.left_bottom() + vec2(10.0, -10.0);
    label(
        ui,
        corner,
        egui::Align2::LEFT_BOTTOM,
        &engine.gpu().describe(),
    );
}

fn label(ui: &Ui, place: egui::Pos2, align: egui::Align2, text: &str) {
    let painter = ui.painter();
    let font = egui::FontId::proportional(12.0);
    let galley = painter.layout_no_wrap(text.to_owned(), font, Color32::WHITE);
    let area = align.anchor_size(place, galley.size());
    painter.rect_filled(area.expand(4.0), 3.0, Color32::from_black_alpha(150));
    painter.galley(area.min, galley, Color32::WHITE);
}
