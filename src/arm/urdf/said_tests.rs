//! What a URDF file says is honoured, noted by name and line, or refused by name and line.

use std::fs;

use super::{Arm, ArmError, ArmOptions, draft_of, load_arm};

/// A wrist-partitioned arm whose links have lines of their own; the first joint is on line 3.
fn six_axes() -> String {
    let mut text = String::from("<robot name=\"six\">\n<link name=\"base\"/>\n");
    let axes = ["0 0 1", "0 1 0", "0 1 0", "1 0 0", "0 1 0", "1 0 0"];
    let origins = [
        "0 0 0.3",
        "0.1 0 0",
        "0 0 0.6",
        "0.1 0 0.1",
        "0.5 0 0",
        "0.1 0 0",
    ];
    for (index, (axis, origin)) in axes.iter().zip(origins).enumerate() {
        let (parent, child) = (index, index + 1);
        let parent = match parent {
            0 => "base".to_owned(),
            _ => format!("l{parent}"),
        };
        text += &format!(
            "<joint name=\"j{child}\" type=\"revolute\"><parent link=\"{parent}\"/><child link=\"l{child}\"/>\n\
             <origin xyz=\"{origin}\" rpy=\"0 0 0\"/><axis xyz=\"{axis}\"/>\n\
             <limit lower=\"-2\" upper=\"2\" effort=\"400\" velocity=\"3\"/></joint>\n\
             <link name=\"l{child}\"><inertial><mass value=\"3\"/>\n\
             <inertia ixx=\"0.03\" ixy=\"0\" ixz=\"0\" iyy=\"0.03\" iyz=\"0\" izz=\"0.03\"/></inertial></link>\n"
        );
    }
    text + "<joint name=\"mount\" type=\"fixed\"><parent link=\"l6\"/><child link=\"tool0\"/>\n\
            <origin xyz=\"0.05 0 0\" rpy=\"0 1.5707963 0\"/></joint>\n<link name=\"tool0\"/>\n</robot>\n"
}

fn edited(from: &str, to: &str) -> String {
    let text = six_axes();
    assert!(text.contains(from), "{from}");
    text.replacen(from, to, 1)
}

fn load(text: &str) -> Result<Arm, ArmError> {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("arm.urdf");
    fs::write(&file, text).unwrap();
    load_arm(
        &file,
        &ArmOptions {
            tip_link: "tool0".into(),
            ..ArmOptions::default()
        },
    )
}

fn drafted(text: &str) -> Result<super::ArmDraft, String> {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("arm.urdf");
    fs::write(&file, text).unwrap();
    draft_of(&file).map_err(|error| error.to_string())
}

#[test]
fn the_plain_arm_is_taken_without_a_note() {
    let arm = load(&six_axes()).unwrap();
    assert!(arm.notes.is_empty(), "{:?}", arm.notes);
    assert!(arm.estimated.is_empty());
}

#[test]
fn what_is_misspelt_or_of_another_format_is_refused_by_name_and_line() {
    let cases = [
        (
            "<origin xyz=\"0.1 0 0\"",
            "<orgin xyz=\"0.1 0 0\"",
            "joint `j2`: <orgin> is no element of <joint>; did you mean <origin>?",
        ),
        (
            "<origin xyz=\"0.1 0 0\"",
            "<Origin xyz=\"0.1 0 0\"",
            "did you mean <origin>?",
        ),
        (
            "rpy=\"0 0 0\"",
            "rpx=\"0 0 0\"",
            "joint `j1`: <origin> has no attribute `rpx`; did you mean `rpy`?",
        ),
        (
            "rpy=\"0 0 0\"",
            "quat_xyzw=\"0 0 0 1\"",
            "has no attribute `quat_xyzw`, expected xyz, rpy",
        ),
        (
            "rpy=\"0 0 0\"",
            "rpy=\"0 0\"",
            "rpy=\"0 0\", expected 3 numbers",
        ),
        ("rpy=\"0 0 0\"", "rpy=\"0,5 0 0\"", "expected 3 numbers"),
        ("rpy=\"0 0 0\"", "rpy=\"0 pi 0 0\"", "expected 3 numbers"),
        (
            "effort=\"400\"",
            "effort=\"400 N\"",
            "joint `j1`: <limit> has effort=\"400 N\", expected a number",
        ),
        ("effort=\"400\"", "efort=\"400\"", "did you mean `effort`?"),
        (
            "effort=\"400\"",
            "torque=\"400\"",
            "no attribute `torque`, expected lower, upper, effort",
        ),
        (
            "type=\"revolute\"",
            "type=\"Revolute\"",
            "did you mean revolute?",
        ),
        (
            "type=\"revolute\"",
            "type=\"hinge\"",
            "expected revolute, continuous",
        ),
        ("type=\"revolute\"", "", "<joint> has no type"),
        (
            "rpy=\"0 0 0\"/>",
            "><rpy>0 0 0</rpy></origin>",
            "<rpy> is no element of <origin>; expected attributes alone (xyz, rpy)",
        ),
        (
            "<mass value=\"3\"/>",
            "<mass>3</mass>",
            "link `l1`: <mass> has no value",
        ),
        (
            "<mass value=\"3\"/>",
            "<mas value=\"3\"/>",
            "did you mean <mass>?",
        ),
        (
            "<mass value=\"3\"/>",
            "<mass value=\"3\"/><mass value=\"4\"/>",
            "has a second <mass>",
        ),
    ];
    all_refused(&cases);
}

