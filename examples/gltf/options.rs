//! Defines the command line.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, ValueEnum};
use shadow_support::gpu::GpuRequest;
use wgpu_shadows::{Bias, CascadeLayout, CascadeSplit, Filter};

/// Renders a glTF 2.0 file with shadows, offscreen, to a PNG.
#[derive(Parser, Debug)]
#[command(name = "gltf")]
pub struct Options {
    /// Names the .glb or .gltf file.
    pub file: PathBuf,
    /// Names the file for the image.
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// Names the file for visibility: 8-bit grey, one sample per pixel, of the file's first light.
    #[arg(long)]
    pub visibility: Option<PathBuf>,
    /// Names the file for the report, as JSON.
    #[arg(long)]
    pub report: Option<PathBuf>,
    /// Sets the size of the image in pixels.
    #[arg(long, default_value = "960x540", value_parser = size)]
    pub size: [u32; 2],
    /// Sets the texels per side of each shadow map, and of each face of a point light that is alone;
    /// spots share a map, and so do several points [default: 2048 for a sun, 1024 for a face, 4096
    /// for all spots and for all points]
    #[arg(long)]
    pub map_size: Option<u32>,
    /// Selects nearest, hardware, box, bilinear, tent3, tent5 or tent7; the gathered ones with an
    /// edge sharpness, as in tent3:3.
    #[arg(long, default_value = "tent3:3", value_parser = filter)]
    pub filter: Filter,
    /// Selects auto, normal-offset, or manual:CONSTANT,SLOPE in world units.
    #[arg(long, default_value = "auto", value_parser = bias)]
    pub bias: Bias,
    /// Sets the number of cascades of a directional light, 1 to 8, each with a map of its own.
    /// Without it one map is divided among cascades by predicted error.
    #[arg(long)]
    pub cascades: Option<u32>,
    /// Sets the depths along the view at which all cascades but the last end, as in 10,30,80;
    /// without it they have equal ratios.
    #[arg(long, value_delimiter = ',', num_args = 1..=7)]
    pub splits: Vec<f32>,
    /// Sets the distance along the view beyond which nothing is shadowed.
    #[arg(long, default_value_t = f32::INFINITY)]
    pub max_distance: f32,
    /// Sets the angular diameter of directional lights in radians, for soft shadows (the sun's is
    /// 0.0093).
    #[arg(long, value_parser = positive)]
    pub angular_diameter: Option<f32>,
    /// Sets the radius of spot and point lights in metres, for soft shadows.
    #[arg(long, value_parser = positive)]
    pub light_radius: Option<f32>,
    /// Omits shadows.
    #[arg(long)]
    pub no_shadows: bool,
    /// Selects wgpu's backend; without it the first that works is used.
    #[arg(long)]
    pub adapter: Option<Backend>,
    /// Sets the number of frames over which times are taken.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub frames: u32,
}

impl Options {
    /// Returns how texels are divided among cascades. A number of `--splits` that is not one fewer
    /// than `--cascades` is refused by the light.
    pub fn layout(&self) -> CascadeLayout<'_> {
        match (self.cascades, self.splits.as_slice()) {
            (None, []) => CascadeLayout::default(),
            (Some(cascades), []) => CascadeLayout::fixed(cascades),
            (cascades, ends) => CascadeLayout::Fixed {
                cascades: cascades.unwrap_or(ends.len() as u32 + 1),
                split: CascadeSplit::Explicit { ends },
            },
        }
    }

    /// Returns the filter of directional lights.
    pub fn sun_filter(&self) -> Filter {
        self.angular_diameter
            .map_or(self.filter, |light_size| Filter::Pcss { light_size })
    }

    /// Returns the filter of spot and point lights.
    pub fn local_filter(&self) -> Filter {
        self.light_radius
            .map_or(self.filter, |light_size| Filter::Pcss { light_size })
    }

    /// Returns what the device must have.
    pub fn gpu(&self) -> GpuRequest {
        let wanted = match self.adapter {
            Some(Backend::Vulkan) => wgpu::Backends::VULKAN,
            Some(Backend::Gl) => wgpu::Backends::GL,
            None => return GpuRequest::measuring(),
        };
        GpuRequest {
            backends: vec![wanted],
            ..GpuRequest::measuring()
        }
    }
}

