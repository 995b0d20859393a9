//! Effects where the tool meets the workpiece.

pub mod contact_stiffness_error;
pub mod hertzian_contact;
pub mod surface_offset;
pub mod surface_waviness;
pub mod tool_runout;

use super::parts::*;

/// Slower than this no tool turns, faster no surface waves [Hz].
pub const SLOWEST_TOOL: f64 = 11.0;
/// A wave that a fit can start from [m].
const SMALL_WAVE: f64 = 1e-5;

/// Stiffness of either law.
const STIFFNESS: Quantity = LAW_STIFFNESS.named("stiffness_n_per_m");

/// A small sine or cosine at each of the two strongest frequencies in question.
fn waves(clues: &Clues<'_>, in_question: fn(f64) -> bool) -> Vec<Vec<f64>> {
    let frequencies = clues.periodic.iter().filter(|f| in_question(**f));
    frequencies
        .take(2)
        .flat_map(|f| [vec![*f, SMALL_WAVE, 0.0], vec![*f, 0.0, SMALL_WAVE]])
        .collect()
}

/// Force at which an elastic contact is as stiff as it is believed to be [N].
const USUAL_FORCE: f64 = 150.0;
