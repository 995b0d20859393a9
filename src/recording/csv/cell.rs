//! A recording of a robot cell: the columns of a rig's that it has, and the commands and encoders of the arm's joints.

use std::path::Path;

use super::super::{RecordingError, schema};
use super::columns::{COLUMNS, Column, TIME};
use super::{check_plausible, check_step, table};
use crate::unit::SiUnit as Unit;

/// A recording of a cell; NaN where there is no value.
#[derive(Debug, Clone, PartialEq)]
pub struct CellRecording {
    /// Sample times [s].
    pub time: Vec<f64>,
    /// Commanded position along the edge [m].
    pub path: Vec<f64>,
    /// Commanded angles of each joint, base first [rad].
    pub commands: Vec<Vec<f64>>,
    /// Reading of each joint's encoder [rad]; none where the file lacks it.
    pub encoders: Vec<Option<Vec<f64>>>,
    /// Torque of each joint's drive [N m]; none where it was not recorded.
    pub torques: Vec<Option<Vec<f64>>>,
    /// Set pressure [Pa gauge].
    pub set_pressure: Vec<f64>,
    /// Readings by their quantity in the schema; a quantity whose column the file lacks is absent.
    pub readings: Vec<(&'static str, Vec<f64>)>,
    /// Lines, from 1, that repeated the line before them and were left out.
    pub repeated: Vec<u64>,
    /// Columns that mean nothing here and were left out.
    pub ignored: Vec<String>,
}

/// Columns of joints: commands, encoders, torques.
const JOINTS: [[&str; 3]; 8] = [
    ["joint_1_command_rad", "joint_1_rad", "joint_1_torque_n_m"],
    ["joint_2_command_rad", "joint_2_rad", "joint_2_torque_n_m"],
    ["joint_3_command_rad", "joint_3_rad", "joint_3_torque_n_m"],
    ["joint_4_command_rad", "joint_4_rad", "joint_4_torque_n_m"],
    ["joint_5_command_rad", "joint_5_rad", "joint_5_torque_n_m"],
    ["joint_6_command_rad", "joint_6_rad", "joint_6_torque_n_m"],
    ["joint_7_command_rad", "joint_7_rad", "joint_7_torque_n_m"],
    ["joint_8_command_rad", "joint_8_rad", "joint_8_torque_n_m"],
];
/// Most turns that a joint makes, both ways [rad]; degrees are soon beyond.
const MOST_TURNS: f64 = 14.0;

/// Reads a recording of a cell whose arm has so many joints.
///
/// # Errors
/// File, line and column of what is wrong, what was found and what was expected.
pub fn read_cell_csv(path: &Path, joints: usize) -> Result<CellRecording, RecordingError> {
    let columns = columns(joints);
    let mut table = table::read(path, &columns)?;
    for (column, values) in columns.iter().zip(&table.columns) {
        match values {
            Some(values) => {
                check_plausible(path, column, values, &table.lines)?;
                if column.is_input {
                    check_given(path, column, values, &table.lines)?;
                }
            }
            None if column.is_input => {
                return Err(RecordingError::Column {
                    path: path.to_owned(),
                    column: column.name.to_owned(),
                    found: "missing".to_owned(),
                    expected: format!("it, as the arm has {joints} joints"),
                });
            }
            None => {}
        }
    }
    check_step(path, &table.time)?;
    let mut taken = table.columns.drain(..);
    let mut next = || taken.next().flatten();
    // Inputs are there by now.
    let path_length = next().unwrap_or_default();
    let set_pressure = next().unwrap_or_default();
    let commands = (0..joints).map(|_| next().unwrap_or_default()).collect();
    let encoders = (0..joints).map(|_| next()).collect();
    let torques = (0..joints).map(|_| next()).collect();
    let readings = columns[2 + 3 * joints..]
        .iter()
        .filter_map(|column| Some((column.quantity, next()?)))
        .collect();
    drop(taken);
    Ok(CellRecording {
        time: table.time,
        path: path_length,
        commands,
        encoders,
        torques,
        set_pressure,
        readings,
        repeated: table.repeated,
        ignored: table.ignored,
    })
}

/// Path, set pressure, commands, encoders, torques, readings.
fn columns(joints: usize) -> Vec<Column> {
    let of_rig = |quantity: &str| COLUMNS.iter().find(|c| c.quantity == quantity).cloned();
    let length = Column {
        name: "path_m",
        quantity: schema::PATH_LENGTH,
        unit: Unit::Metre,
        is_input: true,
        is_held: false,
        range: [-1e3, 1e3],
        larger_than_si: Some("mm"),
        least_maximum: 0.0,
    };
    let joint = |name: &'static str, is_input: bool| Column {
        name,
        quantity: "",
        unit: Unit::Radian,
        is_input,
        range: [-MOST_TURNS, MOST_TURNS],
        larger_than_si: Some("degrees"),
        ..length
    };
    let mut columns = vec![length.clone()];
    columns.extend(of_rig(schema::SET_PRESSURE_GAUGE));
    columns.extend(JOINTS[..joints].iter().map(|names| joint(names[0], true)));
    columns.extend(JOINTS[..joints].iter().map(|names| joint(names[1], false)));
    let torque = |names: &[&'static str; 3]| Column {
        unit: Unit::NewtonMetre,
        range: [-1e5, 1e5],
        larger_than_si: None,
        ..joint(names[2], false)
    };
    columns.extend(JOINTS[..joints].iter().map(torque));
    for quantity in [
        schema::MEASURED_REGULATOR_PRESSURE_GAUGE,
        schema::MEASURED_STROKE,
        schema::MEASURED_FORCE,
        schema::MEASURED_ACCELERATION,
    ] {
        columns.extend(of_rig(quantity));
    }
    columns
}

