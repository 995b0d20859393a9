//! Sizes of effects that are asked for by name alone: beyond the tolerances that an arm usually has, within what is found in practice.

use super::ArmParameters;
use super::vocabulary::ArmEffectName;

/// Share of a drive's rated torque that is a clear torque at its joint [1].
const CLEAR: f64 = 0.05;
/// Rated torque where a URDF gives none [N m].
const RATED: f64 = 100.0;
/// Channel of the wrench sensor along its z.
const FORCE_Z: usize = 2;

/// Numbers of an effect at their usual size, in the order of the vocabulary [SI]. `joint` is the place in the chain of the joint or link that it is of.
#[must_use]
pub fn usual(effect: &ArmEffectName, arm: &ArmParameters, joint: usize) -> Vec<f64> {
    if effect.subsystem == "wrench_sensor" {
        return of_wrench(effect, arm);
    }
    let drive = &arm.drives[joint];
    let rated = arm.chain.joints[joint].effort;
    let rated = if rated.is_finite() { rated } else { RATED };
    let clear = CLEAR * rated;
    let dry = drive.coulomb.max(clear);
    match effect.name {
        "joint_friction" => vec![drive.coulomb + clear, drive.viscous + clear],
        "stribeck_joint_friction" => vec![dry, drive.viscous, 1.6 * dry, 0.05],
        "load_dependent_joint_friction" => vec![0.15],
        "motor_inertia_error" => vec![2.0 * drive.motor_inertia + 0.02 * rated],
        "drive_gain_error" => vec![1.3 / drive.inverse_gain],
        "joint_torque_offset" => vec![clear],
        "gear_ripple" => vec![0.4 * clear, 100.0],
        "compliant_joint" => vec![100.0 * rated],
        "joint_encoder_offset" => vec![2e-3],
        "joint_warm_up" => vec![0.5, 5.0],
        "payload" => vec![3.0, 0.0, 0.0, 0.05],
        "link_mass_error" => vec![1.6 * arm.chain.joints[joint].body.mass],
        "base_tilt" => vec![0.02, 0.01],
        "dress_pack_spring" => vec![clear, 0.0],
        "outside_push" => vec![3.0, 5.0, 40.0],
        _ => vec![0.02],
    }
}

fn of_wrench(effect: &ArmEffectName, arm: &ArmParameters) -> Vec<f64> {
    let Some(sensor) = &arm.wrench else {
        return vec![0.0; effect.numbers.len()];
    };
    match effect.name {
        "wrench_zero" => {
            let moved = [6.0, -4.0, 8.0, 0.3, 0.2, -0.1];
            sensor
                .zero
                .iter()
                .zip(moved)
                .map(|(z, by)| z + by)
                .collect()
        }
        "tool_weight_error" => {
            let centre = sensor.tool_centre;
            vec![1.25 * sensor.tool_mass, centre.x, centre.y, centre.z]
        }
        "wrench_frame_turned" => vec![0.1],
        "wrench_gain_error" => vec![1.15 * sensor.gain[FORCE_Z]],
        "wrench_crosstalk" => vec![0.08],
        _ => vec![0.5],
    }
}
