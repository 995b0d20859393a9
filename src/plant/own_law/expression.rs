//! An arithmetic expression over named variables and constants: read, checked for its units and for values that are not finite, evaluated.
//!
//! ```text
//! -c * max(v - v_0, 0) ^ 1.5
//! ```
//!
//! `^` binds before a sign, as on paper: -v^2 is -(v^2). A comparison is 1 where it holds and 0 elsewhere.

use std::ops::Range;

use winnow::ascii::{float, multispace0};
use winnow::combinator::Infix::{Left, Right};
use winnow::combinator::{
    Infix, Prefix, alt, cut_err, delimited, expression, fail, opt, peek, preceded, separated,
};
use winnow::error::{ContextError, ErrMode};
use winnow::stream::LocatingSlice;
use winnow::token::{any, literal, take_while};
use winnow::{ModalResult, Parser};

use super::unit::Unit;

/// A fault of an expression, and its place in the text.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{reason}")]
pub struct ExpressionError {
    /// Bytes of the text that it is about.
    pub span: Range<usize>,
    /// In words.
    pub reason: String,
}

/// A function of one argument.
#[derive(Debug, Clone, Copy)]
struct Function {
    name: &'static str,
    law: fn(f64) -> f64,
    /// Unit of its value by that of its argument; none where the argument may not have one.
    unit: fn(Unit) -> Option<Unit>,
}

/// Functions of one argument.
const FUNCTIONS: [Function; 10] = [
    function("sin", f64::sin, Unit::plain),
    function("cos", f64::cos, Unit::plain),
    function("tan", f64::tan, Unit::plain),
    function("atan", f64::atan, Unit::plain),
    function("tanh", f64::tanh, Unit::plain),
    function("exp", f64::exp, Unit::plain),
    function("ln", f64::ln, Unit::plain),
    function("sqrt", f64::sqrt, |unit| Some(unit.power(0.5))),
    function("abs", f64::abs, Some),
    function("sign", sign, |_| Some(Unit::ONE)),
];

const fn function(
    name: &'static str,
    law: fn(f64) -> f64,
    unit: fn(Unit) -> Option<Unit>,
) -> Function {
    Function { name, law, unit }
}

/// -1, 0 or 1.
fn sign(value: f64) -> f64 {
    if value == 0.0 { 0.0 } else { value.signum() }
}

/// An operation on two values.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Operation {
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Less,
    Greater,
    Least,
    Greatest,
}

impl Operation {
    fn apply(self, a: f64, b: f64) -> f64 {
        match self {
            Self::Add => a + b,
            Self::Subtract => a - b,
            Self::Multiply => a * b,
            Self::Divide => a / b,
            Self::Power => a.powf(b),
            Self::Less => f64::from(a < b),
            Self::Greater => f64::from(a > b),
            Self::Least => a.min(b),
            Self::Greatest => a.max(b),
        }
    }
}

/// A part of an expression, with the bytes of its text.
#[derive(Debug, Clone)]
struct Node {
    span: Range<usize>,
    kind: Kind,
}

#[derive(Debug, Clone)]
enum Kind {
    Number(f64),
    /// A name that is still to be looked up.
    Name(String),
    Value(usize),
    Negative(Box<Node>),
    Function(Function, Box<Node>),
    Operation(Operation, Box<[Node; 2]>),
}

/// An expression over values given by their places in a list.
#[derive(Debug, Clone)]
pub struct Expression {
    text: String,
    root: Node,
}

impl PartialEq for Expression {
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text
    }
}

/// Statement of an expression on the unit of one of its parts.
#[derive(Debug, Clone, Copy, PartialEq)]
enum InferredUnit {
    /// A number as written: of any unit beside a sum, of none in a product.
    Number,
    /// Nothing is known.
    Nothing,
    Unit(Unit),
}

