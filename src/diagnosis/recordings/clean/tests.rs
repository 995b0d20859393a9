//! Planted dirt is found, and nothing else is taken for it.

use rand::{Rng, SeedableRng};
use rand_distr::StandardNormal;

use super::*;
use crate::device::DeviceParameters;
use crate::diagnosis::recordings::device::Device;
use crate::physics::regulator::RegulatorParameters;
use crate::plant::*;

const NOISE: [f64; 4] = [400.0, 2e-5, 0.8, 0.15];
const MASS: f64 = 5.0;

fn plant() -> PlantParameters {
    PlantParameters {
        device: DeviceParameters {
            bore: 0.025,
            rod: 0.01,
            dead_volume: 1.4e-5,
            moving_mass: MASS,
            supply_orifice: 1.6e-6,
            exhaust_orifice: 1.3e-6,
            regulator: RegulatorParameters {
                time_constant: 0.1,
                dead_time: 0.0,
                ..RegulatorParameters::default()
            },
            ..DeviceParameters::default()
        },
        gravity_along_extension: -9.81,
        contact: ContactParameters {
            law: ContactLaw::Linear { stiffness: 2e5 },
            damping: 400.0,
            surface_offset: 0.0,
            spindle_frequency: 0.0,
            runout: Periodic::NONE,
            waviness: Periodic::NONE,
        },
        mounting: Mounting::default(),
        cell: CellParameters::RIGID,
        sensors: SensorErrors::NONE,
        latent: None,
        own: Vec::new(),
        parts: DeviceParts::Whole,
        links: LinkParameters::NONE,
    }
}

/// Six seconds at 250 Hz with impacts: on a surface that stands at 20 mm, or end stop on end stop without one.
fn recording(contact: bool, seed: u64) -> (Vec<f64>, [Vec<f64>; 4]) {
    let count = 1500;
    let time: Vec<f64> = (0..count).map(|i| 0.004 * f64::from(i)).collect();
    let inputs = PlantInputs {
        set_pressure: time
            .iter()
            .map(|t| if *t < 0.2 { 0.0 } else { 2e5 })
            .collect(),
        extends: time.iter().map(|t| contact || t % 3.0 < 1.5).collect(),
        surface: vec![if contact { 0.02 } else { f64::NAN }; time.len()],
        time: time.clone(),
        cell: None,
        motion: None,
        initial: crate::plant::InitialState::AtRest,
        place: 0,
    };
    let mut readings = simulate(&plant(), &inputs).readings;
    let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
    for (values, noise) in readings.iter_mut().zip(NOISE) {
        for value in values {
            *value += noise * random.sample::<f64, _>(StandardNormal);
        }
    }
    (time, readings)
}

#[test]
fn impacts_are_no_wild_values() {
    for contact in [true, false] {
        let (time, mut readings) = recording(contact, 1);
        // Single samples that stand out are there to be mistaken.
        let accelerations = &readings[3];
        let alone = accelerations
            .windows(3)
            .filter(|w| (w[1] - w[0]).abs() > 5.0 && (w[1] - w[2]).abs() > 5.0)
            .count();
        assert!(alone > 0, "{contact}");
        let before = readings.clone();
        let cleaning = clean::<Device>(&time, &mut readings, &NOISE, &plant());
        assert_eq!(readings, before);
        assert_eq!(cleaning.account::<Device>(&NOISE), Vec::<String>::new());
        assert!((cleaning.step - 0.004).abs() < 1e-12);
    }
}

#[test]
fn planted_wild_values_are_set_aside_and_nothing_else_is() {
    let (time, mut readings) = recording(true, 2);
    let planted = [
        (0, 700, 2e5),
        (1, 800, 3e-3),
        (2, 15, -400.0),
        (2, 900, 60.0),
        (2, 906, -70.0),
        (3, 1000, 40.0),
    ];
    for (channel, index, size) in planted {
        readings[channel][index] += size;
    }
    readings[2][1200] = 1e12;
    let before = readings.clone();
    let cleaning = clean::<Device>(&time, &mut readings, &NOISE, &plant());
    let count = |channel: usize| cleaning.outliers[channel].len();
    assert_eq!([count(0), count(1), count(2), count(3)], [1, 1, 4, 1]);
    for (channel, index, _) in planted.into_iter().chain([(2, 1200, 0.0)]) {
        assert!(readings[channel][index].is_nan(), "{channel} {index}");
    }
    let kept = |(after, before): (&Vec<f64>, &Vec<f64>)| {
        let pairs = after.iter().zip(before);
        pairs.filter(|(after, before)| after == before).count()
    };
    let kept: usize = readings.iter().zip(&before).map(kept).sum();
    assert_eq!(kept, 4 * time.len() - 7);
    assert!(
        cleaning.account::<Device>(&NOISE)[0]
            .starts_with("1 outlier of regulator_pressure_pa set aside, at 2.800 s")
    );
}

