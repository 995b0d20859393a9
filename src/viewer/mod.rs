//! Recordings as Rerun files: `recording.rrd`.
//!
//! A file holds the cell in space (bodies, the edge path coloured by force error, the edge before and
//! after it was worked coloured by the chamfer's error, the contact force as an arrow), the signals as plots in their bands and limits, the phases as a coloured lane, a
//! summary, and the screen layout in which the viewer opens it all. Everything can be watched along
//! simulated time or along path length. Equal input gives equal bytes.

mod blueprint;
mod board;
mod cell;
mod check;
mod colours;
mod fingerprint;
mod finished_edge;
mod footer;
mod layout;
mod live;
mod options;
mod plots;
mod rrd;
mod shading;
mod signals;
mod streaming;
mod timelines;
mod view_box;

pub use board::write_board;
pub use check::{RrdFault, check_rrd, viewer_version};
pub use live::{LiveOutlet, LiveRecording};
pub use options::{Opening, RerunOptions};
pub use rrd::LiveWriter;
pub use streaming::{EncodedRrd, PART_SAMPLES, StreamingRrd};

use std::path::Path;

use crate::recording::{Recording, RecordingError};
use crate::scene::Scene;

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
    let streaming = StreamingRrd::begin(path, "", recording, scene, options)?;
    streaming
        .end(recording, scene, &options.summary_markdown)?
        .write(path)
}

#[cfg(test)]
mod tests;
