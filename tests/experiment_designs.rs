//! The peer of a chosen experiment where it is known what is missing: a D-optimal multisine, as identification toolboxes plan it, within the same limits.
//!
//! ```text
//! u(t) = u0 + sum over k of a_k sin(2 pi f_k t + phi_k),   k = 1 .. 12
//! ```
//!
//! u set pressure, held for 50 ms at a time; place of the surface; and what the valve extends by where it is positive. The three have the frequencies f in common, and
//! offsets u0, amplitudes a and phases phi of their own: 87 numbers, by CMA-ES (Hansen, arXiv:1604.00772) on the information on the numbers of the effects.
//! Source: J. Swevers, C. Ganseman et al., Optimal robot excitation and identification, IEEE Trans. Robot. Autom. 13, 1997.

use std::convert::Infallible;
use std::f64::consts::TAU;
use std::sync::Mutex;

use basin::{
    BoundedCmaEs, BoxBounds, ConstraintDescription, ConstraintSet, Constraints, CostFunction,
    DenseMatrix, Executor, PopulationProgress,
};
use nalgebra::DMatrix;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use idc_cell::diagnosis::experiment::choice::{ChoiceSettings, choose};
use idc_cell::diagnosis::experiment::coverage::Coverage;
use idc_cell::diagnosis::experiment::information::{Open, Outlook, Sensors};
use idc_cell::diagnosis::experiment::limits::{Limits, Movable};
use idc_cell::diagnosis::experiment::programme::HOLD;
use idc_cell::diagnosis::fit::free::{Free, Prior, free_of};
use idc_cell::diagnosis::recordings::evidence::{Evidence, Measured};
use idc_cell::effects::{CATALOGUE, Coordinate, Effect};
use idc_cell::plant::registry::{self, Number};
use idc_cell::plant::{ContactParameters, InitialState, PlantInputs, PlantParameters, simulate};

/// Sines.
const SINES: usize = 12;
/// Numbers: frequencies; of each of three inputs an offset, amplitudes and phases.
const NUMBERS: usize = SINES + 3 * (1 + 2 * SINES);
/// Frequencies [Hz].
const FREQUENCIES: [f64; 2] = [0.1, 12.0];
/// Generations after which it has converged if the last quarter of them gained nothing to speak of, and members of each.
const GENERATIONS: u64 = 120;
const MEMBERS: usize = 20;
/// Length of the experiments that are compared [s].
const DURATION: f64 = 2.0;
/// Numbers of the device that are known to their tolerance only, and that [1].
const TOLERATED: [(&Number, f64); 5] = [
    (&registry::MOVING_MASS, 0.01),
    (&registry::SUPPLY_ORIFICE, 0.05),
    (&registry::EXHAUST_ORIFICE, 0.05),
    (&registry::REGULATOR_TIME_CONSTANT, 0.1),
    (&registry::CONTACT_STIFFNESS, 0.1),
];

/// Sum of the sines of one input at each time, its amplitudes as shares of one.
fn wave(numbers: &[f64], frequencies: &[f64], time: &[f64]) -> Vec<f64> {
    let sines = frequencies.iter().zip(numbers.chunks(2));
    let sines: Vec<_> = sines.collect();
    let at = |t: &f64| {
        let own = sines.iter().map(|(frequency, of)| {
            let rate = TAU * FREQUENCIES[0] * (FREQUENCIES[1] / FREQUENCIES[0]).powf(**frequency);
            of[0] * (rate * t + TAU * of[1]).sin()
        });
        own.sum::<f64>()
    };
    time.iter().map(at).collect()
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |most: f64, value| most.max(value.abs()))
}