/// Is a wgpu backend.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Backend {
    /// Uses Vulkan; on machines without a GPU, lavapipe.
    Vulkan,
    /// Uses OpenGL; on machines without a GPU, llvmpipe.
    Gl,
}

/// Returns the options, or the exit code after one line on stderr.
pub fn parse() -> Result<Options, ExitCode> {
    let options = Options::try_parse().map_err(|error| {
        if error.use_stderr() {
            let text = error.to_string();
            eprintln!("{}", text.lines().next().unwrap_or("error: bad arguments"));
            ExitCode::from(2)
        } else {
            print!("{error}");
            ExitCode::SUCCESS
        }
    })?;
    if options.out.is_none() && options.visibility.is_none() && options.report.is_none() {
        eprintln!("error: nothing to do: give --out, --visibility or --report");
        return Err(ExitCode::from(2));
    }
    Ok(options)
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let rule = "must be WIDTHxHEIGHT, each 1 to 16384";
    let (width, height) = text.split_once('x').ok_or(rule)?;
    let side = |text: &str| text.parse().ok().filter(|side| (1..=16384).contains(side));
    match (side(width), side(height)) {
        (Some(width), Some(height)) => Ok([width, height]),
        _ => Err(rule.to_owned()),
    }
}

fn positive(text: &str) -> Result<f32, String> {
    let number = text
        .parse()
        .ok()
        .filter(|n: &f32| *n > 0.0 && n.is_finite());
    number.ok_or_else(|| "must be a number above 0".to_owned())
}

fn filter(text: &str) -> Result<Filter, String> {
    let (name, sharpness) = match text.split_once(':') {
        None => (text, None),
        Some((name, sharpness)) => {
            let rule = "the sharpness must be a number of at least 1";
            let parsed = sharpness
                .parse::<f32>()
                .ok()
                .filter(|s| *s >= 1.0 && s.is_finite());
            (name, Some(parsed.ok_or(rule)?))
        }
    };
    let plain = sharpness.unwrap_or(1.0);
    match name {
        "nearest" | "hardware" | "box" if sharpness.is_some() => {
            Err(format!("{name} has no sharpness"))
        }
        "nearest" => Ok(Filter::Nearest),
        "hardware" => Ok(Filter::Hardware),
        "box" => Ok(Filter::Box),
        "bilinear" => Ok(Filter::Bilinear { sharpness: plain }),
        "tent3" => Ok(Filter::Tent3 { sharpness: plain }),
        "tent5" => Ok(Filter::Tent5 { sharpness: plain }),
        "tent7" => Ok(Filter::Tent7 { sharpness: plain }),
        _ => Err("must be nearest, hardware, box, bilinear, tent3, tent5 or tent7".to_owned()),
    }
}

fn bias(text: &str) -> Result<Bias, String> {
    let rule =
        "must be auto, normal-offset or manual:CONSTANT,SLOPE with two numbers of at least 0";
    match text {
        "auto" => return Ok(Bias::Auto),
        "normal-offset" => return Ok(Bias::NormalOffset),
        _ => {}
    }
    let numbers = text.strip_prefix("manual:").ok_or(rule)?;
    let (constant, slope) = numbers.split_once(',').ok_or(rule)?;
    let number = |text: &str| {
        text.trim()
            .parse::<f32>()
            .ok()
            .filter(|n| *n >= 0.0 && n.is_finite())
    };
    match (number(constant), number(slope)) {
        (Some(constant), Some(slope)) => Ok(Bias::Manual { constant, slope }),
        _ => Err(rule.to_owned()),
    }
}
