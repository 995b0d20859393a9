//! `idc predict`: what a rig file says of a recording's inputs, and how far that is from what was measured.

use std::fmt::Write as _;
use std::path::Path;

use super::cli::PredictArguments;
use super::error::{AppError, ExitCode};
use super::output::say;
use super::recordings::{read_rig, shown_columns};
use crate::diagnosis::clean::clean;
use crate::diagnosis::recorded::{COLUMNS, recorded_of};
use crate::plant::simulate;
use crate::recording::csv::write_csv;
use crate::scenario::rig_file::load_rig;

/// Predicts and writes.
pub(super) fn predict(arguments: &PredictArguments) -> Result<ExitCode, AppError> {
    let rig = load_rig(&arguments.rig)?;
    let file = arguments.inputs.display().to_string();
    let recording = read_rig(rig.plant.chain, &arguments.inputs)?;
    let mut taken = recorded_of(rig.plant.chain, &file, &recording)?;
    for input in [&arguments.rig, &arguments.inputs] {
        if same_file(input, &arguments.out) {
            return Err(AppError::Overwrites {
                file: arguments.out.display().to_string(),
            });
        }
    }
    let time = &taken.inputs.time;
    let predicted = simulate(&rig.plant, &taken.inputs).readings;
    for (column, values) in COLUMNS.into_iter().zip(&predicted) {
        if let Some(index) = values.iter().position(|value| !value.is_finite()) {
            return Err(AppError::Astray {
                rig: arguments.rig.display().to_string(),
                inputs: file,
                time: time[index],
                column,
                value: values[index],
            });
        }
    }
    let columns = shown_columns(rig.plant.chain, &predicted);
    write_csv(&arguments.out, time, &columns)?;
    if arguments.quiet {
        return Ok(ExitCode::Done);
    }
    let mut text = String::new();
    let mass = rig.plant.device.moving_mass;
    let cleaning = clean(time, &mut taken.readings, &rig.noise, mass);
    for sentence in cleaning.account(&rig.noise) {
        // Writing into a text cannot fail.
        let _ = writeln!(text, "note: {sentence}");
    }
    for (channel, column) in COLUMNS.into_iter().enumerate() {
        let measured = &taken.readings[channel];
        if let Some(rms) = whitened(measured, &predicted[channel], rig.noise[channel]) {
            let _ = writeln!(
                text,
                "{column:<24} measured less predicted: RMS {rms:.3} standard deviations of the sensor's noise"
            );
        }
    }
    let _ = writeln!(
        text,
        "{} samples written to {}",
        time.len(),
        arguments.out.display()
    );
    say(&text)?;
    Ok(ExitCode::Done)
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

fn same_file(one: &Path, other: &Path) -> bool {
    match (one.canonicalize(), other.canonicalize()) {
        (Ok(one), Ok(other)) => one == other,
        _ => false,
    }
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
