//! Contains the CPU reference of the WGSL: the arithmetic of a lookup in f64, which returns what
//! the shader should return for the texels that a map contains.
//!
//! It serves the tests of engines and of the library, which compare the device's results with it.
//! Kernels are computed here by their definition, a bilinear comparison convolved with a row of
//! integers, and not by the shader's closed form.
//!
//! No input makes these functions panic.

mod filter;
mod receiver;

pub use filter::{DepthLayer, visibility};
pub use receiver::{Receiver, holds, receiver, weight};
