//! Parts of a device that it need not have: line, reservoir, the regulator's oscillator; and what its gas does.

use super::Layers;
use super::keys::GasProcessKind;
use crate::device::DeviceParameters;
use crate::keys::error::ScenarioError;
use crate::physics::gas_process::GasProcess;
use crate::physics::hose::Hose;
use crate::physics::regulator::SecondOrder;
use crate::physics::supply_reservoir::SupplyReservoir;
use crate::plant::registry;

/// Smallest natural frequency that stands for an oscillator [rad/s].
const LOWEST_FREQUENCY: f64 = 0.1;
/// Smallest reservoir [m3].
const SMALLEST_RESERVOIR: f64 = 1e-5;

impl Layers<'_> {
    /// Gives a device the parts that the tables say it has.
    pub(super) fn add_parts(&self, device: &mut DeviceParameters) -> Result<(), ScenarioError> {
        let conductance = self.number(&registry::WALL_CONDUCTANCE)?;
        let given = match self.of_scenario(|keys| keys.gas_process) {
            None if self.ideal => GasProcessKind::Isothermal,
            _ => self.find("gas_process", |keys| keys.gas_process)?.1,
        };
        device.gas_process = match given {
            GasProcessKind::Isothermal => GasProcess::Isothermal,
            GasProcessKind::WallHeat => GasProcess::WallHeat { conductance },
        };
        device.hose = self.hose(device)?;
        device.supply_reservoir = self.supply_reservoir()?;
        device.regulator.second_order = self.second_order()?;
        Ok(())
    }

    /// The line, by its geometry or by its volume and resistance; none of no length and no volume.
    fn hose(&self, device: &DeviceParameters) -> Result<Option<Hose>, ScenarioError> {
        let length = self.number(&registry::HOSE_LENGTH)?;
        let diameter = self.number(&registry::HOSE_DIAMETER)?;
        let volume = self.number(&registry::HOSE_VOLUME)?;
        let resistance = self.number(&registry::HOSE_RESISTANCE)?;
        if volume > 0.0 && length > 0.0 {
            let expected = "0 beside a hose_length_m, which says the volume";
            return Err(self.refusal(&registry::HOSE_VOLUME, expected));
        }
        if (volume > 0.0) != (resistance > 0.0) {
            let expected = "more than 0 with a hose_volume_cm3, and 0 without one";
            return Err(self.refusal(&registry::HOSE_RESISTANCE, expected));
        }
        if volume > 0.0 {
            return Ok(Some(Hose::lumped(volume, resistance)));
        }
        Ok((length > 0.0).then(|| Hose::tube(length, diameter, &device.gas)))
    }

    /// The reservoir in front of the regulator; none of no volume.
    fn supply_reservoir(&self) -> Result<Option<SupplyReservoir>, ScenarioError> {
        let volume = self.number(&registry::RESERVOIR_VOLUME)?;
        let full_pressure = self.number(&registry::RESERVOIR_PRESSURE)?;
        let compressor_flow = self.number(&registry::COMPRESSOR_FLOW)?;
        if volume > 0.0 && volume < SMALLEST_RESERVOIR {
            let expected = "0 for none, or 10 to 1000000 cm3";
            return Err(self.refusal(&registry::RESERVOIR_VOLUME, expected));
        }
        Ok((volume > 0.0).then_some(SupplyReservoir {
            volume,
            full_pressure,
            compressor_flow,
        }))
    }

    /// The regulator's oscillator; none of no frequency.
    fn second_order(&self) -> Result<Option<SecondOrder>, ScenarioError> {
        let natural_frequency = self.number(&registry::NATURAL_FREQUENCY)?;
        let damping_ratio = self.number(&registry::DAMPING_RATIO)?;
        if natural_frequency > 0.0 && natural_frequency < LOWEST_FREQUENCY {
            let expected = "0 for none, or 0.1 to 1000 rad/s";
            return Err(self.refusal(&registry::NATURAL_FREQUENCY, expected));
        }
        Ok((natural_frequency > 0.0).then_some(SecondOrder {
            natural_frequency,
            damping_ratio,
        }))
    }
}
