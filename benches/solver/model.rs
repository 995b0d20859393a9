//! The device on a load as a plain system of four differential equations, for solvers that know nothing of this project.
//!
//! State: air in chambers 1 and 2 [kg], stroke [m], speed [m/s], each over its own scale, so that one tolerance suits all.
//! The equations are those of `physics`, isothermal, without dry friction or line, written once more: they also give their derivatives.
//! Between discontinuities - a set pressure that arrives, the valve, a contact made or left - a `Leg` holds and all is smooth but the flow's kinks.

use idc_cell::device::{Device, DeviceParameters, PistonMotion};
use idc_cell::physics::chamber::Chamber;
use idc_cell::physics::orifice::{FlowFunction, LAMINAR_RATIO};
use idc_cell::physics::push_only::PushOnly;
use idc_cell::physics::valve::ValvePosition;

/// Masses, stroke and speed over their scales [1].
pub type State = [f64; 4];

/// Contacts that push on the piston.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Contacts {
    /// Retracted stop, extended stop, load.
    pub pushing: [bool; 3],
}

/// Quantities that hold from one discontinuity to the next.
#[derive(Debug, Clone, Copy)]
pub struct Leg {
    /// Since when [s].
    pub start: f64,
    /// The regulator's outlet then, gauge [Pa].
    pub outlet: f64,
    /// Where its lag takes it, gauge [Pa].
    pub target: f64,
    /// Position of the valve.
    pub valve: ValvePosition,
    /// Contacts that push.
    pub contacts: Contacts,
}

/// A device, gravity, and a load that stands still.
#[derive(Debug, Clone)]
pub struct Model {
    chambers: [Chamber; 2],
    supply: f64,
    exhaust: f64,
    moving_mass: f64,
    weight: f64,
    viscous: f64,
    lag_rate: f64,
    atmosphere: f64,
    /// R T [J/kg].
    rt: f64,
    inverse_sqrt_rt: f64,
    exponent: f64,
    factor: f64,
    critical_ratio: f64,
    choked: f64,
    laminar_slope: f64,
    stop: PushOnly,
    full_stroke: f64,
    load: Option<(f64, PushOnly)>,
    /// Scale of the masses [kg].
    mass_scale: f64,
}

/// Derivatives of the rates: the entries that are not zero.
#[derive(Debug, Clone, Copy)]
pub struct Slopes {
    /// Of each chamber's inflow, with its own air and with the stroke.
    pub flow: [[f64; 2]; 2],
    /// Of the speed's rate, with both masses, stroke and speed.
    pub speed: [f64; 4],
    /// Of the stroke's rate with the speed.
    pub stroke: f64,
    /// Of each chamber's inflow with time.
    pub time: [f64; 2],
}

/// Inflow [kg/s], its derivative with the pressure inside and with that outside [kg/(s Pa)].
type Inflow = [f64; 3];

impl Model {
    /// `gravity` is its component along extension [m/s2]; the load stands at a position [m].
    pub fn new(parameters: &DeviceParameters, gravity: f64, load: Option<(f64, PushOnly)>) -> Self {
        let gas = &parameters.gas;
        let flow = FlowFunction::new(gas);
        let k = gas.heat_capacity_ratio;
        let valve = parameters.valve();
        let chambers = parameters.chambers();
        let rt = gas.specific_gas_constant * gas.temperature;
        Self {
            chambers,
            supply: valve.supply_conductance,
            exhaust: valve.exhaust_conductance,
            moving_mass: parameters.moving_mass,
            weight: parameters.moving_mass * gravity,
            viscous: parameters.seal_friction.viscous,
            lag_rate: 1.0 / parameters.regulator.time_constant,
            atmosphere: gas.atmosphere,
            rt,
            inverse_sqrt_rt: 1.0 / rt.sqrt(),
            exponent: (k - 1.0) / k,
            factor: 2.0 * k / (k - 1.0),
            critical_ratio: flow.critical_ratio(),
            choked: flow.value(0.0),
            laminar_slope: flow.laminar_slope(),
            stop: parameters.end_stop,
            full_stroke: parameters.full_stroke,
            load,
            mass_scale: gas.mass(gas.atmosphere, chambers[0].volume(parameters.full_stroke)),
        }
    }

