//! Order statistics and distributions: one rule for each, wherever a number is of many.
//!
//! ```text
//! q(s) = x_k + (h - k) (x_{k+1} - x_k),   h = s (n - 1),   k = floor h        x sorted, counted from 0
//! ```
//!
//! q the value below which a share s of n values lies (type 7 of Hyndman and Fan, The American Statistician 50, 1996). The median is q(1/2): of an even count
//! the mean of the two in the middle.

mod distribution;

pub use distribution::{
    NORMAL_90, NORMAL_95, chance_beyond, normal_quantile, normal_share_below, student_90,
    student_95, student_exceeded,
};

/// Standard deviation of a normal distribution over the median of its absolute deviations, 1 / (the quantile of 3/4) [1].
pub const NORMAL_MAD: f64 = 1.482_602;

/// Value below which a share of all lies, of numbers that are known (not NaN); none of none.
#[must_use]
pub fn quantile(values: impl IntoIterator<Item = f64>, share: f64) -> Option<f64> {
    let mut known: Vec<f64> = values.into_iter().filter(|v| !v.is_nan()).collect();
    let place = share.clamp(0.0, 1.0) * known.len().checked_sub(1)? as f64;
    let (_, low, above) = known.select_nth_unstable_by(place as usize, f64::total_cmp);
    let low = *low;
    let next = above.iter().copied().min_by(f64::total_cmp);
    Some(
        next.filter(|_| place.fract() > 0.0)
            .map_or(low, |next| between(low, next, place.fract())),
    )
}

/// The same of several shares.
#[must_use]
pub fn quantiles(values: &[f64], shares: &[f64]) -> Option<Vec<f64>> {
    let mut known: Vec<f64> = values.iter().copied().filter(|v| !v.is_nan()).collect();
    known.sort_by(f64::total_cmp);
    let last = known.len().checked_sub(1)? as f64;
    let at = |share: &f64| {
        let place = share.clamp(0.0, 1.0) * last;
        between(
            known[place.floor() as usize],
            known[place.ceil() as usize],
            place.fract(),
        )
    };
    Some(shares.iter().map(at).collect())
}

fn between(low: f64, high: f64, share: f64) -> f64 {
    // Of equals exactly that, infinite ones too.
    if low == high {
        low
    } else {
        low + (high - low) * share
    }
}

/// The median of numbers that are known (not NaN); none of none.
#[must_use]
pub fn median(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    quantile(values, 0.5)
}

/// The median distance of increasing times [s]; 0 of less than two.
#[must_use]
pub fn median_step(time: &[f64]) -> f64 {
    median(time.windows(2).map(|pair| pair[1] - pair[0])).unwrap_or(0.0)
}

/// The mean; 0 of nothing.
#[must_use]
pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_lie_straight_between_neighbours() {
        let values = [4.0, f64::NAN, 1.0, 2.0, 3.0];
        let shares = [0.0, 0.5, 0.9, 1.0];
        let found = quantiles(&values, &shares).unwrap();
        assert_eq!(found, [1.0, 2.5, 3.7, 4.0]);
        assert_eq!(
            shares.map(|share| quantile(values, share)).to_vec(),
            found.into_iter().map(Some).collect::<Vec<_>>()
        );
        assert_eq!(quantiles(&[f64::NAN], &[0.5]), None);
        assert_eq!(
            quantile([f64::INFINITY, f64::INFINITY], 0.5),
            Some(f64::INFINITY)
        );
    }

    #[test]
    fn a_median_is_the_middle_one_or_the_mean_of_two() {
        assert_eq!(median([3.0, 1.0, 2.0]), Some(2.0));
        assert_eq!(median([4.0, 1.0, 3.0, 2.0]), Some(2.5));
        assert_eq!(median([]), None);
        assert_eq!(median_step(&[0.0, 1.0, 3.0, 4.0]), 1.0);
        assert_eq!(median_step(&[0.0]), 0.0);
        assert_eq!([mean(&[1.0, 2.0, 6.0]), mean(&[])], [3.0, 0.0]);
    }

    #[test]
    fn half_of_a_normal_distribution_lies_within_its_median_deviation() {
        assert!((NORMAL_MAD * normal_quantile(0.75) - 1.0).abs() < 1e-6);
    }
}
