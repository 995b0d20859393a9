//! Each key reaches its own field, in SI.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec3;

use super::super::{
    BurrScenario, Direction, DriveScenario, EdgeSelection, Expectation, LimitOverride,
    Misplacement, ObstacleShape, ProcessScenario, ServoScenario, SimulationScenario,
};
use super::{MINIMAL, edited, read, scenarios};
use crate::plant::ContactParameters;

#[test]
fn every_key_of_the_process_reaches_its_field() {
    let text = edited(
        "feed_mm_per_s = 20\n",
        "feed_mm_per_s = 21\ncorner_feed_mm_per_s = 7\nacceleration_mm_per_s2 = 600\njerk_mm_per_s3 = 7000\nworking_stroke_mm = 18\nlean_deg = -45\nroll_deg = 90\n\
         approach_distance_mm = 60\napproach_speed_mm_per_s = 110\nengage_speed_mm_per_s = 25\nsettle_time_s = 1.5\n",
    );
    let expected = ProcessScenario {
        force: 150.0,
        feed: 0.021,
        corner_feed: 0.007,
        lateral_acceleration: f64::INFINITY,
        acceleration: 0.6,
        jerk: 7.0,
        working_stroke: 0.018,
        lean: -PI / 4.0,
        passes: 1,
        feed_follows: None,
        tool_axis: None,
        roll: Some(FRAC_PI_2),
        approach_distance: 0.06,
        approach_speed: 0.11,
        engage_speed: 0.025,
        settle_time: 1.5,
    };
    assert_eq!(read(&text).unwrap().process, expected);
}

#[test]
fn the_tool_s_axis_is_a_word_or_a_direction_in_place_of_a_lean() {
    let with = |axis: &str| {
        let keys = format!("feed_mm_per_s = 20\ntool_axis = {axis}\n");
        read(&edited("feed_mm_per_s = 20\n", &keys))
    };
    let axis = |text: &str| with(text).unwrap().process.tool_axis;
    assert_eq!(axis("\"down\""), Some(Direction(DVec3::NEG_Z)));
    let Direction(given) = axis("[3, 0, -4]").unwrap();
    assert!(
        (given - DVec3::new(0.6, 0.0, -0.8)).length() < 1e-12,
        "{given}"
    );
    for (wrong, expected) in [
        ("[0, 0, 0]", "a direction in the world"),
        ("[0, 1]", "a direction in the world"),
        ("\"sideways\"", "\"down\" or a direction"),
        ("\"down\"\nlean_deg = 5", "expected one of the two"),
    ] {
        let message = with(wrong).unwrap_err().to_string();
        assert!(message.contains(expected), "{wrong}: {message}");
    }
}

#[test]
fn collisions_and_obstacles_reach_their_fields() {
    let text = format!(
        "{MINIMAL}[collision]\nmargin_mm = 8\nfloor_height_mm = -700\nallowed_pairs = [[\"tool\", \"table\"]]\n\
         [[obstacle]]\nname = \"table\"\nbox_mm = [1000, 800, 30]\nposition_mm = [1, 2, 3]\n\
         [[obstacle]]\nmesh = \"../assets/plate.stl\"\nmesh_unit = \"inch\"\nrotation_deg = [0, 0, 90]\n"
    );
    let collision = read(&text).unwrap().collision;
    assert_eq!(
        (collision.margin, collision.floor_height),
        (0.008, Some(-0.7))
    );
    assert_eq!(
        collision.allowed_pairs,
        [["tool".to_owned(), "table".to_owned()]]
    );
    let [table, part] = &collision.obstacles[..] else {
        panic!("two obstacles");
    };
    assert_eq!(table.shape, ObstacleShape::Box(DVec3::new(1.0, 0.8, 0.03)));
    assert!(
        (table.world_from_obstacle.translation - DVec3::new(1e-3, 2e-3, 3e-3)).length() < 1e-15
    );
    assert_eq!(part.name, "obstacle 2");
    let path = scenarios().join("../assets/plate.stl");
    assert_eq!(
        part.shape,
        ObstacleShape::Mesh {
            path,
            scale: 0.0254
        }
    );
    let turned = part.world_from_obstacle.rotation * DVec3::X;
    assert!((turned - DVec3::Y).length() < 1e-12);
    let none = read(MINIMAL).unwrap().collision;
    assert_eq!(
        (none.margin, none.floor_height, none.obstacles.len()),
        (0.005, None, 0)
    );
    for (wrong, expected) in [
        (
            "[[obstacle]]\nname = \"x\"\n",
            "box_mm = [x, y, z], or mesh",
        ),
        ("[[obstacle]]\nbox_mm = [1, 2]\n", "a list of 3"),
        ("[[obstacle]]\nbox_mm = [1, 2, 0]\n", "0.01 to 100000"),
        (
            "[[obstacle]]\nmesh = \"../assets/plate.stl\"\n",
            "mm, m or inch",
        ),
        (
            "[[obstacle]]\nmesh = \"none.stl\"\nmesh_unit = \"m\"\n",
            "an existing file",
        ),
        (
            "[[obstacle]]\nbox_mm = [1, 2, 3]\n[[obstacle]]\nname = \"obstacle 1\"\nbox_mm = [1, 2, 3]\n",
            "each name once",
        ),
    ] {
        let message = read(&format!("{MINIMAL}{wrong}")).unwrap_err().to_string();
        assert!(message.contains(expected), "{wrong}: {message}");
    }
}

