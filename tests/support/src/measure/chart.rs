//! Draws scatter charts of cost against error, with logarithmic axes and named points.

use std::error::Error;
use std::path::Path;

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

const SIZE: (u32, u32) = (1280, 860);
const FONT: &str = "sans-serif";
const LABEL_HEIGHT: i32 = 15;
/// Is the mean width of a letter, for keeping labels apart.
const LETTER_WIDTH: f64 = 6.6;

type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;

/// Is a configuration in a chart.
pub struct Point {
    pub cost: f64,
    pub error: f64,
    /// Is the name of its series; points of one series are joined.
    pub series: String,
    /// Selects its colour and entry of the legend.
    pub family: String,
    pub mark: Mark,
    /// Is the label beside it, if it has one.
    pub label: Option<String>,
    pub is_on_front: bool,
    pub is_default: bool,
}

/// Is the shape of a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// Marks a derived bias, fitted to the camera.
    Circle,
    /// Marks a derived bias over the whole scene.
    Square,
    /// Marks another bias.
    Triangle,
    /// Marks the textbook.
    Cross,
}

/// Holds the texts around the points of a chart.
pub struct Words<'a> {
    pub title: &'a str,
    pub cost: &'a str,
    pub error: &'a str,
}

/// Draws a chart into an SVG file.
pub fn draw(path: &Path, words: &Words<'_>, points: &[Point]) -> Result<(), Box<dyn Error>> {
    let finite = points
        .iter()
        .filter(|point| point.cost > 0.0 && point.error > 0.0);
    let points: Vec<&Point> = finite.collect();
    if points.is_empty() {
        return Ok(());
    }
    let costs = range(points.iter().map(|point| point.cost), 1.35);
    let errors = range(points.iter().map(|point| point.error), 1.25);
    let root = SVGBackend::new(path, SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let (plot_area, legend_area) = root.split_horizontally(960);
    let mut chart = ChartBuilder::on(&plot_area)
        .caption(words.title, (FONT, 20))
        .margin(14)
        .x_label_area_size(46)
        .y_label_area_size(74)
        .build_cartesian_2d(
            (costs.0..costs.1).log_scale().with_key_points(ticks(costs)),
            (errors.0..errors.1)
                .log_scale()
                .with_key_points(ticks(errors)),
        )?;
    chart
        .configure_mesh()
        .x_desc(words.cost)
        .y_desc(words.error)
        .axis_desc_style((FONT, 16))
        .label_style((FONT, 14))
        .light_line_style(WHITE.mix(0.0))
        .bold_line_style(RGBColor(215, 215, 215))
        .x_label_formatter(&|value| short(*value))
        .y_label_formatter(&|value| short(*value))
        .draw()?;
    chart.draw_series(LineSeries::new(
        stairs(&points),
        BLACK.mix(0.35).stroke_width(2),
    ))?;
    let families = names(points.iter().map(|point| &point.family));
    for series in names(points.iter().map(|point| &point.series)) {
        let own: Vec<_> = points
            .iter()
            .filter(|point| point.series == series)
            .collect();
        let color = color(&own[0].family, &families);
        chart.draw_series(LineSeries::new(
            own.iter().map(|point| (point.cost, point.error)),
            color.mix(0.3).stroke_width(1),
        ))?;
    }
    let places: Vec<_> = points
        .iter()
        .map(|point| chart.backend_coord(&(point.cost, point.error)))
        .collect();
    drop(chart);
    for (point, &place) in points.iter().zip(&places) {
        let color = color(&point.family, &families);
        draw_mark(&root, place, point.mark, color, point.is_on_front)?;
        if point.is_default {
            root.draw(&Circle::new(place, 10, RED.stroke_width(2)))?;
        }
    }
    draw_labels(&root, &points, &places)?;
    draw_legend(&legend_area, &families, &points)?;
    root.present()?;
    Ok(())
}

/// Draws labels beside their points, each where it covers the least.
fn draw_labels(
    root: &Area<'_>,
    points: &[&Point],
    places: &[(i32, i32)],
) -> Result<(), Box<dyn Error>> {
    // Points are entered first, so that labels avoid them.
    let mut taken: Vec<[i32; 4]> = places
        .iter()
        .map(|&(x, y)| [x - 5, y - 5, x + 5, y + 5])
        .collect();
    for (point, &(x, y)) in points.iter().zip(places) {
        let Some(label) = &point.label else { continue };
        let width = (label.chars().count() as f64 * LETTER_WIDTH) as i32;
        let beside = [8, -8 - width, -width / 2];
        let levels = [0, -16, 16, -32, 32, -48, 48, -64, 64, -80, 80];
        let boxes = levels.iter().flat_map(|level| {
            beside.iter().map(move |aside| {
                let (left, top) = (x + aside, y + level - LABEL_HEIGHT / 2);
                [left, top, left + width, top + LABEL_HEIGHT]
            })
        });
        let best = boxes
            .filter(|place| place[0] > 90 && place[2] < 955 && place[1] > 40 && place[3] < 796)
            .min_by_key(|place| {
                let covered: i32 = taken.iter().map(|other| overlap(place, other)).sum();
                let away = (place[1] + LABEL_HEIGHT / 2 - y).abs();
                covered * 10 + away
            });
        let Some(place) = best else { continue };
        let middle_y = (place[1] + place[3]) / 2;
        if (middle_y - y).abs() > LABEL_HEIGHT {
            let near_x = x.clamp(place[0], place[2]);
            let line = vec![(x, y), (near_x, middle_y)];
            root.draw(&PathElement::new(line, BLACK.mix(0.3)))?;
        }
        let ink = if point.is_default { RED } else { BLACK };
        let style = TextStyle::from((FONT, 13).into_font())
            .pos(Pos::new(HPos::Left, VPos::Center))
            .color(&ink);
        root.draw(&Text::new(label.clone(), (place[0], middle_y), style))?;
        taken.push(place);
    }
    Ok(())
}

fn draw_legend(
    area: &Area<'_>,
    families: &[String],
    points: &[&Point],
) -> Result<(), Box<dyn Error>> {
    let style = TextStyle::from((FONT, 14).into_font()).pos(Pos::new(HPos::Left, VPos::Center));
    let mut y = 50;
    let mut entry = |mark: Mark, color: RGBColor, words: &str| {
        draw_mark(area, (14, y), mark, color, false)?;
        area.draw(&Text::new(words.to_owned(), (30, y), style.clone()))?;
        y += 22;
        Ok::<_, Box<dyn Error>>(())
    };
    for family in families {
        let mark = if family == "textbook" {
            Mark::Cross
        } else {
            Mark::Circle
        };
        entry(mark, color(family, families), family)?;
    }
    // Where all marks are circles, their shape distinguishes nothing.
    let plain = [Mark::Circle, Mark::Cross];
    if !points.iter().all(|point| plain.contains(&point.mark)) {
        entry(Mark::Circle, BLACK, "derived bias, map fits the camera")?;
        entry(Mark::Square, BLACK, "derived bias, map of the whole scene")?;
        entry(Mark::Triangle, BLACK, "another bias")?;
    }
    let notes = [
        "Lines join map sizes.",
        "Filled, and on the grey line:",
        "nothing else is both cheaper",
        "and closer to the truth.",
        "Red ring: the default.",
    ];
    for (index, note) in notes.iter().enumerate() {
        area.draw(&Text::new(*note, (8, y + 20 * index as i32), style.clone()))?;
    }
    Ok(())
}

/// Draws a mark at a position, filled or in outline.
fn draw_mark(
    area: &Area<'_>,
    (x, y): (i32, i32),
    mark: Mark,
    color: RGBColor,
    is_filled: bool,
) -> Result<(), Box<dyn Error>> {
    let style = if is_filled {
        color.filled()
    } else {
        color.stroke_width(1)
    };
    match mark {
        Mark::Circle => area.draw(&Circle::new((x, y), 5, style))?,
        Mark::Triangle => {
            let corners = [(x, y - 6), (x + 6, y + 5), (x - 6, y + 5), (x, y - 6)];
            if is_filled {
                area.draw(&Polygon::new(corners, color.filled()))?;
            }
            area.draw(&PathElement::new(corners, color))?;
        }
        Mark::Cross => area.draw(&Cross::new((x, y), 5, color.stroke_width(2)))?,
        Mark::Square => area.draw(&Rectangle::new([(x - 4, y - 4), (x + 5, y + 5)], style))?,
    }
    Ok(())
}

/// Returns the front as the lower left border of all configurations that it dominates.
fn stairs(points: &[&Point]) -> Vec<(f64, f64)> {
    let mut front: Vec<_> = points
        .iter()
        .filter(|point| point.is_on_front)
        .map(|point| (point.cost, point.error))
        .collect();
    front.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut line: Vec<(f64, f64)> = Vec::new();
    for (cost, error) in front {
        if let Some(&(_, above)) = line.last() {
            line.push((cost, above));
        }
        line.push((cost, error));
    }
    line
}

/// Returns each name once, in order.
fn names<'a>(all: impl Iterator<Item = &'a String>) -> Vec<String> {
    all.fold(Vec::new(), |mut names, name| {
        if !names.contains(name) {
            names.push(name.clone());
        }
        names
    })
}

