//! Explanations that an experiment leaves open, and the sensor that would tell them apart.

use super::information::{Open, Outlook, Probe, Sensors};
use crate::diagnosis::answer::words::CHANNEL_WORDS;
use crate::plant::{CHANNELS, Channel, PlantInputs};

/// Probability of another explanation, were one the truth, from which the two stay open [1].
const OPEN: f64 = 0.1;
/// Probability of an explanation from which it is worth a word that it stays [1].
const LIKELY: f64 = 0.01;
/// Probability of another explanation, were one the truth, with a sensor more, up to which it tells them apart [1].
const APART: f64 = 0.05;
/// Noise of usual sensors, in the order of [`CHANNELS`]: of a pressure [Pa], a stroke [m], a force [N], an acceleration [m/s2].
const USUAL: [f64; CHANNELS.len()] = [400.0, 3e-5, 1.0, 0.15];

/// A sensor that a rig has not.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FurtherSensor {
    /// One of the usual channels.
    Channel(Channel),
    /// Pressure in a chamber, 0 or 1.
    ChamberPressure(usize),
}

impl FurtherSensor {
    /// In words.
    #[must_use]
    pub fn words(self) -> String {
        match self {
            Self::Channel(channel) => format!("the {}", CHANNEL_WORDS[channel as usize]),
            Self::ChamberPressure(place) => format!("the pressure in chamber {}", place + 1),
        }
    }

    fn added(self, sensors: &Sensors) -> Sensors {
        let mut with = sensors.clone();
        match self {
            Self::Channel(channel) => with.noise[channel as usize] = USUAL[channel as usize],
            Self::ChamberPressure(place) => {
                with.probe = Some(Probe {
                    chamber: place,
                    noise: USUAL[Channel::RegulatorPressure as usize],
                });
            }
        }
        with
    }

    fn all(sensors: &Sensors) -> impl Iterator<Item = Self> {
        let missing = CHANNELS
            .into_iter()
            .filter(|channel| !sensors.noise[*channel as usize].is_finite());
        let missing: Vec<Self> = missing.map(Self::Channel).collect();
        missing.into_iter().chain([0, 1].map(Self::ChamberPressure))
    }
}

/// Two explanations that stay open.
#[derive(Debug, Clone, PartialEq)]
pub struct Inseparable {
    /// Their places among the open ones, the likelier first.
    pub places: [usize; 2],
    /// What would tell them apart; none where none of the sensors that there usually are does.
    pub sensor: Option<FurtherSensor>,
}

/// Pairs of explanations that inputs leave open by what is expected of them, with the first sensor more that would tell them apart.
#[must_use]
pub fn inseparable(
    open: &[Open],
    (sensors, odds): (&Sensors, &[Vec<f64>]),
    inputs: &PlantInputs,
) -> Vec<Inseparable> {
    let stay = |odds: &[Vec<f64>], [one, other]: [usize; 2], limit: f64| {
        // Of the two alone, whichever is the truth.
        let of = |truth: usize, model: usize| {
            let [right, wrong] = [odds[truth][truth], odds[truth][model]];
            wrong / (right + wrong)
        };
        of(one, other).max(of(other, one)) > limit
    };
    let pairs = (1..open.len()).flat_map(|other| (0..other).map(move |one| [one, other]));
    let likely = |pair: &[usize; 2]| pair.iter().all(|place| open[*place].probability > LIKELY);
    let pairs = pairs.filter(likely);
    let stuck: Vec<[usize; 2]> = pairs.filter(|pair| stay(odds, *pair, OPEN)).collect();
    if stuck.is_empty() {
        return Vec::new();
    }
    let with: Vec<(FurtherSensor, Vec<Vec<f64>>)> = FurtherSensor::all(sensors)
        .map(|sensor| {
            let with = sensor.added(sensors);
            (sensor, Outlook::of(open, &with, inputs).expected().odds)
        })
        .collect();
    let of = |places: [usize; 2]| {
        let tells = |(_, odds): &&(FurtherSensor, Vec<Vec<f64>>)| !stay(odds, places, APART);
        Inseparable {
            places,
            sensor: with.iter().find(tells).map(|(sensor, _)| *sensor),
        }
    };
    stuck.into_iter().map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::super::information::tests::{inputs, open, sensors};
    use super::*;
    use crate::diagnosis::test_evidence::plant;

    /// Without a load cell its gain moves nothing, and with one it does; the mass shows in the stroke.
    #[test]
    fn the_sensor_that_is_missing_is_named() {
        let (mut gained, mut heavier) = (plant(), plant());
        gained.sensors.force_gain = 1.2;
        heavier.device.moving_mass *= 1.3;
        let all = [
            open("as it is", plant(), 0.4),
            open("gain", gained, 0.3),
            open("mass", heavier, 0.3),
        ];
        let mut sensors = sensors();
        sensors.noise[2..].fill(f64::INFINITY);
        let inputs = inputs();
        let odds = Outlook::of(&all, &sensors, &inputs).expected().odds;
        let found = inseparable(&all, (&sensors, &odds), &inputs);
        let expected = Inseparable {
            places: [0, 1],
            sensor: Some(FurtherSensor::Channel(Channel::Force)),
        };
        assert_eq!(found, [expected]);
    }

    /// What no sensor shows has none to name; nothing open is nothing to say.
    #[test]
    fn what_nothing_tells_apart_has_no_sensor() {
        let all = [open("a", plant(), 0.5), open("b", plant(), 0.5)];
        let inputs = inputs();
        let odds = Outlook::of(&all, &sensors(), &inputs).expected().odds;
        let found = inseparable(&all, (&sensors(), &odds), &inputs);
        assert_eq!((found[0].sensor, found.len()), (None, 1));
        let alone = [open("a", plant(), 1.0)];
        let odds = Outlook::of(&alone, &sensors(), &inputs).expected().odds;
        assert_eq!(inseparable(&alone, (&sensors(), &odds), &inputs), []);
    }
}
