//! Prints what the frames cost.

use std::fmt::Write;
use std::time::Duration;

use wgpu_shadows::{report::ShadowReport, report::ViewStatus};

/// Holds the times of the frames so far.
#[derive(Default)]
pub struct Table {
    record_times: Vec<Duration>,
}

impl Table {
    /// Adds a frame, and returns its rows: one per cascade.
    pub fn add(&mut self, report: &ShadowReport, record_time: Duration) -> String {
        self.record_times.push(record_time);
        let mut rows = String::from(
            "    cascade  status  casters  culled  texel (m)      depth (m)  worst gap (m)  texels on slice\n",
        );
        for view in &report.views {
            let status = match view.status {
                ViewStatus::Drawn => "drawn",
                ViewStatus::Kept => "kept",
                ViewStatus::Empty => "empty",
                _ => "other",
            };
            // Writing to a string does not fail.
            let _ = writeln!(
                rows,
                "    {:7}  {status:6}  {:7}  {:6}  {:.3} x {:.3}  {:9.1}  {:13.4}  {:14.0}%",
                view.layer,
                view.casters,
                view.culled,
                view.texel_size_world.x,
                view.texel_size_world.y,
                view.depth_range_world,
                view.max_peter_panning_world,
                100.0 * view.slice.map_or(0.0, |slice| slice.map_utilization),
            );
        }
        let _ = writeln!(
            rows,
            "    {} passes, {} draws, {} MiB of maps, frame and record {record_time:.2?}",
            report.passes,
            report.draws(),
            report.bytes_held >> 20,
        );
        rows
    }

    /// Returns the number of frames so far.
    pub fn frames(&self) -> usize {
        self.record_times.len()
    }

    /// Returns the median of the frames' times on the CPU, the upper one of two.
    pub fn median_record_time(&self) -> Duration {
        let mut sorted = self.record_times.clone();
        sorted.sort();
        sorted.get(sorted.len() / 2).copied().unwrap_or_default()
    }
}
