//! A recording that is encoded while it is made, for a file that is written when it is over.
//!
//! Nearly all of the work, encoding bodies and signals, is done as they come. What only the whole run tells is left for the end: the layout with its
//! ranges, the colours of the edge path, the edge before and after it was worked, the guides in the plots, the phases and the summary.

use std::path::{Path, PathBuf};

use ::rerun::archetypes::RecordingInfo;
use ::rerun::{EntityPath, StoreKind};

use super::fingerprint::fingerprint;
use super::finished_edge::{write_finished_edge, write_summary};
use super::footer::write_joined;
use super::layout::write_layout;
use super::options::{RerunOptions, slug};
use super::plots::{Plot, plots};
use super::rrd::{RrdError, RrdWriter};
use super::timelines::Axes;
use super::{cell, signals};
use crate::recording::atomic::write_atomic;
use crate::recording::{Recording, RecordingError, schema};
use crate::scene::Scene;

/// Samples of a part that fill a chunk: parts of as many make a file no larger than the whole at once.
pub const PART_SAMPLES: usize = signals::CHUNK_ROWS;

/// A recording that is encoded while it is made.
pub struct StreamingRrd {
    rrd: RrdWriter,
    options: RerunOptions,
    /// File of which errors speak.
    file: PathBuf,
    id: String,
    number: u64,
    /// Path length at the last sample [m].
    path_length: f64,
}

impl StreamingRrd {
    /// Begins with the first samples and frames of a run, at least one sample. `origin` says what the run is made of: runs of which it differs are kept
    /// apart in a viewer even where their first samples are the same.
    ///
    /// # Errors
    /// [`RecordingError::Scene`] if the scene's parts do not fit together; [`RecordingError::Write`] if they cannot be encoded.
    pub fn begin(
        file: &Path,
        origin: &str,
        samples: &Recording,
        scene: &Scene,
        options: &RerunOptions,
    ) -> Result<Self, RecordingError> {
        scene.check()?;
        let number = fingerprint(origin, samples, scene, options);
        let id = format!("{}-{number:016x}", slug(&scene.title));
        let start = || -> Result<RrdWriter, RrdError> {
            let mut rrd = RrdWriter::begin(StoreKind::Recording, &id, number)?;
            let info = RecordingInfo::new().with_name(scene.title.clone());
            rrd.add_static(&EntityPath::properties().to_string(), &info)?;
            cell::write_bodies(&mut rrd, scene)?;
            Ok(rrd)
        };
        let mut streaming = Self {
            rrd: start().map_err(|error| RecordingError::write(file, error))?,
            options: options.clone(),
            file: file.to_owned(),
            id,
            number,
            path_length: 0.0,
        };
        streaming.add(samples, scene)?;
        Ok(streaming)
    }

    /// Adds the samples and frames that have come since, at least one sample.
    ///
    /// # Errors
    /// As [`Self::begin`].
    pub fn add(&mut self, samples: &Recording, scene: &Scene) -> Result<(), RecordingError> {
        scene.check()?;
        let plots = plots(samples, &scene.limits)?;
        let added = self.encode(samples, scene, &plots);
        added.map_err(|error| RecordingError::write(&self.file, error))
    }

    fn encode(
        &mut self,
        samples: &Recording,
        scene: &Scene,
        plots: &[Plot],
    ) -> Result<(), RrdError> {
        cell::write_frames(&mut self.rrd, scene, self.path_length, &self.options)?;
        let axes = Axes::of(samples, self.path_length);
        for plot in plots {
            signals::write_signals(&mut self.rrd, plot, &axes)?;
        }
        if let Some(channel) = samples.channel(schema::PATH_LENGTH) {
            let known = channel.values.iter().rev().find(|length| !length.is_nan());
            self.path_length = known.copied().unwrap_or(self.path_length);
        }
        Ok(())
    }

    /// Adds what only the whole run tells: `recording` and `scene` are those of the whole run.
    ///
    /// # Errors
    /// As [`Self::begin`].
    pub fn end(
        mut self,
        recording: &Recording,
        scene: &Scene,
        summary_markdown: &str,
    ) -> Result<EncodedRrd, RecordingError> {
        scene.check()?;
        let plots = plots(recording, &scene.limits)?;
        summary_markdown.clone_into(&mut self.options.summary_markdown);
        let file = self.file.clone();
        let files = self.finish(recording, scene, &plots);
        let files = files.map_err(|error| RecordingError::write(&file, error))?;
        Ok(EncodedRrd { files })
    }

    /// The layout and the data, a file each.
    fn finish(
        mut self,
        recording: &Recording,
        scene: &Scene,
        plots: &[Plot],
    ) -> Result<[Vec<u8>; 2], RrdError> {
        cell::write_edge_path(&mut self.rrd, &scene.edge_path)?;
        let axes = Axes::of(recording, 0.0);
        write_finished_edge(&mut self.rrd, scene.finished_edge.as_ref(), Some(&axes))?;
        for plot in plots {
            signals::write_looks(&mut self.rrd, plot)?;
            signals::write_guides(&mut self.rrd, plot, &axes)?;
        }
        signals::write_phases(&mut self.rrd, recording, &axes)?;
        write_summary(&mut self.rrd, &self.options.summary_markdown, scene)?;
        // Chunks of the two stores are distinct as those of two recordings.
        let mut layout = RrdWriter::begin(StoreKind::Blueprint, &self.id, !self.number)?;
        write_layout(&mut layout, scene, plots, recording, &self.options)?;
        Ok([layout.finish()?, self.rrd.finish()?])
    }
}

/// A recording that is encoded, all of it.
pub struct EncodedRrd {
    files: [Vec<u8>; 2],
}

impl EncodedRrd {
    /// Writes the file.
    ///
    /// # Errors
    /// [`RecordingError::Write`] if it cannot be written; nothing is left then.
    pub fn write(&self, path: &Path) -> Result<(), RecordingError> {
        write_atomic(path, |file| write_joined(&self.files, file))
    }
}
