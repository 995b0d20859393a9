//! From what the runs of a contact flange show to an answer.

use super::fit::account::{simulated, unseen};
use super::fit::report::SimulatedFlange;
use super::{AVERAGED, BAND, RunMetrics, spread, spread_of_sizes};
use crate::diagnosis::answer::account::{Account, SectionKind};
use crate::diagnosis::answer::details::{DETAILS_SCHEMA, Details, PredictedRun, RunReport};
use crate::diagnosis::answer::estimate::Estimate;
use crate::diagnosis::answer::statements::{doubts_of, in_headline, stated};
use crate::diagnosis::answer::words::listed;
use crate::diagnosis::answer::{Alternative, Answer, FoundEffect, SCHEMA, Verdict};
use crate::diagnosis::difference::mismatch::Mismatch;

/// Knowledge of a flange from its runs.
#[derive(Debug, Clone)]
pub struct FlangeDiagnosis {
    /// Runs by their names, with what they show.
    pub runs: Vec<(String, RunMetrics)>,
    /// The run to be predicted: its speed of approach, force before and after contact, and what it shows.
    pub unseen: Option<(String, RunMetrics)>,
    /// Moving mass [kg].
    pub mass: f64,
    /// Time constant with which the contact force nominally follows the desired one [s].
    pub time_constant: f64,
    /// Standard deviation of the force sensor's noise [N].
    pub noise: f64,
    /// The flange as a simulation fitted to the runs.
    pub simulated: Option<SimulatedFlange>,
}

/// Multiples of the noise from which a force is there [1].
const THERE: f64 = 5.0;
/// Times its nominal duration from which settling is a finding [1].
const LATE: f64 = 1.5;

impl FlangeDiagnosis {
    fn of(&self, value: impl Fn(&RunMetrics) -> f64) -> [f64; 3] {
        let values: Vec<f64> = self.runs.iter().map(|(_, shown)| value(shown)).collect();
        spread_of_sizes(&values)
    }

    /// Frequencies of the runs that ring [Hz].
    fn frequencies(&self) -> Vec<f64> {
        (self.runs.iter())
            .filter_map(|(_, shown)| shown.frequency)
            .collect()
    }

