//! Every error of the crate: field, rule, and the value that broke it.

use thiserror::Error;

use crate::DepthFormat;

/// Why a device did not make what it was asked for. Part of every error of the crate that a device can cause.
///
/// A browser's WebGPU tells of errors only after the call that caused them. There nothing of this kind is returned: constructors
/// and frames succeed, what the browser refused is an invalid object, and its words arrive at the engine's
/// `wgpu::Device::on_uncaptured_error`. Loss of the device arrives at `wgpu::Device::set_device_lost_callback`. Set both, or
/// the only sign of a shader that does not compile is a black picture. (WebGL in a browser answers at once, like native
/// backends.)
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum DeviceRefusal {
    /// The device is lost or was destroyed. Nothing made on it works any more: make everything anew on another one. A frame in
    /// which nothing is drawn and nothing uploaded asks nothing of the device, and does not notice.
    #[error("the device is lost")]
    Lost,
    /// The device's memory does not suffice.
    #[error("the device is out of memory")]
    OutOfMemory,
    /// The device found the request invalid, for instance for objects of another device; the text is the device's own.
    #[error("{0}")]
    Refused(String),
}

/// An object that a device did not make. Every error of the crate that a device can cause carries one.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("the device did not make {object}: {refusal}")]
pub struct DeviceError {
    /// What was being created.
    pub object: &'static str,
    /// Why the device did not make it.
    pub refusal: DeviceRefusal,
}

/// What a shadow light refuses at construction or at its per-frame call.
///
/// Whatever the call, an error means that nothing was recorded and that the object keeps its last good state.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ShadowError {
    /// A number that must be finite was NaN or infinite.
    #[error("{field} must be finite, got {value}")]
    NotFinite {
        /// Path of the field.
        field: &'static str,
        /// The value, formatted.
        value: String,
    },
    /// A number lies outside its range.
    #[error("{field} must be {rule}, got {value}")]
    OutOfRange {
        /// Path of the field.
        field: &'static str,
        /// The permitted range in words.
        rule: &'static str,
        /// The value, formatted.
        value: String,
    },
    /// A light needs more of something than the device was created with.
    #[error("{field} asks for {value}, and the device's {limit} is {maximum}")]
    OverDeviceLimit {
        /// Path of the field that set the size: lower it, or create the device with a higher limit. Where no field does (a point
        /// light has six faces), what the device is too small for.
        field: &'static str,
        /// Name of the limit in `wgpu::Limits`.
        limit: &'static str,
        /// The device's value of it, in the limit's own unit: texels, layers, bytes.
        maximum: u64,
        /// What is needed, in the same unit.
        value: u64,
    },
    /// A direction of length zero has no direction.
    #[error("{field} must not have length zero")]
    ZeroDirection {
        /// Path of the field.
        field: &'static str,
    },
    /// A covered box with a NaN or infinite corner. (Bounds with `min > max` are empty and are passed over without an error.)
    #[error("{field} must have finite corners, got {value}")]
    BoundsNotFinite {
        /// Path of the field.
        field: &'static str,
        /// The bounds, formatted.
        value: String,
    },
    /// A camera matrix that describes no volume: not finite, or not invertible.
    #[error("{field} of camera {camera} must be finite and invertible, got {value}")]
    CameraMatrix {
        /// Path of the field.
        field: &'static str,
        /// Position of the camera in the frame's list.
        camera: usize,
        /// The matrix, formatted.
        value: String,
    },
    /// The fitted view cannot be expressed: its extent or its distance from the render origin overflows f32, or, for a
    /// directional light, it lies so far from the world's origin that f64 does not tell its texels apart. That is so where four
    /// steps of f64 (`2⁻⁵⁰ coordinate_world`) exceed `extent_world` divided by the map's texels a side, or by 64 for a smaller
    /// map, and also exceed what f32 resolves at `distance_world`: for a map of 2048 texels over 100 units, from 5·10¹³ units on.
    #[error(
        "the fitted view must be representable, got extent {extent_world} at {distance_world} from the render origin and {coordinate_world} from the world's"
    )]
    ViewNotRepresentable {
        /// Largest extent of the view in world units.
        extent_world: f64,
        /// Its distance from the render origin in world units.
        distance_world: f64,
        /// Its distance from the world's origin in world units.
        coordinate_world: f64,
    },
    /// A pool has no free slot.
    #[error(
        "the pool is full: raise PoolDescriptor::capacity (now {capacity}) or remove a light first"
    )]
    PoolFull {
        /// Slots of the pool.
        capacity: u32,
    },
    /// A caster whose pipeline was not made for the format of the map that it is to be drawn into.
    #[error("{field}[{index}]: CasterPipelineDescriptor::depth_formats must name {format:?}")]
    CasterFormat {
        /// Path of the list.
        field: &'static str,
        /// Position in the list.
        index: usize,
        /// The map's format.
        format: DepthFormat,
    },
    /// A caster whose pipeline was made on another device than the light's maps are on.
    #[error("{field}[{index}]: its CasterPipeline must be made on the device of the light")]
    CasterDevice {
        /// Path of the list.
        field: &'static str,
        /// Position in the list.
        index: usize,
    },
    /// A slot that was given back, or that belongs to another pool.
    #[error(
        "{field} must be a slot that this pool has given out and not taken back, got slot {index}"
    )]
    UnknownSlot {
        /// Path of the field.
        field: &'static str,
        /// Index of the slot.
        index: u32,
    },
    /// One slot twice in a frame.
    #[error("{field} must name each slot at most once, got slot {index} twice")]
    DuplicateSlot {
        /// Path of the field.
        field: &'static str,
        /// Index of the slot.
        index: u32,
    },
    /// The device could not hold the depth texture.
    #[error("{field} needs {bytes} bytes of device memory, and the device is out of memory")]
    OutOfMemory {
        /// Path of the field that set the size.
        field: &'static str,
        /// Bytes asked for.
        bytes: u64,
    },
    /// The device did not make an object: it is lost, out of memory, or refused it.
    #[error(transparent)]
    Device(#[from] DeviceError),
}

