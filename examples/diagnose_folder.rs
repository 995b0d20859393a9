//! A folder with rig.toml and recordings, diagnosed: what the nominal model lacks, with numbers and intervals.
//!
//! ```text
//! fitted in full: 1 explanations
//! transport_delay
//!   delay_s = 4.419e-2 (4.194e-2 to 4.655e-2)
//! ```

use std::error::Error;
use std::path::Path;

use idc_cell::diagnosis::search::progress::{Progress, Step};
use idc_cell::{Case, Settings, diagnose};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let case = Case::from_folder(&folder.join("assets/proof/cases/case-03"))?;
    let mut fitted = 0;
    let mut observer = |progress: &Progress<'_>| {
        fitted += usize::from(progress.step == Step::FullFit);
    };
    let diagnosed = diagnose(&case, &Settings::default(), &mut observer)?;
    println!("fitted in full: {fitted} explanations");
    for effect in &diagnosed.answer.effects {
        println!("{}", effect.name);
        for (name, number) in &effect.parameters {
            let (value, low, high) = (number.value, number.low, number.high);
            println!("  {name} = {value:.3e} ({low:.3e} to {high:.3e})");
        }
    }
    Ok(())
}
