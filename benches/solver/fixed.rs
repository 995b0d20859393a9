//! Methods of fixed step on the model: what might stand in the loop instead of the classical Runge-Kutta method.
//!
//! Linearly implicit methods in Kaps' form, with the derivatives exact: ROS2 (Verwer et al. 1999, gamma = 1 + 1/sqrt 2), ROS3 and RODAS3
//! (Sandu et al. 1997), all L-stable; their linear system is solved by hand, for half of its entries are zero.

use super::legs::Timetable;
use super::model::{Leg, Model, Slopes, State};

/// Most changes of contact that are sought in one sub-step.
const MOST_EVENTS: usize = 6;
/// Halvings when one is sought.
const BISECTIONS: usize = 24;

/// The method of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// Heun's third-order method.
    Heun3,
    /// Ralston's third-order method, which is that of Bogacki and Shampine without its estimate.
    Ralston3,
    /// The classical method of order four.
    Classical4,
    /// Kutta's 3/8 rule.
    ThreeEighths,
    /// Two stages, order two.
    Ros2,
    /// Three stages, two rates, order three.
    Ros3,
    /// Four stages, three rates, order three, stiffly accurate.
    Rodas3,
}

impl Method {
    /// Name for the table.
    pub fn name(self) -> &'static str {
        match self {
            Self::Heun3 => "Heun 3",
            Self::Ralston3 => "Ralston 3 (Bogacki-Shampine)",
            Self::Classical4 => "classical RK4",
            Self::ThreeEighths => "3/8 rule",
            Self::Ros2 => "ROS2",
            Self::Ros3 => "ROS3",
            Self::Rodas3 => "RODAS3",
        }
    }
}

fn after<const N: usize>(y: &State, terms: [(f64, &State); N]) -> State {
    let mut sum = *y;
    for (factor, rates) in terms {
        for i in 0..4 {
            sum[i] += factor * rates[i];
        }
    }
    sum
}

/// A linearly implicit method: coefficients of the lower triangles by rows.
struct Rosenbrock<const S: usize> {
    gamma: f64,
    a: [[f64; S]; S],
    c: [[f64; S]; S],
    m: [f64; S],
    alpha: [f64; S],
    gammas: [f64; S],
    /// Whether the stage needs new rates.
    fresh: [bool; S],
}

const G2: f64 = 1.0 + std::f64::consts::FRAC_1_SQRT_2;
const ROS2: Rosenbrock<2> = Rosenbrock {
    gamma: G2,
    a: [[0.0, 0.0], [1.0 / G2, 0.0]],
    c: [[0.0, 0.0], [-2.0 / G2, 0.0]],
    m: [1.5 / G2, 0.5 / G2],
    alpha: [0.0, 1.0],
    gammas: [G2, -G2],
    fresh: [true, true],
};
const G3: f64 = 0.435_866_521_508_459;
const ROS3: Rosenbrock<3> = Rosenbrock {
    gamma: G3,
    a: [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0]],
    c: [
        [0.0; 3],
        [-1.015_617_108_387_770_3, 0.0, 0.0],
        [4.075_995_645_253_77, 9.207_679_429_833_079, 0.0],
    ],
    m: [1.0, 6.169_794_704_382_824, -0.427_722_565_432_185_73],
    alpha: [0.0, G3, G3],
    gammas: [G3, 0.242_919_964_548_168_04, 2.185_138_002_766_406],
    fresh: [true, true, false],
};
const RODAS3: Rosenbrock<4> = Rosenbrock {
    gamma: 0.5,
    a: [
        [0.0; 4],
        [0.0; 4],
        [2.0, 0.0, 0.0, 0.0],
        [2.0, 0.0, 1.0, 0.0],
    ],
    c: [
        [0.0; 4],
        [4.0, 0.0, 0.0, 0.0],
        [1.0, -1.0, 0.0, 0.0],
        [1.0, -1.0, -8.0 / 3.0, 0.0],
    ],
    m: [2.0, 0.0, 1.0, 1.0],
    alpha: [0.0, 0.0, 1.0, 1.0],
    gammas: [0.5, 1.5, 0.0, 0.0],
    fresh: [true, false, true, true],
};