impl Expression {
    /// Reads an expression over these names.
    ///
    /// # Errors
    /// It is no expression, or has a name that is not among them.
    pub fn read(text: &str, names: &[&str]) -> Result<Self, ExpressionError> {
        let mut root = whole.parse(LocatingSlice::new(text)).map_err(|error| {
            let at = error.offset().min(text.len());
            let letter = text.get(at..).and_then(|rest| rest.chars().next());
            ExpressionError {
                span: at..at + letter.map_or(0, char::len_utf8),
                reason: "expected a number, a name, a function such as max(..) or a bracket, joined by + - * / ^ < >".to_owned(),
            }
        })?;
        include_signs(&mut root, text);
        look_up(&mut root, names)?;
        Ok(Self {
            text: text.to_owned(),
            root,
        })
    }

    /// As written.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Its value, of these values of the names.
    #[must_use]
    pub fn value(&self, values: &[f64]) -> f64 {
        value(&self.root, values)
    }

    /// Whether it uses the name of this place.
    #[must_use]
    pub fn uses(&self, place: usize) -> bool {
        uses(&self.root, place)
    }

    /// Checks that it adds only what has the same unit, and that it has the unit expected of it; `units` of the names, where they are known.
    ///
    /// # Errors
    /// The part that does not.
    pub fn check_units(
        &self,
        units: &[Option<Unit>],
        expected: Unit,
    ) -> Result<(), ExpressionError> {
        match unit(&self.root, units)? {
            InferredUnit::Unit(found) if found != expected => Err(ExpressionError {
                span: self.root.span.clone(),
                reason: format!("it is in {found}, expected {expected}"),
            }),
            _ => Ok(()),
        }
    }

    /// Checks that it is finite at these values of the names.
    ///
    /// # Errors
    /// The innermost part that is not.
    pub fn check_finite(&self, values: &[f64]) -> Result<(), ExpressionError> {
        finite(&self.root, values).map(|_| ())
    }
}

type Input<'a> = LocatingSlice<&'a str>;

fn whole(input: &mut Input<'_>) -> ModalResult<Node> {
    delimited(multispace0, sum, multispace0).parse_next(input)
}

fn joined(operation: Operation, a: Node, b: Node) -> Node {
    Node {
        span: a.span.start..b.span.end,
        kind: Kind::Operation(operation, Box::new([a, b])),
    }
}

fn sum(input: &mut Input<'_>) -> ModalResult<Node> {
    let minus = literal("-").span();
    expression(delimited(multispace0, operand, multispace0))
        .prefix(delimited(multispace0, minus, multispace0).map(|_| Prefix(8, negative)))
        .infix(infix)
        .parse_next(input)
}

fn negative(_: &mut Input<'_>, of: Node) -> ModalResult<Node> {
    Ok(Node {
        span: of.span.clone(),
        kind: Kind::Negative(Box::new(of)),
    })
}

fn infix<'a>(input: &mut Input<'a>) -> ModalResult<Infix<Input<'a>, Node, ErrMode<ContextError>>> {
    let rule = match any.parse_next(input)? {
        '<' => Left(3, |_, a, b| Ok(joined(Operation::Less, a, b))),
        '>' => Left(3, |_, a, b| Ok(joined(Operation::Greater, a, b))),
        '+' => Left(5, |_, a, b| Ok(joined(Operation::Add, a, b))),
        '-' => Left(5, |_, a, b| Ok(joined(Operation::Subtract, a, b))),
        '*' => Left(7, |_, a, b| Ok(joined(Operation::Multiply, a, b))),
        '/' => Left(7, |_, a, b| Ok(joined(Operation::Divide, a, b))),
        '^' => Right(10, |_, a, b| Ok(joined(Operation::Power, a, b))),
        _ => return fail.parse_next(input),
    };
    Ok(rule)
}

fn operand(input: &mut Input<'_>) -> ModalResult<Node> {
    alt((bracket, number, named)).parse_next(input)
}

fn bracket(input: &mut Input<'_>) -> ModalResult<Node> {
    preceded("(", cut_err((sum, ")")))
        .with_span()
        .map(|((node, _), span)| Node { span, ..node })
        .parse_next(input)
}

fn number(input: &mut Input<'_>) -> ModalResult<Node> {
    // The library's `float` reads "inf" and "nan" too, which are names here.
    let start = take_while(1, |c: char| c.is_ascii_digit() || c == '.');
    let (value, span) = preceded(peek(start), float).with_span().parse_next(input)?;
    Ok(Node {
        span,
        kind: Kind::Number(value),
    })
}

