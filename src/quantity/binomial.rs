//! Exact bounds on a probability from counts (Clopper and Pearson, Biometrika 26, 1934).
//!
//! ```text
//! upper p:  sum_{i <= k} C(n, i) p^i (1 - p)^(n - i) = alpha
//! ```

/// Probability of at most `hits` among `trials` at a probability each.
fn at_most(hits: usize, trials: usize, probability: f64) -> f64 {
    if probability <= 0.0 || hits >= trials {
        return 1.0;
    }
    if probability >= 1.0 {
        return 0.0;
    }
    // In logarithms: (1 - p)^n is nothing in a number for large n.
    let mut logarithm = trials as f64 * (-probability).ln_1p();
    let odds = probability.ln() - (-probability).ln_1p();
    let mut sum = logarithm.exp();
    for i in 0..hits {
        logarithm += ((trials - i) as f64 / (i + 1) as f64).ln() + odds;
        sum += logarithm.exp();
    }
    sum.min(1.0)
}

/// The probability that is so high that so few hits would come with a probability of `alpha` alone.
#[must_use]
pub fn upper_bound(hits: usize, trials: usize, alpha: f64) -> f64 {
    if hits >= trials {
        return 1.0;
    }
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if at_most(hits, trials, middle) > alpha {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}

/// The probabilities that are neither so low nor so high that the hits would come with a probability of `alpha / 2` alone.
#[must_use]
pub fn interval(hits: usize, trials: usize, alpha: f64) -> [f64; 2] {
    let misses = trials.saturating_sub(hits);
    [
        1.0 - upper_bound(misses, trials, 0.5 * alpha),
        upper_bound(hits, trials, 0.5 * alpha),
    ]
}

#[cfg(test)]
mod tests {
    use super::{interval, upper_bound};

    #[test]
    fn an_interval_has_both_bounds() {
        // R: binom.test(28, 40)$conf.int
        let [low, high] = interval(28, 40, 0.05);
        assert!(
            (low - 0.534_684).abs() < 1e-5 && (high - 0.834_373).abs() < 1e-5,
            "{low} {high}"
        );
        // All of n: (alpha / 2)^(1 / n) to 1.
        let [low, high] = interval(40, 40, 0.05);
        assert!((low - 0.025f64.powf(1.0 / 40.0)).abs() < 1e-12 && high == 1.0);
    }

    #[test]
    fn the_bounds_are_those_of_the_closed_forms() {
        // No hit: (1 - p)^n = alpha. The rule of three.
        let p = upper_bound(0, 150, 0.05);
        assert!((p - (1.0 - 0.05f64.powf(1.0 / 150.0))).abs() < 1e-12);
        // One hit in two: 1 - p^2 = alpha.
        assert!((upper_bound(1, 2, 0.05) - 0.95f64.sqrt()).abs() < 1e-12);
        assert_eq!(upper_bound(3, 3, 0.05), 1.0);
        // R: binom.test(3, 150, alternative = "less")$conf.int
        assert!((upper_bound(3, 150, 0.05) - 0.0508).abs() < 2e-4);
    }
}
