//! Reliability of stated probabilities: of the names given with about a probability, the share that is right.
//!
//! ```text
//! B = mean of (p - o)^2
//! ```
//!
//! B Brier score (Monthly Weather Review 78, 1950), p stated probability of a name, o 1 where it is right and else 0. To say 1/2 of everything scores 0.25.

use serde::Serialize;

use super::score::StatedName;

/// Edges of the bins of stated probability [1].
const EDGES: [f64; 6] = [0.0, 0.5, 0.8, 0.9, 0.99, 1.0];
/// Stated probability from which a name counts as sure [1].
const SURE: f64 = 0.9;

/// Names stated with a probability within a bin.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ReliabilityBin {
    /// The bin's ends [1].
    pub stated: [f64; 2],
    /// Names.
    pub count: usize,
    /// Names that are right.
    pub right: usize,
    /// Mean of the stated probabilities [1].
    pub mean: f64,
}

/// Reliability of all names of some answers.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Reliability {
    /// Bins that hold any name.
    pub bins: Vec<ReliabilityBin>,
    /// Brier score [1].
    pub brier: f64,
    /// Names stated with a probability above 0.9 that are right, of how many.
    pub sure: [usize; 2],
    /// Right names stated so, of all right names.
    pub sure_of_right: [usize; 2],
}

impl Reliability {
    /// Of stated names; none where there are none.
    #[must_use]
    pub fn of<'a>(names: impl IntoIterator<Item = &'a StatedName>) -> Option<Self> {
        let all: Vec<&StatedName> = names.into_iter().collect();
        let count = |of: &dyn Fn(&StatedName) -> bool| all.iter().filter(|n| of(n)).count();
        if all.is_empty() {
            return None;
        }
        let outcome = |name: &StatedName| f64::from(u8::from(name.right));
        let last = EDGES.len() - 2;
        let bin = |(index, ends): (usize, &[f64])| {
            let within = |name: &&&StatedName| {
                name.probability >= ends[0] && (name.probability < ends[1] || index == last)
            };
            let own: Vec<&&StatedName> = all.iter().filter(within).collect();
            (!own.is_empty()).then(|| ReliabilityBin {
                stated: [ends[0], ends[1]],
                count: own.len(),
                right: own.iter().filter(|name| name.right).count(),
                mean: own.iter().map(|name| name.probability).sum::<f64>() / own.len() as f64,
            })
        };
        let squares = all.iter().map(|n| (n.probability - outcome(n)).powi(2));
        let sure_and_right = count(&|n| n.probability > SURE && n.right);
        Some(Self {
            bins: EDGES.windows(2).enumerate().filter_map(bin).collect(),
            brier: squares.sum::<f64>() / all.len() as f64,
            sure: [sure_and_right, count(&|n| n.probability > SURE)],
            sure_of_right: [sure_and_right, count(&|n| n.right)],
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(of: &[(f64, bool)]) -> Vec<StatedName> {
        let name = |(probability, right): &(f64, bool)| StatedName {
            name: "lag".to_owned(),
            probability: *probability,
            right: *right,
        };
        of.iter().map(name).collect()
    }

    #[test]
    fn the_score_of_knowing_saying_half_and_of_being_surely_wrong() {
        let score = |of: &[(f64, bool)]| Reliability::of(&names(of)).unwrap().brier;
        assert_eq!(score(&[(1.0, true), (0.0, false)]), 0.0);
        assert_eq!(score(&[(0.5, true), (0.5, false), (0.5, true)]), 0.25);
        assert_eq!(score(&[(1.0, false)]), 1.0);
        assert_eq!(Reliability::of(&[]), None);
    }

    #[test]
    fn names_fall_into_their_bins_once() {
        let found = Reliability::of(&names(&[
            (0.3, false),
            (0.9, true),
            (0.95, false),
            (0.99, true),
            (1.0, true),
        ]))
        .unwrap();
        let bins: Vec<(f64, usize, usize)> = found
            .bins
            .iter()
            .map(|b| (b.stated[0], b.count, b.right))
            .collect();
        assert_eq!(bins, [(0.0, 1, 0), (0.9, 2, 1), (0.99, 2, 2)]);
        assert_eq!((found.sure, found.sure_of_right), ([2, 3], [2, 3]));
        assert!((found.bins[1].mean - 0.925).abs() < 1e-12);
    }
}
