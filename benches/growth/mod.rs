//! Measures how cost grows, one number at a time.
//!
//! ```text
//! card.rs       the row of a machine for doc/measured_on.md
//! cpu.rs        casters and lights: time and allocations on the CPU, and time on the device
//! copies.rs     copies of one mesh beside one instanced draw; the draw calls of a yard
//! device.rs     cascades, map sizes, taps, and the bare minimum: time on the device
//! faces.rs      a point light's faces in one pass and in a pass each
//! motion.rs     the share of casters that move, and what the static-caster cache saves
//! retained.rs   a set of many casters: nothing moves, the camera walks, some or all casters move
//! table.rs      tables and exponents
//! stage.rs      what the measurements share; crowd.rs, lamps.rs: many boxes and lights; counts.rs: draws and passes
//! processor.rs  time and allocations on the CPU
//! ```

pub mod card;
pub mod copies;
pub mod counts;
pub mod cpu;
pub mod crowd;
pub mod device;
pub mod faces;
pub mod lamps;
pub mod motion;
pub mod processor;
pub mod retained;
pub mod stage;
pub mod table;
