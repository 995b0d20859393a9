//! Time integration: classical Runge-Kutta of order four on the air and the piston, in sub-steps that the stiffest part allows; a line between
//! regulator and valve is taken implicitly (`line_step`).
//!
//! The state is the air's mass (and energy), so that no air is lost however coarse the step. The regulator is solved exactly and known at every
//! stage. Whatever makes the law not smooth - a contact or a stop made or left, the seals' reversal, a set pressure that arrives - is met where it
//! happens: a mode is held over a sub-step, and a sub-step that ends in another mode is cut where that mode begins: a turn of the speed is found by
//! the ITP rule, all else by bisection.
//!
//! Chosen by measurement over adaptive stiff solvers: benches/solver, docs/SPEED.md.

use std::borrow::Borrow;

use super::DeviceParameters;
use super::load::{Load, PistonMotion};
use super::pneumatics::Device;
use super::state::{AirState, DeviceState, Disturbance, EnergyLedger};
use crate::physics::orifice::LAMINAR_RATIO;
use crate::physics::regulator::OutletTrajectory;
use crate::physics::valve::ValvePosition;

/// Largest sub-step times the fastest rate of the pneumatics [1]; the method is stable to 2.78 and damps to a third here.
const AIR_LIMIT: f64 = 1.2;
/// Largest sub-step times the fastest rate of stops and load, of a piston that hardly moves [rad]: its error, in proportion to its swing and to the
/// fourth power of this, is as small.
const SLOW_LIMIT: f64 = 0.6;
/// Speed from which on a piston is no longer slow [m/s].
const SWIFT: f64 = 0.03;
/// Error of a sub-step of a line, in proportion to air and stroke, beyond which it is taken in halves [1].
const LINE_ERROR: f64 = 1e-6;
/// Share of that below which the next one may be twice as long [1].
const FAR_BELOW: f64 = 0.02;
/// Sub-step of a line that is not halved [s].
const SHORTEST_LINE_STEP: f64 = 5e-5;
/// Sub-steps of a step beyond which a device is out of all proportion: its run then ends with the state that cannot be.
const MOST_SUBSTEPS: f64 = 2e4;
/// Looks at most when a change of mode is sought: to 1e-7 of a sub-step.
const LOOKS: i32 = 25;
/// Halvings of a sub-step in which a flow begins.
const MOST_HALVINGS: i32 = 8;
/// Changes of mode that are sought in one sub-step; a piston that chatters is then taken as it comes.
const MOST_EVENTS: usize = 6;

/// The integrated quantities.
#[derive(Debug, Clone, Copy)]
pub(super) struct Flow {
    pub(super) air: AirState,
    ledger: EnergyLedger,
    pub(super) motion: PistonMotion,
    /// Impulse since the start of the step: of the gas on the piston, and of the piston on its contact [N s].
    pub(super) impulses: Impulses,
}

/// Impulses over a step [N s].
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Impulses {
    /// Of the gas on the piston, along extension.
    pub gas: f64,
    /// Of the piston on its contact, along extension; kept with the ledger.
    pub load: f64,
}

impl Flow {
    #[inline(always)]
    pub(super) fn after(&self, rates: &Self, time: f64, ledger: bool) -> Self {
        Self {
            air: self.air.after(&rates.air, time),
            ledger: if ledger {
                self.ledger.after(&rates.ledger, time)
            } else {
                self.ledger
            },
            motion: PistonMotion {
                stroke: self.motion.stroke + time * rates.motion.stroke,
                speed: self.motion.speed + time * rates.motion.speed,
            },
            impulses: Impulses {
                gas: self.impulses.gas + time * rates.impulses.gas,
                load: self.impulses.load + time * rates.impulses.load,
            },
        }
    }
}

/// Quantities that hold over a sub-step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Mode {
    touching: bool,
    stop: i8,
    /// The end cushion that is being pressed.
    cushion: i8,
    /// Direction of sliding, where seals rub.
    direction: i8,
}

/// What is outside the device at a time of the step: each is looked at once, for the sub-step that ends then and the one that begins.
#[derive(Debug, Clone, Copy)]
pub(super) struct Outside<N> {
    /// Since the start of the step [s].
    pub(super) time: f64,
    /// Pressure at the regulator's outlet [Pa gauge].
    pub(super) outlet: f64,
    /// Of the load.
    load: N,
}

