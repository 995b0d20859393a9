//! Zero, weight and centre by least squares in axes that are given.
//!
//! ```text
//! force = C A (z + P' w),   torque = C A (z_t + c x P' w)
//! ```
//!
//! P base from sensor as logged or its inverse, A identity (sensor's axes) or P (base's), C turn of the axes, z, z_t zeros in the sensor's axes, w the
//! weight in the base's, c the centre. Forces and torques count by what is left of each; Gauss-Newton with damping.

use nalgebra::{DMatrix, DVector, Matrix3, Rotation3, Vector3};

use super::Posture;
use super::frame::{Axes, Frame, Turn};
use super::nominal::Nominal;

/// Numbers of zero, weight and centre.
pub(super) const NUMBERS: usize = 12;
/// Steps at most.
const STEPS: usize = 40;
/// Share of the cost below which a further step is no use [1].
const SMALL: f64 = 1e-10;

/// A fit.
#[derive(Debug, Clone)]
pub struct Fit {
    /// The axes.
    pub frame: Frame,
    /// Their turn.
    pub turn: Matrix3<f64>,
    /// Zero of the force [N], weight in the base's axes [N], zero of the torque [N m], centre [m].
    pub numbers: [Vector3<f64>; 4],
    /// Standard deviations that are left of a force [N] and of a torque [N m].
    pub scatter: [f64; 2],
    /// Root mean squares that are left of them.
    pub rms: [f64; 2],
    /// Whether there are torques; without them their zero and the centre are 0.
    pub has_torques: bool,
    /// Covariance of the numbers, then of the turn's.
    pub covariance: DMatrix<f64>,
    /// Derivatives of all forces, then of all torques, over their scatter.
    pub(super) slopes: DMatrix<f64>,
    /// What is left of them, over their scatter.
    pub(super) left: DVector<f64>,
    /// Freedom of each kind [1].
    pub freedom: f64,
    /// -ln of the likelihood, scatters integrated out [1].
    pub cost: f64,
}

impl Fit {
    /// Weight in the base's axes, whatever the sign of the readings [N].
    #[must_use]
    pub fn weight(&self) -> Vector3<f64> {
        match self.frame.opposite {
            false => self.numbers[1],
            true => -self.numbers[1],
        }
    }

    /// Readings of force [N] and torque [N m] without any load, in the sensor's axes as they are.
    #[must_use]
    pub fn zeros(&self) -> [Vector3<f64>; 2] {
        let [zero, _, torque_zero, _] = self.numbers;
        match self.frame.axes {
            Axes::Sensor => [self.turn * zero, self.turn * torque_zero],
            Axes::Base => [zero, torque_zero],
        }
    }

    /// With its numbers changed.
    pub(super) fn stepped(&self, step: &DVector<f64>) -> Self {
        let state = State {
            turn: self.turn,
            numbers: self.numbers,
        };
        let State { turn, numbers } = state.stepped(step, self.frame.turn);
        Self {
            turn,
            numbers,
            ..self.clone()
        }
    }
}

/// Numbers and turn as they are being fitted.
#[derive(Clone)]
struct State {
    turn: Matrix3<f64>,
    numbers: [Vector3<f64>; 4],
}

impl State {
    fn stepped(&self, step: &DVector<f64>, turn: Turn) -> Self {
        let of = |i: usize| Vector3::new(step[3 * i], step[3 * i + 1], step[3 * i + 2]);
        let angles = match turn.count() {
            0 => Vector3::zeros(),
            1 => Vector3::new(0.0, 0.0, step[NUMBERS]),
            _ => of(4),
        };
        Self {
            turn: Rotation3::new(angles).into_inner() * self.turn,
            numbers: std::array::from_fn(|i| self.numbers[i] + of(i)),
        }
    }
}

/// Rotations of a posture by a frame: `A` and `P'`.
fn rotations(posture: &Posture, frame: Frame) -> (Matrix3<f64>, Matrix3<f64>) {
    let pose = match frame.inverse {
        false => posture.base_from_sensor,
        true => posture.base_from_sensor.transpose(),
    };
    let axes = match frame.axes {
        Axes::Sensor => Matrix3::identity(),
        Axes::Base => pose,
    };
    (axes, pose.transpose())
}

