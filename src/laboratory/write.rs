//! A case on disk: the rig file, the recordings, and its truth in another folder.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use super::CHANNELS;
use super::case::{LaboratoryCase, Session};
use super::draw::NominalRig;
use super::programme::Programme;
use crate::recording::RecordingError;
use crate::recording::atomic::write_text;
use crate::recording::csv::write_csv;

/// Grid to which the surface is written [1/m].
const SURFACE_GRID: f64 = 1e7;

/// Writes a case into `folder` and its truth, if there is a place for it, into `sealed`/NAME.json and `sealed`/NAME.predict.csv.
///
/// # Errors
/// A file cannot be written.
pub fn write_case(
    case: &LaboratoryCase,
    folder: &Path,
    sealed: Option<&Path>,
) -> Result<(), RecordingError> {
    let make = |folder: &Path| {
        fs::create_dir_all(folder).map_err(|cause| RecordingError::write(folder, cause))
    };
    make(folder)?;
    let (unseen, seen) = case.programmes.split_last().expect("a case has recordings");
    let names: Vec<&str> = seen
        .iter()
        .map(|programme| programme.name.as_str())
        .collect();
    write_text(
        &folder.join("rig.toml"),
        &rig_text(&case.nominal, &names, &unseen.name),
    )?;
    for (programme, values) in seen.iter().zip(&case.measured) {
        write_measured(
            programme,
            values,
            &folder.join(format!("{}.csv", programme.name)),
        )?;
    }
    let path = folder.join(format!("{}.csv", unseen.name));
    write_csv(&path, &unseen.times, &named(&inputs(unseen)))?;
    let Some(sealed) = sealed else {
        return Ok(());
    };
    make(sealed)?;
    let name = &case.sealed.case;
    let text = serde_json::to_string_pretty(&case.sealed).expect("numbers and names alone");
    write_text(&sealed.join(format!("{name}.json")), &(text + "\n"))?;
    let measured = case.measured.last().expect("one for each programme");
    let columns: Vec<(&str, &[f64])> = CHANNELS
        .iter()
        .zip(measured)
        .map(|(name, v)| (*name, v.as_slice()))
        .collect();
    write_csv(
        &sealed.join(format!("{name}.predict.csv")),
        &unseen.times,
        &columns,
    )
}

/// Writes the recordings of a session into a folder, and the rig file of its type where a file is named.
///
/// # Errors
/// A file cannot be written.
pub fn write_session(
    session: &Session,
    folder: &Path,
    rig: Option<&Path>,
) -> Result<(), RecordingError> {
    fs::create_dir_all(folder).map_err(|cause| RecordingError::write(folder, cause))?;
    for (programme, values) in session.programmes.iter().zip(&session.measured) {
        write_measured(
            programme,
            values,
            &folder.join(format!("{}.csv", programme.name)),
        )?;
    }
    let names: Vec<&str> = session.programmes.iter().map(|p| p.name.as_str()).collect();
    match rig {
        Some(file) => write_text(file, &rig_text(&session.nominal, &names, "predict")),
        None => Ok(()),
    }
}

/// Writes what a device was asked for and what was measured of it.
pub(super) fn write_measured(
    programme: &Programme,
    values: &[Vec<f64>; 4],
    path: &Path,
) -> Result<(), RecordingError> {
    let inputs = inputs(programme);
    let mut columns = named(&inputs);
    columns.extend((CHANNELS.iter().zip(values)).map(|(name, v)| (*name, v.as_slice())));
    write_csv(path, &programme.times, &columns)
}

fn inputs(programme: &Programme) -> [Vec<f64>; 3] {
    let times = programme.times.iter();
    let surface = |t: f64| {
        let place = programme.surface.as_ref().map_or(f64::NAN, |s| s.at(t)[0]);
        (place * SURFACE_GRID).round() / SURFACE_GRID
    };
    [
        times.clone().map(|t| programme.set_pressure(*t)).collect(),
        times
            .clone()
            .map(|t| f64::from(u8::from(programme.extends(*t))))
            .collect(),
        times.map(|t| surface(*t)).collect(),
    ]
}

