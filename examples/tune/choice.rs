//! Chooses a configuration.

use shadow_support::measure::configuration::Configuration;
use shadow_support::measure::subject::Sample;
use shadow_support::scene::Light;

use crate::paste;

/// Is the factor by which errors may exceed the least and still count as good: a smaller difference
/// is not worth its cost.
const TOLERANCE: f64 = 1.1;

/// Holds what is recommended, and what it is compared with.
pub struct Choice<'a> {
    /// Is the library's default.
    pub default: &'a Sample,
    /// Is the choice for the work that may be spent.
    pub within_work: &'a Sample,
    /// Is the choice whatever the work.
    pub accurate: &'a Sample,
    work: f32,
}

impl<'a> Choice<'a> {
    /// Chooses among what was measured, for `work` times the work of the library's default.
    pub fn of(samples: &'a [Sample], work: f32) -> Result<Self, String> {
        let default = samples
            .iter()
            .find(|sample| sample.configuration == Configuration::shipped_default())
            .ok_or("the default was not measured")?;
        let most = default.cost.frame_work() * f64::from(work);
        Ok(Self {
            default,
            within_work: cheapest_of_the_best(samples, most).ok_or(format!(
                "nothing takes as little work as {work} times the default's: give a larger --work"
            ))?,
            accurate: cheapest_of_the_best(samples, f64::INFINITY).unwrap_or(default),
            work,
        })
    }

    /// Prints the rule, and the descriptors to paste.
    pub fn print(&self, light: &Light) {
        println!(
            "\nTo paste: the cheapest of those whose error is at most 10 % above the least that {} times the default's work\n\
             (--work) can buy. {}.\n\n{}",
            self.work,
            self.compared(self.within_work),
            paste::descriptor(&self.within_work.configuration, light)
        );
        if self.accurate.configuration == self.within_work.configuration {
            println!("\nNo amount of work buys an error that is more than 10 % smaller.");
        } else {
            println!(
                "\nThe same rule without a limit. {}.\n\n{}",
                self.compared(self.accurate),
                paste::descriptor(&self.accurate.configuration, light)
            );
        }
    }

    fn compared(&self, sample: &Sample) -> String {
        if sample.configuration == self.default.configuration {
            return "It is the library's default".to_owned();
        }
        format!(
            "Beside the library's default: {:.2} times the error, {:.2} times the work",
            sample.errors.rmse / self.default.errors.rmse,
            sample.cost.frame_work() / self.default.cost.frame_work()
        )
    }
}

/// Returns the cheapest whose error is within the tolerance of the least that `most_work` can buy,
/// of the library's configurations only.
fn cheapest_of_the_best(samples: &[Sample], most_work: f64) -> Option<&Sample> {
    let affordable = || {
        samples.iter().filter(|sample| {
            !sample.configuration.is_textbook()
                && sample.errors.non_finite == 0
                && sample.cost.frame_work() <= most_work
        })
    };
    let least = affordable()
        .map(|sample| sample.errors.rmse)
        .min_by(f64::total_cmp)?;
    affordable()
        .filter(|sample| sample.errors.rmse <= least * TOLERANCE)
        .min_by(|a, b| {
            let key = |sample: &Sample| (sample.cost.frame_work(), sample.errors.rmse);
            let (a, b) = (key(a), key(b));
            a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1))
        })
}
