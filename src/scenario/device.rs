//! From a device model file, and what a scenario overrides of it, to the checked device. The model file holds every default, so a key that it lacks is refused.

use std::ops::RangeInclusive;
use std::path::Path;

use crate::device::DeviceParameters;
use crate::physics::axial_load::AxialLoad;
use crate::physics::end_cushioning::EndCushioning;
use crate::physics::gas::Gas;
use crate::physics::gas_process::GasProcess;
use crate::physics::leakage::Leakage;
use crate::physics::push_only::PushOnly;
use crate::physics::regulator::{RateLimit, RegulatorParameters};
use crate::physics::seal_friction::SealFriction;

use super::DeviceScenario;
use super::check::Section;
use super::document::{Document, read_text};
use super::error::ScenarioError;
use super::file::{GasProcessKind, ModelFile, ModelKeys, SCHEMA};
use super::sections::model_sections;

mod parts;

/// Reads a device model file: the device as it comes, not locked.
pub fn load_device(path: &Path) -> Result<DeviceScenario, ScenarioError> {
    load_with_overrides(path, None)
}

/// Reads a device model file; keys of the other table, if any, take precedence.
pub(super) fn load_with_overrides(
    path: &Path,
    overrides: Option<(Section<'_>, &ModelKeys)>,
) -> Result<DeviceScenario, ScenarioError> {
    let text = read_text(path)?;
    let document = Document::new(path, &text, SCHEMA)?;
    let file: ModelFile = document.parse(&model_sections())?;
    let model = Layers {
        layers: overrides
            .into_iter()
            .chain([(Section::new(&document, "device"), &file.device)])
            .collect(),
    };
    let device = DeviceScenario {
        model: path.to_path_buf(),
        parameters: model.parameters()?,
        locked: false,
        moving_centre_of_mass: model.number(
            "moving_centre_of_mass_mm",
            |keys| keys.moving_centre_of_mass_mm,
            0.0..=1000.0,
        )?,
        moving_radius_of_gyration: model.number(
            "moving_radius_of_gyration_mm",
            |keys| keys.moving_radius_of_gyration_mm,
            1.0..=500.0,
        )?,
        tool_centre: model.number("tool_centre_mm", |keys| keys.tool_centre_mm, 1.0..=1000.0)?,
        tool_radius: model.number(
            "tool_ball_radius_mm",
            |keys| keys.tool_ball_radius_mm,
            0.5..=100.0,
        )?,
    };
    model.check(&device)?;
    Ok(device)
}

/// Tables that give the same keys, the first to give one being right.
struct Layers<'a> {
    layers: Vec<(Section<'a>, &'a ModelKeys)>,
}

impl<'a> Layers<'a> {
    /// The first value given, with the table that gives it.
    fn find<T>(
        &self,
        key: &str,
        pick: impl Fn(&ModelKeys) -> Option<T>,
    ) -> Result<(&Section<'a>, T), ScenarioError> {
        self.layers
            .iter()
            .find_map(|(section, keys)| pick(keys).map(|value| (section, value)))
            .ok_or_else(|| {
                // The last layer is the model file, which should hold every key.
                let (model, _) = &self.layers[self.layers.len() - 1];
                model.missing(key, "it to be given, a device model has no defaults")
            })
    }

    fn number(
        &self,
        key: &str,
        pick: impl Fn(&ModelKeys) -> Option<f64>,
        range: RangeInclusive<f64>,
    ) -> Result<f64, ScenarioError> {
        let (section, value) = self.find(key, pick)?;
        section.number(key, value, range)
    }

