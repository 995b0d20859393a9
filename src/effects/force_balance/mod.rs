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

/// Coulomb friction; static friction stays above it by as much as it did.
const COULOMB: Quantity = Quantity {
    name: "coulomb_force_n",
    index: 0,
    get: |p, _| p.device.seal_friction.coulomb,
    set: |p, _, v| {
        let s = &mut p.device.seal_friction;
        let extra = s.static_force - s.coulomb;
        s.coulomb = v;
        s.static_force = v + extra;
    },
};
const VISCOUS: Quantity =
    quantity!("viscous_coefficient_n_s_per_m", p => p.device.seal_friction.viscous);
const PRESLIDING: Quantity =
    quantity!("presliding_displacement_m", p => p.device.seal_friction.presliding_displacement);
