//! What nothing else beats.

/// For each entry of costs, smaller being better in all of them: is it on the Pareto front, that is, is no other entry at most
/// as large in every cost and smaller in one?
pub fn front<const N: usize>(entries: &[[f64; N]]) -> Vec<bool> {
    entries
        .iter()
        .map(|entry| !entries.iter().any(|other| dominates(other, entry)))
        .collect()
}

/// Is `better` at most as large in every cost, and smaller in one?
pub fn dominates<const N: usize>(better: &[f64; N], worse: &[f64; N]) -> bool {
    let mut pairs = better.iter().zip(worse);
    pairs.clone().all(|(a, b)| a <= b) && pairs.any(|(a, b)| a < b)
}
