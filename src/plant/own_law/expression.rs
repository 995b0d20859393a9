//! An arithmetic expression over named variables and constants: read, checked for its units and for values that are not finite, evaluated.
//!
//! ```text
//! -c * max(v - v_0, 0) ^ 1.5
//! ```
//!
//! `^` binds before a sign, as on paper: -v^2 is -(v^2). A comparison is 1 where it holds and 0 elsewhere.
//!
//! It is kept as steps, operands before what is done with them, so that nothing but the parser goes deeper into the stack with each bracket, and that is bounded.

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

/// Most letters of an expression.
const LONGEST: usize = 10_000;
/// Most brackets, signs and powers in each other: the parser goes deeper into the stack with each.
const DEEPEST: usize = 100;
/// Most values that wait for others while one is evaluated.
const WAITING: usize = 64;

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

/// A step of an expression, with the bytes of the text whose value it is.
#[derive(Debug, Clone)]
struct Step {
    span: Range<usize>,
    kind: Kind,
}

#[derive(Debug, Clone)]
enum Kind {
    Number(f64),
    /// A name that is still to be looked up.
    Name(String),
    Value(usize),
    /// Of the value before it.
    Negative,
    Function(Function),
    /// Of the two values before it.
    Operation(Operation),
}

/// The steps of a part of an expression; the last is the part's own.
type Part = Vec<Step>;

