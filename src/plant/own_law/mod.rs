//! A law that a user writes: physics of one's own at a port of the rig, as an expression over the variables of the moment there, in SI.
//!
//! ```text
//! y = f(t, x, v, p1, p2, q, p_set, x_s, f; constants)          beside what acts at the port
//! ```
//!
//! On the piston it acts with the motion within a step; elsewhere it is held over a sample at its value in the middle.

mod expression;
mod names;
mod unit;

use std::sync::Arc;

pub use expression::{Expression, ExpressionError};
pub use names::kept_name;
pub use unit::Unit;

use super::moment::Moment;
use super::moment::Variable::{
    self, ChamberPressure, ContactForce, MassFlow, PressureDifference, SetPressure, Stroke,
    Surface, Time, Velocity,
};
use super::port::Port;

/// A variable: its symbol, what it is, its unit, where it lies [SI], its value.
pub struct Symbol {
    /// As an expression has it.
    pub name: &'static str,
    /// In words.
    pub meaning: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Least and largest value of devices that there are [SI].
    pub range: [f64; 2],
    /// Variables of a term that it is a part of.
    variables: &'static [Variable],
    value: fn(&Moment) -> f64,
}

/// The variables of an expression.
#[rustfmt::skip] // A table: one variable a line.
pub const SYMBOLS: [Symbol; 9] = [
    symbol("t", "time since the start", "s", [0.0, 60.0], &[Time], |m| m.time),
    symbol("x", "stroke from the retracted end", "m", [0.0, 0.05], &[Stroke], |m| m.stroke),
    symbol("v", "speed of extension", "m/s", [-0.5, 0.5], &[Velocity], |m| m.speed),
    symbol("p1", "pressure in chamber 1, absolute", "Pa", [1e5, 8e5], &[ChamberPressure, PressureDifference], |m| m.pressures[0]),
    symbol("p2", "pressure in chamber 2, absolute", "Pa", [1e5, 8e5], &[PressureDifference], |m| m.pressures[1]),
    symbol("q", "air that enters", "kg/s", [-1e-3, 1e-3], &[MassFlow], |m| m.mass_flow),
    symbol("p_set", "set pressure, gauge", "Pa", [0.0, 6e5], &[SetPressure], |m| m.set_pressure),
    symbol("x_s", "where the surface stands along the stroke", "m", [0.0, 0.05], &[Surface], |m| if m.surface.is_finite() { m.surface } else { 0.0 }),
    symbol("f", "contact force", "N", [0.0, 500.0], &[ContactForce], |m| m.contact_force),
];

const fn symbol(
    name: &'static str,
    meaning: &'static str,
    unit: &'static str,
    range: [f64; 2],
    variables: &'static [Variable],
    value: fn(&Moment) -> f64,
) -> Symbol {
    Symbol {
        name,
        meaning,
        unit,
        range,
        variables,
        value,
    }
}

/// Key of the stiffness of the bristles that a law of friction bends, where the seals have none of their own.
pub const BRISTLE_STIFFNESS: &str = "bristle_stiffness";
/// That stiffness where nothing says it [N/m].
pub const USUAL_BRISTLE_STIFFNESS: f64 = crate::physics::seal_friction::USUAL_STIFFNESS;

/// Constants at most of one law.
pub const MOST_CONSTANTS: usize = 8;

/// A constant of a law.
#[derive(Debug, Clone, PartialEq)]
pub struct Constant {
    /// Its name.
    pub name: &'static str,
    /// Its value [SI].
    pub value: f64,
    /// Its unit as the file says it, if it does.
    pub unit: Option<&'static str>,
    /// Between which values a diagnosis may fit it; none where it is taken to be exact.
    pub range: Option<[f64; 2]>,
}

/// Text of a law.
#[derive(Debug, Clone, PartialEq)]
pub struct LawText {
    /// Its name.
    pub name: &'static str,
    /// Where it acts.
    pub port: Port,
    /// The expression, over [`SYMBOLS`] and then the constants.
    pub expression: Expression,
    /// The constants, free ones first.
    pub constants: Vec<Constant>,
}

/// A law in a rig's description.
#[derive(Debug, Clone, PartialEq)]
pub struct OwnLaw {
    /// Its text.
    pub text: Arc<LawText>,
    /// Whether it acts. One that a diagnosis is to look for does not, to begin with.
    pub acts: bool,
    /// Values of its constants [SI].
    pub values: [f64; MOST_CONSTANTS],
}

