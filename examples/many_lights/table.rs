//! Prints what a frame's shadows cost, as a table.

use std::fmt::Write;

use wgpu_shadows::{report::ShadowReport, report::ViewReport, report::ViewStatus};

use crate::shadows::Shadows;

/// Returns the number of views by status, passes, draws and bytes, for each set of maps, and for
/// its lights that are static and that move.
pub fn of(shadows: &Shadows) -> String {
    let mut table = format!(
        "{:14}{:>7}{:>7}{:>10}{:>7}{:>8}{:>7}{:>12}\n",
        "", "drawn", "kept", "deferred", "empty", "passes", "draws", "bytes"
    );
    for (name, report, views_per_light, moves) in shadows.reports() {
        table += &line(name, &report.views, Some(report));
        for (label, wanted) in [("  still", false), ("  moving", true)] {
            let views: Vec<_> = report
                .views
                .chunks(views_per_light)
                .zip(moves)
                .filter(|(_, moves)| **moves == wanted)
                .flat_map(|(views, _)| views)
                .copied()
                .collect();
            if !views.is_empty() {
                table += &line(label, &views, None);
            }
        }
    }
    table
}

/// Returns a line. The bytes belong to the whole texture. Each view that is drawn is a pass.
fn line(name: &str, views: &[ViewReport], whole: Option<&ShadowReport>) -> String {
    let count = |status| views.iter().filter(|view| view.status == status).count();
    let drawn = count(ViewStatus::Drawn);
    let draws: u32 = views
        .iter()
        .filter(|view| view.status == ViewStatus::Drawn)
        .map(|view| view.casters)
        .sum();
    let mut text = format!(
        "{name:14}{drawn:>7}{:>7}{:>10}{:>7}{:>8}{draws:>7}",
        count(ViewStatus::Kept),
        count(ViewStatus::Deferred),
        count(ViewStatus::Empty),
        whole.map_or(drawn, |report| report.passes as usize),
    );
    if let Some(report) = whole {
        // Writing to a String does not fail.
        let _ = write!(text, "{:>12}", report.bytes_held);
    }
    text + "\n"
}
