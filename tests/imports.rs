//! No circle of imports among files.
//!
//! A file imports the file in which a name that it uses is defined, whoever re-exports it on the way. `mod child;` and a re-export alone are no imports.

use std::collections::{BTreeMap, BTreeSet};

use crate::source::{Sources, Token, sources, tokens};

/// A file as a module.
struct Module {
    file: String,
    /// Its words that stand in no `use` and in no `mod` line.
    body: Vec<Token>,
    /// Modules with files that it declares.
    children: Vec<String>,
    /// Items that it defines.
    defined: BTreeSet<String>,
    imports: Vec<Import>,
}

/// One name of a `use`.
#[derive(Debug, PartialEq)]
struct Import {
    public: bool,
    path: Vec<String>,
    /// What it is called here; `*` for all names.
    name: String,
}

/// Modules by their path in the crate; the crate's root has an empty one.
struct Modules(BTreeMap<Vec<String>, Module>);

/// What a path leads to.
#[derive(Debug, Clone, PartialEq)]
enum Target {
    Module(Vec<String>),
    /// An item, by the module that defines it.
    Item(Vec<String>),
}

/// The leaves of the tree of a `use` from here, behind what stands before it. Returns the place behind the tree.
fn leaves(tree: &[Token], mut at: usize, head: &[String], found: &mut Vec<Import>) -> usize {
    let mut path = head.to_vec();
    let leaf = |path: &[String], name: &str| Import {
        public: false,
        path: path.to_vec(),
        name: name.to_owned(),
    };
    while at < tree.len() {
        match tree[at].text.as_str() {
            "{" => {
                while tree[at].text != "}" {
                    at += 1;
                    if tree[at].text != "}" {
                        at = leaves(tree, at, &path, found);
                    }
                }
                return at + 1;
            }
            "*" => {
                found.push(leaf(&path, "*"));
                return at + 1;
            }
            "as" => {
                found.push(leaf(&path, &tree[at + 1].text));
                return at + 2;
            }
            "," | "}" | ";" => break,
            "::" => (),
            "self" if path.len() > head.len() || !head.is_empty() => (),
            word => path.push(word.to_owned()),
        }
        at += 1;
    }
    if let Some(name) = path.last() {
        found.push(leaf(&path, name));
    }
    at
}

impl Module {
    fn new(file: &str, tokens: &[Token]) -> Self {
        let (mut body, mut children, mut imports) = (Vec::new(), Vec::new(), Vec::new());
        let mut defined = BTreeSet::new();
        let mut at = 0;
        while at < tokens.len() {
            let before = at.checked_sub(1).map_or("", |it| tokens[it].text.as_str());
            match tokens[at].text.as_str() {
                "use" => {
                    let known = imports.len();
                    at = leaves(tokens, at + 1, &[], &mut imports);
                    for import in &mut imports[known..] {
                        import.public = before == "pub" || before == ")";
                    }
                }
                "mod" if tokens.get(at + 2).is_some_and(|it| it.text == ";") => {
                    children.push(tokens[at + 1].text.clone());
                    at += 3;
                }
                _ => {
                    let kinds = [
                        "fn",
                        "struct",
                        "enum",
                        "trait",
                        "const",
                        "static",
                        "type",
                        "macro_rules",
                    ];
                    if kinds.contains(&before) {
                        defined.insert(tokens[at].text.clone());
                    }
                    body.push(tokens[at].clone());
                    at += 1;
                }
            }
        }
        let file = file.to_owned();
        Self {
            file,
            body,
            children,
            defined,
            imports,
        }
    }

    /// Paths of its body, each of at least two words.
    fn paths(&self) -> Vec<Vec<String>> {
        let word = |at: usize| self.body.get(at).map_or("", |token| token.text.as_str());
        let (mut found, mut at) = (Vec::new(), 0);
        while at < self.body.len() {
            let seen = at >= 3 && [word(at - 3), word(at - 2), word(at - 1)] == ["pub", "(", "in"];
            let mut path = vec![word(at).to_owned()];
            while word(at + 1) == "::" {
                at += 2;
                path.push(word(at).to_owned());
            }
            if path.len() > 1 && !seen {
                found.push(path);
            }
            at += 1;
        }
        found
    }
}