fn name<'a>(input: &mut Input<'a>) -> ModalResult<&'a str> {
    let first = |c: char| c.is_alphabetic() || c == '_';
    (
        take_while(1, first),
        take_while(0.., |c: char| first(c) || c.is_ascii_digit()),
    )
        .take()
        .parse_next(input)
}

fn named(input: &mut Input<'_>) -> ModalResult<Node> {
    let ((name, span), arguments) = (name.with_span(), opt(arguments)).parse_next(input)?;
    let Some((arguments, end)) = arguments else {
        let kind = match name {
            "pi" => Kind::Number(std::f64::consts::PI),
            name => Kind::Name(name.to_owned()),
        };
        return Ok(Node { span, kind });
    };
    let whole = span.start..end;
    let operation = match name {
        "min" => Some(Operation::Least),
        "max" => Some(Operation::Greatest),
        _ => None,
    };
    let function = FUNCTIONS.into_iter().find(|function| function.name == name);
    let count = arguments.len();
    let mut arguments = arguments.into_iter();
    let kind = match (operation, function, arguments.next()) {
        (None, Some(function), Some(only)) if count == 1 => {
            Kind::Function(function, Box::new(only))
        }
        (Some(operation), _, Some(first)) if count > 1 => {
            let mut node = arguments.fold(first, |a, b| joined(operation, a, b));
            node.span = whole;
            return Ok(node);
        }
        // Reported as a name that is not known, with its location.
        _ => Kind::Name(format!("{name}(..) of {count}")),
    };
    Ok(Node { span: whole, kind })
}

/// Arguments of a function with where their bracket ends.
fn arguments(input: &mut Input<'_>) -> ModalResult<(Vec<Node>, usize)> {
    let list = separated(1.., sum, ",");
    let close = preceded(multispace0, ")").span();
    preceded((multispace0, "("), cut_err((list, close)))
        .map(|(list, close): (Vec<Node>, Range<usize>)| (list, close.end))
        .parse_next(input)
}

/// Widens what begins with a sign by the sign, which the parser hands on without its place.
fn include_signs(node: &mut Node, text: &str) {
    match &mut node.kind {
        Kind::Negative(of) => {
            include_signs(of, text);
            let before = text
                .get(..of.span.start)
                .and_then(|before| before.rfind('-'));
            node.span.start = before.unwrap_or(of.span.start);
        }
        Kind::Function(_, of) => include_signs(of, text),
        Kind::Operation(_, both) => {
            both.iter_mut().for_each(|part| include_signs(part, text));
            node.span.start = node.span.start.min(both[0].span.start);
        }
        Kind::Number(_) | Kind::Name(_) | Kind::Value(_) => {}
    }
}

fn look_up(node: &mut Node, names: &[&str]) -> Result<(), ExpressionError> {
    match &mut node.kind {
        Kind::Number(_) | Kind::Value(_) => Ok(()),
        Kind::Name(name) => match names.iter().position(|known| known == name) {
            Some(place) => {
                node.kind = Kind::Value(place);
                Ok(())
            }
            None => {
                let functions: Vec<&str> = FUNCTIONS.iter().map(|f| f.name).collect();
                let reason = if name.contains('(') {
                    format!(
                        "there is no function {name}, expected min(a, b), max(a, b) or one of {}, of one argument",
                        functions.join(", ")
                    )
                } else {
                    format!(
                        "there is no `{name}` here, expected one of {}",
                        names.join(", ")
                    )
                };
                Err(ExpressionError {
                    span: node.span.clone(),
                    reason,
                })
            }
        },
        Kind::Negative(of) | Kind::Function(_, of) => look_up(of, names),
        Kind::Operation(_, both) => both.iter_mut().try_for_each(|node| look_up(node, names)),
    }
}

