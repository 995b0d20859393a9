//! The trade-off front: designs of which none is better in both objectives.

/// Positions of the points that no other one dominates, sorted by the first coordinate; both are minimised. Of equal points the first counts.
pub(super) fn non_dominated(points: &[[f64; 2]]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&a, &b| {
        points[a][0]
            .total_cmp(&points[b][0])
            .then(points[a][1].total_cmp(&points[b][1]))
    });
    let mut lowest = f64::INFINITY;
    order.retain(|&index| {
        let better = points[index][1] < lowest;
        lowest = lowest.min(points[index][1]);
        better
    });
    order
}

/// Thins a sorted front to points that differ by more than a share of its extent in one coordinate at least; both ends stay.
pub(super) fn thinned(points: &[[f64; 2]], front: &[usize], share: f64) -> Vec<usize> {
    let (Some(&first), Some(&last)) = (front.first(), front.last()) else {
        return Vec::new();
    };
    let extent = [0, 1].map(|axis| (points[last][axis] - points[first][axis]).abs());
    let apart = |a: usize, b: usize| {
        (0..2).any(|axis| (points[a][axis] - points[b][axis]).abs() > share * extent[axis])
    };
    let mut kept = vec![first];
    for &index in front {
        if kept.last().is_some_and(|&before| apart(before, index)) && apart(index, last) {
            kept.push(index);
        }
    }
    if last != first {
        kept.push(last);
    }
    kept
}

/// The widest gaps between neighbours of a sorted front, at most `count`, by the first coordinates of their ends; both axes count by their extent.
pub(super) fn widest_gaps(points: &[[f64; 2]], front: &[usize], count: usize) -> Vec<[f64; 2]> {
    let (Some(&first), Some(&last)) = (front.first(), front.last()) else {
        return Vec::new();
    };
    let extent = [0, 1].map(|axis| (points[last][axis] - points[first][axis]).abs());
    let mut gaps: Vec<(f64, [f64; 2])> = front
        .windows(2)
        .map(|pair| {
            let [a, b] = [points[pair[0]], points[pair[1]]];
            let share = |axis: usize| (b[axis] - a[axis]).abs() / extent[axis];
            (share(0).hypot(share(1)), [a[0], b[0]])
        })
        .collect();
    // Stable: of equals the first stays first.
    gaps.sort_by(|a, b| b.0.total_cmp(&a.0));
    gaps.into_iter().take(count).map(|(_, ends)| ends).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dominated_and_equal_points_are_left_out() {
        let points = [
            [3.0, 1.0],
            [1.0, 5.0],
            [2.0, 2.0],
            [2.0, 3.0],
            [2.0, 2.0],
            [4.0, 1.0],
            [1.0, 6.0],
        ];
        assert_eq!(non_dominated(&points), [1, 2, 0]);
        assert!(non_dominated(&[]).is_empty());
    }

    #[test]
    fn a_thinned_front_keeps_its_ends() {
        let points: Vec<[f64; 2]> = (0..=1000)
            .map(|i| [f64::from(i) / 1000.0, 1.0 - f64::from(i) / 1000.0])
            .collect();
        let front = non_dominated(&points);
        let kept = thinned(&points, &front, 0.05);
        assert!((15..=21).contains(&kept.len()), "{}", kept.len());
        assert_eq!((kept[0], kept[kept.len() - 1]), (0, 1000));
    }

    #[test]
    fn the_widest_gaps_count_both_axes() {
        let points = [
            [0.0, 10.0],
            [10.0, 9.0],
            [20.0, 2.0],
            [90.0, 1.0],
            [100.0, 0.0],
        ];
        let front = non_dominated(&points);
        assert_eq!(
            widest_gaps(&points, &front, 2),
            [[10.0, 20.0], [20.0, 90.0]]
        );
        assert_eq!(widest_gaps(&points, &front, 9).len(), 4);
        assert!(widest_gaps(&points, &front[..1], 9).is_empty());
    }
}
