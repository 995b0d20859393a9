//! Parts of a device that it need not have: line, reservoir, the regulator's oscillator.

use super::Layers;
use crate::physics::gas::Gas;
use crate::physics::hose::Hose;
use crate::physics::regulator::SecondOrder;
use crate::physics::supply_reservoir::SupplyReservoir;
use crate::scenario::error::ScenarioError;
use crate::scenario::file::ModelKeys;

/// Smallest natural frequency that stands for an oscillator [rad/s].
const LOWEST_FREQUENCY: f64 = 0.1;
/// Smallest reservoir [m3].
const SMALLEST_RESERVOIR: f64 = 1e-5;

impl Layers<'_> {
    /// Refusal of a key's value, as it was given.
    fn refusal(
        &self,
        key: &str,
        pick: impl Fn(&ModelKeys) -> Option<f64>,
        expected: &str,
    ) -> ScenarioError {
        match self.find(key, pick) {
            Ok((section, value)) => section.refuse_number(key, value, expected.to_owned()),
            Err(missing) => missing,
        }
    }

    /// The line, by its geometry or by its volume and resistance; none of no length and no volume.
    pub(super) fn hose(&self, gas: &Gas) -> Result<Option<Hose>, ScenarioError> {
        let length = self.number("hose_length_m", |keys| keys.hose_length_m, 0.0..=50.0)?;
        let diameter = self.number("hose_diameter_mm", |keys| keys.hose_diameter_mm, 1.0..=25.0)?;
        let volume = self.number("hose_volume_cm3", |keys| keys.hose_volume_cm3, 0.0..=1e4)?;
        let resistance = self.number(
            "hose_resistance_pa_s_per_kg",
            |keys| keys.hose_resistance_pa_s_per_kg,
            0.0..=1e12,
        )?;
        if volume > 0.0 && length > 0.0 {
            let expected = "0 beside a hose_length_m, which says the volume";
            return Err(self.refusal("hose_volume_cm3", |keys| keys.hose_volume_cm3, expected));
        }
        if (volume > 0.0) != (resistance > 0.0) {
            let expected = "more than 0 with a hose_volume_cm3, and 0 without one";
            let pick = |keys: &ModelKeys| keys.hose_resistance_pa_s_per_kg;
            return Err(self.refusal("hose_resistance_pa_s_per_kg", pick, expected));
        }
        if volume > 0.0 {
            return Ok(Some(Hose::lumped(volume, resistance)));
        }
        Ok((length > 0.0).then(|| Hose::tube(length, diameter, gas)))
    }

    /// The reservoir in front of the regulator; none of no volume.
    pub(super) fn supply_reservoir(&self) -> Result<Option<SupplyReservoir>, ScenarioError> {
        let key = "supply_reservoir_volume_cm3";
        let volume = self.number(key, |keys| keys.supply_reservoir_volume_cm3, 0.0..=1e6)?;
        let full_pressure = self.number(
            "supply_reservoir_pressure_pa_absolute",
            |keys| keys.supply_reservoir_pressure_pa_absolute,
            1.1e5..=2e6,
        )?;
        let compressor_flow = self.number(
            "compressor_flow_kg_per_s",
            |keys| keys.compressor_flow_kg_per_s,
            0.0..=1.0,
        )?;
        if volume > 0.0 && volume < SMALLEST_RESERVOIR {
            let expected = "0 for none, or 10 to 1000000 cm3";
            return Err(self.refusal(key, |keys| keys.supply_reservoir_volume_cm3, expected));
        }
        Ok((volume > 0.0).then_some(SupplyReservoir {
            volume,
            full_pressure,
            compressor_flow,
        }))
    }

    /// The regulator's oscillator; none of no frequency.
    pub(super) fn second_order(&self) -> Result<Option<SecondOrder>, ScenarioError> {
        let key = "regulator_natural_frequency_rad_per_s";
        let pick = |keys: &ModelKeys| keys.regulator_natural_frequency_rad_per_s;
        let natural_frequency = self.number(key, pick, 0.0..=1000.0)?;
        let damping_ratio = self.number(
            "regulator_damping_ratio",
            |keys| keys.regulator_damping_ratio,
            0.01..=100.0,
        )?;
        if natural_frequency > 0.0 && natural_frequency < LOWEST_FREQUENCY {
            return Err(self.refusal(key, pick, "0 for none, or 0.1 to 1000 rad/s"));
        }
        Ok((natural_frequency > 0.0).then_some(SecondOrder {
            natural_frequency,
            damping_ratio,
        }))
    }
}
