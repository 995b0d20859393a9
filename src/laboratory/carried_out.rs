//! A device of the laboratory as a rig that carries out what it is asked for: inputs in, its recording out.

use std::path::Path;

use super::CHANNELS;
use super::case::Recipe;
use super::programme::{Programme, Sampled, Surface};
use super::trajectory::LaboratoryError;
use super::write::write_measured;
use crate::recording::csv::read_csv;
use crate::recording::{Recording, RecordingError, schema};

/// A rig that does not do it.
#[derive(Debug, thiserror::Error)]
pub enum RigError {
    /// Inputs or recording.
    #[error(transparent)]
    Recording(#[from] RecordingError),
    /// A surface that is there for a part of the time.
    #[error(
        "{file}: `surface_m` is empty in some rows and not in others, expected a surface throughout or none"
    )]
    Surface {
        /// The inputs.
        file: String,
    },
    /// The integrator.
    #[error(transparent)]
    Laboratory(#[from] LaboratoryError),
}

/// Where a list of values changes: times [s] and values from there on.
fn changes<T: PartialEq + Copy>(times: &[f64], values: &[T]) -> Vec<(f64, T)> {
    let begin = times[0];
    let mut found: Vec<(f64, T)> = Vec::new();
    for (time, value) in times.iter().zip(values) {
        if found.last().is_none_or(|(_, last)| last != value) {
            found.push((time - begin, *value));
        }
    }
    found
}

/// The programme of inputs, sampled as often as a device is.
fn programme(inputs: &Recording, rate: f64) -> Result<Programme, RecordingError> {
    let times = inputs.time();
    let pressures = inputs.values(schema::SET_PRESSURE_GAUGE)?;
    let valve = inputs.values(schema::VALVE_EXTENDS)?;
    let valve: Vec<bool> = valve.iter().map(|position| *position > 0.5).collect();
    let surface = inputs.values(schema::SURFACE_POSITION)?;
    let duration = times[times.len() - 1] - times[0];
    let count = (duration * rate).floor() as usize + 1;
    let begin = times[0];
    Ok(Programme {
        name: "asked".to_owned(),
        set_pressures: changes(times, pressures),
        valve: changes(times, &valve),
        surface: surface.iter().all(|place| place.is_finite()).then(|| {
            Surface::Sampled(Sampled {
                times: times.iter().map(|time| time - begin).collect(),
                places: surface.to_vec(),
            })
        }),
        times: (0..count).map(|index| index as f64 / rate).collect(),
    })
}

impl Recipe {
    /// Carries out the inputs of a file on the device, with noise of its own, by the turn, and writes its recording.
    ///
    /// # Errors
    /// Inputs that cannot be read, the integrator cannot go on, a file that cannot be written.
    ///
    /// # Panics
    /// An effect that does not exist.
    pub fn carry_out(&self, inputs: &Path, recording: &Path, turn: u64) -> Result<(), RigError> {
        let read = read_csv(inputs)?.recording;
        let surface = read.values(schema::SURFACE_POSITION)?;
        let rows = surface.iter().filter(|place| place.is_finite()).count();
        if rows > 0 && rows < surface.len() {
            return Err(RigError::Surface {
                file: inputs.display().to_string(),
            });
        }
        let programme = programme(&read, self.rig().rate)?;
        let values: [Vec<f64>; CHANNELS.len()] = self.record(&programme, turn)?;
        Ok(write_measured(&programme, &values, recording)?)
    }
}
