//! The air in a chamber over one sampling period, and how it answers to everything that is uncertain.
//!
//! ```text
//! dm/dt = m_dot(p_up, p),   p = m R T / V(x(t))                                       (source paper, eqs. 4 and 9 to 11)
//! dm/dt = k (m_eq(t) - m),  m_eq = p_up V / (R T),  k = m_dot / (m_eq - m)             (the same, as a lag behind equilibrium)
//! d(dm)/dt = f_m dm + f_x dx + f_p dp_up + f_C dC + f_V dV                             (its linearisation)
//! ```
//!
//! m air [kg], p_up pressure that the chamber hangs on [Pa], x stroke [m], C orifice and V_0 dead volume with relative errors dC and dV [1].
//! Near equal pressures k is steep and the chamber simply follows. So k is taken from the middle of a sub-step and the lag solved exactly: of
//! second order, and it cannot overshoot however small the chamber.

use super::belief::{
    ACCELERATION, DEAD_VOLUME, EXHAUST, MASSES, OUTLET, SPEED, STROKE, SUPPLY, TARGET, Term,
};
use crate::device::DeviceParameters;
use crate::physics::chamber::Chamber;
use crate::physics::gas::Gas;
use crate::physics::orifice::FlowFunction;
use crate::physics::valve::{ValveParameters, ValvePosition};

/// Longest sub-step [s].
const LONGEST_SUBSTEP: f64 = 5e-4;
/// Least pressure difference from which k is taken [Pa]; the flow is linear there.
const LEAST_DIFFERENCE: f64 = 1.0;
/// Half width over which the flow's slope is taken [Pa]: what the filter knows the pressure difference to, so that no kink decides.
const SLOPE_HALF_WIDTH: f64 = 50.0;

/// Motion and regulator at the start of a period, nominal.
#[derive(Debug, Clone, Copy)]
pub(super) struct Drive {
    pub(super) stroke: f64,
    pub(super) speed: f64,
    pub(super) acceleration: f64,
    /// Outlet, gauge [Pa].
    pub(super) outlet: f64,
    /// Target that it lags behind, gauge [Pa].
    pub(super) target: f64,
}

/// Both chambers.
#[derive(Debug, Clone)]
pub(super) struct Chambers {
    gas: Gas,
    flow: FlowFunction,
    chambers: [Chamber; 2],
    valve: ValveParameters,
    dead_volume: f64,
    /// Length of a sub-step [s].
    substep: f64,
    /// Share of the outlet's difference from its target that is left at the start, after half a sub-step, after one, ... to the period's end.
    remaining: Vec<f64>,
}

/// Pressure upstream of a chamber [Pa] and place of its piston [m].
#[derive(Debug, Clone, Copy)]
struct Surroundings {
    upstream: f64,
    stroke: f64,
}

/// Derivatives of a flow into a chamber.
struct Slope {
    by_mass: f64,
    by_stroke: f64,
    by_upstream: f64,
    by_orifice: f64,
    by_dead_volume: f64,
}

impl Chambers {
    pub(super) fn new(device: &DeviceParameters, period: f64) -> Self {
        let substeps = (period / LONGEST_SUBSTEP).ceil().max(1.0);
        let substep = period / substeps;
        let halves = 0..=2 * substeps as usize;
        let lag = device.regulator.time_constant;
        Self {
            gas: device.gas,
            flow: FlowFunction::new(&device.gas),
            chambers: device.chambers(),
            valve: device.valve(),
            dead_volume: device.dead_volume,
            substep,
            remaining: halves
                .map(|i| (-0.5 * substep * i as f64 / lag).exp())
                .collect(),
        }
    }

    /// Absolute pressure [Pa] of an air mass [kg] at a stroke [m].
    pub(super) fn pressure(&self, chamber: usize, mass: f64, stroke: f64) -> f64 {
        self.chambers[chamber].pressure(&self.gas, mass, stroke)
    }

