//! Integrated autocorrelation time: how many neighbouring samples tell as much as one.
//!
//! ```text
//! t = 1 + 2 sum rho_k   up to the first rho_k < 0.05
//! ```
//!
//! rho_k correlation of a signal with itself k samples later (Sokal 1997).

/// Correlation at which two samples count as independent [1].
const INDEPENDENT: f64 = 0.05;
/// Samples that tell as much as one.
pub(in crate::diagnosis) fn integrated_autocorrelation_time(left: &[f64]) -> f64 {
    let count = left.len();
    let mean = left.iter().sum::<f64>() / count.max(1) as f64;
    let at = |lag: usize| -> f64 {
        let pairs = left.iter().zip(&left[lag..]);
        pairs.map(|(a, b)| (a - mean) * (b - mean)).sum()
    };
    let own = at(0);
    if count < 4 || own <= 0.0 {
        return 1.0;
    }
    let mut sum = 1.0;
    for lag in 1..count / 4 {
        let share = at(lag) / own;
        if share < INDEPENDENT {
            break;
        }
        sum += 2.0 * share;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::integrated_autocorrelation_time;
    use rand::{Rng, SeedableRng};

    #[test]
    fn noise_is_alike_for_one_sample_and_a_smoothed_one_for_as_many_as_theory_says() {
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(9);
        let white: Vec<f64> = (0..40_000)
            .map(|_| random.random_range(-1.0..1.0))
            .collect();
        assert!((integrated_autocorrelation_time(&white) - 1.0).abs() < 0.1);
        // First order with decay a: (1 + a)/(1 - a).
        let decay = 0.9;
        let mut state = 0.0;
        let smooth: Vec<f64> = white
            .iter()
            .map(|w| {
                state = decay * state + w;
                state
            })
            .collect();
        let expected = (1.0 + decay) / (1.0 - decay);
        assert!(
            (integrated_autocorrelation_time(&smooth) / expected - 1.0).abs() < 0.15,
            "{}",
            integrated_autocorrelation_time(&smooth)
        );
    }
}
