//! Writes PNG files.

use std::path::{Path, PathBuf};

/// Makes the folder that the program's first argument names, or else `default`, and returns it.
pub fn folder_from_arguments(default: &str) -> Result<PathBuf, String> {
    let folder = std::env::args_os()
        .nth(1)
        .map_or(default.into(), PathBuf::from);
    make_folder(&folder)?;
    Ok(folder)
}

/// Makes `folder`, and those that it lies in.
pub fn make_folder(folder: &Path) -> Result<(), String> {
    std::fs::create_dir_all(folder)
        .map_err(|error| format!("cannot make the folder {}: {error}", folder.display()))
}

/// Writes `pixels`, four bytes each, row by row from the top.
pub fn save(path: &Path, pixels: &[u8], [width, height]: [u32; 2]) -> Result<(), String> {
    image::save_buffer(path, pixels, width, height, image::ColorType::Rgba8)
        .map_err(|error| format!("cannot write {}: {error}", path.display()))
}

/// Writes an image of any kind of pixels.
pub fn save_image(path: &Path, picture: &image::DynamicImage) -> Result<(), String> {
    picture
        .save_with_format(path, image::ImageFormat::Png)
        .map_err(|error| format!("cannot write {}: {error}", path.display()))
}

/// Returns an image of half the width and half the height: the mean of each four sRGB pixels, taken
/// in linear light.
pub fn halved(pixels: &[u8], [width, height]: [u32; 2]) -> Vec<u8> {
    let linear: Vec<f32> = (0..=u8::MAX).map(linear_from_srgb).collect();
    let (width, height) = (width as usize, height as usize);
    let mut half = Vec::with_capacity(width * height);
    for y in 0..height / 2 {
        for index in (0..width / 2).flat_map(|x| (0..4).map(move |channel| 8 * x + channel)) {
            let top = 4 * width * 2 * y + index;
            let four = [top, top + 4, top + 4 * width, top + 4 * width + 4];
            let sum: f32 = four.iter().map(|&at| linear[usize::from(pixels[at])]).sum();
            half.push(srgb_from_linear(sum * 0.25));
        }
    }
    half
}

fn linear_from_srgb(level: u8) -> f32 {
    let level = f32::from(level) / 255.0;
    if level <= 0.04045 {
        level / 12.92
    } else {
        ((level + 0.055) / 1.055).powf(2.4)
    }
}

fn srgb_from_linear(light: f32) -> u8 {
    let level = if light <= 0.003_130_8 {
        light * 12.92
    } else {
        1.055 * light.powf(1.0 / 2.4) - 0.055
    };
    (255.0 * level).round() as u8
}