/// A multisine by its numbers between 0 and 1, within limits.
fn inputs(numbers: &[f64], limits: &Limits, with_surface: bool) -> PlantInputs {
    let (frequencies, rest) = numbers.split_at(SINES);
    let [pressure, surface, valve] = [0, 1, 2].map(|input| {
        let from = input * (1 + 2 * SINES);
        (rest[from], &rest[from + 1..from + 1 + 2 * SINES])
    });
    let holds: Vec<f64> = (0..(DURATION / HOLD).ceil() as usize)
        .map(|i| i as f64 * HOLD)
        .collect();
    let held = |(offset, own)| -> Vec<f64> {
        let waves = wave(own, frequencies, &holds);
        waves.iter().map(|own| offset + own).collect()
    };
    let [least, most] = limits.set_pressure;
    let mut last = 0.0;
    let step = limits.set_pressure_rate * HOLD;
    let pressures: Vec<f64> = (held(pressure).iter())
        .map(|share| {
            let asked = least + (most - least) * share.clamp(0.0, 1.0);
            last += (asked - last).clamp(-step, step);
            last
        })
        .collect();
    // The offset is one where it always extends.
    let extends: Vec<bool> = (held((3.0 * valve.0 - 1.0, valve.1)).iter())
        .map(|own| !limits.retracts || *own >= 0.0)
        .collect();
    let mut made = recording(DURATION, &|t| {
        let at = ((t / HOLD + 1e-9) as usize).min(holds.len() - 1);
        (pressures[at], extends[at], f64::NAN)
    });
    if let Some(range) = limits.surface.filter(|_| with_surface) {
        made.surface = places(surface, frequencies, &made.time, (range, limits));
    }
    made
}

/// Places of the surface [m]: its motion as large as it is asked for or as its range, its speed and its acceleration allow.
fn places(
    (offset, own): (f64, &[f64]),
    frequencies: &[f64],
    time: &[f64],
    ([least, most], limits): ([f64; 2], &Limits),
) -> Vec<f64> {
    let middle = least + (most - least) * offset;
    let room = (middle - least).min(most - middle);
    let half = 0.5 * (most - least);
    let motion: Vec<f64> = (wave(own, frequencies, time).iter())
        .map(|w| half * w)
        .collect();
    let step = time[1] - time[0];
    let speed = largest(motion.windows(2).map(|w| (w[1] - w[0]) / step));
    let acceleration = largest(
        motion
            .windows(3)
            .map(|w| (w[2] - 2.0 * w[1] + w[0]) / (step * step)),
    );
    let [fastest, hardest] = limits.surface_motion;
    let shares = [
        room / largest(motion.iter().copied()),
        fastest / speed,
        hardest / acceleration,
    ];
    let share = shares.into_iter().fold(1.0, f64::min);
    motion.iter().map(|own| middle + share * own).collect()
}

/// What a multisine is optimised for.
struct Problem<'a> {
    open: &'a Open,
    sensors: &'a Sensors,
    limits: &'a Limits,
    with_surface: bool,
    lower: Vec<f64>,
    upper: Vec<f64>,
    /// Costs in the order of their evaluation, those of a generation in any.
    costs: &'a Mutex<Vec<f64>>,
}

impl Problem<'_> {
    fn information(&self, inputs: &PlantInputs) -> f64 {
        let open = std::slice::from_ref(self.open);
        Outlook::of(open, self.sensors, inputs).expected().how_much
    }

    fn force(&self, inputs: &PlantInputs) -> f64 {
        let truth = simulate(&self.open.plant, inputs).truth;
        largest(truth.contact_force.into_iter())
    }
}

impl CostFunction for Problem<'_> {
    type Param = Vec<f64>;
    type Output = f64;
    type Error = Infallible;

    fn cost(&self, numbers: &Vec<f64>) -> Result<f64, Infallible> {
        let inputs = inputs(numbers, self.limits, self.with_surface);
        let force = self.force(&inputs);
        // What presses too hard is worth less than anything that does not.
        let cost = match force > self.limits.force {
            true => force / self.limits.force,
            false => -self.information(&inputs),
        };
        self.costs.lock().unwrap().push(cost);
        Ok(cost)
    }
}

