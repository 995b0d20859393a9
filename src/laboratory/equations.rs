//! The device's equations, with all that may be concealed in it.
//!
//! ```text
//! regulator    T p' = K u - p, or p'' + 2 z w p' + w^2 p = w^2 K u, rates limited; outlet = min(max(p, 0), reservoir) + ripple - droop
//! reservoir    m' = m_c s(p) - drawn
//! line         evenly spread: N equal resistances, a cell behind each, the last one half: the half before the first is the outlet's (trapezoidal rule)
//! orifice      m' = A C p_u / sqrt(R T_u) f(u),  f = y / (y^2 + e^2)^(1/4),  y = 2k/(k-1) (u^(2/k) - u^((k+1)/k)),  u held at the critical ratio
//! chamber      E' = cp (T_in m'_in - T m'_out) - p V' + G (T_w - T),  p V = m R T;   C_w T_w' = -G (T_w - T) - G_a (T_w - T_a)
//! piston       M x'' = p1 A1 - p2 A2 - pa (A1 - A2) + M g + F_0 - k_s x - F_seal - F_cushion + stops - contact
//! law          what `law` says, where it acts
//! seal         F = s0 z + s1 z' + b x',   z' = x' - a(z, x') s0 |x'| z / g(x')    (LuGre, Canudas de Wit et al. 1995; a: elastoplastic, Dupont et al. 2002)
//! ```
//!
//! e makes the flow through an orifice smooth where it reverses: 1e-3, felt within 0.05 % of equal pressures.

use std::f64::consts::{PI, TAU};

use super::concealed::{Concealed, Seals};
use super::law::{AT_ONCE, Driver, Law, Place};
use super::programme::Surface;
use super::rig::LaboratoryRig;

/// States, all scaled to the order of 1.
pub(super) const STATES: usize = 30;
/// A state.
pub(super) type State = [f64; STATES];
/// Most cells of a line.
const CELLS: usize = 16;

/// Places in the state.
pub(super) mod at {
    /// Pilot pressure of the regulator, gauge [1e5 Pa].
    pub const PILOT: usize = 0;
    /// Its rate [1e6 Pa/s].
    pub const PILOT_RATE: usize = 1;
    /// Outlet behind its droop, gauge [1e5 Pa].
    pub const DROOPED: usize = 2;
    /// Memory of a law: it is concealed without a droop [1].
    pub const MEMORY: usize = DROOPED;
    /// Air in chambers 1 and 2, as the pressure that it would have in the swept volume at the surroundings' temperature [1e5 Pa].
    pub const AIR: usize = 3;
    /// Temperatures of chambers 1 and 2 over the surroundings' [1].
    pub const WARMTH: usize = 5;
    /// Temperatures of their walls over the surroundings' less one, in thousandths [1].
    pub const WALL: usize = 7;
    /// Stroke over full stroke [1].
    pub const PLACE: usize = 9;
    /// Speed of extension [m/s].
    pub const SPEED: usize = 10;
    /// Deflection of the seals over that at which they slide [1].
    pub const SEAL: usize = 11;
    /// Pressure of the reservoir, absolute [1e5 Pa].
    pub const RESERVOIR: usize = 12;
    /// Filtered force [100 N].
    pub const FORCE: usize = 13;
    /// Pressures of the line's cells, absolute [1e5 Pa].
    pub const LINE: usize = 14;
}

/// Unit of the pressures in the state [Pa].
const UNIT: f64 = 1e5;
/// See the module's head.
const SMOOTH: f64 = 1e-3;
/// Heat capacity of a chamber's wall [J/K]: some 150 g of aluminium.
const WALL_CAPACITY: f64 = 135.0;
/// Conductance from wall to surroundings [W/K].
const WALL_TO_AIR: f64 = 1.0;
/// Time in which the droop of an outlet builds up [s].
const DROOP_TIME: f64 = AT_ONCE;
/// Speed over which the direction of motion turns where a law says so [m/s].
const TURNS: f64 = 1e-3;
/// Least share of an orifice or a stiffness that a law leaves [1].
const LEAST: f64 = 0.05;
/// Pressure of a full reservoir [Pa absolute].
const FULL: f64 = 7e5;
/// Speed over which a dry force that has no bristles turns its sign [m/s].
const DRY_SPEED: f64 = 1e-3;
/// Fastest exchange between cells of a line that is resolved [1/s].
const FASTEST_CELL: f64 = 6e4;

