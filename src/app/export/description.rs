//! modelDescription.xml of a co-simulation unit, of FMI 2.0 or 3.0, of the variables that its library makes.

use std::collections::BTreeSet;
use std::io;

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};

use super::version::Version;
use crate::fmu::{Causality, Kind, Model, Variable};
use crate::plant::Unit;

type Xml = Writer<Vec<u8>>;
/// Names and values of an element's attributes.
type Attributes = Vec<(&'static str, String)>;

/// Name of the library in the unit, the same for all units.
pub(super) const IDENTIFIER: &str = "idc_device";

/// The text of the file.
pub(super) fn description(model: &Model, version: Version) -> io::Result<Vec<u8>> {
    let mut xml = Writer::new_with_indent(Vec::new(), b' ', 2);
    xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    let token = match version {
        Version::Two => ("guid", model.token.clone()),
        Version::Three => ("instantiationToken", model.token.clone()),
    };
    let attributes = vec![
        ("fmiVersion", version.number().to_owned()),
        ("modelName", model.scenario.title.clone()),
        token,
        ("description", about(model)),
        ("version", env!("CARGO_PKG_VERSION").to_owned()),
        (
            "generationTool",
            format!("idc {}", env!("CARGO_PKG_VERSION")),
        ),
        ("variableNamingConvention", "structured".to_owned()),
    ];
    element(&mut xml, "fmiModelDescription", attributes, |xml| {
        empty(xml, "CoSimulation", abilities(version))?;
        units(xml, model)?;
        let experiment = vec![
            ("startTime", "0".to_owned()),
            ("stopTime", model.scenario.duration.to_string()),
            ("stepSize", model.scenario.step.to_string()),
        ];
        empty(xml, "DefaultExperiment", experiment)?;
        element(xml, "ModelVariables", Vec::new(), |xml| {
            let mut all = model.variables.iter().enumerate();
            all.try_for_each(|(reference, own)| variable(xml, version, reference, own))
        })?;
        element(xml, "ModelStructure", Vec::new(), |xml| {
            structure(xml, version, model)
        })
    })?;
    let mut text = xml.into_inner();
    text.push(b'\n');
    Ok(text)
}

/// What the unit is, in words.
fn about(model: &Model) -> String {
    format!(
        "Pneumatic slide with regulator, 5/2 valve and sensors, without controller and estimator. Set pressure and valve are held over a communication step, which is cut into steps of {} s.",
        model.scenario.step
    )
}

fn abilities(version: Version) -> Attributes {
    let state = match version {
        Version::Two => "canGetAndSetFMUstate",
        Version::Three => "canGetAndSetFMUState",
    };
    vec![
        ("modelIdentifier", IDENTIFIER.to_owned()),
        (state, "true".to_owned()),
        ("canHandleVariableCommunicationStepSize", "true".to_owned()),
    ]
}

/// Units of the variables, each as powers of those of SI where they are whole.
fn units(xml: &mut Xml, model: &Model) -> io::Result<()> {
    let names: BTreeSet<&str> = model.variables.iter().filter_map(|v| v.unit).collect();
    element(xml, "UnitDefinitions", Vec::new(), |xml| {
        for name in names {
            let attributes = vec![("name", name.to_owned())];
            match base(name) {
                None => empty(xml, "Unit", attributes)?,
                Some(base) => element(xml, "Unit", attributes, |xml| empty(xml, "BaseUnit", base))?,
            }
        }
        Ok(())
    })
}

/// Powers of the units of SI, but for those that are 0.
fn base(symbol: &str) -> Option<Attributes> {
    // Powers stand behind their symbols: m/s2.
    let mut text = String::new();
    for letter in symbol.chars() {
        if letter.is_ascii_digit() && text.ends_with(char::is_alphabetic) {
            text.push('^');
        }
        text.push(letter);
    }
    let powers = Unit::read(&text).ok()?.powers();
    if powers.iter().any(|power| power.fract() != 0.0) {
        return None;
    }
    let radians = f64::from(u8::from(symbol.starts_with("rad")));
    let all = ["m", "kg", "s", "K", "rad"].into_iter();
    let all = all.zip(powers.into_iter().chain([radians]));
    Some(
        all.filter(|(_, power)| *power != 0.0)
            .map(|(name, power)| (name, power.to_string()))
            .collect(),
    )
}

fn variable(xml: &mut Xml, version: Version, reference: usize, own: &Variable) -> io::Result<()> {
    let boolean = own.kind == Kind::Boolean;
    let (causality, variability) = match (own.causality, own.kind) {
        (Causality::Independent, _) => ("independent", "continuous"),
        (Causality::Input, Kind::Real { smooth: true }) => ("input", "continuous"),
        (Causality::Input, _) => ("input", "discrete"),
        (Causality::Output, _) => ("output", "continuous"),
        (Causality::Tunable, _) => ("parameter", "tunable"),
        (Causality::Fixed, _) => ("parameter", "fixed"),
    };
    let common = vec![
        ("name", own.name.clone()),
        ("valueReference", reference.to_string()),
        ("description", own.meaning.clone()),
        ("causality", causality.to_owned()),
        ("variability", variability.to_owned()),
    ];
    let mut typed = Attributes::new();
    if let Some(unit) = own.unit {
        typed.push(("unit", unit.to_owned()));
    }
    let [low, high] = own.range;
    let holds = own.start.is_none_or(|start| low <= start && start <= high);
    for (name, bound) in [("min", low), ("max", high)] {
        // A device that lies out of the usual range is still itself.
        if bound.is_finite() && holds {
            typed.push((name, number(bound)));
        }
    }
    if let Some(start) = own.start {
        let text = match boolean {
            true => (start != 0.0).to_string(),
            false => number(start),
        };
        typed.push(("start", text));
    }
    match version {
        Version::Three => {
            let kind = if boolean { "Boolean" } else { "Float64" };
            empty(xml, kind, common.into_iter().chain(typed).collect())
        }
        Version::Two => element(xml, "ScalarVariable", common, |xml| {
            empty(xml, if boolean { "Boolean" } else { "Real" }, typed)
        }),
    }
}

/// Outputs, and that the first values of them are computed.
fn structure(xml: &mut Xml, version: Version, model: &Model) -> io::Result<()> {
    let all = model.variables.iter().enumerate();
    let outputs = all.filter(|(_, own)| own.causality == Causality::Output);
    let outputs: Vec<usize> = outputs.map(|(reference, _)| reference).collect();
    for (group, single) in [("Outputs", "Output"), ("InitialUnknowns", "InitialUnknown")] {
        let list = |xml: &mut Xml, name: &'static str, key: &'static str, first: usize| {
            let one = |reference: &usize| {
                let at = (reference + first).to_string();
                empty(xml, name, vec![(key, at)])
            };
            outputs.iter().try_for_each(one)
        };
        match version {
            Version::Three => list(xml, single, "valueReference", 0)?,
            // By the place among the variables, from 1.
            Version::Two => element(xml, group, Vec::new(), |xml| {
                list(xml, "Unknown", "index", 1)
            })?,
        }
    }
    Ok(())
}

/// A number as XML Schema has it.
fn number(value: f64) -> String {
    match value {
        f64::INFINITY => "INF".to_owned(),
        f64::NEG_INFINITY => "-INF".to_owned(),
        value => value.to_string(),
    }
}

fn empty(xml: &mut Xml, name: &'static str, attributes: Attributes) -> io::Result<()> {
    let pairs = attributes.iter().map(|(key, value)| (*key, value.as_str()));
    xml.create_element(name)
        .with_attributes(pairs)
        .write_empty()
        .map(drop)
}

fn element(
    xml: &mut Xml,
    name: &'static str,
    attributes: Attributes,
    inner: impl FnOnce(&mut Xml) -> io::Result<()>,
) -> io::Result<()> {
    let pairs = attributes.iter().map(|(key, value)| (*key, value.as_str()));
    xml.create_element(name)
        .with_attributes(pairs)
        .write_inner_content(inner)
        .map(drop)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Powers as handbooks have them.
    #[test]
    fn units_are_powers_of_those_of_si() {
        for (symbol, expected) in [
            ("N", "m1 kg1 s-2"),
            ("Pa", "m-1 kg1 s-2"),
            ("m/s2", "m1 s-2"),
            ("m2", "m2"),
            ("N s/m", "kg1 s-1"),
            ("J/(kg K)", "m2 s-2 K-1"),
            ("W/K", "m2 kg1 s-3 K-1"),
            ("rad/s", "s-1 rad1"),
            ("Pa s/kg", "m-1 s-1"),
        ] {
            let base = base(symbol).unwrap_or_else(|| panic!("{symbol}"));
            let shown: Vec<String> = base
                .iter()
                .map(|(key, power)| format!("{key}{power}"))
                .collect();
            assert_eq!(shown.join(" "), expected, "{symbol}");
        }
        assert_eq!(base("N/m^1.5"), None);
    }
}
