//! Which column is which quantity: by its name, its unit, or as the only one that can be.

use std::borrow::Cow;

use super::names::{self, Role, Said, Thing};
use super::seen::{Because, Cells, SaidUnit, Seen};
use crate::import::map::Column;
use crate::recording::{Unit, schema};

/// Share of the samples that do not move from the one before in what is commanded.
const HELD: f64 = 0.8;
/// Worth of a word, a letter and a unit.
const WORD: i32 = 6;
const WEAK: i32 = 2;

/// A column taken for a quantity.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Pick {
    pub quantity: Cow<'static, str>,
    pub place: usize,
    pub because: Because,
    /// Unit in SI that it must have.
    pub kind: Unit,
    /// Unit that more than the column itself says.
    pub unit: Option<SaidUnit>,
    worth: i32,
}

impl Pick {
    /// A column that is a quantity whatever the others are.
    pub fn new(quantity: String, place: usize, because: Because, kind: Unit) -> Self {
        Self {
            quantity: quantity.into(),
            place,
            because,
            kind,
            unit: None,
            worth: 0,
        }
    }
}

/// Quantities in the order of a map, with what asks for one that a log lacks.
#[rustfmt::skip] // A table: a quantity a line.
pub(super) const QUANTITIES: [(&str, Unit); 8] = [
    (schema::SET_PRESSURE_GAUGE, Unit::Pascal),
    (schema::VALVE_EXTENDS, Unit::One),
    (schema::SURFACE_POSITION, Unit::Metre),
    (schema::MEASURED_REGULATOR_PRESSURE_GAUGE, Unit::Pascal),
    (schema::MEASURED_STROKE, Unit::Metre),
    (schema::MEASURED_FORCE, Unit::Newton),
    (schema::MEASURED_ACCELERATION, Unit::MetrePerSecondSquared),
    (schema::DESIRED_FORCE, Unit::Newton),
];

/// Takes columns, but for those at some places, for quantities; in the order of a map.
pub(super) fn assign(columns: &[Seen], taken: &[usize]) -> Vec<Pick> {
    let mut all: Vec<Pick> = Vec::new();
    for (place, column) in columns.iter().enumerate() {
        if taken.contains(&place) || column.numbers().iter().all(|value| value.is_nan()) {
            continue;
        }
        all.extend(pick(place, column));
    }
    split_pressures(columns, &mut all);
    let best = |quantity: &str| {
        let own = all.iter().filter(|pick| pick.quantity == quantity);
        // Of those that are worth as much the first that moves: of a vector not an axis that has nothing.
        own.max_by_key(|pick| {
            let moves = moves(columns[pick.place].numbers());
            (pick.worth, moves, usize::MAX - pick.place)
        })
    };
    let mut chosen: Vec<Pick> = Vec::new();
    for (quantity, _) in QUANTITIES {
        let Some(mut pick) = best(quantity).cloned() else {
            continue;
        };
        let rivals = all
            .iter()
            .filter(|other| other.quantity == quantity && other.place != pick.place);
        let close: Vec<String> = rivals
            .filter(|other| other.worth == pick.worth)
            .map(|other| described(&columns[other.place]))
            .collect();
        if !close.is_empty() {
            pick.because.is_certain = false;
            pick.because.why += &format!("; it may also be {}", close.join(" or "));
        }
        chosen.push(pick);
    }
    chosen
}

