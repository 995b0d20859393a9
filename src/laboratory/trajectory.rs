//! A device run on a programme: stretches between two changes of a command, on each of which the equations are smooth but for impacts.

use differential_equations::interpolate::Interpolation;
use differential_equations::methods::{DormandPrince, ExplicitRungeKutta, Ordinary};
use differential_equations::ode::{ODE, OrdinaryNumericalMethod};
use differential_equations::status::Status;

use super::concealed::Concealed;
use super::equations::{Command, Equations, Reading, STATES, State};
use super::programme::Programme;
use super::rig::LaboratoryRig;

/// Relative tolerance of a step.
const TOLERANCE: f64 = 1e-8;
/// First step after a change of a command [s].
const FIRST_STEP: f64 = 1e-6;
/// Steps at most in a recording.
const MOST_STEPS: usize = 20_000_000;

/// True trajectory of a recording, one value per sample time.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct LaboratoryTrajectory {
    /// Readings of ideal sensors with the device's own errors, in the order of [`super::CHANNELS`].
    pub readings: [Vec<f64>; 4],
    /// Contact force [N].
    pub contact: Vec<f64>,
    /// Pressures of the chambers [Pa absolute].
    pub pressures: [Vec<f64>; 2],
    /// Air in the chambers and the line [kg].
    pub air: Vec<f64>,
    /// Values of what a law may depend on, in the order of [`super::Driver::ALL`].
    pub drivers: Vec<[f64; 10]>,
    /// What a law makes act.
    pub law: Vec<f64>,
}

/// A device that cannot be run.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum LaboratoryError {
    /// The integrator gave up.
    #[error("{recording}: the laboratory's integrator is stuck at {time} s: {what}")]
    Stuck {
        /// The recording.
        recording: String,
        /// When [s].
        time: f64,
        /// Its text.
        what: String,
    },
    /// No law that was drawn will do.
    #[error("seed {seed}: none of the laws drawn for this device will do")]
    NoLaw {
        /// Seed of the device.
        seed: u64,
    },
}

impl ODE<f64, State> for Equations<'_> {
    fn diff(&self, time: f64, state: &State, rates: &mut State) {
        *rates = self.rates(time, state);
    }
}

type Method = ExplicitRungeKutta<Ordinary, DormandPrince, f64, State, 5, 7, 7>;

fn method(
    equations: &Equations<'_>,
    time: f64,
    end: f64,
    state: &State,
    step: f64,
) -> Option<Method> {
    let mut method: Method = ExplicitRungeKutta::dopri5()
        .rtol(TOLERANCE)
        .atol(0.1 * TOLERANCE)
        .h0(step.min(end - time))
        .max_steps(usize::MAX)
        .max_rejects(usize::MAX);
    method.init(equations, time, end, state).ok()?;
    method.set_status(Status::Solving);
    Some(method)
}

/// Changes of what acts on the device: time [s], command from then on.
fn commands(
    rig: &LaboratoryRig,
    concealed: &Concealed,
    programme: &Programme,
) -> Vec<(f64, Command)> {
    let mut acted_on = 0.0f64;
    let mut targets = vec![(0.0, 0.0)];
    let mut sets = vec![(0.0, 0.0)];
    for (time, pressure) in &programme.set_pressures {
        acted_on = acted_on.clamp(pressure - concealed.play, pressure + concealed.play);
        targets.push((time + concealed.dead_time, rig.gain * acted_on));
        sets.push((time + concealed.dead_time, *pressure));
    }
    let mut valve = vec![(0.0, true)];
    for (time, extends) in &programme.valve {
        // A valve whose command does not change has nothing to be late with.
        let late = if *time > 0.0 {
            concealed.switching_delay
        } else {
            0.0
        };
        valve.push((time + late, *extends));
    }
    let mut times: Vec<f64> = targets
        .iter()
        .map(|t| t.0)
        .chain(valve.iter().map(|v| v.0))
        .collect();
    times.sort_by(f64::total_cmp);
    times.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    let last = |list: &[(f64, f64)], time: f64| {
        list.iter()
            .rev()
            .find(|c| c.0 <= time + 1e-9)
            .map_or(0.0, |c| c.1)
    };
    times
        .into_iter()
        .map(|time| {
            let extends = valve
                .iter()
                .rev()
                .find(|v| v.0 <= time + 1e-9)
                .is_none_or(|v| v.1);
            (
                time,
                Command {
                    extends,
                    target: last(&targets, time),
                    set: last(&sets, time),
                },
            )
        })
        .collect()
}

/// Readings at their times, taken while a solution goes on.
struct Readings {
    /// Times in order, each with its sample and whether it is that of the force.
    wanted: Vec<(f64, usize, bool)>,
    /// The first that is still to be taken.
    next: usize,
    is_late: bool,
    taken: Vec<Reading>,
}

