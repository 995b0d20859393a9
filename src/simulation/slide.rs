//! The device's slide over one step of the cell, its contact included: the device's own integration, carried by an arm that keeps its motion meanwhile.
//!
//! ```text
//! M x'' = F_device + M a_0 - sum c_i N_i,   p_i(t) = p_i + t p_i' + c_i (x - x_0)
//! ```
//!
//! x stroke [m], M moving mass [kg], a_0 what gravity, the arm's own acceleration and friction did to the slide over the step before [m/s2], N_i contact force
//! and p_i penetration of touch i [m], p_i' its rate with the slide held [m/s], c_i share of the slide's motion that goes into the part [1]. Both are of the
//! second order in the step, and the slide meets the part, its stops and its seals where they are (`device::integrate`).

use glam::DVec3;

use super::contact::Touch;
use crate::device::{Carrier, Device, DeviceState, PistonMotion};
use crate::plant::{ForceTerms, StepContact};

/// Share of its motion below which a slide says nothing of the force at a touch beside it [1].
const LEAST_SHARE: f64 = 1e-6;
/// Pieces of a sub-step in which the largest force of a contact that turns back is sought.
const CULMINATION: u32 = 8;

/// Loads on the slide over a step from outside the device.
#[derive(Debug, Clone, Copy)]
pub struct SlideCarrier<'a> {
    /// Law between tool and part.
    pub contact: StepContact<'a>,
    /// Where the ball touches at the start of the step.
    pub touches: &'a [Touch],
    /// Time then [s].
    pub start: f64,
    /// Stroke then [m].
    pub stroke: f64,
    /// Force of gravity, arm and friction along extension [N].
    pub weight: f64,
    /// Fastest rate of the moving mass on the contact [1/s].
    pub rate: f64,
    /// Distance of the surface beyond where the part has it, along extension [m].
    pub beyond: f64,
    /// Further forces on the slide.
    pub terms: ForceTerms<'a>,
    /// Where the largest contact force so far is noted [N].
    pub peak: Option<&'a std::cell::Cell<f64>>,
}

impl SlideCarrier<'_> {
    /// Penetration [m] and its rate [m/s] at a touch.
    fn penetration(&self, touch: &Touch, time: f64, motion: PistonMotion) -> (f64, f64) {
        let (deviation, rate) = self.contact.deviation(self.start + time);
        let moved = motion.stroke - self.stroke - self.beyond;
        (
            touch.penetration + time * touch.rate + touch.share * moved - deviation,
            touch.rate + touch.share * motion.speed - rate,
        )
    }

    /// Force at a touch [N].
    pub fn normal_force(&self, touch: &Touch, time: f64, motion: PistonMotion) -> f64 {
        let (penetration, rate) = self.penetration(touch, time, motion);
        self.contact.force(penetration, rate)
    }

    /// Notes the contact force at a time and motion.
    fn note_force(&self, time: f64, motion: PistonMotion) {
        let Some(peak) = self.peak else {
            return;
        };
        let forces = self.touches.iter();
        let force = forces.map(|touch| self.normal_force(touch, time, motion));
        peak.set(peak.get().max(force.sum()));
    }
}

impl Carrier for SlideCarrier<'_> {
    const MOVES: bool = true;
    const LOADED: bool = true;

    fn force(&self, time: f64, motion: PistonMotion, touching: bool) -> f64 {
        let further = self.terms.force(self.start + time, motion);
        self.weight + further - self.load(time, motion, touching)
    }

    fn load(&self, time: f64, motion: PistonMotion, touching: bool) -> f64 {
        match self.touches {
            _ if !touching => 0.0,
            // As it holds while it pushes, so that the law is smooth over a sub-step.
            [touch] => {
                let (penetration, rate) = self.penetration(touch, time, motion);
                touch.share * self.contact.pushing(penetration, rate)
            }
            several => several
                .iter()
                .map(|touch| touch.share * self.normal_force(touch, time, motion))
                .sum(),
        }
    }

    fn touches(&self, time: f64, motion: PistonMotion) -> bool {
        self.touches.iter().any(|touch| {
            let (penetration, rate) = self.penetration(touch, time, motion);
            self.contact.pushes(penetration, rate)
        })
    }

    fn note(&self, start: f64, length: f64, [from, to]: [PistonMotion; 2]) {
        if self.touches.is_empty() {
            return;
        }
        self.note_force(start + length, to);
        let turns = |touch: &Touch| {
            let before = self.penetration(touch, start, from).1;
            before > 0.0 && self.penetration(touch, start + length, to).1 < 0.0
        };
        if self.touches.iter().any(turns) {
            // The force culminates in between.
            for place in 1..CULMINATION {
                let share = f64::from(place) / f64::from(CULMINATION);
                let between = between(from, to, length, share);
                self.note_force(start + share * length, between);
            }
        }
    }

    fn rate(&self) -> f64 {
        self.rate
    }

    fn rate_within(&self, motion: PistonMotion, reach: f64, dt: f64) -> f64 {
        let nearest = self.contact.least_deviation();
        let meets = |touch: &Touch| {
            let moved = (motion.stroke - self.stroke + reach).abs() + self.beyond.abs();
            let deepest = touch.penetration + dt * touch.rate.abs() + touch.share.abs() * moved;
            deepest > nearest
        };
        if self.touches.iter().any(meets) {
            self.rate
        } else {
            0.0
        }
    }
}

