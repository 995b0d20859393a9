//! Worth of an explanation of a part of the device: the same without each of its effects, and with the laws that could stand in an effect's place.

use super::progress::{Observer, Step};
use super::{Search, same};
use crate::diagnosis::answer::family::is_alike;
use crate::diagnosis::fit::free::free_of;
use crate::diagnosis::fit::hypothesis::Hypothesis;
use crate::diagnosis::fit::{FINEST, FULL, Fit, Limit, Stage, fit};
use crate::effects::{Clues, Effect};
use crate::plant::Channel;

/// Times that laws are exchanged in an explanation that an exchange has led to.
const MOST_EXCHANGES: usize = 3;

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
            let fit = variant(search, &effects, FINEST)?;
            Some(described(search, &effects, &fit, channel))
        })
        .collect();
    found.sort_by(|a, b| a.rms.total_cmp(&b.rms));
    found
}

/// The effects of an explanation with another law in the place of one that it excludes, or that is of its family.
pub(in crate::diagnosis) fn exchanges(
    search: &Search<'_>,
    best: &Hypothesis,
) -> Vec<Vec<&'static Effect>> {
    let mut variants = Vec::new();
    for (place, effect) in best.effects.iter().enumerate() {
        let fits = |rival: &Effect| {
            let mut others = best.effects.iter().enumerate();
            others.all(|(other, e)| other == place || !rival.excludes(e))
        };
        let rivals = search.candidates.iter().copied();
        for rival in rivals.filter(|r| r.name != effect.name && is_alike(r, effect) && fits(r)) {
            let mut other = best.effects.clone();
            other[place] = rival;
            variants.push(other);
        }
    }
    variants
}

/// A set of effects, fitted from each start of each.
pub(in crate::diagnosis) fn variant(
    search: &Search<'_>,
    effects: &[&'static Effect],
    stages: &[Stage],
) -> Option<Fit> {
    let nominal = &search.nominal;
    let clues = Clues {
        plant: nominal,
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
            let own = free_of(effect, nominal, &starts[turn.min(starts.len() - 1)]);
            free.retain(|f| !own.iter().any(|o| same(o, f, nominal)));
            free.extend(own);
        }
        let from = (nominal, None);
        fit(search.evidence, from, (&free, &[]), stages, Limit::of(40))
    });
    tried.min_by(|a, b| a.cost().total_cmp(&b.cost()))
}

/// Adds the best explanation with another law in the place of one of its own, where that was not fitted: a search that goes effect by effect, each from one
/// start, may have passed it, and of laws that are alike none is stated before the others were tried.
pub(in crate::diagnosis) fn add_exchanged(
    search: &Search<'_>,
    found: &mut Vec<Hypothesis>,
    observer: &mut Observer<'_>,
) {
    for _ in 0..MOST_EXCHANGES {
        let Some(best) = found.first().filter(|best| best.unlisted().is_none()) else {
            return;
        };
        let own = best.names();
        for effects in exchanges(search, best) {
            let mut names: Vec<&str> = effects.iter().map(|e| e.name).collect();
            names.sort_unstable();
            if search.is_spent() || found.iter().any(|known| known.names() == names) {
                continue;
            }
            let Some(fit) = variant(search, &effects, FULL) else {
                continue;
            };
            let exchanged = Hypothesis {
                effects,
                fit,
                depends_on: Vec::new(),
            };
            let detail = format!("exchanged {:.1}", search.score(&exchanged));
            observer(&Step::Variation.of(&exchanged, detail));
            found.push(exchanged);
        }
        found.sort_by(|a, b| search.score(a).total_cmp(&search.score(b)));
        if found[0].names() == own {
            return;
        }
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::test_evidence::{evidence_of, plant, search};
    use crate::effects::{NUMBERS_OFF, every};

    fn effect(name: &str) -> &'static Effect {
        every().find(|e| e.name == name).unwrap()
    }

    /// A real piston of a bore 3 % off was named a load cell's gain, and the bore not at all: of laws that are alike the search had come to one alone.
    #[test]
    fn of_laws_that_are_alike_the_others_are_tried_too() {
        let gain = effect("force_sensor_gain_error");
        let bore = &NUMBERS_OFF[0];
        let mut truth = plant();
        truth.sensors.force_gain = 1.05;
        let evidence = evidence_of(&truth, vec![vec![1.5e5; 126], vec![2.5e5; 126]]);
        let mut search = search(&evidence);
        search.candidates = vec![gain, bore, effect("heat_transfer")];
        let starts = variant(&search, &[gain], FULL).unwrap();
        let mut found = vec![Hypothesis {
            effects: vec![gain],
            fit: starts,
            depends_on: Vec::new(),
        }];
        add_exchanged(&search, &mut found, &mut |_| ());
        let names: Vec<Vec<&str>> = found.iter().map(Hypothesis::names).collect();
        assert_eq!(names, [vec![gain.name], vec![bore.name]]);
        // It was fitted, not only put there: a force by pressure of 5 % more takes a bore of 2.5 % more.
        let off = found[1].fit.values[0] / plant().device.bore;
        assert!((1.01..1.04).contains(&off), "{off}");
        // What excludes another effect of the explanation stands in no one's place.
        let both = Hypothesis {
            effects: vec![gain, bore],
            ..found.swap_remove(0)
        };
        assert!(exchanges(&search, &both).is_empty());
    }
}