    /// A device's state and motion as a state of this model.
    pub fn state(&self, device: &Device, masses: [f64; 2], motion: PistonMotion) -> State {
        let full_stroke = device.parameters().full_stroke;
        [
            masses[0] / self.mass_scale,
            masses[1] / self.mass_scale,
            motion.stroke / full_stroke,
            motion.speed,
        ]
    }

    /// Motion of the piston.
    pub fn motion(&self, state: &State) -> PistonMotion {
        PistonMotion {
            stroke: state[2] * self.full_stroke,
            speed: state[3],
        }
    }

    /// Absolute pressures in the chambers [Pa].
    pub fn pressures(&self, state: &State) -> [f64; 2] {
        let stroke = state[2] * self.full_stroke;
        [0, 1].map(|i| state[i] * self.mass_scale * self.rt / self.chambers[i].volume(stroke))
    }

    /// Force of the tool on the load [N].
    pub fn load_force(&self, state: &State) -> f64 {
        let motion = self.motion(state);
        self.load.map_or(0.0, |(position, law)| {
            law.force(motion.stroke - position, motion.speed)
        })
    }

    /// The regulator's outlet, gauge [Pa].
    pub fn outlet(&self, leg: &Leg, time: f64) -> f64 {
        leg.target + (leg.outlet - leg.target) * (-(time - leg.start) * self.lag_rate).exp()
    }

    /// Contacts that push on the piston at a state.
    pub fn contacts(&self, state: &State) -> Contacts {
        let PistonMotion { stroke, speed } = self.motion(state);
        let load = self
            .load
            .is_some_and(|(position, law)| law.pushes(stroke - position, speed));
        Contacts {
            pushing: [
                self.stop.pushes(-stroke, -speed),
                self.stop.pushes(stroke - self.full_stroke, speed),
                load,
            ],
        }
    }

    /// Force of what pushes, with its derivatives with stroke and speed.
    fn contact_force(&self, contacts: Contacts, motion: PistonMotion) -> [f64; 3] {
        let PistonMotion { stroke, speed } = motion;
        let mut sum = [0.0; 3];
        let mut add = |force: f64, law: &PushOnly| {
            sum[0] += force;
            sum[1] -= law.stiffness;
            sum[2] -= law.damping;
        };
        if contacts.pushing[0] {
            add(self.stop.linear(-stroke, -speed), &self.stop);
        }
        if contacts.pushing[1] {
            let force = -self.stop.linear(stroke - self.full_stroke, speed);
            add(force, &self.stop);
        }
        if contacts.pushing[2]
            && let Some((position, law)) = self.load
        {
            add(-law.linear(stroke - position, speed), &law);
        }
        sum
    }

    /// Eqs. (9) to (11) of the source paper; `SLOPES` says whether the derivatives are wanted.
    fn inflow<const SLOPES: bool>(&self, conductance: f64, outside: f64, inside: f64) -> Inflow {
        let inwards = outside >= inside;
        let (up, down) = if inwards {
            (outside, inside)
        } else {
            (inside, outside)
        };
        let ratio = down / up;
        // f and its derivative.
        let (value, slope) = if ratio < self.critical_ratio {
            (self.choked, 0.0)
        } else if ratio > LAMINAR_RATIO {
            (self.laminar_slope * (1.0 - ratio), -self.laminar_slope)
        } else {
            let a = ratio.powf(self.exponent);
            let root = (self.factor * (1.0 - a)).sqrt();
            let slope = if SLOPES {
                root / a * (1.0 - self.exponent - 0.5 * self.exponent * a / (1.0 - a))
            } else {
                0.0
            };
            (ratio / a * root, slope)
        };
        let size = conductance * self.inverse_sqrt_rt;
        let (by_up, by_down) = (size * (value - ratio * slope), size * slope);
        if inwards {
            [size * up * value, by_down, by_up]
        } else {
            [-size * up * value, -by_up, -by_down]
        }
    }

