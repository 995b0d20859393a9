//! The whole flange against closed forms.

use super::*;

fn model() -> FlangeModel {
    FlangeModel::of(&[
        5.0, 1.0, 3e5, 0.02, 0.0, 1e6, 0.1, 0.3, 2e6, 0.05, 1e-6, 5e-5, 0.0, 0.5, 2.5e3, 0.01, 0.01,
    ])
}

/// An arm that touches 0.1 s after the start and goes on for 2 mm, so that the slide leaves its stop.
fn course(speed: f64, force: f64) -> FlangeCourse {
    let approach = (0.1 + 2e-3 / speed) / 2e-3;
    let speeds = (0..1000).map(|i| if f64::from(i) < approach { speed } else { 0.0 });
    FlangeCourse {
        start: -0.1,
        period: 2e-3,
        speed: speeds.collect(),
        gap: speed * 0.1,
        before: force,
        after: force,
        ramp: 0.0,
    }
}

/// Upward crossings of a level over a stretch, as a frequency [Hz].
fn frequency(force: &[f64], level: f64) -> f64 {
    let ups: Vec<f64> = (force.windows(2).enumerate())
        .filter(|(_, w)| w[0] < level && w[1] >= level)
        .map(|(i, w)| SAMPLED * (i as f64 + (level - w[0]) / (w[1] - w[0])))
        .collect();
    (ups.len() - 1) as f64 / (ups[ups.len() - 1] - ups[0])
}

#[test]
fn at_rest_the_force_plate_reads_the_set_force() {
    let mut overcome = model();
    overcome.structure_damping = 0.3;
    let force = flange_force(&overcome, &course(0.02, 80.0), 1.8);
    assert!((force[force.len() - 1] - 80.0).abs() < 0.01);
}

#[test]
fn it_rings_at_the_frequency_of_its_springs_in_series() {
    // A head and a workpiece without mass leave the slide on three springs in series.
    let mut light = model();
    (light.head_mass, light.workpiece_mass) = (0.02, 0.02);
    (light.contact_damping, light.structure_damping) = (0.0, 0.005);
    (light.gas_stiffness, light.contact_stiffness) = (1.0, 2e6);
    let force = flange_force_stepped(&light, &course(0.004, 80.0), 0.9, 5e-6);
    let stiffness = 1.0 / (1.0 / 3e5 + 1.0 / 2e6 + 1.0 / 2e6);
    let closed = (stiffness / 4.98f64).sqrt() / std::f64::consts::TAU;
    let found = frequency(&force[1500..4000], 80.0);
    assert!((found / closed - 1.0).abs() < 0.01, "{found} for {closed}");
}

#[test]
fn half_the_step_gives_the_same() {
    let course = course(0.1, 80.0);
    let whole = flange_force(&model(), &course, 0.1);
    let half = flange_force_stepped(&model(), &course, 0.1, 1e-5);
    let peak = |force: &[f64]| force.iter().copied().fold(0.0, f64::max);
    assert!((peak(&whole) / peak(&half) - 1.0).abs() < 0.01);
    let apart = whole.iter().zip(&half).map(|(a, b)| (a - b).powi(2));
    let apart = (apart.sum::<f64>() / whole.len() as f64).sqrt();
    assert!(apart < 0.02 * peak(&half), "{apart}");
}

#[test]
fn a_ramp_presses_lightly_first() {
    let mut ramped = course(0.05, 80.0);
    (ramped.before, ramped.ramp) = (10.0, 0.2);
    let soft = flange_force(&model(), &ramped, 1.5);
    let hard = flange_force(&model(), &course(0.05, 80.0), 1.5);
    let mean = |force: &[f64]| force.iter().sum::<f64>() / force.len() as f64;
    assert!(mean(&soft[1000..1800]) < 0.6 * mean(&hard[1000..1800]));
    // What still rings about the set force has no part in its mean.
    assert!((mean(&soft[soft.len() - 4000..]) - 80.0).abs() < 0.5);
}