impl Constraints for Problem<'_> {
    type Set = ConstraintSet<BoxBounds<Vec<f64>>>;

    fn constraints(&self) -> <Self::Set as ConstraintDescription>::Borrowed<'_> {
        let bounds = BoxBounds::new(Some(&self.lower), Some(&self.upper));
        ConstraintSet::new().with_bounds(bounds)
    }
}

/// Numbers of a multisine at random, whose amplitudes come to about the range of its inputs.
fn drawn(random: &mut ChaCha8Rng) -> Vec<f64> {
    let amplitude = random.random_range(0.05..0.4);
    let mut numbers: Vec<f64> = (0..NUMBERS).map(|_| random.random()).collect();
    for input in 0..3 {
        for sine in 0..SINES {
            numbers[SINES + input * (1 + 2 * SINES) + 1 + 2 * sine] *= amplitude;
        }
    }
    numbers
}

/// The best multisine, and its information [nat] at three quarters of the generations and at their end: on a surface or without one, as the best of those drawn is.
fn optimal(
    (open, sensors, limits): (&Open, &Sensors, &Limits),
    seed: u64,
) -> (PlantInputs, [f64; 2]) {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let costs = Mutex::new(Vec::new());
    let problem = |with_surface| Problem {
        open,
        sensors,
        limits,
        with_surface,
        lower: vec![0.0; NUMBERS],
        upper: vec![1.0; NUMBERS],
        costs: &costs,
    };
    let mut starts: Vec<(f64, Vec<f64>, bool)> = Vec::new();
    for index in 0..8 * MEMBERS {
        let with_surface = index % 2 == 0;
        let numbers = drawn(&mut random);
        let cost = problem(with_surface).cost(&numbers).unwrap();
        starts.push((cost, numbers, with_surface));
    }
    starts.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (_, start, with_surface) = starts.swap_remove(0);
    costs.lock().unwrap().clear();
    let solver = BoundedCmaEs::<Vec<f64>, DenseMatrix>::new(seed, 0.1).with_lambda(MEMBERS);
    let progress = PopulationProgress::from_point(start);
    let result = Executor::new(problem(with_surface), solver, progress)
        .max_iter(GENERATIONS)
        .run()
        .unwrap();
    let (numbers, cost) = result.state.best().unwrap();
    let costs = costs.lock().unwrap();
    let before = costs[..costs.len() * 3 / 4].iter().copied();
    let before = -before.fold(f64::INFINITY, f64::min);
    (inputs(numbers, limits, with_surface), [before, -cost])
}

/// Set pressure, whether the valve extends, and the surface at a time.
type Inputs<'a> = &'a dyn Fn(f64) -> (f64, bool, f64);

/// A recording's inputs.
fn recording(duration: f64, at: Inputs<'_>) -> PlantInputs {
    let count = (duration / limits().step).round() as usize + 1;
    let time: Vec<f64> = (0..count).map(|i| i as f64 * limits().step).collect();
    let values: Vec<_> = time.iter().map(|t| at(*t)).collect();
    PlantInputs {
        set_pressure: values.iter().map(|v| v.0).collect(),
        extends: values.iter().map(|v| v.1).collect(),
        surface: values.iter().map(|v| v.2).collect(),
        cell: None,
        motion: None,
        initial: InitialState::AtRest,
        place: 0,
        time,
    }
}

/// Stairs and a ride on the surface, and a cycle without it, a third of the time each.
fn fixed(limits: &Limits) -> Vec<PlantInputs> {
    let each = DURATION / 3.0;
    let [least, most] = limits.surface.unwrap();
    let (middle, reach) = (0.5 * (least + most), 0.25 * (most - least));
    let top = limits.set_pressure[1];
    let stairs: Inputs<'_> = &|t| {
        let step = (6.0 * t / each).floor();
        (
            top * (1.0 - (step - 2.0).abs() / 3.0).max(0.1),
            true,
            middle,
        )
    };
    let ride: Inputs<'_> = &|t| {
        let motion = reach * ((TAU * 1.5 * t).sin() + 0.3 * (TAU * 5.0 * t).sin()) / 1.3;
        (0.6 * top, true, middle + motion)
    };
    let cycle: Inputs<'_> = &|t| (0.8 * top, ((t / 0.25) as usize).is_multiple_of(2), f64::NAN);
    [stairs, ride, cycle].map(|at| recording(each, at)).to_vec()
}

