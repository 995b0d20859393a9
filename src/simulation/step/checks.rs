//! Reasons to stop a run: numbers that cannot be, an axis that is lost, a stroke that ran out.

use super::Simulation;
use crate::path::{Phase, Reference};
use crate::recording::Unit;
use crate::recording::schema::{self, JointSignal};
use crate::simulation::error::SimulationError;

/// Distance from its reference at which an axis counts as lost [rad].
const LOST: f64 = 0.05;

impl Simulation<'_> {
    /// The ball must stay on the edge: `off` is its distance from its path across travel and tool axis [m].
    pub(super) fn check_on_edge(
        &self,
        reference: &Reference,
        off: f64,
        force: f64,
        time: f64,
    ) -> Result<(), SimulationError> {
        let radius = self.cell.setup.scenario.nominal.mounting.tool_radius;
        if reference.phase == Phase::Follow && off > radius {
            return Err(SimulationError::SlippedOff {
                time,
                edge_length: reference.edge_length,
                off,
                radius,
                force,
            });
        }
        Ok(())
    }

    /// The spindle must turn its tool.
    pub(super) fn check_spindle(
        &self,
        reference: &Reference,
        time: f64,
    ) -> Result<(), SimulationError> {
        match &self.cutting {
            Some(cutting) if cutting.stalled() => Err(SimulationError::Stalled {
                time,
                edge_length: reference.edge_length,
                torque: cutting.reading().torque,
                stall_torque: cutting.stall_torque(),
            }),
            _ => Ok(()),
        }
    }

    pub(super) fn check_finite(
        &self,
        signals: &[f64],
        joints: &[[f64; JointSignal::ALL.len()]],
        phase: Phase,
        time: f64,
    ) -> Result<(), SimulationError> {
        let sensors = schema::CELL_SENSORS.iter();
        let sensors = sensors.filter_map(|sensor| schema::definition(sensor));
        let mut named = signals.iter().zip(schema::SIGNALS.iter().chain(sensors));
        let bad = named.find(|(value, signal)| {
            !value.is_finite() || (signal.unit == Unit::Kilogram && **value < 0.0)
        });
        let bad = bad.map(|(value, signal)| (signal.quantity, *value));
        let bad = bad.or_else(|| {
            joints
                .iter()
                .flatten()
                .find(|v| !v.is_finite())
                .map(|v| ("a joint", *v))
        });
        match bad {
            None => Ok(()),
            Some((quantity, value)) => Err(SimulationError::NotFinite {
                quantity,
                value,
                time,
                phase: phase.name(),
                step: self.cell.setup.scenario.simulation.step,
            }),
        }
    }

    pub(super) fn check_axes(
        &self,
        joints: &[[f64; JointSignal::ALL.len()]],
        phase: Phase,
        time: f64,
    ) -> Result<(), SimulationError> {
        for (axis, joint) in joints.iter().enumerate() {
            let error = joint[1] - joint[0];
            if error.abs() > LOST {
                let axis = &self.cell.setup.arm.chain.joints[axis];
                return Err(SimulationError::AxisLost {
                    axis: axis.name.clone(),
                    error: error.abs(),
                    accepted: LOST,
                    torque: joint[3].abs(),
                    effort: axis.effort,
                    time,
                    phase: phase.name(),
                });
            }
        }
        Ok(())
    }

    /// No body may meet another.
    pub(super) fn check_clearance(
        &mut self,
        reference: &Reference,
        time: f64,
    ) -> Result<(), SimulationError> {
        let positions = super::start::to_array(self.world.positions());
        match self.clearance.meets(&positions) {
            None => Ok(()),
            Some((names, depth)) => Err(SimulationError::Collision {
                names,
                depth,
                time,
                phase: reference.phase.name(),
                edge_length: reference.edge_length,
            }),
        }
    }

    /// The slide must never reach its inner end, and on the edge not its outer one either; `tip` is how far the tool is beyond its place along its axis [m].
    pub(super) fn check_stroke(
        &self,
        reference: &Reference,
        (stroke, tip): (f64, f64),
        time: f64,
    ) -> Result<(), SimulationError> {
        let scenario = &self.cell.setup.scenario;
        let full_stroke = scenario.nominal.device.full_stroke;
        if scenario.device.locked {
            return Ok(());
        }
        let on_edge = reference.phase == Phase::Follow;
        if stroke <= 0.0 || (on_edge && stroke >= full_stroke) {
            return Err(SimulationError::StrokeRanOut {
                time,
                phase: reference.phase.name(),
                edge_length: reference.edge_length,
                stroke,
                full_stroke,
                arm: tip - (stroke - scenario.process.working_stroke),
                tip,
                touched: self.touched,
            });
        }
        Ok(())
    }
}
