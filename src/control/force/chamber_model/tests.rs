use super::super::test_plant::{Bench, Sensors, Surface, device};
use super::*;

#[test]
fn it_follows_the_device_on_a_moved_surface() {
    let device = device(10.0);
    let surface = Surface {
        position: 0.035,
        peak_to_peak: 0.02,
        frequency: 0.5,
        start: 0.1,
    };
    let mut bench = Bench::new(&device, surface, Sensors::IDEAL, 1e-3, 150.0);
    let mut model = ChamberModel::new(&device);
    let area = device.areas().extending;
    let mut before = bench.observe(150.0);
    model.settle(before.regulator_pressure);
    let mut worst = 0.0f64;
    for i in 0..3000 {
        // Steps of pressure on top of the motion.
        bench.step((if i / 500 % 2 == 0 { 150.0 } else { 200.0 }) / area);
        let now = bench.observe(150.0);
        let speed = (now.stroke - before.stroke) / 1e-3;
        let outlet = 0.5 * (before.regulator_pressure + now.regulator_pressure);
        model.advance(outlet, now.stroke, speed, 1e-3);
        before = now;
        for (modelled, truth) in model.pressures.iter().zip(bench.pressures()) {
            worst = worst.max((modelled - truth).abs());
        }
    }
    // 0.4 N on 1608 mm2, while the pressure rises by 31 kPa.
    assert!(worst < 250.0, "{worst}");
}

#[test]
fn the_outlet_for_a_rate_gives_that_rate() {
    let device = device(0.0);
    let mut model = ChamberModel::new(&device);
    model.settle(1.2e5);
    let (stroke, speed) = (0.03, 0.05);
    for rate in [-1e6, -1e5, -10.0, 0.0, 1e3, 2e6] {
        let outlet = model.outlet_for(rate, stroke, speed);
        let given = model.pressure_per_mass(stroke) * model.inflow(outlet)
            - model.pressures[0] * model.growth_rate(stroke, speed);
        assert!(
            (given - rate).abs() < 1e-5 * rate.abs() + 1.0,
            "{rate} {given}"
        );
    }
    assert_eq!(model.outlet_for(1e9, stroke, speed), 6e5);
    assert_eq!(model.outlet_for(-1e9, stroke, speed), 0.0);
}

#[test]
fn from_a_returnable_excess_the_outlet_is_back_as_the_chamber_arrives() {
    let device = device(0.0);
    let (lag, stroke) = (device.regulator.time_constant, 0.03);
    for error in [5e3, 2e4, 6e4] {
        let mut model = ChamberModel::new(&device);
        model.settle(1.2e5 - error);
        let goal = model.pressures[0] + error;
        let [below, above] = model.returnable(goal, stroke, lag);
        assert_eq!(below, 0.0);
        let mut outlet = 1.2e5 + above;
        while outlet > 1.2e5 {
            model.advance(outlet, stroke, 0.0, 1e-4);
            outlet -= 1e-4 * outlet / lag;
        }
        let left = (goal - model.pressures[0]) / error;
        assert!(left.abs() < 0.1, "{left}");
    }
}