    /// Residuals of the runs from the nominal first order, by name; nothing of a nominal flange.
    #[must_use]
    pub fn missing(&self) -> Vec<&'static str> {
        let limit = THERE * self.noise;
        let any = |shows: &dyn Fn(&RunMetrics) -> bool| self.runs.iter().any(|(_, s)| shows(s));
        let nominal = self.time_constant * (1.0 / BAND).ln() + AVERAGED;
        let shown = [
            (
                "contact_impact",
                any(&|s| s.peak > s.desired.max(s.before) * (1.0 + BAND) + limit),
            ),
            ("contact_ringing", any(&|s| s.ringing > limit)),
            ("settling", any(&|s| s.settling > LATE * nominal)),
            ("steady_force_error", any(&|s| s.steady.abs() > limit)),
            (
                "force_error_while_moving",
                any(&|s| s.moving.is_some_and(|rms| rms > limit)),
            ),
        ];
        let shown = shown.into_iter().filter(|(_, shows)| *shows);
        shown.map(|(name, _)| name).collect()
    }

    /// Growth of the peak with the speed [N s/m] with its interval.
    fn impedance(&self) -> [f64; 3] {
        self.of(RunMetrics::impedance)
    }

    fn decays(&self) -> Vec<f64> {
        self.runs.iter().filter_map(|(_, s)| s.decay).collect()
    }

    /// Peak [N] and settling [s] of a run at another speed: of the simulation, or as the fitted runs' grow.
    fn predicted(&self, name: &str, shown: &RunMetrics) -> (f64, f64) {
        let runs = self.simulated.iter().flat_map(|flange| &flange.runs);
        if let Some(run) = runs.filter(|run| !run.fitted).find(|r| r.recording == name) {
            return (run.peak_n.simulated, run.settling_s.simulated);
        }
        let peak = shown.before + shown.approach * self.impedance()[0];
        // What settles is the flange's control: as in the runs of the nearest desired force.
        let away = |s: &RunMetrics| (s.desired / shown.desired).ln().abs();
        let nearest = (self.runs.iter())
            .map(|(_, s)| away(s))
            .fold(f64::INFINITY, f64::min);
        let alike: Vec<f64> = (self.runs.iter())
            .filter(|(_, s)| away(s) < nearest + 0.05)
            .map(|(_, s)| s.settling)
            .collect();
        (peak, spread_of_sizes(&alike)[0])
    }

    /// What is missing, as in diagnosis.json.
    fn effects(&self, missing: &[&str]) -> Vec<FoundEffect> {
        let estimate = |[value, low, high]: [f64; 3]| Estimate::new(value, low, high);
        let effect = |name: &str, subsystem: &str, parameters: Vec<(&str, Estimate)>| {
            let numbers: Vec<Estimate> = parameters.iter().map(|(_, number)| *number).collect();
            let doubts = doubts_of(&numbers);
            FoundEffect {
                name: name.to_owned(),
                key: None,
                subsystem: subsystem.to_owned(),
                confidence: stated(1.0, &doubts),
                doubts,
                parameters: (parameters.into_iter())
                    .map(|(name, value)| (name.to_owned(), value))
                    .collect(),
                depends_on: Vec::new(),
                law: None,
                unlisted: None,
            }
        };
        let frequency = spread_of_sizes(&self.frequencies());
        let mut ringing = vec![("frequency_hz", estimate(frequency))];
        let decays = self.decays();
        if !decays.is_empty() {
            ringing.push(("decay_1_per_s", estimate(spread_of_sizes(&decays))));
        }
        let steady: Vec<f64> = self.runs.iter().map(|(_, s)| s.steady).collect();
        let [least, most] = extremes(&steady);
        let centre = spread(&steady);
        let mut effects = vec![
            effect(
                "contact_impact",
                "contact",
                vec![("peak_per_speed_n_s_per_m", estimate(self.impedance()))],
            ),
            effect("contact_ringing", "contact", ringing),
            effect(
                "settling",
                "regulator",
                vec![("settling_time_s", estimate(self.of(|s| s.settling)))],
            ),
            effect(
                "steady_force_error",
                "force_balance",
                vec![
                    ("mean_n", estimate(centre)),
                    ("least_n", estimate([least; 3])),
                    ("most_n", estimate([most; 3])),
                ],
            ),
        ];
        let moving: Vec<f64> = self.runs.iter().filter_map(|(_, s)| s.moving).collect();
        if !moving.is_empty() {
            effects.push(effect(
                "force_error_while_moving",
                "force_balance",
                vec![("rms_n", estimate(spread_of_sizes(&moving)))],
            ));
        }
        effects.retain(|effect| missing.contains(&effect.name.as_str()));
        effects
    }

    /// diagnosis.json.
    #[must_use]
    pub fn answer(&self, seconds: f64) -> Answer {
        let missing = self.missing();
        let effects = self.effects(&missing);
        let unsteady = missing.contains(&"steady_force_error");
        let causes = [
            "regulator_hysteresis",
            "regulator_gain_error",
            "force_sensor_bias_drift",
            "coulomb_viscous_friction",
        ];
        Answer {
            schema: SCHEMA,
            verdict: match effects.is_empty() {
                true => Verdict::NothingMissing,
                false => Verdict::Explained,
            },
            mismatch: (self.runs.iter())
                .filter(|_| !effects.is_empty())
                .map(|(name, shown)| Mismatch {
                    recording: name.clone(),
                    channel: "force_n".to_owned(),
                    start_s: shown.contact,
                    end_s: shown.contact + shown.settling,
                })
                .collect(),
            explained: None,
            effects,
            seconds,
            alternatives: (causes.into_iter())
                .filter(|_| unsteady)
                .map(|cause| Alternative {
                    formula: None,
                    effects: vec![cause.to_owned()],
                    odds: 1.0,
                })
                .collect(),
            notes: unsteady
                .then(|| CANNOT_TELL.to_owned())
                .into_iter()
                .collect(),
            details: Details {
                schema: DETAILS_SCHEMA,
                account: self.account(),
                runs: self
                    .runs
                    .iter()
                    .map(|(name, shown)| report(name, shown))
                    .collect(),
                predicted: self.unseen.as_ref().map(|(name, shown)| {
                    let (peak, settling) = self.predicted(name, shown);
                    PredictedRun {
                        recording: name.clone(),
                        approach_m_per_s: shown.approach,
                        peak_n: peak,
                        peak_measured_n: shown.peak,
                        settling_s: settling,
                        settling_measured_s: shown.settling,
                    }
                }),
                flange: self.simulated.clone(),
                ..Details::default()
            },
        }
    }

    /// The account.
    #[must_use]
    pub fn account(&self) -> Account {
        let missing = self.missing();
        let effects = self.effects(&missing);
        let stated = effects
            .iter()
            .filter(|e| in_headline(e.confidence, &e.doubts));
        let names: Vec<String> = stated.map(|effect| effect.name.clone()).collect();
        let mut account = Account {
            headline: match (missing.is_empty(), names.is_empty()) {
                (true, _) => "nothing is missing".to_owned(),
                (_, true) => "what is missing is not settled: no number of it is known to better than a decade".to_owned(),
                _ => format!("missing: {}", listed(&names)),
            },
            sections: Vec::new(),
        };
        for (name, kind, paragraph) in [
            ("contact_impact", SectionKind::Impact, self.impact()),
            ("contact_ringing", SectionKind::Ringing, self.ringing()),
            ("settling", SectionKind::Settling, self.settling()),
            (
                "steady_force_error",
                SectionKind::SteadyError,
                self.steady_error(),
            ),
            (
                "force_error_while_moving",
                SectionKind::ErrorWhileMoving,
                self.error_while_moving(),
            ),
        ] {
            if missing.contains(&name) {
                account.add(kind, vec![paragraph]);
            }
        }
        let measured = self
            .unseen
            .as_ref()
            .map(|(name, shown)| self.unseen_run(name, shown));
        let flange = self.simulated.as_ref();
        account.add(
            SectionKind::Simulated,
            (flange.map(|flange| simulated(flange, self.mass))).unwrap_or_default(),
        );
        let simulated_too = flange.map(unseen).unwrap_or_default();
        let paragraphs = measured.into_iter().chain(simulated_too).collect();
        account.add(SectionKind::UnseenRun, paragraphs);
        let runs = self.runs.iter().map(|(name, s)| {
            format!(
                "{name}: {:.3} m/s, {:.0} N desired; peak {:.0} N, {}, settled after {:.2} s, steady error {:+.2} N",
                s.approach,
                s.desired,
                s.peak,
                ringing(s),
                s.settling,
                s.steady
            )
        });
        account.add(SectionKind::Runs, runs.collect());
        account
    }

    fn impact(&self) -> String {
        let [z, z_low, z_high] = self.impedance();
        let [k, low, high] = [z, z_low, z_high].map(|z| z.max(0.0).powi(2) / self.mass * 1e-3);
        format!(
            "The tool of {} kg meets the surface and the force peaks at {z:.0} N for each m/s of approach ({z_low:.0} to {z_high:.0}) over what was desired before, as on a spring of {k:.0} N/mm ({low:.0} to {high:.0}). The nominal first order has no impact. The intervals are those of 95 %, from how the runs differ.",
            self.mass
        )
    }

    fn ringing(&self) -> String {
        let [f, f_low, f_high] = spread_of_sizes(&self.frequencies());
        let decays = self.decays();
        let dies = if decays.is_empty() {
            "; in no run does it stand out long enough for its damping".to_owned()
        } else {
            let [d, d_low, d_high] = spread_of_sizes(&decays);
            format!(
                " and dies away at {d:.1} 1/s ({d_low:.1} to {d_high:.1}; a damping ratio of {:.3})",
                d / (std::f64::consts::TAU * f)
            )
        };
        format!("After the impact the force rings at {f:.1} Hz ({f_low:.1} to {f_high:.1}){dies}.")
    }

    fn settling(&self) -> String {
        let [s, s_low, s_high] = self.of(|s| s.settling);
        format!(
            "The force, averaged over {:.0} ms, stays within {:.0} % of the desired force about its later level {s:.2} s after contact ({s_low:.2} to {s_high:.2}).",
            AVERAGED * 1e3,
            BAND * 100.0
        )
    }

    fn steady_error(&self) -> String {
        let steady: Vec<f64> = self.runs.iter().map(|(_, s)| s.steady).collect();
        let [least, most] = extremes(&steady);
        let unrest = self.of(|s| s.unrest)[0];
        let off = match steady.len() {
            1 => format!("{least:+.2} N"),
            _ => format!("{least:+.2} to {most:+.2} N from run to run"),
        };
        format!(
            "Once settled, with the arm at rest, the force is off by {off}, where within a run it wanders by {unrest:.2} N. {CANNOT_TELL}."
        )
    }

    /// Empty where no run moves in contact.
    fn error_while_moving(&self) -> String {
        let moving: Vec<f64> = self.runs.iter().filter_map(|(_, s)| s.moving).collect();
        if moving.is_empty() {
            return String::new();
        }
        let lost = self.runs.iter().map(|(_, s)| s.lost).fold(0.0, f64::max);
        let [m, ..] = spread_of_sizes(&moving);
        format!(
            "In contact and moving, the force is off by {m:.1} N RMS, and contact is lost for up to {:.1} % of a run's time.",
            lost * 100.0
        )
    }

    fn unseen_run(&self, name: &str, shown: &RunMetrics) -> String {
        let (peak, settling) = self.predicted(name, shown);
        format!(
            "{name} comes at {:.3} m/s. Predicted: a peak of {peak:.0} N, settled after {settling:.2} s; measured: {:.0} N ({:+.0} %) and {:.2} s ({:+.0} %).",
            shown.approach,
            shown.peak,
            100.0 * (peak / shown.peak - 1.0),
            shown.settling,
            100.0 * (settling / shown.settling - 1.0)
        )
    }
}

