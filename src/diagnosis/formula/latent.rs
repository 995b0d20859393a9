//! A model discrepancy: where no known effect explains the recordings, a latent term inside the simulator, at each port and over each variable in
//! turn; the evidence says which.
//!
//! ```text
//! score = 1/2 (S + L),   S = cost + n ln N,   L = cost of each recording as predicted by a term fitted to the others
//! ```
//!
//! S is Schwarz's estimate of -2 ln p(all recordings), L the sum of -2 ln p(one recording | the others). Hats over time fit whatever happens in one
//! recording, and S cannot tell: all hats have as many coefficients. What happens in another recording they do not predict, unless it is a matter of
//! time. Where only one recording shows a term, L says nothing of it either way, and S decides.

use crate::diagnosis::difference::spectrum;
use crate::diagnosis::fit::cross_validation::{Depth, rough_cost};
use crate::diagnosis::fit::free::{Free, Prior};
use crate::diagnosis::fit::hypothesis::Hypothesis;
use crate::diagnosis::fit::{FULL, Fit, Limit, ROUGH, Refit, Stage, Start, fit, rough_noise};
use crate::diagnosis::recordings::evidence::{Evidence, Prediction};
use crate::diagnosis::search::Search;
use crate::diagnosis::search::progress::{Observer, Step};
use crate::diagnosis::search::scale::Scale;
use crate::effects::Coordinate;
use crate::plant::{Basis, Latent, MOST_COEFFICIENTS, Port, Quantity, Variable, registry};
use rayon::prelude::*;

/// Coefficients of a curve in its first step.
const COARSE: usize = 9;
/// Cost beyond noise over that of the best after the first step beyond which a term gets no second look [1]: where the piston meets a stop a term over the
/// stroke needs more than one step.
const FAR: f64 = 12.0;
/// The same beyond which a term gets none where those nearer come to leave noise alone [1].
const NEAR: f64 = 3.0;
/// Terms that get a second look.
const LOOKED_AT: usize = 8;
/// Iterations of that look.
const LOOK: usize = 3;
/// Terms that are fitted roughly.
const FITTED: usize = 4;
/// Iterations of a rough fit.
const ROUGH_ITERATIONS: usize = 8;
/// Terms that are fitted in full.
const IN_FULL: usize = 2;
/// Iterations of the full fit.
const FULL_ITERATIONS: usize = 25;
/// Standard deviation of the prior of a term's level or of a wave, in the port's scale [1].
const NOMINAL: f64 = 20.0;
/// Standard deviation of the prior of the rise from one knot to the next, in the port's scale [1].
const RISES_BY: f64 = 2.0;
/// Shares of its value where it is surest below which a term does not act [1]: both are tried, and the fit decides.
const NARROW: [f64; 2] = [0.1, 0.3];
/// Share of what its variable moves through from which a term is not narrow [1].
const WIDE: f64 = 0.6;
/// Rough cost over that of another explanation beyond which terms that were looked at are given up [1].
const HOPELESS: f64 = 1.5;
/// Share of what another explanation leaves that a curve may leave for a formula to be asked for [1].
const PROMISING: f64 = 0.5;
/// Share of the gain of the best term within which another variable is not distinguished [1].
const ALIKE: f64 = 0.05;

/// Variables named at most.
const MOST_VARIABLES: usize = 3;