impl Modules {
    /// Those that are declared, from the crate's root on.
    fn new(sources: &Sources) -> Self {
        let mut found = BTreeMap::new();
        let mut wanted = vec![Vec::new()];
        while let Some(path) = wanted.pop() {
            let name = path.join("/");
            let files = match path.is_empty() {
                true => ["lib.rs".to_owned(), String::new()],
                false => [format!("{name}.rs"), format!("{name}/mod.rs")],
            };
            let Some(file) = files.iter().find(|file| sources.contains_key(*file)) else {
                panic!("{name} is declared, but has no file");
            };
            let module = Module::new(file, &sources[file]);
            for child in &module.children {
                wanted.push([path.clone(), vec![child.clone()]].concat());
            }
            found.insert(path, module);
        }
        Self(found)
    }

    fn child(&self, of: &[String], name: &str) -> Option<Vec<String>> {
        let path = [of, &[name.to_owned()]].concat();
        self.0.contains_key(&path).then_some(path)
    }

    /// What a path that stands in a module leads to; nothing, if out of the crate. `depth` ends names that re-export each other.
    fn resolve(&self, from: &[String], path: &[String], depth: usize) -> Option<Target> {
        let (head, rest) = path.split_first()?;
        let start = match head.as_str() {
            "crate" => Target::Module(Vec::new()),
            "self" => Target::Module(from.to_vec()),
            "super" => Target::Module(from[..from.len().checked_sub(1)?].to_vec()),
            name => self.name(from, name, depth)?,
        };
        rest.iter().try_fold(start, |target, name| match &target {
            Target::Item(_) => Some(target),
            Target::Module(module) if name == "super" => {
                Some(Target::Module(module[..module.len() - 1].to_vec()))
            }
            Target::Module(module) => self.name(module, name, depth),
        })
    }

    /// What a name in a module stands for.
    fn name(&self, module: &[String], name: &str, depth: usize) -> Option<Target> {
        let here = self.0.get(module)?;
        if let Some(child) = self.child(module, name) {
            return Some(Target::Module(child));
        }
        if here.defined.contains(name) {
            return Some(Target::Item(module.to_vec()));
        }
        let depth = depth.checked_sub(1)?;
        let imports = here.imports.iter();
        imports
            .filter(|import| import.name == name || import.name == "*")
            .find_map(|import| {
                if import.name == name && import.path[0] != name {
                    return self.resolve(module, &import.path, depth);
                }
                let all = self.resolve(module, &import.path, depth);
                match all.filter(|_| import.name == "*")? {
                    Target::Module(other) if other != module => self.name(&other, name, depth),
                    _ => None,
                }
            })
    }

    /// Files that each file imports.
    fn edges(&self) -> BTreeMap<&str, BTreeSet<&str>> {
        let edges = self.0.iter().map(|(path, module)| {
            let words: BTreeSet<&str> = module.body.iter().map(|it| it.text.as_str()).collect();
            let mut used = module.paths();
            for import in &module.imports {
                match import.name.as_str() {
                    "*" => used.extend(
                        words
                            .iter()
                            .map(|word| [import.path.clone(), vec![(*word).to_owned()]].concat()),
                    ),
                    name if !import.public || words.contains(name) => {
                        used.push(import.path.clone());
                    }
                    _ => (),
                }
            }
            let targets = used.iter().filter_map(|it| self.resolve(path, it, 8));
            let targets = targets.filter_map(|target| match target {
                Target::Item(module) => Some(self.0[&module].file.as_str()),
                Target::Module(_) => None,
            });
            let others = targets.filter(|file| *file != module.file);
            (module.file.as_str(), others.collect())
        });
        edges.collect()
    }
}

/// Files that the crate is made of, those for tests only left out.
pub fn product_files(sources: &Sources) -> BTreeSet<String> {
    let modules = Modules::new(sources).0;
    modules.into_values().map(|module| module.file).collect()
}

/// Groups of files that all import one another, by whatever way.
fn circles(sources: &Sources) -> Vec<BTreeSet<String>> {
    let modules = Modules::new(sources);
    let edges = modules.edges();
    let reached = |from: &str| {
        let mut seen = BTreeSet::new();
        let mut wanted: Vec<&str> = edges[from].iter().copied().collect();
        while let Some(file) = wanted.pop() {
            if seen.insert(file) {
                wanted.extend(&edges[file]);
            }
        }
        seen
    };
    let reached: BTreeMap<&str, BTreeSet<&str>> =
        edges.keys().map(|file| (*file, reached(file))).collect();
    let circle = |file: &str| {
        let others = reached[file].iter();
        let others = others.filter(|other| reached[*other].contains(file));
        others.map(|other| (*other).to_owned()).collect()
    };
    let circles: BTreeSet<BTreeSet<String>> = edges.keys().map(|file| circle(file)).collect();
    // That of a file in no circle is empty.
    let circles = circles.into_iter();
    circles.filter(|circle| !circle.is_empty()).collect()
}

