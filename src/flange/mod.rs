//! A pneumatic contact flange between an arm and a workpiece, simulated: arm's motion and set force are inputs, the force below the workpiece comes out.
//!
//! ```text
//! arm --| slide |--structure--| head |--contact--| workpiece |--force plate
//!       air, seals, stop
//! ```
//!
//! One effect a file: `contact`, `structure` (also what carries the workpiece), `seal`, `regulation`, `stop`; put together in `motion`; the arm
//! in `arm_motion` and `ripple`, the way of the force into the log in `reader`. Leaves out: gravity (the flange compensates it), motion across the axis.

mod arm_motion;
mod contact;
mod fitted;
mod motion;
mod reader;
mod regulation;
mod ripple;
mod seal;
mod stop;
mod structure;
#[cfg(test)]
mod tests;

pub use arm_motion::towards_part;
pub use fitted::{CoveredRuns, FittedFlange};
pub use motion::{FlangeCourse, SAMPLED, flange_force, flange_force_stepped};
pub use reader::Reader;
pub use ripple::{Ripple, rippled};

/// Numbers of a model, each declared once: its field, and its name with its unit.
macro_rules! numbers {
    ($(#[$about:meta])* $model:ident, $count:ident; $($(#[$what:meta])* $field:ident = $name:literal;)*) => {
        $(#[$about])*
        #[derive(Debug, Clone, Copy, PartialEq)]
        pub struct $model {
            $($(#[$what])* pub $field: f64,)*
        }

        impl $model {
            /// Names of the numbers with their units, in order.
            pub const NAMES: [&'static str; $count] = [$($name),*];

            /// The numbers in the order of their names.
            #[must_use]
            pub fn numbers(&self) -> [f64; $count] {
                [$(self.$field),*]
            }

            /// Of its numbers.
            #[must_use]
            pub fn of(numbers: &[f64; $count]) -> Self {
                let [$($field),*] = *numbers;
                Self { $($field),* }
            }
        }
    };
}

/// Count of [`FlangeModel`]'s numbers.
pub const FLANGE_NUMBERS: usize = 17;

numbers! {
    /// Numbers of a flange with its tool and its workpiece.
    FlangeModel, FLANGE_NUMBERS;
    /// All that moves with the slide, tool included [kg].
    mass = "moving_mass_kg";
    /// Share of it in front of the structure [kg].
    head_mass = "head_mass_kg";
    /// Between slide and head [N/m].
    structure_stiffness = "structure_stiffness_n_per_m";
    /// Damping ratio [1].
    structure_damping = "structure_damping_ratio";
    /// Quadratic damping [N s2/m2].
    structure_quadratic = "structure_quadratic_damping_n_s2_per_m2";
    /// Between head and workpiece [N/m].
    contact_stiffness = "contact_stiffness_n_per_m";
    /// Damping by the stiffness [s/m].
    contact_damping = "contact_damping_s_per_m";
    /// What swings of the workpiece [kg].
    workpiece_mass = "workpiece_mass_kg";
    /// Below it [N/m].
    workpiece_stiffness = "workpiece_stiffness_n_per_m";
    /// Damping ratio [1].
    workpiece_damping = "workpiece_damping_ratio";
    /// Coulomb friction of the seals [N].
    coulomb = "coulomb_force_n";
    /// Way in which it builds up [m].
    presliding = "presliding_m";
    /// Viscous friction [N s/m].
    viscous = "viscous_coefficient_n_s_per_m";
    /// Time in which the seals relax [s].
    relaxation = "seal_relaxation_s";
    /// Stiffness of the shut-in air [N/m].
    gas_stiffness = "gas_stiffness_n_per_m";
    /// Time of the regulator [s].
    regulator_time = "regulator_time_s";
    /// Time of its valve [s].
    valve_time = "valve_time_s";
}