fn named(inputs: &[Vec<f64>; 3]) -> Vec<(&'static str, &[f64])> {
    let names = ["set_pressure_pa", "solenoid", "surface_m"];
    names
        .into_iter()
        .zip(inputs.iter().map(Vec::as_slice))
        .collect()
}

/// A table of a file: its name, its keys with their values.
type Keys<'a> = (&'a str, Vec<(&'a str, String)>);

fn plain(value: f64) -> String {
    format!("{value:?}")
}

fn rig_text(nominal: &NominalRig, fit: &[&str], predict: &str) -> String {
    let rig = &nominal.rig;
    let noise = CHANNELS.into_iter().zip(rig.noise.map(plain));
    let quoted: Vec<String> = fit.iter().map(|name| format!("\"{name}.csv\"")).collect();
    let mut text = String::from(
        "# The device by its nominal values. SI units; tolerances are relative.\nschema = 2\n",
    );
    let rest = [
        (
            "sensors",
            std::iter::once(("rate_hz", plain(rig.rate)))
                .chain(noise)
                .collect(),
        ),
        (
            "recordings",
            vec![
                ("fit", format!("[{}]", quoted.join(", "))),
                ("predict", format!("\"{predict}.csv\"")),
            ],
        ),
    ];
    for (name, rows) in device_keys(nominal).into_iter().chain(rest) {
        // Writing into a text cannot fail.
        let _ = writeln!(text, "\n[{name}]");
        for (key, value) in rows {
            let _ = writeln!(text, "{key} = {value}");
        }
    }
    text
}

/// Nominal values of device and contact.
fn device_keys(nominal: &NominalRig) -> [Keys<'static>; 6] {
    let rig = &nominal.rig;
    let [volume, mass, gain, lag, supply, exhaust, stiffness, damping] = nominal.tolerances;
    let within =
        |value: f64, tolerance: f64| format!("{{ value = {value:?}, tolerance = {tolerance:?} }}");
    [
        (
            "cylinder",
            vec![
                ("count", rig.count.to_string()),
                ("bore_m", plain(rig.bore)),
                ("rod_m", plain(rig.rod)),
                ("stroke_m", plain(rig.stroke)),
                ("dead_volume_m3", within(rig.dead_volume, volume)),
                ("moving_mass_kg", within(rig.mass, mass)),
                ("gravity_along_axis_m_per_s2", plain(rig.gravity)),
            ],
        ),
        (
            "end_stop",
            vec![
                ("stiffness_n_per_m", plain(rig.stop[0])),
                ("damping_n_s_per_m", plain(rig.stop[1])),
            ],
        ),
        (
            "regulator",
            vec![
                ("gain", within(rig.gain, gain)),
                ("time_constant_s", within(rig.time_constant, lag)),
            ],
        ),
        (
            "valve",
            vec![
                ("supply_orifice_m2", within(rig.supply_orifice, supply)),
                ("exhaust_orifice_m2", within(rig.exhaust_orifice, exhaust)),
                ("discharge_coefficient", plain(rig.discharge)),
            ],
        ),
        (
            "gas",
            vec![
                ("specific_gas_constant_j_per_kg_k", plain(rig.gas.constant)),
                ("heat_capacity_ratio", plain(rig.gas.ratio)),
                ("temperature_k", plain(rig.gas.temperature)),
                ("atmosphere_pa", plain(rig.gas.atmosphere)),
            ],
        ),
        (
            "contact",
            vec![
                (
                    "stiffness_n_per_m",
                    within(rig.contact_stiffness, stiffness),
                ),
                ("damping_n_s_per_m", within(rig.contact_damping, damping)),
            ],
        ),
    ]
}
