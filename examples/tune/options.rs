//! Defines the command line.

use std::path::PathBuf;

use clap::Parser;
use shadow_support::measure::pixels::Effort;

/// Finds the shadow settings that suit a scene: errors against ray-traced truth, costs, and the
/// descriptor to paste.
#[derive(Parser, Debug)]
#[command(name = "tune")]
pub struct Options {
    /// Names a .glb or .gltf file; without it, boxes under a sun are measured.
    pub file: Option<PathBuf>,
    /// Selects one of the file's lights, in the order of its nodes, counted from 0.
    #[arg(long, default_value_t = 0)]
    pub light: usize,
    /// Selects one of the file's cameras, in the order of its nodes, counted from 0; a file without
    /// cameras gets one.
    #[arg(long, default_value_t = 0)]
    pub camera: usize,
    /// Sets the angular diameter of a sun in radians, for soft shadows (the sun's is 0.0093).
    #[arg(long, value_parser = positive)]
    pub angular_diameter: Option<f32>,
    /// Sets the radius of a spot or point light in the file's units, for soft shadows.
    #[arg(long, value_parser = positive)]
    pub light_radius: Option<f32>,
    /// Sets the most work that a frame may take, as a multiple of that of the library's default.
    #[arg(long, default_value_t = 1.0, value_parser = positive)]
    pub work: f32,
    /// Sets the width of the image in whose pixels errors are measured.
    #[arg(long, default_value_t = 480, value_parser = clap::value_parser!(u32).range(16..=1920))]
    pub width: u32,
    /// Sets its height.
    #[arg(long, default_value_t = 270, value_parser = clap::value_parser!(u32).range(16..=1200))]
    pub height: u32,
    /// Measures a third of the configurations and a quarter of the pixels.
    #[arg(long)]
    pub quick: bool,
    /// Sets the folder for table, chart and image.
    #[arg(long, default_value = "target/tune")]
    pub out: PathBuf,
}

impl Options {
    /// Returns width and height in pixels.
    pub fn picture_size(&self) -> [u32; 2] {
        let divisor = if self.quick { 2 } else { 1 };
        [self.width / divisor, self.height / divisor]
    }

    /// Returns how much work the truth may be.
    pub fn effort(&self) -> Effort {
        Effort {
            picture: self.picture_size(),
            disc_side: if self.quick { 16 } else { 24 },
            ring_rays: 12,
        }
    }
}

fn positive(text: &str) -> Result<f32, String> {
    let number = text.parse().ok();
    number
        .filter(|number: &f32| *number > 0.0 && number.is_finite())
        .ok_or_else(|| "must be a number above 0".to_owned())
}