/// Seals that a law presses, where they have no friction beside.
const LIGHT: Seals = Seals {
    coulomb: 1e-3,
    breakaway: 1e-3,
    stribeck_velocity: 0.01,
    viscous: 0.0,
    presliding: 2e-5,
    per_pressure: 0.0,
    elastic_share: 0.4,
};

/// Commands between two of their changes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Command {
    /// Whether the valve extends.
    pub extends: bool,
    /// Pressure that the regulator goes to [Pa gauge].
    pub target: f64,
    /// Set pressure, late as the regulator is [Pa gauge].
    pub set: f64,
}

/// Readings of a state.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Reading {
    /// Outlet [Pa gauge].
    pub outlet: f64,
    /// Stroke [m].
    pub stroke: f64,
    /// Acceleration [m/s2].
    pub acceleration: f64,
    /// Contact force [N].
    pub contact: f64,
    /// Signal of the load cell behind its filter [N].
    pub force: f64,
    /// Pressures of the chambers [Pa absolute].
    pub pressures: [f64; 2],
    /// Air in device and line [kg].
    pub air: f64,
    /// Values of a law's variables, in the order of [`Driver::ALL`].
    pub drivers: [f64; Driver::ALL.len()],
    /// What a law makes act.
    pub law: f64,
}

/// The equations of a device on a programme.
pub(super) struct Equations<'a> {
    pub rig: &'a LaboratoryRig,
    pub concealed: &'a Concealed,
    pub surface: Option<&'a Surface>,
    pub command: Command,
    areas: [f64; 2],
    cells: usize,
    swept: f64,
    critical: f64,
}

/// State of the line and its regulator at a moment.
struct Line {
    at_valve: f64,
    drawn: f64,
    rates: [f64; CELLS],
}

impl<'a> Equations<'a> {
    pub fn new(
        rig: &'a LaboratoryRig,
        concealed: &'a Concealed,
        surface: Option<&'a Surface>,
    ) -> Self {
        let k = rig.gas.ratio;
        let areas = rig.areas();
        Self {
            rig,
            concealed,
            surface,
            command: Command {
                extends: true,
                target: 0.0,
                set: 0.0,
            },
            areas,
            cells: cells(rig, concealed),
            swept: areas[0] * rig.stroke,
            critical: (2.0 / (k + 1.0)).powf(k / (k - 1.0)),
        }
    }

    /// At rest on the retracted stop, everything at the atmosphere.
    pub fn start(&self) -> State {
        let rig = self.rig;
        let mut state = [0.0; STATES];
        let pull = self.pull_at_rest();
        let pressed = (rig.weight() + self.concealed.axial_force + pull).min(0.0);
        state[at::PLACE] = pressed / rig.stop[0] / rig.stroke;
        let volumes = self.volumes(state[at::PLACE] * rig.stroke);
        for side in 0..2 {
            state[at::AIR + side] = rig.gas.atmosphere * volumes[side] / self.swept / UNIT;
            state[at::WARMTH + side] = 1.0;
        }
        state[at::RESERVOIR] = FULL / UNIT;
        for cell in 0..CELLS {
            state[at::LINE + cell] = rig.gas.atmosphere / UNIT;
        }
        if let Some(law) = self.concealed.law.as_ref().filter(|law| law.memory > 0.0) {
            state[at::MEMORY] = law.scaled(self.driver(law.driver, 0.0, &state));
        }
        state
    }

    /// Force of a law on the piston before anything moves [N].
    fn pull_at_rest(&self) -> f64 {
        let mut rest = [0.0; STATES];
        for side in 0..2 {
            let volume = self.volumes(0.0)[side];
            rest[at::AIR + side] = self.rig.gas.atmosphere * volume / self.swept / UNIT;
            rest[at::WARMTH + side] = 1.0;
        }
        self.law(Place::PistonForce, 0.0, &rest)
    }

