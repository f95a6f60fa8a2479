//! Compares measurements in words as far as two machines agree.

/// Returns the words, and the numbers between them with the value of two in their last digit.
fn parts(text: &str) -> (Vec<&str>, Vec<(f64, f64)>) {
    let (mut words, mut numbers) = (Vec::new(), Vec::new());
    let mut rest = text;
    while let Some(start) = rest.find(|c: char| c.is_ascii_digit()) {
        words.push(&rest[..start]);
        let digits = &rest[start..];
        let length_of = |text: &str| {
            text.find(|c: char| !c.is_ascii_digit())
                .unwrap_or(text.len())
        };
        let mut end = length_of(digits);
        let mut decimals = 0;
        if let Some(fraction) = digits[end..].strip_prefix('.') {
            decimals = length_of(fraction);
            end += if decimals > 0 { 1 + decimals } else { 0 };
        }
        let mut exponent = 0;
        if let Some(power) = digits[end..].strip_prefix('e') {
            let sign = usize::from(power.starts_with('-'));
            let length = length_of(&power[sign..]);
            if length > 0 {
                exponent = power[..sign + length].parse().unwrap_or(0);
                end += 1 + sign + length;
            }
        }
        let last_place = 10_f64.powi(exponent - decimals as i32);
        numbers.push((digits[..end].parse().unwrap_or(f64::NAN), 2.0 * last_place));
        rest = &digits[end..];
    }
    words.push(rest);
    (words, numbers)
}

/// Returns whether the words are the same, and the figures as near as two machines give them.
pub fn agree(written: &str, measured: &str) -> bool {
    let ((words, figures), (other_words, others)) = (parts(written), parts(measured));
    let near = |((a, step), (b, other_step)): (&(f64, f64), &(f64, f64))| {
        let (low, high) = (a.min(*b), a.max(*b));
        // A tenth of a step allows for the rounding of the steps themselves.
        high <= 1.5 * low || high - low <= 1.1 * step.max(*other_step)
    };
    words == other_words && figures.iter().zip(&others).all(near)
}

/// This states what the comparison accepts, and what it does not.
#[test]
fn figures_are_told_apart() {
    let pairs = [
        (
            "0 wrong of 4000 receivers",
            "0 wrong of 4100 receivers",
            true,
        ),
        (
            "0 wrong of 4000 receivers",
            "2 wrong of 4000 receivers",
            true,
        ),
        (
            "0 wrong of 4000 receivers",
            "3 wrong of 4000 receivers",
            false,
        ),
        ("0 wrong of 4000 receivers", "0 wrong of 4000 places", false),
        (
            "0 wrong of 4000 receivers",
            "0 wrong of 4000 receivers, 1 lit",
            false,
        ),
        (
            "1 wrong of 4000 receivers",
            "1 wrong of 2000 receivers",
            false,
        ),
        ("0.62 of what is allowed", "0.64 of what is allowed", true),
        ("0.62 of what is allowed", "0.94 of what is allowed", false),
        ("rmse 1.2e-5 at 1e6", "rmse 1.7e-5 at 1e6", true),
        ("rmse 1.2e-5 at 1e6", "rmse 1.9e-5 at 1e6", false),
        ("rmse 1.2e-5 at 1e6", "rmse 1.2e-4 at 1e6", false),
        ("as expected", "as expected", true),
        ("ends at 5.", "ends at 5.", true),
    ];
    for (written, measured, wanted) in pairs {
        assert_eq!(agree(written, measured), wanted, "{written:?} {measured:?}");
        assert_eq!(agree(measured, written), wanted, "{measured:?} {written:?}");
    }
}
