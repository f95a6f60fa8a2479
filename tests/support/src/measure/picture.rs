//! Writes images of visibilities, to see what the figures mean.

use std::path::Path;

use image::{GrayImage, Luma};

use super::pixels::Pixel;

/// Writes images of `size` side by side: visibility as grey, and one dark grey where nothing was
/// sampled.
pub fn write(
    path: &Path,
    [width, height]: [u32; 2],
    pixels: &[Pixel],
    visibilities: &[Vec<f32>],
) -> image::ImageResult<()> {
    let mut picture =
        GrayImage::from_pixel(width * visibilities.len() as u32, height, Luma([UNASKED]));
    for (column, answers) in (0u32..).zip(visibilities) {
        for (pixel, answer) in pixels.iter().zip(answers) {
            let grey = (255.0 * answer.clamp(0.0, 1.0)).round() as u8;
            let x = column * width + pixel.index % width;
            picture.put_pixel(x, pixel.index / width, Luma([grey]));
        }
    }
    picture.save(path)
}

/// Is the grey of pixels without a surface that faces the light.
const UNASKED: u8 = 90;
