//! Measures the error of the shadows of a running scene.
//!
//! ```text
//! error_meter.rs  ErrorMeter: what an engine records
//! light.rs        MeasuredLight: where rays toward a light lead
//! places.rs       the places of a frame with their rays
//! limits.rs       what the meter needs of a device
//! lookup.rs       the pass that asks the light's own lookup and reads the rays' depths
//! readback.rs     results on their way to the CPU
//! results.rs      what they add up to
//! estimate.rs     means with confidence intervals
//! measured.rs     what was measured
//! random.rs       random numbers
//! ```

mod error_meter;
mod estimate;
mod light;
mod limits;
mod lookup;
mod measured;
mod places;
mod random;
mod readback;
mod results;

pub use error_meter::{ErrorMeter, ErrorMeterDescriptor};
pub use estimate::Estimate;
pub use light::MeasuredLight;
pub use measured::{MeasuredError, MeasuredPlace, MeterReport};
pub use places::Receiver;