/// What [`CasterPipeline::new`](crate::CasterPipeline::new) and [`MeshCaster::new`](crate::MeshCaster::new) refuse.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum CasterError {
    /// A position attribute the built-in vertex stage cannot read as floats.
    #[error(
        "PositionAttribute::format must be a float, snorm or unorm format of 2 to 4 components, got {format:?}"
    )]
    PositionFormat {
        /// The format asked for.
        format: wgpu::VertexFormat,
    },
    /// An attribute that does not lie inside its vertex.
    #[error(
        "{field}: offset {offset} + {size} bytes must lie inside the stride of {array_stride} bytes, both multiples of 4"
    )]
    VertexLayout {
        /// Path of the field.
        field: &'static str,
        /// Byte offset of the attribute.
        offset: u64,
        /// Its size in bytes.
        size: u64,
        /// Stride of its buffer.
        array_stride: u64,
    },
    /// More of something than the device was created with.
    #[error("{field} asks for {value}, and the device's {limit} is {maximum}")]
    OverDeviceLimit {
        /// Path of the field.
        field: &'static str,
        /// Name of the limit in `wgpu::Limits`.
        limit: &'static str,
        /// The device's value of it, in the limit's own unit.
        maximum: u64,
        /// What is needed, in the same unit.
        value: u64,
    },
    /// A pipeline for no map at all.
    #[error("CasterPipelineDescriptor::depth_formats must not be empty")]
    NoDepthFormat,
    /// The strip index format goes with strip topologies and with no others.
    #[error(
        "CasterPipelineDescriptor::primitive.strip_index_format goes with strip topologies only, got {topology:?}"
    )]
    StripIndexFormat {
        /// The topology asked for.
        topology: wgpu::PrimitiveTopology,
    },
    /// Outlines, depths that are not clipped and conservative rasterization give no shadow map.
    #[error(
        "CasterPipelineDescriptor::primitive must fill polygons, clip depths and not be conservative, got {polygon_mode:?}, unclipped_depth {unclipped_depth}, conservative {conservative}"
    )]
    Primitive {
        /// The value given.
        unclipped_depth: bool,
        /// The value given.
        polygon_mode: wgpu::PolygonMode,
        /// The value given.
        conservative: bool,
    },
    /// Lines and points cast no shadow that a surface could receive without bias tricks; only triangles are accepted.
    #[error(
        "CasterPipelineDescriptor::primitive.topology must be a triangle topology, got {topology:?}"
    )]
    Topology {
        /// The topology asked for.
        topology: wgpu::PrimitiveTopology,
    },
    /// An object of another device than the one that is made use of.
    #[error("{field} must have been made on the device that is passed")]
    OtherDevice {
        /// Path of the field.
        field: &'static str,
    },
    /// A buffer that the device cannot use: most often one of another device, or one whose creation failed.
    #[error("{field} cannot be used on the device: {refusal}")]
    Buffer {
        /// Path of the field.
        field: &'static str,
        /// Why the device cannot use it.
        refusal: DeviceRefusal,
    },
    /// A pipeline with the engine's own vertex stage that reads what a ready-made mesh does not set.
    #[error(
        "MeshCasterDescriptor::pipeline must take no more than vertex buffer 0 and no bind group of its own, got one that takes {needs}"
    )]
    MeshPipeline {
        /// What else the pipeline takes.
        needs: String,
    },
    /// The device did not make an object: it is lost, out of memory, or refused it.
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// A number that must be finite was NaN or infinite.
    #[error("{field} must be finite, got {value}")]
    NotFinite {
        /// Path of the field.
        field: &'static str,
        /// The value, formatted.
        value: String,
    },
    /// A range of indices or vertices that the buffer does not hold.
    #[error("{field} must hold {needed} bytes, got {got}")]
    BufferTooSmall {
        /// Path of the field.
        field: &'static str,
        /// Bytes that the ranges need.
        needed: u64,
        /// Bytes that the buffer has.
        got: u64,
    },
    /// A range of indices or vertices that holds nothing, or ends before it begins.
    #[error("{field} must not be empty, got {start}..{end}")]
    EmptyRange {
        /// Path of the field.
        field: &'static str,
        /// First of the range.
        start: u32,
        /// One past the last.
        end: u32,
    },
    /// Indices of another format than the pipeline's strips restart by.
    #[error(
        "MeshCasterDescriptor::indices.format must be the strip index format of the pipeline ({expected:?}), got {format:?}"
    )]
    IndexFormat {
        /// The pipeline's strip index format.
        expected: Option<wgpu::IndexFormat>,
        /// The mesh's index format.
        format: wgpu::IndexFormat,
    },
    /// A buffer that was created without the usage it is bound with.
    #[error("{field} must be created with {usage}")]
    BufferUsage {
        /// Path of the field.
        field: &'static str,
        /// Name of the missing usage flag.
        usage: &'static str,
    },
}

