//! The device's slide over one step of the cell, its contact included: the device's own integration, loaded by an arm that keeps its motion meanwhile.
//!
//! ```text
//! M x'' = F_device + M a_0 - sum c_i N_i
//! ```
//!
//! as `plant::PistonLoad` has it, a_0 being what gravity, the arm's own acceleration and friction did to the slide over the step before [m/s2]. This is of the
//! second order in the step, and the slide meets the part, its stops and its seals where they are (`device::integrate`).

use glam::DVec3;

use crate::device::PistonMotion;
use crate::plant::{PistonLoad, RunningDevice};

/// Share of its motion below which a slide says nothing of the force at a touch beside it [1].
const LEAST_SHARE: f64 = 1e-6;

/// Motion of the slide over a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlideStep {
    /// Where it ended, as far as it knows.
    pub motion: PistonMotion,
    /// Mean force of the device on it along extension [N].
    pub device: f64,
    /// Mean force of the part on it against extension [N].
    pub load: f64,
}

/// Advances device and slide by `dt` [s] at a set pressure [Pa gauge], in at least so many sub-steps; puts into `pressed` the mean force [N] along the normal
/// of each touch.
pub fn advance(
    device: &mut RunningDevice<'_>,
    carried: &PistonLoad<'_>,
    set_pressure: f64,
    (dt, substeps): (f64, usize),
    pressed: &mut Vec<(DVec3, f64)>,
) -> SlideStep {
    let start = device.motion;
    let load = device.advance::<true>(carried, set_pressure, (dt, substeps)) / dt;
    let motion = device.motion;
    let mass = device.device.parameters().moving_mass;
    share_out(carried, [start, motion], dt, load, pressed);
    SlideStep {
        motion,
        device: mass * (motion.speed - start.speed) / dt + load - carried.axial.at(0.0),
        load,
    }
}

/// Shares a load along the slide [N] out among the touches, by their forces at both ends of the step.
fn share_out(
    carried: &PistonLoad<'_>,
    [start, end]: [PistonMotion; 2],
    dt: f64,
    load: f64,
    pressed: &mut Vec<(DVec3, f64)>,
) {
    pressed.clear();
    if let [touch] = carried.touches()
        && touch.share.abs() > LEAST_SHARE
    {
        pressed.push((touch.normal, load / touch.share));
        return;
    }
    let forces = carried.touches().iter().map(|touch| {
        let force = carried.normal_force(touch, 0.0, start) + carried.normal_force(touch, dt, end);
        (touch.normal, 0.5 * force)
    });
    pressed.extend(forces);
    let pairs = carried.touches().iter().zip(pressed.iter());
    let along: f64 = pairs.map(|(touch, (_, force))| touch.share * force).sum();
    if along > 0.0 {
        for (_, force) in pressed {
            *force *= load / along;
        }
    }
}

/// Mean force of the part against a slide that is clamped [N], by Simpson's rule over what the arm does in a step.
pub fn mean_load(
    carried: &PistonLoad<'_>,
    motion: PistonMotion,
    dt: f64,
    pressed: &mut Vec<(DVec3, f64)>,
) -> f64 {
    let held = PistonMotion {
        speed: 0.0,
        ..motion
    };
    for share in [0.0, 0.5, 1.0] {
        carried.note_force(share * dt, held);
    }
    pressed.clear();
    pressed.extend(carried.touches().iter().map(|touch| {
        let at = |share: f64| carried.normal_force(touch, share * dt, held);
        (touch.normal, (at(0.0) + 4.0 * at(0.5) + at(1.0)) / 6.0)
    }));
    let pairs = carried.touches().iter().zip(pressed.iter());
    pairs.map(|(touch, (_, force))| touch.share * force).sum()
}
