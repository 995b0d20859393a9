//! Shares of a sweep that are reported, and correlation of ranks.

/// Shares of which the quantiles are reported [1].
pub const QUANTILES: [f64; 7] = [0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0];

/// Spearman's correlation of ranks, from -1 to 1: whether one grows with the other, however; none where one of them stands still.
#[must_use]
pub fn rank_correlation(one: &[f64], other: &[f64]) -> Option<f64> {
    let pairs = one.iter().zip(other);
    let known: Vec<(f64, f64)> = pairs
        .map(|(a, b)| (*a, *b))
        .filter(|(a, b)| !a.is_nan() && !b.is_nan())
        .collect();
    let [a, b] = [
        ranks(&known.iter().map(|pair| pair.0).collect::<Vec<_>>()),
        ranks(&known.iter().map(|pair| pair.1).collect::<Vec<_>>()),
    ];
    let mean = f64::midpoint(known.len() as f64, 1.0);
    let product = |x: &[f64], y: &[f64]| -> f64 {
        (x.iter().zip(y))
            .map(|(x, y)| (x - mean) * (y - mean))
            .sum()
    };
    let scale = (product(&a, &a) * product(&b, &b)).sqrt();
    (scale > 0.0).then(|| product(&a, &b) / scale)
}

/// Ranks from 1; those of equal values are their mean.
fn ranks(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
    let mut ranks = vec![0.0; values.len()];
    let mut before = 0;
    for equal in order.chunk_by(|a, b| values[*a] == values[*b]) {
        let rank = before as f64 + f64::midpoint(equal.len() as f64, 1.0);
        for place in equal {
            ranks[*place] = rank;
        }
        before += equal.len();
    }
    ranks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranks_see_what_grows_however_it_grows() {
        let x: Vec<f64> = (0..20).map(f64::from).collect();
        let grows: Vec<f64> = x.iter().map(|x| x.exp()).collect();
        let falls: Vec<f64> = x.iter().map(|x| -x.powi(3)).collect();
        assert_eq!(rank_correlation(&x, &grows), Some(1.0));
        assert_eq!(rank_correlation(&x, &falls), Some(-1.0));
        assert_eq!(rank_correlation(&x, &[1.0; 20]), None);
        // Ties: 1 2.5 2.5 4 against 1 2 3 4, by hand 4.5 / sqrt(4.5 5).
        let tied = rank_correlation(&[1.0, 2.0, 2.0, 3.0], &[1.0, 2.0, 3.0, 4.0]).unwrap();
        assert!((tied - 4.5 / 22.5f64.sqrt()).abs() < 1e-12, "{tied}");
    }
}
