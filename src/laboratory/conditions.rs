//! Conditions of a case that no ideal laboratory has: small imperfections of device and sensors, rates and noise of other recorders, recordings that begin
//! in mid-motion, a channel that is missing.

use std::f64::consts::TAU;

use rand::Rng;
use rand_chacha::ChaCha8Rng;

use super::concealed::{Concealed, Seals, Swing};
use super::dirt::Dirt;
use super::draw::{NominalRig, stream};
use super::programme::Programme;
use super::rig::LaboratoryRig;
use super::sensors::between;

/// Part of a real device's imperfections from which it also has friction and a hose [1]: less is below any sensor's noise.
const ALL_KINDS: f64 = 0.5;

/// Conditions under which a device is recorded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Conditions {
    /// Size of the imperfections beside what is concealed, over those that a real device has [1].
    pub imperfection: f64,
    /// Samples per second; none for the device's own [Hz].
    pub rate: Option<f64>,
    /// Noise of the sensors over what the rig file states [1].
    pub noise: f64,
    /// Steps of the converters over those of usual ones [1].
    pub coarseness: f64,
    /// Channel that is never recorded, by its place in [`super::CHANNELS`].
    pub missing: Option<usize>,
    /// Time from which recordings to diagnose from are kept [s]; later than 0 they begin in mid-motion and under pressure.
    pub begins: f64,
    /// Whether what is periodic begins with a phase of its own in each recording.
    pub phases_drawn: bool,
    /// Dirt on the recordings.
    pub dirt: Option<Dirt>,
}

impl Default for Conditions {
    /// Those of a laboratory.
    fn default() -> Self {
        Self {
            imperfection: 0.0,
            rate: None,
            noise: 1.0,
            coarseness: 1.0,
            missing: None,
            begins: 0.0,
            phases_drawn: false,
            dirt: None,
        }
    }
}

/// Effects of the vocabulary among a real device's imperfections: naming them is no error.
pub(super) const IMPERFECTIONS: [&str; 11] = [
    "coulomb_viscous_friction",
    "stribeck_friction",
    "presliding_hysteresis",
    "pressure_dependent_friction",
    "hose_volume",
    "external_leakage",
    "regulator_hysteresis",
    "tool_runout",
    "force_sensor_gain_error",
    "force_sensor_bias_drift",
    "stroke_sensor_gain_error",
];

impl Conditions {
    /// Those of a shop floor, drawn at random: a real device's imperfections, a recorder of 50 to 1000 Hz, a sheet that is off by up to two, converters up to eight
    /// times as coarse, half of the recordings dirty.
    #[must_use]
    pub fn of_a_shop(seed: u64) -> Self {
        let rng = &mut stream(seed, 9);
        Self {
            imperfection: rng.random_range(ALL_KINDS..1.5),
            rate: Some(between(rng, 50.0, 1000.0).round()),
            noise: between(rng, 0.5, 2.0),
            coarseness: between(rng, 1.0, 8.0),
            dirt: rng.random_bool(0.5).then_some(Dirt::USUAL),
            ..Self::default()
        }
    }

    /// Whether an effect that is not concealed may be named all the same.
    #[must_use]
    pub fn has(&self, effect: &str) -> bool {
        self.imperfection >= ALL_KINDS && IMPERFECTIONS.contains(&effect)
    }

    pub(super) fn on_nominal(&self, nominal: &mut NominalRig) {
        nominal.rig.rate = self.rate.unwrap_or(nominal.rig.rate);
    }

    /// All programmes but the last, which is to be predicted, lose their beginning.
    pub(super) fn on_programmes(&self, programmes: &mut [Programme]) {
        let last = programmes.len() - 1;
        for programme in &mut programmes[..last] {
            programme.times.retain(|time| *time >= self.begins);
        }
    }

    /// Imperfections where nothing is concealed.
    pub(super) fn on_device(&self, concealed: &mut Concealed, rig: &LaboratoryRig, seed: u64) {
        if self.imperfection == 0.0 {
            return;
        }
        let ideal = Concealed::default();
        let rng = &mut stream(seed, 8);
        let size = self.imperfection;
        let mut drawn = |most: f64| size * most * rng.random_range(0.5..1.0);
        let swing = drawn(4e-6);
        let leak = drawn(1.5e-3 * rig.exhaust_orifice);
        let play = drawn(300.0);
        let [gain, bias, lag, stroke_gain] = [4e-3, 0.4, 4e-4, 6e-4].map(&mut drawn);
        let [coulomb, per_pressure, volume, resistance] = [1.0, 2e-6, 1.5e-5, 3e7].map(&mut drawn);
        let mut sign = |value: f64| value * if rng.random_bool(0.5) { 1.0 } else { -1.0 };
        let (gain, bias, stroke_gain) = (sign(gain), sign(bias), sign(stroke_gain));
        let frequency = between(rng, 15.0, 60.0);
        if concealed.swings.is_empty() {
            concealed.swings.push(Swing {
                amplitude: swing,
                frequency,
                phase: rng.random_range(0.0..TAU),
            });
        }
        let unless = |is_ideal: bool, number: &mut f64, value: f64| {
            if is_ideal {
                *number = value;
            }
        };
        unless(
            concealed.external_leak == 0.0,
            &mut concealed.external_leak,
            leak,
        );
        unless(concealed.play == 0.0, &mut concealed.play, play);
        unless(
            concealed.force_gain == 1.0,
            &mut concealed.force_gain,
            1.0 + gain,
        );
        unless(
            concealed.force_bias == ideal.force_bias,
            &mut concealed.force_bias[0],
            bias,
        );
        unless(concealed.force_lag == 0.0, &mut concealed.force_lag, lag);
        unless(
            concealed.stroke_gain == 1.0,
            &mut concealed.stroke_gain,
            1.0 + stroke_gain,
        );
        if size < ALL_KINDS {
            return;
        }
        concealed.hose = concealed.hose.or(Some([volume, resistance]));
        concealed.seals = concealed.seals.or(Some(Seals {
            coulomb,
            breakaway: 1.3 * coulomb,
            stribeck_velocity: 0.01,
            viscous: 3.0 * coulomb,
            presliding: 2e-5,
            per_pressure,
            elastic_share: 0.4,
        }));
    }

