//! Loads the images of a glTF file, as RGBA of 8 bits.

use std::path::Path;

use shadow_support::measure::parallel;

use super::scene::Picture;

/// Returns all images of the document, decoded.
pub fn load(
    document: &gltf::Document,
    folder: Option<&Path>,
    buffers: &[gltf::buffer::Data],
) -> gltf::Result<Vec<Picture>> {
    let bar = parallel::bar("textures", document.images().len());
    let images = document
        .images()
        .map(|image| {
            let data = gltf::image::Data::from_source(image.source(), folder, buffers)?;
            bar.inc(1);
            Ok(to_rgba(&data))
        })
        .collect();
    bar.finish_and_clear();
    images
}

fn to_rgba(data: &gltf::image::Data) -> Picture {
    use gltf::image::Format as F;
    let (channels, bytes) = match data.format {
        F::R8 => (1, 1),
        F::R8G8 => (2, 1),
        F::R8G8B8 => (3, 1),
        F::R8G8B8A8 => (4, 1),
        F::R16 => (1, 2),
        F::R16G16 => (2, 2),
        F::R16G16B16 => (3, 2),
        F::R16G16B16A16 => (4, 2),
        F::R32G32B32FLOAT => (3, 4),
        F::R32G32B32A32FLOAT => (4, 4),
    };
    let channel = |bytes: &[u8]| match *bytes {
        [byte] => byte,
        [_, high] => high,
        [a, b, c, d] => (f32::from_le_bytes([a, b, c, d]).clamp(0.0, 1.0) * 255.0).round() as u8,
        _ => 0,
    };
    let rgba = data
        .pixels
        .chunks_exact(channels * bytes)
        .flat_map(|pixel| {
            let c: Vec<u8> = pixel.chunks_exact(bytes).map(channel).collect();
            match c[..] {
                [grey] => [grey, grey, grey, 255],
                [grey, alpha] => [grey, grey, grey, alpha],
                [r, g, b] => [r, g, b, 255],
                [r, g, b, a, ..] => [r, g, b, a],
                [] => [255; 4],
            }
        })
        .collect();
    Picture {
        width: data.width,
        height: data.height,
        rgba,
    }
}
