//! Places along a cell's edge where what is left in the stroke stands out: the same place in every recording.

use crate::diagnosis::recordings::evidence::{Evidence, Prediction};

/// Length of edge over which residuals are taken together [m].
const CELL: f64 = 2e-3;
/// Lengths on either side of a place that it is held against: the nearest ones may belong to the bump.
const BESIDE: [usize; 2] = [4, 10];
/// Places that are given.
const MOST: usize = 3;

/// Places [m], strongest first: where the mean residual of the stroke departs most, in its standard deviations, from that of the edge beside it.
pub fn strongest(evidence: &Evidence, prediction: &Prediction) -> Vec<f64> {
    let mut sums: Vec<(f64, f64)> = Vec::new();
    let mut at = 0;
    for (measured, trajectory) in evidence.recordings.iter().zip(&prediction.trajectories) {
        let n = measured.inputs.time.len();
        let stroke = &prediction.residuals[at + n..at + 2 * n];
        at += 4 * n;
        let Some(cell) = &measured.inputs.cell else {
            continue;
        };
        for (i, left) in stroke.iter().enumerate() {
            // Where the tool stands still it rests on one place for long.
            let moves = i > 0 && cell.edge[i].station != cell.edge[i - 1].station;
            if !moves || trajectory.truth.contact_force[i] <= 0.0 || !left.is_finite() {
                continue;
            }
            let index = (cell.edge[i].station / CELL).max(0.0) as usize;
            if sums.len() <= index {
                sums.resize(index + 1, (0.0, 0.0));
            }
            sums[index].0 += left;
            sums[index].1 += 1.0;
        }
    }
    let departure = |index: usize| {
        let (sum, count) = sums[index];
        let near = sums.iter().enumerate().filter(|(other, _)| {
            let away = index.abs_diff(*other);
            (BESIDE[0]..=BESIDE[1]).contains(&away)
        });
        let (beside, number) = near.fold((0.0, 0.0), |(s, n), (_, c)| (s + c.0, n + c.1));
        if count == 0.0 || number == 0.0 {
            return 0.0;
        }
        (sum / count - beside / number).abs() / (1.0 / count + 1.0 / number).sqrt()
    };
    let mut places: Vec<(f64, usize)> = (0..sums.len()).map(|i| (departure(i), i)).collect();
    places.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut found: Vec<usize> = Vec::new();
    for (_, index) in places {
        if found.len() < MOST && found.iter().all(|other| other.abs_diff(index) > BESIDE[0]) {
            found.push(index);
        }
    }
    found
        .iter()
        .map(|index| (*index as f64 + 0.5) * CELL)
        .collect()
}
