//! Mean, spread and shares of sampled values.

/// Mean and spread of a set of values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Moments {
    pub(super) mean: f64,
    /// Of the population: the samples are all there is, not a draw from more.
    pub(super) standard_deviation: f64,
}

/// Mean and population standard deviation; `None` of nothing.
pub(super) fn moments(values: &[f64]) -> Option<Moments> {
    if values.is_empty() {
        return None;
    }
    let mean = mean(values.iter().copied(), values.len());
    // Second pass about the mean: sum of squares less square of sum would cancel.
    let variance = self::mean(
        values.iter().map(|value| (value - mean).powi(2)),
        values.len(),
    );
    Some(Moments {
        mean,
        standard_deviation: variance.sqrt(),
    })
}

fn mean(values: impl Iterator<Item = f64>, count: usize) -> f64 {
    values.sum::<f64>() / count as f64
}

/// Root mean square; `None` of nothing.
pub(super) fn root_mean_square(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| mean(values.iter().map(|v| v * v), values.len()).sqrt())
}

/// Largest absolute value; `None` of nothing.
pub(super) fn largest(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    values.into_iter().map(f64::abs).reduce(f64::max)
}

/// Least and greatest value; `None` of nothing.
pub(super) fn extent(values: &[f64]) -> Option<(f64, f64)> {
    let least = values.iter().copied().reduce(f64::min)?;
    let greatest = values.iter().copied().reduce(f64::max)?;
    Some((least, greatest))
}

/// Length travelled up to each sample, from the first one on.
pub(super) struct Travel {
    cumulative: Vec<f64>,
}

impl Travel {
    /// From positions along the path [m]; `None` if nothing was travelled.
    pub(super) fn along(path_length: &[f64]) -> Option<Self> {
        let mut travelled = 0.0;
        let mut previous = *path_length.first()?;
        let cumulative: Vec<f64> = path_length
            .iter()
            .map(|&position| {
                travelled += (position - previous).abs();
                previous = position;
                travelled
            })
            .collect();
        (travelled > 0.0).then_some(Self { cumulative })
    }

    /// Whole length [m].
    pub(super) fn total(&self) -> f64 {
        self.cumulative[self.cumulative.len() - 1]
    }

    /// Share of the length on which `holds` [%]: a sample stands for half the way to its neighbours.
    pub(super) fn share_percent(&self, values: &[f64], holds: impl Fn(f64) -> bool) -> f64 {
        let last = self.cumulative.len() - 1;
        let (mut held, mut missed) = (0.0, 0.0);
        for (index, &value) in values.iter().enumerate() {
            let before = self.cumulative[index.saturating_sub(1)];
            let after = self.cumulative[(index + 1).min(last)];
            let sum = if holds(value) { &mut held } else { &mut missed };
            *sum += 0.5 * (after - before);
        }
        // Over their sum and not the total: exactly 100 if nothing was missed.
        100.0 * held / (held + missed)
    }

    /// Samples by equal parts of the length; the last part holds its end.
    pub(super) fn parts<'a>(&self, values: &'a [f64], count: usize) -> Vec<&'a [f64]> {
        let mut begin = 0;
        (1..=count)
            .map(|part| {
                let bound = self.total() * part as f64 / count as f64;
                let end = if part == count {
                    values.len()
                } else {
                    self.cumulative
                        .partition_point(|&travelled| travelled < bound)
                };
                let samples = &values[begin..end];
                begin = end;
                samples
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_survive_a_large_mean() {
        let two = moments(&[1e9 - 1.0, 1e9 + 1.0]).unwrap();
        assert_eq!((two.mean, two.standard_deviation), (1e9, 1.0));
        assert_eq!(moments(&[]), None);
        assert_eq!(root_mean_square(&[3.0, -3.0]), Some(3.0));
        assert_eq!(largest([1.0, -2.0]), Some(2.0));
        assert_eq!(extent(&[1.0, -2.0]), Some((-2.0, 1.0)));
    }

    #[test]
    fn shares_are_of_length_and_add_up() {
        // Standing still at first: two samples without any length.
        let travel = Travel::along(&[1.0, 1.0, 1.0, 2.0, 4.0]).unwrap();
        assert_eq!(travel.total(), 3.0);
        let values = [9.0, 9.0, 1.0, 1.0, 0.0];
        assert_eq!(travel.share_percent(&values, |value| value > 5.0), 0.0);
        let one = travel.share_percent(&values, |value| value == 1.0);
        assert!((one - 100.0 * 2.0 / 3.0).abs() < 1e-12, "{one}");
        let uneven: Vec<f64> = (0..1000)
            .map(|index| (0.1 * f64::from(index)).sqrt())
            .collect();
        let travel = Travel::along(&uneven).unwrap();
        assert_eq!(travel.share_percent(&uneven, |_| true), 100.0);
        assert!(Travel::along(&[1.0, 1.0]).is_none());
    }

    #[test]
    fn parts_hold_every_sample_once() {
        let path: Vec<f64> = (0..=100).map(|index| f64::from(index) * 0.01).collect();
        let travel = Travel::along(&path).unwrap();
        let parts = travel.parts(&path, 10);
        let count: Vec<usize> = parts.iter().map(|part| part.len()).collect();
        assert_eq!(count.iter().sum::<usize>(), 101);
        assert!(
            count.iter().all(|&count| (9..=11).contains(&count)),
            "{count:?}"
        );
        assert_eq!(parts[0][0], 0.0);
        assert_eq!(parts[9].last(), Some(&1.0));
    }
}
