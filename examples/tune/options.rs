//! The command line.

use std::path::PathBuf;

use clap::Parser;

use crate::support::pixels::Effort;

/// Finds the shadow settings that suit a scene: errors against ray-traced truth, costs, and the descriptor to paste.
#[derive(Parser, Debug)]
#[command(name = "tune")]
pub struct Options {
    /// A .glb or .gltf file; boxes under a sun without one.
    pub file: Option<PathBuf>,
    /// Which of the file's lights, in the order of its nodes, counted from 0.
    #[arg(long, default_value_t = 0)]
    pub light: usize,
    /// Which of the file's cameras, in the order of its nodes, counted from 0; one is made up for a file that has none.
    #[arg(long, default_value_t = 0)]
    pub camera: usize,
    /// Angular diameter of a sun in radians, for soft shadows (the sun's is 0.0093).
    #[arg(long, value_parser = positive)]
    pub angular_diameter: Option<f32>,
    /// Radius of a spot or point light in the file's units, for soft shadows.
    #[arg(long, value_parser = positive)]
    pub light_radius: Option<f32>,
    /// Most work that a frame may take, as a multiple of that of the library's default.
    #[arg(long, default_value_t = 1.0, value_parser = positive)]
    pub work: f32,
    /// Width of the picture in whose pixels errors are measured.
    #[arg(long, default_value_t = 480, value_parser = clap::value_parser!(u32).range(16..=1920))]
    pub width: u32,
    /// Its height.
    #[arg(long, default_value_t = 270, value_parser = clap::value_parser!(u32).range(16..=1200))]
    pub height: u32,
    /// A third of the configurations and a quarter of the pixels.
    #[arg(long)]
    pub quick: bool,
    /// Folder for table, chart and picture.
    #[arg(long, default_value = "target/tune")]
    pub out: PathBuf,
}

impl Options {
    /// Width and height in pixels.
    pub fn picture_size(&self) -> [u32; 2] {
        let divisor = if self.quick { 2 } else { 1 };
        [self.width / divisor, self.height / divisor]
    }

    /// How much work the truth may be.
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
