//! The source paper's first experiment: a step of 1.8 bar onto a load cell, watched as it goes on.
//!
//! ```text
//! touched at 1.21 s
//! in the end 289.5 N
//! at a stroke of 41.93 mm
//! ```

use std::error::Error;
use std::path::Path;

use idc_cell::Rig;
use idc_cell::recording::schema::{CONTACT_FORCE, STROKE};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let rig = Rig::load(&folder.join("scenarios/paper_step.toml"))?;
    let mut touched = None;
    let (recording, stop) = rig.run(&mut |simulation| {
        let truth = simulation.truth();
        if truth.contact_force > 0.0 && touched.is_none() {
            touched = Some(truth.time);
        }
    })?;
    if let Some(error) = stop {
        return Err(error.into());
    }
    let last = |quantity: &str| -> Result<f64, Box<dyn Error>> {
        let values = recording.values(quantity)?;
        Ok(*values.last().ok_or("nothing was recorded")?)
    };
    println!("touched at {:.2} s", touched.ok_or("nothing was touched")?);
    println!("in the end {:.1} N", last(CONTACT_FORCE)?);
    println!("at a stroke of {:.2} mm", 1e3 * last(STROKE)?);
    Ok(())
}
