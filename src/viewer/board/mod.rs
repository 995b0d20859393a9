//! Findings as a Rerun file: words and pictures of quantities on the left, signals on the right, one tab for each recording.

mod cloud;
mod layout;
mod sheet;

use std::path::Path;

use ::rerun::archetypes::RecordingInfo;
use ::rerun::{EntityPath, StoreKind, TextDocument};

use super::blueprint::write_blueprint;
use super::fingerprint::Fingerprint;
use super::footer::write_joined;
use super::options::{SUMMARY, slug};
use super::rrd::{RrdError, RrdWriter};
use super::{RerunOptions, cell};
use crate::recording::RecordingError;
use crate::recording::atomic::write_atomic;
use crate::scene::board::Board;

/// Writes findings as a Rerun file that opens as a finished screen. Equal input gives equal bytes.
///
/// # Errors
/// [`RecordingError::Scene`] if the scene's parts do not fit together;
/// [`RecordingError::Write`] if the file cannot be written; nothing is left then.
pub fn write_board(path: &Path, board: &Board) -> Result<(), RecordingError> {
    if let Some(scene) = &board.scene {
        scene.check()?;
    }
    let number = fingerprint(board);
    let id = format!("{}-{number:016x}", slug(&board.title));
    let options = RerunOptions::default();
    let encode = || -> Result<Vec<u8>, RrdError> {
        let mut rrd = RrdWriter::begin(StoreKind::Blueprint, &id, number)?;
        let screen = layout::screen(board, &options);
        write_blueprint(&mut rrd, &screen, &layout::time_panel())?;
        rrd.begin_store(StoreKind::Recording, &id)?;
        write_data(&mut rrd, board, &options)?;
        rrd.finish()
    };
    let bytes = encode().map_err(|error| RecordingError::write(path, error))?;
    write_atomic(path, |file| write_joined(&[bytes], file))
}

fn write_data(rrd: &mut RrdWriter, board: &Board, options: &RerunOptions) -> Result<(), RrdError> {
    let info = RecordingInfo::new().with_name(board.title.clone());
    rrd.add_static(&EntityPath::properties().to_string(), &info)?;
    let text = TextDocument::from_markdown(board.text.clone());
    rrd.add_static(SUMMARY, &text)?;
    for (index, cloud) in board.clouds.iter().enumerate() {
        cloud::write(rrd, &cloud::entity(index), cloud)?;
    }
    for (index, sheet) in board.sheets.iter().enumerate() {
        sheet::write(rrd, &sheet::entity(index), sheet)?;
    }
    if let Some(scene) = &board.scene {
        cell::write_bodies(rrd, scene)?;
        cell::write_edge_path(rrd, &scene.edge_path)?;
        cell::write_frames(rrd, scene, 0.0, options)?;
    }
    Ok(())
}

fn fingerprint(board: &Board) -> u64 {
    let mut hash = Fingerprint::default();
    hash.text(&board.title);
    hash.text(&board.text);
    for sheet in &board.sheets {
        hash.text(&sheet.title);
        hash.values(&sheet.time);
        for line in sheet.rows.iter().flatten().flat_map(|plot| &plot.lines) {
            hash.values(&line.values);
        }
    }
    for group in board.clouds.iter().flat_map(|cloud| &cloud.groups) {
        hash.values(group.points.as_flattened());
    }
    hash.finish()
}

#[cfg(test)]
mod tests;
