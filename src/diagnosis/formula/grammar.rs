//! Forms of a law over one variable, as engineers write them down.
//!
//! In a text X stands for the variable. `height` and `gain` enter in proportion; the others are sought on a grid before a fit starts.

use crate::plant::{Port, SYMBOLS, Variable};

/// What a constant of a form is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    /// In the port's unit, in proportion.
    Height,
    /// In the port's unit by the variable's, in proportion.
    Gain,
    /// In the port's unit by the variable's squared, in proportion.
    Curvature,
    /// A value of the variable.
    Place,
    /// A width of the variable, more than nothing.
    Width,
    /// A size of the variable up to which something holds, more than nothing.
    Limit,
    /// A period of the variable.
    Period,
    /// An angle [rad].
    Phase,
    /// A power [1].
    Exponent,
    /// A frequency of what is periodic over time, as the hats' place is taken by waves [Hz].
    Frequency,
}

impl Role {
    /// Whether the form is in proportion to it.
    pub fn is_linear(self) -> bool {
        matches!(self, Self::Height | Self::Gain | Self::Curvature)
    }
}

/// Where a form makes sense.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Sense {
    /// Of any variable.
    Any,
    /// Of a variable that has either sign.
    Signed,
    /// Of a variable in the port's own unit.
    SameUnit,
    /// Of a variable that is never much below nothing.
    Positive,
    /// Over time, from the start.
    Time,
}

/// A form.
#[derive(Debug)]
pub(super) struct Form {
    /// Its text.
    pub text: &'static str,
    /// Its constants.
    pub constants: &'static [(&'static str, Role)],
    /// Where it makes sense.
    pub sense: Sense,
}

const HEIGHT: (&str, Role) = ("height", Role::Height);
const GAIN: (&str, Role) = ("gain", Role::Gain);
const CURVATURE: (&str, Role) = ("curvature", Role::Curvature);
const THRESHOLD: (&str, Role) = ("threshold", Role::Place);
const WIDTH: (&str, Role) = ("width", Role::Width);
const LIMIT: (&str, Role) = ("limit", Role::Limit);
const PERIOD: (&str, Role) = ("period", Role::Period);
const PHASE: (&str, Role) = ("phase", Role::Phase);
const FROM: (&str, Role) = ("from", Role::Place);
const TO: (&str, Role) = ("to", Role::Place);

/// A periodic form over time, found by its frequency.
pub(super) const WAVE: Form = Form {
    text: "height * sin(2 * pi * frequency * t + phase)",
    constants: &[HEIGHT, ("frequency", Role::Frequency), PHASE],
    sense: Sense::Time,
};

#[rustfmt::skip] // A table: one form a line.
pub(super) const FORMS: &[Form] = &[
    form("gain * X", &[GAIN], Sense::Any),
    form("height + gain * X", &[HEIGHT, GAIN], Sense::Any),
    form("curvature * X^2", &[CURVATURE], Sense::Any),
    form("curvature * X * abs(X)", &[CURVATURE], Sense::Signed),
    form("gain * X + curvature * X^2", &[GAIN, CURVATURE], Sense::Any),
    form("height * sign(X) * abs(X / reference)^exponent", &[HEIGHT, ("exponent", Role::Exponent)], Sense::Any),
    form("gain * max(X, 0)", &[GAIN], Sense::Signed),
    form("gain * min(X, 0)", &[GAIN], Sense::Signed),
    form("curvature * max(X, 0)^2", &[CURVATURE], Sense::Signed),
    form("curvature * min(X, 0)^2", &[CURVATURE], Sense::Signed),
    form("gain * max(X - threshold, 0)", &[GAIN, THRESHOLD], Sense::Any),
    form("gain * max(threshold - X, 0)", &[GAIN, THRESHOLD], Sense::Any),
    form("gain * (X - min(max(X, -limit), limit))", &[GAIN, LIMIT], Sense::Signed),
    form("height * (X > threshold)", &[HEIGHT, THRESHOLD], Sense::Any),
    form("height * (X < threshold)", &[HEIGHT, THRESHOLD], Sense::Any),
    form("height * min(max((X - threshold) / width, 0), 1)", &[HEIGHT, THRESHOLD, WIDTH], Sense::Any),
    form("height * min(max((threshold - X) / width, 0), 1)", &[HEIGHT, THRESHOLD, WIDTH], Sense::Any),
    form("height * (X > from) * (X < to)", &[HEIGHT, FROM, TO], Sense::Any),
    form("height * (tanh((X - from) / edge) - tanh((X - to) / edge)) / 2", &[HEIGHT, FROM, TO, ("edge", Role::Width)], Sense::Any),
    form("height * exp(-((X - centre) / width)^2)", &[HEIGHT, ("centre", Role::Place), WIDTH], Sense::Any),
    form("height * sin(2 * pi * X / period)", &[HEIGHT, PERIOD], Sense::Any),
    form("height * sin(2 * pi * X / period + phase)", &[HEIGHT, PERIOD, PHASE], Sense::Any),
    form("height * tanh(X / width)", &[HEIGHT, WIDTH], Sense::Any),
    form("height * tanh((X - centre) / width)", &[HEIGHT, ("centre", Role::Place), WIDTH], Sense::Any),
    form("gain * min(max(X, -limit), limit)", &[GAIN, LIMIT], Sense::Any),
    form("-min(max(X, -limit), limit)", &[LIMIT], Sense::SameUnit),
    form("height * (1 - exp(-X / width))", &[HEIGHT, WIDTH], Sense::Time),
    form("height * exp(-X / width)", &[HEIGHT, WIDTH], Sense::Positive),
];

