//! `[flange]` of an improved rig file: a contact flange as a diagnosis has fitted it to runs.
//!
//! ```text
//! reading_period_s = 2e-3                      how the log reads the force: time between readings, and gain of its two lags over a sample (1 without)
//! reading_gain = 1.43
//! arm_ripple = 0.02                            of the arm while it slides, with its bandwidth; both or none
//! arm_ripple_bandwidth_hz = 15
//! half_widths = [0.3, 0.2, 0.5, 0.5]           half of a 90 % interval of the logarithms of peak, ringing, settling and spread
//! approach_m_per_s = [0.1, 0.25]               least and largest of the runs that it was fitted to
//! force_before_n = [10, 100]
//! desired_force_n = [35, 100]
//!
//! [[flange.fit]]                               fits that count, the best first
//! moving_mass_kg = 3.4                         and all other numbers of the flange
//! ```

use std::collections::BTreeMap;
use std::fmt::Write as _;

use serde::Deserialize;

use crate::flange::{CoveredRuns, FLANGE_NUMBERS, FittedFlange, FlangeModel, Reader, Ripple};
use crate::keys::check::Section;
use crate::keys::document::Document;
use crate::keys::error::ScenarioError;
use crate::plant::DeviceParts;

/// Name of the table.
pub(super) const TABLE: &str = "flange";

/// `[flange]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct FlangeKeys {
    reading_period_s: f64,
    reading_gain: f64,
    arm_ripple: Option<f64>,
    arm_ripple_bandwidth_hz: Option<f64>,
    half_widths: [f64; 4],
    approach_m_per_s: [f64; 2],
    force_before_n: [f64; 2],
    desired_force_n: [f64; 2],
    #[serde(default)]
    fit: Vec<BTreeMap<String, f64>>,
}

/// The table of a file.
pub(super) fn flange(
    document: &Document<'_>,
    keys: Option<&FlangeKeys>,
    parts: DeviceParts,
) -> Result<Option<FittedFlange>, ScenarioError> {
    let Some(keys) = keys else { return Ok(None) };
    let section = Section::new(document, TABLE);
    if parts != DeviceParts::ContactFlange {
        let expected = format!(
            "{:?} of [rig] chain beside it",
            DeviceParts::ContactFlange.name()
        );
        return Err(section.refuse("fit", parts.name().to_owned(), expected));
    }
    if keys.fit.is_empty() {
        return Err(section.missing("fit", "one table [[flange.fit]] at least"));
    }
    let models = (keys.fit.iter().enumerate()).map(|(index, fit)| model(document, index, fit));
    let ripple = match (keys.arm_ripple, keys.arm_ripple_bandwidth_hz) {
        (Some(ratio), Some(bandwidth)) => Some(Ripple {
            ratio: section.number("arm_ripple", ratio, 0.0..=10.0)?,
            bandwidth: section.number("arm_ripple_bandwidth_hz", bandwidth, 1e-3..=1e5)?,
        }),
        (None, None) => None,
        (Some(_), None) => {
            return Err(section.missing("arm_ripple_bandwidth_hz", "one beside arm_ripple"));
        }
        (None, Some(_)) => {
            return Err(section.missing("arm_ripple", "one beside arm_ripple_bandwidth_hz"));
        }
    };
    for half in keys.half_widths {
        section.number("half_widths", half, 0.0..=100.0)?;
    }
    for (key, ends) in [
        ("approach_m_per_s", keys.approach_m_per_s),
        ("force_before_n", keys.force_before_n),
        ("desired_force_n", keys.desired_force_n),
    ] {
        section.number(key, ends[0], -1e6..=1e6)?;
        section.number(key, ends[1], ends[0]..=1e6)?;
    }
    Ok(Some(FittedFlange {
        models: models.collect::<Result<_, _>>()?,
        reader: Reader {
            period: section.number("reading_period_s", keys.reading_period_s, 1e-6..=1.0)?,
            gain: section.number("reading_gain", keys.reading_gain, 1e-3..=1.999)?,
        },
        ripple,
        half_widths: keys.half_widths,
        covered: CoveredRuns {
            approach: keys.approach_m_per_s,
            before: keys.force_before_n,
            desired: keys.desired_force_n,
        },
    }))
}

fn model(
    document: &Document<'_>,
    index: usize,
    fit: &BTreeMap<String, f64>,
) -> Result<FlangeModel, ScenarioError> {
    let section = Section::new(document, format!("{TABLE}.fit[{index}]"));
    if let Some(other) = fit
        .keys()
        .find(|key| !FlangeModel::NAMES.contains(&key.as_str()))
    {
        let expected = format!("no other keys than {}", FlangeModel::NAMES.join(", "));
        return Err(section.refuse(other, "a key of that name".to_owned(), expected));
    }
    let mut numbers = [0.0; FLANGE_NUMBERS];
    for (number, name) in numbers.iter_mut().zip(FlangeModel::NAMES) {
        let Some(value) = fit.get(name) else {
            return Err(section.missing(name, "a number above 0"));
        };
        *number = section.number(name, *value, 1e-15..=1e15)?;
    }
    Ok(FlangeModel::of(&numbers))
}

/// It as a table of a file.
pub(super) fn text(flange: &FittedFlange) -> String {
    let mut text = format!(
        "\n# The flange as it was fitted to the runs: `idc predict` simulates other runs with it.\n[{TABLE}]\n"
    );
    let covered = &flange.covered;
    // Writing into a text cannot fail.
    let mut line = |key: &str, value: String| {
        let _ = writeln!(text, "{key} = {value}");
    };
    let list = |values: &[f64]| {
        let values: Vec<String> = values.iter().map(|value| format!("{value:e}")).collect();
        format!("[{}]", values.join(", "))
    };
    line("reading_period_s", format!("{:e}", flange.reader.period));
    line("reading_gain", format!("{:e}", flange.reader.gain));
    if let Some(ripple) = flange.ripple {
        line("arm_ripple", format!("{:e}", ripple.ratio));
        line("arm_ripple_bandwidth_hz", format!("{:e}", ripple.bandwidth));
    }
    line("half_widths", list(&flange.half_widths));
    line("approach_m_per_s", list(&covered.approach));
    line("force_before_n", list(&covered.before));
    line("desired_force_n", list(&covered.desired));
    for model in &flange.models {
        let _ = writeln!(text, "\n[[{TABLE}.fit]]");
        for (name, value) in FlangeModel::NAMES.iter().zip(model.numbers()) {
            let _ = writeln!(text, "{name} = {value:e}");
        }
    }
    text
}
