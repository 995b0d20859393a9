//! The load on the piston over one step: of a bench, of a recorded rig, of the running slide of a cell.
//!
//! ```text
//! M x'' = F_device + A(t) + H + T - sum (c_i - u) N_i - R
//! p_i(t) = q_i + t q_i' + c_i (x - s(t)) - w(t),   p_i' = q_i' + c_i (x' - s'(t)) - w'(t)
//! ```
//!
//! x stroke [m], M moving mass [kg], A axial force: weight along extension, hand, what an arm that moves does to the slide [N], H hold to a measured motion [N],
//! T further terms [N], N_i contact force at touch i [N], p_i penetration there [m], q_i the same with the slide held at s [m], c_i share of the slide's motion
//! that goes into the part [1], u loss of it by links that swing [1], w deviation of the surface (`contact`) [m], R friction of the ball on the part along the
//! stroke [N]. Source paper, eq. (1), whose sign of g is that of a device that extends upwards.

use glam::DVec3;

use super::contact::ContactParameters;
use super::contact_friction::AxialFriction;
use super::cubic::Cubic;
use super::hold::{HELD_SWING, Hold};
use super::joint_deflections::DeflectedContact;
use super::terms::ForceTerms;
use crate::device::{FINE_SWING, Load, PistonMotion};

/// Pieces of a sub-step in which the largest force of a contact that turns back is sought.
const CULMINATION: u32 = 8;

/// A place where the tool touches the part, or is about to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Touch {
    /// Unit normal out of the part, in the world.
    pub normal: DVec3,
    /// Depth of the tool in the part at the start of the step, with the slide held; negative when apart [m].
    pub penetration: f64,
    /// Rate at which it goes deeper [m/s].
    pub rate: f64,
    /// Share of the slide's motion that goes into the part [1].
    pub share: f64,
    /// Whether the contact damps `rate` and the deviation's too, beside the slide's motion.
    pub damped: bool,
}

impl Touch {
    /// On a surface across the stroke, which meets the tool at the load's stroke.
    pub const AXIAL: Self = Self {
        normal: DVec3::NEG_Z,
        penetration: 0.0,
        rate: 0.0,
        share: 1.0,
        damped: true,
    };

    /// The same a time [s] later.
    #[must_use]
    pub(super) fn later(self, time: f64) -> Self {
        Self {
            penetration: self.penetration + time * self.rate,
            ..self
        }
    }
}

/// What of a load depends on time alone.
#[derive(Debug, Clone, Copy)]
pub struct LoadNow {
    /// Since the start of the step [s].
    time: f64,
    /// Axial force along extension [N].
    axial: f64,
    /// Stroke at which the slide is held for the touches' penetration [m], and its rate [m/s].
    stroke: f64,
    speed: f64,
    /// Deviation of the surface [m] and its rate [m/s].
    deviation: f64,
    deviation_rate: f64,
}

/// Load on a piston over a step.
#[derive(Debug, Clone, Copy)]
pub struct PistonLoad<'a> {
    /// Contact between tool and part.
    contact: &'a ContactParameters,
    /// Stiffness that a term adds to it [N/m].
    pub(super) added_stiffness: f64,
    /// Moving mass [kg].
    mass: f64,
    /// Where the tool touches the part, or is about to.
    pub(super) touches: &'a [Touch],
    /// Time at the start of the step [s].
    pub(super) start: f64,
    /// Stroke at which the slide is held for the touches' penetration: where a surface that moves meets the tool [m].
    pub stroke: Cubic,
    /// Axial force along extension [N].
    pub axial: Cubic,
    /// Loss of the contact force's share along the slide by the slide's turning [1].
    turned: f64,
    /// The motion to which the piston is held, if it is.
    pub(super) hold: Option<Hold>,
    /// Further forces.
    pub(super) terms: ForceTerms<'a>,
    /// Friction of the ball on the part.
    pub(super) friction: AxialFriction,
    /// Where the largest contact force so far is noted [N].
    pub peak: Option<&'a std::cell::Cell<f64>>,
}

impl<'a> PistonLoad<'a> {
    /// Touches from a time [s] on, of a device of a moving mass [kg] that is held at no stroke and under no force.
    pub fn new(
        contact: &'a ContactParameters,
        mass: f64,
        touches: &'a [Touch],
        start: f64,
    ) -> Self {
        Self {
            contact,
            added_stiffness: 0.0,
            mass,
            touches,
            start,
            stroke: Cubic::default(),
            axial: Cubic::default(),
            turned: 0.0,
            hold: None,
            terms: ForceTerms::default(),
            friction: AxialFriction::default(),
            peak: None,
        }
    }