const CANNOT_TELL: &str = "Why it is off these recordings cannot tell: a play or gain error of the regulator, friction of the seals and a wrong zero of the force sensor would look alike. To tell them apart, record the regulator's outlet, and approach the same force from above and from below";

fn extremes(values: &[f64]) -> [f64; 2] {
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    [least, most]
}

fn ringing(shown: &RunMetrics) -> String {
    shown.frequency.map_or_else(
        || "no ringing".to_owned(),
        |frequency| format!("ringing {frequency:.1} Hz"),
    )
}

fn report(name: &str, shown: &RunMetrics) -> RunReport {
    RunReport {
        recording: name.to_owned(),
        contact_s: shown.contact,
        approach_m_per_s: shown.approach,
        desired_n: shown.desired,
        peak_n: shown.peak,
        settling_s: shown.settling,
        ringing_hz: shown.frequency,
        decay_1_per_s: shown.decay,
        steady_error_n: shown.steady,
        wander_n: shown.unrest,
        moving_rms_n: shown.moving,
        sliding_spread_n: shown.spread,
        contact_lost: shown.lost,
    }
}

#[cfg(test)]
mod tests {
    use super::super::Run;
    use super::*;

    /// A nominal flange: the force rises first order from contact on.
    fn as_nominal() -> Run {
        let time: Vec<f64> = (0..6000).map(|i| -0.5 + 8e-4 * f64::from(i)).collect();
        // Noise of a computer: what matters is that it is there.
        let noise = |i: usize| 0.08 * ((i * 7919 % 101) as f64 / 50.0 - 1.0);
        let force = |t: f64| {
            if t < 0.0 {
                0.0
            } else {
                50.0 * (1.0 - (-t / 0.05).exp())
            }
        };
        Run {
            name: "run".to_owned(),
            force: time
                .iter()
                .enumerate()
                .map(|(i, t)| force(*t) + noise(i))
                .collect(),
            desired: time
                .iter()
                .map(|t| if *t < 0.0 { 0.0 } else { 50.0 })
                .collect(),
            speed: time
                .iter()
                .map(|t| if *t < 0.0 { 0.02 } else { 0.0 })
                .collect(),
            force_ramp: None,
            commanded: time
                .iter()
                .map(|t| if *t < 0.0 { 0.02 } else { 0.0 })
                .collect(),
            time,
        }
    }

