//! Laws drawn at random: a place, a form, variables that make sense there, and a size at which it shows.
//!
//! Three things are asked of a draw, else another is drawn. It does not wreck the device. No listed effect of its place is as good: of what acts along the
//! recordings at least a share is left beside all that the list has there. And no other variable tells as much of it:
//!
//! ```text
//! eta^2 = variance of the means of what acts in classes of another variable, over its variance          (Pearson's correlation ratio)
//! ```

use nalgebra::{DMatrix, DVector};
use rand::Rng;
use rand::seq::IndexedRandom;
use rand_chacha::ChaCha8Rng;

use super::case::Recipe;
use super::conditions::Conditions;
use super::draw::stream;
use super::effects::EFFECTS;
use super::law::{AT_ONCE, Driver, Form, Law, Place};
use super::rig::LaboratoryRig;
use super::sensors::between;
use super::trajectory::{LaboratoryError, LaboratoryTrajectory};
use super::visibility::Eye;

/// Visibility of a law, from weak but clear to strong, every order of magnitude alike [standard deviations].
const SHOWS: [f64; 2] = [60.0, 800.0];
/// Departure from what was aimed at [1].
const NEAR: f64 = 0.25;
/// Visibility of a listed effect beside it at least [standard deviations].
const BESIDE_SHOWS: f64 = 60.0;
/// Share of the largest that is plausible of a listed effect beside it [1].
const BESIDE: [f64; 2] = [0.3, 0.7];
/// Share of cases with a listed effect beside the law [1].
const WITH_OTHER: f64 = 1.0 / 3.0;
/// Share of what acts that no listed effect may take up at least [1].
const OWN: f64 = 0.15;
/// Visibility of that part at least [standard deviations].
const OWN_SHOWS: f64 = 40.0;
/// Correlation ratio from which another variable does as well [1].
const ALIKE: f64 = 0.97;
/// Classes of another variable.
const CLASSES: usize = 40;
/// Draws before another place and variable are chosen.
const OF_ONE_CHOICE: u64 = 40;
/// Draws before a device is given up.
const DRAWS: u64 = 400;
/// Share of the time in contact, and of the stroke moved through, that is left of a device that is not wrecked [1].
const LEFT: f64 = 0.6;

/// A kind of form.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Proportion,
    Power,
    Beyond,
    Window,
    Bump,
    Sine,
    Saturating,
    Step,
    Ramp,
    Approach,
    Spline,
    /// In proportion to two variables.
    Product(Driver),
    /// In proportion to, or saturating with, what lags behind the variable.
    Memory,
}

use Kind::{
    Approach, Beyond, Bump, Memory, Power, Product, Proportion, Ramp, Saturating, Sine, Spline,
    Step, Window,
};

/// What may act at a place.
struct Row {
    place: Place,
    /// A usual size, and the largest.
    sizes: [f64; 2],
    drivers: &'static [(Driver, &'static [Kind])],
}

const fn row(place: Place, sizes: [f64; 2], drivers: &'static [(Driver, &'static [Kind])]) -> Row {
    Row {
        place,
        sizes,
        drivers,
    }
}

