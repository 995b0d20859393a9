//! A cell simulated from its scenario file: the contact force while the tool follows the edge.
//!
//! ```text
//! following from 3.38 s to 17.50 s: 150.1 N, standard deviation 0.75 N
//! ```

use std::error::Error;
use std::path::Path;

use idc_cell::Cell;
use idc_cell::recording::schema::CONTACT_FORCE;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let cell = Cell::load(&folder.join("scenarios/plate_edge.toml"))?;
    let run = cell.run(&mut |_| ())?;
    let recording = run.recording;
    let follow = recording
        .phase("follow")
        .ok_or("the tool followed no edge")?;
    let force = &recording.values(CONTACT_FORCE)?[recording.samples_in(follow)];
    let mean = force.iter().sum::<f64>() / force.len() as f64;
    let square = force.iter().map(|f| (f - mean).powi(2)).sum::<f64>();
    println!(
        "following from {:.2} s to {:.2} s: {mean:.1} N, standard deviation {:.2} N",
        follow.start,
        follow.end,
        (square / force.len() as f64).sqrt()
    );
    Ok(())
}