#[test]
fn two_wild_values_side_by_side_are_left_to_a_robust_fit() {
    let (time, mut readings) = recording(true, 3);
    readings[2][600] += 300.0;
    readings[2][601] += 300.0;
    let cleaning = clean::<Device>(&time, &mut readings, &NOISE, &plant());
    assert!(cleaning.outliers[2].is_empty());
}

#[test]
fn a_wild_value_that_no_other_sensor_can_deny_stays() {
    let (time, mut readings) = recording(true, 4);
    readings[3].fill(f64::NAN);
    readings[2][900] += 60.0;
    let cleaning = clean::<Device>(&time, &mut readings, &NOISE, &plant());
    assert!(cleaning.outliers.iter().all(Vec::is_empty));
    assert_eq!((cleaning.lost, cleaning.noise[3]), (vec![0; 4], None));
}

#[test]
fn noise_is_that_of_the_sensors_whatever_the_sheet_says() {
    for contact in [true, false] {
        let (time, mut readings) = recording(contact, 5);
        let sheet = NOISE.map(|noise| 2.0 * noise);
        let cleaning = clean::<Device>(&time, &mut readings, &sheet, &plant());
        for (found, planted) in cleaning.noise.iter().zip(NOISE) {
            let ratio = found.unwrap() / planted;
            assert!((0.85..1.15).contains(&ratio), "{ratio}");
        }
        assert_eq!(cleaning.account::<Device>(&sheet).len(), 4);
    }
}

#[test]
fn a_coarse_converter_is_noticed_and_one_below_the_noise_is_not() {
    for (share, sentences) in [(4.0, 1), (0.3, 0)] {
        let (time, mut readings) = recording(true, 8);
        let step = share * NOISE[1];
        for value in &mut readings[1] {
            *value = (*value / step).round() * step;
        }
        let cleaning = clean::<Device>(&time, &mut readings, &NOISE, &plant());
        let account = cleaning.account::<Device>(&NOISE);
        let coarse = |sentence: &&String| sentence.contains("a coarse converter");
        assert_eq!(
            account.iter().filter(coarse).count(),
            sentences,
            "{account:?}"
        );
        if share > 1.0 {
            let found = cleaning.resolution[1].unwrap();
            assert!((found / step - 1.0).abs() < 1e-6, "{found}");
        }
    }
}

#[test]
fn gaps_lost_values_and_jitter_are_counted_and_do_no_harm() {
    let (time, readings) = recording(true, 6);
    let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(7);
    let kept: Vec<usize> = (0..time.len())
        .filter(|i| !(500..530).contains(i) && i % 97 != 5)
        .collect();
    let jittered: Vec<f64> = kept
        .iter()
        .map(|i| time[*i] + 0.0008 * (random.random::<f64>() - 0.5))
        .collect();
    let mut thinned = readings.map(|values| kept.iter().map(|i| values[*i]).collect::<Vec<f64>>());
    for index in (10..kept.len()).step_by(50) {
        thinned[2][index] = f64::NAN;
    }
    let planted = 700;
    thinned[2][planted] += 200.0;
    let cleaning = clean::<Device>(&jittered, &mut thinned, &NOISE, &plant());
    assert_eq!(cleaning.gaps.len(), 17);
    assert_eq!(
        cleaning.lost,
        [0, 0, (10..kept.len()).step_by(50).count(), 0]
    );
    assert!(cleaning.jitter > 2e-4 && cleaning.jitter < 8.1e-4);
    assert_eq!(cleaning.outliers[2], [jittered[planted]]);
    assert!(
        [0, 1, 3]
            .iter()
            .all(|channel| cleaning.outliers[*channel].is_empty())
    );
    let account = cleaning.account::<Device>(&NOISE).join("; ");
    assert!(account.contains("17 gaps, the longest of 0.1"), "{account}");
    assert!(account.contains("time stamps jitter by up to"), "{account}");
}