    /// Value of a variable, but for the flow, of which a law has a memory alone.
    fn driver(&self, driver: Driver, time: f64, state: &State) -> f64 {
        let pressures = || self.pressures(state);
        match driver {
            Driver::Time => time,
            Driver::Stroke => state[at::PLACE] * self.rig.stroke,
            Driver::Velocity => state[at::SPEED],
            Driver::Direction => (state[at::SPEED] / TURNS).tanh(),
            Driver::ChamberPressure => pressures()[0],
            Driver::PressureDifference => pressures()[0] - pressures()[1],
            Driver::SetPressure => self.command.set,
            Driver::ContactForce => self.contact(time, state),
            Driver::Surface => self.surface.map_or(f64::NAN, |surface| surface.at(time)[0]),
            Driver::MassFlow => 0.0,
        }
    }

    /// u of a law, or its memory of it.
    fn input_of_law(&self, time: f64, state: &State) -> f64 {
        match &self.concealed.law {
            Some(law) if law.memory > 0.0 => state[at::MEMORY],
            Some(law) => law.scaled(self.driver(law.driver, time, state)),
            None => 0.0,
        }
    }

    /// What a law makes act at a place; nothing where there is no surface to depend on.
    fn law(&self, place: Place, time: f64, state: &State) -> f64 {
        let Some(law) = self.concealed.law.as_ref().filter(|law| law.place == place) else {
            return 0.0;
        };
        let factor = law
            .factor
            .map_or(1.0, |(driver, _)| self.driver(driver, time, state));
        let value = law.at(self.input_of_law(time, state), factor);
        if value.is_nan() { 0.0 } else { value }
    }

    /// Rate at which a law moves the surface without a contact force [m/s], and by how much more for each newton of it [m/(s N)].
    fn surface_rate(&self, time: f64, state: &State) -> [f64; 2] {
        /// Step of a difference quotient of u.
        const STEP: f64 = 1e-6;
        let law = self.concealed.law.as_ref();
        let Some(law) = law.filter(|law| law.place == Place::Surface) else {
            return [0.0; 2];
        };
        let u = self.input_of_law(time, state);
        let slope = (law.at(u + STEP, 1.0) - law.at(u - STEP, 1.0)) / (2.0 * STEP);
        match law.driver {
            Driver::ContactForce => {
                [law.scaled(0.0) - u, 1.0 / law.scale[1]].map(|rate| slope * rate / law.memory)
            }
            Driver::Surface => {
                let rate = self.surface.map_or(0.0, |surface| surface.at(time)[1]);
                [slope * rate / law.scale[1], 0.0]
            }
            _ => [slope / law.scale[1], 0.0],
        }
    }

    fn volumes(&self, stroke: f64) -> [f64; 2] {
        [
            self.rig.dead_volume + self.areas[0] * stroke,
            self.rig.dead_volume + self.areas[1] * (self.rig.stroke - stroke),
        ]
    }

    /// Mass flow [kg/s] from one side of an orifice [m2] to the other: pressures [Pa absolute], temperatures over the surroundings' [1].
    fn flow(&self, area: f64, from: (f64, f64), to: (f64, f64)) -> f64 {
        if area <= 0.0 {
            return 0.0;
        }
        let gas = &self.rig.gas;
        let (up, down, sign) = if from.0 >= to.0 {
            (from, to, 1.0)
        } else {
            (to, from, -1.0)
        };
        let k = gas.ratio;
        let u = (down.0 / up.0).max(self.critical);
        let y = 2.0 * k / (k - 1.0) * (u.powf(2.0 / k) - u.powf((k + 1.0) / k));
        let f = y / (y * y + SMOOTH * SMOOTH).sqrt().sqrt();
        sign * area * self.rig.discharge * up.0 * f / (gas.constant * gas.temperature * up.1).sqrt()
    }

    fn pressures(&self, state: &State) -> [f64; 2] {
        let volumes = self.volumes(state[at::PLACE] * self.rig.stroke);
        [0, 1].map(|side| {
            state[at::AIR + side] * UNIT * state[at::WARMTH + side] * self.swept / volumes[side]
        })
    }