    /// What is concealed as it is in one recording.
    pub(super) fn in_recording(&self, concealed: &Concealed, seed: u64, index: usize) -> Concealed {
        let mut own = concealed.clone();
        if self.phases_drawn {
            let rng: &mut ChaCha8Rng = &mut stream(seed, 10 + index as u64);
            for swing in &mut own.swings {
                swing.phase = rng.random_range(0.0..TAU);
            }
        }
        own
    }
}

#[cfg(test)]
mod tests {
    use super::super::case::{LaboratoryCase, Recipe};
    use super::*;

    fn case(conditions: Conditions, effects: &[(&'static str, f64)]) -> LaboratoryCase {
        let recipe = Recipe {
            name: String::new(),
            seed: 3,
            effects: effects.to_vec(),
            law: None,
            duration: 3.0,
            conditions,
        };
        recipe.make().unwrap()
    }

    /// Root mean square of the difference of a channel in the first recording, in standard deviations of the sheet's noise.
    fn apart(one: &LaboratoryCase, other: &LaboratoryCase, channel: usize) -> f64 {
        let pairs = (one.measured[0][channel].iter()).zip(&other.measured[0][channel]);
        let squares: Vec<f64> = pairs.map(|(a, b)| (a - b).powi(2)).collect();
        let mean = squares.iter().sum::<f64>() / squares.len() as f64;
        mean.sqrt() / one.nominal.rig.noise[channel]
    }

    #[test]
    fn imperfections_of_a_twelfth_are_below_the_noise_and_whole_ones_are_not() {
        let ideal = case(Conditions::default(), &[]);
        let of = |imperfection: f64| {
            let conditions = Conditions {
                imperfection,
                ..Conditions::default()
            };
            case(conditions, &[])
        };
        let (small, whole) = (of(1.0 / 12.0), of(1.0));
        // The median channel: what an impact is moved by is seen in all of them for a moment.
        for channel in [0, 1, 2] {
            let size = apart(&small, &ideal, channel);
            assert!(size > 0.0 && size < 1.0, "{channel}: {size}");
        }
        assert!(apart(&whole, &ideal, 1) > 2.0);
        assert!(small.sealed.also_there.is_empty() && whole.sealed.also_there.len() == 11);
    }

    #[test]
    fn what_is_concealed_is_not_among_what_is_there_beside_it() {
        let shop = Conditions {
            imperfection: 1.0,
            ..Conditions::default()
        };
        let found = case(shop, &[("external_leakage", 1.0)]).sealed;
        assert_eq!(found.effects[0].name, "external_leakage");
        assert!(!found.also_there.contains(&"external_leakage".to_owned()));
    }

    #[test]
    fn noise_channels_beginnings_and_phases_are_as_asked() {
        let ideal = case(Conditions::default(), &[("tool_runout", 1.0)]);
        let loud = case(
            Conditions {
                noise: 2.0,
                ..Conditions::default()
            },
            &[("tool_runout", 1.0)],
        );
        // The same numbers drawn, twice as large: what is left between the two is noise once over.
        assert!((apart(&loud, &ideal, 0) - 1.0).abs() < 0.1);
        assert_eq!(loud.nominal.rig.noise, ideal.nominal.rig.noise);
        let other = case(
            Conditions {
                missing: Some(3),
                begins: 1.0,
                phases_drawn: true,
                ..Conditions::default()
            },
            &[("tool_runout", 1.0)],
        );
        assert!(other.measured[0][3].iter().all(|value| value.is_nan()));
        assert!(other.programmes[0].times[0] >= 1.0 && other.programmes[3].times[0] == 0.0);
        let from = ideal.measured[3][2].iter().zip(&other.measured[3][2]);
        let moved = from.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(moved > 10.0 * ideal.nominal.rig.noise[2], "{moved}");
    }
}