#[test]
fn content_in_the_wrong_place_is_refused_by_name_and_line() {
    let cases = [
        (
            "<link name=\"l1\"><inertial><mass value=\"3\"/>",
            "<link name=\"l1\"><mass value=\"3\"/><inertial>",
            "link `l1`: <mass> is no element of <link>",
        ),
        (
            "<link name=\"l1\">",
            "<link name=\"l1\"><pose>0 0 1 0 0 0</pose>",
            "URDF has <origin",
        ),
        (
            "<link name=\"l1\">",
            "<link name=\"l1\">text",
            "holds the text \"text\"",
        ),
        (
            "<link name=\"l1\">",
            "<link name=\"l1\"><visual><geometry><ellipsoid radii=\"1 1 2\"/></geometry></visual>",
            "<ellipsoid> is no element of <geometry>; expected <box>",
        ),
        (
            "<link name=\"l1\">",
            "<link name=\"l1\"><visual><geometry><box size=\"1 1 1\"/><sphere radius=\"1\"/></geometry></visual>",
            "holds 2 shapes",
        ),
        (
            "<link name=\"tool0\"/>",
            "<if value=\"1\"><link name=\"tool0\"/></if>",
            "the <link> in it would be left out",
        ),
        (
            "<link name=\"l2\">",
            "<link name=\"l1\">",
            "link `l1` is defined twice, the first time on line 6",
        ),
        (
            "name=\"j2\"",
            "name=\"j1\"",
            "joint `j1` is defined twice, the first time on line 3",
        ),
        (
            "<child link=\"l2\"/>",
            "<child link=\"l1\"/>",
            "child of both joint `j1` and joint `j2`",
        ),
        (
            "<parent link=\"l1\"/>",
            "",
            "joint `j2`: <joint> has no <parent>, expected one",
        ),
        (
            "<child link=\"l2\"/>",
            "<child link=\"\"/>",
            "<child> has link=\"\", expected a name",
        ),
    ];
    all_refused(&cases);
}

/// Each edit of the plain arm is refused with words and the file's line.
fn all_refused(cases: &[(&str, &str, &str)]) {
    for (from, to, words) in cases {
        let message = load(&edited(from, to)).unwrap_err().to_string();
        assert!(message.contains("arm.urdf:"), "{to}: {message}");
        assert!(message.contains(words), "{to}: {message}");
    }
}

#[test]
fn the_line_is_that_of_the_element() {
    // Each edit adds a word of its own, whose line is looked for in the text.
    for (from, to, mark) in [
        ("<axis xyz=\"1 0 0\"/>", "<axsi xyz=\"1 0 0\"/>", "<axsi"),
        ("value=\"3\"", "valeu=\"3\"", "valeu"),
        (
            "</robot>",
            "<joint name=\"last\" typ=\"fixed\"/></robot>",
            "typ=",
        ),
        ("lower=\"-2\"", "lwoer=\"-2\"", "lwoer"),
    ] {
        let text = edited(from, to);
        let line = 1 + text[..text.find(mark).unwrap()].matches('\n').count();
        let message = load(&text).unwrap_err().to_string();
        assert!(message.contains(&format!("arm.urdf:{line}: ")), "{message}");
    }
}