    fn inflows<const SLOPES: bool>(&self, leg: &Leg, outlet: f64, p: [f64; 2]) -> [Inflow; 2] {
        let supply = self.atmosphere + outlet;
        match leg.valve {
            ValvePosition::Extend => [
                self.inflow::<SLOPES>(self.supply, supply, p[0]),
                self.inflow::<SLOPES>(self.exhaust, self.atmosphere, p[1]),
            ],
            ValvePosition::Retract => [
                self.inflow::<SLOPES>(self.exhaust, self.atmosphere, p[0]),
                self.inflow::<SLOPES>(self.supply, supply, p[1]),
            ],
        }
    }

    /// Rates of the state [1/s].
    pub fn rates(&self, leg: &Leg, time: f64, state: &State) -> State {
        let pressures = self.pressures(state);
        let flows = self.inflows::<false>(leg, self.outlet(leg, time), pressures);
        let motion = self.motion(state);
        let areas = [self.chambers[0].area, self.chambers[1].area];
        let gas = pressures[0] * areas[0]
            - pressures[1] * areas[1]
            - self.atmosphere * (areas[0] - areas[1]);
        let contact = self.contact_force(leg.contacts, motion)[0];
        let force = gas + self.weight + contact - self.viscous * motion.speed;
        [
            flows[0][0] / self.mass_scale,
            flows[1][0] / self.mass_scale,
            motion.speed / self.full_stroke,
            force / self.moving_mass,
        ]
    }

    /// Whether nothing moves, and nothing will until the leg ends.
    pub fn rests(&self, leg: &Leg, state: &State) -> bool {
        let rates = self.rates(leg, leg.start, state);
        leg.outlet == leg.target && rates.iter().all(|rate| rate.abs() < 1e-9)
    }

    /// Derivatives of the rates.
    pub fn slopes(&self, leg: &Leg, time: f64, state: &State) -> Slopes {
        let pressures = self.pressures(state);
        let outlet = self.outlet(leg, time);
        let flows = self.inflows::<true>(leg, outlet, pressures);
        let motion = self.motion(state);
        let [_, by_stroke, by_speed] = self.contact_force(leg.contacts, motion);
        let mut slopes = Slopes {
            flow: [[0.0; 2]; 2],
            speed: [
                0.0,
                0.0,
                by_stroke * self.full_stroke,
                by_speed - self.viscous,
            ]
            .map(|slope| slope / self.moving_mass),
            stroke: 1.0 / self.full_stroke,
            time: [0.0; 2],
        };
        for i in 0..2 {
            let chamber = &self.chambers[i];
            let volume = chamber.volume(motion.stroke);
            let by_mass = self.mass_scale * self.rt / volume;
            let by_stroke = -pressures[i] * chamber.growth() / volume * self.full_stroke;
            let by_pressure = flows[i][1] / self.mass_scale;
            slopes.flow[i] = [by_pressure * by_mass, by_pressure * by_stroke];
            // Pressure on this side times the area, which is the volume's growth.
            let acceleration = chamber.growth() / self.moving_mass;
            slopes.speed[i] = acceleration * by_mass;
            slopes.speed[2] += acceleration * by_stroke;
        }
        let supplied = usize::from(leg.valve == ValvePosition::Retract);
        let outlet_rate = (leg.target - outlet) * self.lag_rate;
        slopes.time[supplied] = flows[supplied][2] / self.mass_scale * outlet_rate;
        slopes
    }
}

impl Slopes {
    /// As a matrix by rows.
    pub fn matrix(&self) -> [[f64; 4]; 4] {
        let [first, second] = self.flow;
        [
            [first[0], 0.0, first[1], 0.0],
            [0.0, second[0], second[1], 0.0],
            [0.0, 0.0, 0.0, self.stroke],
            self.speed,
        ]
    }
}
