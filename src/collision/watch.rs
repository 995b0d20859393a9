//! Bodies watched while a cell runs: what each pair has left of its clearance is worked off by how far its bodies move, and measured again where it is used up.

use super::Positions;
use super::model::{CollisionModel, Links};

/// Distance beyond which pairs are not measured, but bounded [m]: some frames' way.
const NEAR: f64 = 5e-3;

/// Clearances of all pairs of a model.
#[derive(Clone)]
pub struct ClearanceWatch {
    model: CollisionModel,
    /// Poses of the links at the last frame.
    links: Links,
    /// What each pair has left [m].
    left: Vec<f64>,
}

impl ClearanceWatch {
    /// Starts at joint positions. Only true contacts count, without a margin.
    #[must_use]
    pub fn new(mut model: CollisionModel, positions: &Positions) -> Self {
        model
            .pairs
            .retain(|pair| pair.other.is_some() && pair.margin >= 0.0);
        let left = vec![0.0; model.pairs.len()];
        Self {
            links: model.links(positions),
            model,
            left,
        }
    }

    /// Goes on to joint positions; the first pair that meets there, by name, with its depth [m].
    pub fn meets(&mut self, positions: &Positions) -> Option<([String; 2], f64)> {
        let links = self.model.links(positions);
        let before = std::mem::replace(&mut self.links, links);
        for (pair, left) in self.model.pairs.iter().zip(&mut self.left) {
            // Only where the bodies are at the frames counts.
            *left -= self.model.shift(pair, [&before, &links]);
            if *left > 0.0 {
                continue;
            }
            *left = self.model.distance(pair, &links, NEAR);
            if *left <= 0.0 {
                let depth = self.model.depth(pair, &links, 0.0);
                return Some((self.model.named(pair), depth));
            }
        }
        None
    }
}
