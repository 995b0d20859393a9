//! The choice of an experiment: programmes drawn within the limits and changed where that gains, by what each is expected to tell per second.
//!
//! ```text
//! value = (I + E + w L) / (T + c)
//! ```
//!
//! I information on which explanation is right, E on whether a law acts where no recording was (`coverage.rs`), L on how large its numbers are [nat], T length of the recording, c cost of preparing it, both in seconds; w is
//! small as long as it is open which, or whether there is such a law, and one once that is settled.

use nalgebra::DVector;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;

use super::coverage::Coverage;
use super::information::{Expected, Open, Outlook, Sensors, entropy, shares_of};
use super::limits::{LimitError, Limits};
use super::programme::Programme;
use super::ride::ArmReach;
use crate::diagnosis::fit::covariance::inverse;
use crate::diagnosis::recordings::predictability::PREDICTABLE;
use crate::plant::{PlantInputs, PlantParameters, simulate};

/// Weight of a number's information while it is open which explanation is right [1].
const BESIDE: f64 = 0.02;
/// Entropy from which it is open [nat]: two explanations of 0.98 and 0.02.
const OPEN: f64 = 0.1;
/// Draws of an explanation's numbers with which the force on the part is looked at.
const DRAWS: usize = 20;
/// The same where the numbers change the force by little, and an impact by more than a normal law has it [1].
const SPARE: f64 = 1.01;
/// Information of a programme that was made gentler, at least [nat].
const GAINS: f64 = 0.01;
/// How far other draws may be beyond these: 5.6 standard deviations where these 20 are normal [1].
const BEYOND: f64 = 3.0;
/// Duration that a programme counts for at least [s].
const SHORT: f64 = 0.2;
/// Share of that time for programmes that are drawn, the others being changed ones [1].
const DRAWN: f64 = 0.35;
/// Time of devices that is simulated for each programme asked for: that of six explanations for three seconds or so, with derivatives and draws [s].
const SIMULATED: f64 = 240.0;
/// Times that a programme which presses too hard is made gentler, and by how much more than its force asks for [1].
const GENTLER: usize = 3;
const MARGIN: f64 = 0.97;
/// Programmes that are changed further.
const KEPT: usize = 6;

/// What a choice is made by.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChoiceSettings {
    /// Programmes of three seconds that are looked at where six explanations are open; otherwise as many as take the same time.
    pub programmes: usize,
    /// Seed of what is drawn.
    pub seed: u64,
    /// What preparing a recording costs, as seconds of recording [s].
    pub preparation: f64,
}

impl Default for ChoiceSettings {
    fn default() -> Self {
        Self {
            programmes: 240,
            seed: 1,
            preparation: 15.0,
        }
    }
}

/// An experiment that was chosen.
#[derive(Debug, Clone)]
pub struct Chosen {
    /// What is done.
    pub programme: Programme,
    /// What it is expected to tell.
    pub expected: Expected,
    /// Information on whether a law acts where no recording was [nat].
    pub beyond: f64,
    /// Its value [nat/s].
    pub value: f64,
    /// What no draw of any explanation's numbers passes.
    pub extremes: Extremes,
}

/// How far an experiment goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extremes {
    /// Largest force on the part [N].
    pub force: f64,
    /// Largest stroke [m].
    pub stroke: f64,
    /// Largest share of the torque that a drive of a cell's arm may give; 0 where none is limited [1].
    pub torque_share: f64,
}

impl Extremes {
    fn combined(self, other: Self, of: fn(f64, f64) -> f64) -> Self {
        Self {
            force: of(self.force, other.force),
            stroke: of(self.stroke, other.stroke),
            torque_share: of(self.torque_share, other.torque_share),
        }
    }
}

