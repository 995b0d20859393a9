//! The file of still postures explained, with the tables that it names.

use std::path::Path;

use super::super::error::AppError;
use super::report::{Report, shown};
use crate::case::{POSTURES, PosturesCase};
use crate::diagnosis::postures::least_turn;
use crate::quantity::counted;
use crate::scenario::postures_file::{PoseOf, ReadingAxes, ReadingOf};
use crate::shell::word;

/// The file, as itself or as the folder with it.
pub(super) fn postures(path: &Path, shown_as: &Path) -> Result<Report, AppError> {
    let case = PosturesCase::from_file(path)?;
    let file = &case.file;
    let kind = "still postures of a wrench sensor";
    let title = Some(file.title.as_str()).filter(|title| !title.is_empty());
    let mut report = Report::new(shown_as, kind, title);
    let recordings = &case.input.recordings;
    let all: Vec<_> = recordings.iter().flat_map(|r| r.postures.clone()).collect();
    let torques = match case.has_torques() {
        true => "forces and torques",
        false => "forces alone: without torques the tool's centre stays unknown",
    };
    report.fact(
        "postures",
        format!(
            "{} to diagnose from, with {torques}",
            counted(all.len(), "posture")
        ),
    );
    report.number("postures", all.len());
    let turn = least_turn(&all).asin().to_degrees();
    report.fact(
        "turn",
        format!(
            "{} degrees RMS beside the axis turned about most",
            shown(turn)
        ),
    );
    report.number("turn_deg", turn);
    let values = &file.values;
    let axes = match values.axes {
        ReadingAxes::Sensor => "in the sensor's axes",
        ReadingAxes::Base => "in the base's axes",
    };
    let pose = match values.pose {
        PoseOf::SensorInBase => "the sensor's link in the base",
        PoseOf::BaseInSensor => "the base in the sensor's link",
    };
    let reads = match values.reads {
        ReadingOf::ToolOnSensor => "what the tool does to the sensor",
        ReadingOf::SensorOnTool => "what the sensor does to the tool",
    };
    report.fact(
        "nominal",
        format!("readings {axes}, {reads}; pose of {pose}"),
    );
    let declared = [
        ("mass of the tool", values.tool_mass.is_some()),
        ("its centre", values.tool_centre.is_some()),
        ("zero of the forces", values.zero_force.is_some()),
        ("zero of the torques", values.zero_torque.is_some()),
    ];
    let of = |is: bool| {
        let names = declared.iter().filter(|(_, declared)| *declared == is);
        names.map(|(name, _)| *name).collect::<Vec<_>>().join(", ")
    };
    for (label, names) in [("declared", of(true)), ("identified", of(false))] {
        if !names.is_empty() {
            report.fact(label, names);
        }
    }
    let folder = path.parent().unwrap_or(Path::new(""));
    for recording in recordings {
        report.file("postures to diagnose from", &folder.join(&recording.name));
    }
    if let Some(name) = &file.predict {
        report.file("postures to predict", &folder.join(name));
    }
    let folder = match folder.as_os_str().is_empty() {
        true => Path::new("."),
        false => folder,
    };
    report.next(match path.ends_with(POSTURES) {
        true => format!("idc diagnose {}", word(folder)),
        false => format!("idc diagnose FOLDER, in which it stands as {POSTURES}"),
    });
    Ok(report)
}