#[test]
fn faults_of_xml_are_reported_with_the_link_or_joint() {
    for (from, to, words) in [
        (
            "<axis xyz=\"0 0 1\"/>",
            "<axis xyz=\"0 0 1\">",
            "</joint> stands where <axis>, which was begun on line 4, is to be closed first",
        ),
        (
            "effort=\"400\"",
            "effort=\"400\" effort=\"500\"",
            "joint `j1` (begun on line 3): the attribute effort is given twice",
        ),
        (
            "effort=\"400\"",
            "effort=400",
            "joint `j1` (begun on line 3)",
        ),
        (
            "<mass value=\"3\"/>",
            "<mass value=\"3/>",
            "link `l1` (begun on line 6)",
        ),
        (
            "<mass value=\"3\"/>",
            "<mass value=\"&nope;\"/>",
            "link `l1` (begun on line 6)",
        ),
        (
            "</link>\n<joint name=\"j2\"",
            "\n<joint name=\"j2\"",
            "is to be closed first",
        ),
        (
            "<robot name=\"six\">",
            "<!DOCTYPE robot><robot name=\"six\">",
            "document type definition",
        ),
    ] {
        let message = load(&edited(from, to)).unwrap_err().to_string();
        assert!(message.contains("arm.urdf:"), "{message}");
        assert!(message.contains(words), "{to}: {message}");
    }
    let sdf = "<sdf version=\"1.6\"><model name=\"x\"/></sdf>";
    let message = load(sdf).unwrap_err().to_string();
    assert!(
        message.contains("<sdf> of the format SDF, expected <robot>"),
        "{message}"
    );
}

#[test]
fn what_other_programs_add_is_noted_by_name_and_changes_nothing() {
    let plain = load(&six_axes()).unwrap();
    for (extra, words) in [
        (
            "<gazebo reference=\"l1\"><mu1>0.2</mu1></gazebo>",
            "not used: <gazebo> in <robot> (line 36)",
        ),
        (
            "<transmission name=\"t\"><type>simple</type><joint name=\"j1\"/></transmission>",
            "<transmission> in <robot>",
        ),
        (
            "<ros2_control name=\"r\" type=\"system\"><joint name=\"j1\"/></ros2_control>",
            "<ros2_control> in <robot>",
        ),
        ("<sensor name=\"s\"/>", "<sensor> in <robot>"),
        (
            "<drake:collision_filter_group name=\"g\"/>",
            "the prefix `drake:` is used without being declared",
        ),
        (
            "<gazebo><joint name=\"close\"><parent>l1</parent><child>l3</child></joint></gazebo>",
            "with a joint `close` of its own in it",
        ),
        ("<author>nobody</author>", "not used: <author> in <robot>"),
    ] {
        let arm = load(&edited("</robot>", &format!("{extra}</robot>"))).unwrap();
        assert_eq!(arm.chain, plain.chain);
        assert!(
            arm.notes.iter().any(|note| note.contains(words)),
            "{words}: {:?}",
            arm.notes
        );
    }
    let in_joint = edited(
        "<axis xyz=\"0 0 1\"/>",
        "<axis xyz=\"0 0 1\"/><calibration rising=\"0\"/>",
    );
    let calibrated = load(&in_joint).unwrap();
    assert_eq!(calibrated.chain, plain.chain);
    assert!(calibrated.notes[0].contains("not used: <calibration> in <joint>"));
    let of_drake = edited("<robot name", "<robot xmlns=\"http://drake.mit.edu\" name");
    assert_eq!(load(&of_drake).unwrap().chain, plain.chain);
    let marked = format!("\u{feff}{}", six_axes());
    assert_eq!(load(&marked).unwrap().chain, plain.chain);
}

