//! A run of consecutive samples of a recording.

use std::ops::Range;

use super::{FOLLOW_PHASE, MetricsError};
use crate::recording::{Recording, Unit};

/// Consecutive samples of a recording, at least one.
pub(super) struct Window<'a> {
    recording: &'a Recording,
    range: Range<usize>,
}

impl<'a> Window<'a> {
    /// All samples.
    pub(super) fn run(recording: &'a Recording) -> Self {
        Self {
            recording,
            range: 0..recording.sample_count(),
        }
    }

    /// The samples of the following phase; `None` if there are none.
    pub(super) fn follow(recording: &'a Recording) -> Result<Option<Self>, MetricsError> {
        Self::phase(recording, FOLLOW_PHASE)
    }

    /// The samples of a phase; `None` if there are none.
    pub(super) fn phase(
        recording: &'a Recording,
        name: &'static str,
    ) -> Result<Option<Self>, MetricsError> {
        let mut spans = recording.phases().iter().filter(|phase| phase.name == name);
        let Some(span) = spans.next() else {
            return Ok(None);
        };
        let others = spans.count();
        if others > 0 {
            return Err(MetricsError::RepeatedPhase {
                name,
                count: 1 + others,
            });
        }
        let range = recording.samples_in(span);
        Ok((!range.is_empty()).then_some(Self { recording, range }))
    }

    /// The samples of the first phase of a name; `None` if there are none.
    pub(super) fn of(recording: &'a Recording, name: &str) -> Option<Self> {
        let span = recording.phase(name)?;
        let range = recording.samples_in(span);
        (!range.is_empty()).then_some(Self { recording, range })
    }

    /// Sample times [s].
    pub(super) fn time(&self) -> &'a [f64] {
        &self.recording.time()[self.range.clone()]
    }

    /// Time from the first to the last sample [s].
    pub(super) fn duration(&self) -> f64 {
        let time = self.time();
        time[time.len() - 1] - time[0]
    }

    /// Values of a channel here; `None` if it was not recorded or one of them is not finite.
    pub(super) fn finite(
        &self,
        quantity: &str,
        unit: Unit,
    ) -> Result<Option<&'a [f64]>, MetricsError> {
        let Some(values) = raw(self.recording, quantity, unit)? else {
            return Ok(None);
        };
        let values = &values[self.range.clone()];
        Ok(values
            .iter()
            .all(|value| value.is_finite())
            .then_some(values))
    }
}

/// All values of a channel as recorded; `None` if it was not.
pub(super) fn raw<'a>(
    recording: &'a Recording,
    quantity: &str,
    unit: Unit,
) -> Result<Option<&'a [f64]>, MetricsError> {
    match recording.channel(quantity) {
        None => Ok(None),
        Some(channel) if channel.unit == unit => Ok(Some(&channel.values)),
        Some(channel) => Err(MetricsError::ChannelUnit {
            quantity: quantity.to_owned(),
            found: channel.unit.symbol(),
            expected: unit.symbol(),
        }),
    }
}
