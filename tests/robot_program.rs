//! Programs of robots: what the command writes of a cell, for each dialect, by other code than that which wrote it; and dialects written and read.

mod dialects;

use glam::{DQuat, DVec3};
use glamx::DPose3;
use idc_cell::Cell;
use idc_cell::arm::kinematics::tip_pose;
use idc_cell::path::Phase;
use idc_cell::robot_program::{Dialect, Program, Step, Target, Timing, Way, read};

use crate::program::Bench;

/// A six-axis arm with a spherical wrist, its joints counted as KUKA does; nobody's, in the size of a 10 kg robot.
fn spherical(name: &str) -> String {
    let joints = [
        ("0 0 0.4", "0 0 -1"),
        ("0.025 0 0", "0 1 0"),
        ("0.56 0 0", "0 1 0"),
        ("0 0 0.035", "-1 0 0"),
        ("0.515 0 0", "0 1 0"),
        ("0.08 0 0", "-1 0 0"),
    ];
    let inertia = "<inertial><mass value=\"3\"/><inertia ixx=\"0.02\" ixy=\"0\" ixz=\"0\" iyy=\"0.02\" iyz=\"0\" izz=\"0.02\"/></inertial>";
    let mut text = format!("<robot name=\"{name}\"><link name=\"base_link\"/>");
    let mut parent = "base_link".to_owned();
    for (index, (origin, axis)) in joints.iter().enumerate() {
        let link = format!("link_{}", index + 1);
        text += &format!(
            "<joint name=\"a{}\" type=\"revolute\"><parent link=\"{parent}\"/><child link=\"{link}\"/><origin xyz=\"{origin}\"/><axis xyz=\"{axis}\"/><limit lower=\"-6\" upper=\"6\" effort=\"400\" velocity=\"4\"/></joint><link name=\"{link}\">{inertia}</link>",
            index + 1
        );
        parent = link;
    }
    text + "<joint name=\"t\" type=\"fixed\"><parent link=\"link_6\"/><child link=\"flange\"/><origin rpy=\"0 1.5707963267948966 0\"/></joint><link name=\"flange\"/></robot>"
}

/// The nominal job in two passes, with an arm of a name.
fn bench(robot: Option<&str>) -> Bench {
    let bench = Bench::new("plate_edge_ideal");
    let passes = "[[pass]]\nfeed_mm_per_s = 25.37\n\n[[pass]]\nforce_n = 100\n\n[program]\noutput_forces_n = [0, 200]\noutput_values = [0, 1]\n\n[process]";
    bench.replace("scenario.toml", "[process]", passes);
    if let Some(name) = robot {
        bench.write("arm.urdf", spherical(name));
    }
    bench
}

fn exported(bench: &Bench, dialect: Dialect, moves: &str) -> Program {
    let arguments = [
        "export",
        "program",
        "scenario.toml",
        "--dialect",
        dialect.name(),
        "--moves",
        moves,
        "--out",
        "out",
        "--force",
    ];
    let done = bench.idc(&arguments, &[]);
    assert_eq!(done.code, 0, "{}", done.err);
    assert!(done.out.contains("read back"), "{}", done.out);
    let names = bench.names_in("out");
    let ending = format!(".{}", dialect.ending());
    let file = names.iter().find(|name| name.ends_with(&ending)).unwrap();
    let text = std::fs::read_to_string(bench.path(&format!("out/{file}"))).unwrap();
    read(dialect, &text).unwrap()
}

/// Fields of a dialect's program that are known from the scenario alone: order of passes and phases, the force's output.
fn assert_order(program: &Program) {
    let notes: Vec<&str> = program
        .steps
        .iter()
        .filter_map(|step| match step {
            Step::Note(note) => note.strip_prefix("pass "),
            _ => None,
        })
        .collect();
    let once = |pass: usize| {
        ["approach", "engage", "follow", "retract", "retract"]
            .map(|phase| format!("{pass}: {phase}"))
    };
    let mut wanted = once(1).to_vec();
    // Back to the start of the edge.
    wanted.push("2: approach".to_owned());
    wanted.extend(once(2));
    assert_eq!(notes, wanted);
    let values: Vec<f64> = program
        .steps
        .iter()
        .filter_map(|step| match step {
            Step::Output { value, .. } => Some(*value),
            _ => None,
        })
        .collect();
    assert_eq!(values, [0.75, 0.5, 0.0], "150 N, 100 N, none, of 200 N");
}

