//! Zero-phase Butterworth low-pass of order four, run forwards and backwards.
//!
//! ```text
//! |H(f)|^2 = 1/(1 + (tan(pi f/r)/tan(pi c/r))^8)        in each direction
//! ```
//!
//! c cut-off [Hz], r sample rate [Hz]. Source: Oppenheim and Schafer, Discrete-Time Signal Processing, 2010, sec. 7.2 (bilinear transformation).

use std::f64::consts::PI;

/// One section of second order: feed-forward and feedback coefficients.
struct Section {
    b: [f64; 3],
    a: [f64; 2],
}

fn sections(cut_off: f64, rate: f64) -> [Section; 2] {
    let k = (PI * cut_off / rate).tan();
    // Quality factors of the two pole pairs.
    [PI / 8.0, 3.0 * PI / 8.0].map(|angle| {
        let q = 0.5 / angle.cos();
        let norm = 1.0 / (1.0 + k / q + k * k);
        let b = k * k * norm;
        Section {
            b: [b, 2.0 * b, b],
            a: [2.0 * (k * k - 1.0) * norm, (1.0 - k / q + k * k) * norm],
        }
    })
}

/// Runs over a signal as if it had always been at its first value.
fn run(section: &Section, signal: &mut [f64]) {
    let Section { b, a } = section;
    let first = signal[0];
    let (mut x, mut y) = ([first; 2], [first; 2]);
    for value in signal {
        let new = b[0] * *value + b[1] * x[0] + b[2] * x[1] - a[0] * y[0] - a[1] * y[1];
        x = [*value, x[0]];
        y = [new, y[0]];
        *value = new;
    }
}

/// A signal at a rate [Hz] through the low-pass of a cut-off [Hz], without delay; as it is where the cut-off is not below 0.45 of the rate.
#[must_use]
pub fn low_pass(signal: &[f64], rate: f64, cut_off: f64) -> Vec<f64> {
    if signal.len() < 2 || cut_off >= 0.45 * rate {
        return signal.to_vec();
    }
    // Continued beyond both ends, turned about them, so that a slope goes on.
    let pad = ((3.0 * rate / cut_off) as usize).min(signal.len() - 1);
    let (first, last) = (signal[0], signal[signal.len() - 1]);
    let before = signal[1..=pad].iter().rev().map(|v| 2.0 * first - v);
    let after = signal[signal.len() - 1 - pad..signal.len() - 1]
        .iter()
        .rev();
    let mut all: Vec<f64> = before
        .chain(signal.iter().copied())
        .chain(after.map(|v| 2.0 * last - v))
        .collect();
    for section in sections(cut_off, rate) {
        run(&section, &mut all);
        all.reverse();
        run(&section, &mut all);
        all.reverse();
    }
    all[pad..pad + signal.len()].to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sine_keeps_its_phase_and_loses_what_the_closed_form_says() {
        let (rate, cut_off) = (100.0, 8.0);
        for frequency in [2.0, 8.0, 12.0] {
            let sine = |i: usize| (2.0 * PI * frequency * i as f64 / rate).sin();
            let signal: Vec<f64> = (0..2000).map(sine).collect();
            let found = low_pass(&signal, rate, cut_off);
            let middle = 500..1500;
            let [mut same, mut across] = [0.0, 0.0];
            for i in middle {
                same += found[i] * sine(i) / 500.0;
                across += found[i] * (2.0 * PI * frequency * i as f64 / rate).cos() / 500.0;
            }
            let ratio = (PI * frequency / rate).tan() / (PI * cut_off / rate).tan();
            let expected = 1.0 / (1.0 + ratio.powi(8));
            assert!((same - expected).abs() < 2e-3, "{same} {expected}");
            assert!(across.abs() < 2e-3);
        }
    }

    #[test]
    fn a_slope_passes_as_it_is() {
        let signal: Vec<f64> = (0..300).map(|i| 0.3 + 0.01 * f64::from(i)).collect();
        for (found, given) in low_pass(&signal, 100.0, 5.0).iter().zip(&signal) {
            assert!((found - given).abs() < 1e-3);
        }
    }
}
