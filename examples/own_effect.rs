//! An effect of one's own, written as an expression: a bench with and without damping that acts outwards alone.
//!
//! ```text
//! as it is 0.267 m/s
//! damped 0.197 m/s
//! ```

use std::error::Error;
use std::path::Path;

use idc_cell::Rig;
use idc_cell::recording::schema::STROKE_VELOCITY;

/// A law over the speed v [m/s] of extension, in SI.
const EFFECT: &str = r#"
[[effect]]
name = "one_way_damping"
acts_on = "piston_force"
is = "-c * max(v, 0)"
c = { value = 400, unit = "N s/m" }
"#;

fn fastest(scenario: &Path) -> Result<f64, Box<dyn Error>> {
    let (recording, _) = Rig::load(scenario)?.run(&mut |_| ())?;
    let speeds = recording.values(STROKE_VELOCITY)?.iter();
    Ok(speeds.copied().fold(0.0, f64::max))
}

fn main() -> Result<(), Box<dyn Error>> {
    let nominal = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/paper_step.toml");
    let models = format!("{}/models/", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&nominal)?.replace("../models/", &models);
    let folder = std::env::temp_dir().join(format!("own_effect_{}", std::process::id()));
    std::fs::create_dir_all(&folder)?;
    let damped = folder.join("damped.toml");
    std::fs::write(&damped, text + EFFECT)?;
    println!("as it is {:.3} m/s", fastest(&nominal)?);
    println!("damped {:.3} m/s", fastest(&damped)?);
    Ok(std::fs::remove_dir_all(folder)?)
}
