//! Stages of a fit, and where it ends.

/// A stage of a fit.
#[derive(Debug, Clone, Copy)]
pub struct Stage {
    /// Errors in time that are forgiven [s]: a model that is still far off meets impacts at other times than the device, and their spikes would hold it
    /// there.
    pub forgiven: f64,
    /// Whether the piston is held to its measured motion.
    pub guided: bool,
    /// Whether the loss is bounded.
    pub bounded: bool,
    /// Share of the cost that an iteration must gain for the stage to go on [1].
    pub gain: f64,
}

/// A rough fit: what it gains says whether a full one is worth its while.
pub const ROUGH: &[Stage] = &[Stage {
    forgiven: ROUGH_TIME,
    guided: true,
    bounded: false,
    gain: 1e-3,
}];
/// A full fit, one stage after the other.
pub const FULL: &[Stage] = &[
    Stage {
        forgiven: ROUGH_TIME,
        guided: true,
        bounded: false,
        gain: 1e-3,
    },
    Stage {
        forgiven: 0.001,
        guided: false,
        bounded: true,
        gain: 1e-3,
    },
    Stage {
        forgiven: 1e-4,
        guided: false,
        bounded: true,
        gain: 1e-3,
    },
    Stage {
        forgiven: 0.0,
        guided: false,
        bounded: true,
        gain: 3e-4,
    },
    Stage {
        forgiven: 0.0,
        guided: false,
        bounded: false,
        gain: 0.0,
    },
];
/// The last stage of a full fit alone.
pub const FINEST: &[Stage] = FULL.split_at(FULL.len() - 1).1;
/// Error in time that a rough fit forgives [s].
const ROUGH_TIME: f64 = 0.006;

/// Where a fit ends at the latest.
#[derive(Debug, Clone, Copy)]
pub struct Limit {
    /// Iterations at most.
    pub iterations: usize,
    /// Longest step in a coordinate [1].
    pub longest_step: f64,
}

impl Limit {
    /// That of a full fit.
    pub const FULL: Self = Self::of(40);

    /// So many iterations, with steps for the numbers of laws.
    pub const fn of(iterations: usize) -> Self {
        Self {
            iterations,
            longest_step: 3.0,
        }
    }

    /// So many iterations, with steps as long as a curve without a law may need.
    pub const fn of_curve(iterations: usize) -> Self {
        Self {
            iterations,
            longest_step: 30.0,
        }
    }
}
