//! `idc predict`: what a rig file says of a recording's inputs, and how far that is from what was measured.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::PathBuf;

use clap::Args;

use super::error::{AppError, ExitCode};
use super::files::{Standing, is_same, prepare_file};
use super::output::say;
use super::progress;
use crate::case::{check_finite, predict_table, predicted_by, read_rig, shown_columns};
use crate::diagnosis::clean::clean;
use crate::diagnosis::details::UnknownGround;
use crate::diagnosis::recorded::{COLUMNS, recorded_of};
use crate::diagnosis::words::of_column;
use crate::quantity::{counted, significant};
use crate::recording::atomic::write_text;
use crate::recording::csv::write_csv;
use crate::scenario::removal_table::is_removal_table;
use crate::scenario::rig_file::load_rig;

#[derive(Debug, Args)]
pub(super) struct PredictArguments {
    /// Rig file.
    rig: PathBuf,
    /// Recording whose inputs drive the rig; what it holds of measured columns is compared.
    inputs: PathBuf,
    /// File for the predicted columns with their 90 % bands.
    #[arg(long, default_value = "prediction.csv", help_heading = "Output")]
    out: PathBuf,
    /// Put new results in place of old ones.
    #[arg(long, help_heading = "Output")]
    force: bool,
    /// Print nothing but errors.
    #[arg(long, help_heading = "Output")]
    quiet: bool,
    /// Print as JSON how far off the prediction is.
    #[arg(long, conflicts_with = "quiet", help_heading = "Output")]
    json: bool,
}

/// Predicts and writes.
pub(super) fn predict(arguments: &PredictArguments) -> Result<ExitCode, AppError> {
    if is_removal_table(&arguments.rig) {
        return of_table(arguments);
    }
    let rig = load_rig(&arguments.rig)?;
    let file = arguments.inputs.display().to_string();
    let recording = read_rig(rig.plant.chain, &arguments.inputs)?;
    let mut taken = recorded_of(rig.plant.chain, &file, &recording)?.of_sensors(rig.sensors());
    prepare(arguments)?;
    let time = &taken.inputs.time;
    let spinner = progress::spinner("simulating", arguments.quiet || arguments.json);
    let of_model = predicted_by(&rig, &taken.inputs);
    let predicted = &of_model.readings;
    spinner.finish_and_clear();
    let rig_file = arguments.rig.display().to_string();
    check_finite(&rig_file, &file, time, predicted)?;
    let columns = of_model.columns(&shown_columns(rig.plant.chain, rig.sensors(), predicted));
    let columns: Vec<(&str, &[f64])> = (columns
        .iter()
        .map(|(name, values)| (name.as_str(), values.as_slice())))
    .collect();
    write_csv(&arguments.out, time, &columns)?;
    if arguments.quiet {
        return Ok(ExitCode::Done);
    }
    let mass = rig.plant.device.moving_mass;
    let cleaning = clean(time, &mut taken.readings, &rig.noise, mass);
    let mut notes = cleaning.account(&rig.noise);
    notes.extend(UnknownGround::words(&file, &of_model.unknown));
    let off: Vec<Error> = (0..COLUMNS.len())
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
    say(&if arguments.json {
        json(arguments, (time.len(), &of_model.unknown), &notes, &off)
    } else {
        text(arguments, time.len(), &notes, &off)
    })?;
    Ok(ExitCode::Done)
}

/// Makes sure that the prediction goes where it does no harm.
fn prepare(arguments: &PredictArguments) -> Result<(), AppError> {
    for input in [&arguments.rig, &arguments.inputs] {
        if is_same(input, &arguments.out) {
            return Err(AppError::Overwrites {
                file: arguments.out.display().to_string(),
            });
        }
    }
    let ending = arguments.out.extension();
    if ending.is_some_and(|ending| !ending.eq_ignore_ascii_case("csv")) {
        return Err(AppError::OutputFile {
            file: arguments.out.display().to_string(),
            option: "--out",
            reason: "a prediction is written as comma-separated values, and its name ends otherwise than in .csv".to_owned(),
        });
    }
    prepare_file(&arguments.out, "--out", Standing::of(arguments.force))
}

/// Predicts what comes off in the runs of a table.
fn of_table(arguments: &PredictArguments) -> Result<ExitCode, AppError> {
    let (rows, left) = predict_table(&arguments.rig, &arguments.inputs)?;
    prepare(arguments)?;
    write_text(&arguments.out, &rows)?;
    let out = arguments.out.display();
    if arguments.json {
        let document = serde_json::json!({
            "rig": arguments.rig.display().to_string(),
            "inputs": arguments.inputs.display().to_string(),
            "prediction": out.to_string(),
            "rows": left.rows,
            "rows_without_prediction": left.nothing,
            "rms_of_log_volume": left.log,
        });
        say(&format!("{document:#}\n"))?;
    } else if !arguments.quiet {
        say(&format!(
            "removed volume: RMS {} of ln(measured / predicted), {} % of the predicted volume, in {}\nwritten to {out}\n",
            significant(left.log, 2),
            significant(100.0 * left.share, 2),
            counted(left.rows, "row")
        ))?;
    }
    Ok(ExitCode::Done)
}

/// Error of the prediction of a column.
struct Error {
    column: &'static str,
    /// Root mean square over the noise [1].
    rms: f64,
    /// Standard deviation of the sensor's noise, in the column's unit.
    noise: f64,
}

/// Printed text on columns with their errors in standard deviations of the noise.
fn text(arguments: &PredictArguments, samples: usize, notes: &[String], off: &[Error]) -> String {
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
    let out = arguments.out.display();
    let _ = writeln!(text, "{samples} samples written to {out}");
    text
}

/// The same for a program.
fn json(
    arguments: &PredictArguments,
    (samples, unknown): (usize, &[UnknownGround]),
    notes: &[String],
    off: &[Error],
) -> String {
    let off: BTreeMap<&str, f64> = off.iter().map(|e| (e.column, e.rms)).collect();
    let document = serde_json::json!({
        "rig": arguments.rig.display().to_string(),
        "inputs": arguments.inputs.display().to_string(),
        "prediction": arguments.out.display().to_string(),
        "samples": samples,
        "notes": notes,
        "unknown_ground": unknown,
        "rms_in_standard_deviations_of_noise": off,
    });
    format!("{document:#}\n")
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