/// Chooses an experiment; `observer` is given how many programmes' time has been simulated, and of how many in all.
///
/// # Errors
/// None that keeps the force on the part and the stroke, or whose motion can be predicted.
pub fn choose(
    open: &[Open],
    (sensors, coverage): (&Sensors, &Coverage),
    limits: &Limits,
    settings: &ChoiceSettings,
    observer: &mut dyn FnMut(usize, usize),
) -> Result<Chosen, LimitError> {
    let mut random = ChaCha8Rng::seed_from_u64(settings.seed);
    let mut choice = Choice::new(
        (open, sensors, limits),
        coverage,
        settings.preparation,
        &mut random,
    );
    for index in 0.. {
        let share = choice.simulated / (SIMULATED * settings.programmes as f64);
        let looked_at = (share.min(1.0) * settings.programmes as f64) as usize;
        observer(looked_at, settings.programmes);
        if share >= 1.0 {
            break;
        }
        let kept = &choice.kept;
        let mut programme = match kept.is_empty() || share < DRAWN {
            true => Programme::drawn(limits, &mut random),
            false => {
                let which = index % kept.len();
                kept[which].programme.changed(limits, &mut random)
            }
        };
        let mut least = 0.0;
        for _ in 0..=GENTLER {
            let force = choice.look(&programme, least);
            let Some(force) = force.filter(|_| limits.movable.set_pressure) else {
                break;
            };
            // One that presses with nothing keeps every limit, and carries no information.
            least = GAINS;
            programme = programme.gentler(MARGIN * limits.force / force);
        }
    }
    let least = choice.least;
    match choice.kept.into_iter().next() {
        Some(best) => Ok(best),
        None if least.force.is_infinite() => Err(LimitError::Unpredictable),
        None if least.stroke > limits.stroke => Err(LimitError::Stroke {
            most: limits.stroke,
            least: least.stroke,
        }),
        None if least.torque_share > 1.0 => Err(LimitError::Torque {
            percent: 100.0 * least.torque_share,
        }),
        None => Err(LimitError::Force {
            most: limits.force,
            least: least.force,
        }),
    }
}

/// A choice while it is made.
struct Choice<'a> {
    of: (&'a [Open], &'a Sensors, &'a Limits),
    /// Draws of the numbers of every explanation.
    plants: Vec<Vec<PlantParameters>>,
    /// Work of simulating each explanation and all of its draws, as so many devices without any [1].
    work: Vec<[f64; 2]>,
    is_open: bool,
    /// Weight of a number's information [1].
    weight: f64,
    preparation: f64,
    coverage: &'a Coverage,
    /// Programmes that are worth most, the best first.
    kept: Vec<Chosen>,
    /// Least of each over the programmes.
    least: Extremes,
    most_on_numbers: f64,
    /// Time of devices that was simulated [s]; of a stiffer one that of as many more.
    simulated: f64,
}

