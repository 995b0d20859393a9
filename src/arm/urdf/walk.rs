//! A strict walk over the XML tree of a URDF file: every element and attribute is one that is read, is passed over by name, or is refused by name.

use std::collections::{BTreeMap, BTreeSet};

use roxmltree::{Attribute as Given, Document, Node};

use super::format::{
    Absent, Count, ELEMENTS, Element, Form, JOINT_TYPES, OTHER_FORMATS, PASSED_OVER, ROBOT,
};
use crate::xml::{Lines, shown};

/// Most links and joints together: a humanoid with both hands has some 200.
const MOST_PARTS: usize = 2000;
/// Most letters of a name or a path.
const LONGEST: usize = 1000;

/// A fault at a line of the file.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Fault {
    pub line: u32,
    pub words: String,
    /// Whether the program `xacro` would mend it.
    pub xacro: bool,
}

/// What a URDF file holds beside what the parser reads.
#[derive(Debug)]
pub(super) struct Walked {
    pub notes: Vec<String>,
    /// Lines of links and joints, by what and name.
    pub lines: BTreeMap<(&'static str, String), u32>,
    /// Joints that close a loop: line, name, and the links that they join.
    pub loops: Vec<(u32, String, Vec<String>)>,
    /// Links whose file gives a mass, but no inertia.
    pub without_inertia: Vec<String>,
    /// Elements that are left out of the robot, by their numbers in the tree.
    pub left_out: BTreeSet<usize>,
    rows: Lines,
    passed: BTreeMap<String, Vec<u32>>,
    put: BTreeMap<String, Vec<u32>>,
}

/// Walks over a document.
pub(super) fn walk(document: &Document) -> Result<Walked, Fault> {
    let mut walked = Walked {
        notes: Vec::new(),
        lines: BTreeMap::new(),
        loops: Vec::new(),
        without_inertia: Vec::new(),
        left_out: BTreeSet::new(),
        rows: Lines::of(document.input_text()),
        passed: BTreeMap::new(),
        put: BTreeMap::new(),
    };
    let root = document.root_element();
    let line = walked.line_of(root);
    if root.tag_name().name() != ROBOT.name {
        let found = root.tag_name().name();
        let what = match found {
            "sdf" => " of the format SDF",
            "mujoco" => " of the format MJCF",
            "COLLADA" => " of a COLLADA mesh",
            _ => "",
        };
        return Err(fault(
            line,
            format!("its root element is <{found}>{what}, expected <robot>"),
        ));
    }
    walked.element(root, &ROBOT, "the robot")?;
    if !root.children().any(|child| child.has_tag_name("link")) {
        let macros = "it defines no <link>: a file of macros alone, perhaps; expected the robot's links and joints";
        return Err(fault(line, macros.to_owned()));
    }
    walked.sum_up();
    Ok(walked)
}

fn fault(line: u32, words: String) -> Fault {
    Fault {
        line,
        words,
        xacro: false,
    }
}

/// The name nearest to a misspelt one.
fn nearest<'a>(word: &str, names: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let lower = word.to_lowercase();
    let near = names.filter_map(|name| {
        let distance = strsim::damerau_levenshtein(&lower, &name.to_lowercase());
        (distance <= (name.len() / 3).max(1)).then_some((distance, name))
    });
    near.min_by_key(|(distance, _)| *distance)
        .map(|(_, name)| name)
}

fn listed<'a>(names: impl Iterator<Item = &'a str>) -> String {
    names.collect::<Vec<_>>().join(", ")
}

/// Lines in words: the first few of them.
fn lines_in_words(lines: &[u32]) -> String {
    const SHOWN: usize = 3;
    let first: Vec<String> = lines.iter().take(SHOWN).map(u32::to_string).collect();
    match lines.len() {
        1 => format!("line {}", first[0]),
        count if count > SHOWN => format!("lines {} and {} more", first.join(", "), count - SHOWN),
        _ => format!("lines {}", first.join(", ")),
    }
}

impl Walked {
    fn line_of(&self, node: Node) -> u32 {
        self.rows.at(node.range().start)
    }