/// 1/(gamma h) I - J, eliminated to one equation for the speed.
struct Factors {
    slopes: Slopes,
    diagonal: f64,
    masses: [f64; 2],
    stroke_share: [f64; 2],
    speed_share: f64,
}

impl Factors {
    fn new(slopes: Slopes, gamma_step: f64) -> Self {
        let diagonal = 1.0 / gamma_step;
        // m_i = (r_i + flow_i1 x) / (d - flow_i0);   x = (r_x + stroke v) / d
        let masses = [0, 1].map(|i| 1.0 / (diagonal - slopes.flow[i][0]));
        let stroke_share = [0, 1].map(|i| slopes.flow[i][1] * masses[i]);
        let by_stroke =
            slopes.speed[2] + slopes.speed[0] * stroke_share[0] + slopes.speed[1] * stroke_share[1];
        let speed = diagonal - slopes.speed[3] - by_stroke * slopes.stroke / diagonal;
        Self {
            slopes,
            diagonal,
            masses,
            stroke_share,
            speed_share: 1.0 / speed,
        }
    }

    fn solve(&self, r: &State) -> State {
        let s = &self.slopes;
        let free = [r[0] * self.masses[0], r[1] * self.masses[1]];
        let x = r[2] / self.diagonal;
        let by_stroke =
            s.speed[2] + s.speed[0] * self.stroke_share[0] + s.speed[1] * self.stroke_share[1];
        let right = r[3] + s.speed[0] * free[0] + s.speed[1] * free[1] + by_stroke * x;
        let speed = right * self.speed_share;
        let stroke = x + s.stroke * speed / self.diagonal;
        [
            free[0] + self.stroke_share[0] * stroke,
            free[1] + self.stroke_share[1] * stroke,
            stroke,
            speed,
        ]
    }
}

impl<const S: usize> Rosenbrock<S> {
    #[inline(always)]
    fn step(&self, model: &Model, leg: &Leg, time: f64, y: &State, h: f64) -> State {
        let slopes = model.slopes(leg, time, y);
        let factors = Factors::new(slopes, self.gamma * h);
        let mut k = [[0.0; 4]; S];
        let mut rates = [0.0; 4];
        for stage in 0..S {
            if self.fresh[stage] {
                let mut there = *y;
                for (a, k) in self.a[stage].iter().zip(&k[..stage]) {
                    there = after(&there, [(*a, k)]);
                }
                rates = model.rates(leg, time + self.alpha[stage] * h, &there);
            }
            let mut right = rates;
            for (c, k) in self.c[stage].iter().zip(&k[..stage]) {
                right = after(&right, [(c / h, k)]);
            }
            let [first, second] = slopes.time;
            let share = h * self.gammas[stage];
            right = after(&right, [(share, &[first, second, 0.0, 0.0])]);
            k[stage] = factors.solve(&right);
        }
        let mut end = *y;
        for (m, k) in self.m.iter().zip(&k) {
            end = after(&end, [(*m, k)]);
        }
        end
    }
}