    #[rustfmt::skip] // A table: one key a line.
    fn parameters(&self) -> Result<DeviceParameters, ScenarioError> {
        let (section, count) = self.find("cylinder_count", |keys| keys.cylinder_count)?;
        let gas = Gas {
            specific_gas_constant: self.number("gas_constant_j_per_kg_k", |keys| keys.gas_constant_j_per_kg_k, 50.0..=5000.0)?,
            heat_capacity_ratio: self.number("gas_heat_capacity_ratio", |keys| keys.gas_heat_capacity_ratio, 1.01..=1.67)?,
            temperature: self.number("gas_temperature_k", |keys| keys.gas_temperature_k, 200.0..=500.0)?,
            atmosphere: self.number("atmosphere_pa_absolute", |keys| keys.atmosphere_pa_absolute, 50_000.0..=110_000.0)?,
        };
        Ok(DeviceParameters {
            cylinder_count: section.count("cylinder_count", count, 1..=16)?,
            bore: self.number("bore_mm", |keys| keys.bore_mm, 4.0..=200.0)?,
            rod: self.number("rod_mm", |keys| keys.rod_mm, 1.0..=150.0)?,
            full_stroke: self.number("stroke_mm", |keys| keys.stroke_mm, 1.0..=500.0)?,
            dead_volume: self.number("dead_volume_cm3", |keys| keys.dead_volume_cm3, 0.1..=5000.0)?,
            moving_mass: self.number("moving_mass_kg", |keys| keys.moving_mass_kg, 0.1..=100.0)?,
            supply_orifice: self.number("supply_orifice_mm2", |keys| keys.supply_orifice_mm2, 0.01..=100.0)?,
            exhaust_orifice: self.number("exhaust_orifice_mm2", |keys| keys.exhaust_orifice_mm2, 0.01..=100.0)?,
            discharge_coefficient: self.number("discharge_coefficient", |keys| keys.discharge_coefficient, 0.1..=1.0)?,
            regulator: RegulatorParameters {
                gain: self.number("regulator_gain", |keys| keys.regulator_gain, 0.5..=1.5)?,
                time_constant: self.number("regulator_time_constant_s", |keys| keys.regulator_time_constant_s, 0.001..=10.0)?,
                dead_time: self.number("regulator_dead_time_ms", |keys| keys.regulator_dead_time_ms, 0.0..=5000.0)?,
                supply: self.number("supply_pressure_bar_gauge", |keys| keys.supply_pressure_bar_gauge, 0.1..=16.0)?,
                hysteresis: self.number("regulator_hysteresis_pa", |keys| keys.regulator_hysteresis_pa, 0.0..=2e5)?,
                rate_limit: RateLimit {
                    rise: self.number("regulator_rise_limit_pa_per_s", |keys| keys.regulator_rise_limit_pa_per_s, 1000.0..=f64::INFINITY)?,
                    fall: self.number("regulator_fall_limit_pa_per_s", |keys| keys.regulator_fall_limit_pa_per_s, 1000.0..=f64::INFINITY)?,
                },
                second_order: self.second_order()?,
            },
            end_stop: PushOnly {
                stiffness: self.number("end_stop_stiffness_n_per_m", |keys| keys.end_stop_stiffness_n_per_m, 1e4..=1e9)?,
                damping: self.number("end_stop_damping_n_s_per_m", |keys| keys.end_stop_damping_n_s_per_m, 0.0..=1e6)?,
            },
            seal_friction: self.seal_friction()?,
            gas_process: self.gas_process()?,
            hose: self.hose(&gas)?,
            lock_stiffness: self.number("lock_stiffness_n_per_m", |keys| keys.lock_stiffness_n_per_m, 1e5..=1e10)?,
            leakage: Leakage {
                cross_piston: self.number("cross_piston_leak_mm2", |keys| keys.cross_piston_leak_mm2, 0.0..=10.0)?,
                external: self.number("external_leak_mm2", |keys| keys.external_leak_mm2, 0.0..=10.0)?,
            },
            axial_load: AxialLoad {
                force: self.number("axial_load_n", |keys| keys.axial_load_n, -2000.0..=2000.0)?,
                return_stiffness: self.number("return_stiffness_n_per_m", |keys| keys.return_stiffness_n_per_m, 0.0..=1e5)?,
            },
            end_cushioning: EndCushioning {
                damping: self.number("end_cushioning_damping_n_s_per_m", |keys| keys.end_cushioning_damping_n_s_per_m, 0.0..=1e5)?,
                length: self.number("end_cushioning_length_mm", |keys| keys.end_cushioning_length_mm, 0.1..=250.0)?,
            },
            supply_reservoir: self.supply_reservoir()?,
            switching_delay: self.number("valve_switching_delay_ms", |keys| keys.valve_switching_delay_ms, 0.0..=1000.0)?,
            gas,
        })
    }

    #[rustfmt::skip] // A table: one key a line.
    fn seal_friction(&self) -> Result<SealFriction, ScenarioError> {
        Ok(SealFriction {
            coulomb: self.number("seal_coulomb_force_n", |keys| keys.seal_coulomb_force_n, 0.0..=1000.0)?,
            static_force: self.number("seal_static_force_n", |keys| keys.seal_static_force_n, 0.0..=1000.0)?,
            stribeck_velocity: self.number("seal_stribeck_velocity_mm_per_s", |keys| keys.seal_stribeck_velocity_mm_per_s, 0.1..=1000.0)?,
            viscous: self.number("seal_viscous_coefficient_n_s_per_m", |keys| keys.seal_viscous_coefficient_n_s_per_m, 0.0..=1e5)?,
            presliding_displacement: self.number("seal_presliding_displacement_um", |keys| keys.seal_presliding_displacement_um, 1.0..=5000.0)?,
            pressure_coefficient: self.number("seal_pressure_coefficient_n_per_pa", |keys| keys.seal_pressure_coefficient_n_per_pa, 0.0..=0.01)?,
        })
    }

    fn gas_process(&self) -> Result<GasProcess, ScenarioError> {
        let conductance = self.number(
            "wall_conductance_w_per_k",
            |keys| keys.wall_conductance_w_per_k,
            0.0..=100.0,
        )?;
        let (_, kind) = self.find("gas_process", |keys| keys.gas_process)?;
        Ok(match kind {
            GasProcessKind::Isothermal => GasProcess::Isothermal,
            GasProcessKind::WallHeat => GasProcess::WallHeat { conductance },
        })
    }

    /// What the values must be to each other.
    fn check(&self, device: &DeviceScenario) -> Result<(), ScenarioError> {
        let parameters = &device.parameters;
        if parameters.rod >= parameters.bore {
            let (_, bore) = self.find("bore_mm", |keys| keys.bore_mm)?;
            let (section, rod) = self.find("rod_mm", |keys| keys.rod_mm)?;
            let expected = format!("less than bore_mm, {bore} mm");
            return Err(section.refuse_number("rod_mm", rod, expected));
        }
        let seals = &parameters.seal_friction;
        if seals.static_force < seals.coulomb {
            let (_, coulomb) =
                self.find("seal_coulomb_force_n", |keys| keys.seal_coulomb_force_n)?;
            let (section, value) =
                self.find("seal_static_force_n", |keys| keys.seal_static_force_n)?;
            let expected = format!("at least seal_coulomb_force_n, {coulomb} N");
            return Err(section.refuse_number("seal_static_force_n", value, expected));
        }
        if device.tool_centre < device.tool_radius {
            let (_, radius) = self.find("tool_ball_radius_mm", |keys| keys.tool_ball_radius_mm)?;
            let (section, centre) = self.find("tool_centre_mm", |keys| keys.tool_centre_mm)?;
            let expected = format!(
                "at least tool_ball_radius_mm, {radius} mm, so that the ball is in front of the flange"
            );
            return Err(section.refuse_number("tool_centre_mm", centre, expected));
        }
        Ok(())
    }
}