fn value(node: &Node, values: &[f64]) -> f64 {
    match &node.kind {
        Kind::Number(number) => *number,
        Kind::Value(place) => values[*place],
        Kind::Negative(of) => -value(of, values),
        Kind::Function(function, of) => (function.law)(value(of, values)),
        Kind::Operation(operation, both) => {
            let [a, b] = &**both;
            operation.apply(value(a, values), value(b, values))
        }
        // Looked up as the expression was read.
        Kind::Name(_) => f64::NAN,
    }
}

fn uses(node: &Node, place: usize) -> bool {
    match &node.kind {
        Kind::Value(own) => *own == place,
        Kind::Negative(of) | Kind::Function(_, of) => uses(of, place),
        Kind::Operation(_, both) => both.iter().any(|node| uses(node, place)),
        Kind::Number(_) | Kind::Name(_) => false,
    }
}

fn finite(node: &Node, values: &[f64]) -> Result<f64, ExpressionError> {
    match &node.kind {
        Kind::Number(_) | Kind::Value(_) | Kind::Name(_) => {}
        Kind::Negative(of) | Kind::Function(_, of) => {
            finite(of, values)?;
        }
        Kind::Operation(_, both) => {
            for part in &**both {
                finite(part, values)?;
            }
        }
    }
    let found = value(node, values);
    if found.is_finite() {
        return Ok(found);
    }
    Err(ExpressionError {
        span: node.span.clone(),
        reason: "it is not finite".to_owned(),
    })
}

fn unit(node: &Node, units: &[Option<Unit>]) -> Result<InferredUnit, ExpressionError> {
    let refuse = |reason: String| ExpressionError {
        span: node.span.clone(),
        reason,
    };
    Ok(match &node.kind {
        Kind::Number(_) => InferredUnit::Number,
        Kind::Name(_) => InferredUnit::Nothing,
        Kind::Value(place) => units[*place].map_or(InferredUnit::Nothing, InferredUnit::Unit),
        Kind::Negative(of) => unit(of, units)?,
        Kind::Function(function, of) => match unit(of, units)? {
            InferredUnit::Unit(argument) => {
                InferredUnit::Unit((function.unit)(argument).ok_or_else(|| {
                    refuse(format!(
                        "{} of something in {argument}, expected a number without a unit",
                        function.name
                    ))
                })?)
            }
            inferred => inferred,
        },
        Kind::Operation(operation, both) => {
            let [a, b] = &**both;
            let inferred = [unit(a, units)?, unit(b, units)?];
            match (operation, inferred) {
                (Operation::Multiply | Operation::Divide, [a, b]) => product(*operation, a, b),
                (Operation::Power, [InferredUnit::Unit(base), _]) => match b.kind {
                    Kind::Number(exponent) => InferredUnit::Unit(base.power(exponent)),
                    _ if base == Unit::ONE => InferredUnit::Unit(base),
                    _ => InferredUnit::Nothing,
                },
                (Operation::Power, [base, _]) => base,
                (_, [InferredUnit::Unit(a), InferredUnit::Unit(b)]) if a != b => {
                    return Err(refuse(format!("{a} beside {b}")));
                }
                (Operation::Less | Operation::Greater, _) => InferredUnit::Unit(Unit::ONE),
                (_, [InferredUnit::Unit(unit), _] | [_, InferredUnit::Unit(unit)]) => {
                    InferredUnit::Unit(unit)
                }
                (_, [InferredUnit::Number, InferredUnit::Number]) => InferredUnit::Number,
                _ => InferredUnit::Nothing,
            }
        }
    })
}

