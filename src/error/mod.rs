//! Defines every error of the crate. Each tells the field, the rule that it must obey, and the
//! value that broke the rule.
//!
//! ```text
//! device.rs   DeviceError and DeviceRefusal: what a device did not create, and why
//! shadow.rs   ShadowError: what lights and frames refuse
//! caster.rs   CasterError: what caster pipelines and meshes refuse
//! bindings.rs BindingsError: what the bind group of a set of lights refuses
//! debug.rs    DebugViewError: what a debug view refuses
//! ```

mod bindings;
mod caster;
mod debug;
mod device;
mod shadow;

pub use bindings::BindingsError;
pub use caster::CasterError;
pub use debug::DebugViewError;
pub use device::{DeviceError, DeviceRefusal};
pub use shadow::ShadowError;
