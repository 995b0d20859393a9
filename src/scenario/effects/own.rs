//! A law of a user's own: `acts_on` a port, `is` an expression over the variables there and over constants that stand beside it.

use super::keys::{JOINT, KeyTable, NAME};
use super::value::EffectValue;
use crate::effects::Effect;
use crate::keys::check::{Section, plain};
use crate::keys::error::ScenarioError;
use crate::plant::{
    Constant, Expression, ExpressionError, LawText, MOST_CONSTANTS, Port, SYMBOLS, Unit, kept_name,
};

/// Key of the port.
pub(super) const ACTS_ON: &str = "acts_on";
/// Key of the expression.
pub(super) const IS: &str = "is";

/// Reads a law.
pub(super) fn law(
    section: &Section<'_>,
    table: &KeyTable,
    known: &[&'static Effect],
) -> Result<LawText, ScenarioError> {
    let name = text(
        section,
        table,
        NAME,
        "a name for the law, as in one_way_damping",
    )?;
    if known.iter().any(|effect| effect.vocabulary().0 == name) {
        let expected = "a name that no effect of the catalogue has".to_owned();
        return Err(section.refuse(NAME, format!("{name:?}"), expected));
    }
    if !is_name(name) {
        let expected = "a name of letters, digits and _, as in one_way_damping".to_owned();
        return Err(section.refuse(NAME, format!("{name:?}"), expected));
    }
    if table.contains_key(JOINT) {
        let reason = "a law of your own acts at a port, not in a joint".to_owned();
        return Err(section.misplaced(JOINT, reason));
    }
    let port = port(section, table)?;
    let expression = text(
        section,
        table,
        IS,
        "an expression, as in \"-c * max(v, 0)\"",
    )?;
    let constants = constants(section, table)?;
    let names: Vec<&str> = (SYMBOLS.iter().map(|symbol| symbol.name))
        .chain(constants.iter().map(|constant| constant.name))
        .collect();
    let at = |error: ExpressionError| {
        let part = expression.get(error.span.clone()).unwrap_or_default();
        let part = if part.is_empty() { "its end" } else { part };
        ScenarioError::Expression {
            location: section
                .document()
                .location_in_text(&section.dotted(IS), &error.span),
            key: section.dotted(IS),
            reason: format!("at `{part}`: {}", error.reason),
        }
    };
    let law = LawText {
        name: kept_name(name),
        port,
        expression: Expression::read(expression, &names).map_err(at)?,
        constants,
    };
    for (index, constant) in law.constants.iter().enumerate() {
        if !law.is_bristle_stiffness(constant) && !law.expression.uses(SYMBOLS.len() + index) {
            let reason = format!("the expression has no `{}`", constant.name);
            return Err(section.misplaced(constant.name, reason));
        }
    }
    law.check().map_err(at)?;
    Ok(law)
}

/// Values of the constants that a diagnosis may fit.
pub(super) fn free_values(law: &LawText) -> Vec<f64> {
    let free = law.constants.iter().filter(|c| c.range.is_some());
    free.map(|constant| constant.value).collect()
}

/// A text of a table.
pub(super) fn text<'t>(
    section: &Section<'_>,
    table: &'t KeyTable,
    key: &str,
    expected: &str,
) -> Result<&'t str, ScenarioError> {
    match table.get(key) {
        Some(EffectValue::Text(text)) => Ok(text),
        Some(other) => Err(section.refuse(key, other.to_string(), expected.to_owned())),
        None => Err(section.missing(key, expected)),
    }
}

fn port(section: &Section<'_>, table: &KeyTable) -> Result<Port, ScenarioError> {
    let names = Port::ALL.map(Port::name).join(", ");
    let expected = format!("one of {names}");
    let name = text(section, table, ACTS_ON, &expected)?;
    let found = Port::ALL.into_iter().find(|port| port.name() == name);
    found.ok_or_else(|| section.refuse(ACTS_ON, format!("{name:?}"), expected))
}

pub(super) fn is_name(text: &str) -> bool {
    let mut letters = text.chars();
    let first = letters
        .next()
        .is_some_and(|c| c.is_alphabetic() || c == '_');
    first && letters.all(|c| c.is_alphanumeric() || c == '_')
}

fn constants(section: &Section<'_>, table: &KeyTable) -> Result<Vec<Constant>, ScenarioError> {
    let own = table
        .iter()
        .filter(|(key, _)| ![NAME, ACTS_ON, IS].contains(&key.as_str()));
    let mut constants = Vec::new();
    for (key, value) in own {
        let known = value.number().ok_or_else(|| {
            let expected = "a number, or { value, min, max, unit }".to_owned();
            section.refuse(key, value.to_string(), expected)
        })?;
        if let Some(symbol) = SYMBOLS.iter().find(|symbol| symbol.name == key) {
            let reason = format!("`{key}` is {} in an expression", symbol.meaning);
            return Err(section.misplaced(key, reason));
        }
        if !is_name(key) {
            let reason = "a constant's name is made of letters, digits and _".to_owned();
            return Err(section.misplaced(key, reason));
        }
        let inner = Section::new(section.document(), section.dotted(key));
        known.check(&inner)?;
        let numbers = [Some(known.value), known.min, known.max];
        if let Some(bad) = numbers.into_iter().flatten().find(|n| !n.is_finite()) {
            return Err(section.refuse(key, bad.to_string(), "a finite number".to_owned()));
        }
        let range = known.min.zip(known.max).map(|(min, max)| [min, max]);
        if range.is_some_and(|[min, max]| min >= max) {
            let expected = "more than min".to_owned();
            return Err(inner.refuse("max", plain(known.value), expected));
        }
        if let Some(text) = &known.unit
            && let Err(symbol) = Unit::read(text)
        {
            let expected =
                format!("a unit of SI without prefixes, as in \"N s/m\"; it has {symbol:?}");
            return Err(inner.refuse("unit", format!("{text:?}"), expected));
        }
        constants.push(Constant {
            name: kept_name(key),
            value: known.value,
            unit: known.unit.as_deref().map(kept_name),
            range,
        });
    }
    if constants.len() > MOST_CONSTANTS {
        let reason = format!("a law has at most {MOST_CONSTANTS} constants");
        return Err(section.misplaced(constants[MOST_CONSTANTS].name, reason));
    }
    Ok(constants)
}
