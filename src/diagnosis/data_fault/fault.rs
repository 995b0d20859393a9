//! A fault of a sensor, a log or a clock.

use crate::plant::Channel;

/// Kind and size of a fault.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// The zero is another one, in the channel's unit.
    ZeroOffset(f64),
    /// The zero jumps by so much, in the channel's unit, at a stamp [s].
    ZeroJump(f64, f64),
    /// The reading is so many times the truth [1].
    Gain(f64),
    /// A reading is kept for a period [s].
    Held(f64),
    /// The reading stands still between two stamps [s].
    Frozen([f64; 2]),
    /// Stamp over true time [1].
    ClockScale(f64),
    /// The reading is that of so much earlier [s].
    ClockOffset(f64),
    /// The zero moves by so much a second, in the channel's unit a second.
    Drift(f64),
    /// The readings between two stamps [s] are those of another place, which begins at a stamp [s].
    Copied([f64; 2], f64),
    /// The noise has this standard deviation, in the channel's unit.
    Noise(f64),
}

/// A fault.
#[derive(Debug, Clone, PartialEq)]
pub struct DataFault {
    /// What it is.
    pub kind: Kind,
    /// The channel; none where a whole log has it.
    pub channel: Option<Channel>,
    /// Name of the recording; none where all have it.
    pub recording: Option<String>,
    /// Its probability [1].
    pub probability: f64,
    /// Whether it acts in recordings to come too.
    pub stays: bool,
}

impl DataFault {
    /// Whether readings of a channel of a recording are set aside for it: those are not lost.
    #[must_use]
    pub fn sets_aside(&self, channel: Channel, recording: &str) -> bool {
        let does = matches!(
            self.kind,
            Kind::Held(_)
                | Kind::Frozen(_)
                | Kind::Copied(..)
                | Kind::ClockScale(_)
                | Kind::ClockOffset(_)
        );
        does && self.channel == Some(channel)
            && self.recording.as_ref().is_none_or(|own| own == recording)
    }

    pub(super) fn of(
        kind: Kind,
        channel: Channel,
        recording: Option<&str>,
        probability: f64,
    ) -> Self {
        Self {
            kind,
            channel: Some(channel),
            recording: recording.map(str::to_owned),
            probability,
            stays: matches!(
                kind,
                Kind::Gain(_) | Kind::Held(_) | Kind::ClockScale(_) | Kind::ClockOffset(_)
            ),
        }
    }
}
