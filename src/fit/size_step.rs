//! Quantizes sizes to geometric steps, so that a fit changes its scale rarely, and then clearly.

/// Lists the size steps from one power of two to the next: 2^(0/4), 2^(1/4), 2^(2/4), 2^(3/4), 2. A step is at most
/// 1.19 times the size that it was requested for, 1.09 times on average; finer steps are tighter and change more often.
/// They are a table, so that a scene scaled by a power of two has the same steps to the bit.
const STEPS: [f64; 5] = [
    1.0,
    1.189_207_115_002_721,
    std::f64::consts::SQRT_2,
    1.681_792_830_507_429,
    2.0,
];

/// Is how much room a smaller step must have to spare before a held step is left for it, so that a size that varies
/// around a step does not change it every frame.
const SHRINK_SLACK: f64 = 1.05;

/// Returns the smallest size step that is at least `size` (positive and finite).
pub(crate) fn size_step_up(size: f64) -> f64 {
    // log2 may round to the next integer at a power of two; the octave below or above then serves as well.
    let octave = size.log2().floor().exp2();
    STEPS
        .iter()
        .map(|step| step * octave)
        .find(|step| *step >= size)
        .unwrap_or(4.0 * octave)
}

/// Returns the size step to use for `size` when `held` is in use: `held` while it is large enough and no smaller step
/// fits with slack.
pub(crate) fn size_step_with_hysteresis(size: f64, held: Option<f64>) -> f64 {
    match held {
        Some(held) if held >= size && size_step_up(size * SHRINK_SLACK) >= held => held,
        _ => size_step_up(size),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_size_step_is_at_least_its_size_and_at_most_one_step_larger() {
        let mut size = 1e-9;
        while size < 1e9 {
            let step = size_step_up(size);
            assert!(step >= size && step <= size * 2.0_f64.powf(0.25) * (1.0 + 1e-12));
            assert_eq!(size_step_up(step), step, "a step is its own step");
            size *= 1.0137;
        }
    }

    #[test]
    fn sizes_that_vary_around_a_step_change_it_once() {
        let mut held = None;
        let mut changes = 0;
        for frame in 0..1000 {
            let size = 1.0 + 0.02 * (frame as f64 * 0.7).sin();
            let step = size_step_with_hysteresis(size, held);
            changes += usize::from(held != Some(step));
            held = Some(step);
        }
        assert!(changes <= 2, "{changes}");
        assert!(
            size_step_with_hysteresis(0.5, held) < 0.6,
            "a real shrink is taken"
        );
    }
}
