//! What the comments of the shipped scenarios say of their own lines: each claim that follows from values is worked out from them.

use std::f64::consts::PI;
use std::path::PathBuf;

use toml::Table;

use crate::common::project;

fn read(path: &str) -> (String, Table) {
    let text = std::fs::read_to_string(project(path)).unwrap();
    let comments: Vec<&str> = text
        .lines()
        .filter_map(|line| line.split_once('#').map(|(_, comment)| comment.trim()))
        .collect();
    (comments.join(" "), text.parse().unwrap())
}

/// A number by its dotted key; `list.0.key` counts elements.
fn value(table: &Table, key: &str) -> f64 {
    let mut value = &toml::Value::Table(table.clone());
    for part in key.split('.') {
        value = match part.parse::<usize>() {
            Ok(index) => &value[index],
            Err(_) => &value[part],
        };
    }
    let whole = value.as_integer().map(|whole| whole as f64);
    whole.or_else(|| value.as_float()).unwrap()
}

fn device(key: &str) -> f64 {
    value(&read("models/device.toml").1, &format!("device.{key}"))
}

/// Area of both pistons [m2].
fn area() -> f64 {
    device("cylinder_count") * PI / 4.0 * (1e-3 * device("bore_mm")).powi(2)
}

/// The numbers of a claim as they stand in a comment, each `{}` of it one.
fn reported(path: &str, claim: &str) -> Vec<String> {
    let (comments, _) = read(path);
    let mut rest = "";
    let mut found = Vec::new();
    let parts: Vec<&str> = claim.split("{}").collect();
    for (start, _) in comments.match_indices(parts[0]) {
        rest = &comments[start + parts[0].len()..];
        found.clear();
        let all = parts[1..].iter().all(|part| {
            let number = rest.find(|c: char| !(c.is_ascii_digit() || c == '.' || c == '-'));
            let number = number.unwrap_or(rest.len());
            let text = rest[..number].trim_end_matches('.');
            found.push(text.to_owned());
            rest = &rest[text.len()..];
            let fits = !text.is_empty() && rest.starts_with(part);
            rest = rest.strip_prefix(part).unwrap_or(rest);
            fits
        });
        if all {
            return found;
        }
    }
    panic!("{path}: no `{claim}`, up to `{rest}`")
}

/// Each number of a claim is the value worked out, to its last digit.
fn agrees(path: &str, claim: &str, values: &[f64]) {
    let reported = reported(path, claim);
    assert_eq!(reported.len(), values.len(), "{path}: {claim}");
    for (text, value) in reported.iter().zip(values) {
        let decimals = text.split_once('.').map_or(0, |(_, end)| end.len());
        let number: f64 = text.parse().unwrap();
        let half = 0.5 * 10f64.powi(-(decimals as i32)) + 1e-9;
        assert!(
            (number - value).abs() <= half,
            "{path}: {claim}: {text} is stated, {value} worked out"
        );
    }
}

#[test]
fn numbers_of_the_benches_comments_follow_from_their_lines() {
    let bar = 1e5 * area();
    agrees(
        "scenarios/paper_step.toml",
        "{} bar x {} mm2 = {} N",
        &[1.8, 1e6 * area(), 1.8 * bar],
    );
    let (_, stairs) = read("scenarios/paper_stairstep.toml");
    let pressure = |step: usize| value(&stairs, &format!("command.{step}.set_pressure_bar_gauge"));
    let forces = [0, 1, 2].map(|step| pressure(step) * bar);
    agrees(
        "scenarios/paper_stairstep.toml",
        "levels, {}, {} and {} N",
        &forces,
    );
    let (_, hand) = read("scenarios/hand_push.toml");
    let pressed = value(&hand, "command.0.force_n") / value(&hand, "load.stiffness_n_per_m");
    agrees(
        "scenarios/hand_push.toml",
        "pressed in by {} mm",
        &[1e3 * pressed],
    );
    agrees(
        "scenarios/hand_push.toml",
        "follows the hand, {} mm peak to peak at {} Hz",
        &[
            value(&hand, "load.peak_to_peak_mm"),
            value(&hand, "load.frequency_hz"),
        ],
    );
    agrees(
        "scenarios/retract.toml",
        "outer stop at {} mm",
        &[device("stroke_mm")],
    );
    let (_, moved) = read("scenarios/moving_surface.toml");
    agrees(
        "scenarios/moving_surface.toml",
        "goes {} mm to and fro at {} Hz; the seals have {} N",
        &[
            value(&moved, "load.peak_to_peak_mm"),
            value(&moved, "load.frequency_hz"),
            value(&moved, "device.override.seal_coulomb_force_n"),
        ],
    );
}

