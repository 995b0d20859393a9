//! `idc predict`: what a rig file says of a recording's inputs, and how far that is from what was measured.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::Value;

use super::error::{AppError, ExitCode};
use super::files::{OverwritePolicy, is_same, prepare_files};
use super::output::say;
use super::progress;
use super::terminal::shown_path;
use crate::case::{
    check_finite, predict_arm, predict_flange_run, predict_postures, predict_table, predicted_by,
    read_rig, shown_columns,
};
use crate::diagnosis::answer::details::UnknownGround;
use crate::diagnosis::answer::words::of_column;
use crate::diagnosis::recordings::clean::clean;
use crate::diagnosis::recordings::device::Device;
use crate::diagnosis::recordings::recorded::{COLUMNS, recorded_of};
use crate::flange::FittedFlange;
use crate::plant::Channel;
use crate::quantity::{counted, significant};
use crate::recording::atomic::write_all;
use crate::recording::csv::columns_text;
use crate::recording::long_column::LongColumn;
use crate::scenario::arm_file::{ArmFile, is_arm_file, is_arm_text, load_arm_file};
use crate::scenario::postures_file::is_postures_file;
use crate::scenario::removal_table::is_removal_table;
use crate::scenario::rig_file::{RigFile, load_rig};
use crate::scenario::{arm_file, rig_file};

#[derive(Debug, Args)]
pub(super) struct PredictArguments {
    /// Rig file, file of a recorded arm, or of still postures.
    rig: PathBuf,
    /// Recordings whose inputs drive the rig; what they hold of measured columns is compared.
    #[arg(required = true, value_name = "INPUTS")]
    inputs: Vec<PathBuf>,
    /// File for the predicted columns with their 90 % bands; of several recordings a folder for one each. Default: prediction.csv, of several predictions.
    #[arg(long, help_heading = "Output")]
    out: Option<PathBuf>,
    /// Put new results in place of old ones.
    #[arg(long, help_heading = "Output")]
    force: bool,
    /// Print nothing but errors.
    #[arg(long, help_heading = "Output")]
    quiet: bool,
    /// Print as JSON how far off the predictions are.
    #[arg(long, conflicts_with = "quiet", help_heading = "Output")]
    json: bool,
}

/// A prediction, not yet written.
struct Made {
    /// File that it is for.
    out: PathBuf,
    /// Its text.
    csv: String,
    /// The same as columns.
    columns: Vec<(String, LongColumn)>,
    /// What is printed of it.
    said: String,
    /// The same for a program.
    document: Value,
}

/// What predicts.
enum Model {
    Rig(Box<RigFile>),
    Arm(Box<ArmFile>),
    Postures(PathBuf),
    Table(PathBuf),
}

impl Model {
    fn load(file: &Path) -> Result<Self, AppError> {
        Ok(if is_removal_table(file) {
            Self::Table(file.to_owned())
        } else if is_postures_file(file) {
            Self::Postures(file.to_owned())
        } else if is_arm_file(file) {
            Self::Arm(Box::new(load_arm_file(file)?))
        } else {
            Self::Rig(Box::new(load_rig(file)?))
        })
    }

    fn predict(&self, inputs: &Path, out: PathBuf) -> Result<Made, AppError> {
        match self {
            Self::Table(file) => of_table(file, inputs, out),
            Self::Postures(file) => of_postures(file, inputs, out),
            Self::Arm(arm) => of_arm(arm, inputs, out),
            Self::Rig(rig) => match &rig.flange {
                Some(flange) => of_flange((rig, flange), inputs, out),
                None => of_recording(rig, inputs, out),
            },
        }
    }
}

/// A prediction for a caller in the same process.
pub struct PredictedTable {
    /// The columns of what `idc predict` writes.
    pub columns: Vec<(String, LongColumn)>,
    /// How far off they are, as --json prints it.
    pub document: Value,
}

/// Predicts as `idc predict` does; nothing is written. `text` is that of a model that could stand in the file `model`, where it does not stand there.
///
/// # Errors
/// What is wrong with model or inputs.
pub fn predict_table_of(
    model: &Path,
    text: Option<&str>,
    inputs: &Path,
) -> Result<PredictedTable, AppError> {
    let loaded = match text {
        None => Model::load(model)?,
        Some(text) if is_arm_text(model, text) => {
            Model::Arm(Box::new(arm_file::from_text(model, text)?))
        }
        Some(text) => Model::Rig(Box::new(rig_file::from_text(model, text)?)),
    };
    let Made {
        columns,
        mut document,
        ..
    } = loaded.predict(inputs, PathBuf::new())?;
    if let Some(numbers) = document.as_object_mut() {
        numbers.remove("prediction");
    }
    Ok(PredictedTable { columns, document })
}

