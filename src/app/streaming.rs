//! `recording.rrd` of a cell, encoded by a thread of its own while the simulation goes on: the run itself hardly waits for it.

use std::path::Path;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::{Scope, ScopedJoinHandle};

use super::run::{Listener, RunPart};
use crate::cell::Cell;
use crate::recording::{Recording, RecordingError};
use crate::scene::Scene;
use crate::viewer::{EncodedRrd, PART_SAMPLES, RerunOptions, StreamingRrd};

/// A recording that is encoded while it is made.
pub(super) struct StreamingRecording<'scope> {
    file: &'scope Path,
    parts: Sender<RunPart>,
    thread: ScopedJoinHandle<'scope, Result<Option<StreamingRrd>, RecordingError>>,
}

impl<'scope> StreamingRecording<'scope> {
    /// Begins to encode what its listener is given. `file` is where it will stand, `origin` tells what the run is made of.
    pub(super) fn begin<'env>(
        scope: &'scope Scope<'scope, 'env>,
        cell: &'env Cell,
        file: &'env Path,
        origin: &'env str,
        options: RerunOptions,
    ) -> Self {
        let (parts, received) = channel();
        let thread = scope.spawn(move || encode(cell, file, origin, &options, &received));
        Self {
            file,
            parts,
            thread,
        }
    }

    /// The one who is to be given the run.
    pub(super) fn listener<'a>(&self) -> Listener<'a> {
        let parts = self.parts.clone();
        Listener::new(PART_SAMPLES, move |part| {
            // With the thread gone there was an error: `end` gives it back.
            drop(parts.send(part));
            Ok(())
        })
    }

    /// Waits until all is encoded, and adds what only the whole run tells.
    pub(super) fn end(
        self,
        recording: &Recording,
        scene: &Scene,
        summary_markdown: &str,
    ) -> Result<EncodedRrd, RecordingError> {
        drop(self.parts);
        let encoded = self.thread.join();
        let encoded = encoded.unwrap_or_else(|panic| std::panic::resume_unwind(panic))?;
        match encoded {
            Some(streaming) => streaming.end(recording, scene, summary_markdown),
            None => Err(RecordingError::write(self.file, "nothing was recorded")),
        }
    }
}

fn encode(
    cell: &Cell,
    file: &Path,
    origin: &str,
    options: &RerunOptions,
    parts: &Receiver<RunPart>,
) -> Result<Option<StreamingRrd>, RecordingError> {
    let mut streaming: Option<StreamingRrd> = None;
    for part in parts {
        let (samples, scene) = part.shown(cell)?;
        match &mut streaming {
            Some(streaming) => streaming.add(&samples, &scene)?,
            None => {
                streaming = Some(StreamingRrd::begin(
                    file, origin, &samples, &scene, options,
                )?);
            }
        }
    }
    Ok(streaming)
}
