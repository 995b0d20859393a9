//! Which effects promise to explain what a hypothesis leaves: one simulation a start, derivatives of those that promise, a short fit of the best.

use super::super::fit::{Limit, Stage, fit, jacobian, linearised_cost, with_values};
use super::{Search, same};
use crate::diagnosis::difference::bumps;
use crate::diagnosis::difference::spectrum::{self, Line};
use crate::diagnosis::fit::free::{Free, Prior, free_of};
use crate::diagnosis::fit::hypothesis::Hypothesis;
use crate::diagnosis::recordings::evidence::Prediction;
use crate::effects::{Clues, Coordinate, Effect, Subsystem};
use crate::plant::{Latent, PlantParameters, Quantity, registry};
use rayon::prelude::*;

/// Effects whose starts are looked at with all their derivatives, beside those that have no secant.
const GLANCED_AT: usize = 14;
/// Cost over the least beyond which they are not [1].
const GLANCED_BEHIND: f64 = 10.0;
/// Starts of each.
const STARTS_OF_EACH: usize = 2;
/// Change of a residual that is none [1].
const UNCHANGED: f64 = 1e-6;
/// The way from no effect to a start: 1 there.
const WAY: Free = Free {
    quantity: registry::WAY.quantity(),
    start: 0.0,
    coordinate: Coordinate::Linear(1.0),
    bounds: [-3.0, 3.0],
    prior: Prior::Flat,
};
/// Phase of what is periodic in a recording: any.
pub(super) const PHASE: Free = Free {
    quantity: registry::RUNOUT_PHASE.quantity(),
    start: 0.0,
    coordinate: Coordinate::Linear(0.1),
    bounds: [-20.0, 20.0],
    prior: Prior::Flat,
};
/// Number of effects that get a second look.
const LOOKED_AT: usize = 7;
/// Cost over the least beyond which they get none [1].
const LOOKED_BEHIND: f64 = 10.0;

/// An effect and where it may start.
#[derive(Debug, Clone)]
struct Start {
    effect: &'static Effect,
    values: Vec<f64>,
    /// Phases in the recordings after the first, where those differ.
    phases: Vec<Free>,
}

/// Promise of an effect.
#[derive(Debug, Clone)]
struct Promise {
    /// Where it may start.
    start: Start,
    /// Cost that a hypothesis with it could come to [1].
    cost: f64,
}

impl Start {
    /// An effect from these values, its phases where the line at its frequency has one in each recording.
    fn at(effect: &'static Effect, values: Vec<f64>, lines: &[Line]) -> Self {
        let line = lines
            .iter()
            .find(|line| values.first() == Some(&line.frequency));
        let phases = match (effect.phase, line) {
            (Some(phase), Some(line)) => (line.phases.iter())
                .map(|(recording, start)| Free {
                    quantity: phase.quantity().of(*recording),
                    start: *start,
                    ..PHASE
                })
                .collect(),
            _ => Vec::new(),
        };
        Self {
            effect,
            values,
            phases,
        }
    }

    /// Its numbers as free quantities, then its phases.
    fn free(&self, plant: &PlantParameters) -> Vec<Free> {
        let mut free = free_of(self.effect, plant, &self.values);
        free.extend(&self.phases);
        free
    }
}

