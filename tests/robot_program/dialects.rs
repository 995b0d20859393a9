//! Programs written and read back, orientations by hand, and programs in the form of published ones.

use glam::{DMat3, DQuat, DVec3};
use glamx::DPose3;
use idc_cell::robot_program::{
    Configuration, Dialect, Frame, Move, Posture, Program, Step, Target, Timing, Way, Zone,
    configuration, deviation, read, write,
};

/// A number between -1 and 1 that looks random.
fn noise(state: &mut u64) -> f64 {
    *state = state
        .wrapping_mul(6_364_136_223_846_793_005)
        .wrapping_add(1_442_695_040_888_963_407);
    (*state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

fn pose(state: &mut u64) -> DPose3 {
    let [x, y, z, i, j, k, w] = std::array::from_fn(|_| noise(state));
    DPose3::from_parts(
        DVec3::new(x, y, z) * 1.3,
        DQuat::from_xyzw(i, j, k, w).normalize(),
    )
}

fn frame(pose: DPose3) -> Frame {
    Frame {
        name: String::new(),
        pose: Some(pose),
    }
}

/// A configuration as the dialect has them.
fn posed(dialect: Dialect, index: i32) -> Option<Configuration> {
    let turns = [index % 3 - 1, -(index % 2), 1];
    match dialect {
        Dialect::Urscript => None,
        Dialect::Krl => Some(Configuration::StatusTurn {
            status: index as u32 % 8,
            turn: index as u32 * 7 % 64,
        }),
        Dialect::Rapid => Some(Configuration::Quarters {
            turns,
            posture: index % 8,
        }),
        Dialect::FanucLs => Some(Configuration::Flags {
            flip: index % 2 == 0,
            up: index % 3 == 0,
            top: index % 5 != 0,
            turns,
        }),
    }
}

/// What the dialect says in place of a corner of a radius.
fn corner(dialect: Dialect, radius: f64) -> Zone {
    match dialect {
        Dialect::FanucLs => Zone::Share(1.0),
        _ => Zone::Within(radius),
    }
}

/// A program of all that the dialect can say, of numbers that look random.
fn drawn(dialect: Dialect, seed: u64) -> Program {
    let mut state = seed;
    let output = if dialect == Dialect::Rapid {
        "aoForce"
    } else {
        "1"
    };
    let mut steps = vec![
        Step::Tool(frame(pose(&mut state))),
        Step::Frame(frame(pose(&mut state))),
    ];
    for pass in 1..=3 {
        steps.push(Step::Note(format!("pass {pass}: follow")));
        let value = if dialect == Dialect::FanucLs {
            400.0
        } else {
            0.2
        };
        steps.push(Step::Output {
            output: output.to_owned(),
            value: value * f64::from(pass),
        });
        for index in 0..40 {
            let speed = 0.011 * (4.0 * noise(&mut state)).exp2();
            steps.push(Step::Move(Move {
                way: Way::Line,
                target: Target::Pose {
                    pose: pose(&mut state),
                    configuration: posed(dialect, index),
                },
                timing: Some(Timing::Speed(speed.max(0.0085))),
                zone: if index == 39 {
                    Zone::Stop
                } else {
                    corner(dialect, 0.001 + 0.0001 * f64::from(index))
                },
            }));
        }
        steps.push(Step::Wait(0.5));
        let joints: Vec<[f64; 6]> = (0..20)
            .map(|_| std::array::from_fn(|_| 3.0 * noise(&mut state)))
            .collect();
        for (index, joints) in joints.into_iter().enumerate() {
            let is_last = index == 19;
            let timed = dialect != Dialect::FanucLs;
            steps.push(Step::Move(Move {
                way: if timed { Way::Joint } else { Way::Line },
                target: Target::Joints(joints),
                timing: Some(if timed {
                    Timing::Duration(0.2 + 0.1 * noise(&mut state))
                } else {
                    Timing::Speed(0.1)
                }),
                zone: match dialect {
                    _ if is_last => Zone::Stop,
                    Dialect::Krl => Zone::Through,
                    _ => corner(dialect, 0.002),
                },
            }));
        }
    }
    Program {
        name: "DRAWN".to_owned(),
        steps,
    }
}

#[test]
fn what_is_written_is_read_back() {
    for dialect in Dialect::ALL {
        let mut worst = idc_cell::robot_program::Deviation::default();
        for seed in 1..=20 {
            let program = drawn(dialect, seed);
            let text = write(dialect, &program);
            let back = read(dialect, &text)
                .unwrap_or_else(|error| panic!("{}: {error}\n{text}", dialect.name()));
            let found = deviation(&program, &back)
                .unwrap_or_else(|what| panic!("{}: {what}\n{text}", dialect.name()));
            worst.position = worst.position.max(found.position);
            worst.angle = worst.angle.max(found.angle);
            worst.joint = worst.joint.max(found.joint);
            worst.timing = worst.timing.max(found.timing);
            let notes = |program: &Program| -> Vec<String> {
                let notes = program.steps.iter().filter_map(|step| match step {
                    Step::Note(note) if note.starts_with("pass") => Some(note.clone()),
                    _ => None,
                });
                notes.collect()
            };
            assert_eq!(notes(&program), notes(&back));
            assert_eq!(back.name, program.name);
        }
        println!(
            "{}: {:.3} um, {:.2e} deg, joints {:.2e} deg, speeds {:.4} %",
            dialect.name(),
            1e6 * worst.position,
            worst.angle.to_degrees(),
            worst.joint.to_degrees(),
            100.0 * worst.timing
        );
        assert!(
            worst.position < 1e-6 && worst.angle.to_degrees() < 1e-3,
            "{worst:?}"
        );
        let digits = if dialect == Dialect::FanucLs {
            5.1e-4
        } else {
            1e-6
        };
        assert!(
            worst.joint.to_degrees() < digits && worst.timing < 1e-3,
            "{worst:?}"
        );
    }
}

/// The only pose of a program of one line.
fn only(dialect: Dialect, rotation: DQuat) -> String {
    let program = Program {
        name: "ONE".to_owned(),
        steps: vec![Step::Move(Move {
            way: Way::Line,
            target: Target::Pose {
                pose: DPose3::from_parts(DVec3::new(0.1, -0.2, 0.3), rotation),
                configuration: None,
            },
            timing: Some(Timing::Speed(0.1)),
            zone: Zone::Stop,
        })],
    };
    write(dialect, &program)
}

/// Numbers behind a name in a text.
fn behind(text: &str, name: &str) -> f64 {
    let (_, rest) = text
        .split_once(name)
        .unwrap_or_else(|| panic!("no {name} in {text}"));
    let rest = rest.trim_start_matches([' ', '=', ',', '[']);
    let end = rest.find(|c: char| !c.is_ascii_digit() && !matches!(c, '-' | '.'));
    rest[..end.unwrap_or(rest.len())].parse().unwrap()
}

fn turn_x(angle: f64) -> DMat3 {
    let (s, c) = angle.sin_cos();
    DMat3::from_cols(DVec3::X, DVec3::new(0.0, c, s), DVec3::new(0.0, -s, c))
}

fn turn_y(angle: f64) -> DMat3 {
    let (s, c) = angle.sin_cos();
    DMat3::from_cols(DVec3::new(c, 0.0, -s), DVec3::Y, DVec3::new(s, 0.0, c))
}

fn turn_z(angle: f64) -> DMat3 {
    let (s, c) = angle.sin_cos();
    DMat3::from_cols(DVec3::new(c, s, 0.0), DVec3::new(-s, c, 0.0), DVec3::Z)
}

/// Orientations as the makers define them, each by matrices of its own; in the singular ones too.
#[test]
fn orientations_are_those_of_the_makers() {
    let mut state = 5;
    let mut turns: Vec<DQuat> = (0..50).map(|_| pose(&mut state).rotation).collect();
    turns.push(DQuat::IDENTITY);
    turns.push(DQuat::from_rotation_x(std::f64::consts::PI));
    turns.push(DQuat::from_rotation_z(0.4) * DQuat::from_rotation_y(std::f64::consts::FRAC_PI_2));
    for rotation in turns {
        let wanted = DMat3::from_quat(rotation);
        let near = |found: DMat3, digits: f64, what: &str| {
            let off = (found - wanted)
                .to_cols_array()
                .into_iter()
                .fold(0.0, |most: f64, one| most.max(one.abs()));
            assert!(off < digits, "{what}: {off} of {rotation:?}");
        };
        let krl = only(Dialect::Krl, rotation);
        let line = krl.lines().find(|line| line.contains("LIN")).unwrap();
        let [a, b, c] = ["A ", "B ", "C "].map(|name| behind(line, name).to_radians());
        // A, B, C: about z, the new y, the new x.
        near(turn_z(a) * turn_y(b) * turn_x(c), 1e-7, "KRL");
        assert_eq!(
            ["X ", "Y ", "Z "].map(|name| behind(line, name)),
            [100.0, -200.0, 300.0]
        );

        let fanuc = only(Dialect::FanucLs, rotation);
        let [w, p, r] = ["\tW =", "\tP =", "\tR ="].map(|name| behind(&fanuc, name).to_radians());
        // W, P, R: about the fixed x, then y, then z.
        near(turn_z(r) * (turn_y(p) * turn_x(w)), 5e-5, "FANUC");

        let rapid = only(Dialect::Rapid, rotation);
        let (_, q) = rapid
            .split_once("MoveL [[")
            .unwrap()
            .1
            .split_once("],[")
            .unwrap();
        let q: Vec<f64> = q
            .split_once(']')
            .unwrap()
            .0
            .split(',')
            .map(|value| value.parse().unwrap())
            .collect();
        let [w, x, y, z] = q.as_slice() else {
            panic!("{rapid}")
        };
        let matrix = DMat3::from_cols(
            DVec3::new(
                1.0 - 2.0 * (y * y + z * z),
                2.0 * (x * y + w * z),
                2.0 * (x * z - w * y),
            ),
            DVec3::new(
                2.0 * (x * y - w * z),
                1.0 - 2.0 * (x * x + z * z),
                2.0 * (y * z + w * x),
            ),
            DVec3::new(
                2.0 * (x * z + w * y),
                2.0 * (y * z - w * x),
                1.0 - 2.0 * (x * x + y * y),
            ),
        );
        near(matrix, 1e-8, "RAPID");

        let script = only(Dialect::Urscript, rotation);
        let (_, values) = script.split_once("p[").unwrap();
        let values: Vec<f64> = values
            .split_once(']')
            .unwrap()
            .0
            .split(',')
            .map(|value| value.parse().unwrap())
            .collect();
        assert_eq!(values[..3], [0.1, -0.2, 0.3]);
        let vector = DVec3::new(values[3], values[4], values[5]);
        let angle = vector.length();
        let axis = vector.normalize_or_zero();
        // Rodrigues' formula.
        let cross = DMat3::from_cols(
            DVec3::X.cross(axis),
            DVec3::Y.cross(axis),
            DVec3::Z.cross(axis),
        ) * -1.0;
        let matrix = DMat3::IDENTITY + cross * angle.sin() + cross * cross * (1.0 - angle.cos());
        near(matrix, 1e-7, "URScript");
    }
}

/// Axes of an upright arm with lower and upper arm of 0.6 m, at angles from straight up and from straight on [rad].
fn upright(first: f64, second: f64, third: f64) -> [(DVec3, DVec3); 6] {
    let about = |angle: f64, point: DVec3| {
        DQuat::from_rotation_z(first) * (DQuat::from_rotation_y(angle) * point)
    };
    let lean = about(0.0, DVec3::Y);
    let elbow = about(second, DVec3::Z * 0.6);
    let along = about(second + third, DVec3::Z);
    let wrist = elbow + 0.6 * along;
    let across = about(second + third + 0.3, DVec3::X);
    [
        (DVec3::ZERO, DVec3::Z),
        (DVec3::ZERO, lean),
        (elbow, lean),
        (elbow, along),
        (wrist, lean),
        (wrist, across),
    ]
}

#[test]
fn configurations_are_those_of_the_manuals() {
    let of = |first: f64, second: f64, third: f64| {
        Posture::of(&upright(first, second, third), first).unwrap()
    };
    // Upright, forearm forward: KUKA's usual status 2 with A5 above 0, RAPID's 0, FANUC's N U T with the wrist bent down.
    let usual = of(0.2, 0.1, 1.4);
    assert_eq!((usual.front, usual.before_arm), (true, true));
    let joints = [0.2, -1.6, 1.5, -0.1, 0.8, -2.0];
    let krl = configuration(Dialect::Krl, usual, &joints).unwrap();
    assert_eq!(
        krl,
        Some(Configuration::StatusTurn {
            status: 0b010,
            turn: 0b10_1010
        })
    );
    let rapid = configuration(Dialect::Rapid, usual, &joints).unwrap();
    assert_eq!(
        rapid,
        Some(Configuration::Quarters {
            turns: [0, -1, -2],
            posture: 0
        })
    );
    let mut down = joints;
    (down[4], down[5]) = (-1.5, 4.0);
    let fanuc = configuration(Dialect::FanucLs, usual, &down).unwrap();
    assert_eq!(
        fanuc,
        Some(Configuration::Flags {
            flip: false,
            up: true,
            top: true,
            turns: [0, 0, 1]
        })
    );
    // The elbow the other way round, and the wrist behind axis 1.
    let below = of(-2.0, 1.4, -1.0);
    assert_eq!((below.front, below.before_arm), (true, false));
    let behind = of(1.0, -1.2, -0.6);
    assert_eq!((behind.front, behind.before_arm), (false, false));
    let quarters = configuration(Dialect::Rapid, behind, &down).unwrap();
    assert_eq!(
        quarters,
        Some(Configuration::Quarters {
            turns: [0, -1, 2],
            posture: 7
        })
    );
    let status = configuration(Dialect::Krl, behind, &down).unwrap();
    assert!(
        matches!(
            status,
            Some(Configuration::StatusTurn { status: 0b101, .. })
        ),
        "{status:?}"
    );
    assert!(configuration(Dialect::FanucLs, behind, &down).is_err());
    // A wrist whose axes do not meet has no such names.
    let mut offset = upright(0.0, 0.1, 1.4);
    offset[5].0 += offset[4].1 * 0.1;
    assert!(Posture::of(&offset, 0.0).is_err());
}

/// A program in the form of a published one: its dialect, text, moves, the position of one of them [mm], its speed and zone, and a way to spoil it ten times.
struct Published {
    dialect: Dialect,
    text: &'static str,
    moves: usize,
    /// Number of a move with its position [mm] and timing.
    known: (usize, [f64; 3], Timing),
    spoiled: [(&'static str, &'static str); 10],
}

const PUBLISHED: [Published; 8] = [
    // As in <https://github.com/UniversalRobots/Universal_Robots_ROS2_Driver>, ur_robot_driver/doc/usage/script_code.rst.
    Published {
        dialect: Dialect::Urscript,
        text: "def my_prog():\n  set_digital_out(1, True)\n  movej(p[-0.25, -0.35, 0.75, 0.8, 1.1, 3.0], a=1.2, v=0.25, r=0)\n  movel(p[-0.25, 0.2, 0.4, 0, 0, 3.14], a=0.5, v=0.1, r=0.01)\n  textmsg(\"done\")\nend\n",
        moves: 2,
        known: (1, [-250.0, 200.0, 400.0], Timing::Speed(0.1)),
        spoiled: [
            ("def my_prog():", "def my_prog()"),
            ("end\n", ""),
            ("p[-0.25, -0.35, ", "p[-0.25, "),
            ("v=0.25", "v=-0.25"),
            ("v=0.25, r", "v=0.25, v"),
            ("movej(", "movex("),
            ("3.14]", "3.14"),
            ("r=0.01)", "r=0.01"),
            ("a=0.5", "b=0.5"),
            ("textmsg(\"done\")", "textmsg(\"done)"),
        ],
    },
    // As PolyScope writes strokes in a feature (the manual, "pose_trans"): speeds by name, moves in the frame.
    Published {
        dialect: Dialect::Urscript,
        text: "def draw():\n  global accel_mss = 0.6\n  global speed_ms = 0.05\n  set_tcp(p[0.0, 0.0, 0.12, 0.0, 0.0, 0.0])\n  feature = p[0.3, -0.4, 0.1, 0.0, 2.2, 0.0]\n  q_start = [-1.57, -1.2, -1.8, 2.9, -1.57, 0]\n  movej(q_start, 1.4, 1.05, 0, 0)\n  movel(pose_trans(feature, p[0.01, 0.18, 0.02, 0, 0, 0]), accel_mss, speed_ms, 0, 0.001)\n  movel(pose_trans(feature, p[0.05, 0.18, 0.02, 0, 0, 0]), accel_mss, speed_ms, 4)\n  set_standard_analog_out(0, 0.5)\n  sleep(0.5)\nend\ndraw()\n",
        moves: 3,
        known: (1, [10.0, 180.0, 20.0], Timing::Speed(0.05)),
        spoiled: [
            ("feature = p[", "part = p["),
            ("accel_mss = 0.6", "accel_mss = "),
            ("q_start = [-1.57, ", "q_start = ["),
            ("pose_trans(feature, ", "pose_trans(feature "),
            ("sleep(0.5)", "sleep(-1)"),
            ("set_tcp(p[", "set_tcp(["),
            ("speed_ms, 0, 0.001)", "speed_ms, 0, 0.001, 7)"),
            ("analog_out(0, 0.5)", "analog_out(0.5, 0.5)"),
            ("movej(q_start", "movej(accel_mss"),
            ("\ndraw()", "\ndrew()"),
        ],
    },
    // As in <https://github.com/RoboDK/RoboDK-API>, the macro that loads a program of KUKA, "Example program" in its comment.
    Published {
        dialect: Dialect::Krl,
        text: "DEF Milling ( )\n\n$BASE = {FRAME: X 10.000,Y -900.000,Z 0.000,A 0.000,B 0.000,C 0.000}\n$TOOL = {FRAME: X 400.5,Y -4.5,Z 100.25,A -0.000,B 90.000,C 0.000}\n\n$VEL.CP = 1.00000\n\nPTP {A1 100.5,A2 -45.25,A3 140.5,A4 107.5,A5 -87.5,A6 6.25}\nLIN {X -0.000,Y -0.000,Z 6.350,A -180.000,B 0.000,C -180.000}\n\n$VEL.CP = 0.02117\nLIN {X 250.000,Y 0.000,Z 6.350,A 180.000,B 0.000,C -180.000}\nLIN {X 250.000,Y 300.000,Z 6.350,A -160.000,B 0.000,C 180.000}\nEND\n",
        moves: 4,
        known: (2, [250.0, 0.0, 6.35], Timing::Speed(0.02117)),
        spoiled: [
            ("DEF Milling ( )", "DEF Milling ("),
            ("\nEND", "\n"),
            ("A5 -87.5,", ""),
            ("LIN {X -0.000", "LIN {X -0.0.00"),
            ("$VEL.CP = 1.00000", "$VEL.CP = 0"),
            ("$VEL.CP = 0.02117", "$VEL.XY = 0.02117"),
            ("C 180.000}", "C 180.000"),
            ("$TOOL = {FRAME: X", "$TOOL = {FRAME: A1"),
            ("PTP {A1 100.5", "LIN {A1 100.5"),
            ("LIN {X 250", "LNI {X 250"),
        ],
    },
    // As in the programs that BasisTech's forms write: <https://github.com/Hungsiu/WtRobotTraining>, and with S and T "KRL Reference Guide 4.1", PTP.
    Published {
        dialect: Dialect::Krl,
        text: "&ACCESS RVP\n&REL 1\n&PARAM TEMPLATE = C:\\KRC\\Roboter\\Template\\vorgabe\nDEF Cut ( )\nEXT BAS (BAS_COMMAND :IN,REAL :IN )\n;FOLD INI\nBAS (#INITMOV,0)\nBAS (#VEL_PTP,50)\nBAS (#TOOL,1)\nBAS (#BASE,2)\n;ENDFOLD\n$ADVANCE = 3\n$APO.CDIS = 1.5\n$VEL.CP=0.2\nPTP {X 900.5,Y 10.0,Z 700.0,A 0.0,B 90.0,C 0.0,S 'B 110',T 'B 110010',E1 0.0}\nLIN {X 950.0,Y 10.0,Z 700.0,A 0.0,B 90.0,C 0.0,S 6,T 50} C_DIS\nWAIT SEC 0.5\n$ANOUT[1]=0.4\nLIN {X 990.0,Y 10.0,Z 700.0,A 0.0,B 90.0,C 0.0}\nEND\n",
        moves: 3,
        known: (1, [950.0, 10.0, 700.0], Timing::Speed(0.2)),
        spoiled: [
            ("'B 110'", "'B 120'"),
            ("'B 110010'", "'B 1110010'"),
            ("S 6,T 50", "S 6"),
            ("E1 0.0", "E1 5.0"),
            ("} C_DIS", "} C_DES"),
            ("VEL_PTP,50", "VEL_PTP,150"),
            ("WAIT SEC 0.5", "WAIT 0.5"),
            ("$ANOUT[1]=0.4", "$ANOUT[1]=on"),
            ("CDIS = 1.5", "CDIS = -1.5"),
            ("B 90.0,C 0.0}", "C 0.0}"),
        ],
    },
    // As in <https://github.com/TPHugo/TimovyProjekt>, Stavbar/Stavbar24.9/test_4.mod: targets in their moves.
    Published {
        dialect: Dialect::Rapid,
        text: "! TACO Target Robot: T_ROB1\nMODULE MainModule\nVAR speeddata Work:= [100,20,5000,1000];\nPERS tooldata custom_tool1 := [TRUE, [[-140.5,-150.5,30.25], [0.707107,0.5,-0.5,0]], [0.1,[0.10,0.00,0.00],[1,0,0,0],0,0,0]];\nPROC Main()\nConfL \\Off;\nMoveJ [[20,400,140.5],[-0.174713,0.907209,0.375778,0.072368],[0,-1,-1,0],[0,9E9,9E9,9E9,9E9,9E9]],Work,z1,custom_tool1\\WObj:=WObj0;\nIF TestDI(Ready) THEN\nWaitDI Ready, 0;\nENDIF\nWaitTime 0.9;\nSetDO Gripper_open, 0;\nMoveL [[20,500,40.5],[-0.174713,0.907209,0.375778,0.072368],[0,-1,-1,0],[0,9E9,9E9,9E9,9E9,9E9]],Work,fine,custom_tool1\\WObj:=WObj0;\nENDPROC\nENDMODULE\n",
        moves: 2,
        known: (1, [20.0, 500.0, 40.5], Timing::Speed(0.1)),
        spoiled: [
            ("[0.707107,0.5,-0.5,0]", "[0.8,0.5,-0.5,0]"),
            ("0.375778", "0.575778"),
            ("Work:= [100", "Work:= [0"),
            ("],Work,z1", "],Walk,z1"),
            ("z1,", "z3,"),
            ("[0,-1,-1,0]", "[0,-1,-1,9]"),
            ("WaitTime 0.9;", "WaitTime 0.9"),
            ("ENDPROC\n", ""),
            ("MoveL [[20,500,40.5]", "MoveL [[20,500]"),
            ("fine,custom_tool1\\WObj:=", "fine,custom_tool1\\Wobject:="),
        ],
    },
    // As RobotStudio writes paths (the manual, "robtarget"): targets by name, a work object.
    Published {
        dialect: Dialect::Rapid,
        text: "MODULE Module1\n    CONST jointtarget Home:=[[0,0,0,0,30,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];\n    TASK PERS wobjdata Table:=[FALSE,TRUE,\"\",[[450,550,77],[0.707106781,0,0,-0.707106781]],[[0,0,0],[1,0,0,0]]];\n    CONST robtarget Target_10:=[[450.5,700.25,240],[0,0.707106781,0.707106781,0],[0,1,-2,0],\n        [9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];\n    CONST robtarget Target_20:=[[450.5,700.25,90],[0,0.707106781,0.707106781,0],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];\n\n    PROC Path_10()\n        MoveAbsJ Home,v500,z100,tool0;\n        MoveL Target_10,v500,fine,tool0\\WObj:=Table;\n        SetAO aoForce, 4.5;\n        MoveL Target_20,v20\\T:=2.5,z0,tool0\\WObj:=Table;\n    ENDPROC\nENDMODULE\n",
        moves: 3,
        known: (2, [450.5, 700.25, 90.0], Timing::Duration(2.5)),
        spoiled: [
            ("Home:=[[0,0,0,0,30,0]", "Home:=[[0,0,0,0,30]"),
            ("Target_10:=", "Target_11:="),
            ("MoveAbsJ Home", "MoveJ Home"),
            ("MoveL Target_20", "MoveAbsJ Target_20"),
            ("v500,z100", "v500"),
            ("T:=2.5", "T:=0"),
            ("SetAO aoForce, 4.5", "SetAO aoForce"),
            ("[FALSE,TRUE,\"\",", "[FALSE,\"\","),
            ("ENDMODULE", "ENDMODUL"),
            ("z0,tool0", "zero,tool0"),
        ],
    },
    // As in <https://github.com/onerobotics/go-fanuc>, testdata/md/test.ls.
    Published {
        dialect: Dialect::FanucLs,
        text: "/PROG  TEST\n/ATTR\nOWNER\t\t= MNEDITOR;\nCOMMENT\t\t= \"\";\nTCD:  STACK_SIZE\t= 0,\n      TASK_PRIORITY\t= 50;\nDEFAULT_GROUP\t= 1,*,*,*,*;\n/APPL\n\nAUTO_SINGULARITY_HEADER;\n  ENABLE_SINGULARITY_AVOIDANCE   : FALSE;\n/MN\n   1:J P[2:test 123] 100% FINE    ;\n   2:J P[1] 100% FINE    ;\n/POS\nP[1]{\n   GP1:\n\tUF : 0, UT : 1,\t\tCONFIG : 'N U T, 0, 0, 0',\n\tX =  1295.220  mm,\tY =  -398.150  mm,\tZ =  1301.200  mm,\n\tW =   -31.640 deg,\tP =    88.200 deg,\tR =   147.540 deg\n};\nP[2:\"test 123\"]{\n   GP1:\n\tUF : 0, UT : 1,\t\tCONFIG : 'F D B, -1, -1, 1',\n\tX =  1153.500  mm,\tY = -1754.150  mm,\tZ =   493.000  mm,\n\tW =    90.147 deg,\tP =      .582 deg,\tR =     -.593 deg\n};\n/END\n",
        moves: 2,
        known: (0, [1153.5, -1754.15, 493.0], Timing::Share(1.0)),
        spoiled: [
            ("J P[1] 100%", "J P[3] 100%"),
            ("100% FINE    ;\n   2", "110% FINE    ;\n   2"),
            ("FINE    ;\n/POS", "FINA    ;\n/POS"),
            ("'N U T, 0, 0, 0'", "'N V T, 0, 0, 0'"),
            ("'F D B, -1, -1, 1'", "'F D B, -1, -1'"),
            ("Y =  -398.150  mm,", ""),
            ("1295.220  mm", "1295.220  cm"),
            ("/END", ""),
            (
                "GP1:\n\tUF : 0, UT : 1,\t\tCONFIG : 'N",
                "GP2:\n\tUF : 0, UT : 1,\t\tCONFIG : 'N",
            ),
            ("P[2:\"test 123\"]{", "P[1:\"test 123\"]{"),
        ],
    },
    // As in <https://github.com/GilbertPan97/HandEyeSync>, data/Projects/LeiChi-04.25/camera0/calib_c0.ls, with joint angles in one position.
    Published {
        dialect: Dialect::FanucLs,
        text: "/PROG  CALIB_C0\n/ATTR\nOWNER\t\t= MNEDITOR;\n/MN\n   1:   ;\n   2:  UTOOL_NUM=4 ;\n   3:  UFRAME_NUM=0 ;\n   4:  OVERRIDE=30% ;\n   5:   ;\n   6:  !TRANSLATION ;\n   7:J P[1] 20% CNT50 ACC50    ;\n   8:L P[2:REF] 100mm/sec CNT100    ;\n   9:  WAIT    .50(sec) ;\n  10:  AO[1:COMPENSATION]=350 ;\n  11:  CALL VACUUM_OFF    ;\n  12:L P[2:REF] 25.5cm/min FINE    ;\n/POS\nP[1]{\n   GP1:\n\tUF : 0, UT : 4,\n\tJ1=     5.500 deg,\tJ2=    12.250 deg,\tJ3=   -45.000 deg,\n\tJ4=     0.000 deg,\tJ5=     -.500 deg,\tJ6=   200.000 deg\n};\nP[2:\"REF\"]{\n   GP1:\n\tUF : 0, UT : 4,\t\tCONFIG : 'N U T, 0, 0, 0',\n\tX =  -333.800  mm,\tY =  1579.200  mm,\tZ =   356.600  mm,\n\tW =  -175.389 deg,\tP =   -39.284 deg,\tR =     -.384 deg\n};\n/END\n",
        moves: 3,
        known: (1, [-333.8, 1579.2, 356.6], Timing::Speed(0.1)),
        spoiled: [
            ("UTOOL_NUM=4", "UTOOL_NUM=on"),
            ("20% CNT50", "20mm/sec CNT50"),
            ("100mm/sec CNT100", "100% CNT100"),
            ("CNT100", "CNT101"),
            ("25.5cm/min", "25.5cm/hour"),
            ("J4=     0.000 deg,\t", ""),
            ("J2=    12.250 deg", "J2=    12.250 mm"),
            ("AO[1:COMPENSATION]=350", "AO[1:COMPENSATION]="),
            ("ACC50    ;", "ACC50"),
            ("   8:L P[2:REF]", "   8:C P[2:REF]"),
        ],
    },
];

#[test]
fn programs_in_the_form_of_published_ones_are_read() {
    for Published {
        dialect,
        text,
        moves,
        known: (index, position, timing),
        ..
    } in &PUBLISHED
    {
        let program = read(*dialect, text)
            .unwrap_or_else(|error| panic!("{}: {error}\n{text}", dialect.name()));
        assert_eq!(program.moves().count(), *moves, "{text}");
        let one = program.moves().nth(*index).unwrap();
        let Target::Pose { pose, .. } = &one.target else {
            panic!("{one:?}");
        };
        assert!(
            (pose.translation * 1e3 - DVec3::from_array(*position)).length() < 1e-9,
            "{pose:?}"
        );
        let ((Some(Timing::Speed(found)), Timing::Speed(wanted))
        | (Some(Timing::Duration(found)), Timing::Duration(wanted))
        | (Some(Timing::Share(found)), Timing::Share(wanted))) = (one.timing, *timing)
        else {
            panic!("{one:?}");
        };
        assert!((found - wanted).abs() < 1e-9);
    }
}

/// Each is one fault of a program that is read without it.
#[test]
fn spoiled_programs_are_refused_with_their_line() {
    for Published {
        dialect,
        text,
        spoiled,
        ..
    } in &PUBLISHED
    {
        for (from, to) in spoiled {
            assert!(text.contains(from), "{from:?} is not in {text}");
            let other = text.replacen(from, to, 1);
            match read(*dialect, &other) {
                Ok(program) => panic!(
                    "{}: {from:?} as {to:?} is read: {:?}",
                    dialect.name(),
                    program.steps
                ),
                Err(error) => assert!(error.to_string().starts_with("line "), "{error}"),
            }
        }
    }
}
