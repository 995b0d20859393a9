//! Numbers that fell to a thousandth because a mark before every third digit was read as a decimal mark: 998, 999, 1.000, 1.001 for 1000 and 1001.
//!
//! What that leaves is plain: nothing goes beyond a level, and where the course would, it falls to a thousandth of it, again and again.

/// Ratio of neighbours that may be such a fall, and one that no course makes.
const RATIO: std::ops::RangeInclusive<f64> = 940.0..=1060.0;
const JUMP: f64 = 300.0;
/// Share by which the levels of falls may differ from one another.
const SPREAD: f64 = 0.06;
/// Falls and rises that there must be.
const LEAST: usize = 2;

/// Falls to a thousandth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Fallen {
    /// Falls and rises.
    pub count: usize,
    /// Place of the first value behind one.
    pub first: usize,
}

/// Looks for falls to a thousandth; none where a jump is another one, or the course goes beyond their level.
#[must_use]
pub fn thousandfold(values: &[f64]) -> Option<Fallen> {
    let most = values
        .iter()
        .filter(|v| v.is_finite())
        .fold(0.0, |most: f64, v| most.max(v.abs()));
    let mut found = Fallen { count: 0, first: 0 };
    for (index, pair) in values.windows(2).enumerate() {
        let (high, low) = (
            pair[0].abs().max(pair[1].abs()),
            pair[0].abs().min(pair[1].abs()),
        );
        let at_level = high > (1.0 - SPREAD) * most;
        if !at_level || low == 0.0 || low.is_nan() || high / low < JUMP {
            continue;
        }
        if !RATIO.contains(&(high / low)) || pair[0] * pair[1] < 0.0 {
            return None;
        }
        if found.count == 0 {
            found.first = index + 1;
        }
        found.count += 1;
    }
    (found.count >= LEAST).then_some(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_course_beyond_a_thousand_is_seen_when_its_marks_were_misread() {
        let course: Vec<f64> = (0..400)
            .map(|i| 900.0 + 200.0 * (0.05 * f64::from(i)).sin())
            .collect();
        let misread = |v: &f64| {
            if *v >= 1000.0 {
                (v.round()) / 1000.0
            } else {
                *v
            }
        };
        let wild: Vec<f64> = course.iter().map(misread).collect();
        let found = thousandfold(&wild).unwrap();
        assert!(found.count > 4 && wild[found.first] < 1.1, "{found:?}");
        assert_eq!(thousandfold(&course), None);
        // In other units the ratio is the same.
        let metres: Vec<f64> = wild.iter().map(|v| v * 1e-3).collect();
        assert_eq!(thousandfold(&metres), Some(found));
    }

    #[test]
    fn noise_about_nothing_steps_and_single_wild_values_are_none() {
        let noise: Vec<f64> = (0..1000)
            .map(|i| (f64::from(i) * 1.7).sin() * 1e-3)
            .collect();
        assert_eq!(thousandfold(&noise), None);
        let steps: Vec<f64> = (0..100).map(|i| f64::from(i / 10 % 2)).collect();
        assert_eq!(thousandfold(&steps), None);
        let mut single = vec![1.0; 100];
        single[50] = 1000.0;
        assert_eq!(thousandfold(&single[..51]), None);
    }
}