/// Motion at a share of a sub-step of a length [s], of the cubic through both ends.
fn between(from: PistonMotion, to: PistonMotion, length: f64, share: f64) -> PistonMotion {
    let rest = 1.0 - share;
    let travel = to.stroke - from.stroke;
    let [early, late] = [from, to].map(|end| end.speed * length - travel);
    let bend = rest * early - share * late;
    PistonMotion {
        stroke: from.stroke + share * (travel + rest * bend),
        speed: (travel + (rest - share) * bend - share * rest * (early + late)) / length,
    }
}

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
    device: &Device,
    state: &mut DeviceState,
    carrier: &SlideCarrier<'_>,
    (set_pressure, speed): (f64, f64),
    (dt, substeps): (f64, usize),
    pressed: &mut Vec<(DVec3, f64)>,
) -> SlideStep {
    let start = PistonMotion {
        stroke: carrier.stroke,
        speed,
    };
    let mut motion = start;
    let load = device.advance_carried(state, &mut motion, set_pressure, carrier, dt, substeps) / dt;
    let mass = device.parameters().moving_mass;
    share_out(carrier, [start, motion], dt, load, pressed);
    SlideStep {
        motion,
        device: mass * (motion.speed - speed) / dt + load - carrier.weight,
        load,
    }
}

/// Shares a load along the slide [N] out among the touches, by their forces at both ends of the step.
fn share_out(
    carrier: &SlideCarrier<'_>,
    [start, end]: [PistonMotion; 2],
    dt: f64,
    load: f64,
    pressed: &mut Vec<(DVec3, f64)>,
) {
    pressed.clear();
    if let [touch] = carrier.touches
        && touch.share.abs() > LEAST_SHARE
    {
        pressed.push((touch.normal, load / touch.share));
        return;
    }
    let forces = carrier.touches.iter().map(|touch| {
        let force = carrier.normal_force(touch, 0.0, start) + carrier.normal_force(touch, dt, end);
        (touch.normal, 0.5 * force)
    });
    pressed.extend(forces);
    let pairs = carrier.touches.iter().zip(pressed.iter());
    let along: f64 = pairs.map(|(touch, (_, force))| touch.share * force).sum();
    if along > 0.0 {
        for (_, force) in pressed {
            *force *= load / along;
        }
    }
}

/// Mean force of the part against a slide that is clamped [N], by Simpson's rule over what the arm does in a step.
pub fn mean_load(
    carrier: &SlideCarrier<'_>,
    motion: PistonMotion,
    dt: f64,
    pressed: &mut Vec<(DVec3, f64)>,
) -> f64 {
    let held = PistonMotion {
        speed: 0.0,
        ..motion
    };
    for share in [0.0, 0.5, 1.0] {
        carrier.note_force(share * dt, held);
    }
    pressed.clear();
    pressed.extend(carrier.touches.iter().map(|touch| {
        let at = |share: f64| carrier.normal_force(touch, share * dt, held);
        (touch.normal, (at(0.0) + 4.0 * at(0.5) + at(1.0)) / 6.0)
    }));
    let pairs = carrier.touches.iter().zip(pressed.iter());
    pairs.map(|(touch, (_, force))| touch.share * force).sum()
}
