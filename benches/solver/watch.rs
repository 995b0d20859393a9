//! Time and error of a run.

use std::time::{Duration, Instant};

use super::case::Case;
use super::model::State;

/// Cost and error of a method on one case.
#[derive(Debug, Clone, Copy)]
pub struct Measured {
    /// Microseconds a simulated millisecond, within the window.
    pub inside: f64,
    /// The same over the whole run.
    pub whole: f64,
    /// Largest error over full scale [1].
    pub error: f64,
}

/// Time that the rounds of a run take at least: short ones get more of them.
const AT_LEAST: Duration = Duration::from_millis(300);

/// Listener to the samples of a run.
pub type Seen<'a> = &'a mut dyn FnMut(f64, &State);

/// Simulated time whose cost is taken by itself [s].
const PIECE: f64 = 0.01;

/// Measures a run in pieces, of each the best of at least `rounds`: other work on the machine only ever makes it slower, and rarely twice in the
/// same piece.
pub fn measure(
    case: &Case,
    rounds: usize,
    window: (f64, f64),
    run: &mut dyn FnMut(Seen<'_>),
) -> Measured {
    let mut best: Vec<f64> = Vec::new();
    let mut error = f64::NAN;
    let begun = Instant::now();
    let mut done = 0;
    while done < rounds || begun.elapsed() < AT_LEAST {
        done += 1;
        let mut watch = Watch::new(2 * case.steps());
        run(&mut |time, state| watch.see(time, state));
        let pieces = watch.pieces();
        if error.is_nan() {
            error = case.error(&watch.samples);
            best = pieces;
            continue;
        }
        for (best, piece) in best.iter_mut().zip(pieces) {
            *best = best.min(piece);
        }
    }
    let cost =
        |pieces: &[f64]| pieces.iter().sum::<f64>() * 1e6 / (pieces.len() as f64 * PIECE * 1e3);
    let [first, last] = [window.0, window.1].map(|time| (time / PIECE).round() as usize);
    Measured {
        inside: best.get(first..last).map_or(f64::NAN, cost),
        whole: cost(&best),
        error,
    }
}

/// Watches a run: its samples, and when it came to the end of each piece.
struct Watch {
    marks: Vec<Instant>,
    samples: Vec<(f64, State)>,
}

impl Watch {
    fn new(samples: usize) -> Self {
        Self {
            samples: Vec::with_capacity(samples),
            marks: vec![Instant::now()],
        }
    }

    fn see(&mut self, time: f64, state: &State) {
        while time >= self.marks.len() as f64 * PIECE - 1e-9 {
            self.marks.push(Instant::now());
        }
        self.samples.push((time, *state));
    }

    /// Seconds that each piece took.
    fn pieces(&self) -> Vec<f64> {
        let pairs = self.marks.windows(2);
        pairs
            .map(|pair| (pair[1] - pair[0]).as_secs_f64())
            .collect()
    }
}
