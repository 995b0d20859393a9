//! Intervals of a diagnosis hold what they say: fits to devices of the laboratory, by the product's own fit and its own intervals, hold the truth in 95 of 100.

use idc_cell::diagnosis::answer::estimate::estimates;
use idc_cell::diagnosis::fit::cross_validation::{Depth, left_out};
use idc_cell::diagnosis::fit::free::{Free, free_of};
use idc_cell::diagnosis::fit::hypothesis::Hypothesis;
use idc_cell::diagnosis::fit::{FINEST, Limit, fit};
use idc_cell::diagnosis::recordings::evidence::{Evidence, Measured};
use idc_cell::diagnosis::search::ranking::Ranked;
use idc_cell::effects::{Effect, every};
use idc_cell::laboratory::{
    Concealed, Conditions, LaboratoryRig, LaboratoryTrajectory, Programme, Recipe, run,
};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;
use rayon::prelude::*;

use crate::laboratory::{inputs_of, plant_of};

/// Effects, small ones: what is added to an interval for the idealisation of a law is a share of its effect, and would hide that the rest is too narrow.
const EFFECTS: [(&str, f64); 3] = [
    ("force_sensor_gain_error", 0.03),
    ("force_sensor_bias_drift", 0.05),
    ("stroke_sensor_gain_error", 0.02),
];
/// Devices, and draws of the noise of each.
const DEVICES: u64 = 20;
const DRAWS: u64 = 10;
/// Recordings of a device.
const RECORDINGS: usize = 3;

/// A device of the laboratory with what was recorded of it but for the noise.
struct Device {
    rig: LaboratoryRig,
    concealed: Concealed,
    recorded: Vec<(Programme, LaboratoryTrajectory)>,
}

fn device(seed: u64) -> Device {
    let recipe = Recipe {
        name: String::new(),
        seed,
        effects: EFFECTS.to_vec(),
        law: None,
        duration: 3.0,
        conditions: Conditions::default(),
    };
    let (rig, concealed, programmes) = recipe.reality().unwrap();
    let recorded = programmes[..RECORDINGS].iter().map(|programme| {
        let trajectory = run(&rig, &concealed, programme).unwrap();
        (programme.clone(), trajectory)
    });
    Device {
        recorded: recorded.collect(),
        rig,
        concealed,
    }
}

/// A recording of a device as it is measured.
fn measured(
    (programme, trajectory): &(Programme, LaboratoryTrajectory),
    noise: [f64; 4],
    random: &mut ChaCha8Rng,
) -> Measured {
    Measured {
        name: programme.name.clone(),
        inputs: inputs_of(programme),
        readings: std::array::from_fn(|channel| {
            let truth = trajectory.readings[channel].iter();
            truth
                .map(|value| value + noise[channel] * random.sample::<f64, _>(StandardNormal))
                .collect()
        }),
        free: programme.surface.is_none(),
    }
}

/// Of each number of the effects whether its interval holds the truth, in a device with a draw of noise.
fn held(device: &Device, seed: u64) -> Vec<(&'static str, bool)> {
    let nominal = plant_of(&device.rig);
    let noise = device.rig.noise;
    let random = &mut ChaCha8Rng::seed_from_u64(seed);
    let recordings = device.recorded.iter();
    let evidence = Evidence::new(
        recordings.map(|own| measured(own, noise, random)).collect(),
        noise,
    );
    let effects: Vec<&'static Effect> = EFFECTS
        .iter()
        .map(|(name, _)| every().find(|effect| effect.name == *name).unwrap())
        .collect();
    let free: Vec<Free> = effects
        .iter()
        .flat_map(|effect| {
            let parameters = effect.parameters(&nominal);
            let start: Vec<f64> = parameters
                .iter()
                .map(|p| p.quantity.get(&nominal))
                .collect();
            free_of(effect, &nominal, &start)
        })
        .collect();
    let fit = fit(
        &evidence,
        (&nominal, None),
        (&free, &[]),
        FINEST,
        Limit::FULL,
    );
    let found = Ranked {
        left_out: left_out(&evidence, &fit, Depth::OneStep),
        hypothesis: Hypothesis {
            effects,
            fit,
            depends_on: Vec::new(),
        },
        score: 0.0,
        odds: 1.0,
        probability: 1.0,
    };
    assert!(found.left_out.is_some());
    let concealed = &device.concealed;
    let numbers = estimates(&nominal, &[found], &evidence).effects;
    let numbers = numbers.iter().flat_map(|(_, numbers)| numbers);
    let truths = [
        concealed.force_gain,
        concealed.force_bias[0],
        concealed.force_bias[1],
        concealed.stroke_gain,
    ];
    let pairs = numbers.zip(truths);
    pairs
        .map(|(number, truth)| {
            let [low, high] = number.interval;
            (number.name, low <= truth && truth <= high)
        })
        .collect()
}

/// Catches: intervals that are too narrow or too wide by a third or more, which no single diagnosis shows.
#[test]
fn intervals_hold_the_truth_in_95_fits_of_100() {
    let devices: Vec<Device> = (0..DEVICES)
        .into_par_iter()
        .map(|d| device(900 + d))
        .collect();
    let fits: Vec<(u64, u64)> = (0..DEVICES)
        .flat_map(|device| (0..DRAWS).map(move |draw| (device, draw)))
        .collect();
    let all: Vec<Vec<(&str, bool)>> = fits
        .par_iter()
        .map(|(device, draw)| held(&devices[*device as usize], 100 * device + draw))
        .collect();
    assert_eq!(all.len(), 200);
    for number in 0..all[0].len() {
        let name = all[0][number].0;
        let share = all.iter().filter(|fit| fit[number].1).count() as f64 / all.len() as f64;
        println!("{name}: {share}");
        // Of 200 with 95 % each, 0.03 is two standard deviations; half as wide holds 67 %, twice as wide 99.99 %.
        assert!((0.90..0.995).contains(&share), "{name}: {share}");
    }
}
