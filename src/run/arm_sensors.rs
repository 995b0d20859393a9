//! What drives and wrench sensor of a cell's arm read over a run, by the arm file that the cell names: computed after the run, from what truly moved and pressed.
//!
//! Joints, contact and slide are those of the simulation. Nothing here acts back on them: behind a servo as stiff as the simulated one, friction, ripple or
//! hoses at a joint change what its drive gives and not where the tool goes. What moves the tool (joint_friction, compliant_joint, joint_encoder_offset of the
//! cell's own effects) is in the motion already; dry friction that the cell has beyond its nominal one loads the drives here, too.

use glam::DVec3;

use crate::cell::Cell;
use crate::recorded_arm::ArmParameters;
use crate::recorded_arm::device_mount::DeviceMount;
use crate::recorded_arm::motion::Motion;
use crate::recorded_arm::outside::{Outside, OutsideWrench};
use crate::recorded_arm::simulate::{Channel, RigidCourse, all_bristles, readings};
use crate::recorded_arm::sliding_mass::SlidingMass;
use crate::recorded_arm::wrench::CHANNELS;
use crate::recording::schema::{
    self, DriveReading, JointSignal, drive_quantity, joint_quantity, wrench_quantity,
};
use crate::recording::{RecordedChannel, Recording, RecordingError, Unit};
use crate::scenario::arm_file::ArmFile;
use crate::sensing::noise::{Noise, Stream};

/// The recording with what drives and wrench sensor read; as it is where the cell names no arm file. `points` are where the tool touches, by sample [m].
pub(super) fn with_arm_sensors(
    cell: &Cell,
    recording: Recording,
    points: &[DVec3],
) -> Result<Recording, RecordingError> {
    let Some(file) = cell.setup.scenario.arm.recorded_arm.as_deref() else {
        return Ok(recording);
    };
    let arm = arm_of_run(cell, file);
    let mut motion = motion(&recording, arm.joints())?;
    motion.outside = Some(outside(cell, &arm, &recording, (&motion, points))?);
    let channels = channels(file, &arm);
    let (bristles, rigid) = (all_bristles(&arm, &motion), RigidCourse::of(&arm, &motion));
    let mut read = readings(&arm, &motion, &channels, &bristles, &rigid);
    add_noise(cell, file, (&channels, &mut read));
    let named = |(channel, values): (&Channel, Vec<f64>)| {
        let (quantity, unit) = quantity_of(&arm, *channel);
        RecordedChannel::new(quantity, unit, values)
    };
    let recorded = channels.iter().zip(read).map(named).collect();
    recording.with(recorded)
}

/// The arm as it is in a run of the cell: its encoders and transmissions are the cell's.
fn arm_of_run(cell: &Cell, file: &ArmFile) -> ArmParameters {
    // One recording, of no name.
    let mut arm = file.arm(&[String::new()]);
    let setup = &cell.setup;
    let [nominal, actual] = [&setup.scenario.nominal.cell, &setup.actual.cell];
    for (joint, drive) in arm.drives.iter_mut().enumerate() {
        drive.encoder_offset = 0.0;
        drive.compliance = 0.0;
        drive.coulomb += actual.joint_friction[joint] - nominal.joint_friction[joint];
    }
    arm
}

/// Sensors that the file has.
fn channels(file: &ArmFile, arm: &ArmParameters) -> Vec<Channel> {
    let drives = (0..arm.joints()).map(Channel::Drive);
    let wrench = arm.wrench.iter().flat_map(|_| 0..CHANNELS.len());
    let all = drives.chain(wrench.map(Channel::Wrench));
    all.filter(|channel| file.noise.of(*channel).is_some())
        .collect()
}

