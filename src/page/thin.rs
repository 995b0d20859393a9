//! Which samples of a chart are kept where there are more than can be shown: of each stretch the least and the largest of every series, so that no peak
//! is lost however far one looks away.

/// Indices of the samples that are kept, at most about `most`, in order; all where there are not more.
#[must_use]
pub fn kept(count: usize, series: &[&[f64]], most: usize) -> Vec<usize> {
    if count <= most || series.is_empty() {
        return (0..count).collect();
    }
    let stretches = (most / (2 * series.len())).max(1);
    let mut kept = vec![0, count - 1];
    for stretch in 0..stretches {
        let from = stretch * count / stretches;
        let to = (stretch + 1) * count / stretches;
        // A gap stays a gap.
        for values in series {
            let known = (from..to).filter(|i| values[*i].is_finite());
            kept.extend(
                known
                    .clone()
                    .min_by(|a, b| values[*a].total_cmp(&values[*b])),
            );
            kept.extend(known.max_by(|a, b| values[*a].total_cmp(&values[*b])));
            kept.extend((from..to).find(|i| values[*i].is_nan()));
        }
    }
    kept.sort_unstable();
    kept.dedup();
    kept
}

#[cfg(test)]
mod tests {
    use super::kept;

    #[test]
    fn every_peak_is_kept_and_no_more_than_asked() {
        let mut one: Vec<f64> = (0..100_000)
            .map(|i| (f64::from(i) * 1e-3).sin() * 0.1)
            .collect();
        let other = vec![0.0; 100_000];
        one[31_415] = 7.0;
        one[27_182] = -7.0;
        one[50_000..50_010].fill(f64::NAN);
        let kept = kept(one.len(), &[&one, &other], 4000);
        assert!(kept.len() <= 5000, "{}", kept.len());
        assert!(kept.contains(&31_415) && kept.contains(&27_182));
        assert!(kept.iter().any(|i| one[*i].is_nan()));
        assert!(kept.is_sorted() && kept[0] == 0 && kept[kept.len() - 1] == 99_999);
    }

    #[test]
    fn what_is_little_is_kept_whole() {
        assert_eq!(kept(5, &[&[1.0; 5]], 10), [0, 1, 2, 3, 4]);
    }
}
