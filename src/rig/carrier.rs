//! Loads on the piston of a bench rig: weight, load, hand.
//!
//! ```text
//! M dv/dt = F_device + M g_a - F_load - F_hand
//! ```
//!
//! M moving mass [kg], g_a component of gravity along extension [m/s2], F_load push-only contact on the load's surface [N].
//! Source paper, eq. (1), whose sign of g is that of a device that extends upwards.

use crate::device::{Carrier, PistonMotion};
use crate::plant::{ForceTerms, Moment, PlantParameters, Port, StepContact};
use crate::scenario::bench::{BenchScenario, LoadScenario};

/// Load and other forces over one step, during which the surface's and the hand's trajectories are taken as parabolas.
#[derive(Debug, Clone, Copy)]
pub struct BenchCarrier<'a> {
    mass: f64,
    weight: f64,
    contact: Option<StepContact<'a>>,
    /// Start of the step [s].
    start: f64,
    /// The surface: position [m], speed [m/s], acceleration [m/s2] at the start of the step.
    surface: [f64; 3],
    /// The hand's force [N] and its rate [N/s] and curvature [N/s2].
    hand: [f64; 3],
    /// Further forces.
    terms: ForceTerms<'a>,
}

/// Value, first and second derivative of peak/2 (1 - cos(2 pi frequency (t - start))).
fn swing(peak: f64, frequency: f64, start: f64, time: f64) -> [f64; 3] {
    if time < start {
        return [0.0; 3];
    }
    let rate = std::f64::consts::TAU * frequency;
    let (sine, cosine) = (rate * (time - start)).sin_cos();
    [
        0.5 * peak * (1.0 - cosine),
        0.5 * peak * rate * sine,
        0.5 * peak * rate * rate * cosine,
    ]
}

fn parabola(trajectory: [f64; 3], time: f64) -> f64 {
    trajectory[0] + time * (trajectory[1] + 0.5 * time * trajectory[2])
}

impl<'a> BenchCarrier<'a> {
    /// Loads on the piston from `time` [s] on.
    pub fn at(scenario: &'a BenchScenario, time: f64) -> Self {
        let mass = scenario.device.parameters.moving_mass;
        let (contact, surface) = match &scenario.load {
            LoadScenario::Free => (None, [f64::INFINITY, 0.0, 0.0]),
            LoadScenario::Contact {
                position,
                contact,
                motion,
            } => {
                let moved = motion.map_or([0.0; 3], |m| {
                    swing(m.peak_to_peak, m.frequency, m.start, time)
                });
                let contact = StepContact::plain(contact);
                (Some(contact), [position - moved[0], -moved[1], -moved[2]])
            }
        };
        let hand = scenario.hand.map_or([0.0; 3], |hand| {
            swing(hand.peak_force, hand.frequency, hand.start, time)
        });
        Self {
            mass,
            weight: mass * scenario.gravity_along_extension,
            contact,
            start: time,
            surface,
            hand,
            terms: ForceTerms::default(),
        }
    }

    /// The same with the further forces of a description, and where it puts the surface, over a step [s] that starts at a moment.
    #[must_use]
    pub fn with_terms(mut self, plant: &'a PlantParameters, moment: Moment, step: f64) -> Self {
        self.surface[0] += plant.term(Port::Surface, &moment.ahead(0.5 * step));
        if let Some(contact) = &mut self.contact {
            contact.added_stiffness = plant.term(Port::ContactStiffness, &moment);
        }
        self.terms = ForceTerms::over(plant, &moment);
        self
    }

    /// The further forces [N].
    pub fn term_force(&self, time: f64, motion: PistonMotion) -> f64 {
        self.terms.force(self.start + time, motion)
    }

    /// Where the surface stands along the stroke [m].
    pub fn surface(&self) -> f64 {
        let deviation = self.contact.map_or(0.0, |c| c.deviation(self.start).0);
        self.surface[0] + deviation
    }

    /// Force of the hand against extension [N].
    pub fn hand_force(&self) -> f64 {
        self.hand[0]
    }

    fn penetration(
        &self,
        contact: &StepContact<'_>,
        time: f64,
        motion: PistonMotion,
    ) -> (f64, f64) {
        let (deviation, rate) = contact.deviation(self.start + time);
        let surface_speed = self.surface[1] + time * self.surface[2];
        (
            motion.stroke - (parabola(self.surface, time) + deviation),
            motion.speed - (surface_speed + rate),
        )
    }

    /// Force of the tool on the load [N].
    pub fn contact_force(&self, time: f64, motion: PistonMotion) -> f64 {
        self.contact.map_or(0.0, |contact| {
            let (penetration, rate) = self.penetration(&contact, time, motion);
            contact.force(penetration, rate)
        })
    }
}

impl Carrier for BenchCarrier<'_> {
    const MOVES: bool = true;

    fn force(&self, time: f64, motion: PistonMotion, touching: bool) -> f64 {
        let load = match &self.contact {
            Some(contact) if touching => {
                let (penetration, rate) = self.penetration(contact, time, motion);
                contact.pushing(penetration, rate)
            }
            _ => 0.0,
        };
        self.weight - load - parabola(self.hand, time) + self.term_force(time, motion)
    }

    fn touches(&self, time: f64, motion: PistonMotion) -> bool {
        self.contact.is_some_and(|contact| {
            let (penetration, rate) = self.penetration(&contact, time, motion);
            contact.pushes(penetration, rate)
        })
    }

    fn rate(&self) -> f64 {
        self.contact.map_or(0.0, |contact| contact.rate(self.mass))
    }

    fn rate_within(&self, motion: PistonMotion, reach: f64, dt: f64) -> f64 {
        let Some(contact) = &self.contact else {
            return 0.0;
        };
        let [surface, speed, acceleration] = self.surface;
        let nearest = surface + contact.least_deviation()
            - dt * (speed.abs() + 0.5 * dt * acceleration.abs());
        if motion.stroke + reach < nearest {
            0.0
        } else {
            contact.rate(self.mass)
        }
    }
}