/// Columns with their time [s].
fn timed(time: &[f64], columns: &[(&str, &[f64])]) -> Vec<(String, LongColumn)> {
    let first = [("time_s", time)].into_iter();
    let all = first.chain(columns.iter().copied());
    all.map(|(name, values)| (name.to_owned(), LongColumn::Numbers(values.to_vec())))
        .collect()
}

/// Predicts and writes: all, or nothing.
pub(super) fn predict(arguments: &PredictArguments) -> Result<ExitCode, AppError> {
    let outs = outs(arguments)?;
    let model = Model::load(&arguments.rig)?;
    let hidden = arguments.quiet || arguments.json || !matches!(model, Model::Rig(_));
    let spinner = progress::spinner("simulating", hidden);
    let all = arguments.inputs.iter().zip(outs);
    let made: Result<Vec<Made>, AppError> = all
        .map(|(inputs, out)| model.predict(inputs, out))
        .collect();
    spinner.finish_and_clear();
    let made = made?;
    let files: Vec<(&PathBuf, &String)> = made.iter().map(|one| (&one.out, &one.csv)).collect();
    let paths: Vec<&PathBuf> = files.iter().map(|(path, _)| *path).collect();
    let _claims = prepare_files(&paths, "--out", OverwritePolicy::of(arguments.force))?;
    write_all(&files)?;
    if arguments.json {
        let mut documents: Vec<Value> = made.into_iter().map(|one| one.document).collect();
        let document = match documents.len() {
            1 => documents.remove(0),
            _ => serde_json::json!({ "predictions": documents }),
        };
        say(&format!("{document:#}\n"))?;
    } else if !arguments.quiet {
        let said: Vec<String> = made.into_iter().map(|one| one.said).collect();
        say(&said.join("\n"))?;
    }
    Ok(ExitCode::Done)
}

/// Files for the predictions, where they do no harm.
fn outs(arguments: &PredictArguments) -> Result<Vec<PathBuf>, AppError> {
    let several = arguments.inputs.len() > 1;
    let default = if several {
        "predictions"
    } else {
        "prediction.csv"
    };
    let out = arguments.out.clone().unwrap_or_else(|| default.into());
    let of = |inputs: &PathBuf| match several {
        true => out.join(inputs.with_extension("csv").file_name().unwrap_or_default()),
        false => out.clone(),
    };
    let outs: Vec<PathBuf> = arguments.inputs.iter().map(of).collect();
    let refuse = |out: &Path, reason: &str| AppError::OutputFile {
        file: out.display().to_string(),
        option: "--out",
        reason: reason.to_owned(),
    };
    for (place, out) in outs.iter().enumerate() {
        for input in arguments.inputs.iter().chain([&arguments.rig]) {
            if is_same(input, out) {
                return Err(AppError::Overwrites {
                    file: out.display().to_string(),
                });
            }
        }
        if outs[..place].contains(out) {
            let reason = "two of the recordings have this name, and their predictions would be one file; predict them in two calls";
            return Err(refuse(out, reason));
        }
        let ending = out.extension();
        if ending.is_some_and(|ending| !ending.eq_ignore_ascii_case("csv")) {
            let reason = "a prediction is written as comma-separated values, and its name ends otherwise than in .csv";
            return Err(refuse(out, reason));
        }
    }
    Ok(outs)
}

