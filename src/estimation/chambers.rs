//! The air in a chamber over one sampling period, and how it answers to everything that is uncertain.
//!
//!     dm/dt = m_dot(p_up, p),   p = m R T / V(x(t))                                       (source paper, eqs. 4 and 9 to 11)
//!     d(dm)/dt = f_m dm + f_x dx + f_p dp_up + f_C dC + f_V dV                             (its linearisation, exact over a sub-step)
//!
//! m air [kg], p_up pressure that the chamber hangs on [Pa], x stroke [m], C orifice and V_0 dead volume with relative errors dC and dV [1].
//! Near equal pressures f_m is steep and the chamber simply follows; the exponential of the linearisation stays bounded there.

use super::belief::{
    ACCELERATION, DEAD_VOLUME, EXHAUST, MASSES, OUTLET, SPEED, STROKE, SUPPLY, TARGET, Term,
};
use crate::device::DeviceParameters;
use crate::physics::chamber::{Chamber, Side};
use crate::physics::gas::Gas;
use crate::physics::orifice::FlowFunction;
use crate::physics::valve::{ValveParameters, ValvePosition};

/// Longest sub-step [s]: a tenth of a millisecond's worth of the emptiest chamber's time constant is not needed, half of it is.
const LONGEST_SUBSTEP: f64 = 5e-4;
/// Half width over which the flow's slope is taken [Pa]: what the filter knows the pressure difference to, so that no kink decides.
const SLOPE_HALF_WIDTH: f64 = 50.0;

/// Motion and regulator at the start of a period, as believed.
#[derive(Debug, Clone, Copy)]
pub(super) struct Drive {
    pub(super) stroke: f64,
    pub(super) speed: f64,
    pub(super) acceleration: f64,
    /// Outlet, gauge [Pa].
    pub(super) outlet: f64,
    /// What it lags behind, gauge [Pa].
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
    time_constant: f64,
}

/// Rate of a mass and its derivatives.
struct Slope {
    by_mass: f64,
    by_stroke: f64,
    by_upstream: f64,
    by_orifice: f64,
    by_dead_volume: f64,
}

impl Chambers {
    pub(super) fn new(device: &DeviceParameters) -> Self {
        Self {
            gas: device.gas,
            flow: FlowFunction::new(&device.gas),
            chambers: device.chambers(),
            valve: device.valve(),
            dead_volume: device.dead_volume,
            time_constant: device.regulator.time_constant,
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
            pressure / mass,
            -pressure / volume * self.volume_by_stroke(chamber),
            -pressure / volume * self.dead_volume,
        ]
    }

    fn volume_by_stroke(&self, chamber: usize) -> f64 {
        match self.chambers[chamber].side {
            Side::Extending => self.chambers[chamber].area,
            Side::Retracting => -self.chambers[chamber].area,
        }
    }

    /// Does a chamber hang on the regulator?
    pub(super) fn is_supplied(chamber: usize, valve: ValvePosition) -> bool {
        (chamber == 0) == (valve == ValvePosition::Extend)
    }

    /// Outlet after a time [s], gauge [Pa].
    pub(super) fn outlet(&self, drive: &Drive, time: f64) -> f64 {
        drive.target + (drive.outlet - drive.target) * self.remaining(time)
    }

    /// Share of the outlet's difference from its target that is left after a time [s].
    pub(super) fn remaining(&self, time: f64) -> f64 {
        (-time / self.time_constant).exp()
    }

    /// Air after a period [s], and the terms of its deviation.
    pub(super) fn advance(
        &self,
        chamber: usize,
        mass: f64,
        drive: &Drive,
        valve: ValvePosition,
        period: f64,
    ) -> (f64, [Term; 8]) {
        let supplied = Self::is_supplied(chamber, valve);
        let conductance = if supplied {
            self.valve.supply_conductance
        } else {
            self.valve.exhaust_conductance
        };
        let upstream = |t: f64| {
            let gauge = if supplied { self.outlet(drive, t) } else { 0.0 };
            self.gas.atmosphere + gauge.max(0.0)
        };
        let stroke = |t: f64| drive.stroke + t * (drive.speed + 0.5 * t * drive.acceleration);
        let rate = |m: f64, upstream: f64, stroke: f64| {
            let pressure = self.pressure(chamber, m, stroke);
            self.flow.mass_flow(conductance, upstream, pressure)
        };
        let substeps = (period / LONGEST_SUBSTEP).ceil().max(1.0);
        let h = period / substeps;
        let (mut m, mut terms) = (mass, [0.0; 8]);
        terms[0] = 1.0;
        let (mut p_start, mut x_start) = (upstream(0.0), stroke(0.0));
        for i in 0..substeps as usize {
            let t = h * i as f64;
            let (p_middle, x_middle) = (upstream(t + 0.5 * h), stroke(t + 0.5 * h));
            let (p_end, x_end) = (upstream(t + h), stroke(t + h));
            let k1 = rate(m, p_start, x_start);
            let k2 = rate(m + 0.5 * h * k1, p_middle, x_middle);
            let middle = m + 0.5 * h * k2;
            let k3 = rate(middle, p_middle, x_middle);
            let k4 = rate(m + h * k3, p_end, x_end);
            m += h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4);
            let slope = self.slope(chamber, conductance, middle, p_middle, x_middle);
            self.carry(&mut terms, &slope, t + 0.5 * h, h);
            (p_start, x_start) = (p_end, x_end);
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

    /// Derivatives of the flow at a state. The flow is homogeneous of degree one in its pressures, so one slope gives both (Euler).
    fn slope(&self, chamber: usize, area: f64, mass: f64, upstream: f64, stroke: f64) -> Slope {
        let pressure = self.pressure(chamber, mass, stroke);
        let at = |p: f64| self.flow.mass_flow(area, upstream, p);
        let flow = at(pressure);
        let by_pressure = (at(pressure + SLOPE_HALF_WIDTH) - at(pressure - SLOPE_HALF_WIDTH))
            / (2.0 * SLOPE_HALF_WIDTH);
        let [by_mass, by_stroke, by_dead_volume] = self.pressure_slopes(chamber, mass, stroke);
        Slope {
            by_mass: by_pressure * by_mass,
            by_stroke: by_pressure * by_stroke,
            by_upstream: (flow - pressure * by_pressure) / upstream,
            by_orifice: flow,
            by_dead_volume: by_pressure * by_dead_volume,
        }
    }

    /// Carries the terms of the deviation over a sub-step of `h` [s] whose middle is at `time` [s].
    fn carry(&self, terms: &mut [f64; 8], slope: &Slope, time: f64, h: f64) {
        let exponent = slope.by_mass * h;
        let decay = exponent.exp();
        let reach = if exponent.abs() < 1e-8 {
            h
        } else {
            exponent.exp_m1() / slope.by_mass
        };
        let left = self.remaining(time);
        let sources = [
            0.0,
            slope.by_stroke,
            slope.by_stroke * time,
            slope.by_stroke * 0.5 * time * time,
            slope.by_upstream * left,
            slope.by_upstream * (1.0 - left),
            slope.by_orifice,
            slope.by_dead_volume,
        ];
        for (term, source) in terms.iter_mut().zip(sources) {
            *term = decay * *term + reach * source;
        }
    }
}
