//! The workpiece's part of a scenario file.

use super::check::Section;
use super::error::ScenarioError;
use super::file::{self, BurrKind};
use super::sensing::stages::only;
use super::{
    BurrScenario, ChamferScenario, EdgeChoice, EdgeSelection, Misplacement, WorkpieceScenario,
};

/// Thickness of a burr's root where the file says nothing [mm]; judged: 0.05 to 0.3 is usual.
const BURR_ROOT: f64 = 0.15;
/// Height up to which a burr counts as gone where the file says nothing [mm]: it is not felt by a finger any more.
const RESIDUAL_BURR: f64 = 0.02;

/// `[workpiece]` and the tables in it.
pub(super) fn workpiece(
    section: &Section<'_>,
    keys: &file::WorkpieceKeys,
) -> Result<WorkpieceScenario, ScenarioError> {
    let table = |name: &str| Section::new(section.document(), format!("workpiece.{name}"));
    Ok(WorkpieceScenario {
        mesh: section.file("mesh", &keys.mesh)?,
        mesh_scale: keys.mesh_unit.length(),
        world_from_part: section.pose(
            ("position_mm", Some(&keys.position_mm)),
            ("rotation_deg", keys.rotation_deg.as_deref()),
        )?,
        edge: edge(&table("edge"), &keys.edge)?,
        misplacement: misplacement(&table("misplacement"), &keys.misplacement)?,
        burr: match &keys.burr {
            None => BurrScenario::None,
            Some(keys) => burr(&table("burr"), keys)?,
        },
        burr_root: {
            let root = keys.burr.as_ref().and_then(|burr| burr.root_mm);
            table("burr").number("root_mm", root.unwrap_or(BURR_ROOT), 0.001..=5.0)?
        },
        chamfer: chamfer(&table("chamfer"), &keys.chamfer)?,
    })
}

#[rustfmt::skip] // A table: one key a line.
fn edge(section: &Section<'_>, keys: &file::EdgeKeys) -> Result<EdgeChoice, ScenarioError> {
    let selection = match (keys.edge, keys.closed_loop) {
        (Some(edge), None) => EdgeSelection::Edge(edge),
        (None, Some(number)) => EdgeSelection::Loop(number),
        (None, None) => {
            return Err(section.missing("edge", "edge or loop, a number from `idc edges`"));
        }
        (Some(_), Some(_)) => {
            let reason = "`workpiece.edge.edge` is given too, expected one of the two".to_owned();
            return Err(section.misplaced("loop", reason));
        }
    };
    let start_mm = keys.start_mm.unwrap_or(0.0);
    let start = section.number("start_mm", start_mm, 0.0..=100_000.0)?;
    let end_of = |value| section.number("end_mm", value, 0.0..=100_000.0);
    let end = keys.end_mm.map(end_of).transpose()?;
    if let Some(end_mm) = keys.end_mm
        && end_mm <= start_mm
    {
        let expected = format!("more than start_mm, {start_mm} mm");
        return Err(section.refuse_number("end_mm", end_mm, expected));
    }
    Ok(EdgeChoice {
        selection,
        start,
        end,
        reversed: keys.reversed.unwrap_or(false),
        sharp_angle: section.number("sharp_angle_deg", keys.sharp_angle_deg.unwrap_or(30.0), 1.0..=170.0)?,
    })
}

/// Leg and burr within which an edge is good; without bounds anything is.
fn chamfer(
    section: &Section<'_>,
    keys: &file::ChamferKeys,
) -> Result<ChamferScenario, ScenarioError> {
    let least = keys.leg_min_mm.unwrap_or(0.0);
    let most = keys.leg_max_mm.unwrap_or(f64::INFINITY);
    let burr = keys.residual_burr_max_mm.unwrap_or(RESIDUAL_BURR);
    let leg = [
        section.number("leg_min_mm", least, 0.0..=20.0)?,
        section.number("leg_max_mm", most, 0.0..=f64::INFINITY)?,
    ];
    if least >= most {
        let expected = format!("more than leg_min_mm, {least} mm");
        return Err(section.refuse_number("leg_max_mm", most, expected));
    }
    Ok(ChamferScenario {
        leg,
        residual_burr: section.number("residual_burr_max_mm", burr, 0.0..=5.0)?,
    })
}

fn misplacement(
    section: &Section<'_>,
    keys: &file::MisplacementKeys,
) -> Result<Misplacement, ScenarioError> {
    Ok(Misplacement {
        shift: section.number("shift_mm", keys.shift_mm.unwrap_or(0.0), -50.0..=50.0)?,
        tilt: section.number("tilt_deg", keys.tilt_deg.unwrap_or(0.0), -10.0..=10.0)?,
    })
}

/// Keys of each kind of burr: all are needed but those with a default, and no other may be given.
fn keys_of(kind: BurrKind) -> (&'static str, &'static [&'static str]) {
    match kind {
        BurrKind::None => ("none", &[]),
        BurrKind::Constant => ("constant", &["height_mm", "root_mm"]),
        BurrKind::Random => (
            "random",
            &[
                "mean_height_mm",
                "standard_deviation_mm",
                "correlation_length_mm",
                "root_mm",
                "seed",
            ],
        ),
        BurrKind::Bump => ("bump", &["position_mm", "height_mm", "width_mm", "root_mm"]),
        BurrKind::Table => ("table", &["path", "root_mm"]),
    }
}

#[rustfmt::skip] // A table: one key a line.
fn burr(section: &Section<'_>, keys: &file::BurrKeys) -> Result<BurrScenario, ScenarioError> {
    let (kind, allowed) = keys_of(keys.kind);
    only(section, kind, false, allowed)?;
    let needed = |key: &str, value: Option<f64>, range| match value {
        Some(value) => section.number(key, value, range),
        None => Err(section.missing(key, &format!("it to be given with kind = \"{kind}\""))),
    };
    Ok(match keys.kind {
        BurrKind::None => BurrScenario::None,
        BurrKind::Constant => BurrScenario::Constant {
            height: needed("height_mm", keys.height_mm, 0.0..=10.0)?,
        },
        BurrKind::Random => {
            let mean_height = needed("mean_height_mm", keys.mean_height_mm, 0.001..=10.0)?;
            let deviation = keys.standard_deviation_mm;
            BurrScenario::Random {
                seed: keys.seed.unwrap_or(1),
                mean_height,
                height_deviation: deviation
                    .map(|value| section.number("standard_deviation_mm", value, 0.0..=10.0))
                    .unwrap_or(Ok(mean_height / 3.0))?,
                correlation_length: needed("correlation_length_mm", keys.correlation_length_mm, 0.1..=1000.0)?,
            }
        }
        BurrKind::Bump => BurrScenario::Bump {
            position: needed("position_mm", keys.position_mm, 0.0..=100_000.0)?,
            height: needed("height_mm", keys.height_mm, 0.0..=10.0)?,
            width: needed("width_mm", keys.width_mm, 0.1..=1000.0)?,
        },
        BurrKind::Table => match &keys.path {
            Some(path) => BurrScenario::Table {
                path: section.file("path", path)?,
            },
            None => return Err(section.missing("path", "a CSV file with kind = \"table\"")),
        },
    })
}