    /// Air [kg] at an absolute pressure [Pa] and stroke [m].
    pub(super) fn mass(&self, chamber: usize, pressure: f64, stroke: f64) -> f64 {
        self.gas
            .mass(pressure, self.chambers[chamber].volume(stroke))
    }

    /// Derivatives of the pressure by mass [Pa/kg], stroke [Pa/m] and the dead volume's relative error [Pa].
    pub(super) fn pressure_slopes(&self, chamber: usize, mass: f64, stroke: f64) -> [f64; 3] {
        let volume = self.chambers[chamber].volume(stroke);
        let pressure = self.gas.pressure(mass, volume);
        [
            self.gas.pressure(1.0, volume),
            -pressure / volume * self.chambers[chamber].growth(),
            -pressure / volume * self.dead_volume,
        ]
    }

    /// Whether a chamber hangs on the regulator.
    pub(super) fn is_supplied(chamber: usize, valve: ValvePosition) -> bool {
        (chamber == 0) == (valve == ValvePosition::Extend)
    }

    /// Outlet after a period, gauge [Pa].
    pub(super) fn outlet(&self, drive: &Drive) -> f64 {
        drive.target + (drive.outlet - drive.target) * self.remaining()
    }

    /// Share of the outlet's difference from its target that is left after a period.
    pub(super) fn remaining(&self) -> f64 {
        self.remaining[self.remaining.len() - 1]
    }

    /// The period [s].
    pub(super) fn period(&self) -> f64 {
        self.substep * (self.remaining.len() / 2) as f64
    }

    /// Air after a period [kg], and the terms of its deviation.
    pub(super) fn advance(
        &self,
        chamber: usize,
        mass: f64,
        drive: &Drive,
        valve: ValvePosition,
    ) -> (f64, [Term; 8]) {
        let supplied = Self::is_supplied(chamber, valve);
        let area = if supplied {
            self.valve.supply_conductance
        } else {
            self.valve.exhaust_conductance
        };
        let h = self.substep;
        let after_halves = |halves: usize| {
            let t = 0.5 * h * halves as f64;
            let difference = (drive.outlet - drive.target) * self.remaining[halves];
            let gauge = if supplied {
                (drive.target + difference).max(0.0)
            } else {
                0.0
            };
            Surroundings {
                upstream: self.gas.atmosphere + gauge,
                stroke: drive.stroke + t * (drive.speed + 0.5 * t * drive.acceleration),
            }
        };
        let (mut m, mut terms) = (mass, [0.0; 8]);
        terms[0] = 1.0;
        let mut start = after_halves(0);
        for i in 0..self.remaining.len() / 2 {
            let (middle, end) = (after_halves(2 * i + 1), after_halves(2 * i + 2));
            let equal = [start, middle, end].map(|s| self.mass(chamber, s.upstream, s.stroke));
            let rate = self.relative_rate(chamber, area, m, &start);
            let half = lag(m, equal[0], equal[1], rate, 0.5 * h);
            let rate = self.relative_rate(chamber, area, half, &middle);
            m = lag(m, equal[0], equal[2], rate, h);
            let slope = self.slope(chamber, area, half, &middle);
            self.carry(&mut terms, &slope, i);
            start = end;
        }
        if !supplied {
            terms[4] = 0.0;
            terms[5] = 0.0;
        }
        let elements = [
            MASSES[chamber],
            STROKE,
            SPEED,
            ACCELERATION,
            OUTLET,
            TARGET,
            if supplied { SUPPLY } else { EXHAUST },
            DEAD_VOLUME,
        ];
        let mut pairs = [(0, 0.0); 8];
        for (pair, entry) in pairs.iter_mut().zip(elements.into_iter().zip(terms)) {
            *pair = entry;
        }
        (m, pairs)
    }