impl Readings {
    /// Force is read when its stamp says less its delay.
    fn new(samples: &[f64], late: f64) -> Self {
        let is_late = late != 0.0;
        let mut wanted: Vec<(f64, usize, bool)> = samples
            .iter()
            .enumerate()
            .flat_map(|(i, t)| {
                let both = [(*t, i, false), ((t - late).max(0.0), i, true)];
                both.into_iter().take(if is_late { 2 } else { 1 })
            })
            .collect();
        wanted.sort_by(|a, b| a.0.total_cmp(&b.0));
        Self {
            wanted,
            next: 0,
            is_late,
            taken: vec![Reading::default(); samples.len()],
        }
    }

    /// Time of the next reading, if it is not after `until` [s].
    fn due(&self, until: f64) -> Option<f64> {
        let next = self.wanted.get(self.next)?.0;
        (next <= until + 1e-12).then_some(next)
    }

    fn take(&mut self, reading: Reading) {
        let (_, index, is_force) = self.wanted[self.next];
        let own = &mut self.taken[index];
        if is_force {
            own.force = reading.force;
        } else {
            let force = if self.is_late {
                own.force
            } else {
                reading.force
            };
            *own = Reading { force, ..reading };
        }
        self.next += 1;
    }
}

/// Runs a device.
///
/// # Errors
/// The integrator cannot go on.
pub fn run(
    rig: &LaboratoryRig,
    concealed: &Concealed,
    programme: &Programme,
) -> Result<LaboratoryTrajectory, LaboratoryError> {
    let mut equations = Equations::new(rig, concealed, programme.surface.as_ref());
    let mut state = equations.start();
    let mut readings = Readings::new(&programme.times, concealed.force_late);
    let end = readings.wanted.last().map_or(0.0, |w| w.0) + 1e-6;
    let commands = commands(rig, concealed, programme);
    for (index, (from, command)) in commands.iter().enumerate() {
        let until = commands.get(index + 1).map_or(end, |l| l.0).min(end);
        if until <= *from {
            continue;
        }
        equations.command = *command;
        // What a sample at the very start of a stretch reads is the state there.
        while readings.due(*from).is_some() {
            readings.take(equations.read(*from, &state));
        }
        let stuck = |time: f64, what: String| LaboratoryError::Stuck {
            recording: programme.name.clone(),
            time,
            what,
        };
        let fresh = |time: f64, state: &State, step: f64| {
            method(&equations, time, until, state, step)
                .ok_or_else(|| stuck(time, "it cannot start".to_owned()))
        };
        let mut solver = fresh(*from, &state, FIRST_STEP)?;
        for steps in 0.. {
            let left = until - solver.t();
            if left <= 1e-12 {
                break;
            }
            if solver.h() >= left * (1.0 - 1e-9) {
                solver.set_h(left);
            }
            if steps > MOST_STEPS {
                return Err(stuck(solver.t(), "too many steps".to_owned()));
            }
            if solver.step(&equations).is_err() {
                // Its test of stiffness is no failure here: accuracy is held all the same.
                let (time, state, step) = (solver.t(), *solver.y(), 0.5 * solver.h().min(left));
                if step.is_nan() || step <= 1e-13 || !state.iter().all(|v| v.is_finite()) {
                    return Err(stuck(time, "its steps vanish".to_owned()));
                }
                solver = fresh(time, &state, step)?;
                continue;
            }
            if matches!(solver.status(), Status::RejectedStep) {
                continue;
            }
            while let Some(time) = readings.due(solver.t()) {
                let time = time.clamp(solver.t_prev(), solver.t());
                let there: State = solver
                    .interpolate(time)
                    .map_err(|error| stuck(time, format!("{error:?}")))?;
                readings.take(equations.read(time, &there));
            }
        }
        state = *solver.y();
    }
    Ok(trajectory(concealed, programme, &readings.taken))
}

fn trajectory(
    concealed: &Concealed,
    programme: &Programme,
    readings: &[Reading],
) -> LaboratoryTrajectory {
    let of = |value: &dyn Fn(&Reading) -> f64| readings.iter().map(value).collect::<Vec<f64>>();
    let times = programme.times.iter();
    let force = readings.iter().zip(times).map(|(reading, time)| {
        let [bias, drift] = concealed.force_bias;
        // The zero drifts in the instrument's own time.
        let value = concealed.force_gain * reading.force + bias + drift * time;
        value.clamp(-concealed.force_limit, concealed.force_limit)
    });
    LaboratoryTrajectory {
        readings: [
            of(&|r| r.outlet),
            of(&|r| concealed.stroke_gain * r.stroke),
            force.collect(),
            of(&|r| r.acceleration),
        ],
        contact: of(&|r| r.contact),
        pressures: [of(&|r| r.pressures[0]), of(&|r| r.pressures[1])],
        air: of(&|r| r.air),
        drivers: readings.iter().map(|r| r.drivers).collect(),
        law: of(&|r| r.law),
    }
}

