//! Provides devices that draw several views at once.

use std::sync::OnceLock;

use crate::support::gpu::{Gpu, GpuRequest, vulkan};

/// Returns a shared Vulkan device with six views per pass. wgpu has no multiview on OpenGL.
pub fn device() -> &'static Gpu {
    static SHARED: OnceLock<Gpu> = OnceLock::new();
    SHARED.get_or_init(|| {
        Gpu::new(GpuRequest {
            features: wgpu::Features::MULTIVIEW,
            limits: wgpu::Limits {
                max_multiview_view_count: 6,
                ..wgpu::Limits::default()
            },
            backend: Some(wgpu::Backends::VULKAN),
        })
    })
}

/// Returns a device of the same adapter without multiview.
pub fn portable() -> &'static Gpu {
    vulkan()
}

/// Returns false where the driver is a llvmpipe that draws clipped triangles into wrong layers. A run with another
/// driver sets `SHADOW_TEST_MULTIVIEW=required`, and fails if it did not get that driver.
pub fn is_right() -> bool {
    let info = &device().adapter;
    let version = info.driver_info.strip_prefix("Mesa ").unwrap_or_default();
    let numbers = version.split(|letter: char| !letter.is_ascii_digit());
    let version: Vec<u32> = numbers.map_while(|part| part.parse().ok()).collect();
    let is_right = !info.driver.contains("llvmpipe") || version >= vec![25, 0, 7];
    let required = std::env::var_os("SHADOW_TEST_MULTIVIEW").is_some_and(|v| v == "required");
    assert!(
        is_right || !required,
        "{} is not right",
        device().describe()
    );
    is_right
}