/// A sub-step that was tried.
pub(super) struct Step<N> {
    /// The flow at its end.
    pub(super) flow: Flow,
    /// What is outside then.
    pub(super) end: Outside<N>,
    /// Error of a device with a line, in proportion to what is in its chambers and to its stroke, by the embedded method of order three; of others, whose
    /// sub-steps are short enough by their rates, 0 [1].
    pub(super) error: f64,
}

/// A sub-step's surroundings.
pub(super) struct Surroundings<'a, L, P> {
    pub(super) device: &'a Device<P>,
    load: &'a L,
    pub(super) valve: ValvePosition,
    pub(super) trajectory: OutletTrajectory,
    /// Start of the trajectory in the step [s].
    pub(super) trajectory_start: f64,
    /// Deflection of the seals at the start of the sub-step [m].
    deflection: f64,
    pub(super) disturbance: Disturbance,
    /// Longest sub-step of a line by the error of those before [s].
    line_part: f64,
}

impl<P: Borrow<DeviceParameters>> Device<P> {
    /// Returns the impulses of the step.
    pub(super) fn integrate<L: Load, const LEDGER: bool>(
        &self,
        state: &mut DeviceState,
        motion: &mut PistonMotion,
        set_pressure: f64,
        load: &L,
        dt: f64,
        substeps: usize,
    ) -> Impulses {
        let regulator = &self.parameters().regulator;
        let set_pressure = set_pressure + state.disturbance.set_pressure;
        state.regulator.command(regulator, set_pressure);
        let delay = self.parameters().switching_delay;
        state.spool.command(state.valve, delay);
        let mut now = load.now(0.0);
        let longest = (dt / substeps as f64)
            .min(self.longest_substep((load, &now), state, *motion, dt))
            .max(dt / MOST_SUBSTEPS);
        let mut flow = Flow {
            air: state.air,
            ledger: state.ledger,
            motion: *motion,
            impulses: Impulses::default(),
        };
        let mut time = 0.0;
        let mut line_part = dt;
        while time < dt {
            let until_switching = state.spool.remaining();
            let trajectory = state
                .regulator
                .trajectory(regulator, (dt - time).min(until_switching));
            // A hair's breadth less than one more sub-step is rounding.
            let count = (trajectory.duration / longest - 1e-9).ceil().max(0.0);
            let h = trajectory.duration / count.max(1.0);
            let mut surroundings = Surroundings {
                device: self,
                load,
                valve: state.spool.position(state.valve),
                trajectory,
                trajectory_start: time,
                deflection: state.seal_deflection,
                disturbance: state.disturbance,
                line_part,
            };
            if count > 0.0 {
                let mut at = Outside {
                    time,
                    outlet: surroundings.outlet(time),
                    load: now,
                };
                at = surroundings.begin::<LEDGER>(&mut flow, at, h);
                for i in 1..count as usize {
                    at.time = time + h * i as f64;
                    at = surroundings.advance::<LEDGER>(&mut flow, at, h);
                }
                now = at.load;
            }
            state.seal_deflection = surroundings.deflection;
            line_part = surroundings.line_part;
            state.regulator.follow(regulator, &trajectory);
            state.spool.advance(trajectory.duration);
            if let Some(reservoir) = &self.parameters().supply_reservoir {
                let gas = &self.parameters().gas;
                let stored = reservoir.pressure(gas, flow.air.reservoir_mass);
                state.regulator.starve(stored - gas.atmosphere);
            }
            time += trajectory.duration;
        }
        state.air = flow.air;
        state.ledger = flow.ledger;
        if L::MOVES {
            *motion = flow.motion;
            state.seal_stroke = flow.motion.stroke;
        }
        flow.impulses
    }

    fn longest_substep<L: Load>(
        &self,
        (load, now): (&L, &L::Now),
        state: &DeviceState,
        motion: PistonMotion,
        dt: f64,
    ) -> f64 {
        let volumes = self.smallest_volumes(motion, dt);
        let air = AIR_LIMIT / self.air_rate(volumes, &state.disturbance);
        if !L::MOVES {
            return air;
        }
        // What the valve may let in during the step.
        let outlet = self.parameters().gas.atmosphere + state.regulator.outlet;
        let spring = self.spring_rate(&state.air, volumes, outlet);
        let fastest = spring.max(self.piston_rates.within(load, motion, dt));
        let swing = load.swing();
        let mechanical = swing / fastest;
        let allowed = air.min(dt);
        if mechanical >= allowed {
            return allowed;
        }
        let outside = load.force(now, motion, load.touches(now, motion));
        let force = self.piston_force(state, motion) + outside;
        let acceleration = force / self.parameters().moving_mass;
        let speed = motion.speed.abs() + acceleration.abs() * dt;
        let ease = (SWIFT / speed).sqrt().sqrt();
        allowed.min(mechanical * ease.clamp(1.0, (SLOW_LIMIT / swing).max(1.0)))
    }
}

