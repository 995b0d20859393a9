//! Balance of forces: the mean contact force against pressures, areas, gravity and the wrist's angle.

use glam::DQuat;
use idc_cell::cell::Cell;
use idc_cell::recording::schema;
use idc_cell::scenario::Scenario;

use crate::common::{run, scenario};

/// Mean contact force while following [N], and what pressures, areas and gravity say it should be.
fn balance(scenario: Scenario) -> (f64, f64) {
    let cell = Cell::new(scenario.clone()).unwrap();
    let finished = run(scenario);
    let recording = &finished.recording;
    let span = recording.phase("follow").unwrap();
    let parameters = &cell.setup.scenario.nominal.device;
    let areas = parameters.areas();
    let [force, p1, p2] = [
        schema::CONTACT_FORCE,
        schema::CHAMBER_1_PRESSURE,
        schema::CHAMBER_2_PRESSURE,
    ]
    .map(|quantity| recording.values(quantity).unwrap());
    let (mut measured, mut expected, mut count) = (0.0, 0.0, 0.0);
    for i in recording.samples_in(span) {
        let axis = cell.plan.reference(recording.time()[i]).axis;
        let gravity = cell.setup.scenario.simulation.gravity.dot(axis);
        let gas = areas.gas_force(p1[i], p2[i], parameters.gas.atmosphere);
        measured += force[i];
        expected +=
            (gas + parameters.moving_mass * gravity) / cell.setup.scenario.process.lean.cos();
        count += 1.0;
    }
    (measured / count, expected / count)
}

#[test]
fn contact_force_balances_pressures_and_gravity_in_five_orientations() {
    // The part turned about its edge, about the vertical and leaned: the axis stands 0 to 80 degrees off the vertical.
    let orientations = [
        ("plate_edge_ideal", 0.0, 0.0, 0.0),
        ("plate_edge_ideal", 30.0, 0.0, 0.0),
        ("plate_edge_ideal", -25.0, 0.0, 0.0),
        ("plate_edge_ideal", 0.0, 25.0, 10.0),
        ("tilted_wrist", 0.0, 0.0, 0.0),
    ];
    for (name, about_edge, about_vertical, lean) in orientations {
        let mut scenario = scenario(name);
        let pose = &mut scenario.workpiece.world_from_part;
        pose.rotation = DQuat::from_rotation_z(f64::to_radians(about_vertical))
            * pose.rotation
            * DQuat::from_rotation_x(f64::to_radians(about_edge));
        scenario.process.lean += f64::to_radians(lean);
        let (measured, expected) = balance(scenario);
        let off = measured / expected - 1.0;
        println!(
            "{name} turned {about_edge}, {about_vertical}, leaned {lean} deg: {measured:.3} N, balance {expected:.3} N, off {:.4} %",
            100.0 * off
        );
        assert!(off.abs() < 0.005, "{measured} against {expected}");
    }
}

#[test]
fn without_gravity_in_the_balance_it_does_not_close() {
    // The check above must be able to fail: leave the moving mass's weight out of the expectation.
    let mut scenario = scenario("plate_edge_ideal");
    scenario.workpiece.edge.end = Some(scenario.workpiece.edge.start + 0.05);
    let weight = {
        let cell = Cell::new(scenario.clone()).unwrap();
        cell.setup.scenario.nominal.device.moving_mass
            * cell.gravity_along(cell.plan.reference(5.0).axis)
    };
    let (measured, expected) = balance(scenario);
    assert!((measured / (expected - weight) - 1.0).abs() > 0.05);
}