impl LawText {
    /// Stiffness of the bristles that friction bends before the piston slides [N/m], of values of its constants, the first ones at least.
    pub fn bristle_stiffness(&self, constants: &[f64]) -> Option<f64> {
        let mut all = self.constants.iter();
        let place = all.position(|constant| self.is_bristle_stiffness(constant))?;
        Some(
            constants
                .get(place)
                .copied()
                .unwrap_or(self.constants[place].value),
        )
    }

    /// Whether a constant is that stiffness, which stands in no expression.
    pub fn is_bristle_stiffness(&self, constant: &Constant) -> bool {
        self.port == Port::Friction && constant.name == BRISTLE_STIFFNESS
    }

    /// Whether a variable is in its expression.
    pub fn uses(&self, variable: Variable) -> bool {
        let mut symbols = SYMBOLS.iter().enumerate();
        symbols.any(|(place, symbol)| {
            symbol.variables.contains(&variable) && self.expression.uses(place)
        })
    }

    /// Its value at a moment, in the unit of its port, of values of its constants, the first ones at least; nothing where it is not finite.
    pub fn value(&self, moment: &Moment, constants: &[f64]) -> f64 {
        let found = self.expression.value(&self.named_values(moment, constants));
        if found.is_finite() { found } else { 0.0 }
    }

    /// Values of all names of the expression: the variables, then the constants.
    fn named_values(
        &self,
        moment: &Moment,
        constants: &[f64],
    ) -> [f64; SYMBOLS.len() + MOST_CONSTANTS] {
        let mut values = [0.0; SYMBOLS.len() + MOST_CONSTANTS];
        let (variables, others) = values.split_at_mut(SYMBOLS.len());
        for (value, symbol) in variables.iter_mut().zip(&SYMBOLS) {
            *value = (symbol.value)(moment);
        }
        for (index, (value, constant)) in others.iter_mut().zip(&self.constants).enumerate() {
            *value = constants.get(index).copied().unwrap_or(constant.value);
        }
        values
    }

    /// Whether it has a value at a moment, of values of its constants, the first ones at least.
    pub fn is_finite_at(&self, moment: &Moment, constants: &[f64]) -> bool {
        let values = self.named_values(moment, constants);
        self.expression.check_finite(&values).is_ok()
    }

    /// Checks that it is finite at a moment, whatever its constants are within their ranges: as they are written, and each alone at its ends.
    ///
    /// # Errors
    /// The part that is not.
    pub fn check_at(&self, moment: &Moment) -> Result<(), ExpressionError> {
        let written: Vec<f64> = self.constants.iter().map(|c| c.value).collect();
        let finite = |constants: &[f64]| {
            let values = self.named_values(moment, constants);
            self.expression.check_finite(&values)
        };
        finite(&written)?;
        for (place, constant) in self.constants.iter().enumerate() {
            for end in constant.range.into_iter().flatten() {
                let mut constants = written.clone();
                constants[place] = end;
                finite(&constants)?;
            }
        }
        Ok(())
    }

    /// Checks units.
    ///
    /// # Errors
    /// The part whose unit is not that which stands beside it.
    pub fn check_units(&self) -> Result<(), ExpressionError> {
        let known = SYMBOLS.iter().map(|symbol| Unit::read(symbol.unit).ok());
        let units: Vec<Option<Unit>> = known
            .chain(
                self.constants
                    .iter()
                    .map(|c| c.unit.and_then(|unit| Unit::read(unit).ok())),
            )
            .collect();
        let expected = Unit::read(self.port.unit()).unwrap_or(Unit::ONE);
        self.expression.check_units(&units, expected)
    }

