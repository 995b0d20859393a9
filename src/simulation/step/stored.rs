//! Where a running cell stores the numbers of its device: once in the nominal and once in the actual description. What is made of them holds results, not the
//! numbers themselves, but for the few that are listed here.

use std::fmt::Debug;
use std::path::Path;

use super::Simulation;
use crate::cell::{Cell, Setup};
use crate::plant::registry::{
    BORE, CONTACT_DAMPING, CONTACT_STIFFNESS, DEAD_VOLUME, DISCHARGE_COEFFICIENT,
    END_STOP_STIFFNESS, EXHAUST_ORIFICE, HOUSING_MASS, MOVING_MASS, ROD, SEAL_COULOMB,
    SEAL_VISCOUS, STROKE, SUPPLY_ORIFICE, TOOL_CENTRE,
};
use crate::plant::{Number, RunningDevice};
use crate::scenario::load;

/// A number, how often the nominal arm with its slide has it, and how often the chambers and rates of a device.
#[rustfmt::skip] // A table: one number a line.
static NUMBERS: [(&Number, usize, usize); 15] = [
    // Body of the slide, for the feed-forward; Rapier has that of the actual one.
    (&MOVING_MASS, 1, 0),
    // Housing and tool make the chain's last links.
    (&HOUSING_MASS, 0, 0),
    (&TOOL_CENTRE, 1, 0),
    // End of the slide's axis; both chambers and the rates of the piston.
    (&STROKE, 1, 3),
    (&DEAD_VOLUME, 0, 2),
    (&BORE, 0, 0), (&ROD, 0, 0), (&SUPPLY_ORIFICE, 0, 0), (&EXHAUST_ORIFICE, 0, 0), (&DISCHARGE_COEFFICIENT, 0, 0),
    (&END_STOP_STIFFNESS, 0, 0), (&SEAL_COULOMB, 0, 0), (&SEAL_VISCOUS, 0, 0),
    (&CONTACT_STIFFNESS, 0, 0), (&CONTACT_DAMPING, 0, 0),
];

/// How often each number stands in a value's fields.
fn count(of: &dyn Debug, values: &[f64]) -> Vec<usize> {
    let text = format!("{of:?}");
    let numbers = text.split(|c: char| !c.is_ascii_alphanumeric() && c != '.' && c != '-');
    let numbers: Vec<f64> = numbers.filter_map(|word| word.parse().ok()).collect();
    let count = |value: &f64| numbers.iter().filter(|number| *number == value).count();
    values.iter().map(count).collect()
}

fn less(all: Vec<usize>, borrowed: &[Vec<usize>]) -> Vec<usize> {
    let all = all.into_iter().enumerate();
    all.map(|(i, n)| n - borrowed.iter().map(|part| part[i]).sum::<usize>())
        .collect()
}

#[test]
fn a_running_cell_stores_a_number_of_its_device_once_as_stated_and_once_as_it_is() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/plate_edge.toml");
    let mut scenario = load(&path).unwrap();
    // Of no round value, so that nothing else has it.
    for (place, (number, ..)) in NUMBERS.iter().enumerate() {
        let quantity = number.quantity();
        let value = quantity.get(&scenario.nominal).max(1e-9);
        quantity.set(
            &mut scenario.nominal,
            value * (1.0 + 1e-6 * (0.7 + place as f64).sqrt()),
        );
    }
    let values = NUMBERS.map(|(number, ..)| number.quantity().get(&scenario.nominal));
    let cell = Cell::new(scenario).unwrap();
    let mut simulation = Simulation::new(&cell);
    for _ in 0..3 {
        simulation.step().unwrap();
    }
    let once = vec![1; NUMBERS.len()];
    let never = vec![0; NUMBERS.len()];
    // Each field is named here, so that one that is new is looked at.
    let Cell {
        setup,
        resolution,
        middle,
        controller,
        plan: _, // The arm's motion alone.
        axial_share: _,
        gravity_on_edge: _,
        estimated,
    } = &cell;
    let Setup {
        scenario,
        arm,
        arm_with_slide,
        actual,
        part: _,      // A mesh and what it rides like.
        collision: _, // Shapes.
        passes,
        notes,
    } = setup;
    assert_eq!(count(scenario, &values), once);
    assert_eq!(count(actual, &values), once);
    let of_chain: Vec<usize> = NUMBERS.map(|(_, chain, _)| chain).to_vec();
    assert_eq!(count(arm_with_slide, &values), of_chain);
    // The reduced model of the law has the weight that the pressure carries.
    let mut reduced = never.clone();
    reduced[0] = 1;
    assert_eq!(count(controller, &values), reduced);
    let rest = (resolution, middle, estimated, &arm.chain, passes, notes);
    assert_eq!(count(&rest, &values), never);
    count_running(&simulation, &values, &reduced);
}

/// The same of what runs; `reduced` is what the controller has.
fn count_running(simulation: &Simulation<'_>, values: &[f64], reduced: &[usize]) {
    let actual = &simulation.cell.setup.actual;
    let never = vec![0; NUMBERS.len()];
    let Simulation {
        cell: _,
        world: _, // Rapier has its own masses.
        device,
        servo,
        lags,
        motors,
        torques,
        saturation,
        encoders,
        encoder_noise,
        reference,
        controller: its_controller,
        answer,
        errors,
        sensors,
        readings,
        touches,
        pressed,
        carried,
        steps: _,
        total_steps: _,
        stopped: _,
        laws,
        limits,
        touched: _,
        peak: _,
        slide_force,
        log: _,
        frames: _,
        next_frame,
        clearance: _,
        cutting: _,
        feed_lag,
        contact_points: _, // Read, not acted on.
        feed_override,
        given,
    } = simulation;
    let borrowed: &RunningDevice<'_> = device;
    assert!(std::ptr::eq(
        borrowed.device.parameters(),
        &raw const actual.device
    ));
    let parameters = count(&actual.device, values);
    let own = less(count(device, values), &[count(actual, values), parameters]);
    assert_eq!(own, NUMBERS.map(|(.., device)| device).to_vec());
    let laws = (servo, lags, motors, torques, saturation, laws, limits);
    assert_eq!(count(&laws, values), never);
    let read = (encoders, encoder_noise, errors, sensors, readings);
    assert_eq!(count(&read, values), never);
    assert_eq!(count(its_controller, values), reduced);
    let rest = (reference, touches, pressed, answer, carried, slide_force);
    assert_eq!(
        count(&(rest, next_frame, feed_lag, feed_override, given), values),
        never
    );
}
