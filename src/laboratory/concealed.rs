//! Effects at work in a device that its owner's model leaves out.

use super::law::Law;

/// Seal and guide friction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seals {
    /// Coulomb friction [N].
    pub coulomb: f64,
    /// Static friction [N].
    pub breakaway: f64,
    /// Stribeck velocity [m/s].
    pub stribeck_velocity: f64,
    /// Viscous coefficient [N s/m].
    pub viscous: f64,
    /// Coulomb friction over the initial stiffness [m].
    pub presliding: f64,
    /// Growth with the pressure difference across the piston [N/Pa].
    pub per_pressure: f64,
    /// Share of the breakaway deflection up to which the seal is purely elastic [1]; 0 for a seal that creeps from the start.
    pub elastic_share: f64,
}

/// A periodic displacement: amplitude [m], frequency [Hz], phase at t = 0 [rad].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Swing {
    /// Zero to peak [m].
    pub amplitude: f64,
    /// Frequency [Hz].
    pub frequency: f64,
    /// Phase at the start of each recording [rad].
    pub phase: f64,
}

/// All that may be concealed; the default conceals nothing. Numbers of the rig itself that are off are `Some` of what they really are.
#[derive(Debug, Clone, PartialEq)]
pub struct Concealed {
    /// Moving mass [kg].
    pub mass: Option<f64>,
    /// Dead volume [m3].
    pub dead_volume: Option<f64>,
    /// Supply orifice [m2].
    pub supply_orifice: Option<f64>,
    /// Exhaust orifice [m2].
    pub exhaust_orifice: Option<f64>,
    /// Gain of the regulator [1].
    pub gain: Option<f64>,
    /// Stiffness of the contact [N/m].
    pub contact_stiffness: Option<f64>,

    /// Friction.
    pub seals: Option<Seals>,
    /// Stiffness of something that pulls from the retracted end [N/m].
    pub spring: f64,
    /// Constant force along extension [N].
    pub axial_force: f64,
    /// End cushions: damping at the end [N s/m] and length [m].
    pub cushion: Option<[f64; 2]>,

    /// Leak from chamber to chamber [m2].
    pub cross_leak: f64,
    /// Leak of chamber 1 to the atmosphere [m2].
    pub external_leak: f64,
    /// Conductance from gas to wall [W/K]; none where the air keeps its temperature.
    pub wall_conductance: Option<f64>,
    /// Line between regulator and valve: volume [m3], resistance [Pa s/kg].
    pub hose: Option<[f64; 2]>,
    /// Reservoir before the regulator [m3] and its compressor [kg/s].
    pub reservoir: Option<[f64; 2]>,

    /// Dead time of the regulator [s].
    pub dead_time: f64,
    /// Half the width of the regulator's play [Pa].
    pub play: f64,
    /// Largest rates of the outlet, up and down [Pa/s].
    pub rate_limit: Option<[f64; 2]>,
    /// Natural frequency [rad/s] and damping ratio [1] of the regulator.
    pub second_order: Option<[f64; 2]>,
    /// Delay of the 5/2 valve [s].
    pub switching_delay: f64,

    /// Stiffness of a Hertzian contact [N/m^1.5].
    pub hertz: Option<f64>,
    /// Runout and waviness.
    pub swings: Vec<Swing>,
    /// Surface off along extension [m].
    pub surface_offset: f64,

    /// Load cell: zero [N] and its drift [N/s].
    pub force_bias: [f64; 2],
    /// Load cell: gain [1].
    pub force_gain: f64,
    /// Load cell: time constant [s].
    pub force_lag: f64,
    /// Load cell: where it clips [N].
    pub force_limit: f64,
    /// Mass beyond the load cell [kg].
    pub crosstalk: f64,
    /// Position sensor: gain [1].
    pub stroke_gain: f64,
    /// Delay of the force's stamps [s].
    pub force_late: f64,

    /// Unlisted: ripple of the outlet, zero to peak [Pa] and frequency [Hz].
    pub ripple: Option<[f64; 2]>,
    /// Unlisted: a spot at which the piston sticks: extra dry friction [N], where [m], half-width [m].
    pub sticky_spot: Option<[f64; 3]>,
    /// Unlisted: damping in retraction alone, as of a check valve that sticks [N s/m].
    pub one_way_damping: f64,
    /// Unlisted: magnets along the stroke: force [N], pitch [m].
    pub detent: Option<[f64; 2]>,
    /// Unlisted: drop of the outlet with the flow drawn [Pa s/kg].
    pub outlet_droop: f64,
    /// Unlisted: a law of any kind.
    pub law: Option<Law>,
}

impl Default for Concealed {
    fn default() -> Self {
        Self {
            mass: None,
            dead_volume: None,
            supply_orifice: None,
            exhaust_orifice: None,
            gain: None,
            contact_stiffness: None,
            seals: None,
            spring: 0.0,
            axial_force: 0.0,
            cushion: None,
            cross_leak: 0.0,
            external_leak: 0.0,
            wall_conductance: None,
            hose: None,
            reservoir: None,
            dead_time: 0.0,
            play: 0.0,
            rate_limit: None,
            second_order: None,
            switching_delay: 0.0,
            hertz: None,
            swings: Vec::new(),
            surface_offset: 0.0,
            force_bias: [0.0; 2],
            force_gain: 1.0,
            force_lag: 0.0,
            force_limit: f64::INFINITY,
            crosstalk: 0.0,
            stroke_gain: 1.0,
            force_late: 0.0,
            ripple: None,
            sticky_spot: None,
            one_way_damping: 0.0,
            detent: None,
            outlet_droop: 0.0,
            law: None,
        }
    }
}