/// A row of [`TERMS`].
type Entry = (Port, f64, &'static [(Variable, bool)]);

/// Ports, with the size of what is looked for, and variables on which something there may depend, with whether it may act with the motion.
#[rustfmt::skip]
const TERMS: &[Entry] = &[
    (Port::PistonForce, 10.0, &[
        (Variable::Time, false), (Variable::Stroke, false), (Variable::Velocity, false), (Variable::ChamberPressure, false),
        (Variable::PressureDifference, false), (Variable::ContactForce, false), (Variable::Surface, false),
    ]),
    (Port::Friction, 10.0, &[
        (Variable::Time, false), (Variable::Stroke, false), (Variable::ChamberPressure, false), (Variable::PressureDifference, false),
        (Variable::ContactForce, false),
    ]),
    (Port::SetPressure, 1e4, &[(Variable::Time, false), (Variable::SetPressure, false)]),
    (Port::OutletPressure, 1e4, &[
        (Variable::Time, false), (Variable::SetPressure, false), (Variable::MassFlow, false), (Variable::ChamberPressure, false),
    ]),
    (Port::FirstChamberFlow, 1e-5, &[
        (Variable::Time, false), (Variable::Stroke, false), (Variable::ChamberPressure, false), (Variable::PressureDifference, false),
        (Variable::Velocity, false),
    ]),
    (Port::SecondChamberFlow, 1e-5, &[
        (Variable::Time, false), (Variable::Stroke, false), (Variable::ChamberPressure, false), (Variable::PressureDifference, false),
        (Variable::Velocity, false),
    ]),
    (Port::FirstChamberLeak, 1e-6, &[(Variable::Time, false), (Variable::Stroke, false), (Variable::ChamberPressure, false)]),
    (Port::SecondChamberLeak, 1e-6, &[(Variable::Time, false), (Variable::Stroke, false), (Variable::PressureDifference, false)]),
    (Port::SupplyOrifice, 1e-6, &[(Variable::Time, false), (Variable::Stroke, false), (Variable::ChamberPressure, false)]),
    (Port::ExhaustOrifice, 1e-6, &[(Variable::Time, false), (Variable::Stroke, false), (Variable::PressureDifference, false)]),
    (Port::ContactStiffness, 5e4, &[
        (Variable::Time, false), (Variable::ContactForce, false), (Variable::Surface, false),
    ]),
    (Port::Surface, 1e-4, &[
        (Variable::Time, false), (Variable::Surface, false), (Variable::Stroke, false), (Variable::ContactForce, false),
        (Variable::Velocity, false),
    ]),
    (Port::ForceReading, 10.0, &[
        (Variable::Time, false), (Variable::ContactForce, false), (Variable::Stroke, false), (Variable::Velocity, false),
        (Variable::Velocity, true), (Variable::ChamberPressure, false),
    ]),
    (Port::StrokeReading, 1e-4, &[(Variable::Time, false), (Variable::Stroke, false), (Variable::Velocity, false)]),
    (Port::PressureReading, 1e4, &[
        (Variable::Time, false), (Variable::SetPressure, false), (Variable::ChamberPressure, false), (Variable::MassFlow, false),
    ]),
];

/// Size of what is looked for at a port, in its unit.
pub fn scale(port: Port) -> f64 {
    TERMS
        .iter()
        .find(|(known, _, _)| *known == port)
        .map_or(1.0, |(_, scale, _)| *scale)
}

/// Where a curve starts: of what is never less than nothing a little more, that it may be seen to shrink as well as to grow.
fn start(port: Port) -> f64 {
    match port {
        Port::Friction => 0.1 * scale(port),
        _ => 0.0,
    }
}

/// Contribution of a unit of the free quantity of an index to a term at a value of its variable.
#[must_use]
pub fn response(latent: &Latent, index: usize, at: f64) -> f64 {
    let mut unit = latent.clone();
    unit.coefficients.fill(0.0);
    match latent.basis {
        Basis::Hats { .. } => unit.coefficients[index..].fill(1.0),
        Basis::Waves { .. } => unit.coefficients[index] = 1.0,
        Basis::Formula(_) => {
            // By a difference quotient.
            let here = latent.coefficients[index];
            let step = 1e-5 * here.abs().max(1e-9);
            let moved = |value: f64| {
                let mut moved = latent.clone();
                moved.coefficients[index] = value;
                moved.shape(at)
            };
            return (moved(here + step) - moved(here - step)) / (2.0 * step);
        }
    }
    unit.shape(at)
}

/// Free quantities of a latent term: of hats the level and the rises, for a curve's neighbouring values are alike until the recordings say otherwise, and
/// what is not passed through stays as beside it.
fn free_of_latent(latent: &Latent) -> Vec<Free> {
    let scale = scale(latent.port);
    let count = latent.coefficients.len();
    let free = |(quantity, value): (Quantity, f64), deviation: f64| Free {
        quantity,
        start: value,
        coordinate: Coordinate::Linear(scale),
        bounds: [-1e3 * scale, 1e3 * scale],
        prior: Prior::Normal {
            mean: 0.0,
            deviation: deviation * scale,
        },
    };
    let c = latent.coefficients.iter().copied();
    let mut free: Vec<Free> = match latent.basis {
        Basis::Hats { .. } => {
            let before = std::iter::once(0.0).chain(c.clone());
            let rises = c.zip(before).map(|(c, before)| c - before);
            let nominal = std::iter::once(NOMINAL).chain(std::iter::repeat(RISES_BY));
            let rises = (0..count)
                .map(|i| registry::LATENT_RISE.quantity().of(i))
                .zip(rises)
                .zip(nominal);
            rises.map(|(rise, by)| free(rise, by)).collect()
        }
        Basis::Waves { .. } => {
            let waves = (0..count)
                .map(|i| registry::LATENT_COEFFICIENT.quantity().of(i))
                .zip(c);
            waves.map(|wave| free(wave, NOMINAL)).collect()
        }
        Basis::Formula(_) => Vec::new(),
    };
    if let Basis::Waves { frequency } = latent.basis {
        // One turn of phase over the longest recording is a step of about a tenth of a hertz.
        free.push(Free {
            quantity: registry::LATENT_FREQUENCY.quantity(),
            start: frequency,
            coordinate: Coordinate::Linear(0.02),
            bounds: [0.5 * frequency, 2.0 * frequency],
            prior: Prior::Flat,
        });
    }
    debug_assert_eq!(free.len(), latent.numbers());
    free
}

/// Terms that make sense for what a description moves through.
fn terms(evidence: &Evidence, base: &Prediction) -> Vec<Latent> {
    let mut all = Vec::new();
    for (port, _, variables) in TERMS {
        for (variable, directed) in *variables {
            if let Some(ends) = range(evidence, base, *variable) {
                all.push(Latent {
                    port: *port,
                    variable: *variable,
                    directed: *directed,
                    basis: Basis::Hats { ends },
                    coefficients: vec![start(*port); COARSE],
                });
            }
        }
        let channel = match port {
            Port::SetPressure | Port::OutletPressure | Port::PressureReading => 0,
            Port::StrokeReading => 1,
            Port::FirstChamberFlow
            | Port::SecondChamberFlow
            | Port::FirstChamberLeak
            | Port::SecondChamberLeak
            | Port::SupplyOrifice
            | Port::ExhaustOrifice => continue,
            _ => 2,
        };
        for frequency in spectrum::strongest_in(evidence, base, channel)
            .into_iter()
            .take(2)
        {
            all.push(Latent {
                port: *port,
                variable: Variable::Time,
                directed: false,
                basis: Basis::Waves { frequency },
                coefficients: vec![0.0; 4],
            });
        }
    }
    all
}

/// Range of a variable in all recordings, but for a hundredth at either end; nothing if it stands still.
fn range(evidence: &Evidence, base: &Prediction, variable: Variable) -> Option<[f64; 2]> {
    let mut values = Vec::new();
    for (measured, trajectory) in evidence.recordings.iter().zip(&base.trajectories) {
        for i in 0..measured.inputs.time.len() {
            let value = trajectory.truth.moment(&measured.inputs, i).of(variable);
            if value.is_finite() {
                values.push(value);
            }
        }
    }
    if values.len() < 100 {
        return None;
    }
    values.sort_by(f64::total_cmp);
    let (low, high) = match variable {
        Variable::Time | Variable::Stroke | Variable::Surface => {
            (values[0], values[values.len() - 1])
        }
        _ => (
            values[values.len() / 100],
            values[values.len() - 1 - values.len() / 100],
        ),
    };
    (high > low).then_some([low, high])
}

/// A curve with as many knots as there may be; nothing of what is none.
fn refined(latent: &Latent) -> Option<Latent> {
    let Basis::Hats { ends } = latent.basis else {
        return None;
    };
    let step = (ends[1] - ends[0]) / (MOST_COEFFICIENTS - 1) as f64;
    let at = |k: usize| latent.shape(ends[0] + step * k as f64);
    Some(Latent {
        coefficients: (0..MOST_COEFFICIENTS).map(at).collect(),
        ..latent.clone()
    })
}

/// A term in words for the log.
fn described(hypothesis: &Hypothesis) -> String {
    hypothesis.unlisted().map_or(String::new(), |latent| {
        let directed = if latent.directed { ", directed" } else { "" };
        let (port, variable) = (latent.port, latent.variable);
        let count = latent.coefficients.len();
        format!("latent {port:?}({variable:?}{directed}) of {count}")
    })
}

/// The part of its range in which a fitted term acts: about the knot that the recordings are surest of, for what they hardly show, such as a force
/// that a stop takes, may be anything. Nothing where that is most of the range.
fn window(fit: &Fit, share: f64) -> Option<[f64; 2]> {
    let latent = fit.prediction.plant.latent.as_ref()?;
    let Basis::Hats { ends } = latent.basis else {
        return None;
    };
    let c = &latent.coefficients;
    let own = fit.free.len() - c.len();
    // A knot that moves alone is a rise to it, and a fall after it.
    let alone = |k: usize| {
        let (rise, fall) = (own + k, own + k + 1);
        let known = &fit.information;
        if k + 1 == c.len() {
            return known[(rise, rise)];
        }
        known[(rise, rise)] + known[(fall, fall)] - 2.0 * known[(rise, fall)]
    };
    let sure = |k: usize| c[k] * c[k] * alone(k);
    let peak = (0..c.len()).max_by(|a, b| sure(*a).total_cmp(&sure(*b)))?;
    let acts = |k: &usize| c[*k].abs() > share * c[peak].abs();
    let first = (0..=peak).rev().take_while(acts).last()?;
    let last = (peak..c.len()).take_while(acts).last()?;
    let spacing = (ends[1] - ends[0]) / (c.len() - 1) as f64;
    let from = ends[0] + spacing * (first as f64 - 1.5);
    let to = ends[0] + spacing * (last as f64 + 1.5);
    (to - from < WIDE * (ends[1] - ends[0])).then_some([from, to])
}

/// Names of the variables that a term depends on.
fn variables(term: &Latent) -> impl Iterator<Item = &'static str> {
    let directed = term.turns_with_motion().then_some("velocity_sign");
    [term.variable.name()].into_iter().chain(directed)
}

