//! Currents that are stamped later than positions.
//!
//! ```text
//! i_logged(t) = i(t - d)
//! ```
//!
//! d delay [s]. Linear between samples; before the first it is the first.

/// A signal as it is logged.
#[must_use]
pub fn delayed(time: &[f64], signal: &[f64], delay: f64) -> Vec<f64> {
    if delay == 0.0 || signal.is_empty() {
        return signal.to_vec();
    }
    let mut i = 0;
    let last = time.len() - 1;
    let at = |t: &f64| {
        let asked = t - delay;
        while i < last && time[i + 1] < asked {
            i += 1;
        }
        while i > 0 && time[i] > asked {
            i -= 1;
        }
        if asked <= time[0] || i == last {
            return signal[if asked <= time[0] { 0 } else { last }];
        }
        let share = (asked - time[i]) / (time[i + 1] - time[i]);
        signal[i] + share.clamp(0.0, 1.0) * (signal[i + 1] - signal[i])
    };
    time.iter().map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slope_comes_later() {
        let time: Vec<f64> = (0..100).map(|i| 0.01 * f64::from(i)).collect();
        let found = delayed(&time, &time, 0.024);
        assert!((found[50] - (0.5 - 0.024)).abs() < 1e-12);
        assert_eq!(found[0], 0.0);
        assert_eq!(delayed(&time, &time, 0.0), time);
        assert!((delayed(&time, &time, -0.014)[50] - 0.514).abs() < 1e-12);
    }
}