    /// Where the touches are.
    pub fn touches(&self) -> &'a [Touch] {
        self.touches
    }

    /// Where a surface across the stroke stands [m].
    pub fn surface(&self) -> f64 {
        self.stroke.0[0] + self.contact.deviation(self.start).0
    }

    /// Penetration [m] and its rate [m/s] at a touch.
    fn penetration(touch: &Touch, now: &LoadNow, motion: PistonMotion) -> (f64, f64) {
        let moved = motion.stroke - now.stroke;
        let approach = touch.share * (motion.speed - now.speed);
        (
            touch.penetration + now.time * touch.rate + touch.share * moved - now.deviation,
            match touch.damped {
                true => touch.rate + approach - now.deviation_rate,
                false => approach,
            },
        )
    }

    /// Force at a touch [N].
    pub fn normal_force(&self, touch: &Touch, time: f64, motion: PistonMotion) -> f64 {
        self.touch_force(touch, &self.now(time), motion)
    }

    /// Force at a touch [N].
    fn touch_force(&self, touch: &Touch, now: &LoadNow, motion: PistonMotion) -> f64 {
        let (penetration, rate) = Self::penetration(touch, now, motion);
        match penetration > 0.0 {
            true => self.pushing(penetration, rate).max(0.0),
            false => 0.0,
        }
    }

    /// Force at a penetration [m] and its rate [m/s] as it holds while it pushes [N].
    fn pushing(&self, penetration: f64, rate: f64) -> f64 {
        self.contact.pushing(penetration, rate) + self.added_stiffness * penetration
    }

    /// Force of the tool on the workpiece, of all touches [N].
    pub fn contact_force(&self, time: f64, motion: PistonMotion) -> f64 {
        if self.touches.is_empty() {
            return 0.0;
        }
        let now = self.now(time);
        let forces = self.touches.iter();
        let forces = forces.map(|touch| self.touch_force(touch, &now, motion));
        forces.fold(0.0, |sum, force| sum + force)
    }

    /// The further forces [N].
    pub fn term_force(&self, time: f64, motion: PistonMotion) -> f64 {
        self.terms.force(self.start + time, motion)
    }

    /// Share of a touch's force along the stroke [1].
    pub(super) fn axial_share(&self, touch: &Touch) -> f64 {
        touch.share - self.turned
    }

    /// On links that swing.
    #[must_use]
    pub(super) fn deflected(mut self, by: &DeflectedContact) -> Self {
        for (stroke, more) in self.stroke.0.iter_mut().zip(by.surface) {
            *stroke += more;
        }
        self.turned = by.turned;
        self
    }

    /// The same from a time [s] on, with the touches as they are then.
    #[must_use]
    pub(super) fn later<'b>(self, time: f64, touches: &'b [Touch]) -> PistonLoad<'b>
    where
        'a: 'b,
    {
        PistonLoad {
            touches,
            start: self.start + time,
            stroke: self.stroke.from(time),
            axial: self.axial.from(time),
            hold: self.hold.map(|hold| Hold {
                stroke: hold.stroke.from(time),
                ..hold
            }),
            ..self
        }
    }

    /// Notes the contact force at a time and motion, if it is the largest so far.
    pub fn note_force(&self, time: f64, motion: PistonMotion) {
        if let Some(peak) = self.peak {
            peak.set(peak.get().max(self.contact_force(time, motion)));
        }
    }
}

impl Load for PistonLoad<'_> {
    type Now = LoadNow;

    #[inline]
    fn now(&self, time: f64) -> LoadNow {
        let (deviation, deviation_rate) = self.contact.deviation(self.start + time);
        LoadNow {
            time,
            axial: self.axial.at(time),
            stroke: self.stroke.at(time),
            speed: self.stroke.rate(time),
            deviation,
            deviation_rate,
        }
    }

    fn force(&self, now: &LoadNow, motion: PistonMotion, touching: bool) -> f64 {
        let mut force = now.axial;
        if let Some(hold) = &self.hold {
            force += hold.force(now.time, motion);
        }
        force += self.term_force(now.time, motion);
        if touching {
            force -= self.contact(now, motion, touching);
            force -= self.friction.at(motion.stroke);
        }
        force
    }

    fn contact(&self, now: &LoadNow, motion: PistonMotion, touching: bool) -> f64 {
        match self.touches {
            _ if !touching => 0.0,
            // As it holds while it pushes, so that the law is smooth over a sub-step.
            [touch] => {
                let (penetration, rate) = Self::penetration(touch, now, motion);
                self.axial_share(touch) * self.pushing(penetration, rate)
            }
            several => several
                .iter()
                .map(|touch| self.axial_share(touch) * self.touch_force(touch, now, motion))
                .sum(),
        }
    }

    fn touches(&self, now: &LoadNow, motion: PistonMotion) -> bool {
        self.touches.iter().any(|touch| {
            let (penetration, rate) = Self::penetration(touch, now, motion);
            penetration > 0.0 && self.pushing(penetration, rate) > 0.0
        })
    }

    fn note(&self, start: f64, length: f64, [from, to]: [PistonMotion; 2]) {
        if self.peak.is_none() || self.touches.is_empty() {
            return;
        }
        self.note_force(start + length, to);
        let (begins, ends) = (self.now(start), self.now(start + length));
        let turns = |touch: &Touch| {
            let before = Self::penetration(touch, &begins, from).1;
            before > 0.0 && Self::penetration(touch, &ends, to).1 < 0.0
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
        let own = self.contact.rate(self.mass);
        (own * own + self.added_stiffness.max(0.0) / self.mass).sqrt()
    }

    fn swing(&self) -> f64 {
        match self.hold {
            Some(_) => HELD_SWING,
            None => FINE_SWING,
        }
    }

    fn rate_within(&self, motion: PistonMotion, reach: f64, dt: f64) -> f64 {
        let nearest = self.contact.least_deviation();
        let moved = motion.stroke - self.stroke.0[0];
        let reach = reach + self.stroke.reach(dt);
        let meets = |touch: &Touch| {
            let deepest = touch.penetration + dt * touch.rate.abs();
            deepest + touch.share * moved + touch.share.abs() * reach > nearest
        };
        match self.touches.iter().any(meets) {
            true => self.rate(),
            false => 0.0,
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