/// Predicts a recording.
fn of_recording(rig: &RigFile, inputs: &Path, out: PathBuf) -> Result<Made, AppError> {
    let file = inputs.display().to_string();
    let recording = read_rig(rig.plant.parts, inputs)?;
    let mut taken = recorded_of(rig.plant.parts, &file, &recording)?.of_sensors(rig.sensors());
    let time = &taken.inputs.time;
    let of_model = predicted_by(rig, &taken.inputs);
    let predicted = &of_model.readings;
    check_finite(&rig.path.display().to_string(), &file, time, predicted)?;
    let columns = of_model.columns(&shown_columns(rig.plant.parts, rig.sensors(), predicted));
    let columns: Vec<(&str, &[f64])> = (columns
        .iter()
        .map(|(name, values)| (name.as_str(), values.as_slice())))
    .collect();
    let csv = columns_text(time, &columns)?;
    let cleaning = clean::<Device>(time, &mut taken.readings, &rig.noise, &rig.plant);
    let mut notes = cleaning.account::<Device>(&rig.noise);
    notes.extend(UnknownGround::words(&file, &of_model.unknown));
    let off: Vec<Error<'_>> = (0..COLUMNS.len())
        .filter_map(|channel| {
            let [measured, predicted] = [&taken.readings[channel], &predicted[channel]];
            let noise = rig.noise[channel];
            Some(Error {
                column: COLUMNS[channel],
                rms: whitened(measured, predicted, noise)?,
                noise,
            })
        })
        .collect();
    let rms: BTreeMap<&str, f64> = off.iter().map(|e| (e.column, e.rms)).collect();
    Ok(Made {
        columns: timed(time, &columns),
        said: text(&out, time.len(), &notes, &off),
        document: serde_json::json!({
            "rig": rig.path.display().to_string(),
            "inputs": file,
            "prediction": out.display().to_string(),
            "samples": time.len(),
            "notes": notes,
            "unknown_ground": of_model.unknown,
            "rms_in_standard_deviations_of_noise": rms,
        }),
        out,
        csv,
    })
}

/// Predicts what the sensors of a recorded arm read.
fn of_arm(arm: &ArmFile, inputs: &Path, out: PathBuf) -> Result<Made, AppError> {
    let file = inputs.display().to_string();
    let predicted = predict_arm(arm, inputs)?;
    let columns = predicted.columns.iter();
    let columns: Vec<(&str, &[f64])> = columns
        .map(|column| (column.name.as_str(), column.predicted.as_slice()))
        .collect();
    let errors = predicted.columns.iter().filter_map(|column| {
        Some(Error {
            column: &column.name,
            rms: whitened(&column.measured, &column.predicted, column.noise)?,
            noise: column.noise,
        })
    });
    let off: Vec<Error<'_>> = errors.collect();
    let rms: BTreeMap<&str, f64> = off.iter().map(|e| (e.column, e.rms)).collect();
    let samples = predicted.time.len();
    Ok(Made {
        columns: timed(&predicted.time, &columns),
        csv: columns_text(&predicted.time, &columns)?,
        said: text(&out, samples, &predicted.notes, &off),
        document: serde_json::json!({
            "arm": arm.path.display().to_string(),
            "inputs": file,
            "prediction": out.display().to_string(),
            "samples": samples,
            "notes": predicted.notes,
            "rms_in_standard_deviations_of_noise": rms,
        }),
        out,
    })
}

/// Predicts a run of a contact flange that was fitted to others.
fn of_flange(
    (rig, flange): (&RigFile, &FittedFlange),
    inputs: &Path,
    out: PathBuf,
) -> Result<Made, AppError> {
    let file = inputs.display().to_string();
    let Some(made) = predict_flange_run(rig, flange, inputs)? else {
        return Err(AppError::NeverSettles { file });
    };
    let mut said = String::new();
    // Writing into a text cannot fail.
    for sentence in &made.notes {
        let _ = writeln!(said, "note: {sentence}.");
    }
    let _ = writeln!(
        said,
        "{}, predicted with 90 % interval; recorded",
        shown_path(inputs)
    );
    let run = &made.run;
    let spread = run.sliding_spread_n;
    let results = [
        ("peak of the impact", "N", Some(run.peak_n)),
        ("ringing", "Hz", run.ringing_hz),
        ("settling", "s", Some(run.settling_s)),
        ("spread while sliding", "N", spread),
    ];
    for (what, unit, result) in results {
        let Some(result) = result else { continue };
        let shown = |value: f64| significant(value, 3);
        let _ = writeln!(
            said,
            "{what:<24} {} {unit} ({} to {}); {} {unit}",
            shown(result.simulated),
            shown(result.low),
            shown(result.high),
            shown(result.recorded)
        );
    }
    let samples = made.time.len();
    let _ = writeln!(said, "{samples} samples written to {}", shown_path(&out));
    let force = COLUMNS[Channel::Force as usize];
    Ok(Made {
        columns: timed(&made.time, &[(force, &made.force)]),
        csv: columns_text(&made.time, &[(force, &made.force)])?,
        document: serde_json::json!({
            "rig": rig.path.display().to_string(),
            "inputs": file,
            "prediction": out.display().to_string(),
            "samples": samples,
            "notes": made.notes,
            "run": made.run,
        }),
        said,
        out,
    })
}