/// Returns hues around the circle, alternately light and dark; black for the textbook.
fn color(family: &str, families: &[String]) -> RGBColor {
    if family == "textbook" {
        return BLACK;
    }
    let index = families.iter().position(|other| other == family);
    let index = index.unwrap_or_default();
    let hue = index as f64 / families.len() as f64;
    let lightness = if index % 2 == 0 { 0.34 } else { 0.48 };
    let (r, g, b) = HSLColor(hue, 0.85, lightness).rgb();
    RGBColor(r, g, b)
}

/// Returns the least and the greatest of positive numbers, with room around them.
fn range(values: impl Iterator<Item = f64>, room: f64) -> (f64, f64) {
    let (least, greatest) = values.fold((f64::INFINITY, 0.0f64), |(least, greatest), value| {
        (least.min(value), greatest.max(value))
    });
    (least / room, greatest * room)
}

/// Returns round numbers for a logarithmic axis.
fn ticks((least, greatest): (f64, f64)) -> Vec<f64> {
    let digits: &[f64] = if greatest / least < 30.0 {
        &[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0]
    } else {
        &[1.0, 2.0, 5.0]
    };
    let decades = least.log10().floor() as i32..=greatest.log10().ceil() as i32;
    decades
        .flat_map(|decade| digits.iter().map(move |digit| digit * 10f64.powi(decade)))
        .filter(|tick| (least..=greatest).contains(tick))
        .collect()
}

fn overlap(a: &[i32; 4], b: &[i32; 4]) -> i32 {
    let across = (a[2].min(b[2]) - a[0].max(b[0])).max(0);
    let down = (a[3].min(b[3]) - a[1].max(b[1])).max(0);
    across * down
}

/// Formats two significant digits, and a power of ten where that is shorter.
fn short(value: f64) -> String {
    if (1e-3..1e4).contains(&value) {
        let text = format!("{value:.4}");
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        format!("{value:.1e}").replace(".0e", "e")
    }
}
