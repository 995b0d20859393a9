//! Reasons why an effect is not stated as sure.

use crate::listed::listed;
use serde::{Deserialize, Serialize};

listed! {
    /// A reason why an effect is not stated as sure.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    #[serde(rename_all = "snake_case")]
    pub enum Doubt,
    /// In words.
    words: &'static str {
        /// A number stands at the end of the range that is searched.
        AtEndOfRange = "a number of it stands at the end of the range that is searched",
        /// The interval of a number spans a decade.
        SpansDecade = "the interval of a number of it spans a decade",
        /// The intervals of its numbers hold the values without it.
        HoldsNeutral = "the intervals of its numbers hold their values without it",
        /// The recordings are explained as well without it.
        CostsNothing = "the recordings are explained as well without it",
        /// Another law in its place explains the recordings as well.
        AnotherDoesAsWell = "another law in its place explains the recordings as well",
        /// A channel is left far above its noise.
        LeavesMuch = "a channel is left far above its noise",
        /// A tolerated number stands at its end and was not tried beyond it.
        NotTriedBeyond = "a number of the rig file stands at the end of its tolerance and was not tried beyond it",
    }
}

impl Doubt {
    /// Whether it forbids to state the effect above 50 %, or in the headline.
    #[must_use]
    pub fn forbids(self) -> bool {
        !matches!(self, Self::NotTriedBeyond | Self::LeavesMuch)
    }
}
