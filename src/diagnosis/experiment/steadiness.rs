//! Whether a motion can be predicted at all: a tool that bounces on a surface that shakes goes its own way after some impacts, whatever is known of it.
//!
//! ```text
//! s = max over channels of sqrt(mean over samples of min(|y((1 + e) p) - y(p)| / n, 1)^2),   e = 10^-5
//! ```
//!
//! y readings, p set pressure, n standard deviation of a channel's noise. A hundred-thousandth is less than any description is true to. In motions that follow
//! from what is done s is some hundredths, and the more of it the longer a mass moves freely; where impacts amplify each other's differences it comes to
//! tenths within ten of them (sensitive dependence on initial conditions of an impacting oscillator: Holmes, Journal of Sound and Vibration 84, 1982).

use crate::plant::{CHANNELS, PlantInputs, PlantParameters, PlantTrajectory, simulate};
use crate::stats::mean;

/// e [1].
const CHANGE: f64 = 1e-5;
/// What s comes to at most where a motion can be predicted [1].
pub const STEADY: f64 = 0.15;

/// s of a device under inputs, with what it does there and the sensors' noise, infinite where there is no sensor [1].
#[must_use]
pub fn sensitivity(
    plant: &PlantParameters,
    inputs: &PlantInputs,
    own: &PlantTrajectory,
    noise: [f64; CHANNELS.len()],
) -> f64 {
    let mut other = inputs.clone();
    other
        .set_pressure
        .iter_mut()
        .for_each(|p| *p *= 1.0 + CHANGE);
    let there = simulate(plant, &other);
    let channels = own.readings.iter().zip(&there.readings).zip(noise);
    let of = channels.filter(|(_, noise)| noise.is_finite());
    of.map(|((own, there), noise)| {
        let changes = own
            .iter()
            .zip(there)
            .map(|(own, there)| (there - own).abs() / noise);
        let known = changes.filter(|change| change.is_finite());
        let squares: Vec<f64> = known.map(|change| change.min(1.0).powi(2)).collect();
        mean(&squares).sqrt()
    })
    .fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::test_evidence::plant;
    use crate::plant::InitialState;
    use std::f64::consts::TAU;

    const NOISE: [f64; CHANNELS.len()] = [500.0, 2e-5, 1.0, 0.2];

    /// Four seconds at a set pressure [Pa gauge], the surface moved to either side of the stroke's middle by an amplitude [m] at a frequency [Hz].
    fn of(pressure: f64, amplitude: f64, frequency: f64) -> f64 {
        let plant = plant();
        let middle = 0.5 * plant.device.full_stroke;
        let time: Vec<f64> = (0..1000).map(|i| 0.004 * f64::from(i)).collect();
        let inputs = PlantInputs {
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
        };
        let own = simulate(&plant, &inputs);
        sensitivity(&plant, &inputs, &own, NOISE)
    }

    /// A tool that follows its surface, slow or fast, and one that strikes it again and again.
    #[test]
    fn a_tool_that_bounces_cannot_be_predicted() {
        for (pressure, amplitude, frequency) in [(2e5, 0.005, 0.5), (2e5, 0.002, 3.0)] {
            let found = of(pressure, amplitude, frequency);
            assert!(found < 0.5 * STEADY, "{pressure} {frequency}: {found}");
        }
        let bounces = of(4e4, 0.004, 15.0);
        assert!(bounces > 2.0 * STEADY, "{bounces}");
    }
}
