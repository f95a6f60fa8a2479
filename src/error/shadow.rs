//! Defines what lights and frames refuse.

use thiserror::Error;

use crate::DepthFormat;
use crate::error::DeviceError;

/// Tells why the construction of a light, a frame, or the recording of a light failed.
///
/// Whichever call returned it, an error means that nothing was recorded and that the object keeps
/// its last good state.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ShadowError {
    /// A number that must be finite is NaN or infinite.
    #[error("{field} must be finite, got {value}")]
    NotFinite {
        /// Is the path of the field.
        field: &'static str,
        /// Is the value, formatted.
        value: String,
    },
    /// A value lies outside its permitted range.
    #[error("{field} must be {rule}, got {value}")]
    OutOfRange {
        /// Is the path of the field.
        field: &'static str,
        /// States the permitted range in words.
        rule: &'static str,
        /// Is the value, formatted.
        value: String,
    },
    /// A light needs more of a resource than the limits with which the device was created allow.
    #[error("{field}: the device's {limit} must be at least {value}, and it is {maximum}")]
    OverDeviceLimit {
        /// Is the path of the field that sets the size: lower its value, or create the device with
        /// a higher limit. Where no field sets it (a point light always has six faces), this
        /// describes the object instead.
        field: &'static str,
        /// Is the name of the limit in `wgpu::Limits`.
        limit: &'static str,
        /// Is the limit of the device, in its own unit: texels, layers or bytes.
        maximum: u64,
        /// Is the amount that the light needs, in the same unit.
        value: u64,
    },
    /// A direction vector has length zero and therefore no direction.
    #[error("{field} must not have length zero")]
    ZeroDirection {
        /// Is the path of the field.
        field: &'static str,
    },
    /// A covered box has a corner that is NaN or infinite. A box with `min > max` on an axis is
    /// empty instead and covers nothing, without an error.
    #[error("{field} must have finite corners, got {value}")]
    BoundsNotFinite {
        /// Is the path of the field.
        field: &'static str,
        /// Is the value of the box, formatted.
        value: String,
    },
    /// A camera matrix is not finite or not invertible, so that it describes no volume.
    #[error("{field} of camera {camera} must be finite and invertible, got {value}")]
    CameraMatrix {
        /// Is the path of the field.
        field: &'static str,
        /// Is the index of the camera in the frame's list.
        camera: usize,
        /// Is the matrix, formatted.
        value: String,
    },
    /// The fitted view cannot be represented in floating point. One cause is that its extent, or
    /// its distance from the render origin, overflows f32.
    ///
    /// The other cause affects directional lights only: the view lies so far from the world origin
    /// that f64 does not distinguish its texels. That is so where four steps of f64 (`2⁻⁵⁰
    /// coordinate_world`) exceed the texel size that `extent_world` leads to, and also exceed what
    /// f32 resolves at `distance_world`. That texel size is `extent_world` divided by the map's
    /// texels per side, or by 64 if the map has fewer. A map of 2048 texels over 100 units fails
    /// beyond 5.5·10¹³ units from the world origin. Under a camera with
    /// [`Stability::TightFit`](crate::Stability::TightFit) the extent is that of a cascade's slice
    /// of the view, or of all casters and receivers together if that is less, and not of the part
    /// that the map is fitted to.
    #[error(
        "the fitted view must be representable in f32 and f64, got an extent of {extent_world} world units at {distance_world} from the render origin and {coordinate_world} from the world origin"
    )]
    ViewNotRepresentable {
        /// Is the largest extent of the view in world units.
        extent_world: f64,
        /// Is the view's distance from the render origin in world units.
        distance_world: f64,
        /// Is the view's distance from the world origin in world units.
        coordinate_world: f64,
    },
    /// Every slot of the pool holds a light.
    #[error(
        "the pool is full: raise PoolDescriptor::capacity (now {capacity}) or remove a light first"
    )]
    PoolFull {
        /// Is the number of slots of the pool.
        capacity: u32,
    },
    /// The pipeline of a caster was not made for the depth format of the map that the caster is to
    /// be drawn into.
    #[error("{field}[{index}]: CasterPipelineDescriptor::depth_formats must name {format:?}")]
    CasterFormat {
        /// Is the path of the list.
        field: &'static str,
        /// Is the index in the list, or that of the [`CasterId`](crate::CasterId) in a set.
        index: usize,
        /// Is the format of the map.
        format: DepthFormat,
    },
    /// The pipeline of a caster was made on another device than the light's maps.
    #[error("{field}[{index}]: its CasterPipeline must be made on the device of the light")]
    CasterDevice {
        /// Is the path of the list.
        field: &'static str,
        /// Is the index in the list, or that of the [`CasterId`](crate::CasterId) in a set.
        index: usize,
    },
    /// A caster was removed from the set, or belongs to another set.
    #[error(
        "{field} must be of a caster that this set has been given and not taken back, got index {index}"
    )]
    UnknownCaster {
        /// Is the path of the field.
        field: &'static str,
        /// Is the index of the caster.
        index: u32,
    },
    /// A slot was removed from the pool, or belongs to another pool.
    #[error(
        "{field} must be a slot that this pool has given out and not taken back, got slot {index}"
    )]
    UnknownSlot {
        /// Is the path of the field.
        field: &'static str,
        /// Is the index of the slot.
        index: u32,
    },
    /// A frame lists a slot twice.
    #[error("{field} must name each slot at most once, got slot {index} twice")]
    DuplicateSlot {
        /// Is the path of the field.
        field: &'static str,
        /// Is the index of the slot.
        index: u32,
    },
    /// The device has too little memory for the depth texture.
    #[error("{field} needs {bytes} bytes of device memory, and the device is out of memory")]
    OutOfMemory {
        /// Is the path of the field that sets the size.
        field: &'static str,
        /// Is the size of the depth texture in bytes.
        bytes: u64,
    },
    /// The device did not create an object: it is lost or out of memory, or it refused the object.
    #[error(transparent)]
    Device(#[from] DeviceError),
}
