//! Values that are wrong, alone or at odds with others: each gives one clear message.

use super::{MINIMAL, edited, message, refused, scenarios};

#[test]
fn a_wrong_type_says_what_was_expected() {
    for (from, to, location, words) in [
        (
            "150",
            "\"150\"",
            "15:11",
            "`process.force_n` is \"150\", expected a number, in N",
        ),
        (
            "150",
            "[150]",
            "15:11",
            "`process.force_n` is [150], expected a number, in N",
        ),
        (
            "edge = 1",
            "edge = -1",
            "13:8",
            "`workpiece.edge.edge` is -1, expected a whole number, 0 or more",
        ),
        (
            "edge = 1",
            "edge = 1.5",
            "13:8",
            "`workpiece.edge.edge` is 1.5, expected a whole number, 0 or more",
        ),
        (
            "\"minimal\"",
            "7",
            "2:9",
            "`title` is 7, expected a text in quotes",
        ),
        (
            "\"../assets/plate.stl\"",
            "7",
            "9:8",
            "`workpiece.mesh` is 7, expected a text in quotes",
        ),
        (
            "\"mm\"",
            "\"cm\"",
            "10:13",
            "`workpiece.mesh_unit` is \"cm\", expected one of `mm`, `m`, `inch`",
        ),
        (
            "[750, 0, 200]",
            "750",
            "11:15",
            "`workpiece.position_mm` is 750, expected a list of numbers, in mm",
        ),
        (
            "[750, 0, 200]",
            "[750, true, 200]",
            "11:21",
            "`workpiece.position_mm[1]` is true, expected a number, in mm",
        ),
        (
            "[process]",
            "[device.override]\nbore_mm = '3'\n[process]",
            "15:11",
            "`device.override.bore_mm` is '3', expected a number, in mm",
        ),
        (
            "[workpiece.edge]\nedge = 1",
            "edge = 1",
            "12:8",
            "`workpiece.edge` is 1, expected a table",
        ),
        (
            "edge = 1",
            "edge = 1\nreversed = 1",
            "14:12",
            "`workpiece.edge.reversed` is 1, expected true or false",
        ),
    ] {
        refused(from, to, location, words);
    }
}

#[test]
fn a_number_out_of_range_is_refused_with_its_unit() {
    for (from, to, location, words) in [
        (
            "150",
            "-5",
            "15:1",
            "`process.force_n` is -5 N, expected 0.1 to 5000 N",
        ),
        (
            "150",
            "nan",
            "15:1",
            "`process.force_n` is NaN N, expected 0.1 to 5000 N",
        ),
        (
            "150",
            "inf",
            "15:1",
            "`process.force_n` is inf N, expected 0.1 to 5000 N",
        ),
        (
            "[750, 0, 200]",
            "[750, 0, 2e6]",
            "11:24",
            "`workpiece.position_mm[2]` is 2000000 mm, expected -10000 to 10000 mm",
        ),
        (
            "[750, 0, 200]",
            "[750, 0]",
            "11:15",
            "`workpiece.position_mm` is [750, 0], expected a list of 3",
        ),
        (
            "[750, 0, 200]",
            "[7, 0, 2, 9]",
            "11:15",
            "`workpiece.position_mm` is [7, 0, 2, 9], expected a list of 3",
        ),
        (
            "[process]",
            "[device.override]\nsupply_pressure_bar_gauge = 600000\n[process]",
            "15:1",
            "`device.override.supply_pressure_bar_gauge` is 600000 bar gauge, expected 0.1 to 16 bar gauge",
        ),
        (
            "[process]",
            "[simulation]\ndevice_substeps = 0\n[process]",
            "15:1",
            "`simulation.device_substeps` is 0, expected 1 to 1000",
        ),
        (
            "[process]",
            "[arm.servo]\nintegral_time_s = 0\n[process]",
            "15:1",
            "`arm.servo.integral_time_s` is 0 s, expected at least 0.001 s",
        ),
        (
            "\"minimal\"",
            "\" \"",
            "2:1",
            "`title` is \" \", expected a text",
        ),
    ] {
        refused(from, to, location, words);
    }
}

#[test]
fn a_path_that_does_not_exist_is_named_as_written_and_in_full() {
    let message = message(&edited("plate.stl", "plait.stl"));
    assert!(
        message.contains("test.toml:9:1: `workpiece.mesh` is \"../assets/plait.stl\""),
        "{message}"
    );
    assert!(
        message.contains("an existing file (there is no /"),
        "{message}"
    );
    let text = edited("[device]", "packages = { ur = \"nowhere\" }\n[device]");
    let message = super::message(&text);
    assert!(
        message.contains("`arm.packages.ur` is \"nowhere\", expected an existing folder"),
        "{message}"
    );
}

