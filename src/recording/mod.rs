//! Recordings: sampled signals of one run of the cell, simulated or real.
//!
//! A [`Recording`] is sample times, named channels in SI units and the phases of the job. It knows
//! nothing of how it came about. [`parquet`] stores it as a table, [`csv`] reads that of a real rig, [`table`] any other's columns, and [`schema`] lists
//! the signals that the simulated cell writes. `bag` writes it as messages of ROS 2.

#[cfg(feature = "cli")]
pub mod arrow_table;
pub mod atomic;
#[cfg(feature = "import")]
pub mod bag;
pub mod claim;
pub mod csv;
mod error;
pub mod gaps;
pub mod log;
pub mod long_column;
#[cfg(feature = "parquet")]
pub mod long_table;
#[cfg(feature = "parquet")]
pub mod parquet;
#[cfg(feature = "parquet")]
mod parquet_file;
mod placing;
pub mod provenance;
pub mod samples;
pub mod schema;
pub mod seal;
#[cfg(feature = "parquet")]
pub mod table;
pub mod thousandfold;
#[cfg(feature = "parquet")]
mod thrift;
mod unfinished;

pub use crate::unit::SiUnit as Unit;
pub use error::RecordingError;

use std::collections::BTreeSet;
use std::ops::Range;

use crate::unit::{column_name, parse_column_name};

/// One signal, sampled at the recording's times.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedChannel {
    /// The recorded quantity, without its unit: `contact_force`.
    pub quantity: String,
    /// Unit of `values`.
    pub unit: Unit,
    /// One value per sample time; NaN where there is none.
    pub values: Vec<f64>,
}

impl RecordedChannel {
    /// A channel of `quantity` in `unit`.
    #[must_use]
    pub fn new(quantity: impl Into<String>, unit: Unit, values: Vec<f64>) -> Self {
        Self {
            quantity: quantity.into(),
            unit,
            values,
        }
    }
}

/// A part of the job, such as `approach` or `follow`.
///
/// A sample at time t belongs to it if start <= t < end; a span that ends with the recording also
/// holds the last sample.
#[derive(Debug, Clone, PartialEq)]
pub struct PhaseSpan {
    /// Name of the phase.
    pub name: String,
    /// Its start [s].
    pub start: f64,
    /// Its end [s].
    pub end: f64,
}

/// Sampled signals of one run, checked to fit together.
#[derive(Debug, Clone, PartialEq)]
pub struct Recording {
    time: Vec<f64>,
    channels: Vec<RecordedChannel>,
    phases: Vec<PhaseSpan>,
}

impl Recording {
    /// Puts a recording together: `time` [s] must increase, every channel must have one value per
    /// time and a name of its own, phases must follow one another without overlap.
    ///
    /// # Errors
    /// Says which channel, sample or phase does not fit.
    pub fn new(
        time: Vec<f64>,
        channels: Vec<RecordedChannel>,
        phases: Vec<PhaseSpan>,
    ) -> Result<Self, RecordingError> {
        check_time(&time)?;
        check_channels(&channels, time.len())?;
        check_phases(&phases)?;
        Ok(Self {
            time,
            channels,
            phases,
        })
    }

    /// The same with further channels.
    ///
    /// # Errors
    /// As of [`Self::new`].
    pub fn with(mut self, channels: Vec<RecordedChannel>) -> Result<Self, RecordingError> {
        self.channels.extend(channels);
        check_channels(&self.channels, self.time.len())?;
        Ok(self)
    }

    /// Sample times [s].
    #[must_use]
    pub fn time(&self) -> &[f64] {
        &self.time
    }

    /// All channels, in the order they were given.
    #[must_use]
    pub fn channels(&self) -> &[RecordedChannel] {
        &self.channels
    }

    /// The phases, in order of time.
    #[must_use]
    pub fn phases(&self) -> &[PhaseSpan] {
        &self.phases
    }