const _: () = assert!(
    STATES == 30,
    "the scaled norm of a step is over this many states"
);

#[cfg(test)]
mod tests {
    use super::super::draw::NominalRig;
    use super::*;

    fn programme(pressure: f64, times: Vec<f64>) -> Programme {
        Programme {
            name: "test".to_owned(),
            set_pressures: vec![(0.0, pressure)],
            valve: vec![(0.0, true)],
            surface: None,
            times,
        }
    }

    #[test]
    fn sealed_chambers_keep_their_air_whatever_the_piston_does() {
        let mut rig = NominalRig::draw(3).rig;
        (rig.supply_orifice, rig.exhaust_orifice, rig.gravity) = (0.0, 0.0, 30.0);
        let concealed = Concealed {
            cross_leak: 1e-7,
            ..Concealed::default()
        };
        let times = (0..200).map(|i| f64::from(i) * 0.01).collect();
        let trajectory = run(&rig, &concealed, &programme(0.0, times)).unwrap();
        let stroke = &trajectory.readings[1];
        assert!(stroke.iter().any(|x| *x > 0.1 * rig.stroke), "it moves");
        for air in &trajectory.air {
            assert!((air / trajectory.air[0] - 1.0).abs() < 1e-7);
        }
    }

    #[test]
    fn a_chamber_behind_a_choked_orifice_fills_at_a_constant_rate() {
        let mut rig = NominalRig::draw(4).rig;
        // Held on a hard stop, and a regulator that is there at once.
        (rig.gravity, rig.time_constant, rig.stop) = (-500.0, 1e-5, [1e9, 2e5]);
        let set = 8e5;
        let times: Vec<f64> = (1..=20).map(|i| f64::from(i) * 5e-4).collect();
        let trajectory = run(&rig, &Concealed::default(), &programme(set, times.clone())).unwrap();
        let (gas, up) = (rig.gas, set + rig.gas.atmosphere);
        let k = gas.ratio;
        let choked = (k * (2.0 / (k + 1.0)).powf((k + 1.0) / (k - 1.0))).sqrt();
        let volume = rig.dead_volume + rig.areas()[0] * trajectory.readings[1][19];
        let root = (gas.constant * gas.temperature).sqrt();
        let slope = rig.supply_orifice * rig.discharge * up * choked * root / volume;
        let [from, to] = [5, 19].map(|i| trajectory.pressures[0][i]);
        assert!(to < 0.528 * up, "choked to the end");
        let found = (to - from) / (times[19] - times[5]);
        assert!((found / slope - 1.0).abs() < 1e-4, "{found} {slope}");
    }

    #[test]
    fn air_that_keeps_its_heat_is_compressed_adiabatically() {
        let mut rig = NominalRig::draw(5).rig;
        (rig.supply_orifice, rig.exhaust_orifice, rig.gravity) = (0.0, 0.0, 30.0);
        let concealed = Concealed {
            wall_conductance: Some(0.0),
            ..Concealed::default()
        };
        let times: Vec<f64> = (0..100).map(|i| f64::from(i) * 0.004).collect();
        let trajectory = run(&rig, &concealed, &programme(0.0, times)).unwrap();
        let volume = |i: usize| rig.dead_volume + rig.areas()[0] * trajectory.readings[1][i];
        let constant = |i: usize| trajectory.pressures[0][i] * volume(i).powf(rig.gas.ratio);
        for i in 0..100 {
            assert!((constant(i) / constant(0) - 1.0).abs() < 1e-5, "{i}");
        }
    }

    #[test]
    fn a_late_stamp_is_the_force_of_that_time_before() {
        let mut nominal = NominalRig::draw(6);
        nominal.rig.gravity = -5.0;
        let mut programme = nominal.programmes(6, 2.0)[0].clone();
        let late = Concealed {
            force_late: 0.02,
            ..Concealed::default()
        };
        let now = run(&nominal.rig, &Concealed::default(), &programme).unwrap();
        let then = run(&nominal.rig, &late, &programme).unwrap();
        for i in 5..programme.times.len() {
            let off = then.readings[2][i] - now.readings[2][i - 5];
            assert!(
                off.abs() < 1e-3 * (1.0 + now.readings[2][i - 5].abs()),
                "{i} {off}"
            );
        }
        // The other way round: the programme's own times do not matter to what happens.
        programme.times.retain(|t| (t * 125.0).fract() < 1e-6);
        let fewer = run(&nominal.rig, &Concealed::default(), &programme).unwrap();
        let last = fewer.contact.len() - 1;
        let twin = now.contact[2 * last];
        assert!((fewer.contact[last] - twin).abs() < 1e-3 * (1.0 + twin));
    }
}
