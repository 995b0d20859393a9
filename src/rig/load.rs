//! The load on the piston of a bench rig: weight, hand, and what it pushes on.

use crate::plant::{Actual, ContactParameters, Cubic, PistonLoad, PlantParameters, Touch};
use crate::scenario::bench::{BenchScenario, LoadScenario};

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

/// What a swing leaves of a value.
fn less(value: f64, swing: [f64; 3]) -> Cubic {
    Cubic([value - swing[0], -swing[1], -0.5 * swing[2], 0.0])
}

/// Load on the piston from `time` [s] on, over a step in which the surface, if there is one, stands at a stroke [m] and a force from outside, weight apart, acts
/// along extension [N].
pub fn load_under(
    actual: &Actual<PlantParameters>,
    time: f64,
    surface: Option<Cubic>,
    outside: Cubic,
) -> PistonLoad<'_> {
    /// Nothing to push on.
    const FREE: ContactParameters = ContactParameters::linear(0.0, 0.0);
    let mass = actual.device.moving_mass;
    let mut load = match surface {
        None => {
            let mut load = PistonLoad::new(&FREE, mass, &[], time);
            load.stroke.0[0] = f64::INFINITY;
            load
        }
        Some(surface) => {
            let mut load = PistonLoad::new(&actual.contact, mass, &[Touch::AXIAL], time);
            load.stroke = surface;
            load
        }
    };
    load.axial = outside;
    load.axial.0[0] += mass * actual.gravity_along_extension;
    load
}

/// Load on the piston from `time` [s] on, over a step in which the motions of surface and hand are taken as parabolas.
pub fn load_at<'a>(
    scenario: &BenchScenario,
    actual: &'a Actual<PlantParameters>,
    time: f64,
) -> PistonLoad<'a> {
    let surface = match &scenario.load {
        LoadScenario::Free => None,
        LoadScenario::Contact { position, motion } => {
            let moved = motion.map_or([0.0; 3], |m| {
                swing(m.peak_to_peak, m.frequency, m.start, time)
            });
            Some(less(*position, moved))
        }
    };
    let hand = scenario.hand.map_or([0.0; 3], |hand| {
        swing(hand.peak_force, hand.frequency, hand.start, time)
    });
    load_under(actual, time, surface, less(0.0, hand))
}
