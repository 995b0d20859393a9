//! Functions are short and take few arguments; those that are not stand here with their reason.

use std::collections::BTreeSet;

use crate::imports::product_files;
use crate::source::{Sources, Token, behind, product, sources, tokens};

/// Most lines of a function, from its name to its end [-].
const MOST_LINES: usize = 80;
/// Most arguments, `self` among them, each of a tuple or an array that is taken apart in the list counted [-].
const MOST_ARGUMENTS: usize = 7;

/// A function: its file, its name.
type Place = (&'static str, &'static str);

/// Ones with more arguments, with the reason.
const MANY_ARGUMENTS: [(Place, &str); 4] = [
    (("fmu/fmi3.rs", "fmi3DoStep"), "FMI 3.0"),
    (("fmu/fmi3.rs", "fmi3InstantiateCoSimulation"), "FMI 3.0"),
    (
        ("simulation/dispatch.rs", "cast_shapes_nonlinear"),
        "Parry's trait QueryDispatcher",
    ),
    (
        ("simulation/dispatch.rs", "contact_manifold_convex_convex"),
        "Parry's trait PersistentQueryDispatcher",
    ),
];

/// A function as it is written.
#[derive(Debug, PartialEq)]
struct Function {
    name: String,
    lines: usize,
    arguments: usize,
}

/// Functions with a body.
fn functions(tokens: &[Token]) -> Vec<Function> {
    let mut found = Vec::new();
    for at in 0..tokens.len() {
        let name = tokens.get(at + 1).map_or("(", |token| token.text.as_str());
        if tokens[at].text != "fn" || name == "(" {
            continue;
        }
        let mut next = at + 2;
        // What is generic stands before the arguments; an arrow in it is no bracket.
        let mut depth = 0;
        while tokens[next].text != "(" || depth > 0 {
            match tokens[next].text.as_str() {
                "<" => depth += 1,
                ">" if tokens[next - 1].text != "-" => depth -= 1,
                _ => (),
            }
            next += 1;
        }
        let end = behind(tokens, next);
        let arguments = arguments(&tokens[next + 1..end - 1]);
        let mut body = end;
        while ![";", "{"].contains(&tokens[body].text.as_str()) {
            body = if ["(", "["].contains(&tokens[body].text.as_str()) {
                behind(tokens, body)
            } else {
                body + 1
            };
        }
        if tokens[body].text == "{" {
            let last = behind(tokens, body) - 1;
            found.push(Function {
                name: name.to_owned(),
                lines: tokens[last].line - tokens[at].line + 1,
                arguments,
            });
        }
    }
    found
}

/// Number of arguments between the brackets; what is taken apart where it is named counts by its parts.
fn arguments(list: &[Token]) -> usize {
    let (mut count, mut at, mut depth, mut parts) = (0, 0, 0, 0);
    while at < list.len() {
        match list[at].text.as_str() {
            bracket @ ("(" | "[" | "{") => {
                let end = behind(list, at);
                if parts == 0 && bracket != "{" {
                    parts = arguments(&list[at + 1..end - 1]);
                }
                parts = parts.max(1);
                at = end;
                continue;
            }
            // An attribute of an argument is none.
            "#" => {
                at = behind(list, at + 1);
                continue;
            }
            "<" => depth += 1,
            ">" if list[at - 1].text != "-" => depth -= 1,
            "," if depth == 0 => {
                count += parts;
                parts = 0;
                at += 1;
                continue;
            }
            _ => (),
        }
        parts = parts.max(1);
        at += 1;
    }
    count + parts
}

/// Places of the product's functions of which this holds.
fn places(sources: &Sources, holds: impl Fn(&Function) -> bool) -> BTreeSet<(String, String)> {
    let of_file = |file: &String| {
        let found = functions(&sources[file]).into_iter().filter(&holds);
        let file = file.clone();
        found.map(move |function| (file.clone(), function.name))
    };
    product_files(sources).iter().flat_map(of_file).collect()
}

/// Refuses what is not listed, and what is listed without need.
fn check(what: &str, found: &BTreeSet<(String, String)>, listed: &[Place]) {
    let owned = |(file, name): &Place| ((*file).to_owned(), (*name).to_owned());
    let listed: BTreeSet<(String, String)> = listed.iter().map(owned).collect();
    let new: Vec<_> = found.difference(&listed).collect();
    assert!(new.is_empty(), "{what}: {new:?}; split along a concept");
    let gone: Vec<_> = listed.difference(found).collect();
    assert!(gone.is_empty(), "{what} no longer: {gone:?}");
}

#[test]
fn functions_are_short() {
    let found = places(&sources(), |function| function.lines > MOST_LINES);
    check("longer than 80 lines", &found, &[]);
}

#[test]
fn functions_take_few_arguments() {
    let found = places(&sources(), |function| function.arguments > MOST_ARGUMENTS);
    check(
        "more than 7 arguments",
        &found,
        &MANY_ARGUMENTS.map(|(place, _)| place),
    );
}

#[test]
fn lengths_and_arguments_are_counted() {
    let counted = |text: &str| -> Vec<(String, usize, usize)> {
        let found = functions(&tokens(text)).into_iter();
        found.map(|it| (it.name, it.lines, it.arguments)).collect()
    };
    let one = |name: &str, lines, arguments| vec![(name.to_owned(), lines, arguments)];
    assert_eq!(counted("fn a() {}"), one("a", 1, 0));
    assert_eq!(
        counted("#[x]\nfn a(\n    &self,\n    b: A<B, C>,\n) {\n    // c\n}\n"),
        one("a", 6, 2)
    );
    assert_eq!(
        counted(
            "fn a<F: Fn(u8, u8) -> B>(f: F, g: (u8, u8), h: fn(u8) -> [u8; 2],) -> [u8; 3] {\n}"
        ),
        one("a", 2, 3)
    );
    assert_eq!(
        counted("fn a((b, [c, d]): (u8, [u8; 2]), [e, _]: [f64; 2], f: [u8; 9], &g: &u8) {}"),
        one("a", 1, 7)
    );
    assert_eq!(
        counted("trait T { fn a(&self); fn b(&self) {\n} }"),
        one("b", 2, 1)
    );
    assert!(counted("type A = fn(u8, u8) -> B;").is_empty());
    let planted = |body: &str| {
        let files = [
            ("lib.rs", "mod a; #[cfg(test)] mod t;"),
            ("a.rs", body),
            ("t.rs", body),
        ];
        let files = files.map(|(name, text)| (name.to_owned(), product(&tokens(text))));
        places(&files.into(), |function| function.lines > MOST_LINES)
    };
    let long = |lines: usize| format!("fn f() {{{}}}", "\n".repeat(lines - 1));
    assert!(planted(&long(MOST_LINES)).is_empty());
    let only = BTreeSet::from([("a.rs".to_owned(), "f".to_owned())]);
    assert_eq!(planted(&long(MOST_LINES + 1)), only);
}