/// Forces, then torques, less what a state says of them.
fn residuals(postures: &[Posture], frame: Frame, state: &State) -> DVector<f64> {
    let half = 3 * postures.len();
    let mut rows = DVector::zeros(2 * half);
    let [zero, weight, torque_zero, centre] = state.numbers;
    for (i, posture) in postures.iter().enumerate() {
        let (axes, from_base) = rotations(posture, frame);
        let to_reading = state.turn * axes;
        let load = from_base * weight;
        let force = posture.force - to_reading * (zero + load);
        rows.fixed_rows_mut::<3>(3 * i).copy_from(&force);
        if let Some(read) = posture.torque {
            let torque = read - to_reading * (torque_zero + centre.cross(&load));
            rows.fixed_rows_mut::<3>(half + 3 * i).copy_from(&torque);
        }
    }
    rows
}

/// Minus the derivatives of the residuals.
fn derivatives(postures: &[Posture], frame: Frame, state: &State) -> DMatrix<f64> {
    let half = 3 * postures.len();
    let turning = frame.turn.count();
    let mut rows = DMatrix::zeros(2 * half, NUMBERS + turning);
    let [zero, weight, torque_zero, centre] = state.numbers;
    for (i, posture) in postures.iter().enumerate() {
        let (axes, from_base) = rotations(posture, frame);
        let to_reading = state.turn * axes;
        let load = from_base * weight;
        let mut put = |row: usize, column: usize, block: Matrix3<f64>| {
            rows.fixed_view_mut::<3, 3>(row + 3 * i, column)
                .copy_from(&block);
        };
        put(0, 0, to_reading);
        put(0, 3, to_reading * from_base);
        if posture.torque.is_none() {
            put_turn(&mut rows, frame.turn, 3 * i, &(to_reading * (zero + load)));
            continue;
        }
        put(half, 3, to_reading * centre.cross_matrix() * from_base);
        put(half, 6, to_reading);
        put(half, 9, -to_reading * load.cross_matrix());
        let turned = [
            to_reading * (zero + load),
            to_reading * (torque_zero + centre.cross(&load)),
        ];
        for (row, reading) in [0, half].into_iter().zip(turned) {
            put_turn(&mut rows, frame.turn, row + 3 * i, &reading);
        }
    }
    rows
}

/// Derivatives of a reading by the turn of its axes.
fn put_turn(rows: &mut DMatrix<f64>, turn: Turn, row: usize, reading: &Vector3<f64>) {
    let by_turn = -reading.cross_matrix();
    let first = if turn.count() == 1 { 2 } else { 0 };
    for column in 0..turn.count() {
        let of = by_turn.column(first + column);
        rows.fixed_view_mut::<3, 1>(row, NUMBERS + column)
            .copy_from(&of);
    }
}

/// Weighs each half of the rows.
fn weigh(rows: &mut DMatrix<f64>, scatter: [f64; 2]) {
    let half = rows.nrows() / 2;
    for (part, sigma) in scatter.into_iter().enumerate() {
        rows.rows_mut(part * half, half).scale_mut(1.0 / sigma);
    }
}

/// Fits in axes. None where the postures do not determine the numbers.
#[must_use]
pub fn fit(postures: &[Posture], frame: Frame, nominal: &Nominal) -> Option<Fit> {
    let starts = frame.turn.starts().into_iter();
    let starts = starts.map(|turn| turn * nominal.axes_turn);
    let fits = starts.filter_map(|turn| from(postures, frame, turn, nominal.noise));
    fits.min_by(|a, b| a.cost.total_cmp(&b.cost))
}

/// What scatters are made of.
#[derive(Clone, Copy)]
struct Scale {
    /// Freedom of each kind [1].
    freedom: f64,
    /// Least scatter of a force [N] and a torque [N m].
    least: [f64; 2],
    has_torques: bool,
}

