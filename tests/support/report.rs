//! Checks what holds for every report.

use wgpu_shadows::report::ShadowReport;

/// Asserts that no figure of a report is NaN, and that fractions are in 0..=1.
pub fn assert_whole(report: &ShadowReport, what: &str) {
    for view in &report.views {
        let mut numbers = vec![
            view.texel_size_world.x,
            view.texel_size_world.y,
            view.depth_range_world,
            view.max_peter_panning_world,
        ];
        if let Some(slice) = view.slice {
            assert!(
                (0.0..=1.0).contains(&slice.map_utilization),
                "{what}: {view:?}"
            );
            numbers.extend([
                slice.depth_near,
                slice.depth_far,
                slice.texels_across_image.x,
                slice.texels_across_image.y,
            ]);
        }
        assert!(
            numbers.iter().all(|number| !number.is_nan()),
            "{what}: {view:?}"
        );
    }
}
