//! From what the runs of a contact flange show to an answer.

use std::fmt::Write as _;

use super::answer::{Alternative, Answer, Estimate, FoundEffect, Mismatch, SCHEMA, Verdict};
use super::details::{Details, ForetoldRun, RunShown};
use super::flange::{AVERAGED, BAND, Shown, spread, spread_of_sizes};
use super::words::wrapped;

/// What is known of a flange from its runs.
#[derive(Debug, Clone)]
pub struct FlangeDiagnosis {
    /// Case.
    pub name: String,
    /// Runs by their names, with what they show.
    pub runs: Vec<(String, Shown)>,
    /// The run to be foretold: its speed of approach, force before and after contact, and what it shows.
    pub unseen: Option<(String, Shown)>,
    /// Moving mass [kg].
    pub mass: f64,
}

impl FlangeDiagnosis {
    fn of(&self, value: impl Fn(&Shown) -> f64) -> [f64; 3] {
        let values: Vec<f64> = self.runs.iter().map(|(_, shown)| value(shown)).collect();
        spread_of_sizes(&values)
    }

    /// Growth of the peak with the speed [N s/m] with its interval.
    fn impedance(&self) -> [f64; 3] {
        self.of(Shown::impedance)
    }

    fn decays(&self) -> Vec<f64> {
        self.runs.iter().filter_map(|(_, s)| s.decay).collect()
    }

    /// Peak [N] and settling [s] of a run at another speed.
    fn foretold(&self, shown: &Shown) -> (f64, f64) {
        let peak = shown.before + shown.approach * self.impedance()[0];
        // What settles is the flange's control: as in the runs of the nearest desired force.
        let away = |s: &Shown| (s.desired / shown.desired).ln().abs();
        let nearest = (self.runs.iter())
            .map(|(_, s)| away(s))
            .fold(f64::INFINITY, f64::min);
        let alike: Vec<f64> = (self.runs.iter())
            .filter(|(_, s)| away(s) < nearest + 0.05)
            .map(|(_, s)| s.settling)
            .collect();
        (peak, spread_of_sizes(&alike)[0])
    }

    /// diagnosis.json.
    #[must_use]
    pub fn answer(&self, seconds: f64) -> Answer {
        let estimate = |[value, low, high]: [f64; 3]| Estimate { value, low, high };
        let effect = |name: &str, subsystem: &str, parameters: Vec<(&str, Estimate)>| FoundEffect {
            name: name.to_owned(),
            subsystem: subsystem.to_owned(),
            confidence: 1.0,
            parameters: (parameters.into_iter())
                .map(|(name, value)| (name.to_owned(), value))
                .collect(),
            depends_on: Vec::new(),
            unlisted: None,
        };
        let impedance = self.impedance();
        let stiffness = impedance.map(|z| z.max(0.0).powi(2) / self.mass);
        let mut ringing = vec![("frequency_hz", estimate(self.of(|s| s.frequency)))];
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
                vec![
                    ("contact_stiffness_n_per_m", estimate(stiffness)),
                    ("peak_per_speed_n_s_per_m", estimate(impedance)),
                ],
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
        let causes = [
            "regulator_hysteresis",
            "regulator_gain_error",
            "force_sensor_bias_drift",
            "coulomb_viscous_friction",
        ];
        Answer {
            schema: SCHEMA,
            verdict: Verdict::Explained,
            effects,
            mismatch: (self.runs.iter())
                .map(|(name, shown)| Mismatch {
                    recording: name.clone(),
                    channel: "force_n".to_owned(),
                    start_s: shown.contact,
                    end_s: shown.contact + shown.settling,
                })
                .collect(),
            seconds,
            alternatives: causes
                .map(|cause| Alternative {
                    effects: vec![cause.to_owned()],
                    odds: 1.0,
                })
                .into(),
            notes: vec![CANNOT_TELL.to_owned()],
            details: Details {
                runs: self
                    .runs
                    .iter()
                    .map(|(name, shown)| report(name, shown))
                    .collect(),
                foretold: self.unseen.as_ref().map(|(name, shown)| {
                    let (peak, settling) = self.foretold(shown);
                    ForetoldRun {
                        recording: name.clone(),
                        approach_m_per_s: shown.approach,
                        peak_n: peak,
                        peak_measured_n: shown.peak,
                        settling_s: settling,
                        settling_measured_s: shown.settling,
                    }
                }),
                ..Details::default()
            },
        }
    }

