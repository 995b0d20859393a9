//! Devices, carriers and the printed equations that the other files share.

use idc_cell::device::{Device, DeviceParameters, DeviceState, Load, PistonMotion};
use idc_cell::physics::gas::Gas;
use idc_cell::physics::gas_process::GasProcess;
use idc_cell::physics::push_only::PushOnly;
use idc_cell::physics::regulator::RegulatorParameters;
use idc_cell::physics::seal_friction::SealFriction;

/// Prints the figure that was reached and holds it against what is asked.
pub fn reached(what: &str, figure: f64, asked: f64) {
    println!("{what}: {figure:.1e} (asked {asked:.0e})");
    assert!(figure <= asked, "{what}: {figure:e} is more than {asked:e}");
}

/// The device of models/device.toml.
pub fn usual() -> DeviceParameters {
    DeviceParameters {
        cylinder_count: 2,
        bore: 0.032,
        rod: 0.012,
        full_stroke: 0.05,
        dead_volume: 2e-5,
        moving_mass: 4.0,
        supply_orifice: 2.5e-6,
        exhaust_orifice: 2e-6,
        discharge_coefficient: 0.95,
        regulator: RegulatorParameters {
            gain: 1.0,
            time_constant: 0.15,
            dead_time: 0.02,
            supply: 6e5,
            ..RegulatorParameters::default()
        },
        end_stop: PushOnly {
            stiffness: 1e6,
            damping: 2e3,
        },
        seal_friction: SealFriction::NONE,
        gas: Gas::default(),
        gas_process: GasProcess::Isothermal,
        hose: None,
        lock_stiffness: 1e8,
        ..DeviceParameters::default()
    }
}

/// The same without openings.
pub fn closed(gas_process: GasProcess) -> DeviceParameters {
    DeviceParameters {
        supply_orifice: 0.0,
        exhaust_orifice: 0.0,
        gas_process,
        ..usual()
    }
}

/// No heat from the walls.
pub const ADIABATIC: GasProcess = GasProcess::WallHeat { conductance: 0.0 };

/// R T of the usual gas [J/kg].
pub fn rt() -> f64 {
    let gas = Gas::default();
    gas.specific_gas_constant * gas.temperature
}

/// Volumes below eq. (6), by hand [m3].
pub fn volumes(parameters: &DeviceParameters, stroke: f64) -> [f64; 2] {
    let disc = |diameter: f64| std::f64::consts::FRAC_PI_4 * diameter * diameter;
    let count = f64::from(parameters.cylinder_count);
    let first = count * disc(parameters.bore);
    let second = first - count * disc(parameters.rod);
    [
        parameters.dead_volume + first * stroke,
        parameters.dead_volume + second * (parameters.full_stroke - stroke),
    ]
}

/// At rest at a stroke [m], the chambers at these absolute pressures [Pa], the regulator at a set pressure [Pa gauge].
pub fn filled(device: &Device, stroke: f64, pressures: [f64; 2], set_pressure: f64) -> DeviceState {
    let mut state = device.at_rest(stroke, set_pressure);
    let gas = &device.parameters().gas;
    let volumes = volumes(device.parameters(), stroke);
    state.air.masses = [0, 1].map(|i| gas.mass(pressures[i], volumes[i]));
    let per_mass = gas.specific_heat_volume() * gas.temperature;
    state.air.energies = state.air.masses.map(|mass| mass * per_mass);
    state
}

/// Not moving.
pub const fn still(stroke: f64) -> PistonMotion {
    PistonMotion { stroke, speed: 0.0 }
}

/// Loads on a piston that moves: a constant force along extension, and a load.
#[derive(Debug, Clone, Copy)]
pub struct Outside {
    /// Weight and the like, along extension [N].
    pub force: f64,
    /// Where a load stands [m], and its law.
    pub load: Option<(f64, PushOnly)>,
    /// For the choice of sub-steps [1/s].
    pub rate: f64,
}

impl Outside {
    pub const NOTHING: Self = Self {
        force: 0.0,
        load: None,
        rate: 0.0,
    };

    pub fn force(force: f64) -> Self {
        Self {
            force,
            ..Self::NOTHING
        }
    }

    /// The load cell of the paper's scenarios.
    pub fn load_cell(position: f64) -> Self {
        let law = PushOnly {
            stiffness: 1.5e5,
            damping: 400.0,
        };
        Self {
            load: Some((position, law)),
            rate: (1.5e5f64 / 4.0).sqrt(),
            ..Self::NOTHING
        }
    }

    /// Force on the load [N].
    pub fn contact(&self, motion: PistonMotion) -> f64 {
        self.load.map_or(0.0, |(position, law)| {
            law.force(motion.stroke - position, motion.speed)
        })
    }
}

impl Load for Outside {
    type Now = ();

    fn now(&self, _: f64) {}

    fn force(&self, (): &(), motion: PistonMotion, touching: bool) -> f64 {
        let load = match self.load {
            Some((position, law)) if touching => law.linear(motion.stroke - position, motion.speed),
            _ => 0.0,
        };
        self.force - load
    }

    fn touches(&self, (): &(), motion: PistonMotion) -> bool {
        self.load
            .is_some_and(|(position, law)| law.pushes(motion.stroke - position, motion.speed))
    }

    fn rate(&self) -> f64 {
        self.rate
    }
}

/// Eq. (11) as printed.
pub fn printed_critical_ratio(k: f64) -> f64 {
    (2.0 / (k + 1.0)).powf(k / (k - 1.0))
}

/// Eq. (10) as printed.
pub fn printed_flow_function(k: f64, u: f64) -> f64 {
    if u >= printed_critical_ratio(k) {
        (2.0 * k / (k - 1.0) * (u.powf(2.0 / k) - u.powf((k + 1.0) / k))).sqrt()
    } else {
        (k * (2.0 / (k + 1.0)).powf((k + 1.0) / (k - 1.0))).sqrt()
    }
}

/// Eq. (9) as printed: flow [kg/s] through an area times coefficient [m2] from a supply into a chamber [Pa absolute].
pub fn printed_flow(conductance_area: f64, supply: f64, chamber: f64) -> f64 {
    conductance_area * supply / rt().sqrt() * printed_flow_function(1.4, chamber / supply)
}
