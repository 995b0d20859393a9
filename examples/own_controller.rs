//! A force controller of one's own in a cell: the desired force over the pistons' area, corrected by the integral of the load cell's error.
//!
//! ```text
//! 153.3 N at the start of the edge, 150.1 N at its end
//! ```

use std::error::Error;
use std::path::Path;

use idc_cell::Cell;
use idc_cell::control::force::{ForceController, ForceObservation, OwnController};
use idc_cell::recording::schema::CONTACT_FORCE;

#[derive(Debug, Clone)]
struct Integrating {
    /// Moving mass [kg] and area of the pistons [m2].
    mass: f64,
    area: f64,
    /// Share of the error that is corrected in a period [1].
    gain: f64,
    /// Correction so far [N].
    correction: f64,
}

impl OwnController for Integrating {
    fn set_pressure(&mut self, seen: &ForceObservation) -> f64 {
        if seen.measured_axial_force > 1.0 {
            let error = seen.desired_axial_force - seen.measured_axial_force;
            self.correction += self.gain * error;
        }
        let force = seen.desired_axial_force + self.correction;
        ((force - self.mass * seen.gravity_along_axis) / self.area).max(0.0)
    }

    fn boxed_clone(&self) -> Box<dyn OwnController> {
        Box::new(self.clone())
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut cell = Cell::load(&folder.join("scenarios/plate_edge.toml"))?;
    cell.controller = ForceController::Own(Box::new(Integrating {
        mass: cell.setup.actual.device.moving_mass,
        area: 1.6e-3,
        gain: 0.02, // each 20 ms, as the scenario has it
        correction: 0.0,
    }));
    let run = cell.run(&mut |_| ())?;
    let follow = run
        .recording
        .phase("follow")
        .ok_or("nothing was followed")?;
    let samples = run.recording.samples_in(follow);
    let force = &run.recording.values(CONTACT_FORCE)?[samples];
    let (first, last) = (force[0], force[force.len() - 1]);
    println!("{first:.1} N at the start of the edge, {last:.1} N at its end");
    Ok(())
}
