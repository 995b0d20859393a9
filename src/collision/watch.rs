//! Bodies watched while a cell runs: what each pair has left of its clearance is worked off by the joints' ways, and measured again where it is used up.

use super::Positions;
use super::model::CollisionModel;

/// Clearances of all pairs of a model.
#[derive(Clone)]
pub struct ClearanceWatch {
    model: CollisionModel,
    positions: Positions,
    /// What each pair has left [m].
    left: Vec<f64>,
}

impl ClearanceWatch {
    /// Starts at joint positions. Only true contacts count, without a margin.
    #[must_use]
    pub fn new(mut model: CollisionModel, positions: Positions) -> Self {
        model
            .pairs
            .retain(|pair| pair.other.is_some() && pair.margin >= 0.0);
        let left = vec![0.0; model.pairs.len()];
        Self {
            model,
            positions,
            left,
        }
    }

    /// Goes on to joint positions; the first pair that meets there, by name, with its depth [m].
    pub fn meets(&mut self, positions: &Positions) -> Option<([String; 2], f64)> {
        let mut ways = *positions;
        for (way, before) in ways.iter_mut().zip(&self.positions) {
            *way = (*way - before).abs();
        }
        self.positions = *positions;
        let mut links = None;
        for (pair, left) in self.model.pairs.iter().zip(&mut self.left) {
            *left -= pair.moved_by(&ways);
            if *left > 0.0 {
                continue;
            }
            let links = links.get_or_insert_with(|| self.model.links(positions));
            *left = self.model.distance(pair, links, f64::INFINITY);
            if *left <= 0.0 {
                let depth = self.model.depth(pair, links, 0.0);
                return Some((self.model.named(pair), depth));
            }
        }
        None
    }
}
