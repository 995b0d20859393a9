//! A formula as a term of the model, with what is free in it.

use std::sync::Arc;

use super::grammar::{Form, Role, per, symbol};
use super::latent::scale;
use crate::diagnosis::fit::free::{Free, Prior};
use crate::diagnosis::fit::hypothesis::Hypothesis;
use crate::effects::{Coordinate, UNLISTED};
use crate::plant::registry::LATENT_COEFFICIENT;
use crate::plant::{
    BRISTLE_STIFFNESS, Basis, Constant, Expression, Formula, Latent, LawText, Moment, Port,
    SYMBOLS, USUAL_BRISTLE_STIFFNESS, Variable, kept_name,
};

/// Size of a constant that a formula is in proportion to, over its start, at most [1].
const MOST: f64 = 30.0;
/// Speed at which what acts against the motion is all there [m/s].
const CREEP: f64 = 2e-3;
/// Names of fixed constants.
const REFERENCE: &str = "reference";
const CREEP_NAME: &str = "creep";

/// A formula with a start of its constants.
#[derive(Debug, Clone)]
pub(super) struct Candidate {
    /// The term.
    pub latent: Latent,
    /// Its free constants.
    pub free: Vec<Free>,
    /// Variables that it depends on, as in an answer.
    pub depends_on: Vec<&'static str>,
}

impl Candidate {
    /// A form in the place of a curve; constants that are not given are 1. Of friction where there is none beside it, the stiffness of its bristles is free too.
    pub fn new(
        form: &Form,
        (curve, with_bristles): (&Latent, bool),
        typical: Moment,
        constants: &[f64],
    ) -> Self {
        let variable = symbol(curve.variable);
        let visited = match curve.basis {
            Basis::Hats { ends } => ends,
            _ => [0.0, 1.0],
        };
        let mut text = form.text.replace('X', variable.text);
        if curve.directed {
            text = format!("{} * tanh(v / {CREEP_NAME})", bracketed(&text));
        }
        let at = |index: usize| constants.get(index).copied().unwrap_or(1.0);
        let free = form
            .constants
            .iter()
            .enumerate()
            .map(|(index, (name, role))| {
                free_constant(index, kept_name(name), *role, at(index), curve, visited)
            });
        let bristles = with_bristles.then(|| Free {
            quantity: LATENT_COEFFICIENT
                .named(BRISTLE_STIFFNESS)
                .of(form.constants.len()),
            start: USUAL_BRISTLE_STIFFNESS,
            coordinate: Coordinate::Logarithmic,
            bounds: [1e3, 1e8],
            prior: Prior::Flat,
        });
        let free = free.chain(bristles);
        let own = form
            .constants
            .iter()
            .enumerate()
            .map(|(index, (name, role))| Constant {
                name: kept_name(name),
                value: at(index),
                unit: Some(kept_name(&unit_of(*role, curve.port.unit(), variable.unit))),
                range: None,
            });
        let fixed = |name: &'static str, value: f64, unit: &'static str| Constant {
            name,
            value,
            unit: Some(unit),
            range: None,
        };
        let largest = visited[0].abs().max(visited[1].abs());
        let uses = |name: &str| text.contains(name);
        let reference = uses(REFERENCE).then(|| fixed(REFERENCE, largest, variable.unit));
        let creep = uses(CREEP_NAME).then(|| fixed(CREEP_NAME, CREEP, "m/s"));
        let bristles =
            with_bristles.then(|| fixed(BRISTLE_STIFFNESS, USUAL_BRISTLE_STIFFNESS, "N/m"));
        let stiffness = bristles.as_ref().map(|constant| constant.value);
        let constants = own.chain(bristles).chain(reference).chain(creep);
        let constants: Vec<Constant> = constants.collect();
        let values = (0..form.constants.len()).map(at).chain(stiffness).collect();
        let directed = curve.turns_with_motion().then_some("velocity_sign");
        Self {
            free: free.collect(),
            depends_on: std::iter::once(curve.variable.name())
                .chain(directed)
                .collect(),
            latent: latent(
                (curve.variable, curve.directed),
                law_text(curve.port, &text, constants),
                values,
                (visited, typical),
            ),
        }
    }

