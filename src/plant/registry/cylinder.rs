//! The piston, what hangs on it and what rubs on it.

use super::{Number, numbers};
use crate::plant::PlantParameters;

#[rustfmt::skip] // A table: one number a line.
numbers! { CYLINDER:
    /// equal cylinders side by side
    CYLINDER_COUNT = "cylinder.count" as "cylinder_count", [1.0, 16.0], (|p, _| f64::from(p.device.cylinder_count), |p, _, v| p.device.cylinder_count = v as u32);
    /// piston diameter
    BORE = "cylinder.bore_m" as "bore_mm", [0.002, 0.3], (p => p.device.bore);
    /// rod diameter, less than the bore
    ROD = "cylinder.rod_m" as "rod_mm", [5e-4, 0.2], (p => p.device.rod);
    /// full stroke, from end stop to end stop
    STROKE = "cylinder.stroke_m" as "stroke_mm", [0.001, 1.0], (p => p.device.full_stroke);
    /// dead volume of each side, all cylinders together
    DEAD_VOLUME = "cylinder.dead_volume_m3" as "dead_volume_cm3", [1e-8, 5e-3], (p => p.device.dead_volume);
    /// slide with tool
    MOVING_MASS = "cylinder.moving_mass_kg" as "moving_mass_kg", [0.05, 200.0], (p => p.device.moving_mass);
    /// gravity along extension: -9.81 pressing upwards, 0 lying flat
    GRAVITY = "cylinder.gravity_along_axis_m_per_s2", [-30.0, 30.0], (p => p.gravity_along_extension);
    /// of each end stop
    END_STOP_STIFFNESS = "end_stop.stiffness_n_per_m" as "end_stop_stiffness_n_per_m", [1e4, 1e9], (p => p.device.end_stop.stiffness);
    /// of each end stop
    END_STOP_DAMPING = "end_stop.damping_n_s_per_m" as "end_stop_damping_n_s_per_m", [0.0, 1e6], (p => p.device.end_stop.damping);
    /// damping at the very end of the stroke, on approach alone
    CUSHION_DAMPING = "end_cushioning.damping_n_s_per_m" as "end_cushioning_damping_n_s_per_m", [0.0, 1e5], (p => p.device.end_cushioning.damping);
    /// distance from the end at which it has fallen to nothing
    CUSHION_LENGTH = "end_cushioning.length_m" as "end_cushioning_length_mm", [1e-4, 0.25], (p => p.device.end_cushioning.length);
    /// constant force along extension
    AXIAL_LOAD = "axial_load.force_n" as "axial_load_n", [-2000.0, 2000.0], (p => p.device.axial_load.force);
    /// spring that pulls back in proportion to the stroke
    RETURN_STIFFNESS = "axial_load.return_stiffness_n_per_m" as "return_stiffness_n_per_m", [-5e4, 1e5], (p => p.device.axial_load.return_stiffness);
    /// held behind chamber 2 by a second regulator while the device extends; 0: open to the atmosphere
    OPPOSING_PRESSURE = "cylinder.opposing_pressure_pa" as "opposing_pressure_bar_gauge", [0.0, 1e6], (p => p.device.opposing_pressure);
    /// Coulomb friction of seals and guides, all cylinders together
    SEAL_COULOMB = "seal.coulomb_force_n" as "seal_coulomb_force_n", [0.0, 1000.0], (|p, _| p.device.seal_friction.coulomb, set_coulomb);
    /// breakaway force, at least the Coulomb friction
    SEAL_STATIC = "seal.static_force_n" as "seal_static_force_n", [0.0, 1000.0], (|p, _| p.device.seal_friction.static_force, set_static);
    /// speed at which friction falls from breakaway to Coulomb
    SEAL_STRIBECK = "seal.stribeck_velocity_m_per_s" as "seal_stribeck_velocity_mm_per_s", [1e-4, 1.0], (p => p.device.seal_friction.stribeck_velocity);
    /// viscous friction
    SEAL_VISCOUS = "seal.viscous_coefficient_n_s_per_m" as "seal_viscous_coefficient_n_s_per_m", [0.0, 1e5], (p => p.device.seal_friction.viscous);
    /// Coulomb friction over the seals' stiffness before they slide
    SEAL_PRESLIDING = "seal.presliding_displacement_m" as "seal_presliding_displacement_um", [1e-6, 0.01], (p => p.device.seal_friction.presliding_displacement);
    /// growth of Coulomb and breakaway friction with the pressure difference across the piston
    SEAL_PRESSURE = "seal.pressure_coefficient_n_per_pa" as "seal_pressure_coefficient_n_per_pa", [0.0, 0.01], (p => p.device.seal_friction.pressure_coefficient);
    /// clamp of a locked slide
    LOCK_STIFFNESS = "lock.stiffness_n_per_m" as "lock_stiffness_n_per_m", [1e5, 1e10], (p => p.device.lock_stiffness);
}

/// Static friction stays above Coulomb's by as much as it did.
fn set_coulomb(plant: &mut PlantParameters, _: usize, value: f64) {
    let seals = &mut plant.device.seal_friction;
    let extra = seals.static_force - seals.coulomb;
    seals.coulomb = value;
    seals.static_force = value + extra;
}

fn set_static(plant: &mut PlantParameters, _: usize, value: f64) {
    let seals = &mut plant.device.seal_friction;
    seals.static_force = value.max(seals.coulomb);
}