#[rustfmt::skip] // A table: one variable a line.
static ROWS: [Row; 13] = [
    row(Place::PistonForce, [10.0, 60.0], &[
        (Driver::Stroke, &[Power, Beyond, Window, Bump, Sine, Saturating, Spline, Product(Driver::Time)]),
        (Driver::Time, &[Proportion, Step, Ramp, Approach, Sine, Spline]),
        (Driver::Velocity, &[Power, Beyond, Saturating, Product(Driver::Stroke)]),
        (Driver::ChamberPressure, &[Beyond, Power, Saturating, Memory]),
        (Driver::PressureDifference, &[Spline, Memory, Product(Driver::Stroke)]),
    ]),
    row(Place::Friction, [10.0, 60.0], &[
        (Driver::Stroke, &[Proportion, Beyond, Window, Bump, Spline]),
        (Driver::Time, &[Proportion, Step, Ramp, Approach]),
        (Driver::ContactForce, &[Proportion, Beyond, Power]),
    ]),
    // Of the supply orifice.
    row(Place::FirstLeak, [0.1, 1.0], &[
        (Driver::Stroke, &[Beyond, Window, Bump, Spline]),
        (Driver::Time, &[Step, Ramp, Approach]),
        (Driver::ChamberPressure, &[Beyond, Power]),
    ]),
    row(Place::SecondLeak, [0.2, 2.0], &[
        (Driver::Stroke, &[Beyond, Window, Bump]),
        (Driver::Time, &[Step, Ramp]),
    ]),
    row(Place::Supply, [0.2, 0.8], &[
        (Driver::Stroke, &[Window, Bump, Spline]),
        (Driver::Time, &[Step, Ramp, Approach, Sine]),
        (Driver::SetPressure, &[Proportion, Saturating]),
    ]),
    row(Place::Exhaust, [0.2, 0.8], &[
        (Driver::Stroke, &[Beyond, Bump, Spline]),
        (Driver::Time, &[Step, Ramp, Approach]),
    ]),
    row(Place::SetPressure, [8e3, 5e4], &[
        (Driver::SetPressure, &[Power, Beyond, Bump, Sine, Saturating, Spline, Memory, Product(Driver::Time)]),
        (Driver::Time, &[Proportion, Step, Ramp, Approach, Sine, Spline]),
    ]),
    row(Place::Outlet, [5e3, 4e4], &[
        (Driver::Time, &[Step, Ramp, Approach, Sine]),
        (Driver::ChamberPressure, &[Beyond, Saturating, Memory]),
        (Driver::MassFlow, &[Proportion, Power, Saturating, Memory]),
    ]),
    row(Place::Surface, [2e-4, 2e-3], &[
        (Driver::Time, &[Proportion, Step, Ramp, Approach, Spline]),
        (Driver::Surface, &[Proportion, Bump, Sine, Spline]),
        (Driver::ContactForce, &[Memory]),
    ]),
    row(Place::Stiffness, [0.3, 0.9], &[
        (Driver::Time, &[Step, Ramp, Approach]),
        (Driver::Surface, &[Proportion, Bump, Spline]),
    ]),
    row(Place::ForceReading, [5.0, 40.0], &[
        (Driver::Time, &[Step, Approach, Sine, Spline]),
        (Driver::ContactForce, &[Power, Beyond, Saturating, Spline, Memory, Product(Driver::Time)]),
        (Driver::Stroke, &[Proportion, Sine, Spline, Product(Driver::Direction)]),
        (Driver::Velocity, &[Proportion, Saturating]),
        (Driver::ChamberPressure, &[Proportion, Power, Memory]),
    ]),
    row(Place::StrokeReading, [1e-4, 1e-3], &[
        (Driver::Stroke, &[Power, Beyond, Bump, Sine, Spline, Product(Driver::Time)]),
        (Driver::Time, &[Proportion, Step, Ramp, Approach]),
        (Driver::Velocity, &[Proportion, Saturating]),
    ]),
    row(Place::PressureReading, [3e3, 3e4], &[
        (Driver::Time, &[Step, Ramp, Approach, Sine]),
        (Driver::ChamberPressure, &[Proportion, Power, Memory, Product(Driver::Time)]),
        (Driver::MassFlow, &[Proportion, Power]),
    ]),
];

impl Kind {
    /// One of its forms over u from 0 to 1.
    fn form(self, driver: Driver, is_positive: bool, rng: &mut ChaCha8Rng, length: f64) -> Form {
        let of_time = driver == Driver::Time;
        match self {
            Proportion | Product(_) => Form::Proportion,
            // A root of the speed would stick.
            Power => Form::Power(if driver == Driver::Velocity || rng.random_bool(0.7) {
                rng.random_range(1.6..3.0)
            } else {
                rng.random_range(0.3..0.6)
            }),
            Beyond => Form::Beyond(rng.random_range(0.25..0.6)),
            Window => {
                let from = rng.random_range(0.15..0.5);
                let edge = rng.random_range(0.01..0.03);
                Form::Window([from, from + rng.random_range(0.12..0.35), edge])
            }
            Bump => Form::Bump([rng.random_range(0.2..0.7), rng.random_range(0.05..0.16)]),
            // Over time up to 8 Hz, along a way few periods.
            Sine if of_time => {
                let frequency = between(rng, 0.5, 8.0);
                Form::Sine([frequency * length, 0.0])
            }
            Sine => Form::Sine([rng.random_range(1.5..5.0), rng.random_range(-3.0..3.0)]),
            Saturating => Form::Saturating(rng.random_range(0.1..0.45)),
            Step => Form::Step([rng.random_range(0.25..0.75), 1e-3]),
            Ramp => Form::Ramp([rng.random_range(0.1..0.4), rng.random_range(0.5..0.9)]),
            Approach => Form::Approach(rng.random_range(0.1..0.5)),
            Memory if rng.random_bool(0.5) => Form::Saturating(rng.random_range(0.2..0.5)),
            Memory => Form::Proportion,
            Spline => {
                let count = rng.random_range(4..=6usize);
                let gap = 1.0 / (count - 1) as f64;
                let mut points: Vec<[f64; 2]> = (0..count)
                    .map(|i| {
                        let inner = i > 0 && i + 1 < count;
                        let off = if inner {
                            rng.random_range(-0.25..0.25)
                        } else {
                            0.0
                        };
                        [gap * (i as f64 + off), rng.random_range(-1.0..1.0)]
                    })
                    .collect();
                let least = points.iter().map(|p| p[1]).fold(f64::INFINITY, f64::min);
                // At rest nothing acts over time; of an opening and of friction there is none somewhere.
                let from = if of_time { points[0][1] } else { least };
                if of_time || is_positive {
                    for point in &mut points {
                        point[1] -= from;
                    }
                }
                let most = points.iter().map(|p| p[1].abs()).fold(0.0, f64::max);
                for point in &mut points {
                    point[1] /= most.max(1e-3);
                }
                Form::spline(&points)
            }
        }
    }
}

