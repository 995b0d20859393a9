//! The device as the subject of a diagnosis, by itself, in a cell, or a part of it.

use super::recorded::{COLUMNS, QUANTITIES};
use super::subject::{Denial, Subject};
use crate::plant::{
    CHANNELS, Channel, Nudging, PlantInputs, PlantParameters, PlantTrajectory, Quantity, readings,
    true_trajectory,
};
use crate::recording::csv::plausible_range;

/// Multiple of the load cell's noise from which the tool touches [1].
const TOUCHES: f64 = 6.0;

/// The pneumatic device.
#[derive(Debug, Clone, Copy)]
pub struct Device;

impl Subject for Device {
    type Model = PlantParameters;
    type Quantity = Quantity;
    type Inputs = PlantInputs;
    type Channel = Channel;
    type Readings = [Vec<f64>; CHANNELS.len()];
    type Noise = [f64; CHANNELS.len()];
    type Simulated = PlantTrajectory;
    type Guide = Nudging;

    const CHANNELS: &'static [Channel] = &CHANNELS;
    const UPSTREAM: Option<Channel> = Some(Channel::RegulatorPressure);

    fn column(channel: Channel) -> &'static str {
        COLUMNS[channel as usize]
    }

    fn plausible(channel: Channel) -> [f64; 2] {
        plausible_range(QUANTITIES[channel as usize])
    }

    /// ```text
    /// force e    ->  acceleration e / m                    stroke e  ->  acceleration e / T^2
    /// acceleration e  ->  speed after less speed before e T, as the stroke has it
    /// ```
    ///
    /// e departure, m moving mass [kg], T step [s]. The regulator's outlet is left by a lag, which no single sample can come out of.
    fn denial(channel: Channel, model: &PlantParameters) -> Denial {
        let by = Channel::Acceleration as usize;
        let of = |per: f64, order: i32| Denial::Derivative { by, per, order };
        match channel {
            Channel::RegulatorPressure => Denial::Itself,
            Channel::Force => of(model.device.moving_mass, 0),
            Channel::Stroke => of(1.0, 2),
            Channel::Acceleration => Denial::TwiceIntegrated {
                by: Channel::Stroke as usize,
            },
        }
    }

    fn value(quantity: &Quantity, model: &PlantParameters) -> f64 {
        quantity.get(model)
    }

    fn set(quantity: &Quantity, model: &mut PlantParameters, value: f64) {
        quantity.set(model, value);
    }

    fn time(inputs: &PlantInputs) -> &[f64] {
        &inputs.time
    }

    fn placed(inputs: &mut PlantInputs, place: usize) -> usize {
        inputs.place = place;
        inputs.initial.samples()
    }

    fn guide(inputs: &PlantInputs, readings: &Self::Readings, noise: &Self::Noise) -> Nudging {
        let [_, stroke, force, acceleration] = readings;
        let [_, stroke_noise, force_noise, acceleration_noise] = *noise;
        let touching = |i: usize| force[i].abs() > TOUCHES * force_noise;
        Nudging::new(
            &inputs.time,
            stroke,
            acceleration,
            stroke_noise,
            acceleration_noise,
            touching,
        )
    }

    fn guides(channel: Channel) -> bool {
        channel == Channel::Acceleration
    }

    /// The trajectory is the known one where only sensors differ.
    fn simulate(
        model: &PlantParameters,
        inputs: &PlantInputs,
        free: bool,
        guide: Option<&Nudging>,
        known: Option<(&PlantParameters, &PlantTrajectory)>,
    ) -> PlantTrajectory {
        let moves_alike = |other: &PlantParameters| {
            // A stroke's gain is one of the motion that a piston is held to.
            let held_alike =
                guide.is_none() || model.sensors.stroke_gain == other.sensors.stroke_gain;
            let free_alike = || free && model.moves_freely_as(other);
            held_alike && (model.moves_as(other, inputs.place) || free_alike())
        };
        // What a late load cell feels between the samples is known of what was simulated with one.
        let felt = |known: &PlantTrajectory| {
            guide.is_some() || !model.sensors.is_late() || known.truth.load_cell.is_known()
        };
        let alike = known.filter(|(other, known)| felt(known) && moves_alike(other));
        let truth = match alike {
            Some((_, known)) => known.truth.clone(),
            None => true_trajectory(model, inputs, guide),
        };
        let readings = readings(model, inputs, &truth);
        PlantTrajectory { truth, readings }
    }

    fn readings(simulated: &PlantTrajectory) -> &[Vec<f64>] {
        &simulated.readings
    }
}

#[cfg(test)]
mod tests {
    use crate::diagnosis::test_evidence::{evidence_of, plant};

    /// A trajectory that was simulated for a load cell in time does not say what a late one feels between the samples.
    #[test]
    fn a_late_load_cell_reads_the_same_whatever_was_simulated_before() {
        let evidence = evidence_of(&plant(), vec![vec![2e5; 126]]);
        let in_time = evidence.predict(&plant(), false, None);
        for late in [[1.5e-3, 0.0], [0.0, 5.1e-3]] {
            let mut plant = plant();
            [plant.sensors.force_lag, plant.sensors.force_delay] = late;
            let anew = evidence.predict(&plant, false, None);
            let from_known = evidence.predict(&plant, false, Some(&in_time));
            assert_eq!(from_known.residuals, anew.residuals, "{late:?}");
        }
    }
}