    /// Checks units, and that it is finite wherever its variables may be: at the ends and the middle of each, and between.
    ///
    /// # Errors
    /// The part that is not.
    pub fn check(&self) -> Result<(), ExpressionError> {
        self.check_units()?;
        let ranges: Vec<[f64; 2]> = (SYMBOLS.iter().map(|symbol| symbol.range))
            .chain(
                self.constants
                    .iter()
                    .map(|c| c.range.unwrap_or([c.value; 2])),
            )
            .collect();
        let at = |shares: &dyn Fn(usize) -> f64| -> Vec<f64> {
            let share = |(place, [low, high]): (usize, &[f64; 2])| {
                // Rest and zero lie within what is signed.
                low + shares(place) * (high - low)
            };
            ranges.iter().enumerate().map(share).collect()
        };
        // At rest, each variable alone at its ends, and all of them spread evenly over their ranges (van der Corput, of a base for each).
        let mut rest = at(&|_| 0.0);
        for (value, [low, high]) in rest.iter_mut().zip(&ranges) {
            *value = 0f64.clamp(*low, *high);
        }
        for (constant, value) in self.constants.iter().zip(&mut rest[SYMBOLS.len()..]) {
            *value = constant.value;
        }
        self.expression.check_finite(&rest)?;
        for (place, range) in ranges.iter().enumerate() {
            for end in range {
                let mut one = rest.clone();
                one[place] = *end;
                self.expression.check_finite(&one)?;
            }
        }
        for index in 1..=PROBES {
            let shares = |place: usize| radical_inverse(index, PRIMES[place % PRIMES.len()]);
            self.expression.check_finite(&at(&shares))?;
        }
        Ok(())
    }
}

/// Points at which a law is tried before it runs.
const PROBES: usize = 500;
/// Bases of the points.
const PRIMES: [usize; 17] = [
    2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53, 59,
];

/// Van der Corput's sequence of a base.
fn radical_inverse(mut index: usize, base: usize) -> f64 {
    let mut found = 0.0;
    let mut place = 1.0;
    while index > 0 {
        place /= base as f64;
        found += place * (index % base) as f64;
        index /= base;
    }
    found
}

impl OwnLaw {
    /// Stiffness of the bristles that its friction bends [N/m], where it says it.
    pub fn bristle_stiffness(&self) -> Option<f64> {
        self.text.bristle_stiffness(&self.values)
    }

    /// The law as it is written, at work.
    pub fn new(text: &Arc<LawText>) -> Self {
        let mut values = [0.0; MOST_CONSTANTS];
        for (value, constant) in values.iter_mut().zip(&text.constants) {
            *value = constant.value;
        }
        Self {
            text: Arc::clone(text),
            acts: true,
            values,
        }
    }

    /// Its value at a moment, in the unit of its port; nothing where it is not finite.
    pub fn at(&self, moment: &Moment) -> f64 {
        if !self.acts {
            return 0.0;
        }
        self.text.value(moment, &self.values)
    }

    /// Whether it needs to know where the surface stands.
    pub fn uses_surface(&self) -> bool {
        self.text.uses(Surface)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn law(port: Port, text: &str, constants: &[(&'static str, f64)]) -> LawText {
        let names: Vec<&str> = (SYMBOLS.iter().map(|s| s.name))
            .chain(constants.iter().map(|(name, _)| *name))
            .collect();
        let constant = |(name, value): &(&'static str, f64)| Constant {
            name,
            value: *value,
            unit: None,
            range: None,
        };
        LawText {
            name: "own",
            port,
            expression: Expression::read(text, &names).unwrap(),
            constants: constants.iter().map(constant).collect(),
        }
    }

    #[test]
    fn it_is_of_the_moment() {
        let own = OwnLaw::new(&Arc::new(law(
            Port::PistonForce,
            "-c * max(v, 0) + k*x",
            &[("c", 200.0), ("k", 10.0)],
        )));
        assert_eq!(own.text.check(), Ok(()));
        let moment = Moment {
            stroke: 0.02,
            speed: 0.1,
            ..Moment::default()
        };
        assert!((own.at(&moment) - (-20.0 + 0.2)).abs() < 1e-12);
        let idle = OwnLaw { acts: false, ..own };
        assert_eq!(idle.at(&moment), 0.0);
    }

    #[test]
    fn a_law_is_tried_wherever_its_variables_may_be() {
        for (text, part) in [
            ("f * 0.1 / sign(v)", "f * 0.1 / sign(v)"),
            ("f + f * ln(sign(x))", "ln(sign(x))"),
            ("sqrt(f - 400) * sqrt(f)", "sqrt(f - 400)"),
            ("f/(sign(p1) - 1)", "f/(sign(p1) - 1)"),
        ] {
            let error = law(Port::PistonForce, text, &[]).check().unwrap_err();
            assert_eq!(&text[error.span.clone()], part, "{error}");
        }
        let error = law(Port::StrokeReading, "1e-3 * v", &[])
            .check()
            .unwrap_err();
        assert_eq!(error.reason, "it is in m/s, expected m");
    }
}
