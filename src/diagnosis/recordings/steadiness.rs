//! Whether a motion can be predicted at all: a tool that bounces on a surface that shakes goes its own way after some impacts, whatever is known of it.
//!
//! ```text
//! s = max over channels of sqrt(mean over samples of min(|y((1 + e) p) - y(p)| / n, 1)^2),   e = 10^-5
//! ```
//!
//! y readings, p set pressure, n standard deviation of a channel's noise. A hundred-thousandth is less than any description is true to. In motions that follow
//! from what is done s is some hundredths, and the more of it the longer a mass moves freely; where impacts amplify each other's differences it comes to
//! tenths within ten of them (sensitive dependence on initial conditions of an impacting oscillator: Holmes, Journal of Sound and Vibration 84, 1982).

use crate::plant::{CHANNELS, Channel, PlantInputs, PlantParameters, PlantTrajectory, simulate};
use crate::stats::mean;

/// e [1].
const CHANGE: f64 = 1e-5;
/// What s comes to at most where a motion can be predicted [1].
pub const STEADY: f64 = 0.15;
/// Change of the stroke from which it goes its own way, in standard deviations of its noise: ten times as much is a ten-thousandth's [1].
const OWN_WAY: f64 = 0.2;
/// Change from which it has begun to, over [`GROWS`]: by what a model is off, more than e, it is on its own way earlier than by e [1].
const BEGINS: f64 = 0.02;
/// Time over which a change is looked at [s].
const GROWS: f64 = 0.1;
/// Between two stretches of which no more is between them they are one [s].
const APART: f64 = 0.2;
/// Contacts in a stretch, and in as long before it begins, that make it one of bouncing.
const BOUNCES: usize = 3;
/// Time before a stretch in which the bouncing began [s].
const BEGAN: f64 = 1.0;
/// Force of a contact, in standard deviations of its noise [1].
const TOUCHES: f64 = 10.0;

/// What a change of the set pressure by e does to the readings, in standard deviations of their noise, by channel; infinite noise where there is no sensor.
fn changes(
    plant: &PlantParameters,
    inputs: &PlantInputs,
    own: &PlantTrajectory,
    noise: [f64; CHANNELS.len()],
) -> [Vec<f64>; CHANNELS.len()] {
    let mut other = inputs.clone();
    for pressure in &mut other.set_pressure {
        *pressure *= 1.0 + CHANGE;
    }
    let there = simulate(plant, &other);
    std::array::from_fn(|channel| {
        let pairs = own.readings[channel].iter().zip(&there.readings[channel]);
        pairs
            .map(|(own, there)| (there - own).abs() / noise[channel])
            .collect()
    })
}

/// s of a device under inputs, with what it does there and the sensors' noise, infinite where there is no sensor [1].
#[must_use]
pub fn sensitivity(
    plant: &PlantParameters,
    inputs: &PlantInputs,
    own: &PlantTrajectory,
    noise: [f64; CHANNELS.len()],
) -> f64 {
    let of_channel = |changes: &Vec<f64>| {
        let known = changes.iter().filter(|change| change.is_finite());
        let squares: Vec<f64> = known.map(|change| change.min(1.0).powi(2)).collect();
        mean(&squares).sqrt()
    };
    let all = changes(plant, inputs, own, noise);
    all.iter().map(of_channel).fold(0.0, f64::max)
}

/// Stretches of a recording [s] in which the tool bounces and no model of it can say where it is: there the nominal one goes its own way, and the force says that
/// the tool touched and left the part again and again.
#[must_use]
pub fn unpredictable(
    nominal: &PlantParameters,
    inputs: &PlantInputs,
    readings: &[Vec<f64>; CHANNELS.len()],
    noise: [f64; CHANNELS.len()],
) -> Vec<[f64; 2]> {
    let own = simulate(nominal, inputs);
    let all = changes(nominal, inputs, &own, noise);
    let mut found: Vec<[f64; 2]> = Vec::new();
    for (time, change) in inputs.time.iter().zip(&all[Channel::Stroke as usize]) {
        if !change.is_finite() || *change <= OWN_WAY {
            continue;
        }
        match found.last_mut() {
            Some(last) if time - last[1] < APART => last[1] = *time,
            _ => found.push([*time, *time]),
        }
    }
    for stretch in &mut found {
        stretch[0] = beginning(&inputs.time, &all[Channel::Stroke as usize], stretch[0]);
    }
    let touches = TOUCHES * noise[Channel::Force as usize];
    let force = &readings[Channel::Force as usize];
    found.retain(|[start, end]| {
        let of = |time: f64| inputs.time.partition_point(|t| *t < time);
        let within = &force[of(start - BEGAN)..of(*end)];
        let begins = |two: &&[f64]| two[0] <= touches && two[1] > touches;
        within.windows(2).filter(begins).count() >= BOUNCES
    });
    found
}