#[test]
fn defaults_that_depend_on_other_values_follow_them() {
    let text = format!("{MINIMAL}[device.override]\nstroke_mm = 40\n");
    let process = read(&text).unwrap().process;
    assert_eq!(process.corner_feed, 0.01);
    assert_eq!(process.working_stroke, 0.02);
}

#[test]
fn every_key_of_the_arm_reaches_its_field() {
    let text = edited(
        "flange_link = \"flange\"\n",
        "flange_link = \"tool0\"\nbase_link = \"base\"\npackages = { b = \".\", a = \"../models\" }\nbase_position_mm = [1, 2, 3]\n\
         base_rotation_deg = [90, 0, 90]\nseed_posture_deg = [0, 180, -90]\n\
         servo = { natural_frequency_hz = 30, damping_ratio = 0.8, integral_time_s = inf, contact_feed_forward = false, lag_bandwidth_hz = 9, encoder_noise_rad = 1e-5 }\n\
         drives = [{ joint = \"a\", friction_n_m = 7, stiffness_n_m_per_rad = 2e5, damping_time_ms = 3, backlash_deg = 0.18 }]\n\
         limit_overrides = [{ joint = \"a\", effort_n_m = 12 }, { joint = \"b\", velocity_deg_per_s = 90 }]\n",
    );
    let arm = read(&text).unwrap().arm;
    assert_eq!(arm.flange_link, "tool0");
    assert_eq!(arm.base_link.as_deref(), Some("base"));
    let packages: Vec<_> = arm.package_directories.into_iter().collect();
    let folder = |name: &str, path: &str| (name.to_owned(), scenarios().join(path));
    assert_eq!(packages, [folder("a", "../models"), folder("b", ".")]);
    assert_eq!(
        arm.world_from_base.translation,
        DVec3::new(0.001, 0.002, 0.003)
    );
    assert_eq!(arm.seed_posture, Some(vec![0.0, PI, -FRAC_PI_2]));
    let servo = ServoScenario {
        natural_frequency: 30.0,
        damping_ratio: 0.8,
        integral_time: f64::INFINITY,
        contact_feed_forward: false,
        lag_bandwidth: 9.0,
        encoder_noise: 1e-5,
    };
    assert_eq!(arm.servo, servo);
    let drive = DriveScenario {
        joint: "a".to_owned(),
        friction: Some(7.0),
        stiffness: 2e5,
        damping_time: 0.003,
        backlash: 0.18_f64.to_radians(),
    };
    assert_eq!(arm.drives, [drive]);
    let limit = |joint: &str, effort, velocity| LimitOverride {
        joint: joint.to_owned(),
        effort,
        velocity,
    };
    assert_eq!(
        arm.limit_overrides,
        [
            limit("a", Some(12.0), None),
            limit("b", None, Some(FRAC_PI_2))
        ]
    );
}

#[test]
fn rotations_are_roll_then_pitch_then_yaw_about_fixed_axes() {
    let text = edited(
        "[workpiece.edge]",
        "rotation_deg = [90, 0, 90]\n[workpiece.edge]",
    );
    let rotation = read(&text).unwrap().workpiece.world_from_part.rotation;
    // Rolled first, z lies along -y; yawed then, along +x. About moving axes it would lie along -y.
    assert!((rotation * DVec3::Z - DVec3::X).length() < 1e-15);
    let text = edited(
        "[workpiece.edge]",
        "rotation_deg = [90, 90, 0]\n[workpiece.edge]",
    );
    let rotation = read(&text).unwrap().workpiece.world_from_part.rotation;
    assert!((rotation * DVec3::Z + DVec3::Y).length() < 1e-15);
    assert!((rotation * DVec3::Y - DVec3::X).length() < 1e-15);
}

