//! Reasons why an effect is not stated as sure.

use serde::{Deserialize, Serialize};

/// A reason why an effect is not stated as sure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Doubt {
    /// A number stands at the end of the range that is searched.
    AtEndOfRange,
    /// The interval of a number spans a decade.
    SpansDecade,
    /// The intervals of its numbers hold the values without it.
    HoldsNeutral,
    /// The recordings are explained as well without it.
    CostsNothing,
    /// Another law in its place explains the recordings as well.
    AnotherDoesAsWell,
    /// A channel is left far above its noise.
    LeavesMuch,
    /// A tolerated number stands at its end and was not tried beyond it.
    NotTriedBeyond,
}

impl Doubt {
    /// Whether it forbids to state the effect above 50 %, or in the headline.
    #[must_use]
    pub fn forbids(self) -> bool {
        !matches!(self, Self::NotTriedBeyond | Self::LeavesMuch)
    }

    /// In words.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::AtEndOfRange => "a number of it stands at the end of the range that is searched",
            Self::SpansDecade => "the interval of a number of it spans a decade",
            Self::HoldsNeutral => "the intervals of its numbers hold their values without it",
            Self::CostsNothing => "the recordings are explained as well without it",
            Self::AnotherDoesAsWell => "another law in its place explains the recordings as well",
            Self::LeavesMuch => "a channel is left far above its noise",
            Self::NotTriedBeyond => {
                "a number of the rig file stands at the end of its tolerance and was not tried beyond it"
            }
        }
    }
}
