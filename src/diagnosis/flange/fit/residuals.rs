//! What of a run the simulation is to meet: the impact reading by reading, the bounces in means of 10 ms, the way to rest in means of 25 to 40 ms, the
//! spectrum of the ringing and the frequency of its largest line, and the logged peak.
//!
//! Bounces are chaotic: read by read they would only tell by how much each of them is too early. Residuals are scaled by the largest reading of the run.

use super::course::RunCourse;
use super::prediction::PHASES;
use crate::diagnosis::flange::{Run, RunMetrics, power_at};
use crate::flange::{FlangeModel, Reader, SAMPLED, flange_force};

/// Time before contact from which a run is simulated [s].
const LEAD: f64 = 0.03;
/// Time after contact until which it is [s].
const UNTIL: f64 = 1.02;
/// Impact: time after contact [s], tolerance by the largest reading [1], weight of its readings, which are many to a swing [1].
const IMPACT: (f64, f64, f64) = (0.02, 0.025, 0.63);
/// Bounces: from, to, every, width [s]; tolerance by the largest reading [1]; time in which their weight falls [s].
const BOUNCES: [f64; 6] = [0.02, 0.3, 0.004, 0.01, 0.04, 0.3];
/// Rest: from, to, every, width [s], twice; tolerance by the largest reading [1], by the standard deviation of the readings [1].
const REST: [[f64; 4]; 2] = [[0.06, 0.3, 0.01, 0.025], [0.3, 1.0, 0.04, 0.04]];
const AT_REST: (f64, f64) = (0.008, 0.4);
/// Ringing: times after the last bounce [s]; tolerance of the logarithm of an amplitude and of the frequency [1].
const RINGS: [[f64; 2]; 2] = [[0.01, 0.21], [0.21, 0.41]];
const RINGING: (f64, f64) = (0.5, 0.02);
/// Amplitude below which the ringing is not looked at, by the largest reading [1].
const FAINT: f64 = 0.003;
/// Frequencies looked at: first, step [Hz], in a band, bands.
const FREQUENCIES: (f64, f64, usize, usize) = (40.0, 7.5, 3, 12);
/// Samples in which a log's lags forget how they began [-].
const SETTLES: usize = 10;
/// Width of a line by its frequency, to either side [1].
const LINE: f64 = 0.2;
const WHOLE: f64 = f64::INFINITY;
/// Residual of the logarithm of the logged peak [1].
const PEAK: f64 = 0.025;
/// Time after contact in which each reading differs from that before, so that the reader is identified [s].
const READER_TIME: f64 = 0.35;

/// A mean over a time that is to be met.
#[derive(Debug, Clone)]
struct Mean {
    at: f64,
    width: f64,
    value: f64,
    tolerance: f64,
}

/// Targets of a run.
#[derive(Debug, Clone)]
pub(super) struct Targets {
    pub course: RunCourse,
    pub reader: Reader,
    /// Instants of the readings in the impact [s], with what they are [N].
    impact: Vec<(f64, f64)>,
    /// Times of the log's samples in the impact [s].
    clock: Vec<f64>,
    /// Phase of the readings and time between samples [s].
    phase: f64,
    period: f64,
    means: Vec<Mean>,
    /// Last bounce [s].
    bounced: f64,
    rings: [Vec<f64>; 2],
    /// Centre of the power about the largest line, and of all power [Hz]; none where nothing rings.
    lines: Option<[f64; 2]>,
    peak: f64,
    scale: f64,
}

impl Targets {
    /// Of a run.
    pub fn of(run: &Run, shown: &RunMetrics) -> Self {
        let period = (run.time[run.time.len() - 1] - run.time[0]) / (run.time.len() - 1) as f64;
        let contact = shown.contact;
        let at = |time: f64| run.time.partition_point(|t| *t < contact + time);
        let reader = Reader::of(&run.force[at(0.0)..at(READER_TIME)], period);
        let readings = reader.readings(&run.force);
        let course = RunCourse::of(run, shown, LEAD);
        let (from, to) = (at(-0.004), at(IMPACT.0));
        let phase = phase(&reader, &run.time[from..to], &readings[from..to], period);
        let impact: Vec<(f64, f64)> = (from..to)
            .map(|i| (reader.read_at(run.time[i], phase), readings[i]))
            .collect();
        let largest = |values: &[(f64, f64)]| values.iter().map(|v| v.1).fold(0.0, f64::max);
        let scale = largest(&impact).max(1e-3);
        let series = Series::new(&readings[at(-LEAD)..], run.time[at(-LEAD)], period);
        let means = means(&series, contact, scale, shown.steady);
        let bounced = shown.bounced - contact;
        let rings = RINGS.map(|[a, b]| {
            let (a, b) = (at(bounced + a), at(bounced + b));
            spectrum(&run.time[a..b], &run.force[a..b])
        });
        let lines = shown.frequency.map(|frequency| {
            [LINE, WHOLE].map(|width| centroid(&rings[0], frequency, width).unwrap_or(frequency))
        });
        Self {
            course,
            reader,
            impact,
            clock: run.time[from..to].to_vec(),
            phase,
            period,
            means,
            bounced: shown.bounced,
            lines,
            rings: rings.map(|powers| bands(&powers)),
            peak: shown.peak,
            scale,
        }
    }