#[test]
fn every_key_of_the_workpiece_reaches_its_field() {
    let text = edited(
        "edge = 1\n",
        "loop = 3\nstart_mm = 4\nend_mm = 5\nreversed = true\nsharp_angle_deg = 45\n[workpiece.misplacement]\nshift_mm = 2\ntilt_deg = -9\n",
    )
    .replace("mesh_unit = \"mm\"", "mesh_unit = \"inch\"");
    let workpiece = read(&text).unwrap().workpiece;
    assert_eq!(workpiece.mesh, scenarios().join("../assets/plate.stl"));
    assert_eq!(workpiece.mesh_scale, 0.0254);
    assert_eq!(
        workpiece.world_from_part.translation,
        DVec3::new(0.75, 0.0, 0.2)
    );
    let edge = &workpiece.edge;
    assert_eq!(edge.selection, EdgeSelection::Loop(3));
    assert_eq!((edge.start, edge.end), (0.004, Some(0.005)));
    assert!(edge.reversed);
    assert!((edge.sharp_angle - PI / 4.0).abs() < 1e-15);
    let misplacement = Misplacement {
        shift: 0.002,
        tilt: -PI / 20.0,
    };
    assert_eq!(workpiece.misplacement, misplacement);
}

#[test]
fn every_kind_of_burr_is_read() {
    for (keys, expected) in [
        ("kind = \"none\"", BurrScenario::None),
        (
            "kind = \"constant\"\nheight_mm = 0.3",
            BurrScenario::Constant { height: 0.3e-3 },
        ),
        (
            "kind = \"random\"\nmean_height_mm = 0.3\nstandard_deviation_mm = 0.2\ncorrelation_length_mm = 4\nseed = 5",
            BurrScenario::Random {
                seed: 5,
                mean_height: 0.3e-3,
                height_deviation: 0.2e-3,
                correlation_length: 4e-3,
            },
        ),
        (
            "kind = \"random\"\nmean_height_mm = 6\ncorrelation_length_mm = 4",
            BurrScenario::Random {
                seed: 1,
                mean_height: 6e-3,
                height_deviation: 2e-3,
                correlation_length: 4e-3,
            },
        ),
        (
            "kind = \"bump\"\nposition_mm = 140\nheight_mm = 0.4\nwidth_mm = 20",
            BurrScenario::Bump {
                position: 0.14,
                height: 0.4e-3,
                width: 0.02,
            },
        ),
        (
            "kind = \"table\"\npath = \"README.md\"",
            BurrScenario::Table {
                path: scenarios().join("README.md"),
            },
        ),
    ] {
        let text = format!("{MINIMAL}[workpiece.burr]\n{keys}\n");
        assert_eq!(read(&text).unwrap().workpiece.burr, expected);
    }
}

#[test]
fn every_other_key_reaches_its_field() {
    let text = format!(
        "{MINIMAL}[contact]\nstiffness_n_per_m = 2e5\ndamping_n_s_per_m = 300\nfriction_coefficient = 0.3\n\
         [simulation]\nstep_ms = 0.5\ndevice_substeps = 4\narm_steps = 3\ngravity_m_per_s2 = [1, 2, -3]\nseed = 9\n\
         [expect]\nb_n = {{ max = 2 }}\na_n = {{ min = -1, max = 1 }}\n"
    );
    let scenario = read(&text).unwrap();
    let nominal = &scenario.nominal;
    assert_eq!(nominal.contact, ContactParameters::linear(2e5, 300.0));
    assert_eq!(nominal.cell.friction, 0.3);
    let simulation = SimulationScenario {
        step: 5e-4,
        substeps: 4,
        arm_steps: 3,
        gravity: DVec3::new(1.0, 2.0, -3.0),
        seed: 9,
    };
    assert_eq!(scenario.simulation, simulation);
    let bound = |metric: &str, min, max| Expectation {
        metric: metric.to_owned(),
        min,
        max,
    };
    assert_eq!(
        scenario.expect,
        [
            bound("a_n", Some(-1.0), Some(1.0)),
            bound("b_n", None, Some(2.0))
        ]
    );
}
