use super::*;
use crate::arm::chain::point_mass_inertia;
use crate::arm::kinematics::tip_pose;
use glam::{DMat3, DQuat, DVec3};
use glamx::DPose3;
use std::fs;

const DYNAMICS: &str = r#"<dynamics damping="0.5" friction="0.25"/>"#;
const LIMIT: &str = r#"<limit lower="-2" upper="2.5" effort="50" velocity="3"/>"#;

/// A five-axis arm `base`, `l1` .. `l5` with a fixed `tip`; every joint turns about y, 0.3 m apart.
fn five_axes() -> String {
    let mut text = String::from(r#"<robot name="five"><link name="base"/>"#);
    for index in 1..=5 {
        let parent = match index {
            1 => "base".to_string(),
            _ => format!("l{}", index - 1),
        };
        text += &format!(
            r#"<joint name="j{index}" type="revolute"><parent link="{parent}"/><child link="l{index}"/>
            <origin xyz="0 0 0.3"/><axis xyz="0 1 0"/>{LIMIT}{DYNAMICS}</joint>
            <link name="l{index}"><inertial><origin xyz="0 0 0.1"/><mass value="2"/>
            <inertia ixx="0.02" iyy="0.03" izz="0.04" ixy="0" ixz="0" iyz="0"/></inertial></link>"#
        );
    }
    text + r#"<joint name="mount" type="fixed"><parent link="l5"/><child link="tip"/>
        <origin xyz="0 0 0.2" rpy="0 0 1.5"/></joint><link name="tip"/></robot>"#
}

fn options() -> ArmOptions {
    ArmOptions {
        tip_link: "tip".into(),
        ..ArmOptions::default()
    }
}

fn load(text: &str, options: &ArmOptions) -> Result<Arm, ArmError> {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("arm.urdf");
    fs::write(&file, text).expect("written");
    load_arm(&file, options)
}

/// `five_axes` with its first `from` replaced, which must be there.
fn edited(from: &str, to: &str) -> String {
    let text = five_axes();
    assert!(text.contains(from), "{from}");
    text.replacen(from, to, 1)
}

/// Notes but for the one that the flange's z lies across the last axis, as it does here.
fn plain(arm: &Arm) -> Vec<&String> {
    let notes = arm.notes.iter();
    notes
        .filter(|note| !note.contains("off the outward axis"))
        .collect()
}

fn with_extra(extra: &str) -> String {
    edited("</robot>", &format!("{extra}</robot>"))
}

fn refusal(text: &str, options: &ArmOptions) -> String {
    let error = load(text, options).expect_err("refused").to_string();
    assert!(error.contains("arm.urdf"), "{error}");
    error
}

#[test]
fn a_plain_arm_is_taken_as_written() {
    let arm = load(&five_axes(), &options()).expect("plain");
    assert_eq!(arm.name, "five");
    assert_eq!(arm.link_names, ["base", "l1", "l2", "l3", "l4", "l5"]);
    assert!(plain(&arm).is_empty(), "{:?}", arm.notes);
    for joint in &arm.chain.joints {
        assert_eq!((joint.lower, joint.upper), (-2.0, 2.5));
        assert_eq!((joint.effort, joint.velocity), (50.0, 3.0));
        assert_eq!((joint.damping, joint.friction), (0.5, 0.25));
        assert_eq!(joint.axis, DVec3::Y);
        assert_eq!(joint.body.mass, 2.0);
    }
    let tip = tip_pose(&arm.chain, DPose3::IDENTITY, &[0.0; 5]);
    assert!((tip.translation - DVec3::new(0.0, 0.0, 1.7)).length() < 1e-15);
    assert!(tip.rotation.dot(DQuat::from_rotation_z(1.5)) > 1.0 - 1e-15);
}

#[test]
fn roll_turns_first_then_pitch_then_yaw() {
    let text = edited(r#"rpy="0 0 1.5""#, r#"rpy="0.3 0.4 0.5""#);
    let turn = load(&text, &options())
        .expect("turned")
        .chain
        .tip_from_last
        .rotation;
    let (roll, pitch, yaw) = (0.3f64, 0.4f64, 0.5f64);
    // First column and last row of Rz(yaw) Ry(pitch) Rx(roll), written out.
    let x = DVec3::new(
        yaw.cos() * pitch.cos(),
        yaw.sin() * pitch.cos(),
        -pitch.sin(),
    );
    assert!((turn * DVec3::X - x).length() < 1e-15);
    let row = DVec3::new(
        -pitch.sin(),
        pitch.cos() * roll.sin(),
        pitch.cos() * roll.cos(),
    );
    assert!((turn.inverse() * DVec3::Z - row).length() < 1e-15);
}

#[test]
fn our_own_arm_has_its_published_lengths_and_masses() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("models/arm/arm10.urdf");
    let options = ArmOptions {
        tip_link: "flange".into(),
        ..ArmOptions::default()
    };
    let arm = load_arm(&file, &options).expect("our own");
    assert_eq!(arm.notes.len(), 1, "{:?}", arm.notes);
    let mass: f64 = arm.chain.joints.iter().map(|joint| joint.body.mass).sum();
    assert!((mass - 29.104).abs() < 1e-12);
    for index in 0..7 {
        assert!(arm.visuals.iter().any(|visual| visual.link_index == index));
    }
    // The published (a, d, alpha) of each link.
    let quarter = std::f64::consts::FRAC_PI_2;
    let table = [
        (0.0, 0.1807, quarter),
        (-0.6127, 0.0, 0.0),
        (-0.57155, 0.0, 0.0),
        (0.0, 0.17415, quarter),
        (0.0, 0.11985, -quarter),
        (0.0, 0.11655, 0.0),
    ];
    let q = [0.4, -1.1, 1.9, -0.6, 0.8, 2.2];
    let mut expected = DPose3::IDENTITY;
    for ((a, d, alpha), q) in table.into_iter().zip(q) {
        expected = expected
            * DPose3::from_parts(DVec3::new(0.0, 0.0, d), DQuat::from_rotation_z(q))
            * DPose3::from_parts(DVec3::new(a, 0.0, 0.0), DQuat::from_rotation_x(alpha));
    }
    let tip = tip_pose(&arm.chain, DPose3::IDENTITY, &q);
    assert!((tip.translation - expected.translation).length() < 1e-14);
    assert!(tip.rotation.dot(expected.rotation).abs() > 1.0 - 1e-14);
    // Published centre of mass of link 2, given in its far frame, seen from its own joint.
    let upper_arm = &arm.chain.joints[1].body;
    let centre = DVec3::new(0.38 - 0.6127, 0.0, 0.158);
    assert!((upper_arm.centre_of_mass - centre).length() < 1e-12);
    // Link 1's published inertia is written in axes turned by alpha.
    let shoulder = &arm.chain.joints[0].body.inertia;
    assert!((shoulder.y_axis.y - 0.02156).abs() < 1e-12);
    assert!((shoulder.z_axis.z - 0.03529).abs() < 1e-12);
}

#[test]
fn what_is_fixed_to_a_link_is_welded_by_the_parallel_axis_theorem() {
    let arm = load(
        &with_extra(
            r#"<joint name="cap" type="fixed"><parent link="l3"/><child link="ball"/>
            <origin xyz="0.2 0 0.1" rpy="0 0 0.5"/></joint>
            <link name="ball"><inertial><mass value="6"/>
            <inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>"#,
        ),
        &options(),
    )
    .expect("a ball on a link");
    let body = &arm.chain.joints[2].body;
    assert_eq!(body.mass, 8.0);
    assert!((body.centre_of_mass - DVec3::new(0.15, 0.0, 0.1)).length() < 1e-15);
    let expected = DMat3::from_diagonal(DVec3::new(0.12, 0.13, 0.14))
        + point_mass_inertia(2.0, DVec3::new(-0.15, 0.0, 0.0))
        + point_mass_inertia(6.0, DVec3::new(0.05, 0.0, 0.0));
    assert!(body.inertia.abs_diff_eq(expected, 1e-15));
    assert_eq!(arm.chain.joints[3].body.mass, 2.0);
}

#[test]
fn fingers_are_held_at_the_nearest_limit_and_mimics_follow() {
    let finger = |name: &str, mimic: &str| {
        format!(
            r#"<joint name="{name}" type="prismatic"><parent link="tip"/><child link="{name}_link"/>
            <axis xyz="1 0 0"/><limit lower="0.01" upper="0.04" effort="1" velocity="1"/>{mimic}</joint>
            <link name="{name}_link"><inertial><mass value="0.5"/>
            <inertia ixx="1e-4" iyy="1e-4" izz="1e-4" ixy="0" ixz="0" iyz="0"/></inertial></link>"#
        )
    };
    let right = r#"<mimic joint="left" multiplier="-1" offset="0.002"/>"#;
    let text = with_extra(&(finger("left", "") + &finger("right", right)));
    let arm = load(&text, &options()).expect("a gripper");
    let body = &arm.chain.joints[4].body;
    assert_eq!(body.mass, 3.0);
    // The fingers stand at 0.01 and -0.008 m along the tip's x, which is turned by 1.5 rad about z.
    let along = 0.5 * (0.01 - 0.008) / 3.0;
    let centre = DVec3::new(
        along * 1.5f64.cos(),
        along * 1.5f64.sin(),
        (0.2 + 0.2) / 3.0,
    );
    assert!((body.centre_of_mass - centre).length() < 1e-15);
    let held: Vec<_> = arm
        .notes
        .iter()
        .filter(|note| note.contains("held"))
        .collect();
    assert!(held[0].contains("left") && held[0].contains("0.01 m"));
    assert!(held[1].contains("right") && held[1].contains("-0.008 m"));
}

#[test]
fn safety_controllers_narrow_limits_and_overrides_replace_them() {
    let soft =
        r#"<safety_controller soft_lower_limit="-1.5" soft_upper_limit="9" k_velocity="1"/>"#;
    let text = edited(DYNAMICS, soft);
    let mut options = options();
    let replaced = LimitOverride {
        effort: Some(70.0),
        velocity: None,
    };
    options.limit_overrides.insert("j2".into(), replaced);
    let arm = load(&text, &options).expect("narrowed");
    assert_eq!(
        (arm.chain.joints[0].lower, arm.chain.joints[0].upper),
        (-1.5, 2.5)
    );
    assert_eq!(arm.chain.joints[1].effort, 70.0);
    assert_eq!(arm.chain.joints[1].velocity, 3.0);
    assert!(arm.notes[0].contains("j1") && arm.notes[0].contains("-1.5 to 2.5"));
    assert!(arm.notes[1].contains("j2") && arm.notes[1].contains("overridden by 70"));
    // An override also supplies what the file leaves out.
    options.limit_overrides.insert("j1".into(), replaced);
    let text = edited(r#"effort="50""#, r#"effort="0""#);
    assert_eq!(
        load(&text, &options).expect("supplied").chain.joints[0].effort,
        70.0
    );
}

#[test]
fn a_continuous_joint_has_no_position_limits() {
    let text = edited("type=\"revolute\"", "type=\"continuous\"");
    let arm = load(&text, &options()).expect("endless");
    assert_eq!(arm.chain.joints[0].lower, f64::NEG_INFINITY);
    assert_eq!(arm.chain.joints[0].upper, f64::INFINITY);
    assert_eq!(arm.chain.joints[0].kind, crate::arm::JointKind::Revolute);
}

#[test]
fn what_cannot_be_honoured_is_refused_by_name() {
    let revolute = r#"name="j1" type="revolute""#;
    let mimic = r#"<mimic joint="j2"/>"#;
    let cases = [
        (DYNAMICS, mimic, "joint `j1` on the path mimics joint `j2`"),
        (
            revolute,
            r#"name="j1" type="planar""#,
            "joint `j1` is planar",
        ),
        (
            revolute,
            r#"name="j1" type="floating""#,
            "joint `j1` is floating",
        ),
        (LIMIT, "", "joint `j1` has position limits 0 to 0"),
        (r#"effort="50""#, "", "joint `j1` has effort limit 0"),
        (
            r#"velocity="3""#,
            r#"velocity="0""#,
            "joint `j1` has velocity limit 0",
        ),
        (
            r#"velocity="3""#,
            r#"velocity="inf""#,
            "joint `j1` has velocity limit inf",
        ),
        (
            r#"lower="-2""#,
            r#"lower="4""#,
            "joint `j1` has position limits 4 to 2.5",
        ),
        (
            r#"mass value="2""#,
            r#"mass value="0""#,
            "link `l1` has no mass (no <inertial>",
        ),
        (
            r#"mass value="2""#,
            r#"mass value="-2""#,
            "link `l1` has mass -2 kg",
        ),
        (
            r#"ixx="0.02""#,
            r#"ixx="-0.02""#,
            "link `l1` has principal inertias -2.000e-2",
        ),
        (
            r#"ixx="0.02""#,
            r#"ixx="0""#,
            "link `l1` has principal inertias 0",
        ),
        (
            r#"xyz="0 1 0""#,
            r#"xyz="0 0 0""#,
            "joint `j1` has axis (0 0 0)",
        ),
        (
            r#"damping="0.5""#,
            r#"damping="-1""#,
            "joint `j1` has damping -1",
        ),
        (
            r#"friction="0.25""#,
            r#"friction="nan""#,
            "joint `j1` has friction NaN",
        ),
        (
            r#"xyz="0 0 0.3""#,
            r#"xyz="0 nan 0.3""#,
            "origin of joint `j1` is not finite",
        ),
        (
            r#"child link="l1""#,
            r#"child link="l9""#,
            "names a link `l9`",
        ),
        (
            r#"child link="tip""#,
            r#"child link="l1""#,
            "child of both joint `j1` and joint `mount`",
        ),
        (
            r#"link name="l2""#,
            r#"link name="l1""#,
            "link `l1` is defined twice",
        ),
        (
            revolute,
            r#"name="j1" type="fixed""#,
            "has 4 moving joints (j2, j3, j4, j5)",
        ),
    ];
    for (from, to, expected) in cases {
        let message = refusal(&edited(from, to), &options());
        assert!(message.contains(expected), "{expected}: {message}");
    }
}

#[test]
fn links_and_joints_named_by_the_user_must_exist() {
    let named = |base: Option<&str>, tip: &str| ArmOptions {
        base_link: base.map(String::from),
        tip_link: tip.into(),
        ..ArmOptions::default()
    };
    let text = five_axes();
    assert!(refusal(&text, &named(None, "hand")).contains("no link `hand` to be the tip"));
    assert!(refusal(&text, &named(Some("foot"), "tip")).contains("no link `foot` to be the base"));
    let behind = refusal(&text, &named(Some("l5"), "base"));
    assert!(behind.contains("tip link `base` is not reached from base link `l5`"));
    let loose = refusal(&with_extra(r#"<link name="loose"/>"#), &options());
    assert!(loose.contains("2 (base, loose)"), "{loose}");
    let mut overridden = options();
    overridden
        .limit_overrides
        .insert("j9".into(), LimitOverride::default());
    assert!(refusal(&text, &overridden).contains("override names joint `j9`"));
    let moved = r#"<joint name="f" type="revolute"><parent link="tip"/><child link="fl"/>
        <mimic joint="j3"/></joint><link name="fl"/>"#;
    let follows = refusal(&with_extra(moved), &options());
    assert!(follows.contains("joint `f` mimics `j3`, which moves with the arm"));
}

#[test]
fn unreadable_files_are_distinguished() {
    let missing = load_arm(Path::new("/nowhere/arm.urdf"), &options());
    assert!(matches!(missing, Err(ArmError::Unreadable { .. })));
    for text in ["", "<robot", "\u{0}"] {
        let cut = load(text, &options());
        assert!(matches!(cut, Err(ArmError::Incomplete { .. })));
    }
    let nameless = load("<robot name='x'><link/></robot>", &options());
    assert!(matches!(nameless, Err(ArmError::Faulty { line: 1, .. })));
}

/// A tetrahedron wound outwards, one unit along each axis.
const TETRAHEDRON: &str =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

/// One triangle of three corners, the last of which does not exist.
const BROKEN_COLLADA: &str = r##"<COLLADA version="1.4.1"><asset/><library_geometries><geometry id="g"><mesh>
    <source id="p"><float_array id="a" count="6">0 0 0 1 0 0</float_array><technique_common>
    <accessor source="#a" count="2" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
    <param name="Z" type="float"/></accessor></technique_common></source>
    <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
    <triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 7</p></triangles>
    </mesh></geometry></library_geometries><library_visual_scenes><visual_scene id="s"><node id="n">
    <instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
    <scene><instance_visual_scene url="#s"/></scene></COLLADA>"##;

fn mesh_on_link_2(name: &str, scale: &str, material: &str) -> String {
    let visual = format!(
        r#"<link name="l2"><visual><geometry><mesh filename="{name}"{scale}/></geometry>{material}</visual>"#
    );
    edited(r#"<link name="l2">"#, &visual)
}

fn volume(shape: &VisualShape) -> f64 {
    let VisualShape::Mesh {
        vertices,
        triangles,
    } = shape
    else {
        panic!("a mesh");
    };
    let corner = |index: u32| vertices[index as usize];
    let signed = triangles
        .iter()
        .map(|[a, b, c]| corner(*a).dot(corner(*b).cross(corner(*c))));
    signed.sum::<f64>() / 6.0
}

#[test]
fn meshes_are_found_scaled_and_kept_outside_out() {
    let folder = tempfile::tempdir().expect("a folder");
    let nested = folder.path().join("shapes_pkg/robots/one");
    fs::create_dir_all(&nested).expect("made");
    let meshes = folder.path().join("shapes_pkg/meshes");
    fs::create_dir_all(&meshes).expect("made");
    fs::write(meshes.join("tetra.obj"), TETRAHEDRON).expect("written");
    let urdf = nested.join("arm.urdf");
    let mut options = options();
    options
        .package_directories
        .insert("elsewhere".into(), meshes.clone());
    let absolute = meshes.join("tetra.obj").display().to_string();
    let names = [
        "package://shapes_pkg/meshes/tetra.obj".to_string(),
        "package://meshes/tetra.obj".to_string(),
        "package://elsewhere/tetra.obj".to_string(),
        "../../meshes/tetra.obj".to_string(),
        format!("file://{absolute}"),
        absolute,
    ];
    for name in &names {
        fs::write(&urdf, mesh_on_link_2(name, r#" scale="2 -0.5 3""#, "")).expect("written");
        let arm = load_arm(&urdf, &options).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(arm.visuals.len(), 1);
        assert_eq!(arm.visuals[0].link_index, 2);
        assert!(
            (volume(&arm.visuals[0].shape) - 3.0 / 6.0).abs() < 1e-12,
            "{name}"
        );
    }
    fs::write(nested.join("broken.obj"), "v 0 0 0\nf 1 2 3\n").expect("written");
    fs::write(nested.join("broken.dae"), BROKEN_COLLADA).expect("written");
    fs::write(nested.join("empty.stl"), "solid x\nendsolid x\n").expect("written");
    let bad = [
        ("tetra.obj", "", "there is no file"),
        (
            "package://nowhere/tetra.obj",
            "",
            "no folder `nowhere` from",
        ),
        ("package://elsewhere/cube.obj", "", "cube.obj"),
        ("http://site/tetra.obj", "", "`http://` is not known"),
        ("arm.urdf", "", "arm.urdf"),
        ("broken.obj", "", "broken.obj"),
        ("broken.dae", "", "broken.dae"),
        ("empty.stl", "", "empty.stl"),
        (names[3].as_str(), r#" scale="1 0 1""#, "scale is 1 0 1"),
    ];
    for (name, scale, expected) in bad {
        fs::write(&urdf, mesh_on_link_2(name, scale, "")).expect("written");
        let message = load_arm(&urdf, &options).expect_err("unusable").to_string();
        assert!(
            message.contains("link `l2`") && message.contains(name),
            "{message}"
        );
        assert!(message.contains(expected), "{message}");
        options.skip_visuals = true;
        assert!(
            load_arm(&urdf, &options)
                .expect("not drawn")
                .visuals
                .is_empty()
        );
        options.skip_visuals = false;
    }
}

#[test]
fn shapes_carry_their_pose_and_colour() {
    let visual = r#"<link name="l2">
        <visual><origin xyz="1 2 3"/><geometry><box size="1 2 3"/></geometry>
            <material name="red"/></visual>
        <visual><geometry><sphere radius="0.5"/></geometry>
            <material name="own"><color rgba="0 0 1 0.5"/></material></visual>
        <visual><geometry><capsule radius="0.1" length="1"/></geometry>
            <material name="bare"/></visual>"#;
    let red = r#"<material name="red"><color rgba="1 0 0 1"/></material></robot>"#;
    let text = edited(r#"<link name="l2">"#, visual).replace("</robot>", red);
    let arm = load(&text, &options()).expect("shapes");
    let size = DVec3::new(1.0, 2.0, 3.0);
    assert_eq!(arm.visuals[0].shape, VisualShape::Box { size });
    assert_eq!(arm.visuals[0].link_from_visual.translation, size);
    assert_eq!(arm.visuals[0].colour, [255, 0, 0, 255]);
    assert_eq!(arm.visuals[1].colour, [0, 0, 255, 128]);
    // A capsule is drawn as a tube and two balls.
    assert_eq!(arm.visuals.len(), 5);
    assert_eq!(arm.visuals[4].link_from_visual.translation.z, -0.5);
    assert!(
        arm.notes
            .iter()
            .any(|note| note.contains("without a colour") && note.contains("bare"))
    );
    let flat = text.replace("0.5\"/></geometry>", "0\"/></geometry>");
    let arm = load(&flat, &options()).expect("without the ball");
    assert_eq!(arm.visuals.len(), 4);
    let expected =
        "link `l2`: a visual shape is a sphere of 0, without extent: it is left out (line 9)";
    assert!(
        arm.notes.iter().any(|note| note == expected),
        "{:?}",
        arm.notes
    );
    let inside_out = text.replace("0.5\"/></geometry>", "-0.5\"/></geometry>");
    let refused = refusal(&inside_out, &options());
    assert!(
        refused.contains("link `l2` has a visual sphere of [-0.5]"),
        "{refused}"
    );
}

#[test]
fn a_link_without_usable_collision_geometry_has_the_shape_that_is_drawn_of_it() {
    let drawn = r#"<visual><geometry><box size="1 2 3"/></geometry></visual>"#;
    let with = |collision: &str| {
        let link = format!("<link name=\"l2\">{drawn}{collision}");
        load(&edited(r#"<link name="l2">"#, &link), &options())
    };
    let own = r#"<collision><origin xyz="0 0 4"/><geometry><sphere radius="0.5"/></geometry></collision>"#;
    let arm = with(own).expect("a sphere");
    assert_eq!(arm.collisions.len(), 1);
    assert_eq!(arm.collisions[0].shape, VisualShape::Sphere { radius: 0.5 });
    assert_eq!(arm.collisions[0].link_from_shape.translation.z, 4.0);
    assert!(plain(&arm).is_empty(), "{:?}", arm.notes);
    let size = DVec3::new(1.0, 2.0, 3.0);
    let missing = r#"<collision><geometry><mesh filename="none.stl"/></geometry></collision>"#;
    for (collision, expected) in [
        ("", "links without collision geometry"),
        (missing, "collision mesh `none.stl` cannot be used"),
    ] {
        let arm = with(collision).expect("what is drawn");
        assert_eq!(arm.collisions.len(), 1);
        assert_eq!(arm.collisions[0].shape, VisualShape::Box { size });
        let notes: Vec<&String> = arm
            .notes
            .iter()
            .filter(|note| note.contains(expected))
            .collect();
        assert!(
            notes.len() == 1 && notes[0].contains("l2"),
            "{:?}",
            arm.notes
        );
    }
    let zero = own.replace("0.5", "0");
    let arm = with(&zero).expect("what is drawn");
    assert_eq!(arm.collisions[0].shape, VisualShape::Box { size });
    let inside_out = own.replace("0.5", "-0.5");
    let refused = with(&inside_out).unwrap_err().to_string();
    assert!(refused.contains("collision sphere"), "{refused}");
}
