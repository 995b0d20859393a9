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

/// Count of [`FlangeModel`]'s numbers.
pub const FLANGE_NUMBERS: usize = 17;

/// Numbers of a flange with its tool and its workpiece.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlangeModel {
    /// All that moves with the slide, tool included [kg].
    pub mass: f64,
    /// Share of it in front of the structure [kg].
    pub head_mass: f64,
    /// Between slide and head [N/m].
    pub structure_stiffness: f64,
    /// Damping ratio [1].
    pub structure_damping: f64,
    /// Quadratic damping [N s2/m2].
    pub structure_quadratic: f64,
    /// Between head and workpiece [N/m].
    pub contact_stiffness: f64,
    /// Damping by the stiffness [s/m].
    pub contact_damping: f64,
    /// What swings of the workpiece [kg].
    pub workpiece_mass: f64,
    /// Below it [N/m].
    pub workpiece_stiffness: f64,
    /// Damping ratio [1].
    pub workpiece_damping: f64,
    /// Coulomb friction of the seals [N].
    pub coulomb: f64,
    /// Way in which it builds up [m].
    pub presliding: f64,
    /// Viscous friction [N s/m].
    pub viscous: f64,
    /// Time in which the seals relax [s].
    pub relaxation: f64,
    /// Stiffness of the shut-in air [N/m].
    pub gas_stiffness: f64,
    /// Time of the regulator [s].
    pub regulator_time: f64,
    /// Time of its valve [s].
    pub valve_time: f64,
}

impl FlangeModel {
    /// Names of the numbers with their units, in order.
    pub const NAMES: [&'static str; FLANGE_NUMBERS] = [
        "moving_mass_kg",
        "head_mass_kg",
        "structure_stiffness_n_per_m",
        "structure_damping_ratio",
        "structure_quadratic_damping_n_s2_per_m2",
        "contact_stiffness_n_per_m",
        "contact_damping_s_per_m",
        "workpiece_mass_kg",
        "workpiece_stiffness_n_per_m",
        "workpiece_damping_ratio",
        "coulomb_force_n",
        "presliding_m",
        "viscous_coefficient_n_s_per_m",
        "seal_relaxation_s",
        "gas_stiffness_n_per_m",
        "regulator_time_s",
        "valve_time_s",
    ];

    /// The numbers in the order of their names.
    #[must_use]
    pub fn numbers(&self) -> [f64; FLANGE_NUMBERS] {
        [
            self.mass,
            self.head_mass,
            self.structure_stiffness,
            self.structure_damping,
            self.structure_quadratic,
            self.contact_stiffness,
            self.contact_damping,
            self.workpiece_mass,
            self.workpiece_stiffness,
            self.workpiece_damping,
            self.coulomb,
            self.presliding,
            self.viscous,
            self.relaxation,
            self.gas_stiffness,
            self.regulator_time,
            self.valve_time,
        ]
    }

    /// Of its numbers.
    #[must_use]
    pub fn of(numbers: &[f64; FLANGE_NUMBERS]) -> Self {
        let n = numbers;
        Self {
            mass: n[0],
            head_mass: n[1],
            structure_stiffness: n[2],
            structure_damping: n[3],
            structure_quadratic: n[4],
            contact_stiffness: n[5],
            contact_damping: n[6],
            workpiece_mass: n[7],
            workpiece_stiffness: n[8],
            workpiece_damping: n[9],
            coulomb: n[10],
            presliding: n[11],
            viscous: n[12],
            relaxation: n[13],
            gas_stiffness: n[14],
            regulator_time: n[15],
            valve_time: n[16],
        }
    }
}