/// A case with a law of its own concealed, alone or beside a listed effect, drawn by its seed.
///
/// # Errors
/// No draw will do, or the integrator cannot go on without a law.
pub fn law_case(name: &str, seed: u64, duration: f64) -> Result<Recipe, LaboratoryError> {
    let mut recipe = Recipe {
        name: name.to_owned(),
        seed,
        effects: Vec::new(),
        law: None,
        duration,
        conditions: Conditions::default(),
    };
    let rng = &mut stream(seed, 20);
    if rng.random_bool(WITH_OTHER) {
        recipe.effects = vec![beside(&recipe, rng)?];
    }
    let eye = recipe.eye_beside()?;
    let mut chosen = choice(rng);
    for draw in 0..DRAWS {
        // Others only where none of what was chosen first will do: else what is easily its own would be all there is.
        if draw >= OF_ONE_CHOICE {
            chosen = choice(rng);
        }
        let rng = &mut stream(seed, 100 + draw);
        let aim = between(rng, SHOWS[0], SHOWS[1]);
        let (law, most) = drawn(chosen, rng, recipe.rig(), duration, eye.trajectories());
        // A device that cannot be run is another draw.
        if let Ok(Some(law)) = sized(&mut recipe, law, most, aim, &eye) {
            recipe.law = Some(law);
            return Ok(recipe);
        }
    }
    Err(LaboratoryError::NoLaw { seed })
}

/// A listed effect that shows.
fn beside(recipe: &Recipe, rng: &mut ChaCha8Rng) -> Result<(&'static str, f64), LaboratoryError> {
    for _ in 0..DRAWS {
        let name = EFFECTS[rng.random_range(0..EFFECTS.len())].name;
        let share = rng.random_range(BESIDE[0]..BESIDE[1]);
        if recipe.visibility(name)?(share)? > BESIDE_SHOWS {
            return Ok((name, share));
        }
    }
    Err(LaboratoryError::NoLaw { seed: recipe.seed })
}

/// A place and a variable.
type Choice = (&'static Row, Driver, &'static [Kind]);

fn choice(rng: &mut ChaCha8Rng) -> Choice {
    let row = &ROWS[rng.random_range(0..ROWS.len())];
    let (driver, kinds) = row.drivers[rng.random_range(0..row.drivers.len())];
    (row, driver, kinds)
}