/// The imports within a circle, to be read.
fn reported(sources: &Sources, circle: &BTreeSet<String>) -> String {
    let modules = Modules::new(sources);
    let edges = modules.edges();
    let line = |file: &String| {
        let inside = edges[file.as_str()]
            .iter()
            .filter(|it| circle.contains(**it));
        format!(
            "  {file} -> {}\n",
            inside.copied().collect::<Vec<_>>().join(", ")
        )
    };
    circle.iter().map(line).collect()
}

#[test]
fn no_files_import_one_another_in_a_circle() {
    let sources = sources();
    let found = circles(&sources);
    let text: Vec<String> = found
        .iter()
        .map(|circle| reported(&sources, circle))
        .collect();
    assert!(found.is_empty(), "circles of imports:\n{}", text.join("\n"));
}

/// Files of a small crate.
fn planted(files: &[(&str, &str)]) -> Sources {
    let file = |(name, text): &(&str, &str)| ((*name).to_owned(), tokens(text));
    files.iter().map(file).collect()
}

/// The imports of one of its files.
fn imported(files: &[(&str, &str)], by: &str) -> Vec<String> {
    let modules = Modules::new(&planted(files));
    let found = &modules.edges()[by];
    found.iter().map(|file| (*file).to_owned()).collect()
}

#[test]
fn planted_circles_of_three_and_of_two_are_found() {
    let found = |last: &'static str| {
        circles(&planted(&[
            ("lib.rs", "mod a; mod b; mod c; mod d;"),
            ("a.rs", "use crate::b::B; pub struct A;"),
            ("b.rs", "pub struct B; fn f() { super::c::g() }"),
            ("c.rs", last),
            ("d.rs", "use crate::{a::A, b::B};"),
        ]))
    };
    let of = |files: &[&str]| -> BTreeSet<String> {
        files.iter().map(|file| (*file).to_owned()).collect()
    };
    let three = "use crate::{d, a::{self as x}}; pub fn g() { x::A; d::nothing }";
    assert_eq!(found(three), [of(&["a.rs", "b.rs", "c.rs"])]);
    let two = "use crate::b::B; pub fn g() {}";
    assert_eq!(found(two), [of(&["b.rs", "c.rs"])]);
    assert!(found("pub fn g() {}").is_empty());
}

#[test]
fn a_name_is_followed_to_the_file_that_defines_it() {
    let files = |by: &'static str| {
        [
            ("lib.rs", "mod a; mod b;"),
            (
                "a/mod.rs",
                "mod x; mod y; pub use x::{X, x}; pub use y::*; pub struct Own; pub use self::x::X as Z;",
            ),
            (
                "a/x.rs",
                "pub struct X; impl X { pub fn new() {} } pub fn x() {}",
            ),
            (
                "a/y.rs",
                "pub(in super::super) fn v() {} pub const W: u8 = 1; pub mod deep;",
            ),
            ("a/y/deep.rs", "pub fn d() { super::super::Own }"),
            ("b.rs", by),
        ]
    };
    for (by, expected) in [
        ("use crate::a::X;", &["a/x.rs"][..]),
        ("use super::a::{X, v};", &["a/x.rs", "a/y.rs"]),
        ("use crate::a::{self, Own};", &["a/mod.rs"]),
        ("use crate::a; fn f() { a::Z::new() }", &["a/x.rs"]),
        ("use crate::a::Z as Q;", &["a/x.rs"]),
        ("fn f() { crate::a::deep::d() }", &["a/y/deep.rs"]),
        ("use crate::a::*; fn f() { W }", &["a/y.rs"]),
        ("pub use crate::a::X;", &[]),
        ("pub use crate::a::X; fn f(x: X) {}", &["a/x.rs"]),
        (
            "use std::a::X; use serde::Own; fn f() { X::a(); other::a::Own }",
            &[],
        ),
    ] {
        assert_eq!(imported(&files(by), "b.rs"), expected, "{by}");
    }
    assert_eq!(imported(&files(""), "a/y/deep.rs"), ["a/mod.rs"]);
    assert!(imported(&files(""), "lib.rs").is_empty());
    assert!(imported(&files(""), "a/mod.rs").is_empty());
    assert!(imported(&files(""), "a/y.rs").is_empty());
}