#[test]
fn numbers_of_the_cells_comments_follow_from_their_lines() {
    let (_, weak) = read("scenarios/weak_supply.toml");
    let supply = value(&weak, "device.override.supply_pressure_bar_gauge");
    agrees(
        "scenarios/weak_supply.toml",
        "supply of {} bar gives at most {} N",
        &[supply, supply * 1e5 * area()],
    );
    for name in ["misplaced_part", "locked_tool"] {
        let path = format!("scenarios/{name}.toml");
        let (_, cell) = read(&path);
        let of = |key: &str| value(&cell, &format!("workpiece.{key}"));
        let length = of("edge.end_mm") - of("edge.start_mm");
        let shift = of("misplacement.shift_mm");
        let turned = 0.5 * length * of("misplacement.tilt_deg").to_radians().tan();
        agrees(
            &path,
            "middle of the followed {} mm: they lie from {} mm to {} mm closer",
            &[length, shift - turned, shift + turned],
        );
    }
    let (_, tilted) = read("scenarios/tilted_wrist.toml");
    agrees(
        "scenarios/tilted_wrist.toml",
        "only {} degrees above the horizontal, and the tool leans by {} degrees",
        // Of the plate's edge it points up by 45.
        &[
            45.0 - value(&tilted, "workpiece.rotation_deg.0"),
            value(&tilted, "process.lean_deg"),
        ],
    );
    let (_, burred) = read("scenarios/burred_edge.toml");
    agrees(
        "scenarios/burred_edge.toml",
        "random burr of {} mm",
        &[value(&burred, "workpiece.burr.mean_height_mm")],
    );
    for path in [
        "scenarios/deburred_edge.toml",
        "scenarios/studies/burred_plate.toml",
    ] {
        let (_, cell) = read(path);
        let lead = value(&cell, "tool.spindle_lead_deg");
        let radius = device("tool_ball_radius_mm") * lead.to_radians().sin();
        let turns = value(&cell, "tool.spindle_speed_rpm") / 60.0;
        agrees(
            path,
            "leads by {} degrees, so that it cuts at {} mm from its axis, {} m/s",
            &[lead, radius, 2.0 * PI * turns * 1e-3 * radius],
        );
    }
    let (_, deburred) = read("scenarios/deburred_edge.toml");
    let leg = ["leg_min_mm", "leg_max_mm"]
        .map(|key| value(&deburred, &format!("workpiece.chamfer.{key}")));
    agrees(
        "scenarios/deburred_edge.toml",
        "stays between {} and {} mm",
        &leg,
    );
    assert_eq!(deburred["pass"].as_array().unwrap().len(), 2);
    let (_, plate) = read("scenarios/plate_edge.toml");
    agrees(
        "scenarios/plate_edge.toml",
        "coefficient of variation at most {} %",
        &[value(&plate, "expect.coefficient_of_variation_percent.max")],
    );
}

// Catches: a comment that calls ideal what has the seals' friction, or the other way round.
#[test]
fn what_is_called_nominal_is_not_ideal() {
    let folder = std::fs::read_dir(project("scenarios")).unwrap();
    let paths: Vec<PathBuf> = folder.map(|entry| entry.unwrap().path()).collect();
    let mut seen = 0;
    for path in paths {
        if path.extension().is_none_or(|ending| ending != "toml") {
            continue;
        }
        let name = format!("scenarios/{}", path.file_name().unwrap().display());
        let (comments, table) = read(&name);
        let ideal = table["device"]
            .get("ideal")
            .is_some_and(|ideal| ideal.as_bool() == Some(true));
        for (said, expected) in [("The nominal job", false), ("The ideal job", true)] {
            if comments.contains(said) {
                assert_eq!(ideal, expected, "{name}: {said}");
                seen += 1;
            }
        }
    }
    assert!(seen >= 2, "{seen}");
}
