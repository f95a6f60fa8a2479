//! Prints tables on standard output, and writes every number to files.

use std::fmt::Write as _;
use std::fs;
use std::io;
use std::path::Path;

use super::overall::Overall;
use super::pareto;
use super::subject::Sample;

/// Prints what matters of a scene: its front, the default, and the textbook; or everything.
pub fn print_scene(samples: &[Sample], all_rows: bool) {
    let Some(first) = samples.first() else { return };
    println!(
        "\n{} ({}; * on the front of work per frame against rmse)",
        first.scene,
        if first.is_soft {
            "light with extent"
        } else {
            "hard shadows"
        }
    );
    println!(
        "  {:44} {:>7} {:>7} {:>7} {:>7} {:>6} {:>7} {:>11} {:>6} {:>6} {:>5} {:>8} {:>12}",
        "",
        "rmse",
        "wrong%",
        "acne%",
        "contact%",
        "reach",
        "deep%",
        "edge/floor",
        "shift",
        "penum.",
        "cycles",
        "Mtexel",
        "time ratio"
    );
    let front = front(samples);
    let mut rows: Vec<_> = samples.iter().zip(front).collect();
    rows.sort_by(|(a, _), (b, _)| a.errors.rmse.total_cmp(&b.errors.rmse));
    for (sample, is_on_front) in rows {
        let configuration = &sample.configuration;
        let always =
            is_on_front || configuration.is_textbook() || configuration.preset_name().is_some();
        if !(always || all_rows) {
            continue;
        }
        let (errors, cost, time) = (&sample.errors, &sample.cost, &sample.ratios.total);
        let penumbra = if errors.penumbra_rmse.is_nan() {
            "-".to_owned()
        } else {
            format!("{:.3}", errors.penumbra_rmse)
        };
        println!(
            "{} {:44} {:7.4} {:7.3} {:7.3} {:8.3} {:6.1} {:7.3} {:5.2}/{:5.2} {:6.2} {:>6} {:5.1} {:8.2} {:5.2} ({:.2}-{:.2}){}",
            if is_on_front { '*' } else { ' ' },
            configuration.to_string(),
            errors.rmse,
            errors.misclassified_percent,
            errors.false_shadow_percent,
            errors.contact_light_percent,
            errors.contact_reach_texels,
            errors.deep_light_percent,
            errors.edge_aliasing_texels,
            sample.edge_floor_texels,
            errors.edge_shift_texels,
            penumbra,
            cost.lookup_cycles,
            cost.texels_allocated as f64 * 1e-6,
            time.median,
            time.lower_quartile,
            time.upper_quartile,
            if errors.non_finite > 0 {
                format!("  {} NOT FINITE", errors.non_finite)
            } else {
                String::new()
            },
        );
    }
}

/// Returns which samples of one scene are on its front.
pub fn front(samples: &[Sample]) -> Vec<bool> {
    let costs: Vec<_> = samples
        .iter()
        .map(|sample| [sample.cost.frame_work(), sample.errors.rmse])
        .collect();
    pareto::front(&costs)
}

/// Prints the means over all scenes with hard shadows, best first.
pub fn print_overall(entries: &[Overall]) {
    println!(
        "\nall scenes with hard shadows (means; * on the front of work per frame against rmse)"
    );
    println!(
        "  {:44} {:>7} {:>7} {:>7} {:>7} {:>6} {:>8} {:>10} {:>10}",
        "", "rmse", "wrong%", "acne%", "leak%", "cycles", "Mtexel", "cost", "time ratio"
    );
    let mut rows: Vec<_> = entries.iter().collect();
    rows.sort_by(|a, b| a.rmse.total_cmp(&b.rmse));
    for entry in rows {
        println!(
            "{} {:44} {:7.4} {:7.3} {:7.3} {:7.3} {:6.1} {:8.2} {:10.3e} {:10.2}{}",
            if entry.is_on_front { '*' } else { ' ' },
            entry.configuration.to_string(),
            entry.rmse,
            entry.misclassified_percent,
            entry.false_shadow_percent,
            entry.false_light_percent,
            entry.lookup_cycles,
            entry.texels * 1e-6,
            entry.cost,
            entry.time_ratio,
            entry
                .configuration
                .preset_name()
                .map_or_else(String::new, |name| format!("  <- {name}")),
        );
    }
}

/// Writes every number of every sample.
pub fn write_samples(path: &Path, samples: &[Sample]) -> io::Result<()> {
    let mut text = String::from(
        "scene,configuration,map_size,fits_camera,rmse,misclassified_percent,false_shadow_percent,contact_light_percent,\
         contact_reach_texels,deep_light_percent,edge_aliasing_texels,edge_aliasing_floor_texels,edge_shift_texels,\
         penumbra_rmse,non_finite,texels_allocated,texels_cleared,draws,passes,bytes,lookup_cycles,texels_touched,\
         time_ratio,time_ratio_lower_quartile,time_ratio_upper_quartile,maps_time_ratio,lookups_time_ratio\n",
    );
    for sample in samples {
        let (configuration, errors) = (&sample.configuration, &sample.errors);
        let (cost, ratios) = (&sample.cost, &sample.ratios);
        let numbers = [
            errors.rmse,
            errors.misclassified_percent,
            errors.false_shadow_percent,
            errors.contact_light_percent,
            errors.contact_reach_texels,
            errors.deep_light_percent,
            errors.edge_aliasing_texels,
            sample.edge_floor_texels,
            errors.edge_shift_texels,
            errors.penumbra_rmse,
            errors.non_finite as f64,
            cost.texels_allocated as f64,
            cost.texels_cleared as f64,
            f64::from(cost.draws),
            f64::from(cost.passes),
            cost.bytes as f64,
            cost.lookup_cycles,
            f64::from(cost.texels_touched),
            ratios.total.median,
            ratios.total.lower_quartile,
            ratios.total.upper_quartile,
            ratios.maps.median,
            ratios.lookups.median,
        ];
        let _ = write!(
            text,
            "{},\"{}\",{},{}",
            sample.scene,
            configuration.series(),
            configuration.map_size,
            configuration.fits_camera
        );
        for number in numbers {
            let _ = write!(text, ",{number}");
        }
        text.push('\n');
    }
    fs::write(path, text)
}

/// Writes the overall table.
pub fn write_overall(path: &Path, entries: &[Overall]) -> io::Result<()> {
    let mut text = String::from(
        "configuration,map_size,fits_camera,rmse,misclassified_percent,false_shadow_percent,false_light_percent,\
         lookup_cycles,texels,frame_work,time_ratio,on_front\n",
    );
    for entry in entries {
        let configuration = &entry.configuration;
        let _ = writeln!(
            text,
            "\"{}\",{},{},{},{},{},{},{},{},{},{},{}",
            configuration.series(),
            configuration.map_size,
            configuration.fits_camera,
            entry.rmse,
            entry.misclassified_percent,
            entry.false_shadow_percent,
            entry.false_light_percent,
            entry.lookup_cycles,
            entry.texels,
            entry.cost,
            entry.time_ratio,
            entry.is_on_front
        );
    }
    fs::write(path, text)
}