    /// Number of samples, at least one.
    #[must_use]
    pub fn sample_count(&self) -> usize {
        self.time.len()
    }

    /// The channel of a quantity, if it was recorded.
    #[must_use]
    pub fn channel(&self, quantity: &str) -> Option<&RecordedChannel> {
        self.channels
            .iter()
            .find(|channel| channel.quantity == quantity)
    }

    /// The values of a quantity.
    ///
    /// # Errors
    /// [`RecordingError::Missing`] if it was not recorded.
    pub fn values(&self, quantity: &str) -> Result<&[f64], RecordingError> {
        self.channel(quantity)
            .map(|channel| channel.values.as_slice())
            .ok_or_else(|| RecordingError::Missing {
                quantity: quantity.to_owned(),
            })
    }

    /// The first phase of a name.
    #[must_use]
    pub fn phase(&self, name: &str) -> Option<&PhaseSpan> {
        self.phases.iter().find(|phase| phase.name == name)
    }

    /// A stretch of it by itself, without its phases.
    ///
    /// # Errors
    /// [`RecordingError::Empty`] if there is no sample in it.
    pub fn part(&self, samples: Range<usize>) -> Result<Self, RecordingError> {
        let cut = |values: &[f64]| values.get(samples.clone()).unwrap_or_default().to_vec();
        let channels = self.channels.iter().map(|channel| RecordedChannel {
            values: cut(&channel.values),
            ..channel.clone()
        });
        Self::new(cut(&self.time), channels.collect(), Vec::new())
    }

    /// Indices of the samples that belong to a span.
    #[must_use]
    pub fn samples_in(&self, span: &PhaseSpan) -> Range<usize> {
        let start = self.time.partition_point(|&time| time < span.start);
        let ends_with_recording = self.time.last() == Some(&span.end);
        let end = self
            .time
            .partition_point(|&time| time < span.end || (ends_with_recording && time == span.end));
        start..end.max(start)
    }
}

fn check_time(time: &[f64]) -> Result<(), RecordingError> {
    if time.is_empty() {
        return Err(RecordingError::Empty);
    }
    let mut previous = f64::NEG_INFINITY;
    for (index, &value) in time.iter().enumerate() {
        if !value.is_finite() || value <= previous {
            return Err(RecordingError::Time {
                index,
                previous,
                value,
            });
        }
        previous = value;
    }
    Ok(())
}

fn check_channels(channels: &[RecordedChannel], sample_count: usize) -> Result<(), RecordingError> {
    let mut seen = BTreeSet::new();
    for channel in channels {
        if let Some(reason) = quantity_fault(&channel.quantity, channel.unit) {
            return Err(RecordingError::Quantity {
                quantity: channel.quantity.clone(),
                unit: channel.unit.symbol(),
                reason,
            });
        }
        if channel.values.len() != sample_count {
            return Err(RecordingError::Length {
                quantity: channel.quantity.clone(),
                found: channel.values.len(),
                expected: sample_count,
            });
        }
        if !seen.insert(&channel.quantity) {
            return Err(RecordingError::Duplicate {
                quantity: channel.quantity.clone(),
            });
        }
    }
    Ok(())
}

/// Why a quantity cannot become a column name, if it cannot.
fn quantity_fault(quantity: &str, unit: Unit) -> Option<&'static str> {
    let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
    if quantity.is_empty() || !quantity.chars().all(plain) {
        Some("a name is made of lower-case letters, digits and underscores")
    } else if quantity == schema::TIME || quantity == schema::PHASE {
        Some("the name is kept for the recording's own columns")
    } else if parse_column_name(&column_name(quantity, unit)) != Some((quantity, unit)) {
        Some("with its unit appended it reads as another unit")
    } else {
        None
    }
}

