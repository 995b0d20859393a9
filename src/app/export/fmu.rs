//! `idc export fmu`: a bench, or a rig file on a bench, as a co-simulation unit.

use std::path::{Path, PathBuf};

use clap::Args;

use super::super::error::{AppError, ExitCode};
use super::super::files::{OverwritePolicy, prepare_file};
use super::super::output::say;
use super::super::terminal::shown_path;
use super::super::this_program::this_program;
use super::archive::packed;
use super::description::{IDENTIFIER, description};
use super::error::ExportError;
use super::version::Version;
use crate::flange::FittedFlange;
use crate::fmu::{Causality, FmuError, MARK, Model, SCENARIO};
use crate::plant::{DeviceParts, PlantParameters};
use crate::recording::RecordingError;
use crate::recording::atomic::{write_all, write_text};
use crate::scenario::rig_file::{RigFile, load_rig};
use crate::scenario::{
    AnyScenario, KeyValue, ScenarioError, ScenarioTemplate, keys_given, load_any, load_device,
};

/// For the help.
pub(super) const EXAMPLES: &str = "\
The unit is the device with regulator, valve and sensors, and with every effect
of its file: what a diagnosis found, too. Inputs are set pressure, valve,
surface and an outside force, outputs force, pressures, stroke and readings;
numbers of the device are tunable parameters with units, and the state can be
saved and restored. The bench's own step is inside: at it the numbers are those
of idc run. docs/FMU.md says how it is used and how exact it is.

The unit takes along the shared library of co-simulation units, from beside this
program, from examples beside it, from ../lib, or from --library. Exit codes:
0 written, 2 bad input.

Examples:
  # Of a bench, for FMI 3.0, with its library. (takes minutes)
  cargo build --release --example co_simulation_unit
  idc export fmu scenarios/paper_step.toml --out runs/device.fmu
  # Of a diagnosed rig, for FMI 2.0. (takes minutes)
  idc export fmu runs/found/improved.toml --fmi 2 --out runs/found.fmu";

/// File of the device in the unit's resources.
const DEVICE: &str = "device.toml";
/// The library as cargo names it.
const LIBRARY: &str = "libco_simulation_unit.so";

#[derive(Debug, Args)]
pub(super) struct FmuArguments {
    /// Scenario of a bench, rig file, nominal or improved, or device model.
    file: PathBuf,
    /// Version of FMI.
    #[arg(long, default_value = "3")]
    fmi: Version,
    /// Shared library of co-simulation units [default: beside this program, in examples, or in ../lib].
    #[arg(long, value_name = "FILE")]
    library: Option<PathBuf>,
    /// The unit [default: runs/<file's name>.fmu].
    #[arg(long, help_heading = "Output")]
    out: Option<PathBuf>,
    /// Put a new file in place of an old one.
    #[arg(long, help_heading = "Output")]
    force: bool,
    /// Print nothing but errors.
    #[arg(long, help_heading = "Output")]
    quiet: bool,
    /// Print what was written as JSON.
    #[arg(long, conflicts_with = "quiet", help_heading = "Output")]
    json: bool,
}

/// Writes the unit.
pub(super) fn run(arguments: &FmuArguments) -> Result<ExitCode, AppError> {
    on_this_platform(std::env::consts::ARCH, std::env::consts::OS)?;
    let resources = resources(&arguments.file)?;
    let library = library(arguments.library.as_deref())?;
    let folder = tempfile::tempdir().map_err(ExportError::Pack)?;
    write_text(&folder.path().join(SCENARIO), &resources.scenario)?;
    write_text(&folder.path().join(DEVICE), &resources.device)?;
    let model = Model::load(&folder.path().join(SCENARIO)).map_err(ExportError::Fmu)?;
    let text = description(&model, arguments.fmi).map_err(ExportError::Pack)?;
    let binary = format!("binaries/{}/{IDENTIFIER}.so", arguments.fmi.platform());
    let [scenario, device] = [SCENARIO, DEVICE].map(|name| format!("resources/{name}"));
    let files: [(&str, &[u8]); 4] = [
        ("modelDescription.xml", &text),
        (&binary, &library),
        (&scenario, resources.scenario.as_bytes()),
        (&device, resources.device.as_bytes()),
    ];
    let bytes = packed(&files).map_err(ExportError::Pack)?;
    let stem = arguments.file.file_stem().unwrap_or_default();
    let usual = || Path::new("runs").join(stem).with_extension("fmu");
    let out = arguments.out.clone().unwrap_or_else(usual);
    let policy = OverwritePolicy::of(arguments.force);
    let _claim = prepare_file(&out, "--out", policy)?;
    write_all(&[(&out, bytes)])?;
    report(arguments, &out, &model)?;
    Ok(ExitCode::Done)
}

fn on_this_platform(architecture: &'static str, system: &'static str) -> Result<(), ExportError> {
    match (architecture, system) {
        ("x86_64", "linux") => Ok(()),
        _ => Err(ExportError::Platform {
            architecture,
            system,
        }),
    }
}

/// Texts that a unit reads.
struct Resources {
    scenario: String,
    device: String,
}

