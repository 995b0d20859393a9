//! URDF files that claim more than an arm has: memory, stack and time are bounded by the file, messages by a line.

use std::fs;
use std::time::{Duration, Instant};

use super::{Arm, ArmOptions, draft_of, load_arm};

/// Longest time for one of these files; without its bound each took minutes, or overflowed the stack.
const PATIENCE: Duration = Duration::from_secs(20);

const LIMIT: &str = "<limit lower=\"-2\" upper=\"2\" effort=\"400\" velocity=\"3\"/>";
const MASS: &str = "<inertial><origin xyz=\"0 0 0.1\"/><mass value=\"3\"/><inertia ixx=\"0.03\" ixy=\"0\" ixz=\"0\" iyy=\"0.03\" iyz=\"0\" izz=\"0.03\"/></inertial>";

/// A chain of joints, each 0.2 m behind the one before and across it, with a fixed flange.
fn chain(count: usize) -> String {
    let mut text = String::from("<robot name=\"chain\"><link name=\"l0\"/>");
    for index in 1..=count {
        let turn = if index % 2 == 0 { 1.5 } else { -1.5 };
        text += &format!(
            "<joint name=\"j{index}\" type=\"revolute\"><origin xyz=\"0 0 0.2\" rpy=\"{turn} 0 0\"/><parent link=\"l{}\"/><child link=\"l{index}\"/><axis xyz=\"0 0 1\"/>{LIMIT}</joint>\n<link name=\"l{index}\">{MASS}</link>\n",
            index - 1
        );
    }
    text + &format!(
        "<joint name=\"mount\" type=\"fixed\"><parent link=\"l{count}\"/><child link=\"flange\"/></joint><link name=\"flange\"/></robot>"
    )
}

fn load(text: &str) -> Result<Arm, String> {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("arm.urdf");
    fs::write(&file, text).unwrap();
    let options = ArmOptions {
        tip_link: "flange".into(),
        ..ArmOptions::default()
    };
    let begin = Instant::now();
    let loaded = load_arm(&file, &options).map_err(|error| error.to_string());
    // A draft looks for the flange itself, among all links.
    let _ = draft_of(&file);
    assert!(begin.elapsed() < PATIENCE, "{:?}", begin.elapsed());
    loaded
}

fn refusal(text: &str) -> String {
    let message = load(text).unwrap_err();
    assert!(message.len() < 2000, "{} letters", message.len());
    message
}

fn with(extra: &str) -> String {
    chain(6).replace("</robot>", &format!("{extra}</robot>"))
}

#[test]
fn deep_wide_and_expanding_xml_is_refused_with_its_line() {
    for open in ["<x>", "<x a=\"/>\">", "<!-- </x> --><x>"] {
        let deep = format!("\n{}{}", open.repeat(30_000), "</x>".repeat(30_000));
        let said = refusal(&with(&deep));
        assert!(said.contains("400 deep") && said.contains(":14:"), "{said}");
    }
    let attributes: String = (0..200_000).map(|own| format!(" a{own}=\"\"")).collect();
    assert!(refusal(&with(&format!("<x{attributes}/>"))).contains("200000 attributes"));
    let entity = format!(
        "<!DOCTYPE robot [<!ENTITY a \"{}\">]>",
        "x".repeat(1_000_000)
    );
    let bomb = entity + &with(&format!("<x>{}</x>", "&a;".repeat(5000)));
    assert!(refusal(&bomb).contains("<!ENTITY"));
}

