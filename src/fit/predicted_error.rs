//! Predicts the error of a texel from its size in pixels and the density of shadow edges.

/// Is the factor between the error of a texel and its side in pixels times the density of edges:
/// the mean squared error over the pixels of an image is that factor times their mean. It was
/// measured for the default filter.
const SQUARED_ERROR_PER_EDGE: f64 = 0.095;

/// Is the number of pixels beyond which a texel makes shadows no more wrong. Shadows narrower than
/// that are lost by then, and without a limit few points near the camera would outweigh all others.
pub(crate) const LARGEST_TEXEL_PIXELS: f64 = 8.0;

/// Is the number of frames from one prediction to the next: a quarter of a second at sixty frames
/// per second, and a sixteenth of the cost of a prediction in each frame.
pub(crate) const FRAMES_BETWEEN_PREDICTIONS: u32 = 16;

/// Returns the root of the mean squared error over `count` points, for the sum over these points of
/// the density of edges times the size of a texel in pixels.
pub(crate) fn root_mean_error(sum: f64, count: usize) -> f64 {
    (SQUARED_ERROR_PER_EDGE * sum / count.max(1) as f64).sqrt()
}