/// The arm's command is known at each sample, or nothing can be said of it.
fn check_given(
    path: &Path,
    column: &Column,
    values: &[f64],
    lines: &[u64],
) -> Result<(), RecordingError> {
    if column.is_held {
        return Ok(());
    }
    match values.iter().position(|value| value.is_nan()) {
        None => Ok(()),
        Some(index) => Err(RecordingError::Line {
            path: path.to_owned(),
            line: lines[index],
            column: column.name.to_owned(),
            found: "empty".to_owned(),
            expected: format!("a value beside each {TIME}"),
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<CellRecording, RecordingError> {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.csv");
        std::fs::write(&file, text).unwrap();
        read_cell_csv(&file, 1)
    }

    #[test]
    fn columns_go_where_they_belong_and_what_was_not_measured_is_absent() {
        let text = "time_s,path_m,joint_1_command_rad,joint_1_rad,set_pressure_pa,force_n\n\
                    0,0.1,1.5,1.4,0,\n0.002,0.2,1.6,,3000,7\n";
        let taken = read(text).unwrap();
        assert_eq!(taken.path, [0.1, 0.2]);
        assert_eq!(taken.commands, [[1.5, 1.6]]);
        assert_eq!(taken.encoders[0].as_ref().unwrap()[0], 1.4);
        assert!(taken.encoders[0].as_ref().unwrap()[1].is_nan());
        assert_eq!(taken.set_pressure, [0.0, 3000.0]);
        assert_eq!(taken.readings.len(), 1);
        assert_eq!(
            (taken.readings[0].0, taken.readings[0].1[1]),
            (schema::MEASURED_FORCE, 7.0)
        );
    }

    #[test]
    fn what_is_missing_lost_or_in_degrees_is_refused_by_its_column() {
        let says = |text: &str| read(text).unwrap_err().to_string();
        let missing = says("time_s,path_m,set_pressure_pa\n0,0,0\n0.002,0,0\n");
        assert!(missing.contains("joint_1_command_rad"), "{missing}");
        let lost = says("time_s,path_m,set_pressure_pa,joint_1_command_rad\n0,0,0,1\n0.002,0,0,\n");
        assert!(
            lost.contains("joint_1_command_rad") && lost.contains("empty"),
            "{lost}"
        );
        let degrees =
            says("time_s,path_m,set_pressure_pa,joint_1_command_rad\n0,0,0,90\n0.002,0,0,91\n");
        assert!(degrees.contains("degrees"), "{degrees}");
    }
}
