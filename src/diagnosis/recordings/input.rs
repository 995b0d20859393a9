//! Input of a diagnosis: a nominal rig, what is tolerated of it, and recordings of what it did.

use super::clean::{Cleaning, clean};
use super::device::Device;
use super::evidence::{Evidence, Measured};
use super::predictability::unpredictable;
use super::recorded::{COLUMNS, QUANTITIES, Recorded, RecordedError};
use crate::diagnosis::data_fault::fault::DataFault;
use crate::diagnosis::fit::free::{Free, Prior};
use crate::diagnosis::search::EstablishedEffect;
use crate::diagnosis::search::kept::KeptExplanation;
use crate::effects::{Coordinate, Effect};
use crate::plant::registry::{PRESSURE_DRIFT, START_ERROR};
use crate::plant::{
    CHANNELS, Channel, DeviceParts, OperatingLimits, PlantInputs, PlantParameters, Quantity,
};
use crate::recording::csv::plausible_range;
use crate::stats::median;

/// Times by which the noise of a recording must differ from the sheet's to take its place [1].
pub(in crate::diagnosis) const OTHER_NOISE: f64 = 1.5;

/// A recording by its name.
#[derive(Debug, Clone)]
pub struct NamedRecording {
    /// File name, as the rig file has it.
    pub name: String,
    /// The file, for messages.
    pub file: String,
    /// Its content.
    pub recorded: Recorded,
}

/// A case to be diagnosed.
#[derive(Debug, Clone)]
pub struct DiagnosisInput {
    /// The nominal rig.
    pub nominal: PlantParameters,
    /// Its tolerated quantities.
    pub tolerated: Vec<Free>,
    /// Standard deviation of each sensor's noise as its sheet has it, in the order of [`CHANNELS`].
    pub noise: [f64; CHANNELS.len()],
    /// Samples a second as the sensors' sheet has it; not a number where it says none [1/s].
    pub rate: f64,
    /// Recordings to diagnose from.
    pub recordings: Vec<NamedRecording>,
    /// Recording to be predicted.
    pub unseen: Option<NamedRecording>,
    /// Effects that may be at work.
    pub candidates: Vec<&'static Effect>,
    /// Effects that a link of its own has shown.
    pub shown: Vec<EstablishedEffect>,
    /// Law among the candidates that a user tries: whatever the search comes to, it is fitted in full.
    pub tried: Option<&'static Effect>,
    /// Faults of sensors and clocks that were found, and taken off the recordings.
    pub data_faults: Vec<DataFault>,
    /// How far an experiment may move the rig, as its file states.
    pub limits: OperatingLimits,
    /// Explanations that were found in a part of the recordings, to go on from; nothing to begin with nothing.
    pub kept: Vec<KeptExplanation>,
}

impl DiagnosisInput {
    /// Whether what was measured is plausible as SI, in the recording to be predicted too: nearly all readings of each channel, and some pressure where a sensor has readings of it.
    #[must_use]
    pub fn is_in_si(&self) -> bool {
        /// Share of the readings that may be wild [1].
        const WILD: f64 = 0.02;
        /// Largest pressure that none is below [Pa].
        const LEAST_PRESSURE: f64 = 50.0;
        let plausible = |recording: &NamedRecording| {
            let channels = QUANTITIES.iter().zip(&recording.recorded.readings);
            let mut channels = channels.enumerate();
            channels.all(|(index, (quantity, values))| {
                let [low, high] = plausible_range(quantity);
                let given = values.iter().filter(|value| value.is_finite());
                let outside = given.clone().filter(|v| !(low..=high).contains(*v)).count();
                let largest = given.clone().fold(0.0, |most: f64, v| most.max(*v));
                let is_pressure = index == Channel::RegulatorPressure as usize;
                outside as f64 <= WILD * given.count() as f64
                    && !(is_pressure && largest > 0.0 && largest < LEAST_PRESSURE)
            })
        };
        self.recordings.iter().chain(&self.unseen).all(plausible)
    }
}

/// A number that lies within a relative tolerance of a value, any part of it being as likely: the normal distribution of that spread.
#[must_use]
pub fn tolerated(quantity: Quantity, value: f64, tolerance: f64) -> Free {
    let half = (value * tolerance).abs();
    let deviation = half / 3f64.sqrt();
    Free {
        quantity,
        start: value,
        coordinate: Coordinate::Linear(deviation),
        bounds: [value - half, value + half],
        prior: Prior::Normal {
            mean: value,
            deviation,
        },
    }
}

