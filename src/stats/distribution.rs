//! The normal distribution and Student's.

use statrs::distribution::{ContinuousCDF, Normal, StudentsT};

/// Standard deviations from the mean to either end of the interval that holds 90 % of a normal distribution [1].
pub const NORMAL_90: f64 = 1.644_854;
/// The same of 95 % [1].
pub const NORMAL_95: f64 = 1.959_964;

/// Share of the standard normal distribution that lies below a value.
#[must_use]
pub fn normal_share_below(value: f64) -> f64 {
    Normal::standard().cdf(value)
}

/// Value below which a share of the standard normal distribution lies.
#[must_use]
pub fn normal_quantile(share: f64) -> f64 {
    Normal::standard().inverse_cdf(share)
}

/// Student's distribution of some degrees of freedom; the normal one of infinitely many.
fn student(freedom: f64) -> Option<StudentsT> {
    StudentsT::new(0.0, 1.0, freedom).ok()
}

/// Probability that Student's t is beyond a value on either side, by degrees of freedom.
#[must_use]
pub fn chance_beyond(t: f64, freedom: f64) -> f64 {
    student(freedom).map_or(1.0, |student| 2.0 * student.sf(t.abs()))
}

/// Value that Student's t exceeds with a probability on the upper side, by degrees of freedom; infinite of none.
#[must_use]
pub fn student_exceeded(upper: f64, freedom: f64) -> f64 {
    student(freedom).map_or(f64::INFINITY, |student| student.inverse_cdf(1.0 - upper))
}

/// Half of the interval that holds 90 % of Student's t, by degrees of freedom.
#[must_use]
pub fn student_90(freedom: f64) -> f64 {
    student_exceeded(0.05, freedom)
}

/// The same of 95 %.
#[must_use]
pub fn student_95(freedom: f64) -> f64 {
    student_exceeded(0.025, freedom)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_the_tables() {
        for (upper, freedom, table) in [
            (0.025, 1.0, 12.706),
            (0.025, 5.0, 2.571),
            (0.025, 18.0, 2.101),
            (0.05, 4.0, 2.132),
            (0.005, 10.0, 3.169),
            (0.0005, 30.0, 3.646),
            (0.025, 120.0, 1.980),
        ] {
            let value = student_exceeded(upper, freedom);
            assert!(
                (value / table - 1.0).abs() < 1e-3,
                "{upper} {freedom}: {value}"
            );
            let chance = chance_beyond(table, freedom);
            assert!((0.5 * chance / upper - 1.0).abs() < 0.01, "{chance}");
        }
        for (share, value) in [
            (0.5, 0.0),
            (0.975, NORMAL_95),
            (0.95, NORMAL_90),
            (0.001, -3.090_232),
        ] {
            assert!((normal_quantile(share) - value).abs() < 1e-6, "{share}");
            assert!((normal_share_below(value) - share).abs() < 1e-7, "{share}");
        }
    }
}
