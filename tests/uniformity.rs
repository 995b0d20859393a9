//! Guards on the variance of the contact force: one for each scenario that reaches contact, each shown to fail when a disturbance is planted.

use idc_cell::metrics::{METRICS, check};
use idc_cell::scenario::{BurrScenario, Scenario};

use crate::common::{run, scenario};

/// The scenario's own bounds that its run does not keep.
fn broken_bounds(scenario: Scenario) -> Vec<String> {
    let expectations = scenario.expect.clone();
    assert!(!expectations.is_empty());
    let summary = run(scenario).summary;
    let verdicts = check(METRICS, &summary, &expectations).unwrap();
    verdicts
        .iter()
        .filter(|v| !v.kept)
        .map(|v| v.metric.to_string())
        .collect()
}

/// The guard holds on the scenario as it is, and breaks on the force's variation when `disturb` has been at it.
fn guarded(name: &str, disturb: fn(&mut Scenario)) {
    let nominal = scenario(name);
    let mut disturbed = nominal.clone();
    disturb(&mut disturbed);
    assert_eq!(broken_bounds(nominal), Vec::<&str>::new(), "{name}");
    let broken = broken_bounds(disturbed);
    assert!(
        broken.contains(&"force_standard_deviation_n".to_owned()),
        "{name}: the disturbance went unseen: {broken:?}"
    );
}

/// A coarse burr that the slide's mass cannot follow quietly.
fn coarse_burr(scenario: &mut Scenario) {
    scenario.workpiece.burr = BurrScenario::Random {
        seed: 3,
        mean_height: 0.4e-3,
        height_deviation: 0.15e-3,
        correlation_length: 1.5e-3,
    };
}

fn clamped_slide(scenario: &mut Scenario) {
    scenario.device.locked = true;
}

#[test]
fn plate_edge_is_uniform_unless_the_burr_is_coarse() {
    guarded("plate_edge", coarse_burr);
}

#[test]
fn plate_edge_is_uniform_unless_a_tilted_part_meets_a_clamped_slide() {
    guarded("plate_edge", |scenario| {
        clamped_slide(scenario);
        scenario.workpiece.misplacement.tilt = 1e-3;
    });
}

#[test]
fn slow_regulator_is_uniform_unless_the_burr_is_coarse() {
    guarded("slow_regulator", coarse_burr);
}

#[test]
fn bracket_loop_is_uniform_unless_the_slide_is_clamped() {
    guarded("bracket_loop", |scenario| {
        clamped_slide(scenario);
        scenario.workpiece.misplacement.tilt = 1e-3;
    });
}

#[test]
fn misplaced_part_is_uniform_unless_the_slide_is_clamped() {
    guarded("misplaced_part", clamped_slide);
}

#[test]
fn burred_edge_is_uniform_unless_the_burr_is_coarse() {
    guarded("burred_edge", coarse_burr);
}

#[test]
fn tilted_wrist_is_uniform_unless_the_burr_is_coarse() {
    guarded("tilted_wrist", coarse_burr);
}

#[test]
fn locked_tool_is_uneven_unless_it_is_freed() {
    guarded("locked_tool", |scenario| scenario.device.locked = false);
}

#[test]
fn a_free_device_evens_out_a_misplaced_part_at_least_twentyfold() {
    let deviation = |name| {
        run(scenario(name))
            .summary
            .force_standard_deviation_n
            .unwrap()
    };
    let (free, locked) = (deviation("misplaced_part"), deviation("locked_tool"));
    println!(
        "standard deviation locked {locked:.3} N, free {free:.4} N: {:.0} times",
        locked / free
    );
    assert!(locked > 20.0 * free, "{locked} N against {free} N");
}
