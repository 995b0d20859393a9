//! Parameters that cannot be meant are refused by name.

use super::ensemble::parameters;
use super::plant::{PERIOD, device};
use crate::estimation::{ContactForceEstimator, EstimationError, EstimatorParameters, Tolerances};
use crate::physics::gas_process::GasProcess;
use crate::physics::hose::Hose;

fn refused(change: impl Fn(&mut EstimatorParameters), stroke: f64, period: f64) -> EstimationError {
    let data = device();
    let mut given = parameters(&data, Tolerances::default());
    change(&mut given);
    ContactForceEstimator::new(&data, &given, stroke, period).unwrap_err()
}

#[test]
fn each_refusal_names_what_is_wrong() {
    let message = refused(|p| p.noise.stroke = 0.0, 0.03, PERIOD).to_string();
    assert!(
        message.contains("standard deviation of the stroke is 0"),
        "{message}"
    );
    let message = refused(|p| p.noise.acceleration = f64::NAN, 0.03, PERIOD).to_string();
    assert!(message.contains("acceleration is NaN"), "{message}");
    let message = refused(|p| p.tolerances.orifices = -0.1, 0.03, PERIOD).to_string();
    assert!(message.contains("the orifices is -0.1"), "{message}");
    let message = refused(|p| p.tolerances.dead_volume = 1.5, 0.03, PERIOD).to_string();
    assert!(message.contains("the dead volume is 1.5"), "{message}");
    let error = refused(|p| p.models.clear(), 0.03, PERIOD);
    assert_eq!(error, EstimationError::NoModel);
    let error = refused(|_| (), 0.03, 0.1);
    assert!(matches!(error, EstimationError::Period { period, .. } if period == 0.1));
    let error = refused(|_| (), f64::NAN, PERIOD);
    assert!(matches!(error, EstimationError::NotFinite { .. }));
}

#[test]
fn a_device_with_parts_beyond_the_equations_is_refused() {
    let given = parameters(&device(), Tolerances::NONE);
    let mut warm = device();
    warm.gas_process = GasProcess::WallHeat { conductance: 1.0 };
    let mut piped = device();
    piped.hose = Some(Hose::lumped(1.3e-5, 1e8));
    let mut leaky = device();
    leaky.leakage.external = 1e-7;
    let mut loaded = device();
    loaded.axial_load.return_stiffness = 100.0;
    let mut cushioned = device();
    cushioned.end_cushioning.damping = 100.0;
    let mut pressed = device();
    pressed.seal_friction.pressure_coefficient = 1e-5;
    let mut late = device();
    late.switching_delay = 0.01;
    for (data, part) in [
        (warm, "warms up"),
        (piped, "a line"),
        (leaky, "leaks"),
        (loaded, "an axial load"),
        (cushioned, "cushions"),
        (pressed, "presses"),
        (late, "switches late"),
    ] {
        let message = ContactForceEstimator::new(&data, &given, 0.03, PERIOD)
            .unwrap_err()
            .to_string();
        assert!(message.contains(part), "{message}");
    }
}
