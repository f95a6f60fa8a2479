//! Draws what faults of shadows look like, each beside the same image without it.
//!
//! `cargo run --example symptoms [FOLDER]` draws one image per fault into `target/symptoms`, or the
//! folder named. `-- --update` also writes them into `doc/pictures.md`, from which the
//! documentation takes them: rustdoc has no place for files of images, so they are in its text.
//!
//! ```text
//! faults.rs     what is wrong in each image, and what is right
//! props.rs      the objects
//! painter.rs    one image
//! ../support    meshes and Blinn-Phong
//! ```

mod faults;
mod painter;
mod props;

use std::error::Error;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use clap::Parser;
use example_support::{arguments, picture};
use image::codecs::jpeg::JpegEncoder;
use image::{RgbImage, RgbaImage};
use shadow_support::gpu::{Gpu, GpuRequest};

use painter::SIZE;

/// Is the file of images in the documentation, and the quality of its JPEGs in percent.
const EMBEDDED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/doc/pictures.md");
const QUALITY: u8 = 85;

/// Is the number of columns between the two images.
const GAP: u32 = 6;

/// Draws what faults of shadows look like, each beside the same image without it.
#[derive(Parser)]
struct Arguments {
    /// Sets the folder for the images.
    #[arg(default_value = "target/symptoms")]
    folder: PathBuf,
    /// Writes the images into the documentation as well.
    #[arg(long)]
    update: bool,
}

fn main() -> ExitCode {
    arguments::run("symptoms", run)
}

fn run(arguments: Arguments) -> Result<(), Box<dyn Error>> {
    let gpu = Gpu::new(&GpuRequest::default())?;
    picture::make_folder(&arguments.folder)?;
    let mut text = "<!-- Written by `cargo run --example symptoms -- --update`. -->\n\n".to_owned();
    let mut embed = |name: &str, image: &RgbImage| -> Result<(), Box<dyn Error>> {
        let mut bytes = Vec::new();
        JpegEncoder::new_with_quality(&mut bytes, QUALITY).encode_image(image)?;
        writeln!(
            text,
            "[picture-{name}]: data:image/jpeg;base64,{}",
            STANDARD.encode(bytes)
        )?;
        Ok(())
    };
    embed("quickstart", &halved_quickstart()?)?;
    for fault in faults::all() {
        let [wrong, right] = [&fault.wrong, &fault.right].map(|setup| painter::paint(&gpu, setup));
        let pair = beside(&wrong?, &right?);
        let path = arguments.folder.join(fault.name).with_extension("png");
        pair.save(&path)?;
        println!("{}", path.display());
        embed(fault.name, &pair)?;
    }
    if arguments.update {
        std::fs::write(EMBEDDED, text)?;
    }
    Ok(())
}

/// Returns the quickstart's picture at half its size.
fn halved_quickstart() -> Result<RgbImage, Box<dyn Error>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("doc/quickstart.png");
    let whole = image::open(path)?.into_rgba8();
    let size = whole.dimensions();
    let half = picture::halved(&whole, size.into());
    let half = RgbaImage::from_raw(size.0 / 2, size.1 / 2, half).ok_or("an image of that size")?;
    Ok(image::DynamicImage::from(half).into_rgb8())
}

/// Returns both images in one, with a gap between them.
fn beside(left: &[u8], right: &[u8]) -> RgbImage {
    let [width, height] = SIZE;
    RgbImage::from_fn(2 * width + GAP, height, |x, y| {
        let (pixels, column) = if x < width {
            (left, x)
        } else if x < width + GAP {
            return image::Rgb([255; 3]);
        } else {
            (right, x - width - GAP)
        };
        let at = 4 * (y * width + column) as usize;
        image::Rgb([pixels[at], pixels[at + 1], pixels[at + 2]])
    })
}
