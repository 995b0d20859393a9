//! The standard normal distribution.

use std::f64::consts::FRAC_1_SQRT_2;

/// Share of all that lies below a value.
pub(super) fn share_below(value: f64) -> f64 {
    0.5 * libm::erfc(-value * FRAC_1_SQRT_2)
}

/// Value below which a share lies; within 9 standard deviations.
pub(super) fn quantile(share: f64) -> f64 {
    let (mut low, mut high) = (-9.0, 9.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if share_below(middle) < share {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::{quantile, share_below};

    #[test]
    fn values_are_those_of_tables() {
        for (share, value) in [
            (0.5, 0.0),
            (0.975, 1.959_964),
            (0.95, 1.644_854),
            (0.001, -3.090_232),
        ] {
            assert!(
                (quantile(share) - value).abs() < 1e-6,
                "{share}: {}",
                quantile(share)
            );
            assert!((share_below(value) - share).abs() < 1e-7);
        }
    }
}
