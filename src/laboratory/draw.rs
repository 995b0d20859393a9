//! Devices drawn at random: their nominal values, and what they really are.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::programme::{Programme, Surface, Wave};
use super::rig::{AIR, LaboratoryRig};
use super::sensors::{as_printed, between};

/// The numbers that have a tolerance, and how wide it is at its usual.
pub const TOLERANCES: [(&str, f64); 8] = [
    ("dead_volume_m3", 0.1),
    ("moving_mass_kg", 0.01),
    ("gain", 0.01),
    ("time_constant_s", 0.1),
    ("supply_orifice_m2", 0.05),
    ("exhaust_orifice_m2", 0.05),
    ("stiffness_n_per_m", 0.1),
    ("damping_n_s_per_m", 0.3),
];

/// A nominal device, with its tolerances.
#[derive(Debug, Clone, PartialEq)]
pub struct NominalRig {
    /// The numbers.
    pub rig: LaboratoryRig,
    /// Relative tolerances, in the order of [`TOLERANCES`].
    pub tolerances: [f64; 8],
}

/// The toleranced numbers of a rig, in the order of [`TOLERANCES`].
pub(super) fn toleranced(rig: &mut LaboratoryRig) -> [&mut f64; 8] {
    [
        &mut rig.dead_volume,
        &mut rig.mass,
        &mut rig.gain,
        &mut rig.time_constant,
        &mut rig.supply_orifice,
        &mut rig.exhaust_orifice,
        &mut rig.contact_stiffness,
        &mut rig.contact_damping,
    ]
}

/// A stream of random numbers for a purpose.
pub(super) fn stream(seed: u64, purpose: u64) -> ChaCha8Rng {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(purpose);
    rng
}

impl NominalRig {
    /// A device at random.
    pub fn draw(seed: u64) -> Self {
        let rng = &mut stream(seed, 1);
        let count = rng.random_range(1u32..=3);
        // Cylinders of a like area in all, so that weight and force go together.
        let area = between(rng, 5e-4, 1.3e-3);
        let bore = (area / f64::from(count) / 0.25 / std::f64::consts::PI).sqrt();
        let stroke = between(rng, 0.035, 0.08);
        let mass = between(rng, 2.0, 7.0);
        let swept = area * stroke;
        let stiffness = between(rng, 4e4, 3e5);
        let damping_share = rng.random_range(0.1..0.3);
        let noise = between(rng, 0.6, 1.7);
        let rig = LaboratoryRig {
            count,
            bore: as_printed(bore, 3),
            rod: as_printed(bore * rng.random_range(0.3..0.5), 2),
            stroke: as_printed(stroke, 2),
            dead_volume: as_printed(swept * rng.random_range(0.15..0.4), 4),
            mass: as_printed(mass, 3),
            gravity: as_printed(-9.81 * rng.random_range(0.0..1.0), 3),
            stop: [1e6, 2e3],
            gain: 1.0,
            time_constant: as_printed(between(rng, 0.06, 0.2), 3),
            supply_orifice: as_printed(area * between(rng, 1.2e-3, 3e-3), 4),
            exhaust_orifice: as_printed(area * between(rng, 1.0e-3, 2.5e-3), 4),
            discharge: as_printed(rng.random_range(0.8..0.98), 2),
            gas: AIR,
            contact_stiffness: as_printed(stiffness, 3),
            contact_damping: as_printed(damping_share * 2.0 * (stiffness * mass).sqrt(), 3),
            rate: 250.0,
            noise: [400.0, 2e-5, 0.8, 0.15].map(|sheet| as_printed(noise * sheet, 2)),
        };
        let looser = rng.random_range(0.7..1.3);
        Self {
            rig,
            tolerances: TOLERANCES.map(|(_, usual)| as_printed(looser * usual, 1)),
        }
    }

    /// The same device as it really is, every number within its tolerance.
    pub fn real(&self, seed: u64) -> LaboratoryRig {
        let rng = &mut stream(seed, 2);
        let mut rig = self.rig.clone();
        for (number, tolerance) in toleranced(&mut rig).into_iter().zip(self.tolerances) {
            *number *= 1.0 + tolerance * rng.random_range(-1.0..1.0);
        }
        rig
    }

    /// Three programmes to diagnose from and one to predict, each this long [s].
    pub fn programmes(&self, seed: u64, duration: f64) -> [Programme; 4] {
        let rng = &mut stream(seed, 3);
        let rig = &self.rig;
        // Below this the device does not lift its weight.
        let lifts = rig.mass * rig.gravity.abs() / rig.areas()[0];
        let times: Vec<f64> = (0..(duration * rig.rate).round() as usize)
            .map(|i| i as f64 / rig.rate)
            .collect();
        let level = |rng: &mut ChaCha8Rng| {
            let pressure = lifts + between(rng, 0.4e5, 3.2e5);
            (pressure / 1e3).round() * 1e3
        };
        let on_grid = |time: f64| (time * rig.rate).round() / rig.rate;
        let programme = |name: &str, set_pressures, valve, surface| Programme {
            name: name.to_owned(),
            set_pressures,
            valve,
            surface,
            times: times.clone(),
        };
        let steps = |rng: &mut ChaCha8Rng, hold: [f64; 2]| {
            let mut at = on_grid(rng.random_range(0.08..0.16));
            let mut commands = Vec::new();
            while at < duration - 0.15 {
                commands.push((at, level(rng)));
                at = on_grid(at + rng.random_range(hold[0]..hold[1]));
            }
            commands
        };
        let place = as_printed(rig.stroke * rng.random_range(0.35..0.6), 4);
        let still = Surface::Waves(place, Vec::new());
        let moved = |rng: &mut ChaCha8Rng| {
            let middle = rig.stroke * rng.random_range(0.42..0.58);
            let waves = [0.25, 0.7, 1.9].map(|frequency: f64| {
                let frequency = frequency * rng.random_range(0.8..1.25);
                Wave {
                    amplitude: rig.stroke * 0.05 / frequency.sqrt().max(frequency),
                    frequency,
                    phase: rng.random_range(0.0..std::f64::consts::TAU),
                }
            });
            Surface::Waves(middle, waves.to_vec())
        };
        let stairs = steps(rng, [0.35, 0.6]);
        let ride_surface = moved(rng);
        let ride = steps(rng, [0.6, 1.1]);
        let cycle = steps(rng, [0.9, 1.6]);
        let toggles = |rng: &mut ChaCha8Rng, hold: [f64; 2], first: f64| {
            let mut at = on_grid(first);
            let mut valve = vec![(0.0, true)];
            while at < duration - 0.1 {
                valve.push((at, valve.len() % 2 == 0));
                at = on_grid(at + rng.random_range(hold[0]..hold[1]));
            }
            valve
        };
        let cycle_valve = toggles(rng, [0.4, 0.8], 0.9);
        let unseen_surface = moved(rng);
        let unseen = steps(rng, [0.4, 0.9]);
        let unseen_valve = toggles(rng, [0.9, 1.4], 0.55 * duration);
        [
            programme("stairs", stairs, vec![(0.0, true)], Some(still)),
            programme("ride", ride, vec![(0.0, true)], Some(ride_surface)),
            programme("cycle", cycle, cycle_valve, None),
            programme("predict", unseen, unseen_valve, Some(unseen_surface)),
        ]
    }
}