#[test]
fn chains_rings_and_crowds_are_refused_in_a_line() {
    assert!(load(&chain(6)).is_ok());
    let said = refusal(&chain(300));
    assert!(said.contains("300 moving joints (j1, j2,"), "{said}");
    assert!(said.contains("and 280 more"), "{said}");
    assert!(refusal(&chain(5000)).contains("2000 links and joints"));
    let crowd = |count: usize| -> String {
        let one = |own: usize| {
            format!(
                "<link name=\"k{own}\"/><joint name=\"m{own}\" type=\"fixed\"><parent link=\"l0\"/><child link=\"k{own}\"/></joint>\n"
            )
        };
        (0..count).map(one).collect()
    };
    assert!(load(&with(&crowd(900))).is_ok());
    assert!(refusal(&with(&crowd(100_000))).contains("2000 links and joints"));
    let ring =
        "<joint name=\"r\" type=\"fixed\"><parent link=\"flange\"/><child link=\"l0\"/></joint>";
    assert!(refusal(&with(ring)).contains("form a ring"));
    let finger = |own: usize, other: usize| {
        format!(
            "<link name=\"f{own}\"/><joint name=\"m{own}\" type=\"revolute\"><parent link=\"flange\"/><child link=\"f{own}\"/><axis xyz=\"0 0 1\"/>{LIMIT}<mimic joint=\"m{other}\"/></joint>"
        )
    };
    let mimics = finger(1, 2) + &finger(2, 3) + &finger(3, 1);
    assert!(refusal(&with(&mimics)).contains("mimics"));
}

#[test]
fn numbers_that_no_arm_has_are_refused_before_a_search_starts_with_them() {
    let edited = |from: &str, to: &str| {
        let text = chain(6);
        assert!(text.contains(from), "{from}");
        refusal(&text.replacen(from, to, 1))
    };
    let shape = |shape: &str| {
        let body = format!("<collision><geometry>{shape}</geometry></collision>");
        edited(MASS, &format!("{MASS}{body}"))
    };
    for (said, expected) in [
        (
            edited("xyz=\"0 0 0.2\"", "xyz=\"0 0 1e8\""),
            "origin of joint `j1` is 1.000e8 m",
        ),
        (
            edited("xyz=\"0 0 0.1\"", "xyz=\"0 0 -1e200\""),
            "inertial origin of link `l1`",
        ),
        (
            edited("mass value=\"3\"", "mass value=\"1e12\""),
            "mass of link `l1` is 1.000e12 kg",
        ),
        (
            edited("izz=\"0.03\"", "izz=\"1e300\""),
            "inertia of link `l1`",
        ),
        (
            edited("</joint>", "<dynamics damping=\"1e300\"/></joint>"),
            "damping of joint `j1`",
        ),
        (
            shape("<box size=\"1e300 1 1\"/>"),
            "collision box of link `l1`",
        ),
        (
            shape("<capsule radius=\"1\" length=\"1e9\"/>"),
            "collision capsule of link `l1`",
        ),
    ] {
        assert!(said.contains(expected), "{said}");
        assert!(said.contains("expected at most 1e"), "{said}");
    }
    let name = "l".repeat(3_000_000);
    let named = chain(6).replace("\"l1\"", &format!("\"{name}\""));
    assert!(refusal(&named).contains("3000000 letters, expected 1000 at most"));
    let value = edited(
        "effort=\"400\"",
        &format!("effort=\"{}\"", "z".repeat(3_000_000)),
    );
    assert!(value.contains("zz.."), "{value}");
}

#[test]
fn what_belongs_to_a_link_may_stand_in_any_order() {
    let visual = |size: f64| {
        format!("<visual><geometry><box size=\"{size} {size} {size}\"/></geometry></visual>")
    };
    let body = "<collision><geometry><sphere radius=\"0.05\"/></geometry></collision>";
    let mixed = format!(
        "{}{body}{MASS}{}{body}{}",
        visual(0.1),
        visual(0.2),
        visual(0.3)
    );
    let arm = load(&chain(6).replacen(MASS, &mixed, 1)).unwrap();
    assert_eq!(arm.visuals.len(), 3);
    assert_eq!(arm.collisions.len(), 2);
    assert_eq!(arm.chain.joints[0].body.mass, 3.0);
}

#[test]
fn absent_limits_are_none_from_version_1_2_on() {
    let open = chain(6).replacen("lower=\"-2\" upper=\"2\" ", "", 1);
    let said = refusal(&open);
    assert!(said.contains("position limits 0 to 0"), "{said}");
    let arm = load(&open.replacen("name=\"chain\"", "name=\"chain\" version=\"1.2\"", 1)).unwrap();
    assert_eq!(arm.chain.joints[0].upper, f64::INFINITY);
    assert_eq!(arm.chain.joints[1].upper, 2.0);
}