impl<'a> Choice<'a> {
    /// One of which nothing has been looked at; `preparation` is the cost of preparing a recording [s].
    fn new(
        of: (&'a [Open], &'a Sensors, &'a Limits),
        coverage: &'a Coverage,
        preparation: f64,
        random: &mut ChaCha8Rng,
    ) -> Self {
        let (open, sensors, _) = of;
        let plants: Vec<Vec<PlantParameters>> = open.iter().map(|own| draws(own, random)).collect();
        let usual = sensors.without.device.fastest_rate();
        let work = |plant: &PlantParameters| (plant.device.fastest_rate() / usual).max(1.0);
        let beyond = coverage.probability_beyond();
        let is_open = [shares_of(open), vec![beyond, 1.0 - beyond]]
            .iter()
            .any(|odds| entropy(odds) > OPEN);
        Self {
            of,
            work: (open.iter().zip(&plants))
                .map(|(own, draws)| [work(&own.plant), draws.iter().map(work).sum()])
                .collect(),
            plants,
            is_open,
            weight: if is_open { BESIDE } else { 1.0 },
            preparation,
            coverage,
            kept: Vec::new(),
            least: Extremes {
                force: f64::INFINITY,
                stroke: f64::INFINITY,
                torque_share: f64::INFINITY,
            },
            most_on_numbers: 0.0,
            simulated: 0.0,
        }
    }

    /// Counts what was simulated; a short programme is work as well.
    fn count(&mut self, duration: f64, devices: f64) {
        self.simulated += duration.max(SHORT) * devices;
    }

    /// Keeps a programme whose information is at least so much [nat], and more than that of others; gives the force on the part where only that forbids it [N].
    fn look(&mut self, programme: &Programme, least: f64) -> Option<f64> {
        let (open, sensors, limits) = self.of;
        let inputs = programme.inputs(limits);
        let outlook = Outlook::of(open, sensors, &inputs);
        let duration = programme.duration();
        let time = duration + self.preparation;
        // Each explanation with what tells whether it can be predicted, and the rig without them.
        let explanations: f64 = self.work.iter().map(|[own, _]| own).sum();
        self.count(duration, 2.0 * explanations + 1.0);
        let full = self.kept.len() == KEPT;
        // Derivatives are most of the work: of what could not be among the best they are not asked for.
        let beyond = self.coverage.information(outlook.likeliest());
        let most = outlook.most_on_which() + beyond + self.weight * self.most_on_numbers;
        if full && self.is_open && most / time <= self.kept[KEPT - 1].value {
            return None;
        }
        // What cannot be predicted carries no information, and no fit accounts for it.
        if outlook.sensitivity() > PREDICTABLE {
            return None;
        }
        let expected = outlook.expected();
        let of_one = |(own, [work, _]): (&Open, &[f64; 2])| work * own.free.len() as f64;
        let derivatives: f64 = open.iter().zip(&self.work).map(of_one).sum();
        self.count(duration, derivatives);
        self.most_on_numbers = expected.how_much.max(self.most_on_numbers);
        let gained = expected.which + beyond + self.weight * expected.how_much;
        let value = gained / time;
        if gained < least {
            return None;
        }
        if full && self.kept[KEPT - 1].value >= value {
            return None;
        }
        // Of a programme that would be kept, whether it may be done.
        let extremes = extremes_of(&self.plants, &inputs, limits.arm.as_ref());
        let draws: f64 = self.work.iter().map(|[_, draws]| draws).sum();
        self.count(duration, draws);
        self.least = self.least.combined(extremes, f64::min);
        if extremes.stroke > limits.stroke || extremes.torque_share > 1.0 {
            return None;
        }
        if extremes.force > limits.force {
            return Some(extremes.force);
        }
        self.kept.push(Chosen {
            programme: programme.clone(),
            expected,
            beyond,
            value,
            extremes,
        });
        self.kept.sort_by(|a, b| b.value.total_cmp(&a.value));
        self.kept.truncate(KEPT);
        None
    }
}

/// What no draw of an explanation's numbers passes, over all explanations: of the largest value in each of the draws that are looked at their mean, and [`BEYOND`]
/// times as far from it as the largest of them. Other draws are as many again, and half of such would pass the largest of these.
fn extremes_of(
    plants: &[Vec<PlantParameters>],
    inputs: &PlantInputs,
    arm: Option<&ArmReach>,
) -> Extremes {
    let bounds = plants.iter().map(|draws| {
        let all: Vec<Extremes> = (draws.par_iter())
            .map(|plant| largest(plant, inputs, arm))
            .collect();
        let bound = |of: fn(&Extremes) -> f64, spare: f64| {
            let mean = all.iter().map(of).sum::<f64>() / all.len() as f64;
            let largest = all.iter().map(of).fold(0.0, f64::max);
            spare * (mean + BEYOND * (largest - mean))
        };
        Extremes {
            force: bound(|own| own.force, SPARE),
            stroke: bound(|own| own.stroke, 1.0),
            torque_share: bound(|own| own.torque_share, SPARE),
        }
    });
    let none = Extremes {
        force: 0.0,
        stroke: 0.0,
        torque_share: 0.0,
    };
    bounds.fold(none, |all, own| all.combined(own, f64::max))
}

/// How far a device goes.
fn largest(plant: &PlantParameters, inputs: &PlantInputs, arm: Option<&ArmReach>) -> Extremes {
    let truth = simulate(plant, inputs).truth;
    let most = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
    let touched = (&truth.stroke[..], &truth.contact_force[..]);
    Extremes {
        force: most(&truth.contact_force),
        stroke: most(&truth.stroke),
        torque_share: arm.map_or(0.0, |arm| arm.torque_share(plant, inputs, touched)),
    }
}

/// An explanation as it was fitted, and draws of its numbers.
fn draws(open: &Open, random: &mut ChaCha8Rng) -> Vec<PlantParameters> {
    let count = open.free.len();
    let mut all = vec![open.plant.clone()];
    if open.information.nrows() != count {
        return all;
    }
    let covariance = inverse(&open.information);
    let Some(root) = covariance.cholesky().map(|c| c.l()) else {
        return all;
    };
    for _ in 1..DRAWS {
        let normal = DVector::from_fn(count, |_, _| StandardNormal.sample(random));
        let moved = &root * normal;
        let mut plant = open.plant.clone();
        for (i, (free, value)) in open.free.iter().zip(&open.values).enumerate() {
            let [back, on] = free.room(*value);
            let at = free.coordinate.of(*value) + moved[i].clamp(back, on);
            free.quantity
                .set(&mut plant, free.clamp(free.coordinate.value(at)));
        }
        all.push(plant);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::super::information::tests::sensors;
    use super::super::programme::{Part, Segment, Surface};
    use super::*;
    use crate::diagnosis::fit::free::free_of;
    use crate::diagnosis::recordings::evidence::Evidence;
    use crate::diagnosis::test_evidence::{evidence, evidence_of, plant};
    use crate::effects::CATALOGUE;
    use crate::plant::OperatingLimits;
    use nalgebra::DMatrix;

    fn limits() -> Limits {
        Limits {
            set_pressure_rate: 1e8,
            duration: 4.0,
            ..Limits::of_tests()
        }
    }

    fn pair(change: impl Fn(&mut PlantParameters)) -> [Open; 2] {
        let mut other = plant();
        change(&mut other);
        [("as it is", plant()), ("changed", other)].map(|(name, plant)| Open {
            name: name.to_owned(),
            probability: 0.5,
            plant,
            free: Vec::new(),
            values: Vec::new(),
            information: DMatrix::zeros(0, 0),
            of_effects: Vec::new(),
        })
    }

    fn seeded() -> ChaCha8Rng {
        ChaCha8Rng::seed_from_u64(1)
    }

    fn settings(programmes: usize) -> ChoiceSettings {
        ChoiceSettings {
            programmes,
            ..ChoiceSettings::default()
        }
    }

    fn chosen(open: &[Open], limits: &Limits, programmes: usize) -> Result<Chosen, LimitError> {
        choose(
            open,
            (&sensors(), &Coverage::default()),
            limits,
            &settings(programmes),
            &mut |_, _| (),
        )
    }

    /// Only a valve that reverses shows that it does so late.
    #[test]
    fn a_late_valve_is_sought_by_reversing_it() {
        let late = pair(|plant| plant.device.switching_delay = 2e-4);
        let found = chosen(&late, &limits(), 9).unwrap();
        let extends: Vec<bool> = found.programme.segments.iter().map(|s| s.extends).collect();
        assert!(
            extends.windows(2).any(|two| two[0] != two[1]),
            "{extends:?}"
        );
        assert!(found.expected.which > 0.3, "{}", found.expected.which);
        let left_alone = Limits {
            retracts: false,
            ..limits()
        };
        let found = chosen(&late, &left_alone, 3).unwrap();
        assert!(found.expected.which < 1e-9, "{}", found.expected.which);
    }

    /// An end stop thirty times as damped took nine tenths of a choice: its sub-steps were not counted.
    #[test]
    fn a_stiff_device_is_as_much_more_work() {
        let stiff = pair(|plant| plant.device.end_stop.damping *= 30.0);
        let (sensors, limits, coverage) = (sensors(), limits(), Coverage::default());
        let of = (&stiff[..], &sensors, &limits);
        let choice = Choice::new(of, &coverage, 0.0, &mut seeded());
        let device = &plant().device;
        let stop = &device.end_stop;
        let swing = (stop.stiffness / device.moving_mass).sqrt();
        let damped = |times: f64| (times * stop.damping / device.moving_mass).max(swing);
        let expected = damped(30.0) / damped(1.0);
        assert!(expected > 10.0, "{expected}");
        let [usual, own] = [0, 1].map(|place| choice.work[place]);
        assert_eq!(usual[0], 1.0);
        assert!((own[0] / expected - 1.0).abs() < 1e-9, "{own:?}");
    }

    #[test]
    fn the_same_seed_chooses_the_same_and_more_programmes_no_worse() {
        let pair = pair(|plant| plant.device.moving_mass *= 1.002);
        let [few, again, many] = [3, 3, 12].map(|count| chosen(&pair, &limits(), count).unwrap());
        assert_eq!(few.programme, again.programme);
        assert!(
            many.value >= 0.9 * few.value,
            "{} {}",
            many.value,
            few.value
        );
    }

    /// Where no experiment distinguishes the explanations and a law is possible beyond the recordings, the experiment goes there.
    #[test]
    fn where_no_recording_was_is_where_an_experiment_goes() {
        let same = pair(|_| ());
        let evidence = evidence_of(&plant(), vec![vec![0.3e5; 126]]);
        let stated = OperatingLimits {
            set_pressure: Some(3e5),
            ..OperatingLimits::default()
        };
        let found = evidence.predict(&plant(), false, None);
        let coverage = Coverage::of(&stated, &evidence, &found);
        let go = |coverage: &Coverage| {
            let of = (&sensors(), coverage);
            choose(&same, of, &limits(), &settings(6), &mut |_, _| ()).unwrap()
        };
        let visits = go(&coverage);
        assert!(visits.beyond > 0.2, "{}", visits.beyond);
        let inputs = visits.programme.inputs(&limits());
        let pressures = simulate(&plant(), &inputs).truth.pressures[0].clone();
        let largest = pressures.into_iter().fold(0.0, f64::max) - plant().device.gas.atmosphere;
        assert!(largest > 2e5, "{largest}");
        assert_eq!(go(&Coverage::default()).beyond, 0.0);
    }

    /// What the part may bear is kept by every draw; where nothing keeps it, that is said with the least force found.
    #[test]
    fn the_part_is_spared() {
        let gained = pair(|plant| plant.sensors.force_gain = 1.05);
        let gentle = Limits {
            force: 150.0,
            ..limits()
        };
        let found = chosen(&gained, &gentle, 9).unwrap();
        assert!(found.extremes.force <= 150.0, "{}", found.extremes.force);
        let surface = Limits {
            force: 1e-3,
            without_workpiece: false,
            set_pressure: [2e5, 3e5],
            retracts: false,
            ..limits()
        };
        let error = chosen(&gained, &surface, 2).unwrap_err().to_string();
        assert!(
            error.contains("force_n") && error.contains("[limits]"),
            "{error}"
        );
    }

    /// A programme in which the tool bounces unpredictably is left out, whatever its readings would distinguish; one in which it follows the surface is kept.
    #[test]
    fn what_cannot_be_predicted_is_left_out() {
        let gained = pair(|plant| plant.sensors.force_gain = 1.05);
        let (sensors, limits) = (sensors(), limits());
        let kept = |set_pressure: f64, peak_to_peak: f64, frequency: f64| {
            let programme = Programme {
                segments: vec![Segment {
                    duration: 4.0,
                    set_pressure: [set_pressure; 2],
                    extends: true,
                }],
                part: Part::Surface(Surface {
                    position: 0.03,
                    peak_to_peak,
                    frequency,
                    start: 0.0,
                }),
            };
            let none = Coverage::default();
            let mut choice = Choice::new((&gained, &sensors, &limits), &none, 15.0, &mut seeded());
            choice.look(&programme, 0.0);
            (choice.kept.len(), choice.least.force)
        };
        let (count, force) = kept(2e5, 0.005, 0.5);
        assert_eq!(count, 1, "{force}");
        assert_eq!(kept(4e4, 0.008, 15.0), (0, f64::INFINITY));
    }

    /// The stroke is kept where a surface can stop the tool before it, and where nothing can, that is said.
    #[test]
    fn the_stroke_is_kept() {
        let gained = pair(|plant| plant.sensors.force_gain = 1.05);
        let short = Limits {
            stroke: 0.03,
            ..limits()
        };
        let found = chosen(&gained, &short, 9).unwrap();
        assert!(found.extremes.stroke <= 0.03, "{:?}", found.extremes);
        assert!(found.programme.surface().is_some());
        let open = Limits {
            surface: None,
            retracts: false,
            set_pressure: [2e5, 3e5],
            ..short
        };
        let error = chosen(&gained, &open, 2).unwrap_err().to_string();
        assert!(error.contains("`stroke_m` = 0.0300 m"), "{error}");
    }

    /// Experiments of this many seeds; `IDC_EXPERIMENTS` asks for others.
    const EXPERIMENTS: usize = 12;

    /// Other draws than those that the choice looked at, 20 of each explanation, in experiments whose limit is below what most would press with: none is beyond the force
    /// that the choice states.
    #[test]
    fn other_draws_keep_the_force_too() {
        let asked = std::env::var("IDC_EXPERIMENTS").ok();
        let count = asked.map_or(EXPERIMENTS, |text| text.parse().unwrap());
        let recorded = evidence(1);
        let open = [
            "coulomb_viscous_friction",
            "external_leakage",
            "contact_stiffness_error",
        ]
        .map(|name| known_about(name, &recorded));
        let gentle = Limits {
            force: 120.0,
            without_workpiece: false,
            ..limits()
        };
        let (mut passed, mut near) = (0, 0);
        for seed in 0..count as u64 {
            let settings = ChoiceSettings {
                seed,
                ..settings(3)
            };
            let Ok(found) = choose(
                &open,
                (&sensors(), &Coverage::default()),
                &gentle,
                &settings,
                &mut |_, _| (),
            ) else {
                continue;
            };
            let inputs = found.programme.inputs(&gentle);
            let mut random = ChaCha8Rng::seed_from_u64(1_000_000 + seed);
            let forces: Vec<f64> = (open.iter().flat_map(|own| draws(own, &mut random)))
                .map(|plant| super::largest(&plant, &inputs, None).force)
                .collect();
            let largest = forces.into_iter().fold(0.0, f64::max);
            assert!(found.extremes.force <= gentle.force);
            passed += usize::from(largest > found.extremes.force);
            near += usize::from(largest > 0.8 * gentle.force);
        }
        assert_eq!(passed, 0, "of {count}");
        assert!(near > count / 4, "{near} of {count} come near the limit");
    }

    /// An effect at its usual size, with its numbers free and what a recording knows of them.
    fn known_about(name: &str, recorded: &Evidence) -> Open {
        let effect = CATALOGUE.iter().find(|own| own.name == name).unwrap();
        let usual = effect.usual(&plant());
        let free = free_of(effect, &plant(), &usual);
        let mut own = plant();
        for (free, value) in free.iter().zip(&usual) {
            free.quantity.set(&mut own, *value);
        }
        let open = Open {
            name: name.to_owned(),
            probability: 1.0 / 3.0,
            plant: own,
            of_effects: (0..free.len()).collect(),
            information: DMatrix::zeros(free.len(), free.len()),
            free,
            values: usual,
        };
        open.informed_by(recorded, &sensors())
    }
}
