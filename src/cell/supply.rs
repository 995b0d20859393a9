//! Whether supply and weight allow the desired force all along the edge.

use super::error::CellError;
use crate::device::PressureMap;
use crate::path::{Pass, ToolPath};
use crate::scenario::{Scenario, attainable_set_pressure};

/// The supply must give the force wherever the wrist turns, and gravity alone must not press harder than asked for. Returns the least and greatest
/// component of gravity along the tool's axis [m/s2].
pub(super) fn check(
    scenario: &Scenario,
    passes: &[Pass],
    tool_path: &ToolPath,
) -> Result<[f64; 2], CellError> {
    let mut range = [f64::INFINITY, f64::NEG_INFINITY];
    let map = PressureMap::new(&scenario.nominal.device);
    let device = &scenario.nominal.device;
    let (supply, giver) = attainable_set_pressure(device, &scenario.sensing.command);
    let length = tool_path.length();
    let count = (length / 5e-3).ceil().max(1.0) as usize;
    for i in 0..=count {
        let station = tool_path.at(length * i as f64 / count as f64);
        let share = tool_path.share(&station);
        let gravity = scenario.simulation.gravity.dot(station.axis);
        range = [range[0].min(gravity), range[1].max(gravity)];
        for &Pass { force, .. } in passes {
            let axial = force * share;
            let needed = map.unlimited(axial, gravity);
            if needed < 0.0 {
                let pull = scenario.simulation.gravity.length();
                let cosine = |along: f64| (along / pull).clamp(-1.0, 1.0).acos();
                return Err(CellError::Weight {
                    file: scenario.path.clone(),
                    force,
                    edge_length: station.edge_length,
                    pressing: map.force(0.0, gravity) / share,
                    mass: device.moving_mass,
                    most_mass: axial / gravity,
                    tilt: cosine(gravity),
                    least_opposing: (device.moving_mass * gravity - axial)
                        / device.areas().retracting,
                    least_tilt: cosine(axial / device.moving_mass),
                });
            }
            if needed > supply {
                return Err(CellError::Supply {
                    file: scenario.path.clone(),
                    force,
                    edge_length: station.edge_length,
                    needed,
                    supply,
                    giver,
                    attainable: [map.force(0.0, gravity), map.force(supply, gravity)]
                        .map(|force| force / share),
                });
            }
        }
    }
    Ok(range)
}