/// The moves of a phase of a pass.
fn moves_of<'a>(program: &'a Program, note: &str) -> Vec<&'a idc_cell::robot_program::Move> {
    let start = program
        .steps
        .iter()
        .position(|step| matches!(step, Step::Note(found) if found == note));
    let rest = program.steps[start.unwrap() + 1..].iter();
    rest.take_while(|step| !matches!(step, Step::Note(_)))
        .filter_map(|step| match step {
            Step::Move(one) => Some(one),
            _ => None,
        })
        .collect()
}

/// The tool that the program states at the end of the followed edge is where the plan has it, by the arm's own kinematics and by the ball's centre; the feed is that of the scenario.
#[test]
fn poses_speeds_and_frames_are_those_of_the_plan() {
    for (dialect, robot) in [
        (Dialect::Urscript, None),
        (Dialect::Krl, Some("plain")),
        (Dialect::Rapid, Some("plain")),
    ] {
        let bench = bench(robot);
        let program = exported(&bench, dialect, "cartesian");
        assert_order(&program);
        let cell = Cell::load(&bench.path("scenario.toml")).unwrap();
        let frames: Vec<DPose3> = program
            .steps
            .iter()
            .filter_map(|step| match step {
                Step::Tool(frame) | Step::Frame(frame) => frame.pose,
                _ => None,
            })
            .collect();
        let [flange_from_tool, base_from_part] = frames.as_slice() else {
            panic!("{frames:?}");
        };
        for (pass, feed) in [(1, 0.02537), (2, 0.02)] {
            let moves = moves_of(&program, &format!("pass {pass}: follow"));
            let last = moves.last().unwrap();
            let Target::Pose { pose, .. } = &last.target else {
                panic!("{last:?}");
            };
            let follow = cell
                .plan
                .stretches()
                .filter(|s| s.phase == Phase::Follow)
                .nth(pass - 1)
                .unwrap();
            let reference = cell.plan.reference(follow.at_rest - 1e-9);
            let arm = &cell.setup.arm.chain;
            let base = cell.setup.scenario.arm.world_from_base;
            let flange = tip_pose(arm, base, &reference.position[..6]);
            let found = base * *base_from_part * *pose * flange_from_tool.inverse();
            assert!(
                (found.translation - flange.translation).length() < 2e-6,
                "{}",
                dialect.name()
            );
            assert!(found.rotation.angle_between(flange.rotation) < 2e-5);
            let centre = (base * *base_from_part * *pose).translation;
            assert!((centre - reference.centre).length() < 2e-6);
            let fastest = moves.iter().map(|one| match one.timing {
                Some(Timing::Speed(speed)) => speed,
                other => panic!("{other:?}"),
            });
            let fastest = fastest.fold(0.0, f64::max);
            assert!((fastest / feed - 1.0).abs() < 1e-3, "{fastest} {feed}");
        }
    }
}

/// In joint angles the moves of all dialects add up to the time of the plan, and end where it does.
#[test]
fn joint_moves_take_the_time_of_the_plan() {
    for dialect in [Dialect::Urscript, Dialect::Krl, Dialect::Rapid] {
        let bench = bench(None);
        let program = exported(&bench, dialect, "joint");
        let cell = Cell::load(&bench.path("scenario.toml")).unwrap();
        let times = program.steps.iter().map(|step| match step {
            Step::Wait(time) => *time,
            Step::Move(one) => match one.timing {
                Some(Timing::Duration(time)) => time,
                _ => 0.0,
            },
            _ => 0.0,
        });
        let total: f64 = times.sum();
        assert!((total - cell.plan.duration()).abs() < 2e-3, "{total}");
        let last = program.moves().last().unwrap();
        let Target::Joints(joints) = &last.target else {
            panic!("{last:?}");
        };
        let end = cell.plan.reference(cell.plan.duration()).position;
        let off = joints
            .iter()
            .zip(end)
            .map(|(one, other)| (one - other).abs());
        assert!(off.fold(0.0, f64::max) < 1e-7);
        assert!(program.moves().all(|one| one.way == Way::Joint));
    }
}