fn check_phases(phases: &[PhaseSpan]) -> Result<(), RecordingError> {
    let mut previous: Option<&PhaseSpan> = None;
    for phase in phases {
        let reason = if phase.name.is_empty() {
            Some("it has no name")
        } else if !(phase.start.is_finite() && phase.end.is_finite() && phase.start <= phase.end) {
            Some("its times must be finite and its end not before its start")
        } else if previous.is_some_and(|before| phase.start < before.end) {
            Some("it starts before the phase ahead of it ends")
        } else if previous
            .is_some_and(|before| phase.start == before.end && phase.name == before.name)
        {
            Some("it continues a phase of the same name; the two are one")
        } else {
            None
        };
        if let Some(reason) = reason {
            return Err(RecordingError::Phase {
                name: phase.name.clone(),
                start: phase.start,
                end: phase.end,
                reason,
            });
        }
        previous = Some(phase);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn span(name: &str, start: f64, end: f64) -> PhaseSpan {
        PhaseSpan {
            name: name.to_owned(),
            start,
            end,
        }
    }

    fn force(values: Vec<f64>) -> RecordedChannel {
        RecordedChannel::new(schema::CONTACT_FORCE, Unit::Newton, values)
    }

    #[test]
    fn a_channel_is_found_by_name() {
        let recording =
            Recording::new(vec![0.0, 1.0], vec![force(vec![3.0, 4.0])], vec![]).unwrap();
        assert_eq!(recording.values("contact_force").unwrap(), [3.0, 4.0]);
        assert_eq!(recording.sample_count(), 2);
        let error = recording.values("stroke").unwrap_err().to_string();
        assert_eq!(error, "the recording has no channel `stroke`");
    }

    #[test]
    fn samples_belong_to_half_open_spans_and_the_last_sample_to_the_last() {
        let time = vec![0.0, 1.0, 2.0, 3.0];
        let phases = vec![span("approach", 0.0, 1.5), span("follow", 2.0, 3.0)];
        let recording = Recording::new(time, vec![], phases).unwrap();
        assert_eq!(recording.samples_in(&recording.phases()[0]), 0..2);
        assert_eq!(recording.samples_in(&recording.phases()[1]), 2..4);
        assert_eq!(recording.samples_in(&span("x", 1.0, 2.0)), 1..2);
        assert_eq!(recording.phase("follow").unwrap().start, 2.0);
    }

    #[test]
    fn what_does_not_fit_is_refused_by_name() {
        let refuse = |time: Vec<f64>, channels, phases| {
            Recording::new(time, channels, phases)
                .unwrap_err()
                .to_string()
        };
        let two = vec![0.0, 1.0];
        assert!(refuse(vec![], vec![], vec![]).contains("no samples"));
        assert!(refuse(vec![0.0, 0.0], vec![], vec![]).contains("sample time 1"));
        assert!(refuse(vec![f64::NAN], vec![], vec![]).contains("sample time 0"));
        let short = refuse(two.clone(), vec![force(vec![1.0])], vec![]);
        assert!(
            short.contains("`contact_force` has 1 values, expected 2"),
            "{short}"
        );
        let twice = vec![force(vec![0.0; 2]), force(vec![0.0; 2])];
        assert!(refuse(two.clone(), twice, vec![]).contains("appears twice"));
        for (name, unit) in [
            ("time", Unit::Second),
            ("Force", Unit::Newton),
            ("", Unit::Newton),
            ("lever_n", Unit::Metre),
        ] {
            let channel = RecordedChannel::new(name, unit, vec![0.0; 2]);
            assert!(refuse(two.clone(), vec![channel], vec![]).contains("cannot be used"));
        }
        for phases in [
            vec![span("follow", 1.0, 0.0)],
            vec![span("approach", 0.0, 1.0), span("follow", 0.5, 1.0)],
            vec![span("follow", 0.0, 1.0), span("follow", 1.0, 2.0)],
        ] {
            assert!(refuse(two.clone(), vec![], phases).contains("phase `follow`"));
        }
    }
}