#[test]
fn values_at_odds_with_each_other_are_refused() {
    for (from, to, location, words) in [
        (
            "150",
            "150\ncorner_feed_mm_per_s = 30",
            "16:1",
            "`process.corner_feed_mm_per_s` is 30 mm/s, expected at most feed_mm_per_s, 20 mm/s",
        ),
        (
            "150",
            "150\nworking_stroke_mm = 50",
            "16:1",
            "`process.working_stroke_mm` is 50 mm, expected less than the device's stroke_mm, 50 mm",
        ),
        (
            "edge = 1",
            "edge = 1\nloop = 0",
            "14:1",
            "`workpiece.edge.loop` cannot stand here: `workpiece.edge.edge` is given too, expected one of the two",
        ),
        (
            "edge = 1",
            "edge = 1\nstart_mm = 20\nend_mm = 20",
            "15:1",
            "`workpiece.edge.end_mm` is 20 mm, expected more than start_mm, 20 mm",
        ),
        (
            "[process]",
            "[device.override]\nrod_mm = 32\n[process]",
            "15:1",
            "`device.override.rod_mm` is 32 mm, expected less than bore_mm, 32 mm",
        ),
        (
            "[process]",
            "[device.override]\ntool_centre_mm = 4\n[process]",
            "15:1",
            "`device.override.tool_centre_mm` is 4 mm, expected at least tool_ball_radius_mm, 5 mm, so that the ball is in front of the flange",
        ),
        (
            "[workpiece]",
            "locked = true\n[contact]\nstiffness_n_per_m = 2e7\n[workpiece]",
            "10:1",
            "`contact.stiffness_n_per_m` is 20000000 N/m, expected at most 10000000 N/m, a tenth of the device's lock_stiffness_n_per_m, as the device is locked",
        ),
        (
            "[process]",
            "[[arm.limit_overrides]]\njoint = \"a\"\n[process]",
            "14:1",
            "`arm.limit_overrides[0].effort_n_m` is missing, expected it or velocity_deg_per_s to be given",
        ),
        (
            "[process]",
            "[[arm.limit_overrides]]\njoint = \"a\"\neffort_n_m = 1\n[[arm.limit_overrides]]\njoint = \"a\"\neffort_n_m = 2\n[process]",
            "18:1",
            "`arm.limit_overrides[1].joint` is \"a\" again, expected each joint once",
        ),
        (
            "[process]",
            "[expect]\nx_n = {}\n[process]",
            "15:1",
            "`expect.x_n` is empty, expected min, max or both, finite and min not above max",
        ),
        (
            "[process]",
            "[expect]\nx_n = { min = 2, max = 1 }\n[process]",
            "15:1",
            "`expect.x_n` is { min = 2, max = 1 }, expected min, max or both, finite and min not above max",
        ),
    ] {
        refused(from, to, location, words);
    }
}

#[test]
fn a_burr_has_the_keys_of_its_kind_and_no_others() {
    for (keys, location, words) in [
        (
            "kind = \"wavy\"",
            "15:8",
            "`workpiece.burr.kind` is \"wavy\", expected one of `none`, `constant`, `random`, `bump`, `table`",
        ),
        (
            "kind = \"constant\"",
            "14:12",
            "`workpiece.burr.height_mm` is missing, expected it to be given with kind = \"constant\"",
        ),
        (
            "kind = \"table\"",
            "14:12",
            "`workpiece.burr.path` is missing, expected it to be given with kind = \"table\"",
        ),
        (
            "kind = \"constant\"\nheight_mm = 1\nwidth_mm = 2",
            "17:1",
            "`workpiece.burr.width_mm` cannot stand here: kind = \"constant\" has root_mm, height_mm",
        ),
        (
            "kind = \"none\"\nseed = 2",
            "16:1",
            "`workpiece.burr.seed` cannot stand here: kind = \"none\" has no other key",
        ),
    ] {
        refused(
            "[process]",
            &format!("[workpiece.burr]\n{keys}\n[process]"),
            location,
            words,
        );
    }
}

#[test]
fn a_fault_in_the_device_model_is_placed_in_that_file() {
    let shipped = std::fs::read_to_string(scenarios().join("../models/device.toml")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let model = folder.path().join("model.toml");
    let text = edited("../models/device.toml", model.to_str().unwrap());
    for (from, to, words) in [
        (
            "bore_mm = 32",
            "",
            "`device.bore_mm` is missing, expected it to be given, a device model has no defaults",
        ),
        (
            "bore_mm = 32",
            "bore_mm = 320",
            "`device.bore_mm` is 320 mm, expected 2 to 300 mm",
        ),
        (
            "bore_mm = 32",
            "bore = 32",
            "unknown key `device.bore`; the key is `bore_mm`, in mm",
        ),
        ("schema = 2", "schema = 3", "schema is 3, expected 1 to 2"),
        (
            "[device]",
            "[devise]",
            "unknown key `devise`; did you mean `device`?",
        ),
    ] {
        assert!(shipped.contains(from));
        std::fs::write(&model, shipped.replacen(from, to, 1)).unwrap();
        let message = message(&text);
        let file = format!("{}:", model.display());
        assert!(
            message.starts_with(&file) && message.ends_with(words),
            "{message}"
        );
    }
    // What the scenario overrides is the scenario's to answer for.
    std::fs::write(&model, shipped).unwrap();
    let message = super::message(&format!("{text}[device.override]\nrod_mm = 50\n"));
    assert!(
        message.contains("test.toml:18:1: `device.override.rod_mm` is 50 mm"),
        "{message}"
    );
    assert!(super::read(MINIMAL).is_ok());
}
