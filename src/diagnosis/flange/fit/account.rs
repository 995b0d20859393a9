//! The simulated flange in words.

use super::report::{SimulatedFlange, SimulatedResult, SimulatedRun};
use crate::quantity::significant;

/// Logarithm of a moving mass over the rig file's from which it is said to be another [1].
const OTHER_MASS: f64 = 0.1;
/// Gain from which a log overshoots [1].
const OVERSHOOTS: f64 = 1.05;

/// The fitted flange, and what it gives of the runs that it was fitted to.
pub(in crate::diagnosis) fn simulated(flange: &SimulatedFlange, mass: f64) -> Vec<String> {
    let of = |name: &str| {
        let found = flange.numbers.iter().find(|number| number.name == name);
        found.map_or(f64::NAN, |number| number.value)
    };
    let number = |name: &str, factor: f64| significant(factor * of(name), 2);
    let mut paragraphs = vec![format!(
        "Arm's speed, desired force and force ramp in, contact force out: {} kg move with the slide, {} kg of them in front of a structure of {} N/mm; the contact has {} N/mm, \
         what carries the workpiece {} N/mm; the air {} N/mm, the seals {} N. The regulator takes {} ms, its valve {} ms. {} of the fits count as well as the best. \
         All numbers with their intervals stand in diagnosis.json.",
        number("moving_mass_kg", 1.0),
        number("head_mass_kg", 1.0),
        number("structure_stiffness_n_per_m", 1e-3),
        number("contact_stiffness_n_per_m", 1e-3),
        number("workpiece_stiffness_n_per_m", 1e-3),
        number("gas_stiffness_n_per_m", 1e-3),
        number("coulomb_force_n", 1.0),
        number("regulator_time_s", 1e3),
        number("valve_time_s", 1e3),
        flange.solutions,
    )];
    paragraphs.extend(other_mass(flange, mass));
    if flange.reading_gain > OVERSHOOTS {
        paragraphs.push(format!(
            "The log has the force read {} times a second behind two lags that overshoot: a step of the force first reads {} times as large. Peaks of the log are no peaks of the force.",
            significant(flange.reading_rate_hz, 3),
            significant(flange.reading_gain.powi(2), 3),
        ));
    }
    let fitted = flange.runs.iter().filter(|run| run.fitted);
    paragraphs.extend(fitted.map(|run| format!("Fitted to {}: {}.", run.recording, beside(run))));
    paragraphs
}

/// That the moving mass is another than the rig file's [kg], where it is.
fn other_mass(flange: &SimulatedFlange, mass: f64) -> Option<String> {
    let own = flange
        .numbers
        .iter()
        .find(|number| number.name == "moving_mass_kg")?;
    let [low, high] = own.interval?;
    if (own.value / mass).ln().abs() < OTHER_MASS {
        return None;
    }
    let holds = match (low..=high).contains(&mass) {
        true => "the interval holds that of the rig file too",
        false => {
            "the rig file's lies outside: something moves with the slide that it does not count, or the simulation puts into the mass what it lacks elsewhere"
        }
    };
    Some(format!(
        "The moving mass comes to {} kg ({} to {}), {} times the {} kg of the rig file; {holds}.",
        significant(own.value, 2),
        significant(low, 2),
        significant(high, 2),
        significant(own.value / mass, 2),
        significant(mass, 3),
    ))
}

/// What it predicts of runs that it never saw.
pub(in crate::diagnosis) fn unseen(flange: &SimulatedFlange) -> Vec<String> {
    let unseen = flange.runs.iter().filter(|run| !run.fitted);
    unseen
        .map(|run| {
            format!(
                "{}, by the simulation: {}. Intervals are those of 90 %, from what the fits leave open and from how far each fitted run is from what the others say of it.",
                run.recording,
                beside(run)
            )
        })
        .collect()
}

fn beside(run: &SimulatedRun) -> String {
    let part = |what: &str, unit: &str, value: &SimulatedResult| {
        format!(
            "{what} {} {unit} ({} to {}), recorded {} ({:+.0} %)",
            significant(value.simulated, 3),
            significant(value.low, 3),
            significant(value.high, 3),
            significant(value.recorded, 3),
            100.0 * value.error()
        )
    };
    let mut parts = vec![part("peak", "N", &run.peak_n)];
    parts.extend(
        run.ringing_hz
            .map(|ringing| part("ringing", "Hz", &ringing)),
    );
    parts.push(part("settled after", "s", &run.settling_s));
    parts.extend(
        run.sliding_spread_n
            .map(|s| part("spread while sliding", "N", &s)),
    );
    parts.join("; ")
}