    fn sum_up(&mut self) {
        for (what, lines) in &self.passed {
            self.notes
                .push(format!("not used: {what} ({})", lines_in_words(lines)));
        }
        for (what, lines) in &self.put {
            self.notes
                .push(format!("{what} ({})", lines_in_words(lines)));
        }
    }

    fn pass_over(&mut self, what: String, line: u32) {
        self.passed.entry(what).or_default().push(line);
    }

    fn element(&mut self, node: Node, element: &Element, owner: &str) -> Result<(), Fault> {
        let line = self.line_of(node);
        let named = |kind: &'static str| node.attribute("name").map(|name| (kind, name.to_owned()));
        let own = match element.name {
            "link" => named("link"),
            "joint" => named("joint"),
            _ => None,
        };
        let owner = match &own {
            Some((kind, name)) => format!("{kind} `{}`", shown(name)),
            None => owner.to_owned(),
        };
        if let Some((kind, name)) = own {
            if let Some(first) = self.lines.get(&(kind, name.clone())) {
                let twice = format!(
                    "{kind} `{}` is defined twice, the first time on line {first}",
                    shown(&name)
                );
                return Err(fault(line, twice));
            }
            self.lines.insert((kind, name), line);
            if self.lines.len() > MOST_PARTS {
                let words =
                    format!("it has more than {MOST_PARTS} links and joints, expected fewer");
                return Err(fault(line, words));
            }
        }
        for attribute in node.attributes() {
            self.attribute(attribute, element, &owner)?;
        }
        self.absent_attributes(node, element, &owner)?;
        let mut counts = vec![0; element.children.len()];
        for child in node.children() {
            if child.is_element() {
                self.child(child, element, &owner, &mut counts)?;
            } else if let Some(text) = child.text().filter(|_| child.is_text())
                && !text.trim().is_empty()
            {
                let line = self.line_of(child);
                let shown: String = text.trim().chars().take(30).collect();
                let words = format!(
                    "{owner}: <{}> holds the text \"{shown}\", expected {}",
                    element.name,
                    inside(element)
                );
                return Err(fault(line, words));
            }
        }
        for (child, count) in element.children.iter().zip(counts) {
            if child.count == Count::Once && count == 0 {
                let (inner, outer) = (child.element.name, element.name);
                let words = format!("{owner}: <{outer}> has no <{inner}>, expected one");
                return Err(fault(line, words));
            }
        }
        self.own_rules(node, element, &owner)
    }

    fn child(
        &mut self,
        node: Node,
        outer: &Element,
        owner: &str,
        counts: &mut [usize],
    ) -> Result<(), Fault> {
        let line = self.line_of(node);
        let name = node.tag_name().name();
        if let Some(space) = node.tag_name().namespace() {
            if is_xacro(space) {
                return Err(Fault {
                    line,
                    words: format!("<xacro:{name}> is left in the file"),
                    xacro: true,
                });
            }
            self.pass_over(format!("<{name}> of the namespace {space}"), line);
            self.left_out.insert(node.id().get_usize());
            return Ok(());
        }
        let known = |child: &super::format::Child| child.element.name == name;
        if let Some(index) = outer.children.iter().position(known) {
            let child = &outer.children[index];
            counts[index] += 1;
            if child.count != Count::Any && counts[index] > 1 {
                let words = format!(
                    "{owner}: <{}> has a second <{name}>, expected one",
                    outer.name
                );
                return Err(fault(line, words));
            }
            if name == "calibration" {
                self.pass_over(format!("<{name}> in <{}>", outer.name), line);
            }
            return self.element(node, child.element, owner);
        }
        self.unknown(node, outer, owner)
    }