    /// k: flow over distance from equilibrium [1/s].
    fn relative_rate(&self, chamber: usize, area: f64, mass: f64, around: &Surroundings) -> f64 {
        let pressure = self.pressure(chamber, mass, around.stroke);
        let mut difference = around.upstream - pressure;
        if difference.abs() < LEAST_DIFFERENCE {
            difference = LEAST_DIFFERENCE;
        }
        let flow = self
            .flow
            .mass_flow(area, around.upstream, around.upstream - difference);
        let by_pressure = flow / difference;
        let volume = self.chambers[chamber].volume(around.stroke);
        by_pressure * self.gas.pressure(1.0, volume)
    }

    /// Derivatives of the flow at a state. The flow is homogeneous of degree one in its pressures, so one slope gives both (Euler).
    fn slope(&self, chamber: usize, area: f64, mass: f64, around: &Surroundings) -> Slope {
        let (upstream, stroke) = (around.upstream, around.stroke);
        let pressure = self.pressure(chamber, mass, stroke);
        let at = |p: f64| self.flow.mass_flow(area, upstream, p);
        let (above, below) = (
            at(pressure + SLOPE_HALF_WIDTH),
            at(pressure - SLOPE_HALF_WIDTH),
        );
        let flow = 0.5 * (above + below);
        let by_pressure = (above - below) / (2.0 * SLOPE_HALF_WIDTH);
        let [by_mass, by_stroke, by_dead_volume] = self.pressure_slopes(chamber, mass, stroke);
        Slope {
            by_mass: by_pressure * by_mass,
            by_stroke: by_pressure * by_stroke,
            by_upstream: (flow - pressure * by_pressure) / upstream,
            by_orifice: flow,
            by_dead_volume: by_pressure * by_dead_volume,
        }
    }

    /// Carries the terms of the deviation over a sub-step; what drives them goes evenly meanwhile.
    fn carry(&self, terms: &mut [f64; 8], slope: &Slope, substep: usize) {
        let h = self.substep;
        let exponent = slope.by_mass * h;
        let decay = exponent.exp();
        let (of_start, of_end) = if exponent.abs() < 1e-4 {
            (0.5 * h, 0.5 * h)
        } else {
            let all = exponent.exp_m1() / exponent;
            let of_end = h * (all - 1.0) / exponent;
            (h * all - of_end, of_end)
        };
        let sources = |node: usize| {
            let (t, left) = (h * node as f64, self.remaining[2 * node]);
            [
                0.0,
                slope.by_stroke,
                slope.by_stroke * t,
                slope.by_stroke * 0.5 * t * t,
                slope.by_upstream * left,
                slope.by_upstream * (1.0 - left),
                slope.by_orifice,
                slope.by_dead_volume,
            ]
        };
        let (start, end) = (sources(substep), sources(substep + 1));
        for (i, term) in terms.iter_mut().enumerate() {
            *term = decay * *term + of_start * start[i] + of_end * end[i];
        }
    }
}

