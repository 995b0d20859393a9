//! The arm's ripple, of the force while it slides: its size meets the spread of the force, its bandwidth the spread of the averaged force (`super::prediction::spreads`).

use super::prediction::{Logged, logged, spreads};
use crate::flange::{FlangeModel, Ripple};

/// Bandwidths looked at [Hz].
const BANDWIDTHS: [f64; 11] = [
    4.0, 6.0, 8.0, 11.0, 15.0, 21.0, 29.0, 40.0, 55.0, 76.0, 105.0,
];
/// Ripple: least and largest [1], halvings of what is between.
const RATIOS: (f64, f64, u32) = (1e-4, 1.0, 12);

/// The ripple with which a flange spreads the force as some runs that slide do; none without such runs.
pub(super) fn ripple(model: &FlangeModel, runs: &[Logged<'_>]) -> Option<Ripple> {
    let sliding: Vec<(&Logged<'_>, [f64; 2], [f64; 2])> = (runs.iter())
        .filter_map(|run| {
            let slides = run.sliding()?;
            Some((run, slides, run.recorded_spreads(slides)))
        })
        .collect();
    if sliding.is_empty() {
        return None;
    }
    // Squares of both spreads, simulated less recorded, summed over the runs.
    let excess = |ripple: Ripple| -> [f64; 2] {
        let mut sums = [0.0; 2];
        for (run, slides, recorded) in &sliding {
            let force = logged(model, &run.course.with_ripple(ripple), run, 0.0);
            let found = spreads(&run.time[..force.len()], &force, *slides);
            for k in 0..2 {
                sums[k] += found[k].powi(2) - recorded[k].powi(2);
            }
        }
        sums
    };
    let candidates = BANDWIDTHS.map(|bandwidth| {
        let (mut low, mut high) = (RATIOS.0, RATIOS.1);
        for _ in 0..RATIOS.2 {
            let ratio = (low * high).sqrt();
            match excess(Ripple { ratio, bandwidth })[0] > 0.0 {
                true => high = ratio,
                false => low = ratio,
            }
        }
        let ripple = Ripple {
            ratio: (low * high).sqrt(),
            bandwidth,
        };
        (excess(ripple)[1].abs(), ripple)
    });
    let best = candidates.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
    best.map(|(_, ripple)| ripple)
}
