//! From `[robustness]` to what is drawn.

use super::{Distribution, Scatter, Scattering};
use crate::design::file::{RobustnessKeys, ScatterKeys};
use crate::design::variable::Variable;
use crate::keys::check::Section;
use crate::keys::document::Document;
use crate::keys::suggestion::advice;
use crate::scenario::ScenarioError;
use crate::scenario::sections::{bench_sections, model_sections, scenario_sections};

/// Checks the table.
pub(in crate::design) fn scattering(
    document: &Document<'_>,
    keys: &RobustnessKeys,
    variables: &[Variable],
) -> Result<Scattering, ScenarioError> {
    let section = Section::new(document, "robustness");
    if keys.variables.is_empty() {
        let expected =
            "at least one table such as [robustness.variables.\"workpiece.misplacement.shift_mm\"]";
        return Err(section.missing("variables", expected));
    }
    let scatter = |(key, keys): (&String, &ScatterKeys)| {
        check_key(document, key, variables)?;
        let section = Section::new(document, format!("robustness.variables.{key}"));
        Ok(Scatter {
            key: key.clone(),
            distribution: distribution(&section, keys)?,
            whole: keys.whole,
            location: document.location(&format!("robustness.variables.{key}")),
        })
    };
    Ok(Scattering {
        runs: keys.runs,
        seed: keys.seed,
        scatters: keys
            .variables
            .iter()
            .map(scatter)
            .collect::<Result<_, _>>()?,
    })
}

/// A key of a device, or of a table of a scenario; none that the study chooses.
fn check_key(
    document: &Document<'_>,
    key: &str,
    variables: &[Variable],
) -> Result<(), ScenarioError> {
    let dotted = format!("robustness.variables.{key}");
    if variables.iter().any(|variable| variable.key == key) {
        return Err(ScenarioError::Misplaced {
            location: document.location(&dotted),
            key: dotted,
            reason:
                "it is a variable of the study; what is drawn is what the study does not choose"
                    .to_owned(),
        });
    }
    let model = model_sections();
    let (table, name) = key.rsplit_once('.').unwrap_or(("device", key));
    let sections = match table {
        "device" => model.clone(),
        _ => [scenario_sections(), bench_sections()].concat(),
    };
    let known = |(section, keys): &(String, Vec<&str>)| section == table && keys.contains(&name);
    if sections.iter().any(known) {
        return Ok(());
    }
    let nearest = match table {
        "device" => advice(&format!("device.{key}"), &model),
        _ => advice(key, &sections),
    };
    Err(ScenarioError::UnknownKey {
        location: document.location(&dotted),
        key: dotted,
        advice: format!(
            "what is drawn is a key of [device.override] or, in quotes, \"table.key\" of a scenario; {nearest}"
        ),
    })
}

fn distribution(section: &Section<'_>, keys: &ScatterKeys) -> Result<Distribution, ScenarioError> {
    let given = [
        ("min", keys.min),
        ("max", keys.max),
        ("mean", keys.mean),
        ("standard_deviation", keys.standard_deviation),
    ];
    for (key, value) in given {
        if let Some(value) = value.filter(|value| !value.is_finite()) {
            return Err(section.refuse(key, value.to_string(), "a finite number".to_owned()));
        }
    }
    if let (Some(min), Some(max)) = (keys.min, keys.max)
        && min >= max
    {
        return Err(section.refuse("min", min.to_string(), format!("less than max, {max}")));
    }
    let needed = |key: &str, value: Option<f64>, beside: &str| {
        value.ok_or_else(|| section.missing(key, &format!("it to be given with {beside}")))
    };
    match (keys.mean, keys.standard_deviation) {
        (None, None) => Ok(Distribution::Uniform([
            needed("min", keys.min, "max, or mean and standard_deviation")?,
            needed("max", keys.max, "min")?,
        ])),
        (mean, deviation) => {
            let mean = needed("mean", mean, "standard_deviation")?;
            let standard_deviation = needed("standard_deviation", deviation, "mean")?;
            if standard_deviation <= 0.0 {
                let found = standard_deviation.to_string();
                return Err(section.refuse("standard_deviation", found, "more than 0".to_owned()));
            }
            let bounds = [
                keys.min.unwrap_or(f64::NEG_INFINITY),
                keys.max.unwrap_or(f64::INFINITY),
            ];
            if !(bounds[0]..=bounds[1]).contains(&mean) {
                let expected = "a number between min and max".to_owned();
                return Err(section.refuse("mean", mean.to_string(), expected));
            }
            Ok(Distribution::Normal {
                mean,
                standard_deviation,
                bounds,
            })
        }
    }
}