fn step(method: Method, model: &Model, leg: &Leg, t: f64, y: &State, h: f64) -> State {
    let f = |share: f64, y: &State| model.rates(leg, t + share * h, y);
    match method {
        Method::Heun3 => {
            let k1 = f(0.0, y);
            let k2 = f(1.0 / 3.0, &after(y, [(h / 3.0, &k1)]));
            let k3 = f(2.0 / 3.0, &after(y, [(h * 2.0 / 3.0, &k2)]));
            after(y, [(h * 0.25, &k1), (h * 0.75, &k3)])
        }
        Method::Ralston3 => {
            let k1 = f(0.0, y);
            let k2 = f(0.5, &after(y, [(0.5 * h, &k1)]));
            let k3 = f(0.75, &after(y, [(0.75 * h, &k2)]));
            after(
                y,
                [(h * 2.0 / 9.0, &k1), (h / 3.0, &k2), (h * 4.0 / 9.0, &k3)],
            )
        }
        Method::Classical4 => {
            let k1 = f(0.0, y);
            let k2 = f(0.5, &after(y, [(0.5 * h, &k1)]));
            let k3 = f(0.5, &after(y, [(0.5 * h, &k2)]));
            let k4 = f(1.0, &after(y, [(h, &k3)]));
            after(
                y,
                [
                    (h / 6.0, &k1),
                    (h / 3.0, &k2),
                    (h / 3.0, &k3),
                    (h / 6.0, &k4),
                ],
            )
        }
        Method::ThreeEighths => {
            let k1 = f(0.0, y);
            let k2 = f(1.0 / 3.0, &after(y, [(h / 3.0, &k1)]));
            let k3 = f(2.0 / 3.0, &after(y, [(-h / 3.0, &k1), (h, &k2)]));
            let k4 = f(1.0, &after(y, [(h, &k1), (-h, &k2), (h, &k3)]));
            after(
                y,
                [
                    (h * 0.125, &k1),
                    (h * 0.375, &k2),
                    (h * 0.375, &k3),
                    (h * 0.125, &k4),
                ],
            )
        }
        Method::Ros2 => ROS2.step(model, leg, t, y, h),
        Method::Ros3 => ROS3.step(model, leg, t, y, h),
        Method::Rodas3 => RODAS3.step(model, leg, t, y, h),
    }
}

/// A fixed-step run in steps of 1 ms.
#[derive(Debug, Clone, Copy)]
pub struct Fixed {
    /// The method.
    pub method: Method,
    /// Sub-steps in a millisecond.
    pub substeps: usize,
    /// Whether changes of contact are met where they happen. If not, a sub-step keeps to the contacts that it began with.
    pub located: bool,
}

impl Fixed {
    /// A method that meets changes of contact where they happen.
    pub fn new(method: Method, substeps: usize) -> Self {
        Self {
            method,
            substeps,
            located: true,
        }
    }

    /// Hands the state at each millisecond to `seen`.
    pub fn run(
        &self,
        model: &Model,
        timetable: &Timetable,
        start: State,
        seen: &mut dyn FnMut(f64, &State),
    ) {
        let mut state = start;
        seen(0.0, &state);
        let breaks = timetable.breaks();
        let mut next = 1;
        let mut leg = timetable.leg(model, None, 0.0, &state);
        let steps = (timetable.end * 1e3).round() as usize;
        for i in 0..steps {
            let (mut time, end) = (i as f64 * 1e-3, (i + 1) as f64 * 1e-3);
            while end - time > 1e-12 {
                let until = breaks.get(next).copied().unwrap_or(end);
                let until = if until < end - 1e-12 { until } else { end };
                let count = ((until - time) / 1e-3 * self.substeps as f64 - 1e-9).ceil();
                let h = (until - time) / count;
                for sub in 0..count as usize {
                    self.advance(model, &mut leg, time + h * sub as f64, &mut state, h);
                }
                time = until;
                while breaks.get(next).is_some_and(|b| *b <= time + 1e-12) {
                    leg = timetable.leg(model, Some(&leg), breaks[next], &state);
                    next += 1;
                }
            }
            seen(end, &state);
        }
    }

    fn advance(&self, model: &Model, leg: &mut Leg, start: f64, state: &mut State, h: f64) {
        let (mut from, mut left) = (start, h);
        if self.located {
            for _ in 0..MOST_EVENTS {
                leg.contacts = model.contacts(state);
                let whole = step(self.method, model, leg, from, state, left);
                if model.contacts(&whole) == leg.contacts {
                    *state = whole;
                    return;
                }
                let (mut before, mut after, mut there) = (0.0, left, whole);
                for _ in 0..BISECTIONS {
                    let middle = 0.5 * (before + after);
                    let tried = step(self.method, model, leg, from, state, middle);
                    if model.contacts(&tried) == leg.contacts {
                        before = middle;
                    } else {
                        (after, there) = (middle, tried);
                    }
                }
                *state = there;
                from += after;
                left -= after;
                if left <= 0.0 {
                    return;
                }
            }
        }
        leg.contacts = model.contacts(state);
        *state = step(self.method, model, leg, from, state, left);
    }
}
