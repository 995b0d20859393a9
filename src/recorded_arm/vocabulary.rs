//! What may be missing in the description of a recorded arm, by name: where it is, its numbers and what it means.
//!
//! Values are those of the description, not changes; amplitudes are zero to peak, all at the joint's side of the gear.

/// What says where an effect is; a part of its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// A joint, by the number in its columns.
    Joint,
    /// A link, by its name.
    Link,
    /// A recording, by the name of its file.
    Recording,
    /// A channel of the wrench sensor.
    Channel,
    /// The channel whose truth another reads.
    Source,
    /// The channel that reads it.
    Target,
}

impl Place {
    /// Its key.
    #[must_use]
    pub const fn key(self) -> &'static str {
        match self {
            Self::Joint => "joint",
            Self::Link => "link",
            Self::Recording => "recording",
            Self::Channel => "channel",
            Self::Source => "source",
            Self::Target => "target",
        }
    }
}

/// An effect of the vocabulary.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ArmEffectName {
    /// Its name.
    pub name: &'static str,
    /// Part of the arm that it is of.
    pub subsystem: &'static str,
    /// What it is.
    pub meaning: &'static str,
    /// What says where it is.
    pub places: &'static [Place],
    /// Its numbers [SI].
    pub numbers: &'static [&'static str],
}

const fn effect(
    (subsystem, name): (&'static str, &'static str),
    meaning: &'static str,
    places: &'static [Place],
    numbers: &'static [&'static str],
) -> ArmEffectName {
    ArmEffectName {
        name,
        subsystem,
        meaning,
        places,
        numbers,
    }
}

const JOINT: &[Place] = &[Place::Joint];
const CENTRE: &[&str] = &["mass_kg", "centre_x_m", "centre_y_m", "centre_z_m"];
const FORCES_AND_TORQUES: &[&str] = &[
    "force_x_n",
    "force_y_n",
    "force_z_n",
    "torque_x_n_m",
    "torque_y_n_m",
    "torque_z_n_m",
];

/// The vocabulary, by subsystem.
#[rustfmt::skip] // A table.
pub const ARM_EFFECTS: [ArmEffectName; 22] = [
    effect(("joints", "joint_friction"), "dry and viscous friction of a joint, where none or far less was declared", JOINT,
        &["coulomb_n_m", "viscous_n_m_s_per_rad"]),
    effect(("joints", "stribeck_joint_friction"), "friction of a joint that falls as it starts to turn", JOINT,
        &["coulomb_n_m", "viscous_n_m_s_per_rad", "static_n_m", "stribeck_velocity_rad_per_s"]),
    effect(("joints", "load_dependent_joint_friction"), "friction of a gear that grows with the torque it carries", JOINT, &["friction_per_load"]),
    effect(("joints", "motor_inertia_error"), "the reflected inertia of motor and gear is outside its tolerance", JOINT, &["inertia_kg_m2"]),
    effect(("joints", "drive_gain_error"), "a drive's torque per ampere is outside its tolerance", JOINT, &["gain_n_m_per_a"]),
    effect(("joints", "joint_torque_offset"), "a constant torque acts on a joint", JOINT, &["offset_n_m"]),
    effect(("joints", "gear_ripple"), "a torque is periodic in a joint's angle", JOINT, &["amplitude_n_m", "cycles_per_turn"]),
    effect(("joints", "compliant_joint"), "the gear between a motor and its link is soft", JOINT, &["stiffness_n_m_per_rad"]),
    effect(("joints", "joint_encoder_offset"), "a joint's encoder has another zero", JOINT, &["offset_rad"]),
    effect(("joints", "joint_warm_up"), "a joint's friction falls as it warms", JOINT, &["fraction", "time_constant_s"]),
    effect(("load", "payload"), "the flange carries a load that was not declared", &[], CENTRE),
    effect(("load", "link_mass_error"), "a link's mass is outside its tolerance", &[Place::Link], &["mass_kg"]),
    effect(("mount", "base_tilt"), "the base does not stand as declared", &[], &["roll_rad", "pitch_rad"]),
    effect(("surroundings", "dress_pack_spring"), "hoses and cables pull a joint towards a rest angle", JOINT, &["stiffness_n_m_per_rad", "rest_rad"]),
    effect(("surroundings", "outside_push"), "somebody or something pushes the arm at its flange for a while", &[Place::Recording], &["start_s", "end_s", "force_n"]),
    effect(("wrench_sensor", "wrench_zero"), "the wrench sensor's zero is outside its tolerance", &[], FORCES_AND_TORQUES),
    effect(("wrench_sensor", "tool_weight_error"), "mass and centre of the tool beyond the wrench sensor are outside their tolerances", &[], CENTRE),
    effect(("wrench_sensor", "wrench_frame_turned"), "the wrench sensor is mounted turned about its z", &[], &["angle_rad"]),
    effect(("wrench_sensor", "wrench_gain_error"), "the gain of a channel of the wrench sensor is off", &[Place::Channel], &["gain"]),
    effect(("wrench_sensor", "wrench_crosstalk"), "a channel of the wrench sensor reads a share of another", &[Place::Source, Place::Target], &["coefficient"]),
    effect(("wrench_sensor", "wrench_drift"), "the zero of a channel of the wrench sensor drifts", &[Place::Channel], &["n_per_s"]),
    effect(("timing", "current_late"), "currents are stamped later than positions", &[], &["delay_s"]),
];

/// An effect by its name.
#[must_use]
pub fn arm_effect(name: &str) -> Option<&'static ArmEffectName> {
    ARM_EFFECTS.iter().find(|effect| effect.name == name)
}
