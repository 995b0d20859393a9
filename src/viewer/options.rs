//! Options for drawing a recording, and names that all of a file share.

use glam::DVec3;

use crate::recording::Recording;

/// Entity of the phases' lane.
pub(super) const PHASES: &str = "/phases";
/// Phase that is judged.
pub(super) const FOLLOW_PHASE: &str = "follow";
/// Entity of the summary.
pub(super) const SUMMARY: &str = "/summary";

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
    pub(super) fn moment(self, recording: &Recording) -> Option<f64> {
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

/// Letters and digits of a title, other stretches as a dash each.
pub(super) fn slug(title: &str) -> String {
    let words = title.split(|letter: char| !letter.is_ascii_alphanumeric());
    let words: Vec<String> = words
        .filter(|word| !word.is_empty())
        .map(str::to_ascii_lowercase)
        .collect();
    words.join("-")
}
