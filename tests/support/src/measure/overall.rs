//! Computes means over the scenes, the Pareto front, and whether the library's default is on it.

use super::configuration::Configuration;
use super::pareto;
use super::subject::Sample;

/// Holds the results of one configuration over all scenes with hard shadows.
#[derive(Clone, Debug)]
pub struct Overall {
    pub configuration: Configuration,
    /// Is the mean over the scenes.
    pub rmse: f64,
    pub misclassified_percent: f64,
    pub false_shadow_percent: f64,
    pub false_light_percent: f64,
    /// Is the mean of the lookup's SIMD cycles per shaded pixel.
    pub lookup_cycles: f64,
    /// Is the mean of the texels allocated.
    pub texels: f64,
    /// Is the mean over the scenes of the work per frame.
    pub cost: f64,
    /// Is the geometric mean over the scenes of the time as a multiple of the textbook's.
    pub time_ratio: f64,
    pub is_on_front: bool,
}

/// Returns one entry per configuration that ran in every scene with hard shadows.
pub fn of(samples: &[Sample]) -> Vec<Overall> {
    let hard: Vec<&Sample> = samples.iter().filter(|sample| !sample.is_soft).collect();
    let mut scenes: Vec<_> = hard.iter().map(|sample| sample.scene).collect();
    scenes.dedup();
    let mut entries: Vec<Overall> = Vec::new();
    for sample in &hard {
        let configuration = sample.configuration;
        if entries
            .iter()
            .any(|entry| entry.configuration == configuration)
        {
            continue;
        }
        let own: Vec<&Sample> = hard
            .iter()
            .filter(|sample| sample.configuration == configuration)
            .copied()
            .collect();
        if own.len() == scenes.len() {
            entries.push(mean(configuration, &own));
        }
    }
    let costs: Vec<_> = entries
        .iter()
        .map(|entry| [entry.cost, entry.rmse])
        .collect();
    for (entry, is_on_front) in entries.iter_mut().zip(pareto::front(&costs)) {
        entry.is_on_front = is_on_front;
    }
    entries
}

fn mean(configuration: Configuration, samples: &[&Sample]) -> Overall {
    let mean = |value: fn(&Sample) -> f64| {
        samples.iter().map(|sample| value(sample)).sum::<f64>() / samples.len() as f64
    };
    Overall {
        configuration,
        rmse: mean(|sample| sample.errors.rmse),
        misclassified_percent: mean(|sample| sample.errors.misclassified_percent),
        false_shadow_percent: mean(|sample| sample.errors.false_shadow_percent),
        false_light_percent: mean(|sample| {
            sample.errors.contact_light_percent + sample.errors.deep_light_percent
        }),
        lookup_cycles: mean(|sample| sample.cost.lookup_cycles),
        texels: mean(|sample| sample.cost.texels_allocated as f64),
        cost: mean(|sample| sample.cost.frame_work()),
        time_ratio: mean(|sample| sample.ratios.total.median.ln()).exp(),
        is_on_front: false,
    }
}

/// Returns whether a configuration is on the front of work per frame against rmse. The sentence
/// names what dominates it.
pub fn judge(entries: &[Overall], configuration: &Configuration) -> Result<String, String> {
    let own = find(entries, configuration)?;
    let front = "on the Pareto front of work per frame against rmse";
    let figures = |entry: &Overall| format!("cost {:.3e}, rmse {:.4}", entry.cost, entry.rmse);
    match beaten_by(entries, own, |entry| [entry.cost, entry.rmse]) {
        None => Ok(format!("{configuration} ({}) is {front}", figures(own))),
        Some(other) => Err(format!(
            "{configuration} ({}) is not {front}: {} beats it ({})",
            figures(own),
            other.configuration,
            figures(other)
        )),
    }
}

/// Answers the same question for other costs, with one sentence each, in addition to the judgement.
pub fn other_views(entries: &[Overall]) -> Result<Vec<String>, String> {
    let own = find(entries, &Configuration::shipped_default())?;
    let answer = |costs: &str, beaten: Option<&Overall>| match beaten {
        None => format!("with {costs}, nothing beats the default"),
        Some(other) => format!(
            "with {costs}, {} beats the default (rmse {:.4}, {:.1} cycles, {:.2e} texels, time ratio {:.2})",
            other.configuration, other.rmse, other.lookup_cycles, other.texels, other.time_ratio
        ),
    };
    Ok(vec![
        answer(
            "cycles and texels as two costs",
            beaten_by(entries, own, |entry| {
                [entry.lookup_cycles, entry.texels, entry.rmse]
            }),
        ),
        answer(
            "texels alone as cost",
            beaten_by(entries, own, |entry| [entry.texels, entry.rmse]),
        ),
        answer(
            "time in this run as cost",
            beaten_by(entries, own, |entry| [entry.time_ratio, entry.rmse]),
        ),
    ])
}

fn find<'a>(entries: &'a [Overall], configuration: &Configuration) -> Result<&'a Overall, String> {
    entries
        .iter()
        .find(|entry| entry.configuration == *configuration)
        .ok_or_else(|| format!("{configuration} was not measured in every scene"))
}

/// Returns the closest to the truth of all that dominate `own` in these costs.
fn beaten_by<'a, const N: usize>(
    entries: &'a [Overall],
    own: &Overall,
    costs: impl Fn(&Overall) -> [f64; N],
) -> Option<&'a Overall> {
    entries
        .iter()
        .filter(|other| pareto::dominates(&costs(other), &costs(own)))
        .min_by(|a, b| a.rmse.total_cmp(&b.rmse))
}
