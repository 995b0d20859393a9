//! The best that the regulator's dead time allows.
//!
//! **Disturbances.** A set pressure given at t acts at t + theta, whatever the controller. Let d be the disturbance, the error of the contact force with a
//! constant set pressure [N], and d^ the controller's estimate of it from what is known theta earlier. Then
//!
//! ```text
//! e(t) = d(t) - d^(t | t - theta)
//! ```
//!
//! even if d is seen at once, without noise, and cancelled fully and at once. With d^(t | t - theta) = d(t - theta) this is [`dead_time_error`].
//! It is the error of a persistence forecast, and a lower bound for every causal controller if d cannot be predicted: if its increments have zero mean given its past (a random walk), d(t - theta)
//! is the best estimate of d(t) in the mean square. Where d can be predicted - a friction that reverses with a motion whose speed and acceleration
//! are seen - a controller that does so may beat it; then it says what prediction was worth.
//! The lag is not in theta: a lag can be inverted as far as the supply reaches. What the supply costs counts for steps:
//!
//! **Steps.** From outlet pressure p_a to p_b (gauge) the regulator is quickest with the supply p_s commanded, and the step is over when the outlet is
//! within a share s of it:
//!
//! ```text
//! t = theta + tau ln((p_s - p_a) / (p_s - p_c)),   p_c = p_b - s (p_b - p_a)        rising
//! t = theta + tau ln(p_a / p_c)                                                     falling, with nothing commanded
//! ```
//!
//! [`least_settling_time`]. The chamber's filling comes on top, so this is a lower bound too.

use crate::physics::regulator::RegulatorParameters;

/// Root mean square [N] of what is left of a disturbance that is cancelled a delay later: of d(t) - d(t - delay).
///
/// `disturbance` [N] at equal distances of `period` [s], linear in between; before its start it is as at its start. `delay` [s].
pub fn dead_time_error(disturbance: &[f64], period: f64, delay: f64) -> f64 {
    let Some(&first) = disturbance.first() else {
        return 0.0;
    };
    let back = delay / period;
    let at = |position: f64| {
        if position <= 0.0 {
            return first;
        }
        let index = position.floor() as usize;
        let next = disturbance[(index + 1).min(disturbance.len() - 1)];
        disturbance[index] + (position - index as f64) * (next - disturbance[index])
    };
    let sum: f64 = disturbance
        .iter()
        .enumerate()
        .map(|(i, now)| (now - at(i as f64 - back)).powi(2))
        .sum();
    (sum / disturbance.len() as f64).sqrt()
}

/// Shortest time [s] from the command to the outlet being within `tolerance` [1] of a step from one outlet pressure to another [Pa gauge];
/// infinite if the supply does not reach that far.
pub fn least_settling_time(
    regulator: &RegulatorParameters,
    from: f64,
    to: f64,
    tolerance: f64,
) -> f64 {
    let reached = to - tolerance * (to - from);
    let ratio = if to >= from {
        (regulator.supply - from) / (regulator.supply - reached)
    } else {
        from / reached
    };
    if ratio.is_finite() && ratio > 0.0 {
        regulator.dead_time + regulator.time_constant * ratio.ln()
    } else {
        f64::INFINITY
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::regulator::RegulatorState;

    #[test]
    fn of_a_sine_it_is_the_chord() {
        // |1 - e^(-j w theta)| / sqrt(2) = 2 sin(w theta / 2) / sqrt(2), over whole turns.
        // A cosine, which is level at its start.
        let (w, theta, period) = (std::f64::consts::TAU, 0.02, 1e-3);
        let trajectory: Vec<f64> = (0..5000)
            .map(|i| 7.0 * (w * f64::from(i) * period).cos())
            .collect();
        let expected = 7.0 * 2.0 * (0.5 * w * theta).sin() / 2.0f64.sqrt();
        let settled = dead_time_error(&trajectory, period, theta);
        assert!(
            (settled / expected - 1.0).abs() < 1e-3,
            "{settled} {expected}"
        );
    }

    #[test]
    fn of_a_step_it_is_the_step_for_the_delay() {
        let trajectory: Vec<f64> = (0..1000).map(|i| if i < 500 { 0.0 } else { 4.0 }).collect();
        let expected = 4.0 * (20.0f64 / 1000.0).sqrt();
        assert!((dead_time_error(&trajectory, 1e-3, 0.02) - expected).abs() < 1e-12);
        assert_eq!(dead_time_error(&trajectory, 1e-3, 0.0), 0.0);
        assert_eq!(dead_time_error(&[], 1e-3, 0.02), 0.0);
    }

    #[test]
    fn no_regulator_settles_sooner() {
        let parameters = RegulatorParameters {
            gain: 1.0,
            time_constant: 0.15,
            dead_time: 0.02,
            supply: 6e5,
            ..RegulatorParameters::default()
        };
        for (from, to, set) in [(0.6e5, 1.2e5, 6e5), (1.2e5, 0.6e5, 0.0)] {
            let time = least_settling_time(&parameters, from, to, 0.05);
            let mut state = RegulatorState::at_rest(&parameters, from);
            state.command(&parameters, set);
            state.advance(&parameters, time);
            let share = (state.outlet - from) / (to - from);
            assert!((share - 0.95).abs() < 1e-9, "{share}");
        }
        assert!(least_settling_time(&parameters, 1e5, 7e5, 0.05).is_infinite());
    }
}