#[test]
fn macros_that_are_left_are_given_to_xacro_or_refused_with_its_command() {
    let gripper = "<xacro:if value=\"true\"><link name=\"g\"><inertial><mass value=\"20\"/></inertial></link></xacro:if></robot>";
    let declared = edited("</robot>", gripper).replace(
        "<robot name",
        "<robot xmlns:xacro=\"http://www.ros.org/wiki/xacro\" name",
    );
    let evaluated = edited("effort=\"400\"", "effort=\"${4 * 100}\"");
    for text in [edited("</robot>", gripper), declared, evaluated] {
        // Where xacro is installed, it says itself what it thinks of them.
        match load(&text) {
            Err(error @ ArmError::Xacro { .. }) => {
                let message = error.to_string();
                assert!(
                    message.contains("xacro ") && message.contains("-o "),
                    "{message}"
                );
            }
            Ok(arm) => assert!(arm.notes[0].contains("xacro"), "{:?}", arm.notes),
            Err(other) => panic!("{other}"),
        }
    }
    // A declared prefix that is not used is nothing to speak of, as xacro leaves it behind.
    let left = six_axes().replace(
        "<robot name",
        "<robot xmlns:xacro=\"http://www.ros.org/wiki/xacro\" name",
    );
    assert!(load(&left).unwrap().notes.is_empty());
    let commented = edited(
        "</robot>",
        &format!("<!-- {gripper} --></robot>").replace("</robot> -->", "-->"),
    );
    assert!(load(&commented).unwrap().notes.is_empty());
}

#[test]
fn joints_that_close_a_chain_are_refused_where_something_moves_between_their_links() {
    let joint = |one: &str, two: &str| {
        let text = format!(
            "<loop_joint name=\"lj\" type=\"revolute\"><link1 link=\"{one}\"/><link2 link=\"{two}\"/></loop_joint></robot>"
        );
        load(&edited("</robot>", &text))
    };
    let refused = joint("l1", "l3").unwrap_err().to_string();
    assert!(
        refused.contains("line 36: <loop_joint> `lj` closes a chain between links `l1` and `l3`"),
        "{refused}"
    );
    let arm = joint("l6", "tool0").unwrap();
    assert!(
        arm.notes.iter().any(|note| note.contains("`lj`")),
        "{:?}",
        arm.notes
    );
}

#[test]
fn an_inertia_that_lacks_products_has_them_zero_and_one_that_lacks_moments_is_refused() {
    let arm = load(&edited(" ixy=\"0\"", "")).unwrap();
    assert_eq!(arm.chain, load(&six_axes()).unwrap().chain);
    assert!(
        arm.notes[0].contains("link `l1`: <inertia> has no ixy, taken as 0 (line 7)"),
        "{:?}",
        arm.notes
    );
    let refused = load(&edited(" ixx=\"0.03\"", "")).unwrap_err().to_string();
    assert!(
        refused.contains("arm.urdf:7: ") && refused.contains("<inertia> has no ixx"),
        "{refused}"
    );
}

/// Without its <inertial>s, and with a box of one density on the base and on every link.
fn of_boxes() -> String {
    let mut text = six_axes();
    while let (Some(start), Some(end)) = (text.find("<inertial>"), text.find("</inertial>")) {
        text.replace_range(start..end + "</inertial>".len(), "");
    }
    let shape = |z: f64| {
        format!(
            "<collision><origin xyz=\"0 0 0.1\"/><geometry><box size=\"0.1 0.1 {z}\"/></geometry></collision>"
        )
    };
    text = text.replace(
        "<link name=\"base\"/>",
        &format!("<link name=\"base\">{}</link>", shape(0.4)),
    );
    for index in 1..=6 {
        let name = format!("<link name=\"l{index}\">");
        text = text.replace(&name, &format!("{name}{}", shape(0.1 * f64::from(index))));
    }
    text
}

fn with_options(text: &str, options: impl Fn(&mut ArmOptions)) -> Result<Arm, String> {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("arm.urdf");
    fs::write(&file, text).unwrap();
    let mut own = ArmOptions {
        tip_link: "tool0".into(),
        ..ArmOptions::default()
    };
    options(&mut own);
    load_arm(&file, &own).map_err(|error| error.to_string())
}

