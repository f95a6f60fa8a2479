//! Measures every configuration in one scene.

use std::error::Error;
use std::path::Path;

use super::configuration::{Configuration, Method};
use super::error::{self, Band, Errors};
use super::floor::Floors;
use super::picture;
use super::pixels::{self, Effort, Pixel};
use super::prober::{Prober, Questions, Times};
use super::statistics::Spread;
use crate::gpu::Gpu;
use crate::library::{LibraryOptions, LibraryTechnique, SceneCasters};
use crate::scene::{Light, Scene};
use crate::technique::{Cost, Technique};
use crate::textbook::cube::{CubeFilter, CubeTechnique};
use crate::textbook::flat::FlatTechnique;
use crate::textbook::meshes::WorldMeshes;
use crate::truth::World;

/// Holds the results of one configuration in one scene.
#[derive(Clone, Debug)]
pub struct Sample {
    pub scene: &'static str,
    pub is_soft: bool,
    pub configuration: Configuration,
    pub errors: Errors,
    /// Is the least edge aliasing of the configuration's filter, in texels; NaN where it is not
    /// known.
    pub edge_floor_texels: f64,
    pub cost: Cost,
    /// Holds times as multiples of the textbook's, run by run.
    pub ratios: Ratios,
}

/// Holds times divided by that of [`Configuration::BASELINE`], run right before; NaN where nothing
/// was timed.
#[derive(Clone, Copy, Debug)]
pub struct Ratios {
    pub maps: Spread,
    pub lookups: Spread,
    pub total: Spread,
}

impl Ratios {
    const UNTIMED: Self = Self {
        maps: Spread::UNKNOWN,
        lookups: Spread::UNKNOWN,
        total: Spread::UNKNOWN,
    };
}

/// Holds the textbook, warmed up, and how often each technique is run next to it.
pub struct Stopwatch<'a> {
    baseline: Box<dyn Technique + 'a>,
    pub repeats: u32,
}

/// Holds a scene on the device, with the truth about what its camera sees: everything that its
/// measurements share.
pub struct Subject<'a> {
    gpu: &'a Gpu,
    scene: &'a Scene,
    casters: SceneCasters,
    meshes: WorldMeshes,
    pixels: Vec<Pixel>,
    questions: Questions,
    picture_size: [u32; 2],
}

impl<'a> Subject<'a> {
    /// Casts the rays of the truth.
    ///
    /// # Errors
    /// Returns an error where the camera sees nothing that faces the light.
    pub fn new(prober: &Prober<'a>, scene: &'a Scene, effort: &Effort) -> Result<Self, String> {
        let gpu = prober.gpu();
        let world = World::new(scene);
        let pixels = pixels::visible(scene, &world, effort);
        if pixels.is_empty() {
            return Err("the camera sees no surface that faces the light".to_owned());
        }
        let places: Vec<_> = pixels
            .iter()
            .map(|pixel| (pixel.position, pixel.normal))
            .collect();
        Ok(Self {
            gpu,
            scene,
            casters: SceneCasters::new(gpu, scene),
            meshes: WorldMeshes::new(gpu, scene),
            questions: prober.questions(&places, scene.origin),
            pixels,
            picture_size: effort.picture,
        })
    }

    /// Returns the pixels that are sampled: those that face the light.
    pub fn pixels(&self) -> &[Pixel] {
        &self.pixels
    }

    /// Returns errors and counts of one configuration, and times where there is a clock for them.
    pub fn measure(
        &self,
        prober: &mut Prober<'_>,
        configuration: &Configuration,
        floors: &Floors,
        stopwatch: Option<&mut Stopwatch<'_>>,
    ) -> Result<Sample, Box<dyn Error>> {
        let mut technique = self.technique(configuration)?;
        // The first run compiles and allocates, and its results are as good as any.
        prober.run(technique.as_mut(), &self.questions)?;
        let answers = prober.answers(&self.questions);
        let footprint = technique.footprint();
        let texel_world: Vec<_> = self
            .pixels
            .iter()
            .map(|pixel| footprint.texel_world(pixel.position))
            .collect();
        let band = Band {
            texels: technique.band_texels(),
            world: technique.band_world(),
        };
        Ok(Sample {
            scene: self.scene.name,
            is_soft: self.scene.light.is_soft(),
            configuration: *configuration,
            errors: error::compare(&self.pixels, &answers, &texel_world, band),
            edge_floor_texels: floors.get(configuration.floor_filter()).unwrap_or(f64::NAN),
            cost: technique.cost(),
            ratios: match stopwatch {
                Some(stopwatch) => self.ratios(prober, technique.as_mut(), stopwatch)?,
                None => Ratios::UNTIMED,
            },
        })
    }