    /// Frequency of the largest line of the ringing [Hz], where it rings.
    pub fn line(&self) -> Option<f64> {
        self.lines.map(|[line, _]| line)
    }

    /// Residuals of the simulation from it, in those accepted, with a touch that is later [s].
    pub fn residuals(&self, model: &FlangeModel, later: f64) -> Vec<f64> {
        let course = self.course.later(later);
        let contact = self.course.contact;
        let force = flange_force(model, &course, contact + UNTIL);
        let series = Series::new(&force, course.start, SAMPLED);
        let mut residuals = Vec::with_capacity(self.impact.len() + self.means.len() + 8);
        let (_, tolerance, weight) = IMPACT;
        for (time, value) in &self.impact {
            let simulated = series.at(*time);
            residuals.push(weight * (simulated - value) / (tolerance * self.scale));
        }
        let means = self.means.iter();
        residuals.extend(means.map(|m| (series.mean(m.at, m.width) - m.value) / m.tolerance));
        residuals.push((self.logged_peak(&series) / self.peak).ln() / PEAK);
        let faint = FAINT * self.scale;
        for (index, ([from, to], recorded)) in RINGS.iter().zip(&self.rings).enumerate() {
            let (time, force) = self.logged(&series, self.bounced + from, self.bounced + to);
            let powers = spectrum(&time, &force);
            let simulated = bands(&powers);
            let both = simulated.iter().zip(recorded);
            residuals.extend(both.map(|(s, r)| ((s + faint) / (r + faint)).ln() / RINGING.0));
            if let (0, Some(lines)) = (index, self.lines) {
                for (line, width) in lines.into_iter().zip([LINE, WHOLE]) {
                    let simulated = centroid(&powers, lines[0], width).unwrap_or(0.0);
                    residuals.push((simulated / line).ln() / RINGING.1);
                }
            }
        }
        for residual in &mut residuals {
            *residual = match residual.is_finite() {
                true => residual.clamp(-50.0, 50.0),
                false => 50.0,
            };
        }
        residuals
    }

    /// Peak of the log, the mean over phases of the readings [N]: which of them a run has is chance.
    fn logged_peak(&self, series: &Series<'_>) -> f64 {
        let peaks = PHASES.map(|share| {
            let phase = self.phase + share * self.reader.period;
            let times = self.clock.iter().map(|t| self.reader.read_at(*t, phase));
            let readings: Vec<f64> = times.map(|time| series.at(time)).collect();
            self.reader
                .logged(&readings)
                .into_iter()
                .fold(1e-3, f64::max)
        });
        peaks.iter().sum::<f64>() / peaks.len() as f64
    }

    /// The log from one time to another [s].
    fn logged(&self, series: &Series<'_>, from: f64, to: f64) -> (Vec<f64>, Vec<f64>) {
        let count = ((to - from) / self.period) as usize + SETTLES;
        let start = from - self.period * SETTLES as f64;
        let (time, read): (Vec<f64>, Vec<f64>) = (0..count)
            .map(|i| start + self.period * i as f64)
            .map(|time| (time, series.at(self.reader.read_at(time, self.phase))))
            .unzip();
        let log = self.reader.logged(&read);
        (time[SETTLES..].to_vec(), log[SETTLES..].to_vec())
    }
}