#[test]
fn links_take_the_share_of_their_volume_of_the_robot_s_mass() {
    let text = of_boxes();
    let refused = with_options(&text, |_| ()).unwrap_err();
    assert!(
        refused.contains("link `l1` has no mass") && refused.contains("arm.mass_kg"),
        "{refused}"
    );
    // Boxes of 0.4 (base), 0.1, 0.2 .. 0.6 m height: 2.5 m in all, of 100 kg.
    let arm = with_options(&text, |own| own.whole_mass = Some(100.0)).unwrap();
    for (index, joint) in arm.chain.joints.iter().enumerate() {
        let height = 0.1 * (index + 1) as f64;
        let mass = 100.0 * height / 2.5;
        assert!((joint.body.mass - mass).abs() < 1e-9);
        assert!((joint.body.centre_of_mass.z - 0.1).abs() < 1e-12);
        let about_x = mass * (0.1 * 0.1 + height * height) / 12.0;
        assert!((joint.body.inertia.x_axis.x - about_x).abs() < 1e-9);
    }
    assert_eq!(arm.estimated.len(), 6);
    assert!(arm.estimated.iter().all(|mass| mass.by_volume));
    // A mass that is known is taken off, and is not marked as estimated but for where it lies.
    let arm = with_options(&text, |own| {
        own.whole_mass = Some(100.0);
        own.link_masses.insert("l6".into(), 40.0);
    })
    .unwrap();
    assert!((arm.chain.joints[0].body.mass - 60.0 * 0.1 / 1.9).abs() < 1e-9);
    assert!((arm.chain.joints[5].body.mass - 40.0).abs() < 1e-12);
    assert!(!arm.estimated[5].by_volume);
    // Masses of the file count as well, scaled by a key with their inertia.
    let arm = with_options(&six_axes(), |own| {
        own.link_masses.insert("l2".into(), 6.0);
    })
    .unwrap();
    assert_eq!(arm.chain.joints[1].body.mass, 6.0);
    assert!((arm.chain.joints[1].body.inertia.x_axis.x - 0.06).abs() < 1e-12);
    assert!(arm.estimated.is_empty());
    for (link, words) in [("l9", "the arm does not have"), ("base", "stands still")] {
        let refused = with_options(&text, |own| {
            own.link_masses.insert(link.into(), 1.0);
        });
        assert!(refused.unwrap_err().contains(words));
    }
    let heavy = six_axes().replacen("<mass value=\"3\"/>", "", 1).replacen(
        "<inertial>\n",
        "<inertial><mass value=\"0\"/>\n",
        1,
    );
    let refused = with_options(&heavy, |own| own.whole_mass = Some(10.0)).unwrap_err();
    assert!(
        refused.contains("given as 10 kg") && refused.contains("15.0 kg"),
        "{refused}"
    );
}