fn product(operation: Operation, a: InferredUnit, b: InferredUnit) -> InferredUnit {
    let known = |inferred| match inferred {
        InferredUnit::Number => Some(Unit::ONE),
        InferredUnit::Nothing => None,
        InferredUnit::Unit(unit) => Some(unit),
    };
    if (a, b) == (InferredUnit::Number, InferredUnit::Number) {
        return InferredUnit::Number;
    }
    let (Some(a), Some(b)) = (known(a), known(b)) else {
        return InferredUnit::Nothing;
    };
    InferredUnit::Unit(match operation {
        Operation::Divide => a.times(b.power(-1.0)),
        _ => a.times(b),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const NAMES: [&str; 4] = ["t", "x", "v", "c"];

    fn at(text: &str) -> f64 {
        let expression = Expression::read(text, &NAMES).unwrap();
        expression.value(&[2.0, 0.5, -3.0, 10.0])
    }

    #[test]
    fn it_is_read_as_on_paper() {
        for (text, expected) in [
            ("1 + 2*3", 7.0),
            ("-v^2", -9.0),
            ("2^3^2", 512.0),
            ("c/2/5", 1.0),
            ("10 - 4 - 3", 3.0),
            ("-c * max(v, 0)", 0.0),
            ("-c*max(-v,0)", -30.0),
            ("max(1, min(c, 7), x)", 7.0),
            ("(x > 0.4) * (t < 3)", 1.0),
            ("sqrt(abs(v)) * sign(v)", -3f64.sqrt()),
            ("sin(pi * x)", 1.0),
            ("1e-3 * c - -t", 2.01),
            ("2 * -x", -1.0),
            ("t*(x - (v))", 7.0),
        ] {
            assert!((at(text) - expected).abs() < 1e-12, "{text}: {}", at(text));
        }
    }

    #[test]
    fn what_cannot_be_read_is_reported_with_its_location() {
        for (text, part, said) in [
            ("-c * mox(v, 0)", "mox(v, 0)", "no function mox(..) of 2"),
            ("-c * max(v)", "max(v)", "no function max(..) of 1"),
            ("-c * w", "w", "no `w` here, expected one of t, x, v, c"),
            ("-c * inf", "inf", "no `inf` here"),
            ("c * (v + ", "", "expected a number, a name"),
            ("c * * v", "* v", "expected a number, a name"),
            ("c v", "v", "expected a number, a name"),
        ] {
            let error = Expression::read(text, &NAMES).unwrap_err();
            assert!(error.reason.contains(said), "{text}: {error}");
            let place = text[error.span.start..].starts_with(part);
            assert!(place, "{text}: {:?}", error.span);
        }
    }

    #[test]
    fn a_letter_of_several_bytes_is_named_whole() {
        for (text, expected) in [("v² * c", "²"), ("t - 1ü", "ü"), ("2 * ", "")] {
            let span = Expression::read(text, &NAMES).unwrap_err().span;
            assert_eq!(text.get(span), Some(expected), "{text}");
        }
    }

    #[test]
    fn units_that_do_not_go_together_are_refused_where_they_meet() {
        let of = |text: &str| Some(Unit::read(text).unwrap());
        let units = [of("s"), of("m"), of("m/s"), of("N s/m")];
        let check = |text: &str| {
            let expression = Expression::read(text, &NAMES).unwrap();
            expression.check_units(&units, Unit::read("N").unwrap())
        };
        for text in [
            "-c * max(v, 0)",
            "c * v * (x > 0.01)",
            "2 * c * x / t",
            "c * v * exp(-t/3)",
            "c*sqrt(v^2)",
        ] {
            // A number in a sum takes the unit beside it; t/3 is a time all the same.
            let result = check(text);
            assert_eq!(result.is_ok(), !text.contains("exp"), "{text}: {result:?}");
        }
        for (text, part, said) in [
            ("c * (v + x)", "(v + x)", "m/s beside m"),
            ("c * x", "c * x", "it is in N s, expected N"),
            ("c * v * sin(x)", "sin(x)", "sin of something in m"),
        ] {
            let error = check(text).unwrap_err();
            assert_eq!(&text[error.span.clone()], part);
            assert!(error.reason.contains(said), "{error}");
        }
        let unknown = Expression::read("c * x", &NAMES).unwrap();
        let units = [of("s"), of("m"), of("m/s"), None];
        assert_eq!(
            unknown.check_units(&units, Unit::read("N").unwrap()),
            Ok(())
        );
    }

    #[test]
    fn what_is_not_finite_is_reported_with_its_location() {
        let expression = Expression::read("c + ln(x - t) * 2", &NAMES).unwrap();
        let error = expression.check_finite(&[0.0, 0.0, 0.0, 1.0]).unwrap_err();
        assert_eq!(error.span, 4..13);
        assert_eq!(expression.check_finite(&[0.0, 1.0, 0.0, 1.0]), Ok(()));
    }
}
