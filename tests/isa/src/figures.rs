//! Defines what the compiler tells of a shader.

/// Holds what the compiler says of a stage of a pipeline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Figures {
    /// Counts the vector registers.
    pub vgprs: u64,
    /// Counts the waves that fit on a SIMD unit.
    pub waves: u64,
    /// Counts the instructions.
    pub instructions: u64,
    /// Is the number of cycles from the first to the last instruction of a wave, by the compiler's
    /// own model, which counts the body of a loop eightfold.
    pub latency: u64,
    /// Is the number of cycles per wave where enough waves run, by the same model.
    pub inverse_throughput: u64,
}