/// An expression over values given by their places in a list.
#[derive(Debug, Clone)]
pub struct Expression {
    text: String,
    steps: Vec<Step>,
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
        check_extent(text)?;
        let mut steps = whole.parse(LocatingSlice::new(text)).map_err(|error| {
            let at = error.offset().min(text.len());
            let letter = text.get(at..).and_then(|rest| rest.chars().next());
            ExpressionError {
                span: at..at + letter.map_or(0, char::len_utf8),
                reason: "expected a number, a name, a function such as max(..) or a bracket, joined by + - * / ^ < >".to_owned(),
            }
        })?;
        include_signs(&mut steps, text);
        steps.iter_mut().try_for_each(|step| look_up(step, names))?;
        check_waiting(&steps)?;
        Ok(Self {
            text: text.to_owned(),
            steps,
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
        let (mut waiting, mut count) = ([0.0; WAITING], 0);
        for step in &self.steps {
            count = step.kind.pushed(count, values, &mut waiting);
        }
        waiting[0]
    }

    /// Whether it uses the name of this place.
    #[must_use]
    pub fn uses(&self, place: usize) -> bool {
        let is_it = |step: &Step| matches!(step.kind, Kind::Value(own) if own == place);
        self.steps.iter().any(is_it)
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
        match unit(&self.steps, units)? {
            InferredUnit::Unit(found) if found != expected => Err(ExpressionError {
                span: self.steps.last().map_or(0..0, |step| step.span.clone()),
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
        let (mut waiting, mut count) = ([0.0; WAITING], 0);
        for step in &self.steps {
            count = step.kind.pushed(count, values, &mut waiting);
            if !waiting[count - 1].is_finite() {
                return Err(ExpressionError {
                    span: step.span.clone(),
                    reason: "it is not finite".to_owned(),
                });
            }
        }
        Ok(())
    }
}

impl Kind {
    /// Takes what it needs of the values that wait, and puts its own there; how many wait then.
    fn pushed(&self, count: usize, values: &[f64], waiting: &mut [f64; WAITING]) -> usize {
        let (place, found) = match self {
            Self::Number(number) => (count, *number),
            Self::Value(place) => (count, values[*place]),
            // Looked up as the expression was read.
            Self::Name(_) => (count, f64::NAN),
            Self::Negative => (count - 1, -waiting[count - 1]),
            Self::Function(function) => (count - 1, (function.law)(waiting[count - 1])),
            Self::Operation(operation) => {
                let [a, b] = [waiting[count - 2], waiting[count - 1]];
                (count - 2, operation.apply(a, b))
            }
        };
        waiting[place] = found;
        place + 1
    }

    /// How many values it takes.
    fn taken(&self) -> usize {
        match self {
            Self::Number(_) | Self::Name(_) | Self::Value(_) => 0,
            Self::Negative | Self::Function(_) => 1,
            Self::Operation(_) => 2,
        }
    }
}

/// Refuses a text that is very long, or whose parts lie very deep in each other.
fn check_extent(text: &str) -> Result<(), ExpressionError> {
    let refuse = |at: usize, reason: String| {
        Err(ExpressionError {
            span: at..(at + 1).min(text.len()),
            reason,
        })
    };
    if text.len() > LONGEST {
        let count = text.len();
        return refuse(
            0,
            format!("it has {count} letters, expected {LONGEST} at most"),
        );
    }
    // Signs and powers that are open in each bracket that is open; a value stands before what joins it to another.
    let (mut open, mut depth, mut after_value) = (vec![0], 0, false);
    for (at, letter) in text.char_indices().filter(|(_, c)| !c.is_whitespace()) {
        let own = open.len() - 1;
        match letter {
            '(' => {
                open.push(0);
                depth += 1;
            }
            ')' if own > 0 => depth -= open.pop().unwrap_or(0) + 1,
            '^' => {
                open[own] += 1;
                depth += 1;
            }
            '-' if !after_value => {
                open[own] += 1;
                depth += 1;
            }
            '+' | '-' | '*' | '/' | '<' | '>' | ',' => depth -= std::mem::take(&mut open[own]),
            _ => {}
        }
        if depth > DEEPEST {
            return refuse(
                at,
                format!(
                    "its brackets, signs and powers lie more than {DEEPEST} deep in each other"
                ),
            );
        }
        after_value = letter == ')' || letter == '.' || letter == '_' || letter.is_alphanumeric();
    }
    Ok(())
}

/// Refuses what would hold very many values while it is evaluated.
fn check_waiting(steps: &[Step]) -> Result<(), ExpressionError> {
    let mut count = 0;
    for step in steps {
        count = count + 1 - step.kind.taken();
        if count > WAITING {
            return Err(ExpressionError {
                span: step.span.clone(),
                reason: format!(
                    "more than {WAITING} values wait here for those behind them, expected fewer: put the innermost part first"
                ),
            });
        }
    }
    Ok(())
}

type Input<'a> = LocatingSlice<&'a str>;

fn whole(input: &mut Input<'_>) -> ModalResult<Part> {
    delimited(multispace0, sum, multispace0).parse_next(input)
}

fn span_of(part: &Part) -> Range<usize> {
    part.last().map_or(0..0, |step| step.span.clone())
}

fn joined(operation: Operation, mut a: Part, b: Part) -> Part {
    let span = span_of(&a).start..span_of(&b).end;
    a.extend(b);
    a.push(Step {
        span,
        kind: Kind::Operation(operation),
    });
    a
}

/// A part whose own step is about these bytes.
fn spanning(span: Range<usize>, mut part: Part) -> Part {
    if let Some(own) = part.last_mut() {
        own.span = span;
    }
    part
}

fn sum(input: &mut Input<'_>) -> ModalResult<Part> {
    let minus = literal("-").span();
    expression(delimited(multispace0, operand, multispace0))
        .prefix(delimited(multispace0, minus, multispace0).map(|_| Prefix(8, negative)))
        .infix(infix)
        .parse_next(input)
}

fn negative(_: &mut Input<'_>, mut of: Part) -> ModalResult<Part> {
    of.push(Step {
        span: span_of(&of),
        kind: Kind::Negative,
    });
    Ok(of)
}

fn infix<'a>(input: &mut Input<'a>) -> ModalResult<Infix<Input<'a>, Part, ErrMode<ContextError>>> {
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

fn operand(input: &mut Input<'_>) -> ModalResult<Part> {
    alt((bracket, number, named)).parse_next(input)
}

fn bracket(input: &mut Input<'_>) -> ModalResult<Part> {
    preceded("(", cut_err((sum, ")")))
        .with_span()
        .map(|((part, _), span)| spanning(span, part))
        .parse_next(input)
}

fn number(input: &mut Input<'_>) -> ModalResult<Part> {
    // The library's `float` reads "inf" and "nan" too, which are names here.
    let start = take_while(1, |c: char| c.is_ascii_digit() || c == '.');
    let (value, span) = preceded(peek(start), float).with_span().parse_next(input)?;
    Ok(vec![Step {
        span,
        kind: Kind::Number(value),
    }])
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

fn named(input: &mut Input<'_>) -> ModalResult<Part> {
    let ((name, span), arguments) = (name.with_span(), opt(arguments)).parse_next(input)?;
    let Some((arguments, end)) = arguments else {
        let kind = match name {
            "pi" => Kind::Number(std::f64::consts::PI),
            name => Kind::Name(name.to_owned()),
        };
        return Ok(vec![Step { span, kind }]);
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
        (None, Some(function), Some(mut only)) if count == 1 => {
            let kind = Kind::Function(function);
            only.push(Step { span: whole, kind });
            return Ok(only);
        }
        (Some(operation), _, Some(first)) if count > 1 => {
            let part = arguments.fold(first, |a, b| joined(operation, a, b));
            return Ok(spanning(whole, part));
        }
        // Reported as a name that is not known, with its location.
        _ => Kind::Name(format!("{name}(..) of {count}")),
    };
    Ok(vec![Step { span: whole, kind }])
}

/// Arguments of a function with where their bracket ends.
fn arguments(input: &mut Input<'_>) -> ModalResult<(Vec<Part>, usize)> {
    let list = separated(1.., sum, ",");
    let close = preceded(multispace0, ")").span();
    preceded((multispace0, "("), cut_err((list, close)))
        .map(|(list, close): (Vec<Part>, Range<usize>)| (list, close.end))
        .parse_next(input)
}

/// Widens what begins with a sign by the sign, which the parser hands on without its place.
fn include_signs(steps: &mut [Step], text: &str) {
    // Where the values that wait begin.
    let mut begins: Vec<usize> = Vec::new();
    for step in steps {
        let first = begins.len().saturating_sub(step.kind.taken());
        let of_first = begins.get(first).copied();
        match (&step.kind, of_first) {
            (Kind::Negative, Some(begin)) => {
                let before = text.get(..begin).and_then(|before| before.rfind('-'));
                step.span.start = before.unwrap_or(begin);
            }
            (Kind::Operation(_), Some(begin)) => step.span.start = step.span.start.min(begin),
            _ => {}
        }
        begins.truncate(first);
        begins.push(step.span.start);
    }
}

fn look_up(step: &mut Step, names: &[&str]) -> Result<(), ExpressionError> {
    let Kind::Name(name) = &step.kind else {
        return Ok(());
    };
    if let Some(place) = names.iter().position(|known| known == name) {
        step.kind = Kind::Value(place);
        return Ok(());
    }
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
        span: step.span.clone(),
        reason,
    })
}

/// The unit of an expression's value.
fn unit(steps: &[Step], units: &[Option<Unit>]) -> Result<InferredUnit, ExpressionError> {
    let mut waiting: Vec<InferredUnit> = Vec::new();
    let mut exponent = None;
    for step in steps {
        let first = waiting.len().saturating_sub(step.kind.taken());
        let found = unit_of(step, &waiting[first..], exponent, units)?;
        waiting.truncate(first);
        waiting.push(found);
        exponent = match step.kind {
            Kind::Number(number) => Some(number),
            _ => None,
        };
    }
    Ok(waiting.pop().unwrap_or(InferredUnit::Nothing))
}

/// The unit of a step's value by those of what it takes, and the number before it, if that is one as written.
fn unit_of(
    step: &Step,
    taken: &[InferredUnit],
    exponent: Option<f64>,
    units: &[Option<Unit>],
) -> Result<InferredUnit, ExpressionError> {
    let refuse = |reason: String| ExpressionError {
        span: step.span.clone(),
        reason,
    };
    Ok(match (&step.kind, taken) {
        (Kind::Number(_), _) => InferredUnit::Number,
        (Kind::Value(place), _) => units[*place].map_or(InferredUnit::Nothing, InferredUnit::Unit),
        (Kind::Function(function), [InferredUnit::Unit(argument)]) => {
            InferredUnit::Unit((function.unit)(*argument).ok_or_else(|| {
                refuse(format!(
                    "{} of something in {argument}, expected a number without a unit",
                    function.name
                ))
            })?)
        }
        (Kind::Negative | Kind::Function(_), [inferred]) => *inferred,
        (Kind::Operation(operation), &[a, b]) => match (operation, [a, b]) {
            (Operation::Multiply | Operation::Divide, [a, b]) => product(*operation, a, b),
            (Operation::Power, [InferredUnit::Unit(base), _]) => match exponent {
                Some(exponent) => InferredUnit::Unit(base.power(exponent)),
                None if base == Unit::ONE => InferredUnit::Unit(base),
                None => InferredUnit::Nothing,
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
        },
        _ => InferredUnit::Nothing,
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
    fn a_refusal_points_at_whole_letters() {
        for text in [
            "ü-1e308ü-1e308",
            "x ü",
            "ü",
            "x * ü(2)",
            "(ü",
            "2ü3",
            "x-ü-1e3ü",
            "é^-é",
            "-ü",
            "x + 1 é",
        ] {
            let error = Expression::read(text, &NAMES).unwrap_err();
            assert!(
                text.get(error.span.clone()).is_some(),
                "{text}: {:?}, {error}",
                error.span
            );
        }
    }

    #[test]
    fn very_long_and_very_deep_texts_are_refused_and_what_is_read_is_evaluated() {
        let refusal = |text: &str| Expression::read(text, &NAMES).unwrap_err().reason;
        let deep = |open: &str, count: usize, close: &str| {
            format!("{}x{}", open.repeat(count), close.repeat(count))
        };
        for (open, close) in [
            ("(", ")"),
            ("-", ""),
            ("- ", " "),
            ("2^", ""),
            ("2^-", ""),
            ("sin(", ")"),
            ("max(1,", ")"),
            ("1+(", ")"),
            ("-(", ")"),
        ] {
            for count in [400, 5300, 50_000] {
                let said = refusal(&deep(open, count, close));
                let expected = said.contains("deep in each other") || said.contains("letters");
                assert!(expected, "{open}: {said}");
            }
            let fits = Expression::read(&deep(open, 40, close), &NAMES);
            assert!(fits.is_ok(), "{open}: {fits:?}");
        }
        // Open brackets alone, closing ones alone: no expression, and no more than that.
        assert!(refusal(&"(".repeat(90)).contains("expected a number"));
        assert!(refusal(&")".repeat(5000)).contains("expected a number"));
        // What stands side by side lies in nothing.
        let terms = 2400;
        let sum = format!("x{}", " - v".repeat(terms));
        assert_eq!(at(&sum), 0.5 + 3.0 * f64::from(terms as u32));
        assert!(refusal(&format!("x{}", "+x".repeat(50_000))).contains("letters"));
        let side_by_side = "-x^2 + ".repeat(300) + "(x)";
        assert_eq!(at(&side_by_side), 0.5 - 300.0 * 0.25);
        // Values that wait: 1+2*(1+2*(..)).
        let waiting = deep("1+2*(", 60, ")");
        assert!(refusal(&waiting).contains("wait"));
    }

    #[test]
    fn what_is_not_finite_is_reported_with_its_location() {
        let expression = Expression::read("c + ln(x - t) * 2", &NAMES).unwrap();
        let error = expression.check_finite(&[0.0, 0.0, 0.0, 1.0]).unwrap_err();
        assert_eq!(error.span, 4..13);
        assert_eq!(expression.check_finite(&[0.0, 1.0, 0.0, 1.0]), Ok(()));
    }
}
