//! How cost grows, one number at a time.
//!
//! ```text
//! cpu.rs        casters and lights: time and allocations on the CPU
//! device.rs     cascades, map sizes, taps, and the bare minimum: time on the device
//! faces.rs      a point light's faces in one pass and in a pass each
//! table.rs      tables and exponents
//! stage.rs      what they share; crowd.rs: many boxes as casters
//! processor.rs  time and allocations on the CPU
//! clock.rs      time on the device
//! ```

pub mod clock;
pub mod cpu;
pub mod crowd;
pub mod device;
pub mod faces;
pub mod processor;
pub mod stage;
pub mod table;
