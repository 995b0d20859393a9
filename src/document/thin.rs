//! Which samples of a chart are kept where there are more than can be shown. Of each stretch of a line the least and the largest, so that no peak is lost
//! however far one looks away. Of a cloud an even pick: its extremes alone would look like a wider cloud.

/// By it no series is left out, however the samples of several alternate, as a pick of every n-th might.
const GOLDEN_SECTION: f64 = 0.618_033_988_749_894_9;

/// Indices of the samples that are kept, at most about `most`, in order; all where there are not more.
#[must_use]
pub fn kept(count: usize, lines: &[&[f64]], clouds: &[&[f64]], most: usize) -> Vec<usize> {
    let columns = lines.len() + clouds.len();
    if count <= most || columns == 0 {
        return (0..count).collect();
    }
    let mut kept = vec![0, count - 1];
    let stretches = (most / (2 * columns)).max(1);
    for stretch in 0..stretches {
        let from = stretch * count / stretches;
        let to = (stretch + 1) * count / stretches;
        // A gap stays a gap.
        for values in lines {
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
    let in_cloud = |i: &usize| clouds.iter().any(|values| values[*i].is_finite());
    let points: Vec<usize> = (0..count).filter(in_cloud).collect();
    let share = (most * clouds.len() / columns) as f64 / points.len().max(1) as f64;
    let picked = points.iter().enumerate();
    kept.extend(
        picked
            .filter(|(place, _)| (*place as f64 * GOLDEN_SECTION).fract() < share)
            .map(|(_, i)| i),
    );
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
        let kept = kept(one.len(), &[&one, &other], &[], 4000);
        assert!(kept.len() <= 5000, "{}", kept.len());
        assert!(kept.contains(&31_415) && kept.contains(&27_182));
        assert!(kept.iter().any(|i| one[*i].is_nan()));
        assert!(kept.is_sorted() && kept[0] == 0 && kept[kept.len() - 1] == 99_999);
    }

    #[test]
    fn of_clouds_that_alternate_each_keeps_its_share() {
        let own = |owner: usize| -> Vec<f64> {
            let value = |i: usize| if i % 2 == owner { 1.0 } else { f64::NAN };
            (0..9000).map(value).collect()
        };
        let clouds = [own(0), own(1)];
        let kept = kept(9000, &[], &[&clouds[0], &clouds[1]], 900);
        for cloud in &clouds {
            let points = kept.iter().filter(|i| cloud[**i].is_finite()).count();
            assert!(points.abs_diff(450) < 10, "{points}");
        }
    }

    #[test]
    fn what_is_little_is_kept_whole() {
        assert_eq!(kept(5, &[&[1.0; 5]], &[], 10), [0, 1, 2, 3, 4]);
    }
}