    fn of(run: &Run) -> FlangeDiagnosis {
        FlangeDiagnosis {
            runs: vec![(run.name.clone(), run.metrics().unwrap())],
            unseen: None,
            mass: 3.0,
            time_constant: 0.05,
            noise: 0.085,
            simulated: None,
        }
    }

    #[test]
    fn a_nominal_flange_lacks_nothing_and_one_that_is_off_lacks_that_alone() {
        let mut run = as_nominal();
        let answer = of(&run).answer(0.0);
        assert_eq!(
            answer.verdict,
            Verdict::NothingMissing,
            "{:?}",
            answer.effects
        );
        assert_eq!(of(&run).account().headline, "nothing is missing");
        for (force, time) in run.force.iter_mut().zip(&run.time) {
            *force += if *time < 0.0 { 0.0 } else { 1.5 };
        }
        assert_eq!(of(&run).missing(), ["steady_force_error"]);
        assert!(of(&run).answer(0.0).text().is_ok());
    }

    #[test]
    fn a_run_that_ends_soon_after_contact_is_refused() {
        let mut run = as_nominal();
        for values in [
            &mut run.time,
            &mut run.force,
            &mut run.desired,
            &mut run.speed,
            &mut run.commanded,
        ] {
            values.truncate(1000);
        }
        let refused = run.metrics().unwrap_err().to_string();
        assert!(refused.contains("expected at least 1.5 s"), "{refused}");
    }
}
