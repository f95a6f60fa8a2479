//! Defines the errors that a device causes: it is lost, out of memory, or refuses an object.

use thiserror::Error;

/// Tells why a device did not create an object. Every error of the crate that a device can cause
/// contains one.
///
/// A browser's WebGPU reports errors only after the call that caused them has returned. In such a
/// browser no error of this kind is returned: constructors and frames succeed, an object that the
/// browser refused is an invalid one, and the browser's message arrives at the engine's
/// `wgpu::Device::on_uncaptured_error`. The loss of the device arrives at
/// `wgpu::Device::set_device_lost_callback`. Engines should set both; otherwise the only sign of a
/// shader that does not compile is a black image. WebGL in a browser reports errors at once, as
/// native backends do.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum DeviceRefusal {
    /// The device is lost or was destroyed. No object that was created on it works any longer:
    /// create all of them again on another device. A frame that draws and uploads nothing makes no
    /// call to the device, so it does not return this error.
    #[error("the device is lost")]
    Lost,
    /// The device has too little memory for the object.
    #[error("the device is out of memory")]
    OutOfMemory,
    /// The device found the request invalid, for example because it names objects of another
    /// device. The text is the device's own message.
    #[error("{0}")]
    Refused(String),
}

/// Names an object that a device did not create. Every error of the crate that a device can cause
/// contains one.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("the device did not make {object}: {refusal}")]
pub struct DeviceError {
    /// Describes the object that was to be created.
    pub object: &'static str,
    /// Tells why the device did not create it.
    pub refusal: DeviceRefusal,
}