/// A device with an effect at its usual size, what it leaves free with the device's tolerated numbers, and what half a second of stairs knows of that.
fn known_about(effect: &Effect, random: &mut ChaCha8Rng) -> Open {
    let mut own = plant();
    let mut tolerated = Vec::new();
    for (number, tolerance) in TOLERATED {
        let quantity = number.quantity();
        let mean = quantity.get(&own) * random.random_range(0.8..1.25);
        quantity.set(&mut own, mean);
        tolerated.push(Free {
            quantity,
            start: mean,
            coordinate: Coordinate::Logarithmic,
            bounds: [0.4 * mean, 2.5 * mean],
            prior: Prior::Normal {
                mean,
                deviation: tolerance * mean,
            },
        });
    }
    let usual = effect.usual(&own);
    let mut free = free_of(effect, &own, &usual);
    let of_effects = free.len();
    for (free, value) in free.iter().zip(&usual) {
        free.quantity.set(&mut own, *value);
    }
    tolerated.retain(|f| {
        !free
            .iter()
            .any(|of_effect| of_effect.quantity.is(&f.quantity))
    });
    free.extend(tolerated);
    let values: Vec<f64> = free.iter().map(|f| f.quantity.get(&own)).collect();
    let known = recorded(&own, [first()].into_iter());
    let open = Open {
        name: effect.name.to_owned(),
        probability: 1.0,
        plant: own,
        of_effects: (0..of_effects).collect(),
        information: DMatrix::zeros(free.len(), free.len()),
        values,
        free,
    };
    open.informed_by(&known, &sensors())
}

/// Half-widths of the 95 % intervals of the effects' numbers in the fit's coordinates after the first recording and some more: the logarithm of their geometric mean.
fn half_width(open: &Open, more: &[PlantInputs]) -> f64 {
    let all = [first()].into_iter().chain(more.iter().cloned());
    let known = open
        .clone()
        .informed_by(&recorded(&open.plant, all), &sensors());
    let covariance = known.information.try_inverse().unwrap();
    let widths = (open.of_effects.iter()).map(|i| (1.96 * covariance[(*i, *i)].sqrt()).ln());
    widths.sum::<f64>() / open.of_effects.len() as f64
}

/// A device on a stiff contact.
fn plant() -> PlantParameters {
    PlantParameters {
        gravity_along_extension: -9.81,
        contact: ContactParameters::linear(2e5, 400.0),
        ..PlantParameters::default()
    }
}

/// Noise of laboratory devices.
const NOISE: [f64; 4] = [400.0, 2e-5, 0.8, 0.15];

fn sensors() -> Sensors {
    Sensors {
        without: plant(),
        noise: NOISE,
        variance: [1.0; 4],
        probe: None,
    }
}

/// Limits of a bench on which everything may be moved.
fn limits() -> Limits {
    Limits {
        movable: Movable::ALL,
        step: 0.004,
        set_pressure: [0.0, 3e5],
        set_pressure_rate: 2e6,
        retracts: true,
        surface: Some([0.012, 0.031]),
        surface_motion: [0.2, 3.0],
        without_workpiece: true,
        stroke: f64::INFINITY,
        force: f64::INFINITY,
        duration: DURATION,
        arm: None,
    }
}

/// Half a second of stairs on a surface.
fn first() -> PlantInputs {
    recording(0.5, &|t| (1e5 + 1e5 * (t / 0.17).floor(), true, 0.02))
}

/// Recordings of a device.
fn recorded(plant: &PlantParameters, inputs: impl Iterator<Item = PlantInputs>) -> Evidence {
    let measured = inputs.map(|inputs| Measured {
        name: String::new(),
        readings: simulate(plant, &inputs).readings,
        inputs,
        free: false,
    });
    Evidence::new(measured.collect(), NOISE)
}

