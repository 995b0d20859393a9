use super::super::feedback_linearisation::FeedbackLinearisation;
use super::super::proportional_integral::ProportionalIntegral;
use super::super::regulator_model::RegulatorModel;
use super::super::test_plant::{Bench, CONTACT, Sensors, Surface, device};
use super::super::{
    ControllerParameters, FeedbackLinearisationParameters, ForceController,
    ProportionalIntegralParameters,
};
use super::*;
use crate::physics::regulator::RegulatorState;

const PERIODS: [f64; 2] = [1e-3, 4e-3];

/// Ratio of the force's error in the last of four seconds to that in the second, after a touch of 0.05 N.
fn growth(controller: ForceController, period: f64) -> f64 {
    // Near full stroke, for which the limit is computed, and small, for the orifice is taken as laminar.
    let surface = Surface {
        position: 0.0485,
        peak_to_peak: 0.0,
        frequency: 1.0,
        start: 0.0,
    };
    let mut bench = Bench::new(&device(0.0), surface, Sensors::IDEAL, period, 150.0);
    let mut controller = controller;
    let samples = bench.run(&mut controller, 4.0, |_| 150.05);
    let largest = |from: f64| {
        samples
            .iter()
            .filter(|s| s.time > from && s.time < from + 1.0)
            .map(|s| (s.force - 150.05).abs())
            .fold(0.0, f64::max)
    };
    largest(3.0) / largest(1.0)
}

fn refused(parameters: ControllerParameters, period: f64) -> (f64, String) {
    let error = ForceController::new(&parameters, &device(0.0), CONTACT, period).unwrap_err();
    match &error {
        ControllerError::Unstable {
            limit: StabilityLimit::AtMost(limit) | StabilityLimit::AtLeast(limit),
            ..
        } => (*limit, error.to_string()),
        _ => panic!("{error}"),
    }
}

#[test]
fn pi_gains_just_below_the_limit_settle_and_just_above_they_do_not() {
    let at = |gain: f64| ProportionalIntegralParameters {
        proportional_gain: gain,
        integral_gain: 5.0 * gain,
    };
    for period in PERIODS {
        let (limit, message) =
            refused(ControllerParameters::ProportionalIntegral(at(30.0)), period);
        assert!(
            message.starts_with("proportional_gain 30 is unstable: at "),
            "{message}"
        );
        let run = |gain: f64| {
            let controller = ProportionalIntegral::new(&at(gain), &device(0.0), period);
            growth(
                ForceController::ProportionalIntegral(Box::new(controller)),
                period,
            )
        };
        let (below, above) = (run(0.94 * limit), run(1.06 * limit));
        assert!(below < 0.5 && above > 2.0, "{period}: {below} {above}");
        let allowed = ControllerParameters::ProportionalIntegral(at(0.99 * limit));
        assert!(ForceController::new(&allowed, &device(0.0), CONTACT, period).is_ok());
    }
}

#[test]
fn the_integral_of_the_linearisation_likewise() {
    let at = |gain: f64| FeedbackLinearisationParameters {
        integral_gain: gain,
        ..FeedbackLinearisationParameters::tuned(&device(0.0))
    };
    for period in PERIODS {
        let (limit, _) = refused(
            ControllerParameters::FeedbackLinearisation(at(500.0)),
            period,
        );
        let run = |gain: f64| {
            let controller = FeedbackLinearisation::new(&at(gain), &device(0.0), period);
            growth(
                ForceController::FeedbackLinearisation(Box::new(controller)),
                period,
            )
        };
        let (below, above) = (run(0.9 * limit), run(1.1 * limit));
        assert!(below < 0.5 && above > 2.0, "{period}: {below} {above}");
    }
}

/// Largest errors of the outlet [Pa], from 0.3 to 1.5 s and from there to 2 s after a touch of 1 uPa, with a regulator other than its model.
fn lead_errors(response_time: f64, period: f64, factor: f64, late: f64) -> [f64; 2] {
    let model_parameters = device(0.0).regulator;
    let truth = RegulatorParameters {
        time_constant: factor * model_parameters.time_constant,
        dead_time: model_parameters.dead_time + late * period,
        ..model_parameters
    };
    let mut state = RegulatorState::at_rest(&truth, 1e5);
    let mut model = RegulatorModel::new(model_parameters, period);
    let mut largest = [0.0f64; 2];
    for i in 0..(2.0 / period) as usize {
        let time = i as f64 * period;
        model.observe(state.outlet);
        let ahead = model.through_dead_time(state.outlet, |_, _| ());
        // A touch, small enough never to meet a limit while it is looked at.
        let goal = if time < 0.05 { 1e5 + 1e-6 } else { 1e5 };
        let set = model.send(model.lead(ahead, goal, 0.0, response_time), state.outlet);
        state.command(&truth, set);
        state.advance(&truth, period);
        let window = usize::from(time > 1.5);
        if time > 0.3 {
            largest[window] = largest[window].max((state.outlet - 1e5).abs());
        }
    }
    largest
}

#[test]
fn a_lead_just_slower_than_the_limit_withstands_the_stated_misses_and_a_quicker_one_does_not() {
    for period in PERIODS {
        let mut parameters = super::super::DisturbancePredictionParameters::tuned(&device(0.0));
        parameters.response_time = 1e-4;
        let (limit, message) = refused(
            ControllerParameters::DisturbancePrediction(parameters),
            period,
        );
        assert!(message.contains("20 % off"), "{message}");
        let worst = |response_time: f64| {
            [(0.8, 0.0), (0.8, 1.0), (1.2, 0.0), (1.2, 1.0)]
                .map(|(factor, late)| lead_errors(response_time, period, factor, late))
                .into_iter()
                .map(|[before, after]| after / before)
                .fold(0.0, f64::max)
        };
        let (slower, quicker) = (worst(1.1 * limit), worst(0.9 * limit));
        assert!(
            slower < 1.0 && quicker > 2.0,
            "{period}: {slower} {quicker}"
        );
    }
}

#[test]
fn with_an_exact_model_any_lead_is_stable() {
    for period in PERIODS {
        let errors = lead_errors(1e-4, period, 1.0, 0.0);
        assert!(errors[0].max(errors[1]) < 1e-8, "{errors:?}");
    }
}
