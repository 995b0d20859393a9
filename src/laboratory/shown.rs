//! Where the effects show: taken out of the device, its other numbers kept, how far do the readings move.

/// Standard deviations by which a reading must move [1].
const DEVIATIONS: f64 = 3.0;
/// Neighbours as far apart belong together [s].
const APART: f64 = 0.04;
/// Added at either end [s].
const MARGIN: f64 = 0.02;

/// Times [s] from and until which readings differ; a lone sample is none.
pub(super) fn intervals(times: &[f64], with: &[f64], without: &[f64], noise: f64) -> Vec<[f64; 2]> {
    let moved: Vec<f64> = (0..times.len())
        .filter(|i| (with[*i] - without[*i]).abs() > DEVIATIONS * noise)
        .map(|i| times[i])
        .collect();
    moved
        .chunk_by(|a, b| b - a <= APART + 1e-9)
        .filter(|run| run.len() > 1)
        .map(|run| [(run[0] - MARGIN).max(times[0]), run[run.len() - 1] + MARGIN])
        .collect()
}

#[cfg(test)]
mod tests {
    use super::intervals;

    #[test]
    fn runs_are_merged_widened_and_lone_samples_dropped() {
        let times: Vec<f64> = (0..100).map(|i| f64::from(i) * 0.01).collect();
        let mut with = vec![0.0; 100];
        for i in [0, 1, 20, 21, 24, 40, 90, 91] {
            with[i] = 3.1;
        }
        with[60] = 3.0;
        let found = intervals(&times, &with, &[0.0; 100], 1.0);
        let expected = [[0.0, 0.03], [0.18, 0.26], [0.88, 0.93]];
        assert_eq!(found.len(), 3);
        for (found, expected) in found.iter().zip(expected) {
            assert!(
                (found[0] - expected[0]).abs() < 1e-12 && (found[1] - expected[1]).abs() < 1e-12
            );
        }
    }
}
