//! Shows all configurations: a table of those that matter, all of them as CSV, a chart, and an
//! image.

use std::error::Error;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use shadow_support::lookup_cost::most_cascades;
use shadow_support::measure::chart::{self, Point, Words};
use shadow_support::measure::configuration::Configuration;
use shadow_support::measure::prober::Prober;
use shadow_support::measure::report;
use shadow_support::measure::subject::{Sample, Subject};
use shadow_support::scene::Light;
use wgpu_shadows::CascadeLayout;

use crate::choice::Choice;

/// Prints what the errors are measured over.
pub fn print_pixels(subject: &Subject<'_>, [width, height]: [u32; 2]) {
    let pixels = subject.pixels();
    let dark: f64 = pixels.iter().map(|pixel| 1.0 - pixel.visibility).sum();
    println!(
        "{} of {width}x{height} pixels show a surface that faces the light; {:.1} % of them are in shadow",
        pixels.len(),
        100.0 * dark / pixels.len() as f64
    );
    if dark == 0.0 {
        println!("note: no shadow is in sight, so only false shadows count");
    }
}

/// Holds samples with their names.
pub struct Table<'a> {
    rows: Vec<Row<'a>>,
    choice: &'a Choice<'a>,
}

struct Row<'a> {
    sample: &'a Sample,
    name: String,
    map_size: u32,
    is_on_front: bool,
}

impl<'a> Table<'a> {
    pub fn new(samples: &'a [Sample], choice: &'a Choice<'a>, light: &Light) -> Self {
        let rows = samples.iter().zip(report::front(samples));
        let mut rows: Vec<_> = rows
            .map(|(sample, is_on_front)| Row {
                sample,
                name: name(&sample.configuration, light),
                map_size: sample.configuration.map_size_for(light),
                is_on_front,
            })
            .collect();
        rows.sort_by(|a, b| {
            let work = |row: &Row<'_>| row.sample.cost.frame_work();
            work(a).total_cmp(&work(b))
        });
        Self { rows, choice }
    }

    /// Prints the front, the tutorial's method, and what is compared with them, cheapest first.
    pub fn print(&self) {
        println!(
            "\n  {:40} {:>6} {:>7} {:>7} {:>7} {:>6} {:>6} {:>6}",
            "", "rmse", "acne %", "leak %", "Mtexel", "cycles", "work", "time"
        );
        let unit = self.choice.default.cost.frame_work();
        for row in &self.rows {
            let remark = self.remark(row);
            let is_textbook = row.sample.configuration.is_textbook();
            if !row.is_on_front && remark.is_empty() && !is_textbook {
                continue;
            }
            let (errors, cost) = (&row.sample.errors, &row.sample.cost);
            println!(
                "{} {:40} {:6.4} {:7.3} {:7.3} {:7.2} {:6.1} {:6.2} {:6.2}{remark}",
                if row.is_on_front { '*' } else { ' ' },
                row.name,
                errors.rmse,
                errors.false_shadow_percent,
                errors.contact_light_percent + errors.deep_light_percent,
                cost.texels_cleared as f64 * 1e-6,
                cost.lookup_cycles,
                cost.frame_work() / unit,
                row.sample.ratios.total.median,
            );
        }
        println!(
            "\n* the Pareto front: nothing is both less work and closer to the truth\n\
             rmse: of visibility, over all pixels; acne: false shadow away from edges; leak: false light away from edges\n\
             cycles: of a pixel's lookup on an RDNA 2 SIMD, by its compiler\n\
             work: texels cleared and those cycles of 1920x1080 pixels, 1 for the default\n\
             time: of maps and lookups, as a multiple of the textbook's with a map of 1024"
        );
    }