/// Quantities that are never known exactly of a rig with a part of the device: where a closed chamber starts, which its first readings tell to their noise [Pa], and
/// how far its sensor drifts, one standard deviation [Pa/s].
#[must_use]
pub fn of_link(parts: DeviceParts, noise: f64, drift: f64) -> Vec<Free> {
    let free = |quantity: Quantity, deviation: f64| Free {
        quantity,
        start: 0.0,
        coordinate: Coordinate::Linear(deviation),
        bounds: [-20.0 * deviation, 20.0 * deviation],
        prior: Prior::Normal {
            mean: 0.0,
            deviation,
        },
    };
    let mut found = Vec::new();
    if parts == DeviceParts::ClosedChamber {
        found.push(free(START_ERROR.named("start_error_pa"), noise));
    }
    if drift > 0.0 && parts.output() == Some(Channel::RegulatorPressure) {
        found.push(free(
            PRESSURE_DRIFT.named("pressure_sensor_drift_pa_per_s"),
            drift,
        ));
    }
    found
}

/// Recordings made fit to be used.
#[derive(Debug)]
pub struct Prepared {
    /// The evidence in them.
    pub evidence: Evidence,
    /// Readings set aside in each.
    pub cleanings: Vec<Cleaning>,
    /// Sentences on what was done, for people.
    pub notes: Vec<String>,
}

/// Sets aside what is wild, finds the noise, checks that there is something to diagnose from.
///
/// # Errors
/// A recording that is too short, measures nothing, or is in other units than the rig file.
pub fn prepare(case: &DiagnosisInput) -> Result<Prepared, RecordedError> {
    let mut cleanings = Vec::new();
    let mut notes: Vec<String> = case.data_faults.iter().map(DataFault::words).collect();
    let mut measured = Vec::new();
    for recording in &case.recordings {
        let mut readings = recording.recorded.readings.clone();
        let inputs = recording.recorded.inputs.clone();
        let mut cleaning = clean::<Device>(&inputs.time, &mut readings, &case.noise, &case.nominal);
        for (channel, lost) in CHANNELS.into_iter().zip(&mut cleaning.lost) {
            let mut faults = case.data_faults.iter();
            if faults.any(|fault| fault.sets_aside(channel, &recording.name)) {
                *lost = 0;
            }
        }
        recording
            .recorded
            .check(&recording.file, &cleaning.noise, &case.noise)?;
        let name = &recording.name;
        if case.nominal.parts == DeviceParts::Whole {
            notes.extend(missing(name, &readings, &case.noise));
        }
        let held = inputs.initial.samples();
        if held > 0 {
            let until = inputs.time[held.min(inputs.time.len() - 1)] - inputs.time[0];
            notes.push(format!(
                "{name} begins in mid-motion or under pressure: its first {until:.2} s bring the model to that state, and are compared with nothing"
            ));
        }
        if recording.recorded.filled > 0 {
            notes.push(format!(
                "{name}: {} lost values of the inputs filled in",
                recording.recorded.filled
            ));
        }
        let sentences = cleaning.account::<Device>(&case.noise);
        notes.extend(
            sentences
                .iter()
                .map(|sentence| format!("{name}: {sentence}")),
        );
        cleanings.push(cleaning);
        if case.nominal.parts == DeviceParts::Whole {
            notes.extend(
                (leave_out_bouncing(case, &inputs, &mut readings).iter())
                    .map(|sentence| format!("{name}: {sentence}")),
            );
        }
        measured.push(Measured {
            name: name.clone(),
            free: inputs.surface.iter().all(|surface| surface.is_nan()),
            inputs,
            readings,
        });
    }
    let noise = nominal_noise(&cleanings, &case.noise);
    Ok(Prepared {
        evidence: Evidence::new(measured, noise),
        cleanings,
        notes,
    })
}

