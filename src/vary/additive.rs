//! A sum of one curve a variable fitted to a number of all runs, so that what the other variables do to it can be taken away before one of them is looked at.
//!
//! Each run is predicted by the fit to the others (leave one out), so that the fit cannot take a run's own scatter with it; the curves are Legendre polynomials
//! of the variable's rank, as steep as leave-one-out errors warrant, of names a constant each.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};

/// Degrees that are tried, up to a parameter for each four runs.
const DEGREES: [usize; 6] = [1, 2, 3, 4, 6, 8];
const RUNS_OF_EACH: usize = 4;
/// Runs that are fitted to at most, every so many of all: beyond, chance is too small to be taken away.
const FITTED: usize = 2000;
/// Of a parameter's information [1], so that variables that go together are parted at all.
const RIDGE: f64 = 1e-9;
/// Least of a run's own weight that is left beside the fit.
const FREE: f64 = 1e-6;

/// A variable's values, one a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Varied<'a> {
    /// The values; of names their order.
    pub values: &'a [f64],
    /// Whether they are names, of which none is larger than another.
    pub names: bool,
}

/// A number of each run, parted.
pub(super) struct Parted {
    /// By variable: the number less what the other variables do.
    pub without_others: Vec<Vec<f64>>,
    /// The number less what all variables do.
    pub rest: Vec<f64>,
}

/// The number `y` of each run parted by variable; the whole of it where no fit predicts better than the mean.
pub(super) fn parted(variables: &[Varied<'_>], y: &[f64]) -> Parted {
    let each = y.len().div_ceil(FITTED).max(1);
    let fitted: Vec<usize> = (0..y.len()).step_by(each).collect();
    let count = fitted.len() as f64;
    let mean = fitted.iter().map(|run| y[*run]).sum::<f64>() / count;
    let of_mean = |run: &usize| ((y[*run] - mean) * count / (count - 1.0)).powi(2);
    let mut least: f64 = fitted.iter().map(of_mean).sum();
    let mut best = None;
    for degree in DEGREES {
        let basis = Basis::new(variables, degree);
        if basis.width * RUNS_OF_EACH > fitted.len() {
            break;
        }
        if let Some(fit) = Fit::new(&basis, &fitted, y)
            && fit.error < least
        {
            least = fit.error;
            best = Some((basis, fit));
        }
    }
    match best {
        Some((basis, fit)) => fit.part(&basis, each, y),
        None => Parted {
            without_others: vec![y.to_vec(); variables.len()],
            rest: y.to_vec(),
        },
    }
}

/// The columns of a fit: a constant, then those of each variable.
struct Basis {
    /// Of each variable, its ranks from -1 to 1, or of names the place of each run's.
    places: Vec<Vec<f64>>,
    /// Number of columns of each variable, and whether they are names.
    own: Vec<(usize, bool)>,
    /// Number of all columns.
    width: usize,
}

impl Basis {
    fn new(variables: &[Varied<'_>], degree: usize) -> Self {
        let mut places = Vec::new();
        let mut own = Vec::new();
        for variable in variables {
            let (ranks, different) = ranks(variable.values);
            own.push(match variable.names {
                true => (different.len() - 1, true),
                false => (degree.min(different.len() - 1), false),
            });
            places.push(match variable.names {
                true => (variable.values.iter())
                    .map(|value| different[&value.to_bits()] as f64)
                    .collect(),
                false => ranks,
            });
        }
        let width = 1 + own.iter().map(|(columns, _)| columns).sum::<usize>();
        Self { places, own, width }
    }

    fn row(&self, run: usize, row: &mut [f64]) {
        row[0] = 1.0;
        let mut first = 1;
        for (places, (columns, names)) in self.places.iter().zip(&self.own) {
            let (at, own) = (places[run], &mut row[first..first + columns]);
            if *names {
                for (place, column) in own.iter_mut().enumerate() {
                    *column = f64::from(u8::from(at == (place + 1) as f64));
                }
            } else {
                let mut before = [1.0, at];
                for (degree, column) in (1..).zip(own.iter_mut()) {
                    *column = before[1];
                    let degree = f64::from(degree);
                    let next = (2.0 * degree + 1.0) * at * before[1] - degree * before[0];
                    before = [before[1], next / (degree + 1.0)];
                }
            }
            first += columns;
        }
    }
}

/// Ranks of values from -1 to 1, those of equal ones their mean, and the place of each different value.
fn ranks(values: &[f64]) -> (Vec<f64>, BTreeMap<u64, usize>) {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
    let mut ranks = vec![0.0; values.len()];
    let mut different = BTreeMap::new();
    let mut before = 0;
    for equal in order.chunk_by(|a, b| values[*a] == values[*b]) {
        let middle = before as f64 + 0.5 * equal.len() as f64;
        for run in equal {
            ranks[*run] = 2.0 * middle / values.len() as f64 - 1.0;
        }
        different.insert(values[equal[0]].to_bits(), different.len());
        before += equal.len();
    }
    (ranks, different)
}

/// A least-squares fit with what each of its runs is without itself.
struct Fit {
    coefficients: DVector<f64>,
    /// By fitted run: what its own weight adds to the coefficients.
    own: DMatrix<f64>,
    /// Sum of squares of the leave-one-out errors.
    error: f64,
}

impl Fit {
    fn new(basis: &Basis, runs: &[usize], y: &[f64]) -> Option<Self> {
        let mut rows = DMatrix::zeros(basis.width, runs.len());
        for (place, run) in runs.iter().enumerate() {
            basis.row(*run, rows.column_mut(place).as_mut_slice());
        }
        let known = DVector::from_iterator(runs.len(), runs.iter().map(|run| y[*run]));
        let mut normal = &rows * rows.transpose();
        for place in 0..basis.width {
            normal[(place, place)] += RIDGE * runs.len() as f64;
        }
        let inverse = normal.cholesky()?.inverse();
        let coefficients = &inverse * (&rows * &known);
        let mut own = inverse * &rows;
        let mut error = 0.0;
        for place in 0..runs.len() {
            let row = rows.column(place);
            let free = 1.0 - row.dot(&own.column(place));
            if free < FREE {
                return None;
            }
            let left_out = (known[place] - row.dot(&coefficients)) / free;
            error += left_out * left_out;
            own.column_mut(place).scale_mut(left_out);
        }
        Some(Self {
            coefficients,
            own,
            error,
        })
    }

    /// Runs at every so many were fitted to.
    fn part(&self, basis: &Basis, each: usize, y: &[f64]) -> Parted {
        let mut row = vec![0.0; basis.width];
        let mut without_others = vec![Vec::with_capacity(y.len()); basis.own.len()];
        let mut rest = Vec::with_capacity(y.len());
        let mut does = vec![0.0; basis.own.len()];
        for (run, value) in y.iter().enumerate() {
            basis.row(run, &mut row);
            let own = run
                .is_multiple_of(each)
                .then(|| self.own.column(run / each));
            let part = |column: usize| {
                let own = own.map_or(0.0, |own| own[column]);
                row[column] * (self.coefficients[column] - own)
            };
            let mut first = 1;
            for (does, (columns, _)) in does.iter_mut().zip(&basis.own) {
                *does = (first..first + columns).map(part).sum();
                first += columns;
            }
            let left = value - part(0) - does.iter().sum::<f64>();
            rest.push(left);
            for (without, does) in without_others.iter_mut().zip(&does) {
                without.push(left + does);
            }
        }
        Parted {
            without_others,
            rest,
        }
    }
}