/// The scenario with its device beside it, whatever file it names; of a rig file or a device model a bench with a surface.
fn resources(file: &Path) -> Result<Resources, AppError> {
    let keys = keys_given(file, "")?;
    let has = |key: &str| keys.iter().any(|given| given == key);
    if !has("kind") && !has("title") && (has("cylinder") || has("device")) {
        let plant = match has("cylinder") {
            true => {
                let rig = load_rig(file)?;
                refuse_part(&rig)?;
                rig.plant
            }
            false => load_device(file)?.1,
        };
        return Ok(Resources {
            scenario: bench_of(file, &plant),
            device: text_of(file)?,
        });
    }
    match load_any(file) {
        Ok(AnyScenario::Bench(_)) => (),
        Ok(AnyScenario::Cell(_)) | Err(ScenarioError::OtherKind { .. }) => {
            let file = file.display().to_string();
            return Err(ExportError::Fmu(FmuError::Cell { file }).into());
        }
        Err(error) => return Err(error.into()),
    }
    let model = Model::load(file).map_err(ExportError::Fmu)?;
    let beside = [KeyValue::text("device.model", DEVICE)];
    Ok(Resources {
        scenario: ScenarioTemplate::read(file)?.text(&beside)?,
        device: text_of(&model.scenario.device.model)?,
    })
}

fn text_of(file: &Path) -> Result<String, RecordingError> {
    crate::file::read_text(file).map_err(|error| RecordingError::read(file, error))
}

/// Refuses a rig that is a part of a device, or another one.
fn refuse_part(rig: &RigFile) -> Result<(), ExportError> {
    let file = rig.path.display().to_string();
    let flange: Option<&FittedFlange> = rig.flange.as_ref();
    if flange.is_some() {
        return Err(ExportError::Flange { file });
    }
    match rig.plant.parts {
        DeviceParts::Whole => Ok(()),
        part => {
            let chain = part.name();
            Err(FmuError::Part { file, chain }.into())
        }
    }
}

/// A bench on which a device meets a surface, at four fifths of its stroke until an importer says otherwise, with ideal instruments.
fn bench_of(file: &Path, plant: &PlantParameters) -> String {
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    // What a text of a file takes as it is.
    let plain = |letter: &char| letter.is_alphanumeric() || " _-.".contains(*letter);
    let title: String = "Bench of "
        .chars()
        .chain(stem.chars().filter(plain))
        .collect();
    let position = (0.8e3 * plant.device.full_stroke).min(500.0);
    format!(
        "# Written by idc export fmu.\nschema = 2\nkind = \"bench\"\ntitle = \"{title}\"\n\n[device]\nmodel = \"{DEVICE}\"\n\n[bench]\nduration_s = 10\n\n[load]\nkind = \"load_cell\"\nposition_mm = {position:.3}\n\n[[command]]\nat_s = 0\nset_pressure_bar_gauge = 0\n"
    )
}

/// The library, of this program's build.
fn library(named: Option<&Path>) -> Result<Vec<u8>, AppError> {
    let places = match named {
        Some(file) => vec![file.to_owned()],
        None => usual_places(),
    };
    let Some(file) = places.iter().find(|place| place.is_file()) else {
        let looked: Vec<String> = places.iter().map(|p| p.display().to_string()).collect();
        let looked = looked.join(", ");
        return Err(ExportError::NoLibrary { looked }.into());
    };
    let bytes = crate::file::read(file).map_err(|error| RecordingError::read(file, error))?;
    if !holds(&bytes, MARK.as_bytes()) {
        let file = file.display().to_string();
        return Err(ExportError::OtherLibrary { file, mark: MARK }.into());
    }
    Ok(bytes)
}

fn holds(bytes: &[u8], mark: &[u8]) -> bool {
    bytes.windows(mark.len()).any(|window| window == mark)
}

/// Beside the program; in examples there, as cargo builds it; in ../lib, as it is installed.
fn usual_places() -> Vec<PathBuf> {
    let program = this_program().unwrap_or_default();
    let folder = program.parent().unwrap_or(Path::new("")).to_owned();
    let above = folder.parent().unwrap_or(Path::new(""));
    let places = [folder.clone(), folder.join("examples"), above.join("lib")];
    places.map(|place| place.join(LIBRARY)).to_vec()
}

/// What was written.
fn report(arguments: &FmuArguments, out: &Path, model: &Model) -> Result<(), AppError> {
    let count = |wanted: &[Causality]| {
        let own = model.variables.iter();
        own.filter(|own| wanted.contains(&own.causality)).count()
    };
    let [inputs, outputs, parameters] = [
        count(&[Causality::Input]),
        count(&[Causality::Output]),
        count(&[Causality::Tunable, Causality::Fixed]),
    ];
    let version = arguments.fmi.number();
    let step = model.scenario.step;
    if arguments.json {
        let document = serde_json::json!({
            "file": out.display().to_string(),
            "fmi": version,
            "inputs": inputs,
            "outputs": outputs,
            "parameters": parameters,
            "step_s": step,
            "token": model.token,
        });
        return say(&format!("{document:#}\n"));
    }
    if arguments.quiet {
        return Ok(());
    }
    say(&format!(
        "written to {}: FMI {version}, {inputs} inputs, {outputs} outputs, {parameters} parameters, steps of {} ms inside\n",
        shown_path(out),
        1e3 * step
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elsewhere_than_on_x86_64_linux_the_way_is_said() {
        assert!(on_this_platform("x86_64", "linux").is_ok());
        for (architecture, system) in [("aarch64", "linux"), ("x86_64", "macos")] {
            let error = on_this_platform(architecture, system)
                .unwrap_err()
                .to_string();
            assert!(
                error.contains(&format!("{architecture} {system}")) && error.contains("container"),
                "{error}"
            );
        }
    }
}
