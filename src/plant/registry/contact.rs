//! Tool on workpiece.

use super::{ANY, Number, numbers};
use crate::plant::{ContactLaw, PlantParameters};

#[rustfmt::skip] // A table: one number a line.
numbers! { CONTACT:
    /// contact stiffness between tool and workpiece
    CONTACT_STIFFNESS = "contact.stiffness_n_per_m", [100.0, 1e9], (stiffness, |p, _, stiffness| p.contact.law = ContactLaw::Linear { stiffness }), 8.5e5;
    /// contact damping
    CONTACT_DAMPING = "contact.damping_n_s_per_m", [0.0, 1e6], (p => p.contact.damping), 2e2;
    /// stiffness of whichever law the contact has
    LAW_STIFFNESS = "contact.law_stiffness", ANY, (stiffness, set_stiffness);
    /// stiffness of a ball on a flat
    HERTZ_STIFFNESS = "contact.hertz_stiffness_n_per_m15", ANY, (hertz, |p, _, stiffness| p.contact.law = ContactLaw::Hertz { stiffness });
    /// how far the surface stands from where the robot has it, along extension
    SURFACE_OFFSET = "contact.surface_offset_m", ANY, (p => p.contact.surface_offset);
    /// turns of the tool a second, 0 where it is not known
    SPINDLE_FREQUENCY = "contact.spindle_frequency_hz", [0.0, 1000.0], (p => p.contact.spindle_frequency), 0.0;
    /// its turns a second; the spindle's where those are given
    RUNOUT_FREQUENCY = "contact.runout_frequency_hz", [0.1, 1000.0], (p => p.contact.runout.frequency), 30.0;
    /// runout in phase with the sine
    RUNOUT_SINE = "contact.runout_sine_m", ANY, (p => p.contact.runout.sine);
    /// runout in phase with the cosine
    RUNOUT_COSINE = "contact.runout_cosine_m", ANY, (p => p.contact.runout.cosine);
    /// phase of the runout in a recording, ahead of that of sine and cosine
    RUNOUT_PHASE = "contact.runout_phase_rad", ANY, (p, i => p.contact.runout.phases[i]);
    /// waves of the surface a second
    WAVINESS_FREQUENCY = "contact.waviness_frequency_hz", ANY, (p => p.contact.waviness.frequency);
    /// waviness in phase with the sine
    WAVINESS_SINE = "contact.waviness_sine_m", ANY, (p => p.contact.waviness.sine);
    /// waviness in phase with the cosine
    WAVINESS_COSINE = "contact.waviness_cosine_m", ANY, (p => p.contact.waviness.cosine);
    /// phase of the waviness in a recording, ahead of that of sine and cosine
    WAVINESS_PHASE = "contact.waviness_phase_rad", ANY, (p, i => p.contact.waviness.phases[i]);
}

fn stiffness(plant: &PlantParameters, _: usize) -> f64 {
    match plant.contact.law {
        ContactLaw::Linear { stiffness } | ContactLaw::Hertz { stiffness } => stiffness,
    }
}

fn set_stiffness(plant: &mut PlantParameters, _: usize, value: f64) {
    match &mut plant.contact.law {
        ContactLaw::Linear { stiffness } | ContactLaw::Hertz { stiffness } => *stiffness = value,
    }
}

fn hertz(plant: &PlantParameters, _: usize) -> f64 {
    match plant.contact.law {
        ContactLaw::Hertz { stiffness } => stiffness,
        ContactLaw::Linear { .. } => 0.0,
    }
}