/// What [`ShadowBindings::new`](crate::ShadowBindings::new) and [`compose`](crate::shader::compose) refuse.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum BindingsError {
    /// A light's name becomes part of WGSL identifiers.
    #[error(
        "ShadowBindingsDescriptor::lights: name must be a lower-case WGSL identifier ([a-z][a-z0-9_]*, no `__`, no `_` or digit at the end, no `map_`, `view_` or `views_` in front, none of the library's own), got {name:?}"
    )]
    Name {
        /// The name asked for.
        name: String,
    },
    /// Two lights of one name.
    #[error("ShadowBindingsDescriptor::lights: names must differ, got {name:?} twice")]
    DuplicateName {
        /// The name.
        name: String,
    },
    /// The group index exceeds what the device was created with.
    #[error(
        "ShadowBindingsDescriptor::group must be below the device's max_bind_groups = {maximum}, got {group}"
    )]
    Group {
        /// The group asked for.
        group: u32,
        /// The device's limit.
        maximum: u32,
    },
    /// More of a resource than one shader stage may use on this device, or a light whose uniforms are larger than it binds.
    #[error("ShadowBindingsDescriptor::lights need {needed} {limit}, and the device has {maximum}")]
    OverDeviceLimit {
        /// Name of the limit in `wgpu::Limits`.
        limit: &'static str,
        /// What the set needs, in the limit's own unit.
        needed: u64,
        /// What the device was created with.
        maximum: u64,
    },
    /// A light whose maps are on another device.
    #[error(
        "ShadowBindingsDescriptor::lights: {name:?} must have been made on the device that is passed"
    )]
    OtherDevice {
        /// The light's name.
        name: String,
    },
    /// The device did not make an object: it is lost, out of memory, or refused it.
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// A module name that is not in the table.
    #[error("there is no shader module named {name:?}")]
    UnknownModule {
        /// The name asked for.
        name: String,
    },
}

/// What [`DebugView`](crate::debug::DebugView) refuses.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum DebugViewError {
    /// A target format that a fragment shader cannot write floats to.
    #[error("DebugView: the target must be a renderable float colour format, got {format:?}")]
    Format {
        /// The format asked for.
        format: wgpu::TextureFormat,
    },
    /// More of something than the device was created with.
    #[error("DebugView needs {value}, and the device's {limit} is {maximum}")]
    OverDeviceLimit {
        /// Name of the limit in `wgpu::Limits`.
        limit: &'static str,
        /// The device's value of it, in the limit's own unit.
        maximum: u64,
        /// What is needed, in the same unit.
        value: u64,
    },
    /// An unfolded cross of a light that has no cube.
    #[error(
        "DebugView: a cross needs the six faces of a point light, got a light with {layers} layers"
    )]
    NotACube {
        /// Layers of the map.
        layers: u32,
    },
    /// A layer that the map does not have.
    #[error("DebugView: layer must be below the map's {layers} layers, got {layer}")]
    Layer {
        /// The layer asked for.
        layer: u32,
        /// Layers of the map.
        layers: u32,
    },
    /// Maps that are on another device than the view.
    #[error("DebugView: the maps must be on the device that the view was made on")]
    OtherDevice,
    /// The device did not make an object: it is lost, out of memory, or refused it.
    #[error(transparent)]
    Device(#[from] DeviceError),
}