/// A law of a usual size, and the largest size.
fn drawn(
    (row, driver, kinds): Choice,
    rng: &mut ChaCha8Rng,
    rig: LaboratoryRig,
    length: f64,
    bare: &[LaboratoryTrajectory],
) -> (Law, f64) {
    let kind = *kinds.choose(rng).unwrap_or(&Proportion);
    let form = kind.form(driver, row.place.is_positive(), rng, length);
    let scale = match driver {
        Driver::Time => [0.0, length],
        Driver::Stroke => [0.0, rig.stroke],
        Driver::PressureDifference if kind != Spline => [0.0, range(bare, driver)[1]],
        Driver::Surface | Driver::PressureDifference => {
            let [low, high] = range(bare, driver);
            [low, high - low]
        }
        Driver::ChamberPressure => {
            let [_, high] = range(bare, driver);
            [rig.gas.atmosphere, high - rig.gas.atmosphere]
        }
        _ => {
            let [low, high] = range(bare, driver);
            [0.0, high.max(-low)]
        }
    };
    let memory = match (kind, driver) {
        (Memory, _) => between(rng, 0.05, 2.0),
        (_, Driver::MassFlow) => AT_ONCE,
        _ => 0.0,
    };
    let factor = match kind {
        Product(Driver::Direction) => Some((Driver::Direction, 1.0)),
        Product(Driver::Time) => Some((Driver::Time, length)),
        Product(other) => Some((other, range(bare, other)[1])),
        _ => None,
    };
    let unit = match row.place {
        Place::FirstLeak | Place::SecondLeak => rig.supply_orifice,
        _ => 1.0,
    };
    let sign = match (row.place, driver) {
        // What goes with the speed takes power from it, what is pressed gives way.
        (Place::PistonForce, Driver::Velocity) => -1.0,
        (Place::Surface, Driver::ContactForce) => 1.0,
        (place, _) if place.is_positive() || rng.random_bool(0.5) => 1.0,
        _ => -1.0,
    };
    let law = Law {
        place: row.place,
        driver,
        scale,
        form,
        memory,
        factor,
        size: sign * unit * row.sizes[0] * between(rng, 0.5, 2.0),
    };
    (law, unit * row.sizes[1])
}

/// Range of a variable in the recordings to diagnose from, but for the last hundredth at either end.
fn range(bare: &[LaboratoryTrajectory], driver: Driver) -> [f64; 2] {
    let mut all: Vec<f64> = values(bare, driver).filter(|v| v.is_finite()).collect();
    all.sort_by(f64::total_cmp);
    [all.len() / 100, all.len() * 99 / 100].map(|i| all[i])
}

fn values(trajectories: &[LaboratoryTrajectory], driver: Driver) -> impl Iterator<Item = f64> {
    let all = trajectories.iter().flat_map(|t| &t.drivers);
    all.map(move |drivers| drivers[driver as usize])
}

/// The law at a size at which it shows as it should; none where it cannot, or where it will not do.
fn sized(
    recipe: &mut Recipe,
    mut law: Law,
    most: f64,
    aim: f64,
    eye: &Eye,
) -> Result<Option<Law>, LaboratoryError> {
    /// Steps of a fixed point: what shows goes about with the size.
    const STEPS: usize = 5;
    for _ in 0..STEPS {
        if law.size.abs() > most {
            return Ok(None);
        }
        recipe.law = Some(law.clone());
        let real = recipe.real_trajectories()?;
        let shows = eye.visibility(&real);
        if (shows / aim).ln().abs() < NEAR {
            let fit = works(&real, eye.trajectories()) && is_its_own(&law, &real, shows);
            return Ok(fit.then_some(law));
        }
        if shows < 1e-3 * aim {
            return Ok(None);
        }
        law.size *= (aim / shows).clamp(0.1, 10.0);
    }
    Ok(None)
}

/// Whether a device still does what it did: starts at rest, is in contact, moves.
fn works(real: &[LaboratoryTrajectory], bare: &[LaboratoryTrajectory]) -> bool {
    real.iter().zip(bare).all(|(real, bare)| {
        let touching = |t: &LaboratoryTrajectory| t.contact.iter().filter(|f| **f > 0.0).count();
        let way = |t: &LaboratoryTrajectory| {
            let place = |d: &[f64; 10]| d[Driver::Stroke as usize];
            let steps = t.drivers.windows(2).map(|w| place(&w[1]) - place(&w[0]));
            steps.map(f64::abs).sum::<f64>()
        };
        let [a, b] = [real, bare].map(|t| touching(t) as f64);
        let [c, d] = [real, bare].map(way);
        let rests = real.readings[3][0].abs() < 1.0;
        rests && a >= LEFT * b && b >= LEFT * a && c >= LEFT * d && LEFT * c <= d
    })
}