    /// Outlet without its droop [Pa gauge].
    fn undrooped(&self, time: f64, state: &State) -> f64 {
        let mut outlet = (state[at::PILOT] * UNIT).max(0.0);
        if self.concealed.reservoir.is_some() {
            outlet = outlet.min(state[at::RESERVOIR] * UNIT - self.rig.gas.atmosphere);
        }
        if let Some([amplitude, frequency]) = self.concealed.ripple {
            outlet += amplitude * (TAU * frequency * time).sin();
        }
        let law = self.law(Place::Outlet, time, state);
        // An outlet does not suck.
        if law == 0.0 {
            outlet
        } else {
            (outlet + law).max(0.0)
        }
    }

    fn outlet(&self, time: f64, state: &State) -> f64 {
        if self.concealed.outlet_droop > 0.0 {
            state[at::DROOPED] * UNIT
        } else {
            self.undrooped(time, state)
        }
    }

    /// The line, with what flows on through the valve at the pressure before it.
    fn line(&self, time: f64, state: &State, onward: impl Fn(f64) -> f64) -> Line {
        let atmosphere = self.rig.gas.atmosphere;
        let outlet = self.outlet(time, state) + atmosphere;
        let mut rates = [0.0; CELLS];
        let Some([volume, resistance]) = self.concealed.hose else {
            return Line {
                at_valve: outlet,
                drawn: onward(outlet),
                rates,
            };
        };
        let rt = self.rig.gas.constant * self.rig.gas.temperature;
        let cell = |i: usize| state[at::LINE + i] * UNIT;
        let along = resistance / self.cells as f64;
        let drawn = (outlet - cell(0)) / along;
        let mut inward = drawn;
        for (i, rate) in rates.iter_mut().enumerate().take(self.cells) {
            let out = if i + 1 == self.cells {
                onward(cell(i))
            } else {
                (cell(i) - cell(i + 1)) / along
            };
            *rate = (inward - out) * rt / (self.share_of_line(i) * volume);
            inward = out;
        }
        Line {
            at_valve: cell(self.cells - 1),
            drawn,
            rates,
        }
    }

    /// Share of the line's volume in a cell [1].
    fn share_of_line(&self, cell: usize) -> f64 {
        let size = if cell + 1 == self.cells { 0.5 } else { 1.0 };
        size / self.cells as f64
    }

    /// Rates of the state.
    pub fn rates(&self, time: f64, state: &State) -> State {
        self.rates_and_flow(time, state).0
    }

    /// Rates of a chamber's and its wall's temperature, as the state has them, by what flows in and the power [W] that the air gives to the piston:
    /// m cv T' = cp (sum m'_in T_in - m'_out T) - cv T m' - p V' + G (T_w - T).
    fn warming(
        &self,
        state: &State,
        side: usize,
        conductance: f64,
        [mass_in, warmth_in]: [f64; 2],
        work: f64,
    ) -> [f64; 2] {
        let gas = &self.rig.gas;
        let warmth = state[at::WARMTH + side];
        let cv = gas.constant / (gas.ratio - 1.0);
        let cp = gas.ratio * cv;
        let mass = state[at::AIR + side] * UNIT * self.swept / (gas.constant * gas.temperature);
        let wall = 1.0 + 1e-3 * state[at::WALL + side];
        let heat = conductance * (wall - warmth) * gas.temperature;
        let brought = (cp * warmth_in - cv * warmth * mass_in) * gas.temperature;
        let power = brought - work + heat;
        let lost = WALL_TO_AIR * (wall - 1.0) * gas.temperature;
        [
            power / (mass * cv * gas.temperature),
            -1e3 * (heat + lost) / WALL_CAPACITY / gas.temperature,
        ]
    }

