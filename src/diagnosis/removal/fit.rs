//! Least squares of the logarithm with some of the law's numbers free: linear in all but the threshold and the sag, which are searched for along a line each.

use nalgebra::{DMatrix, DVector};

use super::law::{Deviation, TableLaw, TableRow};

/// Candidates along the line of the threshold or the sag, before the best is refined.
const LINE: usize = 48;
/// Residuals below this are those of the numbers' digits.
const FLOOR: f64 = 1e-6;

/// A law fitted.
#[derive(Debug, Clone)]
pub(super) struct Fit {
    /// Free numbers, the coefficient not among them where the nominal law states none.
    pub free: Vec<Deviation>,
    /// The law with its numbers.
    pub law: TableLaw,
    /// Measured less predicted logarithm of each row.
    pub residuals: Vec<f64>,
    /// Sum of the weights: so many measurements the rows are worth [1].
    pub measurements: f64,
    /// Weighted sum of squares.
    pub squares: f64,
    /// The same of the scatter that is known of the rows.
    pub known: f64,
    /// Numbers fitted.
    pub numbers: usize,
    /// Standard error of each free number, robust against scatter that differs between rows (HC3).
    pub errors: Vec<f64>,
    /// Leverage of each row [1].
    pub leverage: Vec<f64>,
}

impl Fit {
    /// Root mean square of what it leaves of the logarithm.
    pub fn rms(&self) -> f64 {
        rms(self.residuals.iter().copied())
    }

    /// The same of each row predicted by a fit to the others.
    pub fn left_out_rms(&self) -> f64 {
        let pairs = self.residuals.iter().zip(&self.leverage);
        rms(pairs.map(|(r, h)| r / (1.0 - h).max(1e-9)))
    }

    /// -2 ln of the likelihood but for a constant, the variance no less than that which is known.
    pub fn deviance(&self) -> f64 {
        let squares = self.squares.max(self.known);
        self.measurements * (squares.ln() + self.squares / squares)
    }

    /// Degrees of freedom left.
    pub fn freedom(&self) -> usize {
        self.residuals.len() - self.numbers
    }
}

/// Root mean square.
pub(super) fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (count, sum) = values.fold((0.0, 0.0), |(n, sum), v| (n + 1.0, sum + v * v));
    if count > 0.0 {
        f64::sqrt(sum / count)
    } else {
        f64::NAN
    }
}

/// Fits; none where rows are too few for the numbers or do not tell them apart.
pub(super) fn fit(rows: &[TableRow], nominal: &TableLaw, free: &[Deviation]) -> Option<Fit> {
    let lines = [Deviation::Threshold, Deviation::Sag];
    let searched: Vec<Deviation> = lines.into_iter().filter(|d| free.contains(d)).collect();
    let law = along(rows, *nominal, free, &searched)?;
    let inner = linear(rows, &law, free)?;
    finish(rows, nominal, free, inner.0)
}

/// Searches the threshold, the sag, or neither, each for the best of those behind it.
fn along(
    rows: &[TableRow],
    law: TableLaw,
    free: &[Deviation],
    searched: &[Deviation],
) -> Option<TableLaw> {
    let Some((first, others)) = searched.split_first() else {
        return Some(linear(rows, &law, free)?.0);
    };
    let forces = || rows.iter().map(|row| row.force);
    let most = match first {
        Deviation::Threshold => 0.995 * forces().fold(law.reference.force, f64::min),
        _ => 0.98 / forces().fold(law.reference.force, f64::max),
    };
    let at = |share: f64| {
        let law = along(rows, law.with(*first, share * most), free, others)?;
        Some((linear(rows, &law, free)?.1, law))
    };
    let grid = (0..=LINE).filter_map(|i| Some((i, at(i as f64 / LINE as f64)?.0)));
    let (best, _) = grid.min_by(|(_, a), (_, b)| a.total_cmp(b))?;
    let share = |i: usize| i.min(LINE) as f64 / LINE as f64;
    let (mut low, mut high) = (share(best.saturating_sub(1)), share(best + 1));
    // Golden section between the neighbours of the best.
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    for _ in 0..32 {
        let [left, right] = [high - golden * (high - low), low + golden * (high - low)];
        let squares = |share| at(share).map_or(f64::INFINITY, |(squares, _)| squares);
        if squares(left) <= squares(right) {
            high = right;
        } else {
            low = left;
        }
    }
    // The end of the line is taken as it is.
    let middle = at(f64::midpoint(low, high))?;
    Some(match at(0.0) {
        Some(zero) if zero.0 <= middle.0 => zero.1,
        _ => middle.1,
    })
}