/// Where a speed is looked at next for its turn, of two times with the speeds there: where a straight line between them turns, drawn to the middle and kept as
/// near to it as bisection would have come by then [s]. So it takes no more looks than that, and a few where the speed is smooth (ITP: Oliveira and
/// Takahashi, ACM Transactions on Mathematical Software 47, 2020, with k1 = 0.2 and k2 = 2).
fn next_look([a, b]: [[f64; 2]; 2], widest: f64, whole: f64) -> f64 {
    let width = b[0] - a[0];
    let middle = 0.5 * (a[0] + b[0]);
    let straight = (b[1] * a[0] - a[1] * b[0]) / (b[1] - a[1]);
    if !straight.is_finite() {
        return middle;
    }
    let towards = (middle - straight).signum();
    let truncated = match 0.2 * width * width / whole {
        step if step <= (middle - straight).abs() => straight + towards * step,
        _ => middle,
    };
    let reach = (widest - 0.5 * width).max(0.0);
    match (truncated - middle).abs() <= reach {
        true => truncated,
        false => middle - towards * reach,
    }
}

impl<L: Load, P: Borrow<DeviceParameters>> Surroundings<'_, L, P> {
    /// Advances over the first sub-step of a trajectory. Where the outlet leaves the chamber's pressure, the flow begins with the root of time, which a step
    /// of whatever order meets with an error of its length to the power 1.5 alone: that sub-step is halved towards its start.
    fn begin<const LEDGER: bool>(
        &mut self,
        flow: &mut Flow,
        start: Outside<L::Now>,
        h: f64,
    ) -> Outside<L::Now> {
        let halvings = self.halvings(flow, h);
        let mut part = h * 0.5f64.powi(halvings);
        let time = start.time;
        let mut at = self.advance::<LEDGER>(flow, start, part);
        for _ in 0..halvings {
            at.time = time + part;
            at = self.advance::<LEDGER>(flow, at, part);
            part *= 2.0;
        }
        at
    }

    /// Number of times that the first sub-step of a trajectory is halved until the outlet moves in it by no more than it is away from the chamber's pressure already,
    /// or than the orifice passes in proportion.
    #[inline]
    fn halvings(&self, flow: &Flow, h: f64) -> i32 {
        let parameters = self.device.parameters();
        let travel = self.trajectory.travel(h);
        let outlet = parameters.gas.atmosphere + self.trajectory.start() + self.disturbance.outlet;
        let proportional = (1.0 - LAMINAR_RATIO) * outlet;
        // The end of a line moves smoothly.
        if travel < 2.0 * proportional || parameters.hose.is_some() {
            return 0;
        }
        let supplied = self.valve.supplied();
        let volumes = [0, 1].map(|i| self.device.chambers[i].volume(flow.motion.stroke));
        let away = (outlet - self.device.pressures_of(&flow.air, volumes)[supplied]).abs();
        let halvings = (travel / away.max(proportional)).log2() as i32;
        halvings.clamp(0, MOST_HALVINGS)
    }

    /// Advances over a sub-step, cut where the mode changes; gives what is outside at its end.
    fn advance<const LEDGER: bool>(
        &mut self,
        flow: &mut Flow,
        start: Outside<L::Now>,
        h: f64,
    ) -> Outside<L::Now> {
        let (mut from, mut left) = (start, h);
        let mut events = 0;
        while events < MOST_EVENTS {
            let mode = self.mode(&from.load, flow.motion);
            let tried = left.min(self.line_part);
            let step = self.step::<LEDGER>(flow, &from, tried, mode);
            if self.is_too_long(&step, tried) {
                self.line_part = 0.5 * tried;
                continue;
            }
            let (whole, end) = (step.flow, step.end);
            if self.mode(&end.load, whole.motion) == mode {
                self.accept(flow, whole, [from.time, tried]);
                from = end;
                left -= tried;
                // What is left of a sub-step that was taken in halves is rounding.
                if left <= 1e-9 * h {
                    return end;
                }
                continue;
            }
            events += 1;
            let (mut before, mut after) = ([0.0, flow.motion.speed], tried);
            let (mut there, mut end) = (whole, end);
            let near = tried * 0.5f64.powi(LOOKS - 1);
            for look in 0..LOOKS {
                if after - before[0] <= near {
                    break;
                }
                let turns = Mode {
                    direction: mode.direction,
                    ..self.mode(&end.load, there.motion)
                } == mode;
                let ends = [before, [after, there.motion.speed]];
                let middle = match turns {
                    true => next_look(ends, near * 2.0f64.powi(LOOKS - 1 - look), tried),
                    false => 0.5 * (before[0] + after),
                };
                let looked = self.step::<LEDGER>(flow, &from, middle, mode);
                if self.mode(&looked.end.load, looked.flow.motion) == mode {
                    before = [middle, looked.flow.motion.speed];
                } else {
                    (after, there, end) = (middle, looked.flow, looked.end);
                }
            }
            self.accept(flow, there, [from.time, after]);
            from = end;
            left -= after;
            if left <= 0.0 {
                return end;
            }
        }
        let mode = self.mode(&from.load, flow.motion);
        let rest = self.step::<LEDGER>(flow, &from, left, mode);
        self.accept(flow, rest.flow, [from.time, left]);
        rest.end
    }

    fn accept(&mut self, flow: &mut Flow, next: Flow, [start, length]: [f64; 2]) {
        self.load.note(start, length, [flow.motion, next.motion]);
        let device = self.device;
        if L::MOVES && device.parameters().seal_friction.is_dry() {
            let ends = [&*flow, &next].map(|flow| (&flow.air, flow.motion.stroke));
            let seals = device.seals_over(ends, self.disturbance.friction);
            let moved = next.motion.stroke - flow.motion.stroke;
            let speed = 0.5 * (flow.motion.speed + next.motion.speed);
            self.deflection = seals.deflection_after(self.deflection, moved, speed);
        }
        *flow = next;
    }

    fn mode(&self, now: &L::Now, motion: PistonMotion) -> Mode {
        if !L::MOVES {
            return Mode {
                touching: false,
                stop: 0,
                cushion: 0,
                direction: 0,
            };
        }
        let dry = self.device.parameters().seal_friction.is_dry();
        Mode {
            touching: self.load.touches(now, motion),
            stop: self.device.stop_at(motion),
            cushion: self.device.cushion_at(motion),
            direction: if dry { motion.speed.signum() as i8 } else { 0 },
        }
    }

    /// Pressure at the regulator's outlet at a time in the step [Pa gauge].
    fn outlet(&self, time: f64) -> f64 {
        self.trajectory.at(time - self.trajectory_start) + self.disturbance.outlet
    }

    /// What is outside at a time in the step.
    pub(super) fn outside(&self, time: f64) -> Outside<L::Now> {
        Outside {
            time,
            outlet: self.outlet(time),
            load: self.load.now(time),
        }
    }

    /// What is outside in the middle and at the end of a sub-step.
    fn ahead(&self, start: &Outside<L::Now>, h: f64) -> [Outside<L::Now>; 2] {
        let added = self.disturbance.outlet;
        let since = start.time - self.trajectory_start;
        let outlets = (self.trajectory).ahead(start.outlet - added, since, h);
        let times = [start.time + 0.5 * h, start.time + h];
        [0, 1].map(|i| Outside {
            time: times[i],
            outlet: outlets[i] + added,
            load: self.load.now(times[i]),
        })
    }

    /// One Runge-Kutta step, or one of a line.
    fn step<const LEDGER: bool>(
        &self,
        start: &Flow,
        from: &Outside<L::Now>,
        h: f64,
        mode: Mode,
    ) -> Step<L::Now> {
        if let Some(hose) = &self.device.parameters().hose {
            return self.line_step::<LEDGER>(hose, start, from, h, mode);
        }
        let [middle, end] = self.ahead(from, h);
        let rates = |flow: &Flow, at: &Outside<L::Now>| {
            self.rates::<LEDGER>(flow, start.motion.stroke, at, mode)
        };
        let k1 = rates(start, from);
        let k2 = rates(&start.after(&k1, 0.5 * h, false), &middle);
        let k3 = rates(&start.after(&k2, 0.5 * h, false), &middle);
        let k4 = rates(&start.after(&k3, h, false), &end);
        let flow = start
            .after(&k1, h / 6.0, LEDGER)
            .after(&k2, h / 3.0, LEDGER)
            .after(&k3, h / 3.0, LEDGER)
            .after(&k4, h / 6.0, LEDGER);
        Step {
            flow,
            end,
            error: 0.0,
        }
    }

    /// Whether a sub-step of a line is to be taken in halves; one that is far from it may be followed by a longer one.
    fn is_too_long(&mut self, step: &Step<L::Now>, length: f64) -> bool {
        if step.error <= LINE_ERROR {
            if step.error < LINE_ERROR * FAR_BELOW {
                // Also behind a change of mode, whose last piece is short for another reason.
                self.line_part = self.line_part.max(2.0 * length);
            }
            return false;
        }
        length > SHORTEST_LINE_STEP
    }

    /// Rates of everything; `substep_stroke` [m] is where the sub-step began, with the seals at `self.deflection`.
    pub(super) fn rates<const LEDGER: bool>(
        &self,
        flow: &Flow,
        substep_stroke: f64,
        at: &Outside<L::Now>,
        mode: Mode,
    ) -> Flow {
        let device = self.device;
        let parameters = device.parameters();
        let motion = flow.motion;
        let atmosphere = parameters.gas.atmosphere;
        let air = device.air_rates::<LEDGER>(
            &flow.air,
            self.valve,
            atmosphere + at.outlet,
            motion,
            &self.disturbance,
        );
        let gas_force = device.gas_force_of(air.pressures);
        let mut rates = Flow {
            air: air.air,
            ledger: air.ledger,
            motion: PistonMotion {
                stroke: motion.speed,
                speed: 0.0,
            },
            impulses: Impulses {
                gas: gas_force,
                load: 0.0,
            },
        };
        if L::MOVES {
            let seals = parameters
                .seal_friction
                .under(air.pressures[0] - air.pressures[1])
                .with(self.disturbance.friction);
            let moved = motion.stroke - substep_stroke;
            let deflection = seals.deflection_after(self.deflection, moved, motion.speed);
            let seal = seals.force(deflection, motion.speed);
            let stop = device.stop_force_of(mode.stop, motion);
            let cushion = device.cushion_force_of(mode.cushion, motion);
            let axial = device.axial_force(motion.stroke);
            let load = self.load.force(&at.load, motion, mode.touching);
            let force = gas_force - seal + stop + cushion + axial + load;
            rates.motion.speed = force / parameters.moving_mass;
            if LEDGER {
                rates.ledger.seal_work = seal * motion.speed;
                rates.ledger.stop_work = -stop * motion.speed;
                rates.ledger.cushion_work = -cushion * motion.speed;
                rates.ledger.axial_work = axial * motion.speed;
                rates.ledger.load_work = load * motion.speed;
                rates.impulses.load = self.load.contact(&at.load, motion, mode.touching);
            }
        }
        if LEDGER {
            let rod = atmosphere * device.areas.rod() * motion.speed;
            rates.ledger.atmosphere_work = rod;
            rates.ledger.chamber_work = gas_force * motion.speed + rod;
        }
        rates
    }
}

