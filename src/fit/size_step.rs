//! A geometric ladder of sizes, so that a fit changes its scale rarely, and then clearly.

/// The rungs from one power of two to the next: 2^(0/4), 2^(1/4), 2^(2/4), 2^(3/4). A rung is at most 1.19 times what was asked
/// for, 1.09 on average; finer rungs are tighter and change more often. As a table, so that a scene scaled by a power of two
/// has the same rungs to the bit.
const RUNGS: [f64; 5] = [
    1.0,
    1.189_207_115_002_721,
    std::f64::consts::SQRT_2,
    1.681_792_830_507_429,
    2.0,
];

/// A held rung is left for a smaller one only when the smaller one has this much room to spare, so that a size that trembles
/// around a rung does not change it every frame.
const SHRINK_SLACK: f64 = 1.05;

/// The smallest rung that is at least `size` (positive and finite).
pub(crate) fn size_step_up(size: f64) -> f64 {
    // log2 may round to the next integer at a power of two; the octave below or above then serves as well.
    let octave = size.log2().floor().exp2();
    RUNGS
        .iter()
        .map(|rung| rung * octave)
        .find(|rung| *rung >= size)
        .unwrap_or(4.0 * octave)
}

/// The rung to use for `size` when `held` is in use: `held` while it is large enough and no smaller rung fits with slack.
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
    fn a_rung_holds_its_size_and_is_at_most_one_step_larger() {
        let mut size = 1e-9;
        while size < 1e9 {
            let rung = size_step_up(size);
            assert!(rung >= size && rung <= size * 2.0_f64.powf(0.25) * (1.0 + 1e-12));
            assert_eq!(size_step_up(rung), rung, "a rung is its own rung");
            size *= 1.0137;
        }
    }

    #[test]
    fn trembling_around_a_rung_changes_it_once() {
        let mut held = None;
        let mut changes = 0;
        for step in 0..1000 {
            let size = 1.0 + 0.02 * (step as f64 * 0.7).sin();
            let rung = size_step_with_hysteresis(size, held);
            changes += usize::from(held != Some(rung));
            held = Some(rung);
        }
        assert!(changes <= 2, "{changes}");
        assert!(
            size_step_with_hysteresis(0.5, held) < 0.6,
            "a real shrink is taken"
        );
    }
}