    /// The formula of a hypothesis, from where it stands.
    pub fn of(hypothesis: &Hypothesis) -> Option<Self> {
        let latent = hypothesis.unlisted()?.clone();
        let own = hypothesis.fit.free.len() - latent.numbers();
        let free = hypothesis.fit.free_from_here().split_off(own);
        Some(Self {
            latent,
            free,
            depends_on: hypothesis.depends_on.clone(),
        })
    }

    /// The law.
    pub fn law(&self) -> &LawText {
        let formula = self.latent.formula();
        &formula
            .expect("a candidate's term is made with a formula")
            .law
    }

    /// Free constants.
    pub fn count(&self) -> usize {
        self.free.len()
    }

    /// The same times a factor, with its further constants: one that is free, with its start, and fixed ones.
    fn times(
        &self,
        factor: &str,
        free: Option<(&'static str, f64)>,
        fixed: Option<(&'static str, f64, &'static str)>,
        depends_on: &'static str,
    ) -> Option<Self> {
        let formula = self.latent.formula()?;
        let law = &formula.law;
        let count = self.latent.coefficients.len();
        let text = format!("{} * {factor}", bracketed(law.expression.text()));
        let (own, others) = law.constants.split_at(count);
        let new = free.map(|(name, value)| Constant {
            name,
            value,
            unit: Some("1"),
            range: None,
        });
        let known = |name: &str| law.constants.iter().any(|c| c.name == name);
        let fixed = fixed.filter(|(name, ..)| !known(name));
        let constants = own
            .iter()
            .cloned()
            .chain(new)
            .chain(others.iter().cloned())
            .chain(fixed.map(|(name, value, unit)| Constant {
                name,
                value,
                unit: Some(unit),
                range: None,
            }));
        let mut values = self.latent.coefficients.clone();
        let mut all = self.free.clone();
        if let Some((name, value)) = free {
            values.push(value);
            all.push(Free {
                quantity: LATENT_COEFFICIENT.named(name).of(count),
                start: value,
                coordinate: Coordinate::Linear(0.5),
                bounds: [-MOST, MOST],
                prior: Prior::Flat,
            });
        }
        let mut variables = self.depends_on.clone();
        if !variables.contains(&depends_on) {
            variables.push(depends_on);
        }
        Some(Self {
            latent: latent(
                (self.latent.variable, self.latent.directed),
                law_text(self.latent.port, &text, constants.collect()),
                values,
                (formula.visited, formula.typical),
            ),
            free: all,
            depends_on: variables,
        })
    }
}

/// A law of the search's own, of a text that the grammar gives.
fn law_text(port: Port, text: &str, constants: Vec<Constant>) -> LawText {
    let names: Vec<&str> = (SYMBOLS.iter().map(|symbol| symbol.name))
        .chain(constants.iter().map(|constant| constant.name))
        .collect();
    let expression =
        Expression::read(text, &names).expect("the grammar's forms are expressions of these names");
    LawText {
        name: UNLISTED,
        port,
        expression,
        constants,
    }
}

fn latent(
    (variable, directed): (Variable, bool),
    law: LawText,
    coefficients: Vec<f64>,
    (visited, typical): ([f64; 2], Moment),
) -> Latent {
    Latent {
        port: law.port,
        variable,
        directed,
        basis: Basis::Formula(Arc::new(Formula {
            law,
            visited,
            typical,
        })),
        coefficients,
    }
}

/// A text in brackets where it is a sum.
fn bracketed(text: &str) -> String {
    let mut depth = 0;
    let is_sum = text.chars().enumerate().any(|(place, letter)| {
        match letter {
            '(' => depth += 1,
            ')' => depth -= 1,
            _ => {}
        }
        place > 0 && depth == 0 && matches!(letter, '+' | '-')
    });
    if is_sum {
        format!("({text})")
    } else {
        text.to_owned()
    }
}

/// Unit of a constant in a formula at a port over a variable.
fn unit_of(role: Role, port: &str, variable: &str) -> String {
    match role {
        Role::Height => port.to_owned(),
        Role::Gain if port == variable => "1".to_owned(),
        Role::Gain => per(port, variable, 1),
        Role::Curvature if port == variable => per("1", variable, 1),
        Role::Curvature => per(port, variable, 2),
        Role::Place | Role::Width | Role::Limit | Role::Period => variable.to_owned(),
        Role::Phase => "rad".to_owned(),
        Role::Exponent => "1".to_owned(),
        Role::Frequency => "Hz".to_owned(),
    }
}

fn free_constant(
    index: usize,
    name: &'static str,
    role: Role,
    start: f64,
    curve: &Latent,
    [low, high]: [f64; 2],
) -> Free {
    let range = high - low;
    let largest = low.abs().max(high.abs());
    let (coordinate, bounds) = match role {
        Role::Height | Role::Gain | Role::Curvature => {
            let by = match role {
                Role::Height => 1.0,
                Role::Gain => largest,
                _ => largest * largest,
            };
            let size = start.abs().max(1e-3 * scale(curve.port) / by);
            // An opening of less than nothing is none.
            let least = if curve.port.is_positive() && role == Role::Height {
                0.0
            } else {
                -MOST * size
            };
            (Coordinate::Linear(0.5 * size), [least, MOST * size])
        }
        Role::Place => {
            // Inputs are held over a sample: a place in time is determined by several.
            let share = match curve.variable {
                Variable::Time => 0.4,
                _ => 0.1,
            };
            let bounds = [low - 0.5 * range, high + 0.5 * range];
            (Coordinate::Linear(share * range), bounds)
        }
        Role::Width | Role::Limit => (Coordinate::Logarithmic, [1e-3 * range, 20.0 * range]),
        Role::Period => (Coordinate::Logarithmic, [range / 30.0, 10.0 * range]),
        Role::Phase => (Coordinate::Linear(1.0), [-20.0, 20.0]),
        Role::Exponent => (Coordinate::Linear(0.5), [0.05, 6.0]),
        // One turn of phase over the longest recording is a step of about a tenth of a hertz.
        Role::Frequency => (Coordinate::Linear(0.02), [0.5 * start, 2.0 * start]),
    };
    Free {
        quantity: LATENT_COEFFICIENT.named(name).of(index),
        start,
        coordinate,
        bounds,
        prior: Prior::Flat,
    }
}

/// Variables that a formula may be multiplied with: all but where the surface stands, which a part takes over, and the flow.
/// Each with the name of the fixed constant that it is taken relative to.
const OTHERS: [(Variable, &str); 6] = [
    (Variable::Time, "time_reference"),
    (Variable::Stroke, "stroke_reference"),
    (Variable::ChamberPressure, "pressure_reference"),
    (Variable::PressureDifference, "difference_reference"),
    (Variable::SetPressure, "set_reference"),
    (Variable::ContactForce, "force_reference"),
];

/// Products of a formula with another variable: in proportion, in part, and where there is a pressure, a contact, a direction of motion.
pub(super) fn modulated(
    candidate: &Candidate,
    largest: impl Fn(Variable) -> f64,
) -> Vec<Candidate> {
    let mut all = Vec::new();
    if candidate.free.len() + 2 > crate::plant::MOST_CONSTANTS - 2 {
        return all;
    }
    let own = candidate.latent.variable;
    for (variable, name) in OTHERS {
        let size = largest(variable);
        if variable == own || size <= 0.0 {
            continue;
        }
        let in_text = symbol(variable);
        let fixed = Some((name, size, in_text.unit));
        let whole = format!("{} / {name}", in_text.text);
        let part = format!("(1 + slope * {} / {name})", in_text.text);
        all.extend(candidate.times(&whole, None, fixed, variable.name()));
        let slope = Some((kept_name("slope"), 0.0));
        all.extend(candidate.times(&part, slope, fixed, variable.name()));
    }
    for (gate, name, variable) in [
        ("(p_set > 0)", "set_pressure", Variable::SetPressure),
        ("(f > 0)", "contact_force", Variable::ContactForce),
        ("(v > 0)", "velocity_sign", Variable::Velocity),
        ("(v < 0)", "velocity_sign", Variable::Velocity),
    ] {
        if variable != own {
            all.extend(candidate.times(gate, None, None, name));
        }
    }
    if own != Variable::Velocity && !candidate.latent.turns_with_motion() {
        let creep = Some((CREEP_NAME, CREEP, "m/s"));
        let turned = format!("tanh(v / {CREEP_NAME})");
        all.extend(candidate.times(&turned, None, creep, "velocity_sign"));
        let viscous = Some(("speed_reference", 0.1, "m/s"));
        all.extend(candidate.times("v / speed_reference", None, viscous, "velocity"));
    }
    all
}