/// Leaves out what was read while the tool bounced unpredictably, but for the regulator's pressure; a sentence on each stretch.
fn leave_out_bouncing(
    case: &DiagnosisInput,
    inputs: &PlantInputs,
    readings: &mut [Vec<f64>; CHANNELS.len()],
) -> Vec<String> {
    let noise = case.noise[Channel::Force as usize];
    let force = readings[Channel::Force as usize].clone();
    let of = |plant: &PlantParameters| unpredictable(plant, inputs, (&force, noise));
    let mut stretches = of(&case.nominal);
    // A device within its tolerances diverges at other times.
    if !stretches.is_empty() {
        let others = at_the_ends_of_tolerances(case);
        stretches.extend(others.iter().flat_map(of));
    }
    let stretches = joined(stretches);
    for [start, end] in &stretches {
        let moved = CHANNELS.into_iter().zip(readings.iter_mut());
        for (_, values) in moved.filter(|(channel, _)| *channel != Channel::RegulatorPressure) {
            for (time, value) in inputs.time.iter().zip(values) {
                if (start..=end).contains(&time) {
                    *value = f64::NAN;
                }
            }
        }
    }
    let words = |[start, end]: &[f64; 2]| {
        format!(
            "from {start:.2} to {end:.2} s the tool bounces unpredictably (a change of the set pressure by 0.001 % would change its motion visibly): this part is left out of the comparison, but for the regulator's pressure"
        )
    };
    stretches.iter().map(words).collect()
}

/// The nominal model with one of its tolerated numbers off by its tolerance: each of them, either way.
fn at_the_ends_of_tolerances(case: &DiagnosisInput) -> Vec<PlantParameters> {
    let plant = |free: &Free, side: f64| {
        let deviation = free.departure_slope(free.start).abs().recip();
        deviation.is_finite().then(|| {
            let at = free.coordinate.of(free.start) + side * deviation;
            let mut plant = case.nominal.clone();
            (free.quantity).set(&mut plant, free.clamp(free.coordinate.value(at)));
            plant
        })
    };
    let ends = case.tolerated.iter();
    ends.flat_map(|free| [-1.0, 1.0].map(|side| plant(free, side)))
        .flatten()
        .collect()
}

/// Stretches, those that overlap as one, in their order.
fn joined(mut stretches: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    stretches.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut all: Vec<[f64; 2]> = Vec::new();
    for [start, end] in stretches {
        match all.last_mut() {
            Some(last) if start <= last[1] => last[1] = last[1].max(end),
            _ => all.push([start, end]),
        }
    }
    all
}

/// Channels that a recording lacks, of those that the rig has sensors of.
fn missing(
    name: &str,
    readings: &[Vec<f64>; CHANNELS.len()],
    sheet: &[f64; CHANNELS.len()],
) -> Vec<String> {
    let lacks = |values: &Vec<f64>| values.iter().all(|value| value.is_nan());
    let all = COLUMNS.into_iter().zip(readings).zip(sheet);
    let absent = all.filter(|((_, values), noise)| noise.is_finite() && lacks(values));
    absent
        .map(|((column, _), _)| {
            format!("{name}: {column} was not measured; the diagnosis does without")
        })
        .collect()
}

/// Noise of each channel: the sheet's, unless the recordings show clearly another.
fn nominal_noise(cleanings: &[Cleaning], sheet: &[f64; CHANNELS.len()]) -> [f64; CHANNELS.len()] {
    std::array::from_fn(|channel| {
        let found = cleanings.iter().filter_map(|c| c.noise[channel]);
        let sheet = sheet[channel];
        let clear = |noise: &f64| !(1.0 / OTHER_NOISE..OTHER_NOISE).contains(&(noise / sheet));
        median(found.filter(|noise| *noise > 0.0))
            .filter(clear)
            .unwrap_or(sheet)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretches_that_overlap_are_one() {
        let all = vec![[3.0, 4.0], [0.5, 1.0], [0.8, 2.0], [2.0, 2.5], [0.6, 0.7]];
        assert_eq!(joined(all), [[0.5, 2.5], [3.0, 4.0]]);
    }

    #[test]
    fn the_data_sheet_holds_unless_the_recordings_clearly_differ() {
        let shown = |noise: f64| Cleaning {
            noise: vec![Some(noise), None, Some(0.0), Some(1.2)],
            ..Cleaning::default()
        };
        let noise = nominal_noise(&[shown(3.0), shown(3.2), shown(0.9)], &[1.0; 4]);
        assert_eq!(noise, [3.0, 1.0, 1.0, 1.0]);
    }
}
