//! The laboratory: recordings of devices that are not the simulator's own.
//!
//! A diagnosis of recordings from the simulator that it fits proves little. Here the device is written out once more, in equations of its
//! own for another integrator (Dormand and Prince 5(4) with its own step control, crate `differential-equations`), and a real device's parts are richer
//! than a model's: seals with elastoplastic presliding, a hose of many cells, walls that warm up, orifices without the model's laminar line.
//! Formulas stand here twice on purpose: nothing here may use `physics`, `device` or `plant`.
//!
//! ```text
//! programme -> device (with something concealed) -> sensors -> recordings + rig file + sealed truth
//! ```

mod carried_out;
mod case;
mod concealed;
mod conditions;
mod dirt;
mod draw;
mod effects;
mod equations;
mod law;
mod law_draw;
mod programme;
mod recipes;
mod rig;
mod sealed;
mod sensors;
mod shown;
mod trajectory;
mod visibility;
mod write;

pub use carried_out::RigError;
pub use case::{LaboratoryCase, Recipe, Session};
pub use concealed::{Concealed, Seals, Swing};
pub use conditions::Conditions;
pub use dirt::Dirt;
pub use draw::{NominalRig, TOLERANCES};
pub use effects::{EFFECTS, LabEffect, UNLISTED_EFFECTS};
pub use law::{Driver, Form, Law, Place};
pub use law_draw::law_case;
pub use programme::{Programme, Sampled, Surface, Wave};
pub use recipes::{LOST, shipped, sizes};
pub use rig::{AIR, Gas, LaboratoryRig};
pub use sealed::{Known, SealedCase, SealedEffect, SealedInterval};
pub use trajectory::{LaboratoryError, LaboratoryTrajectory, run};
pub use write::{write_case, write_session};

/// Columns of the measured channels, in the order of all arrays of four here.
pub const CHANNELS: [&str; 4] = [
    "regulator_pressure_pa",
    "stroke_m",
    "force_n",
    "acceleration_m_per_s2",
];