    /// An element that the format does not have here.
    fn unknown(&mut self, node: Node, outer: &Element, owner: &str) -> Result<(), Fault> {
        let (line, name) = (self.line_of(node), node.tag_name().name());
        let refused = |expected: String| {
            let words = format!(
                "{owner}: <{name}> is no element of <{}>; {expected}",
                outer.name
            );
            Err(fault(line, words))
        };
        let passed = PASSED_OVER.iter().find(|(place, _)| *place == outer.name);
        let is_passed = passed.is_some_and(|(_, names)| names.contains(&name));
        if outer.exact {
            return refused(format!("expected {}", inside(outer)));
        }
        if name == "loop_joint" && is_passed {
            let joined = node
                .children()
                .filter_map(|child| Some(child.attribute("link")?.to_owned()));
            let name = node.attribute("name").unwrap_or_default().to_owned();
            self.loops.push((line, name, joined.collect()));
            self.left_out.insert(node.id().get_usize());
            return Ok(());
        }
        if !is_passed {
            let expected = || outer.children.iter().map(|child| child.element.name);
            if let Some(meant) = nearest(name, expected()) {
                return refused(format!("did you mean <{meant}>?"));
            }
            if ELEMENTS.contains(&name) || outer.name == "geometry" {
                return refused(format!("expected {}", inside(outer)));
            }
            if let Some((_, instead)) = OTHER_FORMATS.iter().find(|(other, _)| *other == name) {
                return refused(format!("URDF has {instead} for it"));
            }
            let weighty = |inner: Node| {
                ["link", "joint", "inertial", "mass"].contains(&inner.tag_name().name())
            };
            if let Some(inner) = node.descendants().skip(1).find(|inner| weighty(*inner)) {
                let inner = inner.tag_name().name();
                return refused(format!("the <{inner}> in it would be left out"));
            }
        }
        // Simulators take joints of another format from there, which may close a chain.
        let closes = |inner: &Node| {
            inner.has_tag_name("joint") && inner.children().any(|own| own.has_tag_name("parent"))
        };
        let what = match node.descendants().find(closes) {
            Some(joint) => format!(
                "<{name}> in <{}> with a joint `{}` of its own in it",
                outer.name,
                joint.attribute("name").unwrap_or_default()
            ),
            None => format!("<{name}> in <{}>", outer.name),
        };
        self.pass_over(what, line);
        self.left_out.insert(node.id().get_usize());
        Ok(())
    }

    fn attribute(&mut self, given: Given, element: &Element, owner: &str) -> Result<(), Fault> {
        let line = self.rows.at(given.range().start);
        let (name, value) = (given.name(), given.value());
        if value.contains("${") || value.contains("$(") {
            return Err(Fault {
                line,
                words: format!(
                    "{owner}: {name}=\"{}\" is left to be evaluated",
                    shown(value)
                ),
                xacro: true,
            });
        }
        if given.namespace().is_some() {
            self.pass_over(format!("{name} of another namespace"), line);
            return Ok(());
        }
        let Some(known) = element.attributes.iter().find(|known| known.name == name) else {
            let names = || element.attributes.iter().map(|known| known.name);
            let location = format!("{owner}: <{}> has no attribute `{name}`", element.name);
            if let Some(meant) = nearest(name, names()) {
                return Err(fault(line, format!("{location}; did you mean `{meant}`?")));
            }
            if element.exact {
                let words = format!("{location}, expected {}", listed(names()));
                return Err(fault(line, words));
            }
            self.pass_over(format!("{name} of <{}>", element.name), line);
            return Ok(());
        };
        let expected = match known.form {
            Form::Text => return Self::text(line, value, element, known.name, owner),
            Form::Number if value.trim().parse::<f64>().is_ok() => return Ok(()),
            Form::Number => "a number".to_owned(),
            Form::Numbers(count) => {
                let parts: Vec<&str> = value.split_whitespace().collect();
                let all = parts.iter().all(|part| part.parse::<f64>().is_ok());
                if all && parts.len() == count {
                    return Ok(());
                }
                format!("{count} numbers with spaces between them")
            }
        };
        let words = format!(
            "{owner}: <{}> has {name}=\"{}\", expected {expected}",
            element.name,
            shown(value)
        );
        Err(fault(line, words))
    }