/// Name and unit of a reading.
fn quantity_of(arm: &ArmParameters, channel: Channel) -> (String, Unit) {
    match channel {
        Channel::Drive(joint) | Channel::Link(joint) => {
            let reading = match arm.drives[joint].logs_current {
                true => DriveReading::Current,
                false => DriveReading::Torque,
            };
            (drive_quantity(joint + 1, reading), reading.unit())
        }
        Channel::Wrench(k) => {
            let unit = if k < 3 {
                Unit::Newton
            } else {
                Unit::NewtonMetre
            };
            (wrench_quantity(CHANNELS[k]), unit)
        }
    }
}

/// Rate of change of samples [1/s].
fn rate(time: &[f64], values: &[f64]) -> Vec<f64> {
    let last = values.len() - 1;
    let at = |i: usize| {
        let (from, to) = (i.saturating_sub(1), (i + 1).min(last));
        match from < to {
            true => (values[to] - values[from]) / (time[to] - time[from]),
            false => 0.0,
        }
    };
    (0..values.len()).map(at).collect()
}

/// How the joints truly moved.
fn motion(recording: &Recording, joints: usize) -> Result<Motion, RecordingError> {
    let time = recording.time();
    let of = |signal: JointSignal| -> Result<Vec<Vec<f64>>, RecordingError> {
        let own = |joint| Ok(recording.values(&joint_quantity(joint, signal))?.to_vec());
        (1..=joints).map(own).collect()
    };
    let speed = of(JointSignal::Velocity)?;
    Ok(Motion {
        time: time.to_vec(),
        recording: 0,
        cut_off: f64::INFINITY,
        position: of(JointSignal::Position)?,
        acceleration: speed.iter().map(|own| rate(time, own)).collect(),
        speed,
        outside: None,
    })
}

/// What contact and slide did to the flange.
fn outside(
    cell: &Cell,
    arm: &ArmParameters,
    recording: &Recording,
    (motion, points): (&Motion, &[DVec3]),
) -> Result<Outside, RecordingError> {
    let actual = &cell.setup.actual;
    let device_mount = DeviceMount {
        arm,
        mount: &cell.setup.arm.chain,
        world_from_base: cell.setup.scenario.arm.world_from_base,
        slide: SlidingMass {
            mass: actual.device.moving_mass,
            centre: actual.mounting.moving_centre_of_mass,
        },
    };
    let [x, y, z] = [
        recording.values(schema::CONTACT_FORCE_X)?,
        recording.values(schema::CONTACT_FORCE_Y)?,
        recording.values(schema::CONTACT_FORCE_Z)?,
    ];
    let stroke = recording.values(schema::STROKE)?;
    let speed = recording.values(schema::STROKE_VELOCITY)?;
    let acceleration = rate(recording.time(), speed);
    let at = |(i, point): (usize, &DVec3)| {
        let of = |all: &[Vec<f64>]| all.iter().map(|own| own[i]).collect::<Vec<f64>>();
        let [q, qd, qdd] =
            [&motion.position, &motion.speed, &motion.acceleration].map(|all| of(all));
        let on_tool = -DVec3::new(x[i], y[i], z[i]);
        let slide = [stroke[i], speed[i], acceleration[i]];
        device_mount.pressed(&q, *point, on_tool) + device_mount.sliding([&q, &qd, &qdd], slide)
    };
    let wrench: Vec<OutsideWrench> = points.iter().enumerate().map(at).collect();
    Ok(Outside {
        drag: vec![OutsideWrench::ZERO; wrench.len()],
        wrench,
    })
}

/// Adds the noise of the sensors, by the scenario's seed.
fn add_noise(cell: &Cell, file: &ArmFile, (channels, read): (&[Channel], &mut [Vec<f64>])) {
    let seed = cell.setup.scenario.simulation.seed;
    let [mut drives, mut wrench] =
        [Stream::Drives, Stream::Wrench].map(|stream| Noise::new(seed, stream));
    for (channel, values) in channels.iter().zip(read) {
        let noise = match channel {
            Channel::Drive(_) | Channel::Link(_) => &mut drives,
            Channel::Wrench(_) => &mut wrench,
        };
        let deviation = file.noise.of(*channel).unwrap_or_default();
        for value in values {
            *value += deviation * noise.normal();
        }
    }
}