    /// The account.
    #[must_use]
    pub fn account(&self) -> String {
        let mut text = format!(
            "{}: missing: contact_impact, contact_ringing, settling and steady_force_error\n",
            self.name
        );
        let mut part = |title: &str, paragraph: &str| {
            // Writing into a text cannot fail.
            let _ = write!(text, "\n{title}\n{}", wrapped("  ", paragraph));
        };
        let [z, z_low, z_high] = self.impedance();
        let [k, low, high] = [z, z_low, z_high].map(|z| z.max(0.0).powi(2) / self.mass * 1e-3);
        part(
            "Impact",
            &format!(
                "The tool of {} kg meets the surface and the force peaks at {z:.0} N for each m/s of approach ({z_low:.0} to {z_high:.0}) over what was desired before, as on a spring of {k:.0} N/mm ({low:.0} to {high:.0}). The believed first order has no impact. The intervals are those of 95 %, from how the runs differ.",
                self.mass
            ),
        );
        let [f, f_low, f_high] = self.of(|s| s.frequency);
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
        part(
            "Ringing",
            &format!(
                "After the impact the force rings at {f:.1} Hz ({f_low:.1} to {f_high:.1}){dies}."
            ),
        );
        let [s, s_low, s_high] = self.of(|s| s.settling);
        part(
            "Settling",
            &format!(
                "The force, averaged over {:.0} ms, stays within {:.0} % of the desired force about its later level {s:.2} s after contact ({s_low:.2} to {s_high:.2}).",
                AVERAGED * 1e3,
                BAND * 100.0
            ),
        );
        let steady: Vec<f64> = self.runs.iter().map(|(_, s)| s.steady).collect();
        let [least, most] = extremes(&steady);
        let unrest = self.of(|s| s.unrest)[0];
        part(
            "Steady error",
            &format!(
                "Once settled, with the arm at rest, the force is off by {least:+.2} to {most:+.2} N from run to run, where within a run it wanders by {unrest:.2} N. {CANNOT_TELL}"
            ),
        );
        let moving: Vec<f64> = self.runs.iter().filter_map(|(_, s)| s.moving).collect();
        if !moving.is_empty() {
            let lost = self.runs.iter().map(|(_, s)| s.lost).fold(0.0, f64::max);
            let [m, ..] = spread_of_sizes(&moving);
            part(
                "While the arm moves",
                &format!(
                    "In contact and moving, the force is off by {m:.1} N RMS, and contact is lost for up to {:.1} % of a run's time.",
                    lost * 100.0
                ),
            );
        }
        if let Some((name, shown)) = &self.unseen {
            let (peak, settling) = self.foretold(shown);
            part(
                "A run that it never saw",
                &format!(
                    "{name} comes at {:.3} m/s. Foretold: a peak of {peak:.0} N, settled after {settling:.2} s; measured: {:.0} N ({:+.0} %) and {:.2} s ({:+.0} %).",
                    shown.approach,
                    shown.peak,
                    100.0 * (peak / shown.peak - 1.0),
                    shown.settling,
                    100.0 * (settling / shown.settling - 1.0)
                ),
            );
        }
        let runs: Vec<String> = (self.runs.iter())
            .map(|(name, s)| {
                format!(
                    "  {name}: {:.3} m/s, {:.0} N desired; peak {:.0} N, ringing {:.1} Hz, settled after {:.2} s, steady error {:+.2} N\n",
                    s.approach, s.desired, s.peak, s.frequency, s.settling, s.steady
                )
            })
            .collect();
        let _ = write!(text, "\nThe runs\n{}", runs.concat());
        text
    }
}

const CANNOT_TELL: &str = "Why it is off these recordings cannot tell: a play or gain error of the regulator, friction of the seals and a wrong zero of the force sensor would look alike. To tell them apart, record the regulator's outlet, and approach the same force from above and from below";

fn extremes(values: &[f64]) -> [f64; 2] {
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    [least, most]
}

fn report(name: &str, shown: &Shown) -> RunShown {
    RunShown {
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
        contact_lost: shown.lost,
    }
}
