//! Tests maps that do not fit into the device's memory.

use wgpu_shadows::{
    CascadeLayout, DirectionalShadow, DirectionalShadowDescriptor, OmniShadow,
    OmniShadowDescriptor, ShadowError,
};

use crate::fixtures::gpu::{GpuRequest, own_gpu};
use crate::fixtures::table;

/// The map is larger than a software adapter can address: the limits allow each side and the
/// layers, but the memory does not suffice. (OpenGL does not report when it runs out.)
#[test]
fn maps_larger_than_the_memory() {
    let limits = wgpu::Limits {
        max_texture_dimension_2d: 16384,
        ..Default::default()
    };
    let large = own_gpu(GpuRequest {
        limits,
        backend: Some(wgpu::Backends::VULKAN),
        ..Default::default()
    });
    let device = &large.device;
    let map_size = 16384;
    let sun = DirectionalShadowDescriptor {
        map_size,
        layout: CascadeLayout::fixed(8),
        ..Default::default()
    };
    let lamp = OmniShadowDescriptor {
        map_size,
        ..Default::default()
    };
    let cases = [
        (
            DirectionalShadow::new(device, &sun).err(),
            "DirectionalShadowDescriptor::map_size",
            8,
        ),
        (
            OmniShadow::new(device, &lamp).err(),
            "OmniShadowDescriptor::map_size",
            6,
        ),
    ];
    for (error, field, layers) in cases {
        let bytes = 16384 * 16384 * 4 * layers;
        let error = error.expect("no memory");
        assert_eq!(error, ShadowError::OutOfMemory { field, bytes });
        assert_eq!(
            error.to_string(),
            format!(
                "{field} needs {bytes} bytes of device memory, and the device is out of memory"
            )
        );
    }
    table::record(
        "maps of 6 and 8 GiB (on Vulkan in either run: OpenGL does not say when it runs out)",
        "an error with field and bytes",
        "as expected, 2 kinds of lights",
    );
}