/// The numbers that are linear, with threshold and sag as they are; the sum of squares besides.
fn linear(rows: &[TableRow], law: &TableLaw, free: &[Deviation]) -> Option<(TableLaw, f64)> {
    let constant = law.volume.is_none() || free.contains(&Deviation::Coefficient);
    let columns: Vec<Deviation> = [
        Deviation::Force,
        Deviation::Speed,
        Deviation::Time,
        Deviation::Area,
        Deviation::Wear,
    ]
    .into_iter()
    .filter(|d| free.contains(d))
    .collect();
    let mut fixed = *law;
    for column in &columns {
        fixed = fixed.with(*column, 0.0);
    }
    let width = columns.len() + usize::from(constant);
    if rows.len() <= width {
        return None;
    }
    let stated = if constant {
        1.0
    } else {
        law.volume.unwrap_or(1.0)
    };
    let root: Vec<f64> = rows.iter().map(|row| row.weight.sqrt()).collect();
    let target = DVector::from_iterator(
        rows.len(),
        (rows.iter().zip(&root))
            .map(|(row, root)| root * ((row.volume / stated).ln() - fixed.log_ratio(row))),
    );
    if width == 0 {
        return Some((fixed, target.norm_squared()));
    }
    let matrix = DMatrix::from_fn(rows.len(), width, |row, column| {
        let value = match columns.get(column) {
            None => 1.0,
            Some(of) => slope(law, *of, &rows[row]),
        };
        root[row] * value
    });
    let scale: Vec<f64> = matrix.column_iter().map(|c| c.norm()).collect();
    if scale.iter().any(|s| !(s.is_finite() && *s > 0.0)) {
        return None;
    }
    let scaled = DMatrix::from_fn(rows.len(), width, |r, c| matrix[(r, c)] / scale[c]);
    let svd = scaled.clone().svd(true, true);
    if svd.singular_values.min() < 1e-5 * svd.singular_values.max() {
        return None;
    }
    let solution = svd.solve(&target, 0.0).ok()?;
    let squares = (target - scaled * &solution).norm_squared();
    let mut fitted = fixed;
    for (column, of) in columns.iter().enumerate() {
        fitted = fitted.with(*of, solution[column] / scale[column]);
    }
    if constant {
        fitted.volume = Some((solution[width - 1] / scale[width - 1]).exp());
    }
    Some((fitted, squares))
}

/// Derivative of the logarithm by a number.
fn slope(law: &TableLaw, of: Deviation, row: &TableRow) -> f64 {
    let [force, speed, time, area, wear] = law.terms(row);
    let at = law.reference.force;
    match of {
        Deviation::Coefficient => 1.0,
        Deviation::Force => force,
        Deviation::Speed => speed,
        Deviation::Time => time,
        Deviation::Area => area,
        Deviation::Wear => -wear,
        Deviation::Threshold => {
            let by = |force: f64| 1.0 / (force - law.threshold);
            law.force * (by(at) - by(row.force))
        }
        Deviation::Sag => {
            let by = |force: f64| force / (1.0 - law.sag * force);
            law.speed * (by(at) - by(row.force))
        }
    }
}

/// Residuals, leverages and standard errors of a fit.
fn finish(rows: &[TableRow], nominal: &TableLaw, free: &[Deviation], law: TableLaw) -> Option<Fit> {
    let volume = law.volume?;
    let residuals: Vec<f64> = rows
        .iter()
        .map(|row| (row.volume / volume).ln() - law.log_ratio(row))
        .collect();
    let hidden = nominal.volume.is_none() && !free.contains(&Deviation::Coefficient);
    let numbers = free.len() + usize::from(hidden);
    if rows.len() <= numbers || residuals.iter().any(|r| !r.is_finite()) {
        return None;
    }
    let weighted = residuals
        .iter()
        .zip(rows)
        .map(|(r, row)| row.weight * r * r);
    let squares = weighted.sum::<f64>().max(rows.len() as f64 * FLOOR * FLOOR);
    let mut fit = Fit {
        free: free.to_vec(),
        law,
        residuals,
        measurements: rows.iter().map(|row| row.weight).sum(),
        squares,
        known: rows
            .iter()
            .map(|row| row.weight * row.scatter * row.scatter)
            .sum(),
        numbers,
        errors: Vec::new(),
        leverage: vec![0.0; rows.len()],
    };
    if numbers == 0 {
        return Some(fit);
    }
    let jacobian = DMatrix::from_fn(rows.len(), numbers, |row, column| {
        let of = free.get(column).copied().unwrap_or(Deviation::Coefficient);
        rows[row].weight.sqrt() * slope(&law, of, &rows[row])
    });
    let scale: Vec<f64> = jacobian.column_iter().map(|c| c.norm()).collect();
    let scaled = DMatrix::from_fn(rows.len(), numbers, |r, c| jacobian[(r, c)] / scale[c]);
    let inverse = (scaled.transpose() * &scaled).try_inverse()?;
    let spread = &scaled * &inverse;
    let mut meat = DMatrix::zeros(numbers, numbers);
    for (row, of) in rows.iter().enumerate() {
        let leverage = scaled.row(row).dot(&spread.row(row)).clamp(0.0, 1.0 - 1e-9);
        fit.leverage[row] = leverage;
        let left = (fit.residuals[row] / (1.0 - leverage))
            .abs()
            .max(of.scatter);
        let residual = of.weight.sqrt() * left;
        meat += scaled.row(row).transpose() * scaled.row(row) * residual * residual;
    }
    let covariance = &inverse * meat * &inverse;
    fit.errors = (0..free.len())
        .map(|c| covariance[(c, c)].max(0.0).sqrt() / scale[c])
        .collect();
    fit.errors.iter().all(|e| e.is_finite()).then_some(fit)
}
