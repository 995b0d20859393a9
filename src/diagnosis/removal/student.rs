//! Student's distribution.

use std::f64::consts::{FRAC_PI_2, PI};

/// Integral of cos^(d-1) u from 0 by Simpson's rule: with t = sqrt(d) tan u the density of Student's t goes so.
fn area(to: f64, freedom: usize) -> f64 {
    const STEPS: usize = 400;
    let power = freedom as i32 - 1;
    let step = to / STEPS as f64;
    let sum: f64 = (0..=STEPS)
        .map(|index| {
            let factor = match index {
                0 | STEPS => 1.0,
                odd if odd % 2 == 1 => 4.0,
                _ => 2.0,
            };
            factor * (index as f64 * step).cos().max(0.0).powi(power)
        })
        .sum();
    sum * step / 3.0
}

/// Probability that Student's t is beyond a value on either side, by degrees of freedom.
pub(super) fn chance_beyond(t: f64, freedom: usize) -> f64 {
    let to = (t.abs() / (freedom as f64).sqrt()).atan();
    (1.0 - area(to, freedom) / area(FRAC_PI_2, freedom)).max(0.0)
}

/// Value that Student's t exceeds with a probability on the upper side, by degrees of freedom.
pub(super) fn t_exceeded(upper: f64, freedom: usize) -> f64 {
    let whole = area(FRAC_PI_2, freedom);
    let (mut low, mut high) = (0.0, FRAC_PI_2);
    for _ in 0..60 {
        let middle = f64::midpoint(low, high);
        if 0.5 - 0.5 * area(middle, freedom) / whole > upper {
            low = middle;
        } else {
            high = middle;
        }
    }
    debug_assert!(high < PI);
    (freedom as f64).sqrt() * low.tan()
}

#[cfg(test)]
mod tests {
    use super::{chance_beyond, t_exceeded};

    #[test]
    fn quantiles_are_those_of_the_tables() {
        for (upper, freedom, table) in [
            (0.025, 1, 12.706),
            (0.025, 5, 2.571),
            (0.025, 18, 2.101),
            (0.005, 10, 3.169),
            (0.0005, 30, 3.646),
            (0.025, 120, 1.980),
        ] {
            let value = t_exceeded(upper, freedom);
            assert!(
                (value / table - 1.0).abs() < 1e-3,
                "{upper} {freedom}: {value}"
            );
            let chance = chance_beyond(table, freedom);
            assert!((0.5 * chance / upper - 1.0).abs() < 0.01, "{chance}");
        }
    }
}