impl Search<'_> {
    /// Formulas beside a hypothesis that leave noise alone, best first; curves where these do and no formula does; none where the curves that point at them promise too little beside what another
    /// explanation costs roughly, `rival`.
    pub(in crate::diagnosis) fn adequate_formulas(
        &self,
        base: &Hypothesis,
        rival: f64,
        scale: &Scale,
        observer: &mut Observer<'_>,
    ) -> Vec<Hypothesis> {
        self.within_effort(|| self.formulas_beside(base, rival, scale, observer))
    }

    /// What a search for formulas finds, unless so much was spent on such before that none is begun.
    pub(in crate::diagnosis) fn within_effort(
        &self,
        search: impl FnOnce() -> Vec<Hypothesis>,
    ) -> Vec<Hypothesis> {
        let most = self.settings.formulas_within;
        self.evidence.effort.on_formulas(most, search)
    }

    fn formulas_beside(
        &self,
        base: &Hypothesis,
        rival: f64,
        scale: &Scale,
        observer: &mut Observer<'_>,
    ) -> Vec<Hypothesis> {
        let base = &self.held(base);
        let noise = self.left_alone(scale);
        let limit = noise + PROMISING * (rival - noise).max(0.0);
        let mut promising = self.promising(base, limit, scale, observer);
        if self.is_spent() {
            return Vec::new();
        }
        if promising.first().is_some_and(|best| best.fit.rough > noise) {
            self.converge(&mut promising, observer);
        }
        let formulas = self.formulas(base, &promising, scale, observer);
        let adequate =
            |h: &Hypothesis| scale.is_adequate(h) && self.term_shows(h) && self.is_finite(h);
        let (mut found, others): (Vec<Hypothesis>, Vec<Hypothesis>) =
            formulas.into_iter().partition(adequate);
        if found.is_empty() && !self.is_spent() {
            promising.retain(|h| h.fit.rough < noise);
            found = self.curves_in_full(base, &promising, observer);
            found.retain(|h| scale.is_adequate(h) && self.is_finite(h));
        }
        self.put_named_first(&mut found, scale, observer);
        if !found.is_empty() {
            // The next best forms, to be shown beside it.
            found.extend(others);
        }
        self.name_variables(base, &mut found, &promising);
        found
    }

    /// The last resort: curves beside a hypothesis, with formulas that do what they do, best first. None where all promise to cost far more than what another
    /// explanation costs roughly, `rival`.
    pub(in crate::diagnosis) fn latent(
        &self,
        base: &Hypothesis,
        rival: f64,
        scale: &Scale,
        observer: &mut Observer<'_>,
    ) -> Vec<Hypothesis> {
        let base = &self.held(base);
        let promising = self.promising(base, HOPELESS * rival, scale, observer);
        let curves = self.curves(base, &promising, observer);
        if self.is_spent() {
            return self.in_full_of_curves(&curves);
        }
        let mut found = self.formulas(base, &curves, scale, observer);
        found.extend(self.in_full_of_curves(&curves));
        found.retain(|h| self.is_finite(h));
        found.sort_by(|a, b| self.score(a).total_cmp(&self.score(b)));
        self.name_variables(base, &mut found, &promising);
        found
    }

    /// Curves that are distinguished by what they leave of recordings that were left out, fitted in full, best first.
    fn curves_in_full(
        &self,
        base: &Hypothesis,
        promising: &[Hypothesis],
        observer: &mut Observer<'_>,
    ) -> Vec<Hypothesis> {
        let curves = self.curves(base, promising, observer);
        let mut full = self.in_full_of_curves(&curves);
        full.sort_by(|a, b| self.score(a).total_cmp(&self.score(b)));
        full
    }

    fn in_full_of_curves(&self, curves: &[Hypothesis]) -> Vec<Hypothesis> {
        let leading = curves.par_iter().take(IN_FULL);
        leading
            .map(|h| self.refit(h, curve(FULL, FULL_ITERATIONS)))
            .collect()
    }

    /// A hypothesis with the piston held: of a full fit that prediction is wanted.
    fn held(&self, base: &Hypothesis) -> Hypothesis {
        self.refit(base, curve(ROUGH, 2))
    }

    /// Rough cost below which nothing is left to be explained.
    pub(in crate::diagnosis) fn left_alone(&self, scale: &Scale) -> f64 {
        rough_noise(self.evidence) + scale.rough_spread()
    }

    /// Curves that promise to cost less than a limit, the best first: all coarsely, those near the best finely.
    fn promising(
        &self,
        base: &Hypothesis,
        limit: f64,
        scale: &Scale,
        observer: &mut Observer<'_>,
    ) -> Vec<Hypothesis> {
        let noise = rough_noise(self.evidence);
        let terms = terms(self.evidence, &base.fit.prediction);
        let mut ranked: Vec<Hypothesis> = terms
            .par_iter()
            .map(|latent| {
                self.with_latent(base, latent, &base.fit.columns, 1)
                    .without_columns()
            })
            .collect();
        self.sort_by_cost(&mut ranked);
        let left = |h: &Hypothesis| (self.latent_score(h) - noise).max(0.0);
        if let Some(best) = ranked.first() {
            let detail = format!(
                "{} coarsely {:.0}, limit {limit:.0}",
                described(best),
                self.latent_score(best)
            );
            observer(&Step::Variation.of(best, detail));
        }
        let best = ranked.first().map_or(0.0, left);
        ranked.retain(|h| left(h) <= FAR * best);
        ranked.truncate(LOOKED_AT);
        let nearer = ranked.partition_point(|h| left(h) <= NEAR * best);
        let farther = ranked.split_off(nearer);
        ranked = self.looked_at(base, &ranked);
        if ranked.iter().all(|h| h.fit.rough > self.left_alone(scale)) {
            ranked.extend(self.looked_at(base, &farther));
        }
        self.sort_by_cost(&mut ranked);
        for h in &ranked {
            let detail = format!("{} promises {:.0}", described(h), self.latent_score(h));
            observer(&Step::Variation.of(h, detail));
        }
        ranked.retain(|h| h.fit.rough < limit);
        ranked
    }

    /// A second look at coarse curves, with as many knots as there may be.
    fn looked_at(&self, base: &Hypothesis, coarse: &[Hypothesis]) -> Vec<Hypothesis> {
        let look = |coarse: &Hypothesis| match coarse.unlisted().and_then(refined) {
            Some(fine) => self.with_latent(base, &fine, &[], LOOK),
            None => self.refit(coarse, curve(ROUGH, LOOK)),
        };
        let look = |coarse: &Hypothesis| look(coarse).without_columns();
        coarse.par_iter().map(look).collect()
    }

    /// Goes on with the leading curves: what acts at one place of the stroke takes more steps than what acts all along it.
    fn converge(&self, promising: &mut Vec<Hypothesis>, observer: &mut Observer<'_>) {
        promising.truncate(FITTED);
        *promising = promising
            .par_iter()
            .map(|h| self.refit(h, curve(ROUGH, ROUGH_ITERATIONS)))
            .collect();
        self.sort_by_cost(promising);
        for h in promising {
            let detail = format!("{} goes on to {:.0}", described(h), self.latent_score(h));
            observer(&Step::Variation.of(h, detail));
        }
    }

    pub(in crate::diagnosis) fn sort_by_cost(&self, hypotheses: &mut [Hypothesis]) {
        hypotheses.sort_by(|a, b| self.latent_score(a).total_cmp(&self.latent_score(b)));
    }

    /// Names the variables on which terms depend: evidence from what was left out may put another first.
    fn name_variables(&self, base: &Hypothesis, found: &mut [Hypothesis], ranked: &[Hypothesis]) {
        for one in found {
            one.depends_on = self.alike(base, one, ranked);
        }
    }

    /// Curves fitted roughly, the best first, by what they leave of recordings that they were not fitted to as well.
    fn curves(
        &self,
        base: &Hypothesis,
        ranked: &[Hypothesis],
        observer: &mut Observer<'_>,
    ) -> Vec<Hypothesis> {
        let fitted = ranked.iter().take(FITTED).map(|promising| {
            let fitted = self.refit(promising, curve(ROUGH, ROUGH_ITERATIONS));
            self.narrowed(base, fitted)
        });
        let mut fitted: Vec<(f64, Hypothesis)> = fitted
            .map(|h| {
                let own = self.latent_score(&h);
                let elsewhere = rough_cost(self.evidence, &h.fit, Depth::Refit(ELSEWHERE));
                let elsewhere = elsewhere.unwrap_or(own);
                let detail = format!("{} {own:.0}, elsewhere {elsewhere:.0}", described(&h));
                observer(&Step::Variation.of(&h, detail));
                (0.5 * (own + elsewhere), h)
            })
            .collect();
        fitted.sort_by(|a, b| a.0.total_cmp(&b.0));
        let Some((least, _)) = fitted.first() else {
            return Vec::new();
        };
        let gain = (base.fit.rough - least).max(0.0);
        let near = least + ALIKE * gain;
        (fitted.into_iter())
            .filter(|(score, _)| *score <= near)
            .map(|(_, hypothesis)| hypothesis)
            .collect()
    }

    /// Variables on which a term depends: its own, then those of curves at its port that promise nearly as much.
    fn alike(
        &self,
        base: &Hypothesis,
        best: &Hypothesis,
        ranked: &[Hypothesis],
    ) -> Vec<&'static str> {
        let Some(own) = best.unlisted() else {
            return Vec::new();
        };
        let least = (ranked.iter().map(|h| self.latent_score(h))).fold(f64::INFINITY, f64::min);
        let gain = (base.fit.rough - least).max(0.0);
        let near = ranked
            .iter()
            .filter(|h| self.latent_score(h) <= least + ALIKE * gain);
        let near = near.filter_map(Hypothesis::unlisted);
        let near = near.filter(|other| other.port == own.port);
        let known = best.depends_on.iter().copied();
        let mut names = Vec::new();
        for name in known.chain(variables(own)).chain(near.flat_map(variables)) {
            if !names.contains(&name) {
                names.push(name);
            }
        }
        names.truncate(MOST_VARIABLES);
        names
    }

    pub(in crate::diagnosis) fn latent_score(&self, hypothesis: &Hypothesis) -> f64 {
        let numbers = hypothesis.unlisted().map_or(0, Latent::numbers) as f64;
        hypothesis.fit.rough + numbers * (self.evidence.count() as f64).ln()
    }

    /// A hypothesis with a term, fitted roughly; the derivatives of what was free before are taken as they are where they are given.
    fn with_latent(
        &self,
        base: &Hypothesis,
        latent: &Latent,
        frozen: &[Vec<f64>],
        iterations: usize,
    ) -> Hypothesis {
        let mut plant = base.fit.prediction.plant.clone();
        plant.latent = Some(latent.clone());
        let mut free = base.fit.free_from_here();
        free.extend(free_of_latent(latent));
        Hypothesis {
            effects: base.effects.clone(),
            fit: fit(
                self.evidence,
                (&plant, None),
                (&free, frozen),
                ROUGH,
                Limit::of_curve(iterations),
            ),
            depends_on: Vec::new(),
        }
    }

    /// A term that acts in a part of its range alone, with its knots there, if that fits better.
    fn narrowed(&self, base: &Hypothesis, fitted: Hypothesis) -> Hypothesis {
        let mut windows: Vec<[f64; 2]> = NARROW
            .iter()
            .filter_map(|share| window(&fitted.fit, *share))
            .collect();
        windows.dedup();
        let mut best = fitted;
        let Some(latent) = best.unlisted().cloned() else {
            return best;
        };
        for [from, to] in windows {
            let count = latent.coefficients.len();
            let step = (to - from) / (count - 1) as f64;
            let narrow = Latent {
                basis: Basis::Hats { ends: [from, to] },
                coefficients: (0..count)
                    .map(|k| latent.shape(from + step * k as f64))
                    .collect(),
                ..latent.clone()
            };
            let tried = self.with_latent(base, &narrow, &[], ROUGH_ITERATIONS);
            if tried.fit.rough < best.fit.rough {
                best = tried;
            }
        }
        best
    }
}

/// The fit to the other recordings, from where that to all is.
const ELSEWHERE: Refit<'static> = Refit {
    start: Start::Here,
    stages: ROUGH,
    limit: Limit::of_curve(5),
};

/// Goes on with the fit of a curve from where it is.
fn curve(stages: &[Stage], iterations: usize) -> Refit<'_> {
    Refit {
        start: Start::Here,
        stages,
        limit: Limit::of_curve(iterations),
    }
}
