//! Prints what a frame cost, in one line.

use wgpu_shadows::{report::ShadowReport, report::ViewStatus};

/// Lists the names of the faces in the order of layers.
const FACES: [&str; 6] = ["+x", "-x", "+y", "-y", "+z", "-z"];

/// Returns faces drawn, kept and empty, casters in each face, and passes.
pub fn of(report: &ShadowReport) -> String {
    let count = |status| {
        let views = report.views.iter();
        views.filter(|view| view.status == status).count()
    };
    let casters: Vec<String> = FACES
        .iter()
        .zip(&report.views)
        .map(|(face, view)| format!("{face} {}", view.casters))
        .collect();
    format!(
        "faces: {} drawn, {} kept, {} empty; casters: {}; {} passes",
        count(ViewStatus::Drawn),
        count(ViewStatus::Kept),
        count(ViewStatus::Empty),
        casters.join(", "),
        report.passes,
    )
}