    fn text(
        line: u32,
        value: &str,
        element: &Element,
        name: &str,
        owner: &str,
    ) -> Result<(), Fault> {
        let location = format!(
            "{owner}: <{}> has {name}=\"{}\"",
            element.name,
            shown(value)
        );
        if value.len() > LONGEST {
            let words = format!(
                "{location} of {} letters, expected {LONGEST} at most",
                value.len()
            );
            return Err(fault(line, words));
        }
        if element.name == "joint" && name == "type" && !JOINT_TYPES.contains(&value) {
            let expected = match nearest(value, JOINT_TYPES.into_iter()) {
                Some(meant) => format!("did you mean {meant}?"),
                None => format!("expected {}", listed(JOINT_TYPES.into_iter())),
            };
            return Err(fault(line, format!("{location}; {expected}")));
        }
        let may_be_empty = ["material", "visual", "collision", "robot", "texture"];
        if value.trim().is_empty() && !may_be_empty.contains(&element.name) {
            return Err(fault(line, format!("{location}, expected a name")));
        }
        Ok(())
    }

    fn absent_attributes(
        &mut self,
        node: Node,
        element: &Element,
        owner: &str,
    ) -> Result<(), Fault> {
        let line = self.line_of(node);
        for known in element.attributes {
            if node.has_attribute(known.name) {
                continue;
            }
            let name = known.name;
            match known.absent {
                Absent::Default | Absent::Put(_) => {}
                Absent::Refused => {
                    let words = format!("{owner}: <{}> has no {name}, expected one", element.name);
                    return Err(fault(line, words));
                }
                Absent::Noted(value) => {
                    let what = format!(
                        "{owner}: <{}> has no {name}, taken as {value}",
                        element.name
                    );
                    self.put.entry(what).or_default().push(line);
                }
            }
        }
        Ok(())
    }

    /// What an element says beyond its attributes.
    fn own_rules(&mut self, node: Node, element: &Element, owner: &str) -> Result<(), Fault> {
        match element.name {
            "visual" | "collision" => self.shape(node, element.name, owner),
            "inertial" => {
                let has = |name: &str| node.children().find(|child| child.has_tag_name(name));
                if let (Some(_), None) = (has("mass"), has("inertia")) {
                    let link = node
                        .parent_element()
                        .and_then(|link| link.attribute("name"));
                    self.without_inertia.extend(link.map(str::to_owned));
                }
                Ok(())
            }
            _ => Ok(()),
        }
    }

    /// A shape: left out, with a note, where it has no extent.
    fn shape(&mut self, node: Node, role: &str, owner: &str) -> Result<(), Fault> {
        let line = self.line_of(node);
        let geometry = node.children().find(|child| child.has_tag_name("geometry"));
        let shapes: Vec<Node> = geometry
            .iter()
            .flat_map(|geometry| geometry.children().filter(Node::is_element))
            .collect();
        let fault_of = |words: String| Err(fault(line, words));
        let why = match &shapes[..] {
            [] => "has no geometry".to_owned(),
            [one] => {
                let sizes = ["size", "radius", "length"].into_iter();
                let sizes = sizes.filter_map(|name| one.attribute(name));
                let sizes: Vec<f64> = sizes
                    .flat_map(|text| text.split_whitespace().filter_map(|part| part.parse().ok()))
                    .collect();
                let name = one.tag_name().name();
                if sizes.iter().all(|size| *size > 0.0) || sizes.iter().any(|size| *size < 0.0) {
                    return Ok(());
                }
                let sizes: Vec<String> = sizes.iter().map(f64::to_string).collect();
                format!("is a {name} of {}, without extent", sizes.join(" x "))
            }
            _ => {
                return fault_of(format!(
                    "{owner}: the <geometry> of a {role} holds {} shapes, expected one",
                    shapes.len()
                ));
            }
        };
        let what = format!("{owner}: a {role} shape {why}: it is left out");
        self.put.entry(what).or_default().push(line);
        self.left_out.insert(node.id().get_usize());
        Ok(())
    }
}

/// What stands in an element, in words.
fn inside(element: &Element) -> String {
    let children = element.children.iter().map(|child| child.element.name);
    let names: Vec<String> = children.map(|name| format!("<{name}>")).collect();
    if names.is_empty() {
        let attributes = element.attributes.iter().map(|attribute| attribute.name);
        return format!("attributes alone ({})", listed(attributes));
    }
    names.join(", ")
}

/// Whether a namespace is that of xacro.
pub(super) fn is_xacro(namespace: &str) -> bool {
    namespace.trim_end_matches('/').ends_with("xacro")
}