const fn form(
    text: &'static str,
    constants: &'static [(&'static str, Role)],
    sense: Sense,
) -> Form {
    Form {
        text,
        constants,
        sense,
    }
}

impl Form {
    /// Whether it makes sense at a port over a variable that lies between these values.
    pub fn makes_sense(&self, port: Port, variable: Variable, [low, high]: [f64; 2]) -> bool {
        match self.sense {
            Sense::Any => true,
            Sense::Signed => low < -0.1 * high && high > -0.1 * low,
            Sense::Positive => low > -0.01 * high,
            Sense::SameUnit => symbol(variable).unit == port.unit(),
            Sense::Time => variable == Variable::Time,
        }
    }
}

/// A variable in an expression: its text and its unit.
#[derive(Debug, Clone, Copy)]
pub(super) struct InExpression {
    pub text: &'static str,
    pub unit: &'static str,
}

/// A variable as an expression has it.
pub(super) fn symbol(variable: Variable) -> InExpression {
    let (text, of) = match variable {
        Variable::Time => ("t", "t"),
        Variable::Stroke => ("x", "x"),
        Variable::Velocity => ("v", "v"),
        Variable::ChamberPressure => ("p1", "p1"),
        Variable::PressureDifference => ("(p1 - p2)", "p1"),
        Variable::MassFlow => ("q", "q"),
        Variable::SetPressure => ("p_set", "p_set"),
        Variable::Surface => ("x_s", "x_s"),
        Variable::ContactForce => ("f", "f"),
    };
    let known = SYMBOLS.iter().find(|symbol| symbol.name == of);
    let unit = known.map_or("1", |symbol| symbol.unit);
    InExpression { text, unit }
}

/// One unit over a power of another, 1 or 2, as a text that is read again.
pub(super) fn per(unit: &str, by: &str, power: usize) -> String {
    let raised = |unit: &str| match power {
        1 => unit.to_owned(),
        _ => format!("{unit}^{power}"),
    };
    let (front, back) = unit.split_once('/').unwrap_or((unit, ""));
    // Behind a stroke everything divides: what divides in `by` multiplies in front.
    let (above, below) = by.split_once('/').unwrap_or((by, ""));
    let joined = |a: &str, b: &str| format!("{a} {b}").trim().to_owned();
    let below = if below.is_empty() {
        String::new()
    } else {
        raised(below)
    };
    format!("{}/{}", joined(front, &below), joined(back, &raised(above)))
}

#[cfg(test)]
mod tests {
    use super::super::candidate::{Candidate, modulated};
    use super::*;
    use crate::plant::{Basis, Latent, Moment, Unit};

    /// A formula is written into a file and read again there: its units must go together, times any other variable too.
    #[test]
    fn every_form_is_in_the_unit_of_its_port() {
        for port in Port::ALL {
            for variable in Variable::ALL {
                for directed in [false, true] {
                    let curve = Latent {
                        port,
                        variable,
                        directed,
                        basis: Basis::Hats { ends: [-1.0, 2.0] },
                        coefficients: vec![0.0; 24],
                    };
                    for form in FORMS.iter().chain([&WAVE]) {
                        if form.sense == Sense::SameUnit && symbol(variable).unit != port.unit() {
                            continue;
                        }
                        let plain = Candidate::new(
                            form,
                            (&curve, port == Port::Friction),
                            Moment::default(),
                            &[],
                        );
                        let products = modulated(&plain, |_| 2.0);
                        for candidate in [plain].iter().chain(&products) {
                            let law = candidate.law();
                            let units: Vec<Option<Unit>> = (SYMBOLS.iter().map(|s| s.unit))
                                .chain(law.constants.iter().map(|c| c.unit.unwrap()))
                                .map(|unit| Some(Unit::read(unit).unwrap()))
                                .collect();
                            let expected = Unit::read(port.unit()).unwrap();
                            let checked = law.expression.check_units(&units, expected);
                            let text = law.expression.text();
                            assert_eq!(checked, Ok(()), "{port:?} {variable:?} {text}");
                            assert_eq!(candidate.latent.coefficients.len(), candidate.count());
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn a_unit_over_another_is_read_again() {
        let read = |text: &str| Unit::read(text).unwrap();
        assert_eq!(per("N", "m/s", 1), "N s/m");
        assert_eq!(read(&per("kg/s", "m/s", 1)), read("kg/m"));
        assert_eq!(per("m^2", "s", 1), "m^2/s");
        assert_eq!(per("N", "m/s", 2), "N s^2/m^2");
        assert_eq!(per("1", "m", 1), "1/m");
    }
}
