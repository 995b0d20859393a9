use super::super::test_plant::device;
use super::*;

const AT_REST: PistonState = PistonState {
    stroke: 0.03,
    speed: 0.0,
    acceleration: 0.0,
};

const RATE: f64 = 150.0;

fn law_and_chambers(outlet: f64) -> (Law, ChamberModel) {
    let device = device(0.0);
    let mut chambers = ChamberModel::new(&device);
    chambers.settle(outlet);
    let law = Law::new(RATE, device.regulator.time_constant, 1e-3);
    (law, chambers)
}

#[test]
fn at_equal_pressures_it_is_regular_and_answers_the_error() {
    let (law, chambers) = law_and_chambers(1.2e5);
    let pressure = chambers.pressures[0];
    assert_eq!(chambers.inflow(1.2e5), 0.0);
    // The bound is reached there, so the answer is that of the first-order law: the share of the error that a lag of 2/r closes in a period.
    let share = -(-0.5 * RATE * 1e-3f64).exp_m1();
    for error in [-1e3, -10.0, 0.0, 10.0, 1e3] {
        let change = law.outlet_change(&chambers, 1.2e5, pressure + error, AT_REST);
        assert!((change - share * error).abs() < 1e-3, "{error}: {change}");
    }
}

#[test]
fn through_equal_pressures_it_is_continuous() {
    let (law, chambers) = law_and_chambers(1.2e5);
    let goal = chambers.pressures[0] + 500.0;
    let at = |outlet: f64| law.outlet_change(&chambers, outlet, goal, AT_REST);
    let mut last = at(1.2e5 - 2000.0);
    let mut largest = 0.0f64;
    for i in -19_999..=20_000 {
        let change = at(1.2e5 + 0.1 * f64::from(i));
        assert!(change.is_finite());
        largest = largest.max((change - last).abs());
        last = change;
    }
    // Steepest where the laminar range ends and the flow's slope halves within 44 Pa: some pascals a pascal, and no jump.
    assert!(largest < 0.1 * 10.0, "{largest}");
}

#[test]
fn without_the_bound_the_error_would_have_no_weight_at_equal_pressures() {
    // A hundredfold orifice stands for a slope that tends to infinity.
    let mut wide = device(0.0);
    wide.supply_orifice *= 100.0;
    let mut chambers = ChamberModel::new(&wide);
    chambers.settle(1.2e5);
    let law = Law::new(RATE, wide.regulator.time_constant, 1e-3);
    let per_mass = chambers.pressure_per_mass(AT_REST.stroke);
    let [slope, _] = chambers.inflow_slopes(1.2e5);
    let unbounded = RATE * RATE / (per_mass * slope);
    let [bounded, _] = law.bounded_slopes(&chambers, 1.2e5, per_mass);
    assert!(unbounded < 0.02 * 0.5 * RATE, "{unbounded}");
    assert!((RATE * RATE / (per_mass * bounded) / (0.5 * RATE) - 1.0).abs() < 1e-12);
}

#[test]
fn in_choked_exhaust_the_input_gain_is_not_zero() {
    let (law, mut chambers) = law_and_chambers(5e5);
    chambers.pressures[0] = 6e5;
    assert!(chambers.inflow_slopes(0.5e5)[0].abs() < 1e-15);
    let per_mass = chambers.pressure_per_mass(AT_REST.stroke);
    assert!(law.bounded_slopes(&chambers, 0.5e5, per_mass)[0] > 0.0);
    let change = law.outlet_change(&chambers, 0.5e5, 2e5, AT_REST);
    assert!(change.is_finite());
}

#[test]
fn away_from_the_bounds_the_chamber_follows_the_wanted_second_order() {
    // Continuous time, a chamber well below its outlet: y'' + 2 r y' + r^2 (y - y_d) = 0 integrated beside the model.
    let (rate_wanted, dt) = (60.0, 1e-6);
    let (mut outlet, start, goal, stroke) = (2.1e5, 3.0e5, 3.3e5, AT_REST.stroke);
    let (_, mut chambers) = law_and_chambers(0.0);
    let law = Law::new(rate_wanted, 0.15, dt);
    chambers.pressures[0] = start;
    let per_mass = chambers.pressure_per_mass(stroke);
    let (mut y, mut rate) = (start, per_mass * chambers.inflow(outlet));
    for _ in 0..2_000 {
        let slopes = chambers.inflow_slopes(outlet);
        assert_eq!(law.bounded_slopes(&chambers, outlet, per_mass), slopes);
        let change = law.outlet_change(&chambers, outlet, goal, AT_REST);
        chambers.pressures[0] += dt * per_mass * chambers.inflow(outlet);
        outlet += change;
        let acceleration = rate_wanted * (rate_wanted * (goal - y) - 2.0 * rate);
        y += dt * rate;
        rate += dt * acceleration;
    }
    let ratio = (chambers.pressures[0] - start) / (y - start);
    assert!((ratio - 1.0).abs() < 2e-3, "{ratio}");
}