/// Effects of numbers without a phase, one after the other.
fn cases(count: usize) -> Vec<Open> {
    let mut random = ChaCha8Rng::seed_from_u64(46);
    let effects = (CATALOGUE.iter())
        .filter(|effect| effect.phase.is_none() && !effect.usual(&plant()).is_empty());
    (effects.cycle().take(count))
        .map(|effect| known_about(effect, &mut random))
        .collect()
}

#[test]
fn a_multisine_keeps_the_limits() {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let limits = limits();
    let (mut moved, mut reversed) = (0.0f64, false);
    for _ in 0..50 {
        let made = inputs(&drawn(&mut random), &limits, true);
        let [least, most] = limits.set_pressure;
        let kept = |p: &f64| (least..=most).contains(p);
        assert!(made.set_pressure.iter().all(kept));
        let holds: Vec<f64> = made.set_pressure.iter().copied().step_by(13).collect();
        let rates = holds
            .windows(2)
            .map(|w| (w[1] - w[0]) / (13.0 * limits.step));
        assert!(largest(rates) <= 2.0 * limits.set_pressure_rate);
        let [near, far] = limits.surface.unwrap();
        let within = |x: &f64| (near - 1e-12..=far + 1e-12).contains(x);
        assert!(made.surface.iter().all(within));
        let speeds: Vec<f64> = (made.surface.windows(2))
            .map(|w| (w[1] - w[0]) / limits.step)
            .collect();
        let speed = largest(speeds.iter().copied());
        assert!(speed <= 1.001 * limits.surface_motion[0]);
        let accelerations = speeds.windows(2).map(|w| (w[1] - w[0]) / limits.step);
        assert!(largest(accelerations) <= 1.001 * limits.surface_motion[1]);
        moved = moved.max(speed);
        reversed |= made.extends.iter().any(|extends| !extends);
    }
    // The limits are reached.
    assert!(moved > 0.05 && reversed, "{moved} m/s");
}

#[test]
#[ignore = "an hour: optimises 30 multisines"]
fn numbers_are_known_as_well_as_by_a_d_optimal_multisine() {
    let count = std::env::var("IDC_CASES").map_or(30, |text| text.parse().unwrap());
    let [mut of_fixed, mut of_multisine] = [0.0; 2];
    for (place, open) in cases(count).iter().enumerate() {
        let mut limits = limits();
        let fixed = fixed(&limits);
        let forces = fixed.iter().map(|inputs| {
            let truth = simulate(&open.plant, inputs).truth;
            largest(truth.contact_force.into_iter())
        });
        limits.force = 1.1 * forces.fold(0.0, f64::max);
        let one = std::slice::from_ref(open);
        let settings = ChoiceSettings::default();
        let chosen = choose(
            one,
            (&sensors(), &Coverage::default()),
            &limits,
            &settings,
            &mut |_, _| (),
        )
        .unwrap();
        let (multisine, [before, at_end]) = optimal((open, &sensors(), &limits), place as u64);
        let of_own = half_width(open, &[chosen.programme.inputs(&limits)]);
        let by_fixed = of_own - half_width(open, &fixed);
        let by_multisine = of_own - half_width(open, std::slice::from_ref(&multisine));
        println!(
            "{}: {:.2} of the fixed programme's, {:.2} of the multisine's; {:.1} s of {:.3} nat, the multisine {before:.3} and {at_end:.3} nat",
            open.name,
            by_fixed.exp(),
            by_multisine.exp(),
            chosen.programme.duration(),
            chosen.expected.how_much,
        );
        of_fixed += by_fixed / count as f64;
        of_multisine += by_multisine / count as f64;
    }
    let [of_fixed, of_multisine] = [of_fixed, of_multisine].map(f64::exp);
    println!(
        "geometric means: {of_fixed:.3} of the fixed programme's, {of_multisine:.3} of the multisine's"
    );
    assert!(of_fixed < 0.7, "{of_fixed}");
    assert!(of_multisine < 1.05, "{of_multisine}");
}