    /// Rates of the state, and the air drawn from the regulator [kg/s].
    fn rates_and_flow(&self, time: f64, state: &State) -> (State, f64) {
        let (rig, concealed, gas) = (self.rig, self.concealed, &self.rig.gas);
        let mut rates = [0.0; STATES];
        let pressures = self.pressures(state);
        let warmth = [state[at::WARMTH], state[at::WARMTH + 1]];
        let chamber = |side: usize| (pressures[side], warmth[side]);
        let (fed, emptied) = if self.command.extends { (0, 1) } else { (1, 0) };
        let outside = (gas.atmosphere, 1.0);

        // Each flow with where it comes from and where it goes to; chambers take part in the heat balance.
        let [supply_area, exhaust_area] = [
            (rig.supply_orifice, Place::Supply),
            (rig.exhaust_orifice, Place::Exhaust),
        ]
        .map(|(area, place)| area * (1.0 + self.law(place, time, state)).max(LEAST));
        let onward = |before: f64| self.flow(supply_area, (before, 1.0), chamber(fed));
        let line = self.line(time, state, onward);
        let supply = onward(line.at_valve);
        let exhaust = self.flow(exhaust_area, chamber(emptied), outside);
        let cross = self.flow(concealed.cross_leak, chamber(0), chamber(1));
        let worn = concealed.external_leak + self.law(Place::FirstLeak, time, state);
        let leak = self.flow(worn, chamber(0), outside);
        let second = self.law(Place::SecondLeak, time, state);
        let second_leak = self.flow(second, chamber(1), outside);
        // Into each chamber: mass, and mass times the temperature that it brings.
        let mut into = [[0.0; 2]; 2];
        let mut move_air = |to: Option<usize>, from: Option<usize>, flow: f64| {
            let source = if flow >= 0.0 { from } else { to };
            let brought = flow * source.map_or(1.0, |side| warmth[side]);
            for (side, sign) in [(to, 1.0), (from, -1.0)] {
                if let Some(side) = side {
                    into[side][0] += sign * flow;
                    into[side][1] += sign * brought;
                }
            }
        };
        move_air(Some(fed), None, supply);
        move_air(None, Some(emptied), exhaust);
        move_air(Some(1), Some(0), cross);
        move_air(None, Some(0), leak);
        move_air(None, Some(1), second_leak);

        let speed = state[at::SPEED];
        let rt = gas.constant * gas.temperature;
        let growth = [self.areas[0] * speed, -self.areas[1] * speed];
        for side in 0..2 {
            rates[at::AIR + side] = into[side][0] * rt / self.swept / UNIT;
            if let Some(conductance) = concealed.wall_conductance {
                let work = pressures[side] * growth[side];
                let [warming, wall] = self.warming(state, side, conductance, into[side], work);
                rates[at::WARMTH + side] = warming;
                rates[at::WALL + side] = wall;
            }
        }
        for (cell, rate) in line.rates.iter().enumerate() {
            rates[at::LINE + cell] = rate / UNIT;
        }
        if let Some([volume, compressor]) = concealed.reservoir {
            let pressure = state[at::RESERVOIR] * UNIT;
            let loading = ((1.0 - pressure / FULL) / 5e-3).clamp(0.0, 1.0);
            rates[at::RESERVOIR] =
                (compressor * loading - line.drawn.max(0.0)) * rt / volume / UNIT;
        }
        self.regulate(time, state, &mut rates);
        if concealed.outlet_droop > 0.0 {
            let goal = self.undrooped(time, state) - concealed.outlet_droop * line.drawn;
            rates[at::DROOPED] = (goal / UNIT - state[at::DROOPED]) / DROOP_TIME;
        }
        self.remember(time, state, line.drawn, &mut rates);

        let (force, contact, seal_rate) = self.piston(time, state, pressures);
        rates[at::PLACE] = speed / rig.stroke;
        rates[at::SPEED] = force / rig.mass;
        rates[at::SEAL] = seal_rate;
        if concealed.force_lag > 0.0 {
            let signal = contact + concealed.crosstalk * rates[at::SPEED];
            rates[at::FORCE] = (signal / 100.0 - state[at::FORCE]) / concealed.force_lag;
        }
        (rates, line.drawn)
    }

    /// Rate of a law's memory, at a flow drawn from the regulator [kg/s].
    fn remember(&self, time: f64, state: &State, drawn: f64, rates: &mut State) {
        if let Some(law) = self.concealed.law.as_ref().filter(|law| law.memory > 0.0) {
            let value = match law.driver {
                Driver::MassFlow => drawn,
                driver => self.driver(driver, time, state),
            };
            rates[at::MEMORY] = (law.scaled(value) - state[at::MEMORY]) / law.memory;
        }
    }

