//! Defines what a debug view refuses.

use thiserror::Error;

use crate::error::DeviceError;

/// Tells why a [`DebugView`](crate::debug::DebugView) could not be created or drawn.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum DebugViewError {
    /// A fragment shader cannot write floats to the target format. [`DebugView::draw_cascades`]
    /// also returns this where the format cannot be blended.
    ///
    /// [`DebugView::draw_cascades`]: crate::debug::DebugView::draw_cascades
    #[error("DebugView: the target must be a renderable float colour format, got {format:?}")]
    Format {
        /// Is the format of the target.
        format: wgpu::TextureFormat,
    },
    /// The debug view needs more of a resource than the limits with which the device was created
    /// allow.
    #[error("DebugView: the device's {limit} must be at least {value}, and it is {maximum}")]
    OverDeviceLimit {
        /// Is the name of the limit in `wgpu::Limits`.
        limit: &'static str,
        /// Is the limit of the device, in its own unit.
        maximum: u64,
        /// Is the amount that the debug view needs, in the same unit.
        value: u64,
    },
    /// An unfolded cross was requested of a light that has no cube.
    #[error(
        "DebugView: a cross needs the six faces of a point light, got a light with {layers} layers"
    )]
    NotACube {
        /// Is the number of layers of the light's map.
        layers: u32,
    },
    /// The map does not have the requested layer.
    #[error("DebugView: layer must be below the map's {layers} layers, got {layer}")]
    Layer {
        /// Is the layer that was requested.
        layer: u32,
        /// Is the number of layers of the map.
        layers: u32,
    },
    /// The maps are on another device than the debug view.
    #[error("DebugView: the maps must be on the device that the view was made on")]
    OtherDevice,
    /// The device did not create an object: it is lost or out of memory, or it refused the object.
    #[error(transparent)]
    Device(#[from] DeviceError),
}