#[cfg(test)]
mod tests {
    use super::{LOOKS, next_look};

    /// Looks until a turn of a speed within [0, 1] is known to 1e-7, and where it then is.
    fn sought(speed: impl Fn(f64) -> f64) -> (i32, f64) {
        let near = 0.5f64.powi(LOOKS - 1);
        let (mut before, mut after) = ([0.0, speed(0.0)], [1.0, speed(1.0)]);
        for look in 0..LOOKS {
            if after[0] - before[0] <= near {
                return (look, after[0]);
            }
            let widest = near * 2.0f64.powi(LOOKS - 1 - look);
            let at = next_look([before, after], widest, 1.0);
            match speed(at) * speed(0.0) > 0.0 {
                true => before = [at, speed(at)],
                false => after = [at, speed(at)],
            }
        }
        (LOOKS, after[0])
    }

    #[test]
    fn a_smooth_turn_takes_a_few_looks_and_none_more_than_bisection() {
        for turn in [1e-3, 0.1, 0.37, 0.5, 0.93] {
            let (looks, at) = sought(|t| 0.3 * (turn - t) * (1.0 + 0.4 * t));
            assert!((at - turn).abs() < 1e-7, "{turn}: {at}");
            assert!(looks <= 12, "{turn}: {looks} looks");
            // Where a straight line says nothing: a jump, and a turn that is nearly a rest.
            for (looks, at) in [
                sought(|t| if t < turn { 1e-6 } else { -1.0 }),
                sought(|t| (turn - t).powi(9)),
            ] {
                assert!((at - turn).abs() < 1e-7, "{turn}: {at}");
                assert!(looks <= LOOKS, "{looks}");
            }
        }
    }
}