impl Search<'_> {
    /// Further gain of each effect, roughly: columns of what is free already are taken as they are. Best first; without those that by their
    /// derivatives cost more than `most`.
    pub fn screen(&self, from: &Hypothesis, stages: &[Stage], most: f64) -> Vec<Hypothesis> {
        let lines = spectrum::strongest(self.evidence, &from.fit.prediction);
        let periodic: Vec<f64> = lines.iter().map(|line| line.frequency).collect();
        let bumps = bumps::strongest(self.evidence, &from.fit.prediction);
        let clues = self.clues(from, &periodic, &bumps);
        let starts: Vec<Start> = self
            .candidates
            .iter()
            .copied()
            .filter(|effect| !from.effects.iter().any(|e| e.excludes(effect)))
            .flat_map(|effect| {
                (effect.starts(&clues).into_iter())
                    .chain(self.start_within(from, effect))
                    .map(|values| Start::at(effect, values, &lines))
                    .collect::<Vec<Start>>()
            })
            .collect();
        let stage = &stages[0];
        let there: Vec<Prediction> = starts
            .par_iter()
            .map(|start| self.started(from, start, stage))
            .collect();
        let secants: Vec<Option<Promise>> = (starts.par_iter().zip(&there))
            .map(|(start, there)| self.secant(from, start, there, stage))
            .collect();
        let glanced = worth_a_glance(&starts, &secants);
        let promises: Vec<Promise> = glanced
            .par_iter()
            .map(|&index| {
                let glance = self.glance(from, &starts[index], &there[index], stage);
                match &secants[index] {
                    Some(secant) if secant.cost < glance.cost => secant.clone(),
                    _ => glance,
                }
            })
            .collect();
        let mut best = best_of_each(promises);
        best.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        let near = LOOKED_BEHIND * best.first().map_or(0.0, |promise| promise.cost);
        best.retain(|promise| promise.cost <= near && promise.cost <= most);
        best.truncate(LOOKED_AT);
        let mut looked: Vec<Hypothesis> = best
            .par_iter()
            .map(|promise| self.add(from, &promise.start, stages, self.look))
            .collect();
        let score = |hypothesis: &Hypothesis| match stages[0].guided {
            true => self.rough_score(hypothesis),
            false => self.score(hypothesis),
        };
        looked.sort_by(|a, b| score(a).total_cmp(&score(b)));
        looked
    }

    /// Where an effect stands that frees what is tolerated: small ones lie just beyond the tolerance.
    fn start_within(&self, from: &Hypothesis, effect: &Effect) -> Option<Vec<f64>> {
        let parameters = effect.parameters(&self.nominal);
        let is_tolerated =
            |quantity: &Quantity| self.tolerated.iter().any(|f| f.quantity.is(quantity));
        let all = !parameters.is_empty() && parameters.iter().all(|p| is_tolerated(&p.quantity));
        let present = parameters
            .iter()
            .map(|p| p.quantity.get(&from.fit.prediction.plant));
        all.then(|| present.collect())
    }

    /// Free quantities that stay free beside an effect, with their columns.
    fn beside(&self, from: &Hypothesis, new: &[Free]) -> (Vec<Free>, Vec<Vec<f64>>) {
        let fitted = from
            .fit
            .free
            .iter()
            .zip(&from.fit.values)
            .zip(&from.fit.columns);
        fitted
            // What an effect frees is no longer held to its tolerance.
            .filter(|((f, _), _)| !new.iter().any(|n| same(n, f, &self.nominal)))
            .map(|((f, value), column)| (f.from(*value), column.clone()))
            .unzip()
    }

    /// Prediction of a hypothesis with one more effect at a start.
    fn started(&self, from: &Hypothesis, start: &Start, stage: &Stage) -> Prediction {
        let new = start.free(&self.nominal);
        let known = &from.fit.prediction;
        let values: Vec<f64> = new.iter().map(|f| f.start).collect();
        let plant = with_values(&known.plant, &new, &values);
        self.evidence.predict(&plant, stage.guided, Some(known))
    }

    /// Promise of one more effect on the straight way to a start and beyond, without a simulation more; none where only derivatives tell: of what has
    /// a phase, of a start that changes nothing, such as a force of zero, and of sensors, whose derivatives are cheap.
    fn secant(
        &self,
        from: &Hypothesis,
        start: &Start,
        there: &Prediction,
        stage: &Stage,
    ) -> Option<Promise> {
        let new = start.free(&self.nominal);
        if start.effect.subsystem == Subsystem::Sensors || start.effect.phase.is_some() {
            return None;
        }
        let here = &from.fit.prediction;
        let along = there.residuals.iter().zip(&here.residuals);
        let way: Vec<f64> = along.map(|(there, here)| there - here).collect();
        if !way.iter().any(|change| change.abs() > UNCHANGED) {
            return None;
        }
        let (mut free, mut columns) = self.beside(from, &new);
        let mut values: Vec<f64> = free.iter().map(|f| f.start).collect();
        columns.push(way);
        free.push(WAY);
        values.push(0.0);
        let (cost, reached) = linearised_cost(self.evidence, here, &free, &values, &columns, stage);
        let mut start = start.clone();
        if let [size] = &new[..] {
            let none = size.quantity.get(&here.plant);
            let way = reached[values.len() - 1];
            if none.is_finite() {
                start.values[0] = size.clamp(none + way * (size.start - none));
            }
        }
        Some(Promise { start, cost })
    }

    /// Promise of one more effect by one step from a start.
    fn glance(
        &self,
        from: &Hypothesis,
        start: &Start,
        there: &Prediction,
        stage: &Stage,
    ) -> Promise {
        let new = start.free(&self.nominal);
        let (mut free, mut columns) = self.beside(from, &new);
        let own = free.len();
        free.extend(new);
        let values: Vec<f64> = free.iter().map(|f| f.start).collect();
        columns.extend(jacobian(self.evidence, there, &free, &values, own));
        let (cost, _) = linearised_cost(self.evidence, there, &free, &values, &columns, stage);
        Promise {
            start: start.clone(),
            cost,
        }
    }

    /// A hypothesis with one more effect from a start, fitted roughly.
    fn add(
        &self,
        from: &Hypothesis,
        start: &Start,
        stages: &[Stage],
        iterations: usize,
    ) -> Hypothesis {
        let new = start.free(&self.nominal);
        let (kept, columns) = self.beside(from, &new);
        let is_phase = |f: &Free| from.effects.iter().any(|e| e.has_phase(&f.quantity));
        let of_term =
            &from.fit.free[from.fit.free.len() - from.unlisted().map_or(0, Latent::numbers)..];
        let there = &from.fit.prediction.plant;
        let is_of_term = |f: &Free| of_term.iter().any(|own| same(own, f, there));
        let (term, kept): (Vec<_>, Vec<_>) =
            (kept.into_iter().zip(columns)).partition(|(f, _)| is_of_term(f));
        let (phases, kept): (Vec<_>, Vec<_>) = kept.into_iter().partition(|(f, _)| is_phase(f));
        let (mut free, frozen): (Vec<Free>, Vec<Vec<f64>>) = kept.into_iter().unzip();
        // Phases and the numbers of a model discrepancy come last (`Hypothesis::tolerated`), and are not frozen: they are few.
        let (own, own_phases) = new.split_at(start.values.len());
        free.extend(own);
        free.extend(phases.into_iter().map(|(f, _)| f));
        free.extend(own_phases);
        free.extend(term.into_iter().map(|(f, _)| f));
        let mut plant = from.fit.prediction.plant.clone();
        for f in &free {
            f.quantity.set(&mut plant, f.start);
        }
        let mut effects = from.effects.clone();
        effects.push(start.effect);
        Hypothesis {
            effects,
            fit: fit(
                self.evidence,
                (&plant, Some(&from.fit.prediction)),
                (&free, &frozen),
                stages,
                Limit::of(iterations),
            ),
            depends_on: from.depends_on.clone(),
        }
    }

    /// Knowledge given to an effect that is asked where to start.
    pub(super) fn clues<'b>(
        &self,
        from: &'b Hypothesis,
        periodic: &'b [f64],
        bumps: &'b [f64],
    ) -> Clues<'b> {
        let readings = self
            .evidence
            .recordings
            .iter()
            .flat_map(|m| m.readings[2].iter());
        Clues {
            plant: &from.fit.prediction.plant,
            largest_force: readings
                .filter(|f| f.is_finite())
                .fold(0.0, |a, b| b.max(a)),
            periodic,
            bumps,
        }
    }
}

