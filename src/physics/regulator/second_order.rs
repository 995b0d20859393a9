//! The regulator as an oscillator of one degree of freedom, in closed form for any damping ratio.
//!
//! ```text
//! p'' + 2 zeta w p' + w^2 p = w^2 p_target                      (its pilot and diaphragm; in place of the first-order lag)
//! ```
//!
//! With y = p - p_target, s = zeta w and d = w sqrt(1 - zeta^2),
//!
//! ```text
//! y(t) = e^(-s t) (y_0 cos d t + (y'_0 + s y_0) sin(d t) / d),    y'(t) = e^(-s t) (y'_0 cos d t - (w^2 y_0 + s y'_0) sin(d t) / d)
//! ```
//!
//! and for zeta >= 1 the hyperbolic functions, or 1 and t, in place of cosine and sine over d.
//!
//! p pressure [Pa], w natural frequency [rad/s], zeta damping ratio [1].

/// Natural frequency and damping ratio.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SecondOrder {
    /// Natural frequency [rad/s].
    pub natural_frequency: f64,
    /// Damping ratio [1], any above 0.
    pub damping_ratio: f64,
}

impl SecondOrder {
    /// Second derivative of a deviation from the target [Pa/s2], from the deviation [Pa] and its rate [Pa/s].
    pub fn acceleration(&self, deviation: f64, rate: f64) -> f64 {
        let w = self.natural_frequency;
        -w * (w * deviation + 2.0 * self.damping_ratio * rate)
    }

    /// Deviation [Pa] and rate [Pa/s] after a time [s].
    pub fn after(&self, deviation: f64, rate: f64, time: f64) -> (f64, f64) {
        let w = self.natural_frequency;
        let decay = self.damping_ratio * w;
        let (cosine, sine) = self.functions(time);
        (
            deviation * cosine + (rate + decay * deviation) * sine,
            rate * cosine - (w * w * deviation + decay * rate) * sine,
        )
    }

    /// Decayed cosine, and decayed sine over its frequency [s].
    fn functions(&self, time: f64) -> (f64, f64) {
        let w = self.natural_frequency;
        let decay = self.damping_ratio * w;
        let discriminant = 1.0 - self.damping_ratio * self.damping_ratio;
        if discriminant > 0.0 {
            let damped = w * discriminant.sqrt();
            let (sine, cosine) = (damped * time).sin_cos();
            let envelope = (-decay * time).exp();
            (envelope * cosine, envelope * sine / damped)
        } else if discriminant < 0.0 {
            let apart = w * (-discriminant).sqrt();
            // The slower of the two rates, without their difference, which cancels far beyond critical.
            let slow = (-w * w / (decay + apart) * time).exp();
            let fast_over_slow = (-2.0 * apart * time).exp_m1();
            (
                slow * (1.0 + 0.5 * fast_over_slow),
                -0.5 * slow * fast_over_slow / apart,
            )
        } else {
            let envelope = (-decay * time).exp();
            (envelope, envelope * time)
        }
    }

    /// Time at which a solution of the equation without target, now at a value and with a rate, is next 0 [s]; infinite if never.
    pub fn next_zero(&self, value: f64, rate: f64) -> f64 {
        let w = self.natural_frequency;
        let slope = rate + self.damping_ratio * w * value;
        let discriminant = 1.0 - self.damping_ratio * self.damping_ratio;
        // At a zero now, the next one is meant.
        let now = 1e-9 / w;
        let time = if discriminant > 0.0 {
            if value == 0.0 && slope == 0.0 {
                return f64::INFINITY;
            }
            let damped = w * discriminant.sqrt();
            let half_turn = std::f64::consts::PI;
            let angle = (-value * damped).atan2(slope).rem_euclid(half_turn);
            if angle < damped * now {
                half_turn / damped
            } else {
                angle / damped
            }
        } else if discriminant < 0.0 {
            let apart = w * (-discriminant).sqrt();
            (-value * apart / slope).atanh() / apart
        } else {
            -value / slope
        };
        if time > now { time } else { f64::INFINITY }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATIOS: [f64; 6] = [0.15, 0.7, 0.999_999, 1.0, 1.000_001, 4.0];

    fn oscillator(damping_ratio: f64) -> SecondOrder {
        SecondOrder {
            natural_frequency: 30.0,
            damping_ratio,
        }
    }

    #[test]
    fn the_closed_form_equals_its_differential_equation_at_any_damping() {
        for ratio in RATIOS {
            let oscillator = oscillator(ratio);
            let (mut y, mut v, n) = (-2e5, 3e5, 20_000);
            let h = 0.2 / f64::from(n);
            for _ in 0..n {
                let rates = |y: f64, v: f64| (v, oscillator.acceleration(y, v));
                let k1 = rates(y, v);
                let k2 = rates(y + 0.5 * h * k1.0, v + 0.5 * h * k1.1);
                let k3 = rates(y + 0.5 * h * k2.0, v + 0.5 * h * k2.1);
                let k4 = rates(y + h * k3.0, v + h * k3.1);
                y += h / 6.0 * (k1.0 + 2.0 * k2.0 + 2.0 * k3.0 + k4.0);
                v += h / 6.0 * (k1.1 + 2.0 * k2.1 + 2.0 * k3.1 + k4.1);
            }
            let (closed, rate) = oscillator.after(-2e5, 3e5, 0.2);
            assert!((closed - y).abs() < 1e-6, "{ratio}: {closed} {y}");
            assert!((rate - v).abs() < 1e-4, "{ratio}: {rate} {v}");
        }
    }

    #[test]
    fn a_step_overshoots_by_what_the_textbooks_say() {
        let oscillator = oscillator(0.4);
        let root = (1.0f64 - 0.16).sqrt();
        let (peak, rate) = oscillator.after(-1.0, 0.0, std::f64::consts::PI / (30.0 * root));
        assert!((peak - (-std::f64::consts::PI * 0.4 / root).exp()).abs() < 1e-12);
        assert!(rate.abs() < 1e-12);
    }

    #[test]
    fn the_next_zero_is_a_zero_and_the_first() {
        for ratio in RATIOS {
            let oscillator = oscillator(ratio);
            for (value, rate) in [
                (1.0, -200.0),
                (-1.0, 40.0),
                (1.0, 20.0),
                (0.0, 5.0),
                (0.5, -1.0),
            ] {
                let zero = oscillator.next_zero(value, rate);
                let end = zero.min(2.0);
                let sign = if value == 0.0 { rate } else { value }.signum();
                for share in [0.01, 0.3, 0.9, 0.999] {
                    let (y, _) = oscillator.after(value, rate, share * end);
                    assert!(y * sign > 0.0, "{ratio} {value} {rate}: {y} at {share}");
                }
                if zero.is_finite() {
                    assert!(oscillator.after(value, rate, zero).0.abs() < 1e-12);
                }
            }
        }
    }

    #[test]
    fn a_long_time_far_beyond_critical_does_not_overflow() {
        let (y, v) = oscillator(50.0).after(1e5, 0.0, 1e4);
        assert_eq!((y, v), (0.0, 0.0));
    }
}