/// Predicts what comes off in the runs of a table.
fn of_table(rig: &Path, inputs: &Path, out: PathBuf) -> Result<Made, AppError> {
    let predicted = predict_table(rig, inputs)?;
    let left = predicted.left;
    Ok(Made {
        said: format!(
            "removed volume: RMS {} of ln(measured / predicted), {} % of the predicted volume, in {}\nwritten to {}\n",
            significant(left.log, 2),
            significant(100.0 * left.share, 2),
            counted(left.rows, "row"),
            out.display()
        ),
        document: serde_json::json!({
            "rig": rig.display().to_string(),
            "inputs": inputs.display().to_string(),
            "prediction": out.display().to_string(),
            "rows": left.rows,
            "rows_without_prediction": left.nothing,
            "rms_of_log_volume": left.log,
        }),
        csv: predicted.csv,
        columns: predicted.columns,
        out,
    })
}

/// Predicts what a wrench sensor reads in still postures.
fn of_postures(file: &Path, inputs: &Path, out: PathBuf) -> Result<Made, AppError> {
    let predicted = predict_postures(file, inputs)?;
    let mut said = String::new();
    for (column, rms) in &predicted.off {
        let (_, unit, factor) = of_column(column);
        // Writing into a text cannot fail.
        let _ = writeln!(
            said,
            "{column:<24} measured less predicted: RMS {} {unit}",
            significant(factor * rms, 3)
        );
    }
    let postures = counted(predicted.postures, "posture");
    let _ = writeln!(said, "{postures} written to {}", shown_path(&out));
    let rms: BTreeMap<&str, f64> = predicted.off.into_iter().collect();
    Ok(Made {
        document: serde_json::json!({
            "postures_file": file.display().to_string(),
            "inputs": inputs.display().to_string(),
            "prediction": out.display().to_string(),
            "postures": predicted.postures,
            "rms": rms,
        }),
        csv: predicted.csv,
        columns: predicted.columns,
        said,
        out,
    })
}

/// Error of the prediction of a column.
struct Error<'a> {
    column: &'a str,
    /// Root mean square over the noise [1].
    rms: f64,
    /// Standard deviation of the sensor's noise, in the column's unit.
    noise: f64,
}

/// Printed text on columns with their errors in standard deviations of the noise.
fn text(out: &Path, samples: usize, notes: &[String], off: &[Error<'_>]) -> String {
    let mut text = String::new();
    // Writing into a text cannot fail.
    for sentence in notes {
        let _ = writeln!(text, "note: {sentence}");
    }
    for Error { column, rms, noise } in off {
        let (_, unit, factor) = of_column(column);
        let _ = writeln!(
            text,
            "{column:<24} measured less predicted: RMS {rms:.3} standard deviations of the sensor's noise ({} {unit})",
            significant(factor * rms * noise, 3)
        );
    }
    let _ = writeln!(text, "{samples} samples written to {}", shown_path(out));
    text
}

/// Root mean square of measured less predicted in standard deviations of the noise; none where nothing was measured.
fn whitened(measured: &[f64], predicted: &[f64], noise: f64) -> Option<f64> {
    let pairs = measured.iter().zip(predicted);
    let squares: Vec<f64> = pairs
        .map(|(measured, predicted)| ((measured - predicted) / noise).powi(2))
        .filter(|square| !square.is_nan())
        .collect();
    let count = squares.len() as f64;
    (count > 0.0).then(|| (squares.iter().sum::<f64>() / count).sqrt())
}

#[cfg(test)]
mod tests {
    use super::whitened;

    #[test]
    fn errors_count_in_standard_deviations_where_there_are_any() {
        let measured = [1.0, f64::NAN, 4.0];
        let rms = whitened(&measured, &[0.0, 0.0, 0.0], 0.5).unwrap();
        assert!((rms - (34.0f64).sqrt()).abs() < 1e-12);
        assert_eq!(whitened(&[f64::NAN; 3], &[0.0; 3], 0.5), None);
    }
}
