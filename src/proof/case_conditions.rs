//! Conditions of the cases of a sweep.

use serde::{Deserialize, Serialize};

use crate::laboratory::{CHANNELS, Conditions};

/// Size of the imperfections of a device that has nothing to be named, over those of a real one [1].
const BELOW_NOISE: f64 = 1.0 / 12.0;
/// Part of a recording, of its length, that is lost before it begins in mid-motion: at least, and at most [1].
const LOST_BEFORE: [f64; 2] = [0.2, 0.4];

/// Conditions under which all cases of a sweep are recorded.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CaseConditions {
    /// An ideal laboratory.
    #[default]
    Laboratory,
    /// A real device's imperfections, 50 to 1000 Hz, sheet noise off by up to two, coarse converters, dirt.
    Shop,
    /// Imperfections below the noise.
    Imperfect,
    /// Recordings that begin in mid-motion.
    MidMotion,
    /// One channel missing.
    MissingChannel,
    /// Periodic phases drawn anew in each recording.
    FreePhases,
    /// Sheet noise off by two.
    WrongNoise,
}

impl CaseConditions {
    /// Of a device, with recordings of a length [s].
    #[must_use]
    pub fn of(self, seed: u64, duration: f64) -> Conditions {
        let ideal = Conditions::default();
        // A draw that differs from seed to seed, evenly.
        let share = (seed as f64 * 0.618_033_988_75).fract();
        match self {
            Self::Laboratory => ideal,
            Self::Shop => Conditions::of_a_shop(seed),
            Self::Imperfect => Conditions {
                imperfection: BELOW_NOISE,
                ..ideal
            },
            Self::MidMotion => Conditions {
                begins: duration * (LOST_BEFORE[0] + share * (LOST_BEFORE[1] - LOST_BEFORE[0])),
                ..ideal
            },
            Self::MissingChannel => Conditions {
                missing: Some(seed as usize % CHANNELS.len()),
                ..ideal
            },
            Self::FreePhases => Conditions {
                phases_drawn: true,
                ..ideal
            },
            Self::WrongNoise => Conditions {
                noise: if seed.is_multiple_of(2) { 2.0 } else { 0.5 },
                ..ideal
            },
        }
    }
}
