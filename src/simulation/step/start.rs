//! The parts of a simulation as they stand at the start of a job.

use glamx::DPose3;

use crate::arm::chain::MAX_JOINTS;
use crate::arm::dynamics::{inverse_dynamics, mass_matrix};
use crate::cell::Cell;
use crate::collision::ClearanceWatch;
use crate::control::servo::{Servo, ServoParameters};
use crate::control::transmission::Motor;
use crate::physics::command_lag::CommandLag;

/// Inertia of each of the arm's axes about itself, the others held, with the slide where it starts [kg m2].
pub(super) fn inertias(cell: &Cell, positions: &[f64]) -> Vec<f64> {
    let count = positions.len();
    let mut masses = nalgebra::DMatrix::zeros(count, count);
    mass_matrix(&cell.setup.arm_with_slide, positions, &mut masses);
    (0..count - 1).map(|i| masses[(i, i)]).collect()
}

/// Response of each axis's drive to its command, where a bandwidth of the drives is finite [Hz].
pub(super) fn lags(bandwidth: f64, positions: &[f64]) -> Vec<CommandLag> {
    let lag = |start: &f64| CommandLag::at_rest(bandwidth, *start);
    match bandwidth.is_finite() {
        true => positions.iter().map(lag).collect(),
        false => Vec::new(),
    }
}

/// The servo of all axes, each about its own inertia [kg m2].
pub(super) fn servo(cell: &Cell, inertias: &[f64]) -> Servo {
    let parameters = &cell.setup.scenario.arm.servo;
    Servo::new(
        &cell.setup.arm.chain,
        &cell.setup.actual.cell.joint_friction,
        inertias,
        &ServoParameters {
            natural_frequency: parameters.natural_frequency * std::f64::consts::TAU,
            damping_ratio: parameters.damping_ratio,
            integral_time: parameters.integral_time,
        },
    )
}

/// A watch over what must not meet, the part where it really is.
pub(super) fn clearance(cell: &Cell, positions: &[f64]) -> ClearanceWatch {
    // Where effects have put the part, its tilt apart: it is none about the middle of the edge.
    let aside = cell
        .setup
        .actual
        .cell
        .aside(&cell.middle, cell.middle.point);
    let part = DPose3::from_translation(aside) * cell.setup.part.world_from_part;
    let model = cell.setup.collision.with_part_at(part);
    ClearanceWatch::new(model, &to_array(positions))
}

/// Positions of as many joints as there are, and zeros.
pub(super) fn to_array(positions: &[f64]) -> [f64; MAX_JOINTS] {
    let mut array = [0.0; MAX_JOINTS];
    array[..positions.len()].copy_from_slice(positions);
    array
}

/// Share of a joint's own inertia that its rotor has, seen from the joint [1]: gears of robots make it of the same order.
const ROTOR_SHARE: f64 = 0.5;

/// Motors at rest where the plan starts; moves the links of `positions` to where they hang on them.
pub(super) fn motors(cell: &Cell, inertias: &[f64], positions: &mut [f64]) -> Vec<Option<Motor>> {
    let still = vec![0.0; positions.len()];
    let mut torques = still.clone();
    let scenario = &cell.setup.scenario;
    inverse_dynamics(
        &cell.setup.arm_with_slide,
        scenario.arm.world_from_base.rotation,
        scenario.simulation.gravity,
        positions,
        &still,
        &still,
        &mut torques,
    );
    let motor = |axis: usize| {
        let inertia = ROTOR_SHARE * inertias[axis];
        let spring = cell.setup.actual.cell.transmission(axis)?;
        let (motor, link) = Motor::at_rest(spring, inertia, positions[axis], torques[axis]);
        positions[axis] = link;
        Some(motor)
    };
    (0..inertias.len()).map(motor).collect()
}