    fn regulate(&self, time: f64, state: &State, rates: &mut State) {
        let target = self.command.target + self.law(Place::SetPressure, time, state);
        let limit = self.concealed.rate_limit;
        let limited = |rate: f64| limit.map_or(rate, |[up, down]| rate.clamp(-down, up));
        let pilot = state[at::PILOT] * UNIT;
        match self.concealed.second_order {
            None => {
                let rate = (target - pilot) / self.rig.time_constant;
                rates[at::PILOT] = limited(rate) / UNIT;
            }
            Some([frequency, damping]) => {
                let rate = state[at::PILOT_RATE] * 1e6;
                let pull = frequency * (frequency * (target - pilot) - 2.0 * damping * rate);
                rates[at::PILOT] = limited(rate) / UNIT;
                rates[at::PILOT_RATE] = pull / 1e6;
            }
        }
    }

    /// Force on the piston [N], contact force [N], rate of the seals' deflection.
    fn piston(&self, time: f64, state: &State, pressures: [f64; 2]) -> (f64, f64, f64) {
        let (rig, concealed) = (self.rig, self.concealed);
        let stroke = state[at::PLACE] * rig.stroke;
        let speed = state[at::SPEED];
        let push = |law: [f64; 2], depth: f64, rate: f64| {
            if depth > 0.0 {
                (law[0] * depth + law[1] * rate).max(0.0)
            } else {
                0.0
            }
        };
        let gas = pressures[0] * self.areas[0]
            - pressures[1] * self.areas[1]
            - rig.gas.atmosphere * (self.areas[0] - self.areas[1]);
        let stops = push(rig.stop, -stroke, -speed) - push(rig.stop, stroke - rig.stroke, speed);
        let mut force =
            gas + rig.weight() + stops + concealed.axial_force - concealed.spring * stroke;
        if let Some([damping, length]) = concealed.cushion {
            let distance = if speed < 0.0 {
                stroke
            } else {
                rig.stroke - stroke
            };
            let share = (1.0 - distance.max(0.0) / length).max(0.0);
            force -= damping * share * speed;
        }
        if let Some([more, place, width]) = concealed.sticky_spot {
            let away = (stroke - place) / width;
            force -= more * (-away * away).exp() * (speed / DRY_SPEED).tanh();
        }
        if speed < 0.0 {
            force -= concealed.one_way_damping * speed;
        }
        if let Some([strength, pitch]) = concealed.detent {
            force -= strength * (TAU * stroke / pitch).sin();
        }
        force += self.law(Place::PistonForce, time, state);
        let mut seal_rate = 0.0;
        if let Some(seals) = self.seals(time, state) {
            let (friction, rate) = seal(
                &seals,
                rig.mass,
                state[at::SEAL],
                speed,
                pressures[0] - pressures[1],
            );
            force -= friction;
            seal_rate = rate;
        }
        let contact = self.contact(time, state);
        (force - contact, contact, seal_rate)
    }

    /// The seals, with what a law presses them by beside.
    fn seals(&self, time: f64, state: &State) -> Option<Seals> {
        let is_elsewhere = |law: &Law| law.place != Place::Friction;
        if self.concealed.law.as_ref().is_none_or(is_elsewhere) {
            return self.concealed.seals;
        }
        let seals = self.concealed.seals.unwrap_or(LIGHT);
        let level = self.law(Place::Friction, time, state);
        Some(Seals {
            coulomb: seals.coulomb + level,
            breakaway: seals.breakaway + level,
            ..seals
        })
    }

    /// Force of the tool on the workpiece [N].
    fn contact(&self, time: f64, state: &State) -> f64 {
        let Some(surface) = self.surface else {
            return 0.0;
        };
        let (stroke, speed) = (state[at::PLACE] * self.rig.stroke, state[at::SPEED]);
        let concealed = self.concealed;
        let [mut place, mut rate] = surface.at(time);
        place += concealed.surface_offset + self.law(Place::Surface, time, state);
        let [moves, gives] = self.surface_rate(time, state);
        rate += moves;
        for swing in &concealed.swings {
            let angular = TAU * swing.frequency;
            let (sine, cosine) = (angular * time + swing.phase).sin_cos();
            place += swing.amplitude * sine;
            rate += swing.amplitude * angular * cosine;
        }
        let depth = stroke - place;
        if depth <= 0.0 {
            return 0.0;
        }
        let softer = (1.0 + self.law(Place::Stiffness, time, state)).max(LEAST);
        let stiffness = softer * self.rig.contact_stiffness;
        let elastic = match concealed.hertz {
            None => stiffness * depth,
            Some(hertz) => softer * hertz * depth * depth.sqrt(),
        };
        let damping = self.rig.contact_damping;
        // What gives way at once takes from the damping.
        (elastic + damping * (speed - rate)).max(0.0) / (1.0 + damping * gives)
    }

