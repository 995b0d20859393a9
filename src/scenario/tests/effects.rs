//! Effects of a file, in a rig: a list since schema 2, by their names before.

use std::path::Path;

use super::super::rig_file::tests::RIG;
use super::super::rig_file::{RigFile, from_text};
use crate::plant::Moment;

fn read(effects: &str) -> Result<RigFile, String> {
    let text = RIG.replace("schema = 1", "schema = 2") + "\n" + effects;
    from_text(Path::new("rig.toml"), &text).map_err(|error| error.to_string())
}

const OWN: &str = "\
[[effect]]
name = \"one_way_damping\"
acts_on = \"piston_force\"
is = \"-c * max(v, 0) + k * x\"
c = { value = 200, min = 0, max = 1000, unit = \"N s/m\" }
k = -30
";

#[test]
fn a_list_says_what_names_said_before() {
    let listed = "[[effect]]\nname = \"tool_runout\"\nfrequency_hz = 120\nsine_mm = 0.1\ncosine_m = 0\n\
        [[effect]]\nname = \"axial_force_offset\"\nforce_n = { value = -20, low = -21, high = -19 }\n";
    let named = RIG.to_owned()
        + "\n[effect.tool_runout]\nfrequency_hz = 120\nsine_m = 1e-4\ncosine_m = 0\n\
        [effect.axial_force_offset]\nforce_n = { value = -20, low = -21, high = -19 }\n";
    let old = from_text(Path::new("rig.toml"), &named).unwrap();
    let new = read(listed).unwrap();
    assert_eq!(new.plant, old.plant);
    assert_eq!(new.plant.contact.runout.sine, 1e-4);
    let names: Vec<&str> = new.effects.iter().map(|e| e.effect.name).collect();
    assert_eq!(names, ["axial_force_offset", "tool_runout"]);
}

#[test]
fn a_law_of_one_s_own_acts_and_its_free_numbers_are_those_with_a_range() {
    let rig = read(OWN).unwrap();
    let moment = Moment {
        stroke: 0.1,
        speed: 0.5,
        ..Moment::default()
    };
    let force = rig.plant.own[0].at(&moment);
    assert!((force - (-100.0 - 3.0)).abs() < 1e-9, "{force}");
    let [present] = &rig.effects[..] else {
        panic!("{:?}", rig.effects);
    };
    let parameters = present.effect.parameters(&rig.plant);
    let [only] = &parameters[..] else {
        panic!("{parameters:?}");
    };
    assert_eq!((only.quantity.name, only.bounds), ("c", [0.0, 1000.0]));
    assert_eq!(present.values, [200.0]);
    let mut plant = rig.plant.clone();
    only.quantity.set(&mut plant, 400.0);
    assert!((plant.own[0].at(&moment) - (-200.0 - 3.0)).abs() < 1e-9);
}

#[test]
#[expect(clippy::too_many_lines, reason = "a table")]
fn what_cannot_be_is_refused_with_its_place() {
    let line = RIG.lines().count() + 2;
    let own = |from: &str, to: &str| {
        assert!(OWN.contains(from), "{from}");
        OWN.replace(from, to)
    };
    let runout = |extra: &str| {
        format!(
            "[[effect]]\nname = \"tool_runout\"\nfrequency_hz = 120\nsine_m = 1e-4\ncosine_m = 0\n{extra}"
        )
    };
    for (text, row, said) in [
        (
            "[effect.joint_friction_3]\nfriction_n_m = 20\n".to_owned(),
            0,
            "`effect.joint_friction_3` is the form of schema 1, expected [[effect]] with name = \"joint_friction\", joint = 3, friction_n_m = 20, each on a line of its own",
        ),
        (
            "[[effect]]\nname = \"tool_runot\"\n".to_owned(),
            1,
            "did you mean `tool_runout`?",
        ),
        (
            "[[effect]]\nsize = 1\n".to_owned(),
            0,
            "`effect[0].name` is missing",
        ),
        (runout("joint = 2\n"), 5, "tool_runout is not of a joint"),
        (runout("sine_mm = 0.1\n"), 5, "sine_m says it already"),
        (runout("size = 1\n"), 5, "unknown key `effect[0].size`"),
        (
            runout("").replace("1e-4", "\"much\""),
            3,
            "`effect[0].sine_m` is \"much\", expected a number",
        ),
        (
            runout("").replace("sine_m = 1e-4", "sine_mm = 1e4"),
            3,
            "`effect[0].sine_mm` is 10000 mm, expected",
        ),
        (
            runout("") + &runout(""),
            6,
            "`effect[1].name` cannot stand here: tool_runout stands in its place already",
        ),
        (
            own("one_way_damping", "tool_runout"),
            1,
            "a name that no effect of the catalogue has",
        ),
        (
            own("piston_force", "piston"),
            2,
            "expected one of piston_force, friction, set_pressure, outlet_pressure",
        ),
        (
            own("max(v", "mox(v"),
            3,
            "`effect[0].is`, at `mox(v, 0)`: there is no function mox",
        ),
        (
            own("* x", "* y"),
            3,
            "at `y`: there is no `y` here, expected one of t, x, v",
        ),
        (
            own("+ k * x", "+ k * x /"),
            3,
            "at `its end`: expected a number",
        ),
        (own("* x", "* x / t"), 3, "at `k * x / t`: it is not finite"),
        (
            own("N s/m", "N s"),
            3,
            "at `-c * max(v, 0) + k * x`: it is in N m, expected N",
        ),
        (own("N s/m", "N s/mm"), 4, "it has \"mm\""),
        (
            own("min = 0", "min = 300"),
            4,
            "`effect[0].c.min` is 300, expected at most the value, 200",
        ),
        (own("min = 0, ", ""), 4, "`effect[0].c.min` is missing"),
        (
            own("k = -30", "q = -30"),
            5,
            "`q` is air that enters in an expression",
        ),
        (
            own("k = -30", "k = -30\nj = 1"),
            6,
            "the expression has no `j`",
        ),
    ] {
        let error = read(&text).unwrap_err();
        assert!(error.contains(said), "{text}{error}");
        let location = format!("rig.toml:{}:", line + row);
        assert!(error.starts_with(&location), "{location} {error}");
    }
    let error = read(&own("max(v", "mox(v")).unwrap_err();
    let column = "is = \"-c * ".len() + 1;
    assert!(
        error.starts_with(&format!("rig.toml:{}:{column}:", line + 3)),
        "{error}"
    );
}

#[test]
fn the_page_of_the_files_has_every_port_and_variable() {
    let page = std::fs::read_to_string("scenarios/README.md").unwrap();
    for symbol in &crate::plant::SYMBOLS {
        let row = format!("| {} | {} | {}", symbol.name, symbol.unit, symbol.meaning);
        assert!(page.contains(&row), "{row}");
    }
    let (_, ports) = page.split_once("| port (`acts_on`)").unwrap();
    let (ports, _) = ports.split_once("| variable").unwrap();
    for port in crate::plant::Port::ALL {
        assert!(ports.contains(port.name()), "{port:?}");
    }
}