impl Scale {
    fn scatter(&self, left: &DVector<f64>) -> [f64; 2] {
        let half = left.len() / 2;
        [0, 1].map(|kind| match kind == 1 && !self.has_torques {
            true => 1.0,
            false => {
                let squares = left.rows(kind * half, half).norm_squared();
                let own = (squares / self.freedom).sqrt();
                own.max(self.least[kind]).max(1e-9)
            }
        })
    }

    /// -ln of the likelihood [1].
    fn cost(&self, left: &DVector<f64>, scatter: [f64; 2]) -> f64 {
        let half = left.len() / 2;
        let of = |kind: usize| {
            let sigma: f64 = scatter[kind];
            let squares = left.rows(kind * half, half).norm_squared();
            self.freedom * sigma.ln() + 0.5 * squares / (sigma * sigma)
        };
        of(0) + if self.has_torques { of(1) } else { 0.0 }
    }

    /// Normal matrix; numbers that only torques show hold still without them.
    fn normal(&self, slopes: &DMatrix<f64>) -> DMatrix<f64> {
        let mut normal = slopes.tr_mul(slopes);
        if !self.has_torques {
            (NUMBERS / 2..NUMBERS).for_each(|i| normal[(i, i)] += 1.0);
        }
        normal
    }
}

fn from(postures: &[Posture], frame: Frame, turn: Matrix3<f64>, noise: [f64; 2]) -> Option<Fit> {
    let scale = Scale {
        freedom: (3 * postures.len() - NUMBERS / 2) as f64 - 0.5 * frame.turn.count() as f64,
        least: noise,
        has_torques: postures.iter().all(|posture| posture.torque.is_some()),
    };
    let mut state = State {
        turn,
        numbers: [Vector3::zeros(); 4],
    };
    let mut left = residuals(postures, frame, &state);
    let mut scatter = scale.scatter(&left);
    let mut damping = 1e-6;
    let mut last = f64::INFINITY;
    for step in 0..STEPS {
        let mut slopes = derivatives(postures, frame, &state);
        let mut rows = DMatrix::from_column_slice(left.len(), 1, left.as_slice());
        weigh(&mut slopes, scatter);
        weigh(&mut rows, scatter);
        let mut normal = scale.normal(&slopes);
        for i in 0..normal.nrows() {
            normal[(i, i)] += damping * normal[(i, i)] + 1e-12;
        }
        let right = slopes.tr_mul(&rows);
        let change = normal.cholesky()?.solve(&right).column(0).into_owned();
        let next = state.stepped(&change, frame.turn);
        let next_left = residuals(postures, frame, &next);
        let cost = scale.cost(&next_left, scale.scatter(&next_left));
        // Centre and weight are a product: the first step, from no weight, may do worse.
        if step > 1 && cost > last {
            damping = (10.0 * damping).min(1e6);
            if damping > 1e3 {
                break;
            }
            continue;
        }
        damping = (0.1 * damping).max(1e-9);
        (state, left) = (next, next_left);
        scatter = scale.scatter(&left);
        let gained = last - cost;
        last = cost;
        if step > 2 && gained < SMALL * cost.abs().max(1.0) {
            break;
        }
    }
    fitted(postures, frame, &state, &scale)
}

/// The fit at its end.
fn fitted(postures: &[Posture], frame: Frame, state: &State, scale: &Scale) -> Option<Fit> {
    let left = residuals(postures, frame, state);
    let scatter = scale.scatter(&left);
    let mut slopes = derivatives(postures, frame, state);
    weigh(&mut slopes, scatter);
    let half = left.len() / 2;
    let mut rows = DMatrix::from_column_slice(left.len(), 1, left.as_slice());
    weigh(&mut rows, scatter);
    Some(Fit {
        frame,
        turn: state.turn,
        numbers: state.numbers,
        scatter,
        rms: [0, half].map(|at| (left.rows(at, half).norm_squared() / half as f64).sqrt()),
        has_torques: scale.has_torques,
        covariance: scale.normal(&slopes).try_inverse()?,
        slopes,
        left: rows.column(0).into_owned(),
        freedom: scale.freedom,
        cost: scale.cost(&left, scatter),
    })
}
