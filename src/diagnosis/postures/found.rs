//! What a diagnosis of still postures is of, and what its answer is made of.

use super::estimate::Numbers;
use super::fit::Fit;
use super::frame::{Frame, Turn};
use super::nominal::Nominal;
use super::select::Candidate;
use super::{Posture, StillRecording};

/// What is diagnosed.
#[derive(Debug, Clone)]
pub struct PosturesInput {
    /// Sensor and tool by their nominal values.
    pub nominal: Nominal,
    /// Recordings to diagnose from.
    pub recordings: Vec<StillRecording>,
}

/// What the answer is made of.
pub(super) struct Found<'a> {
    pub input: &'a PosturesInput,
    /// All postures.
    pub postures: Vec<Posture>,
    /// The likeliest first.
    pub candidates: Vec<Candidate>,
    /// Of the likeliest.
    pub numbers: Numbers,
    /// The fit in the declared axes.
    pub as_declared: Fit,
}

impl Found<'_> {
    pub fn best(&self) -> &Candidate {
        &self.candidates[0]
    }

    /// Whether the readings are what they are declared to be.
    pub fn is_as_declared(&self, frame: &Frame) -> bool {
        *frame
            == Frame {
                turn: Turn::None,
                ..self.input.nominal.frame
            }
    }
}
