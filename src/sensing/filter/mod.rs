//! Treatment of the load cell's noise, with what it costs in delay.
//!
//! ```text
//! delay = -d arg H(e^(i w T)) / dw at w = 0,   noise factor = sd(output) / sd(white input)
//! ```
//!
//! T sample period [s]. The delay is how far the output lags a ramp, the discretisation included. It counts from sample to
//! sample: that a reading is held until the next one adds half a period on average, with or without a filter.

pub mod bessel;
pub mod first_order;
pub mod median;

use bessel::BesselFilter;
use first_order::FirstOrderFilter;
use median::MedianFilter;

/// A filter and its one parameter.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum FilterParameters {
    /// The samples as they are.
    #[default]
    None,
    /// First-order lag.
    FirstOrder {
        /// Time constant [s], above 0.
        time_constant: f64,
    },
    /// Second-order Bessel filter: the delay hardly depends on the frequency.
    Bessel2 {
        /// Frequency at which it passes 1/sqrt(2) [Hz], above 0 and below half the sample rate.
        cutoff: f64,
    },
    /// Median of the last samples: takes single outliers away.
    Median {
        /// Number of samples, odd, 1 to 99.
        length: usize,
    },
}

impl FilterParameters {
    /// Delay of slow signals [s] at a sample period [s].
    pub fn delay(&self, sample_period: f64) -> f64 {
        match *self {
            Self::None => 0.0,
            Self::FirstOrder { time_constant } => first_order::delay(time_constant, sample_period),
            Self::Bessel2 { cutoff } => bessel::delay(cutoff, sample_period),
            Self::Median { length } => median::delay(length, sample_period),
        }
    }

    /// Standard deviation of the output over that of white noise at the input [1], normal noise for the median.
    pub fn noise_factor(&self, sample_period: f64) -> f64 {
        match *self {
            Self::None => 1.0,
            Self::FirstOrder { time_constant } => {
                first_order::noise_factor(time_constant, sample_period)
            }
            Self::Bessel2 { cutoff } => bessel::noise_factor(cutoff, sample_period),
            Self::Median { length } => median::noise_factor(length),
        }
    }
}

/// A filter and what it remembers.
#[derive(Debug, Clone, PartialEq)]
pub enum Filter {
    /// The samples as they are.
    None,
    /// First-order lag.
    FirstOrder(FirstOrderFilter),
    /// Second-order Bessel filter.
    Bessel2(BesselFilter),
    /// Median of the last samples.
    Median(MedianFilter),
}

impl Filter {
    /// At a sample period [s]; it starts settled at its first sample.
    pub fn new(parameters: &FilterParameters, sample_period: f64) -> Self {
        match *parameters {
            FilterParameters::None => Self::None,
            FilterParameters::FirstOrder { time_constant } => {
                Self::FirstOrder(FirstOrderFilter::new(time_constant, sample_period))
            }
            FilterParameters::Bessel2 { cutoff } => {
                Self::Bessel2(BesselFilter::new(cutoff, sample_period))
            }
            FilterParameters::Median { length } => Self::Median(MedianFilter::new(length)),
        }
    }

    /// Takes a sample and returns the filtered value.
    pub fn apply(&mut self, sample: f64) -> f64 {
        match self {
            Self::None => sample,
            Self::FirstOrder(filter) => filter.apply(sample),
            Self::Bessel2(filter) => filter.apply(sample),
            Self::Median(filter) => filter.apply(sample),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::noise::{Noise, Stream};
    use super::*;

    const PERIOD: f64 = 2e-3;

    const ALL: [FilterParameters; 8] = [
        FilterParameters::None,
        FilterParameters::FirstOrder {
            time_constant: 0.02,
        },
        FilterParameters::FirstOrder {
            time_constant: 1e-3,
        },
        FilterParameters::Bessel2 { cutoff: 15.0 },
        FilterParameters::Bessel2 { cutoff: 120.0 },
        FilterParameters::Median { length: 1 },
        FilterParameters::Median { length: 3 },
        FilterParameters::Median { length: 11 },
    ];

    #[test]
    fn the_stated_delay_is_the_lag_behind_a_ramp() {
        for parameters in ALL {
            let mut filter = Filter::new(&parameters, PERIOD);
            let slope = 35.0;
            let mut lag = f64::NAN;
            for k in 0..2000 {
                let truth = slope * f64::from(k) * PERIOD;
                lag = (truth - filter.apply(truth)) / slope;
            }
            let stated = parameters.delay(PERIOD);
            assert!(
                (lag - stated).abs() < 1e-12,
                "{parameters:?}: {lag} {stated}"
            );
        }
    }

    #[test]
    fn a_constant_passes_unchanged_from_the_first_sample() {
        for parameters in ALL {
            let mut filter = Filter::new(&parameters, PERIOD);
            for _ in 0..1000 {
                assert_eq!(filter.apply(123.456), 123.456, "{parameters:?}");
            }
        }
    }

    #[test]
    fn a_step_is_reached_in_full() {
        for parameters in ALL {
            let mut filter = Filter::new(&parameters, PERIOD);
            filter.apply(0.0);
            let last = (0..2000).fold(0.0, |_, _| filter.apply(77.7));
            assert!((last / 77.7 - 1.0).abs() < 1e-14, "{parameters:?}");
        }
    }

    #[test]
    fn the_stated_noise_factor_is_the_one_measured() {
        for parameters in ALL {
            let mut filter = Filter::new(&parameters, PERIOD);
            let mut noise = Noise::new(17, Stream::Force);
            let count = 200_000;
            let squares: f64 = (0..count)
                .map(|_| filter.apply(noise.normal()).powi(2))
                .sum();
            let measured = (squares / f64::from(count)).sqrt();
            let stated = parameters.noise_factor(PERIOD);
            assert!(
                (measured / stated - 1.0).abs() < 0.02,
                "{parameters:?}: {measured} {stated}"
            );
        }
    }
}