/// Whether what acts is neither a listed effect's nor as well described by another variable.
fn is_its_own(law: &Law, real: &[LaboratoryTrajectory], shows: f64) -> bool {
    let mut rows: Vec<(f64, [f64; 10])> = Vec::new();
    let touched = [Place::Surface, Place::Stiffness].contains(&law.place);
    for trajectory in real {
        let samples = trajectory.law.iter().zip(&trajectory.drivers);
        // Where nothing touches, nothing of a contact is seen.
        for (acts, drivers) in samples {
            if touched && drivers[Driver::ContactForce as usize] <= 0.0 {
                continue;
            }
            rows.push((*acts, *drivers));
        }
    }
    if rows.len() < 100 {
        return false;
    }
    let own = law.depends_on();
    // The direction is in the speed.
    let other = |d: &&Driver| **d != Driver::Direction && !own.contains(&d.name()[0]);
    let others = Driver::ALL.iter().filter(other);
    let alike = others
        .map(|other| correlation_ratio(&rows, *other))
        .fold(0.0, f64::max);
    let left = left_by_listed(law.place, &rows);
    alike < ALIKE && left > OWN && shows * left.sqrt() > OWN_SHOWS
}

/// Pearson's correlation ratio of what acts, in classes of a variable.
fn correlation_ratio(rows: &[(f64, [f64; 10])], driver: Driver) -> f64 {
    let mut pairs: Vec<(f64, f64)> = rows
        .iter()
        .map(|(acts, drivers)| (drivers[driver as usize], *acts))
        .filter(|(value, _)| value.is_finite())
        .collect();
    if pairs.len() < rows.len() {
        return 0.0;
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mean = |pairs: &[(f64, f64)]| pairs.iter().map(|p| p.1).sum::<f64>() / pairs.len() as f64;
    let all = mean(&pairs);
    let total: f64 = pairs.iter().map(|p| (p.1 - all).powi(2)).sum();
    let classes = pairs.chunks(pairs.len().div_ceil(CLASSES));
    let between: f64 = classes
        .map(|class| class.len() as f64 * (mean(class) - all).powi(2))
        .sum();
    between / total.max(f64::MIN_POSITIVE)
}

/// Share of what acts that is left beside the listed effects of a place, fitted by least squares.
fn left_by_listed(place: Place, rows: &[(f64, [f64; 10])]) -> f64 {
    let rate = |i: usize, driver: usize| {
        let [from, to] = [i.saturating_sub(1), (i + 1).min(rows.len() - 1)].map(|j| rows[j].1);
        let step = to[0] - from[0];
        if step > 0.0 {
            (to[driver] - from[driver]) / step
        } else {
            0.0
        }
    };
    let listed = |i: usize| -> Vec<f64> {
        let d = &rows[i].1;
        let of = |driver: Driver| d[driver as usize];
        let first = match place {
            Place::PistonForce => vec![
                of(Driver::Stroke),
                of(Driver::Velocity),
                of(Driver::Direction),
                of(Driver::PressureDifference).abs() * of(Driver::Direction),
                rate(i, Driver::Velocity as usize),
            ],
            Place::Friction => vec![of(Driver::PressureDifference).abs()],
            Place::SetPressure | Place::Outlet | Place::PressureReading => {
                return vec![of(Driver::SetPressure)];
            }
            Place::Surface => vec![of(Driver::ContactForce)],
            Place::ForceReading => vec![
                of(Driver::Time),
                of(Driver::ContactForce),
                rate(i, Driver::ContactForce as usize),
                rate(i, Driver::Velocity as usize),
            ],
            // A surface that is off shifts the stroke in contact.
            Place::StrokeReading => {
                let touches = of(Driver::ContactForce) > 0.0;
                return vec![of(Driver::Stroke), f64::from(u8::from(touches))];
            }
            _ => Vec::new(),
        };
        first.into_iter().chain([1.0]).collect()
    };
    let columns = listed(0).len();
    let mut matrix = DMatrix::from_fn(rows.len(), columns, |_, _| 0.0);
    for i in 0..rows.len() {
        for (j, value) in listed(i).into_iter().enumerate() {
            matrix[(i, j)] = if value.is_finite() { value } else { 0.0 };
        }
    }
    // Columns of like length.
    for mut column in matrix.column_iter_mut() {
        let length = column.norm();
        if length > 0.0 {
            column /= length;
        }
    }
    let acts = DVector::from_iterator(rows.len(), rows.iter().map(|row| row.0));
    let normal = matrix.transpose() * &matrix + DMatrix::identity(columns, columns) * 1e-12;
    let Some(factors) = normal
        .cholesky()
        .map(|c| c.solve(&(matrix.transpose() * &acts)))
    else {
        return 1.0;
    };
    let left = &acts - &matrix * factors;
    left.norm_squared() / acts.norm_squared().max(f64::MIN_POSITIVE)
}

#[cfg(test)]
mod tests {
    use super::super::draw::NominalRig;
    use super::super::trajectory::run;
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn all_places_and_kinds_are_drawn_of_variables_that_an_answer_may_name() {
        let nominal = NominalRig::draw(9);
        let seen = &nominal.programmes(9, 2.0)[..3];
        let nothing = super::super::Concealed::default();
        let bare: Vec<LaboratoryTrajectory> = seen
            .iter()
            .map(|programme| run(&nominal.rig, &nothing, programme).unwrap())
            .collect();
        let mut places = BTreeSet::new();
        let mut forms = BTreeSet::new();
        for seed in 0..200 {
            let draw = || {
                let rng = &mut stream(seed, 100);
                drawn(choice(rng), rng, nominal.rig.clone(), 2.0, &bare)
            };
            let (law, most) = draw();
            assert_eq!(draw().0, law);
            assert!(law.size.abs() < most && law.scale[1] > 0.0, "{law:?}");
            // At rest, and all along, there is a number.
            for step in -10..=20 {
                assert!(law.at(0.1 * f64::from(step), 1.0).is_finite(), "{law:?}");
            }
            let known = [
                "time",
                "stroke_m",
                "velocity",
                "velocity_sign",
                "chamber_pressure",
                "pressure_difference",
                "mass_flow",
                "set_pressure",
                "surface_m",
                "contact_force",
            ];
            let names = law.depends_on();
            assert!(names.iter().all(|name| known.contains(name)) && names.len() <= 3);
            let form = format!("{:?}", law.form);
            forms.insert(form.split('(').next().unwrap_or_default().to_owned());
            forms.insert(format!("memory {}", law.memory > AT_ONCE));
            forms.insert(format!("factor {}", law.factor.is_some()));
            places.insert(law.place);
        }
        assert_eq!(places.len(), ROWS.len());
        // Eleven forms, memory or none, one variable or two.
        assert_eq!(forms.len(), 11 + 2 + 2, "{forms:?}");
    }

    /// Samples of a variable that swings, and what acts.
    fn rows(acts: impl Fn(&[f64; 10]) -> f64) -> Vec<(f64, [f64; 10])> {
        let sample = |i: i32| {
            let t = 0.01 * f64::from(i);
            let mut drivers = [0.0; 10];
            drivers[Driver::Time as usize] = t;
            drivers[Driver::Stroke as usize] = 0.02 + 0.01 * (3.0 * t).sin();
            drivers[Driver::Velocity as usize] = 0.03 * (3.0 * t).cos();
            drivers[Driver::ContactForce as usize] = 80.0 + 30.0 * (1.7 * t).sin();
            drivers[Driver::Surface as usize] = drivers[Driver::Stroke as usize] - 1e-6;
            (acts(&drivers), drivers)
        };
        (0..1000).map(sample).collect()
    }

    #[test]
    fn what_is_a_listed_effect_or_another_variable_s_is_refused() {
        let spring = rows(|d| -300.0 * d[1] - 4.0);
        assert!(left_by_listed(Place::PistonForce, &spring) < 1e-6);
        let bump = rows(|d| (-((d[1] - 0.022) / 0.002).powi(2)).exp());
        assert!(left_by_listed(Place::PistonForce, &bump) > 0.3);
        assert!(left_by_listed(Place::ForceReading, &rows(|d| 0.1 * d[7] + 2.0)) < 1e-6);
        // The stroke follows the surface: either tells all of the other; the time tells much less.
        assert!(correlation_ratio(&bump, Driver::Surface) > ALIKE);
        assert!(correlation_ratio(&bump, Driver::Velocity) < 0.9);
    }

    #[test]
    fn a_case_is_drawn_alike_each_time_and_shows_as_it_should() {
        let case = || law_case("one", 3, 2.0).unwrap();
        let recipe = case();
        assert_eq!(recipe, case());
        let law = recipe.law.clone().unwrap();
        let eye = recipe.eye_beside().unwrap();
        let shows = eye.visibility(&recipe.real_trajectories().unwrap());
        assert!(shows > 0.7 * SHOWS[0] && shows < 1.4 * SHOWS[1], "{shows}");
        let sealed = recipe.make().unwrap().sealed;
        let found = sealed.effects.last().unwrap();
        assert_eq!(found.name, "unlisted");
        assert_eq!(found.formula.as_deref(), Some(law.formula().as_str()));
        assert_eq!(found.subsystem, law.place.subsystem());
    }
}