/// Solves dm/dt = rate (m_eq - m) over `h` [s] while the equilibrium goes evenly from `from` to `to` [kg].
fn lag(mass: f64, from: f64, to: f64, rate: f64, h: f64) -> f64 {
    let exponent = rate * h;
    if exponent < 1e-8 {
        return mass + h * rate * (0.5 * (from + to) - mass);
    }
    let behind = (to - from) / exponent;
    to - behind + (mass - from + behind) * (-exponent).exp()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimation::tests::plant::device;

    const DRIVE: Drive = Drive {
        stroke: 0.02,
        speed: 0.03,
        acceleration: 0.5,
        outlet: 1.8e5,
        target: 2.4e5,
    };

    /// Classical Runge-Kutta steps of a microsecond, over a millisecond.
    fn fine(device: &DeviceParameters, chambers: &Chambers, chamber: usize, mass: f64) -> f64 {
        let area = [
            chambers.valve.supply_conductance,
            chambers.valve.exhaust_conductance,
        ][chamber];
        let rate = |m: f64, t: f64| {
            let left = (-t / device.regulator.time_constant).exp();
            let outlet = DRIVE.target + (DRIVE.outlet - DRIVE.target) * left;
            let gauge = [outlet, 0.0][chamber];
            let stroke = DRIVE.stroke + t * (DRIVE.speed + 0.5 * t * DRIVE.acceleration);
            let pressure = chambers.pressure(chamber, m, stroke);
            chambers
                .flow
                .mass_flow(area, chambers.gas.atmosphere + gauge, pressure)
        };
        let h = 1e-6;
        (0..1000).fold(mass, |m, i| {
            let t = h * f64::from(i);
            let k1 = rate(m, t);
            let k2 = rate(m + 0.5 * h * k1, t + 0.5 * h);
            let k3 = rate(m + 0.5 * h * k2, t + 0.5 * h);
            let k4 = rate(m + h * k3, t + h);
            m + h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4)
        })
    }

    #[test]
    fn a_period_agrees_with_fine_steps_filling_following_and_however_stiff() {
        let mut device = device();
        // With orifices 30 times as large the chamber all but arrives within a sub-step; the error is 1 % of the way it went.
        for (scale, tolerance) in [(1.0, 2e-5), (30.0, 5e-3)] {
            device.supply_orifice = 2.5e-6 * scale;
            device.exhaust_orifice = 2e-6 * scale;
            let chambers = Chambers::new(&device, 1e-3);
            for chamber in [0, 1] {
                for start in [2.9e5, 2.6e5, 1.2e5] {
                    let mass = chambers.mass(chamber, start, DRIVE.stroke);
                    let extend = ValvePosition::Extend;
                    let (after, _) = chambers.advance(chamber, mass, &DRIVE, extend);
                    let exact = fine(&device, &chambers, chamber, mass);
                    let error = (after - exact) / exact;
                    assert!(
                        error.abs() < tolerance,
                        "{scale} {chamber} {start}: {error}"
                    );
                }
            }
        }
    }

    #[test]
    fn the_terms_are_the_derivatives_of_the_period() {
        let device = device();
        let chambers = Chambers::new(&device, 1e-3);
        let advance = |chambers: &Chambers, mass: f64, drive: Drive| {
            chambers.advance(0, mass, &drive, ValvePosition::Extend).0
        };
        let mass = chambers.mass(0, 2.7e5, DRIVE.stroke);
        let (_, terms) = chambers.advance(0, mass, &DRIVE, ValvePosition::Extend);
        let term = |element| terms.iter().find(|t| t.0 == element).unwrap().1;
        let of_drive = |change: &dyn Fn(&mut Drive, f64), step: f64| {
            let at = |step: f64| {
                let mut drive = DRIVE;
                change(&mut drive, step);
                advance(&chambers, mass, drive)
            };
            (at(step) - at(-step)) / (2.0 * step)
        };
        let of_mass = {
            let at = |step: f64| advance(&chambers, mass + step, DRIVE);
            (at(1e-8) - at(-1e-8)) / 2e-8
        };
        let of_device = |change: &dyn Fn(&mut DeviceParameters, f64)| {
            let at = |step: f64| {
                let mut other = device.clone();
                change(&mut other, step);
                advance(&Chambers::new(&other, 1e-3), mass, DRIVE)
            };
            (at(1e-4) - at(-1e-4)) / 2e-4
        };
        for (element, slope) in [
            (MASSES[0], of_mass),
            (STROKE, of_drive(&|d, e| d.stroke += e, 1e-6)),
            (SPEED, of_drive(&|d, e| d.speed += e, 1e-4)),
            (OUTLET, of_drive(&|d, e| d.outlet += e, 10.0)),
            (TARGET, of_drive(&|d, e| d.target += e, 100.0)),
            (SUPPLY, of_device(&|d, e| d.supply_orifice *= 1.0 + e)),
            (DEAD_VOLUME, of_device(&|d, e| d.dead_volume *= 1.0 + e)),
        ] {
            let ratio = term(element) / slope;
            assert!((ratio - 1.0).abs() < 0.01, "{element}: {ratio}");
        }
    }
}