/// Since when a change has been growing that has grown large by a time [s].
fn beginning(time: &[f64], changes: &[f64], large: f64) -> f64 {
    let mut start = large;
    loop {
        let [from, to] = [start - GROWS, start].map(|at| time.partition_point(|t| *t < at));
        let largest = changes[from..to].iter().copied().fold(0.0, f64::max);
        if from == to || largest <= BEGINS {
            return start;
        }
        start = time[from];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::test_evidence::plant;
    use crate::plant::InitialState;
    use std::f64::consts::TAU;

    const NOISE: [f64; CHANNELS.len()] = [500.0, 2e-5, 1.0, 0.2];

    /// Four seconds at a set pressure [Pa gauge], the surface moved to either side of the stroke's middle by an amplitude [m] at a frequency [Hz].
    fn inputs(pressure: f64, amplitude: f64, frequency: f64) -> PlantInputs {
        let middle = 0.5 * plant().device.full_stroke;
        let time: Vec<f64> = (0..1000).map(|i| 0.004 * f64::from(i)).collect();
        PlantInputs {
            set_pressure: vec![pressure; time.len()],
            extends: vec![true; time.len()],
            surface: (time.iter())
                .map(|t| middle + amplitude * (TAU * frequency * t).sin())
                .collect(),
            cell: None,
            motion: None,
            initial: InitialState::AtRest,
            place: 0,
            time,
        }
    }

    const FOLLOWS: [(f64, f64, f64); 2] = [(2e5, 0.005, 0.5), (2e5, 0.002, 3.0)];
    const BOUNCING: (f64, f64, f64) = (4e4, 0.004, 15.0);

    /// A tool that follows its surface, slow or fast, and one that strikes it again and again.
    #[test]
    fn a_tool_that_bounces_cannot_be_predicted() {
        let of = |(pressure, amplitude, frequency)| {
            let inputs = inputs(pressure, amplitude, frequency);
            sensitivity(&plant(), &inputs, &simulate(&plant(), &inputs), NOISE)
        };
        for follows in FOLLOWS {
            let found = of(follows);
            assert!(found < 0.5 * STEADY, "{follows:?}: {found}");
        }
        let bounces = of(BOUNCING);
        assert!(bounces > 2.0 * STEADY, "{bounces}");
    }

    /// The device's mass is a thousandth off. Where it bounces by its own recording, what follows is set aside; where only the model does, nothing is.
    #[test]
    fn what_a_bouncing_tool_did_is_set_aside() {
        let mut heavier = plant();
        heavier.device.moving_mass *= 1.001;
        let stretches = |of: (f64, f64, f64), touches: bool| {
            let inputs = inputs(of.0, of.1, of.2);
            let trajectory = simulate(&heavier, &inputs);
            let mut readings = trajectory.readings;
            if !touches {
                readings[Channel::Force as usize].fill(80.0);
            }
            let nominal = simulate(&plant(), &inputs).readings;
            let stroke = Channel::Stroke as usize;
            let off = readings[stroke].iter().zip(&nominal[stroke]);
            let off: Vec<f64> = off
                .map(|(own, other)| (own - other).abs() / NOISE[stroke])
                .collect();
            (
                unpredictable(&plant(), &inputs, &readings, NOISE),
                inputs.time,
                off,
            )
        };
        for follows in FOLLOWS {
            assert_eq!(stretches(follows, true).0, Vec::<[f64; 2]>::new());
        }
        assert_eq!(stretches(BOUNCING, false).0, Vec::<[f64; 2]>::new());
        let (found, time, off) = stretches(BOUNCING, true);
        let is_aside = |t: f64| {
            found
                .iter()
                .any(|[start, end]| (*start..=*end).contains(&t))
        };
        // Most of what cannot be predicted is aside, and what can be is not.
        let far = time.iter().zip(&off).filter(|(_, off)| **off > 50.0);
        let (aside, kept): (Vec<f64>, Vec<f64>) = far.map(|(t, _)| *t).partition(|t| is_aside(*t));
        assert!(
            aside.len() > 4 * kept.len(),
            "{} {}",
            aside.len(),
            kept.len()
        );
        assert!(!is_aside(0.02) && !found.is_empty(), "{found:?}");
    }
}
