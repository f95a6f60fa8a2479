//! One scene, every configuration.

use std::path::Path;

use super::configuration::{Configuration, Method};
use super::error::{self, Band, Errors};
use super::floor::Floors;
use super::gpu::Gpu;
use super::library::{LibraryOptions, LibraryTechnique, SceneCasters};
use super::parallel;
use super::picture;
use super::pixels::{self, Effort, Pixel};
use super::probe::{Prober, Questions, Times};
use super::scene::{Light, Scene};
use super::statistics::Spread;
use super::technique::{Cost, Technique};
use super::textbook::cube::{CubeFilter, CubeTechnique};
use super::textbook::flat::FlatTechnique;
use super::textbook::meshes::WorldMeshes;
use super::truth::World;

/// What one configuration did in one scene.
#[derive(Clone, Debug)]
pub struct Sample {
    pub scene: &'static str,
    pub is_soft: bool,
    pub configuration: Configuration,
    pub errors: Errors,
    /// The least edge aliasing of the configuration's filter, in texels.
    pub edge_floor_texels: f64,
    pub cost: Cost,
    /// Times as multiples of the textbook's, run by run.
    pub ratios: Ratios,
}

/// Time divided by that of [`Configuration::BASELINE`], run right before.
#[derive(Clone, Copy, Debug)]
pub struct Ratios {
    pub maps: Spread,
    pub lookups: Spread,
    pub total: Spread,
}

/// What is measured, the same for all scenes.
pub struct Settings<'a> {
    pub configurations: &'a [Configuration],
    pub effort: Effort,
    pub floors: Floors,
    /// Timed runs of each configuration, each after one of the textbook's.
    pub repeats: u32,
    /// For pictures.
    pub folder: &'a Path,
}

/// Everything that the measurements of a scene share.
struct Bench<'a> {
    gpu: &'a Gpu,
    scene: &'a Scene,
    casters: SceneCasters,
    meshes: WorldMeshes,
    pixels: Vec<Pixel>,
    questions: Questions,
}

/// Measures all configurations that suit the scene's light.
pub fn scene(
    gpu: &Gpu,
    prober: &mut Prober<'_>,
    scene: &Scene,
    settings: &Settings<'_>,
) -> Result<Vec<Sample>, Box<dyn std::error::Error>> {
    let world = World::new(scene);
    let pixels = pixels::visible(scene, &world, &settings.effort);
    let places: Vec<_> = pixels
        .iter()
        .map(|pixel| (pixel.position, pixel.normal))
        .collect();
    let bench = Bench {
        gpu,
        scene,
        casters: SceneCasters::new(gpu, scene),
        meshes: WorldMeshes::new(gpu, scene),
        questions: prober.questions(&places, scene.origin),
        pixels,
    };
    write_picture(&bench, prober, &settings.effort, settings.folder)?;
    let mut baseline = bench.technique(&Configuration::BASELINE)?;
    let suiting: Vec<_> = settings
        .configurations
        .iter()
        .filter(|configuration| configuration.suits(&scene.light))
        .collect();
    let bar = parallel::bar(scene.name, suiting.len());
    let mut samples = Vec::new();
    for configuration in suiting {
        samples.push(bench.measure(prober, configuration, baseline.as_mut(), settings)?);
        bar.inc(1);
    }
    bar.finish_and_clear();
    Ok(samples)
}

impl Bench<'_> {
    fn measure(
        &self,
        prober: &mut Prober<'_>,
        configuration: &Configuration,
        baseline: &mut dyn Technique,
        settings: &Settings<'_>,
    ) -> Result<Sample, Box<dyn std::error::Error>> {
        let mut technique = self.technique(configuration)?;
        // The first run compiles and allocates, and its answers are as good as any.
        prober.run(technique.as_mut(), &self.questions);
        let answers = prober.answers(&self.questions);
        let pairs: Vec<[Times; 2]> = (0..settings.repeats)
            .map(|_| {
                let before = prober.run(baseline, &self.questions);
                [prober.run(technique.as_mut(), &self.questions), before]
            })
            .collect();
        let ratio = |part: fn(&Times) -> f64| {
            Spread::of(pairs.iter().map(|[own, before]| part(own) / part(before)))
        };
        let footprint = technique.footprint();
        let texel_world: Vec<_> = self
            .pixels
            .iter()
            .map(|pixel| footprint.texel_world(pixel.position))
            .collect();
        Ok(Sample {
            scene: self.scene.name,
            is_soft: self.scene.light.is_soft(),
            configuration: *configuration,
            errors: error::compare(
                &self.pixels,
                &answers,
                &texel_world,
                Band {
                    texels: technique.band_texels(),
                    world: technique.band_world(),
                },
            ),
            edge_floor_texels: settings
                .floors
                .get(configuration.floor_filter())
                .unwrap_or(f64::NAN),
            cost: technique.cost(),
            ratios: Ratios {
                maps: ratio(|times| times.maps),
                lookups: ratio(|times| times.lookups),
                total: ratio(Times::total),
            },
        })
    }

    fn technique(
        &self,
        configuration: &Configuration,
    ) -> Result<Box<dyn Technique + '_>, Box<dyn std::error::Error>> {
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
                };
                Box::new(LibraryTechnique::new(gpu, scene, &self.casters, options)?)
            }
        })
    }
}

/// Pictures of the scene side by side: the truth, the library's default, the textbook.
fn write_picture(
    bench: &Bench<'_>,
    prober: &mut Prober<'_>,
    effort: &Effort,
    folder: &Path,
) -> Result<(), Box<dyn std::error::Error>> {
    let truth = bench.pixels.iter().map(|pixel| pixel.visibility as f32);
    let mut visibilities = vec![truth.collect()];
    for configuration in [Configuration::shipped_default(), Configuration::BASELINE] {
        let mut technique = bench.technique(&configuration)?;
        prober.run(technique.as_mut(), &bench.questions);
        visibilities.push(prober.answers(&bench.questions));
    }
    let path = folder.join(format!("{}.png", bench.scene.name));
    picture::write(&path, effort.picture, &bench.pixels, &visibilities)?;
    Ok(())
}
