//! Finds what nothing else dominates.

/// Returns for each entry of costs, smaller being better in all of them, whether it is on the
/// Pareto front: whether no other entry is at most as large in every cost and smaller in one.
pub fn front<const N: usize>(entries: &[[f64; N]]) -> Vec<bool> {
    entries
        .iter()
        .map(|entry| !entries.iter().any(|other| dominates(other, entry)))
        .collect()
}

/// Returns whether `better` is at most as large in every cost, and smaller in one.
pub fn dominates<const N: usize>(better: &[f64; N], worse: &[f64; N]) -> bool {
    let mut pairs = better.iter().zip(worse);
    pairs.clone().all(|(a, b)| a <= b) && pairs.any(|(a, b)| a < b)
}
