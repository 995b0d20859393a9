//! What an analog output is set to for a force.

use super::dialect::Dialect;
use super::error::ProgramError;
use crate::cell::Cell;
use crate::device::PressureMap;
use crate::scenario::attainable_set_pressure;

/// An output that sets the force.
pub(super) struct Output {
    /// Its number or name.
    pub name: String,
    /// Its value in each pass.
    pub passes: Vec<f64>,
    /// Its value for no force.
    pub idle: f64,
}

impl Output {
    /// By the scenario's table; without one 0 to 10 V set 0 to the greatest pressure that the device can be given, as proportional regulators are delivered.
    pub(super) fn of(cell: &Cell, dialect: Dialect) -> Result<Self, ProgramError> {
        let scenario = &cell.setup.scenario;
        let (file, table) = (|| scenario.path.clone(), &scenario.program);
        let name = table.force_output.clone();
        let name = name.unwrap_or_else(|| dialect.usual_output().to_owned());
        let by_name = dialect == Dialect::Rapid;
        let letters = name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
        let fits = match by_name {
            true => letters && name.starts_with(|c: char| c.is_ascii_alphabetic()),
            false => name.parse::<u16>().is_ok(),
        };
        if !fits {
            return Err(ProgramError::OutputName {
                file: file(),
                found: name,
                expected: if by_name {
                    "the name of a signal"
                } else {
                    "its number"
                },
                dialect: dialect.name(),
            });
        }
        let forces = cell.setup.passes.iter().map(|pass| pass.force);
        let (passes, idle) = match (&table.output_forces, &table.output_values) {
            (Some(at), Some(values)) => {
                let found: Result<Vec<f64>, ProgramError> = forces
                    .enumerate()
                    .map(|(index, force)| {
                        between(at, values, force).ok_or_else(|| ProgramError::ForceBeyond {
                            file: file(),
                            pass: index + 1,
                            force,
                            low: at[0],
                            high: at[at.len() - 1],
                        })
                    })
                    .collect();
                (found?, values[0])
            }
            _ => {
                let full = dialect.full_output();
                let full = full.ok_or_else(|| ProgramError::OutputUnknown { file: file() })?;
                let value = |force: f64| full * share(cell, force);
                (forces.map(value).collect(), 0.0)
            }
        };
        let [low, high] = dialect.output_range();
        let beyond = passes
            .iter()
            .chain([&idle])
            .find(|value| !(low..=high).contains(*value));
        match beyond {
            Some(&value) => Err(ProgramError::OutputValue {
                file: file(),
                value,
                low,
                high,
                dialect: dialect.name(),
            }),
            None => Ok(Self { name, passes, idle }),
        }
    }
}

/// Set pressure for a contact force [N] in the middle of the edge, as a share of the greatest one.
fn share(cell: &Cell, force: f64) -> f64 {
    let scenario = &cell.setup.scenario;
    let device = &scenario.nominal.device;
    let (greatest, _) = attainable_set_pressure(device, &scenario.sensing.command);
    let [low, high] = cell.gravity_on_edge;
    let map = PressureMap::new(device);
    map.set_pressure(force * cell.axial_share, 0.5 * (low + high)) / greatest
}

/// The value on straight lines between points; none beyond them.
fn between(at: &[f64], values: &[f64], wanted: f64) -> Option<f64> {
    let pairs = at.windows(2).zip(values.windows(2));
    pairs.into_iter().find_map(|(at, values)| {
        let inside = (at[0]..=at[1]).contains(&wanted);
        inside.then(|| values[0] + (values[1] - values[0]) * (wanted - at[0]) / (at[1] - at[0]))
    })
}