/// Means over bounces and on the way to rest.
fn means(series: &Series<'_>, contact: f64, scale: f64, steady: f64) -> Vec<Mean> {
    let every = |[from, to, step]: [f64; 3]| {
        let count = ((to - from) / step).round() as usize;
        (0..count).map(move |i| contact + from + step * i as f64)
    };
    let [from, to, step, width, share, fades] = BOUNCES;
    let bounces = every([from, to, step]).map(|at| Mean {
        at,
        width,
        value: series.mean(at, width),
        tolerance: share * scale * ((at - contact - from) / fades).exp(),
    });
    let mut means: Vec<Mean> = bounces.collect();
    for [from, to, step, width] in REST {
        means.extend(every([from, to, step]).map(|at| Mean {
            at,
            width,
            value: series.mean(at, width) - steady,
            tolerance: AT_REST.0 * scale + AT_REST.1 * series.deviation(at, 0.05),
        }));
    }
    means
}

/// Phase of the readings [s]: that with which they change where the log does, the middle of those that do.
fn phase(reader: &Reader, time: &[f64], readings: &[f64], period: f64) -> f64 {
    const PHASES: u32 = 20;
    let largest = readings.iter().copied().fold(0.0, f64::max);
    let changes: Vec<f64> = (1..time.len())
        .filter(|i| (readings[*i] - readings[i - 1]).abs() > 2e-3 * largest)
        .map(|i| time[i])
        .collect();
    let phases = (0..PHASES).map(|k| reader.period * f64::from(k) / f64::from(PHASES));
    // A reading that a change shows was taken within the sample before it.
    let missed = |phase: f64| {
        let late = |t: &&f64| **t - reader.read_at(**t, phase) > period;
        changes.iter().filter(late).count()
    };
    let counted: Vec<(usize, f64)> = phases.map(|phase| (missed(phase), phase)).collect();
    let least = counted.iter().map(|(count, _)| *count).min().unwrap_or(0);
    let best: Vec<f64> = (counted.iter().filter(|(count, _)| *count == least))
        .map(|(_, phase)| *phase)
        .collect();
    best.get(best.len() / 2).copied().unwrap_or(0.0)
}

/// Powers at all frequencies.
fn spectrum(time: &[f64], values: &[f64]) -> Vec<f64> {
    let (first, step, width, count) = FREQUENCIES;
    let frequencies = (0..width * count).map(|k| first + step * k as f64);
    frequencies
        .map(|f| match time.len() < 8 {
            true => 0.0,
            false => power_at(time, values, f),
        })
        .collect()
}

/// Amplitudes of bands.
fn bands(powers: &[f64]) -> Vec<f64> {
    let width = FREQUENCIES.2;
    let chunks = powers.chunks(width);
    chunks.map(|band| band.iter().sum::<f64>().sqrt()).collect()
}

/// Centre of the power about a frequency [Hz].
fn centroid(powers: &[f64], frequency: f64, width: f64) -> Option<f64> {
    let (first, step, ..) = FREQUENCIES;
    let (mut sum, mut weighted) = (0.0, 0.0);
    for (k, power) in powers.iter().enumerate() {
        let own = first + step * k as f64;
        if (own / frequency).ln().abs() < width {
            sum += power;
            weighted += power * own;
        }
    }
    (sum > 0.0).then(|| weighted / sum)
}

/// Evenly sampled values with their sums.
struct Series<'a> {
    values: &'a [f64],
    sums: Vec<[f64; 2]>,
    start: f64,
    period: f64,
}

impl<'a> Series<'a> {
    fn new(values: &'a [f64], start: f64, period: f64) -> Self {
        let mut sums = Vec::with_capacity(values.len() + 1);
        let mut sum = [0.0; 2];
        sums.push(sum);
        for value in values {
            sum = [sum[0] + value, sum[1] + value * value];
            sums.push(sum);
        }
        Self {
            values,
            sums,
            start,
            period,
        }
    }

    fn index(&self, time: f64) -> usize {
        let place = ((time - self.start) / self.period).ceil().max(0.0);
        (place as usize).min(self.values.len())
    }

    fn at(&self, time: f64) -> f64 {
        let index = self.index(time).min(self.values.len() - 1);
        self.values[index]
    }

    fn moments(&self, at: f64, width: f64) -> [f64; 2] {
        let from = self.index(at - 0.5 * width);
        let to = self.index(at + 0.5 * width).max(from);
        let count = (to - from).max(1) as f64;
        [0, 1].map(|k| (self.sums[to][k] - self.sums[from][k]) / count)
    }

    fn mean(&self, at: f64, width: f64) -> f64 {
        self.moments(at, width)[0]
    }

    fn deviation(&self, at: f64, width: f64) -> f64 {
        let [mean, square] = self.moments(at, width);
        (square - mean * mean).max(0.0).sqrt()
    }
}
