//! Recordings as Rerun files: `recording.rrd`.
//!
//! A file holds the cell in space (bodies, the edge path coloured by force error, the contact force
//! as an arrow), the signals as plots in their bands and limits, the phases as a coloured lane, a
//! summary, and the screen layout in which the viewer opens it all. Everything can be watched along
//! simulated time or along path length. Equal input gives equal bytes.

mod blueprint;
mod board;
mod cell;
mod check;
mod colours;
mod fingerprint;
mod footer;
mod growing;
mod layout;
mod live;
mod plots;
mod rrd;
mod shading;
mod signals;
mod timelines;
mod view_box;

pub use board::write_board;
pub use check::{RrdFault, check_rrd, viewer_version};
pub use growing::{EncodedRrd, GrowingRrd, PART_SAMPLES};
pub use live::{LiveOutlet, LiveRecording};
pub use rrd::LiveWriter;

use std::path::Path;

use glam::DVec3;

use self::layout::LayoutInput;
use self::plots::Plot;
use self::rrd::{RrdError, RrdWriter};
use super::error_scale::ErrorScale;
use super::scene::Scene;
use super::{Recording, RecordingError};

/// Entity of the phases' lane.
const PHASES: &str = "/phases";
/// Phase that is judged.
const FOLLOW_PHASE: &str = "follow";
/// Entity of the summary.
const SUMMARY: &str = "/summary";

/// Options for drawing a recording.
#[derive(Debug, Clone, PartialEq)]
pub struct RerunOptions {
    /// Text of the summary panel, in Markdown; without it there is no such panel.
    pub summary_markdown: String,
    /// Length of the force arrow per force [m/N].
    pub arrow_metres_per_newton: f64,
    /// Action of the viewer when it opens the file.
    pub opening: Opening,
    /// From the middle of what a 3D view shows towards the eye, in the world.
    pub eye_direction: DVec3,
}

/// Action of the viewer when it opens a file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Opening {
    /// It stands in the middle of following; at the start of a recording that has no such phase.
    Following,
    /// It stands at a moment [s].
    At(f64),
}

impl Opening {
    /// The moment at which a recording opens [s]; none for its start.
    fn moment(self, recording: &Recording) -> Option<f64> {
        match self {
            Self::At(moment) => Some(moment),
            Self::Following => {
                let follow = recording.phase(FOLLOW_PHASE)?;
                let end = recording.time().last()?.min(follow.end);
                Some(0.5 * (follow.start + end))
            }
        }
    }
}

impl Default for RerunOptions {
    fn default() -> Self {
        Self {
            summary_markdown: String::new(),
            arrow_metres_per_newton: 1e-3,
            opening: Opening::Following,
            eye_direction: DVec3::new(0.75, -1.0, 0.55),
        }
    }
}

/// Writes a recording and its scene as a Rerun file that opens as a finished screen.
///
/// # Errors
/// [`RecordingError::Scene`] if the scene's parts do not fit together;
/// [`RecordingError::Write`] if the file cannot be written; nothing is left then.
pub fn write_rrd(
    path: &Path,
    recording: &Recording,
    scene: &Scene,
    options: &RerunOptions,
) -> Result<(), RecordingError> {
    let growing = GrowingRrd::begin(path, "", recording, scene, options)?;
    growing
        .end(recording, scene, &options.summary_markdown)?
        .write(path)
}

fn write_layout(
    rrd: &mut RrdWriter,
    scene: &Scene,
    plots: &[Plot],
    recording: &Recording,
    options: &RerunOptions,
) -> Result<(), RrdError> {
    let errors = &scene.edge_path.relative_force_error;
    let known = errors.iter().any(|error| error.is_finite());
    let screen = layout::screen(&LayoutInput {
        plots,
        scale: known.then(|| ErrorScale::of(&scene.edge_path)),
        cell: view_box::cell_box(scene),
        edge: view_box::ViewBox::around(scene.edge_path.points_in_world.iter().copied()),
        eye_direction: options.eye_direction,
        has_phases: !recording.phases().is_empty(),
        has_summary: !options.summary_markdown.is_empty(),
    });
    blueprint::write_blueprint(
        rrd,
        &screen,
        &layout::time_panel(options.opening.moment(recording)),
    )
}

/// Letters and digits of a title, other stretches as a dash each.
fn slug(title: &str) -> String {
    let words = title.split(|letter: char| !letter.is_ascii_alphanumeric());
    let words: Vec<String> = words
        .filter(|word| !word.is_empty())
        .map(str::to_ascii_lowercase)
        .collect();
    words.join("-")
}

#[cfg(test)]
mod tests;
