//! Defects that recorders bring into recordings: stamps that jitter, gaps, lost values and wild ones.

use rand::Rng;
use rand_chacha::ChaCha8Rng;

use super::programme::Programme;

/// Dirt of recordings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dirt {
    /// Largest departure of a stamp from the grid, in steps [1].
    pub jitter: f64,
    /// Gaps in each recording.
    pub gaps: usize,
    /// Length of a gap [s].
    pub gap: f64,
    /// Share of values that are lost [1].
    pub lost: f64,
    /// Share of values that are wild [1].
    pub outliers: f64,
}

impl Dirt {
    /// As bad as a recording usually gets.
    pub const USUAL: Self = Self {
        jitter: 0.2,
        gaps: 2,
        gap: 0.06,
        lost: 0.01,
        outliers: 0.003,
    };

    /// Samples at other times: some jitter, some are gone. Commands move to the samples in which they are seen.
    pub(super) fn on_times(&self, programme: &mut Programme, rng: &mut ChaCha8Rng) {
        let grid = programme.times.clone();
        let step = grid[1] - grid[0];
        let changes = programme.set_pressures.iter().map(|c| c.0);
        let changes: Vec<f64> = changes.chain(programme.valve.iter().map(|v| v.0)).collect();
        let mut gaps: Vec<f64> = Vec::new();
        while gaps.len() < self.gaps {
            let from = rng.random_range(0.2..grid[grid.len() - 1] - 2.0 * self.gap);
            let near = |t: f64| t > from - 2.0 * step && t < from + self.gap + 2.0 * step;
            // What changes in a gap is not recorded.
            if !changes.iter().any(|t| near(*t)) {
                gaps.push(from);
            }
        }
        programme.times.clear();
        for (i, time) in grid.iter().enumerate() {
            let shift = if i == 0 {
                0.0
            } else {
                rng.random_range(-self.jitter..=self.jitter)
            };
            let stamp = ((time + shift * step) * 1e5).round() / 1e5;
            let moved = |t: &mut f64| {
                if (*t - time).abs() < 0.1 * step {
                    *t = stamp;
                }
            };
            programme
                .set_pressures
                .iter_mut()
                .for_each(|c| moved(&mut c.0));
            programme.valve.iter_mut().for_each(|v| moved(&mut v.0));
            if !gaps
                .iter()
                .any(|from| *time >= *from && *time < from + self.gap)
            {
                programme.times.push(stamp);
            }
        }
    }

    /// Values that are lost (NaN) or wild, of a sensor with this noise.
    pub(super) fn on_values(&self, values: &mut [f64], noise: f64, rng: &mut ChaCha8Rng) {
        let step = super::sensors::decimal(noise);
        for value in values {
            if rng.random_bool(self.lost) {
                *value = f64::NAN;
            } else if rng.random_bool(self.outliers) {
                let sign = if rng.random_bool(0.5) { 1.0 } else { -1.0 };
                let off = sign * noise * rng.random_range(30.0..200.0);
                *value = ((*value + off) / step).round() * step;
            }
        }
    }
}