    fn remark(&self, row: &Row<'_>) -> &'static str {
        let is = |other: &Sample| row.sample.configuration == other.configuration;
        let (default, chosen) = (is(self.choice.default), is(self.choice.within_work));
        match (default, chosen, is(self.choice.accurate)) {
            (true, true, _) => "  <- chosen, the default",
            (true, false, _) => "  <- the default",
            (false, true, _) => "  <- chosen",
            (false, false, true) => "  <- accurate",
            _ => "",
        }
    }

    /// Writes table, chart and image into a folder that exists.
    pub fn write(
        &self,
        folder: &Path,
        subject: &Subject<'_>,
        prober: &mut Prober<'_>,
    ) -> Result<(), Box<dyn Error>> {
        let at = |name: &str| folder.join(name);
        fs::write(at("table.csv"), self.csv())
            .map_err(|error| format!("cannot write to {}: {error}", folder.display()))?;
        chart::draw(&at("chart.svg"), &WORDS, &self.points())?;
        let shown = [self.choice.default, self.choice.within_work];
        let shown = shown.map(|sample| sample.configuration);
        subject.write_picture(prober, &at("picture.png"), &shown)?;
        println!(
            "\nAll configurations: {}; as a chart: {}; truth, default and chosen side by side: {}",
            at("table.csv").display(),
            at("chart.svg").display(),
            at("picture.png").display()
        );
        Ok(())
    }

    fn csv(&self) -> String {
        let mut text = String::from(
            "filter,map_size,layout,rmse,false_shadow_percent,false_light_percent,texels_cleared,lookup_cycles,\
             frame_work,bytes,time_ratio,on_front\n",
        );
        for row in &self.rows {
            let Sample {
                configuration,
                errors,
                cost,
                ratios,
                ..
            } = row.sample;
            let _ = writeln!(
                text,
                "{},{},{},{},{},{},{},{},{},{},{},{}",
                configuration.family(),
                row.map_size,
                layout_name(configuration.layout),
                errors.rmse,
                errors.false_shadow_percent,
                errors.contact_light_percent + errors.deep_light_percent,
                cost.texels_cleared,
                cost.lookup_cycles,
                cost.frame_work(),
                cost.bytes,
                ratios.total.median,
                row.is_on_front
            );
        }
        text
    }

    fn points(&self) -> Vec<Point> {
        let point = |row: &Row<'_>| {
            let configuration = &row.sample.configuration;
            let remark = self.remark(row);
            let is_named = row.is_on_front || !remark.is_empty();
            let layout = layout_name(configuration.layout);
            Point {
                cost: row.sample.cost.frame_work(),
                error: row.sample.errors.rmse,
                series: format!("{} {layout}", configuration.family()),
                family: configuration.family(),
                mark: configuration.mark(),
                label: is_named.then(|| format!("{}{remark}", row.name)),
                is_on_front: row.is_on_front,
                is_default: remark.ends_with("default"),
            }
        };
        self.rows.iter().map(point).collect()
    }
}

const WORDS: Words<'_> = Words {
    title: "Error against cost",
    cost: "texels cleared + lookup cycles of 1920×1080 pixels",
    error: "root of mean squared error of the visibility",
};

/// Returns a name such as "2 cascades", or "at most 4 cascades" where the layout is found.
fn layout_name(layout: CascadeLayout<'_>) -> String {
    match layout {
        CascadeLayout::Automatic { max_cascades } => format!("at most {max_cascades} cascades"),
        CascadeLayout::Fixed { cascades: 1, .. } => "1 cascade".to_owned(),
        _ => format!("{} cascades", most_cascades(layout)),
    }
}

/// Returns a name such as "tent 3x3 sharp 3, 2048, 2 cascades", without cascades where none apply.
fn name(configuration: &Configuration, light: &Light) -> String {
    let family = configuration.family();
    let map_size = configuration.map_size_for(light);
    match light {
        Light::Sun { .. } if !configuration.is_textbook() => {
            format!(
                "{family}, {map_size}, {}",
                layout_name(configuration.layout)
            )
        }
        _ => format!("{family}, {map_size}"),
    }
}