/// Quantity that a column may be taken for.
fn pick(place: usize, column: &Seen) -> Option<Pick> {
    let said = names::said(&column.name);
    let unit = column.unit.as_ref().map(|said| said.unit.si);
    let may_be_states = matches!(column.cells, Cells::States(_)) || is_of_states(column.numbers());
    // A flag that never changes is one by its name alone.
    let is_states = may_be_states && is_two_states(column.numbers());
    let fits = |thing: Thing| {
        thing != Thing::Time
            && unit.is_none_or(|unit| names::units_of(thing).contains(&unit))
            && (if thing == Thing::Valve {
                may_be_states
            } else {
                !is_states
            })
    };
    let by_name = said.thing.filter(|(thing, _)| fits(*thing));
    let set = said.roles.iter().find(|(role, _)| *role == Role::Set);
    let quoted = |word: &str| match set {
        Some((_, set)) => format!("`{word}` and `{set}`"),
        None => format!("`{word}`"),
    };
    // A force in g is no acceleration: nothing is taken for what its name says it is not.
    let is_another = said.thing.is_some_and(|(thing, _)| match thing {
        Thing::Other => true,
        Thing::Time => false,
        thing => unit.is_some() && !is_states && (!said.by_letter || thing == Thing::Force),
    });
    let (thing, mut worth, because) = match (by_name, unit) {
        (Some((thing, word)), _) if !said.by_letter => (
            thing,
            WORD,
            Because::certain(format!("the name says {}", quoted(word))),
        ),
        (Some((thing, letter)), Some(_)) => (
            thing,
            WORD - 1,
            Because::certain(format!(
                "the unit fits, and the name says {}",
                quoted(letter)
            )),
        ),
        (Some((thing, letter)), None) => (
            thing,
            WEAK,
            Because::likely(format!("the name says {}", quoted(letter))),
        ),
        (None, _) if is_another => return None,
        (None, _) if is_states => (Thing::Valve, WEAK, Because::likely("it is of two states")),
        (None, Some(unit)) => {
            let things = [
                Thing::Pressure,
                Thing::Force,
                Thing::Stroke,
                Thing::Acceleration,
            ];
            let thing = things
                .into_iter()
                .find(|t| names::units_of(*t).contains(&unit))?;
            (thing, WEAK, Because::likely("its unit is that of one"))
        }
        (None, None) => return None,
    };
    let quantity = quantity(thing, &said)?;
    worth += i32::from(said.has(Role::Actual)) + i32::from(unit.is_some());
    if said.across && matches!(thing, Thing::Force | Thing::Acceleration) {
        worth -= WORD;
    }
    // A force of a joint is what its drive gives, where there is no load cell.
    if thing == Thing::Force && column.joint.is_some() {
        worth -= WEAK;
    }
    Some(Pick {
        quantity: quantity.into(),
        place,
        because,
        kind: *names::units_of(thing).first()?,
        unit: None,
        worth,
    })
}

fn quantity(thing: Thing, said: &Said) -> Option<&'static str> {
    let is_set = said.has(Role::Set);
    match thing {
        Thing::Pressure if said.has(Role::Elsewhere) => None,
        Thing::Pressure if is_set => Some(schema::SET_PRESSURE_GAUGE),
        Thing::Pressure => Some(schema::MEASURED_REGULATOR_PRESSURE_GAUGE),
        Thing::Valve => Some(schema::VALVE_EXTENDS),
        Thing::Surface => Some(schema::SURFACE_POSITION),
        Thing::Stroke if is_set => None,
        Thing::Stroke => Some(schema::MEASURED_STROKE),
        Thing::Force if is_set => Some(schema::DESIRED_FORCE),
        Thing::Force => Some(schema::MEASURED_FORCE),
        Thing::Acceleration => Some(schema::MEASURED_ACCELERATION),
        Thing::Time | Thing::Other => None,
    }
}

/// Of two pressures without a word on which is commanded, it is the one that is held.
fn split_pressures(columns: &[Seen], all: &mut [Pick]) {
    if all
        .iter()
        .any(|pick| pick.quantity == schema::SET_PRESSURE_GAUGE)
    {
        return;
    }
    let measured = schema::MEASURED_REGULATOR_PRESSURE_GAUGE;
    let held = |pick: &Pick| is_held(columns[pick.place].numbers());
    let pressures: Vec<usize> = (0..all.len())
        .filter(|index| all[*index].quantity == measured)
        .collect();
    let of_held: Vec<usize> = pressures
        .iter()
        .copied()
        .filter(|i| held(&all[*i]))
        .collect();
    if let [only] = of_held[..]
        && pressures.len() > 1
    {
        all[only].quantity = schema::SET_PRESSURE_GAUGE.into();
        all[only].because = Because::likely(
            "of the pressures it is the one that is held and stepped, as a command is",
        );
    }
}

fn moves(values: &[f64]) -> bool {
    let mut there = values.iter().filter(|value| value.is_finite());
    there
        .next()
        .is_some_and(|first| there.any(|value| value != first))
}

fn is_held(values: &[f64]) -> bool {
    let still = values.windows(2).filter(|pair| pair[0] == pair[1]).count();
    still as f64 > HELD * values.len() as f64
}

/// Whether the numbers are 0 and 1, and both of them.
fn is_two_states(values: &[f64]) -> bool {
    let has = |wanted: f64| values.contains(&wanted);
    has(0.0) && has(1.0) && is_of_states(values)
}

/// Whether the numbers are 0 or 1 throughout.
fn is_of_states(values: &[f64]) -> bool {
    let fits = |value: &f64| value.is_nan() || *value == 0.0 || *value == 1.0;
    values.iter().all(fits)
}

/// A column for people.
pub(super) fn described(column: &Seen) -> String {
    match (&column.column, column.name.as_str()) {
        (Column::Number(number), "") => format!("column {number}"),
        (Column::Number(number), name) => format!("column {number}, `{name}`"),
        (_, name) => format!("`{name}`"),
    }
}
