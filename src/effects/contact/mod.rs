//! Effects where the tool meets the workpiece.

pub mod contact_stiffness_error;
pub mod hertzian_contact;
pub mod surface_offset;
pub mod surface_waviness;
pub mod tool_runout;

use super::parts::*;
use crate::plant::PlantParameters;

/// Where the turns of the tool are not known: slower than this no tool turns, faster no surface waves [Hz].
const SLOWEST_TOOL: f64 = 11.0;
/// Fastest periodic part that is looked for [Hz].
const FASTEST: f64 = 200.0;
/// Slowest one [Hz].
const SLOWEST: f64 = 0.3;
/// Relative half-width about the turns that are known in which a tool turns under load [1].
const SPINDLE_SLIP: f64 = 0.05;

/// Least and largest frequency at which a tool turns whose spindle's turns are known [Hz].
#[must_use]
pub fn known_turns(plant: &PlantParameters) -> Option<[f64; 2]> {
    let known = plant.contact.spindle_frequency;
    let about = [1.0 - SPINDLE_SLIP, 1.0 + SPINDLE_SLIP];
    (known > 0.0).then(|| about.map(|share| share * known))
}

/// Least and largest frequency of a tool's runout [Hz].
fn turns(plant: &PlantParameters) -> [f64; 2] {
    known_turns(plant).unwrap_or([SLOWEST_TOOL, FASTEST])
}

/// Whether a tool may turn at a frequency [Hz].
#[must_use]
pub fn tool_turns_at(plant: &PlantParameters, frequency: f64) -> bool {
    let [slowest, fastest] = turns(plant);
    (slowest..=fastest).contains(&frequency)
}

/// Least and largest frequency of a wavy surface [Hz].
fn waves_from_to(plant: &PlantParameters) -> [f64; 2] {
    match known_turns(plant) {
        Some(_) => [SLOWEST, FASTEST],
        None => [SLOWEST, SLOWEST_TOOL],
    }
}
/// A wave that a fit can start from [m].
const SMALL_WAVE: f64 = 1e-5;

/// Stiffness of either law.
const STIFFNESS: Quantity = LAW_STIFFNESS.named("stiffness_n_per_m");

/// A small sine or cosine at each of the two strongest frequencies in question.
fn waves(clues: &Clues<'_>, of_tool: bool) -> Vec<Vec<f64>> {
    let in_question = |f: &&f64| tool_turns_at(clues.plant, **f) == of_tool;
    let frequencies = clues.periodic.iter().filter(in_question);
    frequencies
        .take(2)
        .flat_map(|f| [vec![*f, SMALL_WAVE, 0.0], vec![*f, 0.0, SMALL_WAVE]])
        .collect()
}

/// Force at which an elastic contact has its nominal stiffness [N].
const USUAL_FORCE: f64 = 150.0;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_spindle_tells_runout_from_waviness_where_its_turns_are_known() {
        let starts = |spindle: f64| {
            let mut plant = PlantParameters::default();
            plant.contact.spindle_frequency = spindle;
            let clues = Clues {
                plant: &plant,
                largest_force: 100.0,
                periodic: &[6.1, 40.0],
                bumps: &[],
            };
            [tool_runout::EFFECT, surface_waviness::EFFECT].map(|effect| {
                let starts = effect.starts(&clues);
                let [slowest, fastest] = effect.parameters(&plant)[0].bounds;
                assert!(starts.iter().all(|s| (slowest..=fastest).contains(&s[0])));
                starts.iter().map(|start| start[0]).collect::<Vec<f64>>()
            })
        };
        assert_eq!(starts(0.0), [vec![40.0, 40.0], vec![6.1, 6.1]]);
        assert_eq!(starts(6.0), [vec![6.1, 6.1], vec![40.0, 40.0]]);
        assert_eq!(starts(90.0), [vec![], vec![6.1, 6.1, 40.0, 40.0]]);
    }
}
