//! What happens in a rig, and the channels in which it is measured.

/// A measured channel of a rig.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Channel {
    /// Outlet of the regulator [Pa gauge].
    RegulatorPressure,
    /// Stroke from the retracted end [m].
    Stroke,
    /// Load cell, pushing positive [N].
    Force,
    /// Acceleration along extension [m/s2].
    Acceleration,
}

/// All channels, in the order of a file's columns.
pub const CHANNELS: [Channel; 4] = [
    Channel::RegulatorPressure,
    Channel::Stroke,
    Channel::Force,
    Channel::Acceleration,
];

/// True trajectory of a rig, one value per sample time.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Trajectory {
    /// Outlet of the regulator [Pa gauge].
    pub outlet: Vec<f64>,
    /// Stroke [m].
    pub stroke: Vec<f64>,
    /// Speed of extension [m/s].
    pub speed: Vec<f64>,
    /// Acceleration along extension [m/s2].
    pub acceleration: Vec<f64>,
    /// Contact force [N].
    pub contact_force: Vec<f64>,
    /// Pressures of chambers 1 and 2 [Pa absolute].
    pub pressures: [Vec<f64>; 2],
    /// Air that came in over the last step [kg/s].
    pub mass_flow: Vec<f64>,
    /// Force that held the piston to a measured motion [N]; none where nothing did.
    pub hold_force: Vec<f64>,
    /// Share of the contact force along the stroke [1].
    pub share: Vec<f64>,
    /// What a late or slow load cell feels between the samples; empty of another, and of a piston that is held to a measured motion.
    pub load_cell: LoadCellSignal,
}

/// What a load cell feels, at the samples and between them: one that is late or slow reads what was before its sample.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct LoadCellSignal {
    /// Times [s].
    pub time: Vec<f64>,
    /// Contact force [N].
    pub contact_force: Vec<f64>,
    /// Share of it along the stroke [1].
    pub share: Vec<f64>,
    /// Acceleration along extension [m/s2].
    pub acceleration: Vec<f64>,
    /// Places of the samples among them.
    pub samples: Vec<usize>,
}

impl LoadCellSignal {
    /// Whether it was simulated.
    pub fn is_known(&self) -> bool {
        !self.samples.is_empty()
    }
}

impl Trajectory {
    /// Nothing happens, at every sample.
    pub(super) fn still(count: usize, atmosphere: f64) -> Self {
        let nothing = vec![0.0; count];
        Self {
            outlet: nothing.clone(),
            stroke: nothing.clone(),
            speed: nothing.clone(),
            acceleration: nothing.clone(),
            contact_force: nothing.clone(),
            pressures: [vec![atmosphere; count], vec![atmosphere; count]],
            mass_flow: nothing.clone(),
            hold_force: nothing.clone(),
            share: vec![1.0; count],
            load_cell: LoadCellSignal::default(),
        }
    }
}