    /// Returns the times of one configuration, each next to one of the textbook's.
    pub fn time(
        &self,
        prober: &mut Prober<'_>,
        configuration: &Configuration,
        stopwatch: &mut Stopwatch<'_>,
    ) -> Result<Ratios, Box<dyn Error>> {
        let mut technique = self.technique(configuration)?;
        prober.run(technique.as_mut(), &self.questions)?;
        self.ratios(prober, technique.as_mut(), stopwatch)
    }

    /// Returns a clock that repeats everything this often.
    pub fn stopwatch(
        &self,
        prober: &mut Prober<'_>,
        repeats: u32,
    ) -> Result<Stopwatch<'_>, Box<dyn Error>> {
        let mut baseline = self.technique(&Configuration::BASELINE)?;
        prober.run(baseline.as_mut(), &self.questions)?;
        Ok(Stopwatch { baseline, repeats })
    }

    /// Returns the times of a technique that has run before.
    fn ratios(
        &self,
        prober: &mut Prober<'_>,
        technique: &mut dyn Technique,
        stopwatch: &mut Stopwatch<'_>,
    ) -> Result<Ratios, Box<dyn Error>> {
        let baseline = stopwatch.baseline.as_mut();
        let mut pairs: Vec<[Times; 2]> = Vec::new();
        for _ in 0..stopwatch.repeats.max(1) {
            let before = prober.run(baseline, &self.questions)?;
            pairs.push([prober.run(technique, &self.questions)?, before]);
        }
        let ratio = |part: fn(&Times) -> f64| {
            Spread::of(pairs.iter().map(|[own, before]| part(own) / part(before)))
        };
        Ok(Ratios {
            maps: ratio(|times| times.maps),
            lookups: ratio(|times| times.lookups),
            total: ratio(Times::total),
        })
    }

    fn technique(
        &self,
        configuration: &Configuration,
    ) -> Result<Box<dyn Technique + '_>, Box<dyn Error>> {
        let (gpu, scene) = (self.gpu, self.scene);
        let map_size = configuration.map_size_for(&scene.light);
        let is_point = matches!(scene.light, Light::Point { .. });
        let cube = |filter| CubeTechnique::new(gpu, scene, &self.meshes, map_size, filter);
        Ok(match configuration.method {
            Method::Textbook if is_point => Box::new(cube(CubeFilter::Grid)),
            Method::Textbook => Box::new(FlatTechnique::new(gpu, scene, &self.meshes, map_size)),
            Method::TextbookStar => Box::new(cube(CubeFilter::Star)),
            Method::Library { filter, bias } => {
                let options = LibraryOptions {
                    filter,
                    bias,
                    map_size,
                    fits_camera: configuration.fits_camera,
                    layout: configuration.layout,
                };
                Box::new(LibraryTechnique::new(gpu, scene, &self.casters, options)?)
            }
        })
    }

    /// Writes images of the scene side by side: the truth, then the result of each configuration.
    pub fn write_picture(
        &self,
        prober: &mut Prober<'_>,
        path: &Path,
        configurations: &[Configuration],
    ) -> Result<(), Box<dyn Error>> {
        let truth = self.pixels.iter().map(|pixel| pixel.visibility as f32);
        let mut visibilities = vec![truth.collect()];
        for configuration in configurations {
            let mut technique = self.technique(configuration)?;
            prober.run(technique.as_mut(), &self.questions)?;
            visibilities.push(prober.answers(&self.questions));
        }
        picture::write(path, self.picture_size, &self.pixels, &visibilities)?;
        Ok(())
    }
}
