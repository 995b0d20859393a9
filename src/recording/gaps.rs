//! Gaps in a recording: where so long nothing was recorded that what a device did meanwhile is not known. What stands on either side is a recording of its own.

use std::ops::Range;

use crate::stats::median_step;

/// Longest pause between two samples of one recording: this [s], or so many usual steps, whichever is longer.
const PAUSE: f64 = 1.0;
const STEPS: f64 = 50.0;

/// A gap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gap {
    /// Samples before it.
    pub before: usize,
    /// Samples after it.
    pub after: usize,
    /// Times of the last sample before it and of the first after it [s].
    pub from: f64,
    /// See [`Gap::from`].
    pub to: f64,
}

/// Longest pause that is no gap [s].
#[must_use]
pub fn longest_pause(time: &[f64]) -> f64 {
    PAUSE.max(STEPS * median_step(time))
}

/// The longest gap between increasing times [s], if there is one.
#[must_use]
pub fn longest_gap(time: &[f64]) -> Option<Gap> {
    let length = |index: usize| time[index] - time[index - 1];
    let longest = (1..time.len()).max_by(|a, b| length(*a).total_cmp(&length(*b)))?;
    (length(longest) > longest_pause(time)).then(|| Gap {
        before: longest,
        after: time.len() - longest,
        from: time[longest - 1],
        to: time[longest],
    })
}

/// The stretches between gaps, in order: all of it where there is none.
#[must_use]
pub fn parts(time: &[f64]) -> Vec<Range<usize>> {
    let pause = longest_pause(time);
    let mut parts = Vec::new();
    let mut start = 0;
    for index in 1..time.len() {
        if time[index] - time[index - 1] > pause {
            parts.push(start..index);
            start = index;
        }
    }
    parts.push(start..time.len());
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Times a step apart, with a pause before some of them.
    fn times(step: f64, count: usize, pauses: &[(usize, f64)]) -> Vec<f64> {
        let mut time = Vec::new();
        let mut now = 0.0;
        for index in 0..count {
            let pause = pauses.iter().find(|(at, _)| *at == index);
            now += pause.map_or(step, |(_, pause)| *pause);
            time.push(now);
        }
        time
    }

    #[test]
    fn an_hour_is_a_gap_and_some_dropped_samples_are_none() {
        let time = times(0.004, 1000, &[(300, 0.9), (400, 3600.0), (700, 60.0)]);
        assert_eq!(parts(&time), [0..400, 400..700, 700..1000]);
        let gap = longest_gap(&time).unwrap();
        assert_eq!((gap.before, gap.after), (400, 600));
        assert!((gap.to - gap.from - 3600.0).abs() < 1e-9);
        // Of a slow logger a pause of a second is a few samples.
        let slow = times(0.1, 300, &[(100, 4.9)]);
        assert_eq!(longest_gap(&slow), None);
        assert_eq!(parts(&slow).as_slice(), std::slice::from_ref(&(0..300)));
        assert_eq!(longest_gap(&[0.0]), None);
        assert_eq!(longest_gap(&[0.0, 9.0]), None);
    }
}