/// Starts that are worth their derivatives: those without a secant, and of those with one the best of the effects that promise most.
fn worth_a_glance(starts: &[Start], secants: &[Option<Promise>]) -> Vec<usize> {
    let mut chosen: Vec<usize> = Vec::new();
    let mut with: Vec<(usize, f64)> = Vec::new();
    for (index, secant) in secants.iter().enumerate() {
        match secant {
            None => chosen.push(index),
            Some(secant) => with.push((index, secant.cost)),
        }
    }
    with.sort_by(|a, b| a.1.total_cmp(&b.1));
    let near = GLANCED_BEHIND * with.first().map_or(0.0, |(_, cost)| *cost);
    let mut effects: Vec<(&str, usize)> = Vec::new();
    for (index, _) in with.into_iter().filter(|(_, cost)| *cost <= near) {
        let name = starts[index].effect.name;
        match effects.iter().position(|(known, _)| *known == name) {
            Some(at) if effects[at].1 < STARTS_OF_EACH => effects[at].1 += 1,
            None if effects.len() < GLANCED_AT => effects.push((name, 1)),
            _ => continue,
        }
        chosen.push(index);
    }
    chosen.sort_unstable();
    chosen
}

/// Of each effect what promises most.
fn best_of_each(promises: Vec<Promise>) -> Vec<Promise> {
    let mut best: Vec<Promise> = Vec::new();
    for promise in promises {
        let same = |known: &&mut Promise| known.start.effect.name == promise.start.effect.name;
        match best.iter_mut().find(same) {
            Some(known) if known.cost <= promise.cost => {}
            Some(known) => *known = promise,
            None => best.push(promise),
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::super::super::fit::{ROUGH, Refit};
    use super::super::super::test_evidence::{evidence_of, plant, search};
    use super::*;
    use crate::diagnosis::recordings::evidence::Evidence;
    use crate::effects::every;
    use crate::plant::{Basis, Port, Variable};

    /// Beside a formula the numbers of a small effect stood behind the formula's and each was taken for the other: improved.toml lacked some and was refused.
    #[test]
    fn an_effect_beside_a_term_has_its_numbers_before_those_of_the_term() {
        let mut truth = plant();
        registry::FORCE_BIAS.quantity().set(&mut truth, 6.0);
        let evidence = evidence_of(&truth, vec![vec![2e5; 300]]);
        let search = Search {
            candidates: every()
                .filter(|e| e.name == "force_sensor_bias_drift")
                .collect(),
            ..search(&evidence)
        };
        let mut with_term = plant();
        with_term.latent = Some(Latent {
            port: Port::PistonForce,
            variable: Variable::Stroke,
            directed: false,
            basis: Basis::Hats { ends: [0.0, 0.05] },
            coefficients: vec![0.0; 2],
        });
        let coefficient = |index: usize| Free {
            quantity: registry::LATENT_COEFFICIENT.quantity().of(index),
            start: 0.0,
            coordinate: Coordinate::Linear(1.0),
            bounds: [-100.0, 100.0],
            prior: Prior::Flat,
        };
        let free = [0, 1].map(coefficient);
        let limit = Limit::of(3);
        let mut from = search.fitted(Vec::new(), (&with_term, None), &free, ROUGH, limit);
        from.depends_on = vec!["stroke_m"];
        let found = &search.screen(&from, ROUGH, f64::INFINITY)[0];
        let names: Vec<&str> = found.fit.free.iter().map(|f| f.quantity.name).collect();
        let of_term = free[0].quantity.name;
        assert_eq!(names, ["bias_n", "drift_n_per_s", of_term, of_term]);
        assert_eq!(found.numbers_of(&search.nominal, 0), 0..2);
        assert_eq!(found.depends_on, ["stroke_m"]);
    }

    /// With one phase in all of them a runout that starts anew in each recording was answered "nothing missing".
    #[test]
    fn a_runout_that_starts_anew_in_each_recording_is_found_with_its_phases() {
        let of = |phase: f64| {
            let mut truth = plant();
            let sine = registry::RUNOUT_SINE.quantity();
            let cosine = registry::RUNOUT_COSINE.quantity();
            let (sin, cos) = phase.sin_cos();
            sine.set(&mut truth, 4e-5 * cos);
            cosine.set(&mut truth, 4e-5 * sin);
            registry::RUNOUT_FREQUENCY.quantity().set(&mut truth, 23.4);
            evidence_of(&truth, vec![vec![2e5; 500]]).recordings
        };
        let recordings = [0.3, 2.4, -1.5].into_iter().flat_map(of).collect();
        let evidence = Evidence::new(recordings, [400.0, 2e-5, 0.8, 0.15]);
        let search = Search {
            candidates: every().filter(|e| e.name == "tool_runout").collect(),
            ..search(&evidence)
        };
        let screened = search.screen(&search.baseline(), ROUGH, f64::INFINITY);
        let found = search.refit(&screened[0], Refit::FULL);
        let [frequency, sine, cosine, second, third] = found.fit.values[..] else {
            panic!("{:?}", found.fit.free);
        };
        assert!((frequency - 23.4).abs() < 0.01, "{frequency}");
        assert!((sine.hypot(cosine) - 4e-5).abs() < 1e-6, "{sine} {cosine}");
        assert!(
            (second - 2.1).abs() < 0.05 && (third + 1.8).abs() < 0.05,
            "{second} {third}"
        );
        assert_eq!(found.tolerated(&search.nominal), 0);
    }
}
