//! Defines what the bind group of a set of lights refuses.

use thiserror::Error;

use crate::error::DeviceError;

/// Tells why [`ShadowBindings::new`](crate::ShadowBindings::new) or
/// [`compose`](crate::shader::compose) failed.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum BindingsError {
    /// The name of a light cannot become part of WGSL identifiers.
    #[error(
        "ShadowBindingsDescriptor::lights: name must be a lower-case WGSL identifier ([a-z][a-z0-9_]*, no `__`, no `_` or digit at the end, no `map_`, `view_`, `views_`, `place_of_`, `axes_of_` or `cascade_` in front, none of the library's own), got {name:?}"
    )]
    Name {
        /// Is the name in the descriptor.
        name: String,
    },
    /// Two lights have the same name.
    #[error("ShadowBindingsDescriptor::lights: names must differ, got {name:?} twice")]
    DuplicateName {
        /// Is the name that both have.
        name: String,
    },
    /// The index of the bind group exceeds the limit with which the device was created.
    #[error(
        "ShadowBindingsDescriptor::group must be below the device's max_bind_groups = {maximum}, got {group}"
    )]
    Group {
        /// Is the index in the descriptor.
        group: u32,
        /// Is the device's `max_bind_groups`.
        maximum: u32,
    },
    /// The lights need more of a resource than one shader stage may use on this device, or the
    /// uniforms of one light are larger than the device can bind.
    #[error(
        "ShadowBindingsDescriptor::lights: the device's {limit} must be at least {needed}, and it is {maximum}"
    )]
    OverDeviceLimit {
        /// Is the name of the limit in `wgpu::Limits`.
        limit: &'static str,
        /// Is the amount that the lights need, in the limit's own unit.
        needed: u64,
        /// Is the limit of the device, in the same unit.
        maximum: u64,
    },
    /// The maps of a light are on another device than the one that is passed.
    #[error(
        "ShadowBindingsDescriptor::lights: {name:?} must have been made on the device that is passed"
    )]
    OtherDevice {
        /// Is the light's name.
        name: String,
    },
    /// The device did not create an object: it is lost or out of memory, or it refused the object.
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// A name is not that of a module in [`MODULES`](crate::shader::MODULES).
    #[error(
        "shader::compose: every name must be that of a module in shader::MODULES, got {name:?}"
    )]
    UnknownModule {
        /// Is the name that was passed.
        name: String,
    },
    /// Two modules are named of which one goes with a module that the other replaces.
    #[error(
        "shader::compose: names must be of modules that go together, got {name:?} and {other:?}"
    )]
    ConflictingModules {
        /// Is the name of the one.
        name: &'static str,
        /// Is the name of the other.
        other: &'static str,
    },
}
