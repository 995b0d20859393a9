//! `[[law]]` of an arm file: torque at a joint that no name of the vocabulary covers.
//!
//! ```text
//! [[law]]
//! joint = 2
//! shape = "slope_above"              torque factor x max(0, x - place), over the joint's angle
//! over = "joint_angle"
//! times = "one"                      or "friction" (its sign that of the speed), "speed", "load_torque"
//! factors = [35.0]
//! place = 0.8
//! ```

use std::fmt::Write as _;

use super::keys::LawKeys;
use super::names::Names;
use crate::keys::check::{Section, plain};
use crate::keys::document::Document;
use crate::keys::error::ScenarioError;
use crate::keys::suggestion::nearest;
use crate::recorded_arm::law::{Factor, JointLaw, Shape, Variable};
use crate::scenario::effects::as_written;

/// Forms by their words.
const SHAPES: [(&str, Shape); 11] = [
    ("slope_above", Shape::SlopeAbove),
    ("slope_below", Shape::SlopeBelow),
    ("bump", Shape::Bump),
    ("sine", Shape::Sine),
    ("linear", Shape::Linear),
    ("square", Shape::Square),
    ("cube", Shape::Cube),
    ("saturation", Shape::Saturation),
    ("approach", Shape::Approach),
    ("step", Shape::Step),
    ("constant", Shape::Constant),
];

/// What they are multiplied with, by its words.
const FACTORS: [(&str, Factor); 4] = [
    ("one", Factor::One),
    ("friction", Factor::Friction),
    ("speed", Factor::Speed),
    ("load_torque", Factor::Load),
];

/// The laws of a file.
pub(super) fn laws(
    document: &Document<'_>,
    keys: &[LawKeys],
    names: Names<'_>,
) -> Result<Vec<JointLaw>, ScenarioError> {
    let laws = keys.iter().enumerate();
    laws.map(|(index, keys)| {
        law(
            &Section::new(document, format!("law[{index}]")),
            keys,
            names,
        )
    })
    .collect()
}

fn law(section: &Section<'_>, keys: &LawKeys, names: Names<'_>) -> Result<JointLaw, ScenarioError> {
    let joint = names.joint(f64::from(keys.joint)).ok_or_else(|| {
        let expected = format!("1 to {}, as columns count them", names.numbers.len());
        section.refuse("joint", keys.joint.to_string(), expected)
    })?;
    let variables = Variable::ALL.map(|variable| (variable.name(), variable));
    let shape = among(section, "shape", &keys.shape, &SHAPES)?;
    let second = if shape == Shape::Sine { 2 } else { 1 };
    let amplitude = match keys.factors[..] {
        [one] => [one, 0.0],
        [one, other] if second == 2 => [one, other],
        _ => {
            let expected = "one number; two of a sine, the second that of its cosine";
            let found = format!("a list of {}", keys.factors.len());
            return Err(section.refuse("factors", found, expected.to_owned()));
        }
    };
    if keys.width == 0.0 {
        let expected = "another than 0".to_owned();
        return Err(section.refuse("width", "0".to_owned(), expected));
    }
    Ok(JointLaw {
        joint,
        shape,
        variable: among(section, "over", &keys.over, &variables)?,
        factor: among(section, "times", &keys.times, &FACTORS)?,
        amplitude,
        place: keys.at,
        width: keys.width,
    })
}

fn among<T: Copy>(
    section: &Section<'_>,
    key: &str,
    word: &str,
    all: &[(&str, T)],
) -> Result<T, ScenarioError> {
    let found = all.iter().find(|(name, _)| *name == word);
    found.map(|(_, one)| *one).ok_or_else(|| {
        let names: Vec<&str> = all.iter().map(|(name, _)| *name).collect();
        let expected = format!("one of the words for it; {}", nearest(word, &names));
        section.refuse(key, format!("{word:?}"), expected)
    })
}

fn word<T: Copy + PartialEq>(one: T, all: &[(&'static str, T)]) -> &'static str {
    let found = all.iter().find(|(_, other)| *other == one);
    found.map_or("", |(name, _)| name)
}

/// A law as a table of a file.
pub(super) fn append(text: &mut String, law: &JointLaw, names: Names<'_>) {
    let number = |value: f64| plain(as_written(value));
    let [first, second] = law.amplitude.map(number);
    let factors = match law.shape {
        Shape::Sine => format!("{first}, {second}"),
        _ => first,
    };
    // Writing into a text cannot fail.
    let _ = write!(
        text,
        "\n# Found: a law at a joint that has no name.\n[[law]]\njoint = {}\nshape = {:?}\nover = {:?}\ntimes = {:?}\nfactors = [{factors}]\nplace = {}\nwidth = {}\n",
        names.numbers[law.joint],
        word(law.shape, &SHAPES),
        law.variable.name(),
        word(law.factor, &FACTORS),
        number(law.place),
        number(law.width),
    );
}
