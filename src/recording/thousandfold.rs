//! Numbers that fell to a thousandth because a mark before every third digit was read as a decimal mark: 998, 999, 1.000, 1.001 for 1000 and 1001.
//!
//! The rest is plain: nothing goes beyond a level, and where the trajectory would, it falls to a thousandth of it, again and again.

/// Ratio of neighbours from which a jump from near the level is one that no trajectory makes.
const JUMP: f64 = 300.0;
/// Nearness to the level, and largest change from one sample to the next, as shares of the level.
const NEAR: f64 = 0.5;
/// Rounding of what was written, as a share.
const ROUNDING: f64 = 1e-3;
/// Falls and rises that there must be, and different values behind them: what is switched between two is no trajectory.
const LEAST: usize = 2;

/// Falls to a thousandth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Fallen {
    /// Falls and rises.
    pub count: usize,
    /// Place of the first value behind one.
    pub first: usize,
}

/// Looks for falls to a thousandth; none where a jump is another one.
#[must_use]
pub fn thousandfold(values: &[f64]) -> Option<Fallen> {
    let there = values.iter().filter(|v| v.is_finite());
    let most = there.fold(0.0, |most: f64, v| most.max(v.abs()));
    let mut found = Fallen { count: 0, first: 0 };
    let mut behind: Vec<f64> = Vec::new();
    for (index, pair) in values.windows(2).enumerate() {
        let [a, b] = [pair[0].abs(), pair[1].abs()];
        let (high, low) = (a.max(b), a.min(b));
        if high < NEAR * most || low == 0.0 || low.is_nan() || high / low < JUMP {
            continue;
        }
        // What it was lies beyond the level, and not far from its neighbour.
        let whole = 1e3 * low;
        let is_beyond = whole > (1.0 - ROUNDING) * most && whole - high < NEAR * most;
        if !is_beyond || pair[0] * pair[1] < 0.0 {
            return None;
        }
        if found.count == 0 {
            found.first = index + 1;
        }
        found.count += 1;
        if !behind.contains(&low) {
            behind.push(low);
        }
    }
    (found.count >= LEAST && behind.len() >= LEAST).then_some(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_trajectory_beyond_a_thousand_is_seen_when_its_marks_were_misread() {
        let trajectory: Vec<f64> = (0..400)
            .map(|i| 900.0 + 200.0 * (0.05 * f64::from(i)).sin())
            .collect();
        let misread = |v: &f64| {
            if *v >= 1000.0 {
                (v.round()) / 1000.0
            } else {
                *v
            }
        };
        let wild: Vec<f64> = trajectory.iter().map(misread).collect();
        let found = thousandfold(&wild).unwrap();
        assert!(found.count > 4 && wild[found.first] < 1.1, "{found:?}");
        assert_eq!(thousandfold(&trajectory), None);
        // In other units the ratio is the same.
        let metres: Vec<f64> = wild.iter().map(|v| v * 1e-3).collect();
        assert_eq!(thousandfold(&metres), Some(found));
    }

    #[test]
    fn a_steep_trajectory_is_seen_as_well() {
        // A pressure that is switched, read in millibars.
        let trajectory = |i: u32| 1500.0 * (0.5 + 0.5 * (0.35 * f64::from(i)).sin());
        let wild: Vec<f64> = (0..200)
            .map(trajectory)
            .map(|v| if v >= 1000.0 { v / 1000.0 } else { v })
            .collect();
        assert!(thousandfold(&wild).is_some());
        assert_eq!(
            thousandfold(&(0..200).map(trajectory).collect::<Vec<_>>()),
            None
        );
    }

    #[test]
    fn noise_about_nothing_steps_and_single_wild_values_are_none() {
        let noise: Vec<f64> = (0..1000)
            .map(|i| (f64::from(i) * 1.7).sin() * 1e-3)
            .collect();
        assert_eq!(thousandfold(&noise), None);
        let steps: Vec<f64> = (0..100).map(|i| f64::from(i / 10 % 2)).collect();
        assert_eq!(thousandfold(&steps), None);
        let switched: Vec<f64> = (0..100).map(|i| [1.0, 1000.0][i / 10 % 2]).collect();
        assert_eq!(thousandfold(&switched), None);
        let mut single = vec![1.0; 100];
        single[50] = 1000.0;
        assert_eq!(thousandfold(&single[..51]), None);
    }
}