#[test]
fn a_draft_finds_the_mount_the_masses_and_the_limits() {
    let draft = drafted(&six_axes()).unwrap();
    assert_eq!(draft.mount.flange_link, "tool0");
    assert_eq!(draft.mount.rotation, [0.0; 3]);
    assert_eq!((draft.whole_mass, draft.limits.len()), (None, 0));
    // Wrist: 0.1 aside, 0.6, sqrt(0.02), 0.5.
    assert!((draft.reach - (0.1 + 0.6 + 0.02f64.sqrt() + 0.5)).abs() < 1e-12);
    // A flange as makers have it: x out of it.
    for (rpy, rotation) in [
        ("0 0 0", [0.0, 90.0, 0.0]),
        ("0 -1.5707963 0", [0.0, 180.0, 0.0]),
        ("0 0 3.14159265", [0.0, 90.0, 180.0]),
        // The device's axis already.
        ("-1.5707963 0 -1.5707963", [0.0, 0.0, 0.0]),
    ] {
        let text = edited("rpy=\"0 1.5707963 0\"", &format!("rpy=\"{rpy}\""));
        let mount = drafted(&text).unwrap().mount;
        let degrees = mount.rotation.map(f64::to_degrees);
        let near = degrees
            .iter()
            .zip(rotation)
            .all(|(found, planted)| (found.abs() - planted).abs() < 1e-4);
        // Half a turn has its yaw for nothing.
        assert!(
            near || (rotation[1] == 180.0 && (degrees[1] - 180.0).abs() < 1e-4),
            "{rpy}: {degrees:?}"
        );
        let arm = with_options(&text, |own| {
            own.tip_from_mount = glam::DQuat::from_rotation_z(mount.rotation[2])
                * glam::DQuat::from_rotation_y(mount.rotation[1]);
        })
        .unwrap();
        assert!(arm.notes.is_empty(), "{:?}", arm.notes);
        let z = arm.chain.tip_from_last.rotation * glam::DVec3::Z;
        assert!((z - glam::DVec3::X).length() < 1e-6, "{z}");
        let unturned = with_options(&text, |_| ()).unwrap();
        let aslant = unturned
            .notes
            .iter()
            .any(|note| note.contains("degrees off the outward axis"));
        assert_eq!(aslant, rotation != [0.0; 3], "{:?}", unturned.notes);
    }
    let idle = of_boxes().replace("effort=\"400\" velocity=\"3\"", "effort=\"0\"");
    let draft = drafted(&idle).unwrap();
    let mass = draft.whole_mass.unwrap();
    assert!((80.0..400.0).contains(&mass), "{mass}");
    assert_eq!(draft.limits.len(), 6);
    for (joint, effort, velocity) in &draft.limits {
        assert!(effort.unwrap() > 1.0 && velocity.unwrap() > 1.0, "{joint}");
    }
    // The nearer the base, the stronger.
    let efforts: Vec<f64> = draft.limits.iter().map(|limit| limit.1.unwrap()).collect();
    assert!(
        efforts.windows(2).all(|pair| pair[0] >= pair[1]),
        "{efforts:?}"
    );
}

#[test]
fn a_refused_arm_is_reported_by_its_likeliest_link() {
    // The frame `base` of ROS-Industrial stands last in the file.
    let frame = "<joint name=\"b\" type=\"fixed\"><parent link=\"base\"/><child link=\"base_frame\"/></joint><link name=\"base_frame\"/></robot>";
    let four = edited("</robot>", frame)
        .replace(
            "name=\"j5\" type=\"revolute\"",
            "name=\"j5\" type=\"fixed\"",
        )
        .replace(
            "name=\"j6\" type=\"revolute\"",
            "name=\"j6\" type=\"fixed\"",
        );
    let refused = drafted(&four).unwrap_err();
    assert!(
        refused.contains("to `tool0` has 4 moving joints (j1, j2, j3, j4)"),
        "{refused}"
    );
    assert!(refused.contains("palletisers"), "{refused}");
    let mimicking = edited(
        "<axis xyz=\"0 1 0\"/>",
        "<axis xyz=\"0 1 0\"/><mimic joint=\"j1\"/>",
    );
    let refused = drafted(&mimicking).unwrap_err();
    assert!(
        refused.contains("joint `j2` on the path mimics joint `j1`"),
        "{refused}"
    );
    let planar = edited(
        "name=\"j3\" type=\"revolute\"",
        "name=\"j3\" type=\"planar\"",
    );
    let refused = drafted(&planar).unwrap_err();
    assert!(refused.contains("joint `j3` is planar"), "{refused}");
    let ring = edited(
        "</robot>",
        "<joint name=\"r\" type=\"fixed\"><parent link=\"tool0\"/><child link=\"base\"/></joint></robot>",
    );
    let refused = drafted(&ring).unwrap_err();
    assert!(refused.contains("form a ring"), "{refused}");
    let two = edited("</robot>", "<link name=\"table\"/></robot>");
    assert_eq!(
        drafted(&two).unwrap().mount.base_link.as_deref(),
        Some("base")
    );
    // Fingers are no axes of the arm.
    let finger = |name: &str| {
        format!(
            "<joint name=\"{name}\" type=\"prismatic\"><parent link=\"tool0\"/><child link=\"{name}_link\"/><limit lower=\"0\" upper=\"0.04\" effort=\"9\" velocity=\"1\"/></joint><link name=\"{name}_link\"/>"
        )
    };
    let gripper = edited(
        "</robot>",
        &format!("{}{}</robot>", finger("left"), finger("right")),
    )
    .replace("tool0", "hand");
    assert_eq!(drafted(&gripper).unwrap().mount.flange_link, "hand");
}