/// FANUC: joints with the coupling that the scenario gives, its output as it is counted there.
#[test]
fn a_fanuc_program_counts_joint_3_and_outputs_as_its_controller_does() {
    let bench = bench(Some("plain"));
    bench.replace(
        "scenario.toml",
        "output_values = [0, 1]",
        "output_values = [0, 2000]\njoint_3_by_2 = 1",
    );
    let program = exported(&bench, Dialect::FanucLs, "joint");
    let cell = Cell::load(&bench.path("scenario.toml")).unwrap();
    let Some(Target::Joints(first)) = program.moves().next().map(|one| one.target.clone()) else {
        panic!("no joints");
    };
    let start = cell.plan.start();
    assert!((first[2] - start[2] - start[1]).abs() < 1e-5 && (first[1] - start[1]).abs() < 1e-5);
    assert!(
        program
            .steps
            .iter()
            .any(|step| matches!(step, Step::Output { value, .. } if *value == 1500.0))
    );
}

/// The table of joints is that of the plan, and so is the message of the bag, read by its own few lines.
#[test]
fn every_arm_gets_its_joints_over_time() {
    let bench = bench(None);
    let done = bench.idc(&["export", "program", "scenario.toml", "--out", "out"], &[]);
    assert_eq!(done.code, 0, "{}", done.err);
    assert_eq!(bench.names_in("out"), ["trajectory.csv", "trajectory.mcap"]);
    let cell = Cell::load(&bench.path("scenario.toml")).unwrap();
    let text = std::fs::read_to_string(bench.path("out/trajectory.csv")).unwrap();
    let rows: Vec<Vec<&str>> = text
        .lines()
        .skip(1)
        .map(|line| line.split(',').collect())
        .collect();
    let number = |text: &str| text.parse::<f64>().unwrap();
    for row in [&rows[0], &rows[rows.len() / 2], &rows[rows.len() - 1]] {
        let reference = cell.plan.reference(number(row[0]));
        assert_eq!(row[1], reference.phase.name());
        for joint in 0..6 {
            assert!((number(row[4 + joint]) - reference.position[joint]).abs() < 1e-6);
            assert!((number(row[10 + joint]) - reference.velocity[joint]).abs() < 1e-5);
        }
    }
    let bytes = std::fs::read(bench.path("out/trajectory.mcap")).unwrap();
    let messages: Vec<_> = mcap::MessageStream::new(&bytes)
        .unwrap()
        .map(Result::unwrap)
        .collect();
    let [message] = messages.as_slice() else {
        panic!("{} messages", messages.len());
    };
    assert_eq!(message.channel.topic, "/joint_trajectory");
    let data = &message.data[4..];
    let mut at = 0;
    let word = |at: &mut usize| {
        *at = at.next_multiple_of(4);
        let value = u32::from_le_bytes(data[*at..*at + 4].try_into().unwrap()) as usize;
        *at += 4;
        value
    };
    // Stamp, an empty frame, then the names.
    word(&mut at);
    word(&mut at);
    at = at + 4 + 1;
    let names: Vec<String> = (0..word(&mut at))
        .map(|_| {
            let length = word(&mut at);
            at += length;
            String::from_utf8(data[at - length..at - 1].to_vec()).unwrap()
        })
        .collect();
    assert_eq!(names[0], "shoulder_pan");
    let points = word(&mut at);
    assert_eq!(points, rows.len());
    for row in &rows {
        for column in [Some(4), Some(10), Some(16), None] {
            let count = word(&mut at);
            assert_eq!(count, if column.is_some() { 6 } else { 0 });
            for joint in 0..count {
                at = at.next_multiple_of(8);
                let value = f64::from_le_bytes(data[at..at + 8].try_into().unwrap());
                at += 8;
                assert!((value - number(row[column.unwrap() + joint])).abs() < 1e-8);
            }
        }
        let (seconds, nanoseconds) = (word(&mut at), word(&mut at));
        assert!((seconds as f64 + 1e-9 * nanoseconds as f64 - number(row[0])).abs() < 1e-6);
    }
    assert_eq!(at, data.len());
}

