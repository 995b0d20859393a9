//! Worth of an explanation of a part of the device: the same without each of its effects, and with the laws that could stand in an effect's place.

use super::fit::{FULL, Fit, Limit, Stage, fit};
use super::free::free_of;
use super::hypothesis::Hypothesis;
use super::search::Search;
use crate::effects::{Clues, Effect};
use crate::plant::Channel;

/// An explanation that was tried and does worse.
#[derive(Debug, Clone)]
pub struct RuledOut {
    /// Names of its effects.
    pub effects: Vec<&'static str>,
    /// Root mean square of what it leaves of the channel, in the channel's unit.
    pub rms: f64,
    /// Its numbers, effect by effect.
    pub numbers: Vec<(&'static str, f64)>,
}

/// Variants of an explanation, the best first.
pub fn ruled_out(search: &Search<'_>, best: &Hypothesis, channel: Channel) -> Vec<RuledOut> {
    let mut variants = exchanges(search, best);
    for place in 0..best.effects.len() {
        let mut without = best.effects.clone();
        without.remove(place);
        variants.push(without);
    }
    let mut found: Vec<RuledOut> = variants
        .into_iter()
        .filter_map(|effects| {
            let fit = variant(search, &effects, &FULL[FULL.len() - 1..])?;
            Some(described(search, &effects, &fit, channel))
        })
        .collect();
    found.sort_by(|a, b| a.rms.total_cmp(&b.rms));
    found
}

/// The effects of an explanation with another law in the place of one that it excludes.
pub(super) fn exchanges(search: &Search<'_>, best: &Hypothesis) -> Vec<Vec<&'static Effect>> {
    let mut variants = Vec::new();
    for (place, effect) in best.effects.iter().enumerate() {
        let rivals = search.candidates.iter().copied();
        for rival in rivals.filter(|rival| rival.excludes(effect) && rival.name != effect.name) {
            let mut other = best.effects.clone();
            other[place] = rival;
            variants.push(other);
        }
    }
    variants
}

/// A set of effects, fitted from each start of each.
pub(super) fn variant(
    search: &Search<'_>,
    effects: &[&'static Effect],
    stages: &[Stage],
) -> Option<Fit> {
    let believed = &search.believed;
    let clues = Clues {
        plant: believed,
        largest_force: 0.0,
        periodic: &[],
        bumps: &[],
    };
    // Each effect's starts in turn, the others at their last where they have less.
    let starts: Vec<Vec<Vec<f64>>> = effects.iter().map(|e| e.starts(&clues)).collect();
    let most = starts.iter().map(Vec::len).max().unwrap_or(1);
    let tried = (0..most).map(|turn| {
        let mut free = search.tolerated.clone();
        for (effect, starts) in effects.iter().zip(&starts) {
            free.extend(free_of(
                effect,
                believed,
                &starts[turn.min(starts.len() - 1)],
            ));
        }
        let from = (believed, None);
        fit(search.evidence, from, (&free, &[]), stages, Limit::of(40))
    });
    tried.min_by(|a, b| a.cost().total_cmp(&b.cost()))
}

fn described(
    search: &Search<'_>,
    effects: &[&'static Effect],
    best: &Fit,
    channel: Channel,
) -> RuledOut {
    let index = channel as usize;
    let (mut squares, mut count) = (0.0, 0.0);
    let trajectories = search
        .evidence
        .recordings
        .iter()
        .zip(&best.prediction.trajectories);
    for (measured, trajectory) in trajectories {
        for (m, p) in measured.readings[index]
            .iter()
            .zip(&trajectory.readings[index])
        {
            if (m - p).is_finite() {
                squares += (m - p).powi(2);
                count += 1.0;
            }
        }
    }
    let own = best
        .free
        .iter()
        .zip(&best.values)
        .skip(search.tolerated.len());
    RuledOut {
        effects: effects.iter().map(|effect| effect.name).collect(),
        rms: (squares / f64::max(count, 1.0)).sqrt(),
        numbers: own
            .map(|(free, value)| (free.quantity.name, *value))
            .collect(),
    }
}
