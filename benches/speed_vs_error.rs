//! Measures cost against error, and compares it with the shadow mapping of the tutorial at
//! learnopengl.com (here called the textbook) in the same run.
//!
//! `cargo bench --bench speed_vs_error` measures every filter, bias, map size and coverage over all
//! scenes; `cargo bench --bench speed_vs_error -- --quick` measures a subset. Tables go to standard
//! output; every number as CSV, and one chart and one image per scene, go to
//! `target/speed_vs_error`. Errors are those against rays cast in double precision through the
//! pixels of a camera. Times are multiples of the textbook's, measured right before: on a software
//! rasterizer no other time is meaningful. The run fails where the library's default, or another of
//! the configurations it recommends, is not on the Pareto front of work per frame against rmse.
//!
//! In scenes of many lamps, it compares pools with lights of equal maps at equal bytes;
//! `cargo bench --bench speed_vs_error -- --only-lamps` measures these scenes alone.
//!
//! `tests/support/src/measure/mod.rs` lists its parts.

mod lamps;

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

use clap::Parser;
use shadow_support::closed_form;
use shadow_support::gpu::{Gpu, GpuRequest};
use shadow_support::measure::chart::{self, Point, Words};
use shadow_support::measure::configuration::{self, Configuration, Extent};
use shadow_support::measure::floor::Floors;
use shadow_support::measure::overall::{self, Overall};
use shadow_support::measure::parallel;
use shadow_support::measure::pixels::Effort;
use shadow_support::measure::prober::Prober;
use shadow_support::measure::report;
use shadow_support::measure::subject::{Sample, Subject};
use shadow_support::scene::Scene;
use shadow_support::scenes;

/// Is the number of timed runs of every configuration.
const REPEATS: u32 = 2;