/// What a dialect cannot say is refused in one line that says the way out, and nothing is written.
#[test]
fn what_a_dialect_cannot_say_is_refused() {
    const TABLE: &str = "output_forces_n = [0, 200]\noutput_values = [0, 1]";
    const NAMED: &str = "[program]\nforce_output = \"ao\"";
    let joint: &[&str] = &["--moves", "joint"];
    for (dialect, more, robot, [old, new], expected) in [
        ("krl", &[][..], Some("ur10e"), [""; 2], "--dialect urscript"),
        ("rapid", &[], Some("panda_arm"), [""; 2], "no --dialect"),
        ("krl", &[], None, [""; 2], "--moves joint"),
        ("fanuc_ls", joint, None, [""; 2], "program.joint_3_by_2"),
        (
            "fanuc_ls",
            &[],
            Some("plain"),
            [TABLE, ""],
            "program.output_forces_n",
        ),
        (
            "urscript",
            &[],
            None,
            ["[0, 200]", "[0, 120]"],
            "output_forces_n goes from 0 to 120",
        ),
        (
            "urscript",
            &[],
            None,
            ["[program]", NAMED],
            "program.force_output",
        ),
    ] {
        let bench = bench(robot);
        if !old.is_empty() {
            bench.replace("scenario.toml", old, new);
        }
        let arguments = [
            &[
                "export",
                "program",
                "scenario.toml",
                "--out",
                "out",
                "--dialect",
                dialect,
            ],
            more,
        ]
        .concat();
        let before = bench.contents();
        let refused = bench.idc(&arguments, &[]);
        assert_eq!(refused.code, 2, "{dialect}: {}", refused.out);
        assert!(
            refused.sentences().contains(expected),
            "{dialect}: {}",
            refused.err
        );
        assert!(refused.sentences().contains("expected"), "{}", refused.err);
        refused.only_line("error");
        assert_eq!(before, bench.contents(), "something was written");
    }
}

#[test]
fn an_arm_of_five_joints_is_refused() {
    let bench = bench(None);
    let urdf = std::fs::read_to_string(bench.path("arm.urdf")).unwrap();
    let other = urdf.replacen(
        "<joint name=\"wrist_3\" type=\"revolute\">",
        "<joint name=\"wrist_3\" type=\"fixed\">",
        1,
    );
    assert_ne!(urdf, other);
    bench.write("arm.urdf", other);
    let refused = bench.idc(
        &[
            "export",
            "program",
            "scenario.toml",
            "--out",
            "out",
            "--dialect",
            "urscript",
        ],
        &[],
    );
    assert_eq!(refused.code, 2);
    assert!(
        refused.err.contains("5 axes") && refused.err.contains("trajectory.csv"),
        "{}",
        refused.err
    );
}

/// A controller's base that is turned, and a flange of its own, as ROS-Industrial's files have them, leave the tool where it is.
#[test]
fn the_controllers_base_and_flange_are_those_of_the_urdf() {
    let plain = exported(&bench(None), Dialect::Urscript, "cartesian");
    let turned = bench(None);
    let frames = "<joint name=\"b\" type=\"fixed\"><parent link=\"base_link\"/><child link=\"base\"/><origin xyz=\"0 0 0.1\" rpy=\"0 0 3.141592653589793\"/></joint><link name=\"base\"/><joint name=\"f\" type=\"fixed\"><parent link=\"flange\"/><child link=\"tool0\"/><origin xyz=\"0 0 0.01\" rpy=\"0 0 1.5707963267948966\"/></joint><link name=\"tool0\"/></robot>";
    turned.replace("arm.urdf", "</robot>", frames);
    let turned = exported(&turned, Dialect::Urscript, "cartesian");
    let of = |program: &Program| {
        let found = program.steps.iter().filter_map(|step| match step {
            Step::Tool(frame) | Step::Frame(frame) => frame.pose,
            _ => None,
        });
        found.collect::<Vec<DPose3>>()
    };
    let (plain, turned) = (of(&plain), of(&turned));
    let flange_from_tool0 = DPose3::from_parts(
        DVec3::Z * 0.01,
        DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2),
    );
    let base_link_from_base =
        DPose3::from_parts(DVec3::Z * 0.1, DQuat::from_rotation_z(std::f64::consts::PI));
    for (one, other) in [
        (plain[0], flange_from_tool0 * turned[0]),
        (plain[1], base_link_from_base * turned[1]),
    ] {
        assert!((one.translation - other.translation).length() < 1e-6);
        assert!(one.rotation.angle_between(other.rotation) < 1e-6);
    }
}