    /// Readings of a state.
    pub fn read(&self, time: f64, state: &State) -> Reading {
        let stroke = state[at::PLACE] * self.rig.stroke;
        let pressures = self.pressures(state);
        let (force, contact, _) = self.piston(time, state, pressures);
        let acceleration = force / self.rig.mass;
        let signal = if self.concealed.force_lag > 0.0 {
            100.0 * state[at::FORCE]
        } else {
            contact + self.concealed.crosstalk * acceleration
        };
        let outlet = self.outlet(time, state);
        let rt = self.rig.gas.constant * self.rig.gas.temperature;
        let mut air = (state[at::AIR] + state[at::AIR + 1]) * UNIT * self.swept / rt;
        if let Some([volume, _]) = self.concealed.hose {
            for cell in 0..self.cells {
                air += self.share_of_line(cell) * volume / rt * UNIT * state[at::LINE + cell];
            }
        }
        let mut drivers = Driver::ALL.map(|driver| self.driver(driver, time, state));
        drivers[Driver::ALL.len() - 1] = self.rates_and_flow(time, state).1;
        let place = self.concealed.law.as_ref().map(|law| law.place);
        let added = |place: Place| self.law(place, time, state);
        Reading {
            outlet: outlet + added(Place::PressureReading),
            stroke: stroke + added(Place::StrokeReading),
            acceleration,
            contact,
            force: signal + added(Place::ForceReading),
            pressures,
            air,
            drivers,
            law: place.map_or(0.0, added),
        }
    }
}

/// Cells of a line: as many as can be resolved, no more than there is room for.
fn cells(rig: &LaboratoryRig, concealed: &Concealed) -> usize {
    let Some([volume, resistance]) = concealed.hose else {
        return 1;
    };
    let slow = rig.gas.constant * rig.gas.temperature / (volume * resistance);
    let most = (FASTEST_CELL / (4.0 * slow)).sqrt();
    (most as usize).clamp(4, CELLS)
}

/// Friction [N] of seals at a deflection, over that at which they slide [1], a speed [m/s] and a pressure difference [Pa]; and the deflection's rate.
fn seal(seals: &Seals, mass: f64, deflection: f64, speed: f64, difference: f64) -> (f64, f64) {
    /// Pressure difference at which the presliding displacement holds [Pa].
    const REFERENCE: f64 = 1e5;
    /// Speed at which the bristles' damping has gone [m/s].
    const DAMPED: f64 = 0.02;
    let unit = seals.presliding;
    let stiffness = (seals.coulomb + seals.per_pressure * REFERENCE) / unit;
    let ratio = speed / seals.stribeck_velocity;
    let steady = seals.coulomb
        + seals.per_pressure * difference.abs()
        + (seals.breakaway - seals.coulomb) * (-ratio * ratio).exp();
    let z = deflection * unit;
    let slides = steady / stiffness;
    let elastic = seals.elastic_share * slides;
    let share = if z * speed <= 0.0 || z.abs() <= elastic {
        // Unloading and small deflections are elastic; a seal that creeps has none.
        if seals.elastic_share > 0.0 { 0.0 } else { 1.0 }
    } else if z.abs() >= slides {
        1.0
    } else {
        0.5 - 0.5 * (PI * (z.abs() - elastic) / (slides - elastic)).cos()
    };
    let share = if seals.elastic_share > 0.0 {
        share
    } else {
        1.0
    };
    let rate = speed - share * speed.abs() * z / slides;
    let damping = 0.2 * (stiffness * mass).sqrt() * (-(speed / DAMPED).powi(2)).exp();
    let force = stiffness * z + damping * rate + seals.viscous * speed;
    (force, rate / unit)
}
