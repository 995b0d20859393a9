//! Effects in the balance of forces on the piston.

pub mod axial_force_offset;
pub mod coulomb_viscous_friction;
pub mod end_cushioning;
pub mod moving_mass_error;
pub mod presliding_hysteresis;
pub mod pressure_dependent_friction;
pub mod return_spring_load;
pub mod stribeck_friction;

use super::parts::*;

const COULOMB: Quantity = SEAL_COULOMB.named("coulomb_force_n");
const VISCOUS: Quantity = SEAL_VISCOUS.named("viscous_coefficient_n_s_per_m");
const PRESLIDING: Quantity = SEAL_PRESLIDING.named("presliding_displacement_m");

/// Dry force [N] and viscous coefficient [N s/m] of the seals as the description has them so far; none where they do not rub.
fn rubbing(clues: &Clues<'_>) -> Option<[f64; 2]> {
    let seals = &clues.plant.device.seal_friction;
    (seals.coulomb > 0.1).then_some([seals.coulomb, seals.viscous])
}