/// Measures the cost of shadows against their error, and compares both with the textbook's.
#[derive(Parser)]
struct Arguments {
    /// Measures fewer configurations, pixels and repetitions: two minutes instead of ten to fifteen
    /// on a software rasterizer.
    #[arg(long)]
    quick: bool,
    /// Measures only these scenes. (All others are left out of the means as well.)
    #[arg(long = "scene", value_name = "NAME")]
    scenes: Vec<String>,
    /// Sets the texels per side of a sun's map; spot lights and faces of point lights have half of
    /// that.
    #[arg(long, value_delimiter = ',', default_values_t = [512, 1024, 2048, 4096])]
    map_sizes: Vec<u32>,
    /// Sets the number of timed runs, each next to one of the textbook's, of what is on a scene's
    /// front, of the library's presets and of the textbook; everything else has 2. The default is
    /// 30, or 2 with --quick.
    #[arg(long)]
    repeats: Option<u32>,
    /// Sets the width of the images in pixels, 16:9. The default is 480, or 256 with --quick.
    #[arg(long)]
    width: Option<u32>,
    /// Prints every configuration of every scene, not only the front, the default and the textbook.
    #[arg(long)]
    all_rows: bool,
    /// Sets the folder for tables and charts.
    #[arg(long, default_value = concat!(env!("CARGO_MANIFEST_DIR"), "/target/speed_vs_error"))]
    output: PathBuf,
    /// Measures only the scenes of many lamps: a minute or two.
    #[arg(long)]
    only_lamps: bool,
    /// Is passed by `cargo bench`.
    #[arg(long, hide = true)]
    bench: bool,
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(Ok(praise)) => {
            println!("\nPASS: {praise}");
            ExitCode::SUCCESS
        }
        Ok(Err(blame)) => {
            println!("\nFAIL: {blame}");
            ExitCode::FAILURE
        }
        Err(error) => {
            eprintln!("speed_vs_error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Measures, prints and writes; the inner result is the judgement of the presets.
fn run(arguments: &Arguments) -> Result<Result<String, String>, Box<dyn Error>> {
    let start = Instant::now();
    let gpu = Gpu::new(&GpuRequest::measuring())?;
    println!("{}", gpu.describe());
    if gpu.is_software() {
        println!(
            "A software rasteriser: times are ratios of work done on the CPU, not of a GPU's."
        );
    }
    closed_form::check_ray_caster();
    for scene in lamps::all() {
        if arguments.only_lamps || arguments.scenes.is_empty() {
            lamps::measure(&gpu, &scene, effort(arguments).picture)?;
        }
    }
    if arguments.only_lamps {
        return Ok(Ok("measured the scenes of many lamps alone".to_owned()));
    }
    let extent = if arguments.quick {
        Extent::Quick
    } else {
        Extent::Full
    };
    let configurations = configuration::all(extent, &arguments.map_sizes);
    let floors = Floors::of(configurations.iter().map(Configuration::floor_filter));
    std::fs::create_dir_all(&arguments.output)?;
    let mut prober = Prober::new(&gpu);
    let mut samples: Vec<Sample> = Vec::new();
    for scene in chosen_scenes(&arguments.scenes)? {
        let own = measure_scene(&mut prober, &scene, &configurations, &floors, arguments)?;
        report::print_scene(&own, arguments.all_rows);
        chart_of_scene(arguments, &own)?;
        samples.extend(own);
    }
    let entries = overall::of(&samples);
    report::print_overall(&entries);
    charts_of_all(arguments, &entries)?;
    report::write_samples(&arguments.output.join("samples.csv"), &samples)?;
    report::write_overall(&arguments.output.join("overall.csv"), &entries)?;
    println!(
        "\n{} samples in {:.0} s; tables and charts in {}",
        samples.len(),
        start.elapsed().as_secs_f64(),
        arguments.output.display()
    );
    for sentence in overall::other_views(&entries).unwrap_or_default() {
        println!("{sentence}");
    }
    let broken = samples.iter().filter(|sample| sample.errors.non_finite > 0);
    let judgement = match broken.count() {
        0 => judge_presets(&entries),
        count => Err(format!("{count} samples hold answers that are no number")),
    };
    Ok(judgement)
}

/// Returns whether every configuration that the library recommends is on the overall front.
fn judge_presets(entries: &[Overall]) -> Result<String, String> {
    let judgements = Configuration::presets().map(|(name, preset)| {
        let with_name = |sentence| format!("{name}: {sentence}");
        overall::judge(entries, &preset)
            .map(with_name)
            .map_err(with_name)
    });
    let sentences: Result<Vec<_>, _> = judgements.into_iter().collect();
    Ok(sentences?.join("\n      "))
}

/// Measures everything about one scene: errors and counts of all configurations, and the times of
/// those that matter.
fn measure_scene(
    prober: &mut Prober<'_>,
    scene: &Scene,
    configurations: &[Configuration],
    floors: &Floors,
    arguments: &Arguments,
) -> Result<Vec<Sample>, Box<dyn Error>> {
    let subject = Subject::new(prober, scene, &effort(arguments))?;
    let picture = arguments.output.join(format!("{}.png", scene.name));
    let shown = [Configuration::shipped_default(), Configuration::BASELINE];
    subject.write_picture(prober, &picture, &shown)?;
    let suiting: Vec<_> = configurations
        .iter()
        .filter(|configuration| configuration.suits(&scene.light))
        .collect();
    let mut stopwatch = subject.stopwatch(prober, REPEATS)?;
    let bar = parallel::bar(scene.name, suiting.len());
    let mut samples = Vec::new();
    for configuration in suiting {
        samples.push(subject.measure(prober, configuration, floors, Some(&mut stopwatch))?);
        bar.inc(1);
    }
    bar.finish_and_clear();
    stopwatch.repeats = arguments
        .repeats
        .unwrap_or(if arguments.quick { REPEATS } else { 30 });
    if stopwatch.repeats > REPEATS {
        let front = report::front(&samples);
        let bar = parallel::bar(&format!("times of {}", scene.name), samples.len());
        for (sample, is_on_front) in samples.iter_mut().zip(front) {
            if is_on_front || is_named(&sample.configuration) {
                sample.ratios = subject.time(prober, &sample.configuration, &mut stopwatch)?;
            }
            bar.inc(1);
        }
        bar.finish_and_clear();
    }
    Ok(samples)
}

fn effort(arguments: &Arguments) -> Effort {
    let width = arguments
        .width
        .unwrap_or(if arguments.quick { 256 } else { 480 })
        .max(16);
    Effort {
        picture: [width, width * 9 / 16],
        disc_side: if arguments.quick { 16 } else { 32 },
        ring_rays: if arguments.quick { 12 } else { 24 },
    }
}

fn chosen_scenes(names: &[String]) -> Result<Vec<Scene>, String> {
    let mut scenes = scenes::all();
    if let Some(unknown) = names
        .iter()
        .find(|name| scenes.iter().all(|scene| scene.name != name.as_str()))
    {
        let known: Vec<_> = scenes.iter().map(|scene| scene.name).collect();
        return Err(format!(
            "no scene is called {unknown:?}; there are {}",
            known.join(", ")
        ));
    }
    scenes.retain(|scene| names.is_empty() || names.iter().any(|name| name == scene.name));
    Ok(scenes)
}

const COST_WORDS: &str = "texels cleared + lookup cycles of 1920×1080 pixels (RDNA 2)";

fn chart_of_scene(arguments: &Arguments, samples: &[Sample]) -> Result<(), Box<dyn Error>> {
    let Some(first) = samples.first() else {
        return Ok(());
    };
    let front = report::front(samples);
    let points: Vec<_> = samples
        .iter()
        .zip(front)
        .map(|(sample, is_on_front)| {
            point(
                &sample.configuration,
                [sample.cost.frame_work(), sample.errors.rmse],
                is_on_front,
            )
        })
        .collect();
    let words = Words {
        title: &format!("Scene \"{}\": error against cost", first.scene),
        cost: COST_WORDS,
        error: "root of mean squared error of the visibility",
    };
    let path = arguments.output.join(format!("{}.svg", first.scene));
    chart::draw(&path, &words, &points)
}

fn charts_of_all(arguments: &Arguments, entries: &[Overall]) -> Result<(), Box<dyn Error>> {
    let error = "root of mean squared error of the visibility, mean over scenes";
    let points: Vec<_> = entries
        .iter()
        .map(|entry| {
            point(
                &entry.configuration,
                [entry.cost, entry.rmse],
                entry.is_on_front,
            )
        })
        .collect();
    let words = Words {
        title: "All scenes with hard shadows: error against cost",
        cost: COST_WORDS,
        error,
    };
    chart::draw(&arguments.output.join("overall.svg"), &words, &points)?;
    let costs: Vec<_> = entries
        .iter()
        .map(|entry| [entry.time_ratio, entry.rmse])
        .collect();
    let front = shadow_support::measure::pareto::front(&costs);
    let points: Vec<_> = entries
        .iter()
        .zip(costs)
        .zip(front)
        .map(|((entry, place), is_on_front)| point(&entry.configuration, place, is_on_front))
        .collect();
    let words = Words {
        title: "All scenes with hard shadows: error against time",
        cost: "time as a multiple of the textbook's with 1024 texels a side",
        error,
    };
    chart::draw(&arguments.output.join("overall_time.svg"), &words, &points)
}

/// Returns whether a configuration is timed whether it is on a front or not.
fn is_named(configuration: &Configuration) -> bool {
    configuration.preset_name().is_some() || *configuration == Configuration::BASELINE
}

fn point(configuration: &Configuration, [cost, error]: [f64; 2], is_on_front: bool) -> Point {
    let is_default = *configuration == Configuration::shipped_default();
    let label = match configuration.preset_name() {
        Some(name) => format!("{name}: {configuration}"),
        None => configuration.to_string(),
    };
    let has_label = is_on_front || is_named(configuration);
    Point {
        cost,
        error,
        series: configuration.series(),
        family: configuration.family(),
        mark: configuration.mark(),
        label: has_label.then_some(label),
        is_on_front,
        is_default,
    }
}
