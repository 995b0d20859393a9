//! Faults of the data in diagnosis.json and in words.

use serde::{Deserialize, Serialize};

use super::fault::{DataFault, Kind};
use crate::diagnosis::answer::words::{CHANNEL_UNITS, CHANNEL_WORDS, percent};
use crate::diagnosis::recordings::recorded::COLUMNS;
use crate::plant::Channel;
use crate::quantity::significant;

/// Stands for every recording.
const ALL: &str = "all";

/// A fault in diagnosis.json.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DataFaultReport {
    /// What it is: `zero_offset`, `zero_jump`, `gain`, `held`, `frozen`, `drift`, `copied`, `clock_scale`, `clock_offset` or `noise`.
    pub kind: String,
    /// Column; none where a whole log has it.
    pub channel: Option<String>,
    /// File name, or `all`.
    pub recording: String,
    /// Its size: in the channel's unit, of times in s, of gains and scales as a factor.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub value: Option<f64>,
    /// Stamp from which it acts; of a copy where its source begins [s].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time_s: Option<f64>,
    /// Stamp from which a channel stands still, or is a copy [s].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub start_s: Option<f64>,
    /// Stamp until which it does [s].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub end_s: Option<f64>,
    /// Probability [1].
    pub probability: f64,
    /// In words.
    #[serde(default)]
    pub words: String,
}

impl DataFault {
    /// For diagnosis.json.
    #[must_use]
    pub fn report(&self) -> DataFaultReport {
        let (value, time_s, span) = match self.kind {
            Kind::ZeroJump(value, time) => (Some(value), Some(time), None),
            Kind::Frozen(span) => (None, None, Some(span)),
            Kind::Copied(span, from) => (None, Some(from), Some(span)),
            Kind::ZeroOffset(value)
            | Kind::Gain(value)
            | Kind::Held(value)
            | Kind::ClockScale(value)
            | Kind::ClockOffset(value)
            | Kind::Drift(value)
            | Kind::Noise(value) => (Some(value), None, None),
        };
        DataFaultReport {
            kind: self.name().to_owned(),
            channel: self.channel.map(|c| COLUMNS[c as usize].to_owned()),
            recording: self.recording.clone().unwrap_or_else(|| ALL.to_owned()),
            value,
            time_s,
            start_s: span.map(|[start, _]| start),
            end_s: span.map(|[_, end]| end),
            probability: self.probability,
            words: self.words(),
        }
    }

    pub(super) fn name(&self) -> &'static str {
        match self.kind {
            Kind::ZeroOffset(_) => "zero_offset",
            Kind::ZeroJump(..) => "zero_jump",
            Kind::Gain(_) => "gain",
            Kind::Held(_) => "held",
            Kind::Frozen(_) => "frozen",
            Kind::Drift(_) => "drift",
            Kind::Copied(..) => "copied",
            Kind::ClockScale(_) => "clock_scale",
            Kind::ClockOffset(_) => "clock_offset",
            Kind::Noise(_) => "noise",
        }
    }

    /// In a sentence without its stop, as notes are, of one that was taken off.
    #[must_use]
    pub fn words(&self) -> String {
        let end = match self.kind {
            Kind::Noise(_) => "",
            _ => "; taken off before anything else was looked for",
        };
        self.sentence() + end
    }

    /// What it is.
    pub(super) fn sentence(&self) -> String {
        let name = self.recording.as_deref().unwrap_or("all recordings");
        let index = self.channel.unwrap_or(Channel::Stroke) as usize;
        let channel = match self.channel {
            Some(_) => CHANNEL_WORDS[index],
            None => "log",
        };
        let (unit, factor) = CHANNEL_UNITS[index];
        let said = |value: f64| format!("{} {unit}", significant(value * factor, 3));
        let seconds = |value: f64| format!("{} s", significant(value, 4));
        let what = match self.kind {
            Kind::ZeroOffset(value) => {
                format!("the zero of the {channel} is off by {}", said(value))
            }
            Kind::ZeroJump(value, time) => format!(
                "the zero of the {channel} jumps by {} at {}",
                said(value),
                seconds(time)
            ),
            Kind::Gain(value) => format!(
                "the {channel} reads {} times the truth: a slip of unit or sign",
                significant(value, 4)
            ),
            Kind::Held(value) => format!(
                "the {channel} is sampled and held, every {}",
                seconds(value)
            ),
            Kind::Frozen([start, end]) => format!(
                "the {channel} stands still from {} to {}",
                seconds(start),
                seconds(end)
            ),
            Kind::Drift(value) => format!(
                "the zero of the {channel} drifts by {} a second",
                said(value)
            ),
            Kind::Copied([start, end], from) => format!(
                "the {channel} from {} to {} is a copy of what stands at {}",
                seconds(start),
                seconds(end),
                seconds(from)
            ),
            Kind::ClockScale(value) => format!(
                "the stamps of the {channel} advance {} times as fast as time",
                significant(value, 5)
            ),
            Kind::ClockOffset(value) => format!("the {channel} is stamped {} late", seconds(value)),
            Kind::Noise(value) => format!(
                "the noise of the {channel} is {}, more than its sheet says",
                said(value)
            ),
        };
        format!(
            "in {name} {what} (probability {})",
            percent(self.probability)
        )
    }
}
