//! First-order lag, exact for an input held between samples.
//!
//! ```text
//! y_k = y_(k-1) + a (u_k - y_(k-1)),   a = 1 - e^(-T/tau)
//! delay = T (1 - a) / a = T / (e^(T/tau) - 1),   noise factor = sqrt(a / (2 - a))
//! ```
//!
//! T sample period [s], tau time constant [s].

/// State of the lag.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FirstOrderFilter {
    share: f64,
    output: Option<f64>,
}

fn share(time_constant: f64, sample_period: f64) -> f64 {
    -(-sample_period / time_constant).exp_m1()
}

/// Delay of slow signals [s].
pub fn delay(time_constant: f64, sample_period: f64) -> f64 {
    sample_period / (sample_period / time_constant).exp_m1()
}

/// Standard deviation of the output over that of white noise at the input [1].
pub fn noise_factor(time_constant: f64, sample_period: f64) -> f64 {
    let share = share(time_constant, sample_period);
    (share / (2.0 - share)).sqrt()
}

impl FirstOrderFilter {
    /// With a time constant [s] at a sample period [s].
    pub fn new(time_constant: f64, sample_period: f64) -> Self {
        Self {
            share: share(time_constant, sample_period),
            output: None,
        }
    }

    /// Takes a sample and returns the filtered value.
    pub fn apply(&mut self, sample: f64) -> f64 {
        let last = self.output.unwrap_or(sample);
        let output = last + self.share * (sample - last);
        self.output = Some(output);
        output
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_follows_the_exponential() {
        let mut filter = FirstOrderFilter::new(0.05, 4e-3);
        filter.apply(0.0);
        for k in 1..50 {
            let exact = 1.0 - (-f64::from(k) * 4e-3 / 0.05).exp();
            assert!((filter.apply(1.0) - exact).abs() < 1e-14);
        }
    }

    #[test]
    fn fast_sampling_delays_by_the_time_constant_less_half_a_period() {
        assert!((delay(0.05, 1e-4) - (0.05 - 0.5e-4)).abs() < 2e-8);
    }
}
