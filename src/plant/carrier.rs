//! Loads on the piston of a recorded rig between two samples: weight and contact.
//!
//! ```text
//! M dv/dt = F_device + M g_a - c F_contact,   c the share of the contact's direction that lies along the stroke
//! ```

use super::contact::StepContact;
use super::contact_friction::AxialFriction;
use super::joint_deflections::DeflectedContact;
use super::terms::ForceTerms;
use crate::device::{Carrier, FINE_SWING, PistonMotion};

/// Largest sub-step times the fastest rate of a piston that is held to its measured motion [rad]: what it does then is compared roughly.
const HELD_SWING: f64 = 0.6;

/// Weight and contact over one step, in which the robot's surface follows a cubic.
#[derive(Debug, Clone, Copy)]
pub(super) struct ReplayCarrier<'a> {
    pub contact: StepContact<'a>,
    /// Whether there is a workpiece.
    pub present: bool,
    /// Weight along extension and its rate [N], [N/s].
    pub weight: [f64; 2],
    /// Time at the start of the step [s].
    pub start: f64,
    /// Surface over the step: coefficients of 1, t, t2, t3.
    pub surface: [f64; 4],
    /// Share of a motion along the stroke that goes into the surface [1].
    pub share: f64,
    /// Fastest rate of the contact [1/s].
    pub rate: f64,
    /// A burr on the edge and its rate: of a cell [m], [m/s]; none on a bench.
    pub burr: Option<[f64; 2]>,
    /// Whether the rate at which a burr comes up is damped too.
    pub burr_damped: bool,
    /// Motion of swinging links.
    pub deflected: DeflectedContact,
    /// The motion to which the piston is held, if it is.
    pub hold: Option<Hold>,
    /// Further forces.
    pub terms: ForceTerms<'a>,
    /// Friction of the ball on the part.
    pub friction: AxialFriction,
}

/// A motion over one step that the piston is held to.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hold {
    /// Stroke over the step: coefficients of 1, t, t2, t3.
    pub stroke: [f64; 4],
    /// Stiffness [N/m].
    pub stiffness: f64,
    /// Damping [N s/m].
    pub damping: f64,
}

impl Hold {
    fn force(&self, time: f64, motion: PistonMotion) -> f64 {
        let [a, b, c, d] = self.stroke;
        let stroke = a + time * (b + time * (c + time * d));
        let speed = b + time * (2.0 * c + 3.0 * time * d);
        self.stiffness * (stroke - motion.stroke) + self.damping * (speed - motion.speed)
    }
}

/// Cubic over a step of length `h` [s] from values and slopes at its ends.
pub(super) fn hermite(h: f64, values: [f64; 2], slopes: [f64; 2]) -> [f64; 4] {
    let rise = (values[1] - values[0]) / h;
    [
        values[0],
        slopes[0],
        (3.0 * rise - 2.0 * slopes[0] - slopes[1]) / h,
        (slopes[0] + slopes[1] - 2.0 * rise) / (h * h),
    ]
}

impl ReplayCarrier<'_> {
    fn penetration(&self, time: f64, motion: PistonMotion) -> (f64, f64) {
        let [a, b, c, d] = self.surface;
        let (mut deviation, mut rate) = self.contact.deviation(self.start + time);
        if let Some([height, rise]) = self.burr {
            deviation -= height + time * rise;
            // Of a ball that is met along the bisector its own motion is damped, whatever the shape that it meets.
            rate = if self.burr_damped { rate - rise } else { 0.0 };
        }
        let [lift, lifting, more] = self.deflected.surface;
        let surface = a + lift + time * (b + lifting + time * (c + more + time * d));
        let speed = b + lifting + time * (2.0 * (c + more) + 3.0 * time * d);
        (
            self.share * (motion.stroke - surface) - deviation,
            self.share * (motion.speed - speed) - rate,
        )
    }

    /// Share of the contact force along the stroke [1].
    pub fn axial_share(&self) -> f64 {
        self.share - self.deflected.turned
    }

    /// Weight along extension [N].
    pub fn weight_at(&self, time: f64) -> f64 {
        self.weight[0] + time * self.weight[1]
    }

    /// Adds to the stiffness of the contact [N/m] for a moving mass [kg].
    pub fn stiffen(&mut self, added: f64, mass: f64) {
        self.contact.added_stiffness = added;
        if self.present && added != 0.0 {
            self.rate = self.contact.rate(mass);
        }
    }

    /// The further forces [N].
    pub fn term_force(&self, time: f64, motion: PistonMotion) -> f64 {
        self.terms.force(self.start + time, motion)
    }

    /// Force that holds the piston to a measured motion [N].
    pub fn hold_force(&self, time: f64, motion: PistonMotion) -> f64 {
        self.hold.map_or(0.0, |hold| hold.force(time, motion))
    }

    /// Force of the tool on the workpiece [N].
    pub fn contact_force(&self, time: f64, motion: PistonMotion) -> f64 {
        if !self.present {
            return 0.0;
        }
        let (penetration, rate) = self.penetration(time, motion);
        self.contact.force(penetration, rate)
    }
}

impl Carrier for ReplayCarrier<'_> {
    const MOVES: bool = true;

    fn force(&self, time: f64, motion: PistonMotion, touching: bool) -> f64 {
        let mut force = self.weight_at(time);
        if let Some(hold) = &self.hold {
            force += hold.force(time, motion);
        }
        force += self.term_force(time, motion);
        if touching {
            let (penetration, rate) = self.penetration(time, motion);
            force -= self.axial_share() * self.contact.pushing(penetration, rate);
            force -= self.friction.at(motion.stroke);
        }
        force
    }

    fn touches(&self, time: f64, motion: PistonMotion) -> bool {
        if !self.present {
            return false;
        }
        let (penetration, rate) = self.penetration(time, motion);
        self.contact.pushes(penetration, rate)
    }

    fn rate(&self) -> f64 {
        self.rate
    }

    fn swing(&self) -> f64 {
        if self.hold.is_some() {
            HELD_SWING
        } else {
            FINE_SWING
        }
    }

    fn rate_within(&self, motion: PistonMotion, reach: f64, dt: f64) -> f64 {
        // What the cubic can move by in the step.
        let [a, b, c, d] = self.surface;
        let burr = self.burr.map_or(0.0, |[height, _]| height.abs());
        let nearest = a - burr / self.share + self.deflected.surface[0]
            - dt * self.deflected.surface[1].abs()
            + self.contact.least_deviation() / self.share
            - dt * (b.abs() + dt * (c.abs() + dt * d.abs()));
        if motion.stroke + reach < nearest {
            0.0
        } else {
            self.rate
        }
    }
}

impl ReplayCarrier<'_> {
    /// Begins later by a time [s].
    pub fn move_start(&mut self, time: f64) {
        let later = |[a, b, c, d]: [f64; 4]| {
            [
                a + time * (b + time * (c + time * d)),
                b + time * (2.0 * c + 3.0 * time * d),
                c + 3.0 * time * d,
                d,
            ]
        };
        self.surface = later(self.surface);
        if let Some(hold) = &mut self.hold {
            hold.stroke = later(hold.stroke);
        }
        self.weight[0] = self.weight_at(time);
        if let Some([height, rise]) = &mut self.burr {
            *height += time * *rise;
        }
        self.start += time;
    }
}
