//! Which deviations from the nominal law a table shows, which it rules out, and which it cannot tell.

use super::fit::{Fit, fit, rms};
use super::law::{Deviation, TableLaw, TableRow};
use crate::stats::{chance_beyond, student_95, student_exceeded};

/// Chance that a table of a nominal law that is right names anything at all.
pub(super) const FALSE_ALARM: f64 = 0.05;
/// Chance that the largest of all rows' scatter has it set aside.
const SET_ASIDE: f64 = 0.01;
/// Share of the rows set aside at most.
const SET_ASIDE_MOST: f64 = 0.1;
/// Relative span of a setting from which an exponent of it is looked for.
const LEAST_SPAN: f64 = 0.02;
/// Relative distance within which rows have one level of a setting.
const LEVEL: f64 = 0.005;
/// Odds by which rows must tell a threshold or a sag from an exponent of the force to be named: the nominal law with another number is the plainer one.
const TELLS: f64 = 10.0;

/// A deviation with its value and interval.
#[derive(Debug, Clone, PartialEq)]
pub struct EffectValue {
    /// Which.
    pub deviation: Deviation,
    /// Value, and the ends of its 95 % interval [SI].
    pub value: [f64; 3],
    /// Probability that it is at work [1].
    pub confidence: f64,
}

/// Another form of the law, fitted.
#[derive(Debug, Clone, PartialEq)]
pub struct Rival {
    /// Its deviations.
    pub deviations: Vec<Deviation>,
    /// Its law.
    pub law: TableLaw,
    /// Odds of it against that found [1].
    pub odds: f64,
    /// Root mean square of the logarithm that it leaves [1].
    pub rms: f64,
}

/// Errors of a law on rows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Left {
    /// Root mean square of the natural logarithm of measured over predicted [1].
    pub log: f64,
    /// Root mean square of measured over predicted less one [1].
    pub share: f64,
    /// Rows.
    pub rows: usize,
    /// Rows of which it predicts that nothing comes off; they are not in the others.
    pub nothing: usize,
}

impl Left {
    /// Of a law on rows.
    #[must_use]
    pub fn of(law: &TableLaw, rows: &[TableRow]) -> Self {
        let ratios: Vec<f64> = rows
            .iter()
            .map(|row| row.volume / law.volume_of(row))
            .collect();
        let finite = || ratios.iter().copied().filter(|ratio| ratio.is_finite());
        Self {
            log: rms(finite().map(f64::ln)),
            share: rms(finite().map(|ratio| ratio - 1.0)),
            rows: finite().count(),
            nothing: ratios.len() - finite().count(),
        }
    }
}

/// Diagnosis of a table.
#[derive(Debug, Clone)]
pub struct RemovalDiagnosis {
    /// The nominal law, its coefficient fitted where it states none.
    pub nominal: TableLaw,
    /// The law with what was found.
    pub found: TableLaw,
    /// Deviations found.
    pub effects: Vec<EffectValue>,
    /// Probability that the volume goes with the force otherwise than nominal, whatever the form [1], and of each form that was looked at.
    pub by_force: (f64, Vec<(Deviation, f64)>),
    /// Deviations that were looked for and are not needed, with the values that they would have beside those found.
    pub not_needed: Vec<EffectValue>,
    /// Deviations that the table cannot tell: a setting that does not vary, or varies with another.
    pub unreported: Vec<Deviation>,
    /// Other forms that explain it nearly as well.
    pub rivals: Vec<Rival>,
    /// Errors before, after, and of an exponent of the force alone.
    pub before: Left,
    /// After.
    pub after: Left,
    /// With each row predicted by a fit to the others, root mean square of the logarithm [1].
    pub left_out: f64,
    /// Rows of the fit.
    pub rows: Vec<TableRow>,
    /// Rows set aside, for they lie further off than chance puts any.
    pub aside: Vec<TableRow>,
    /// Rows left out as a setting of theirs that the law needs is not known, and those where nothing came off.
    pub incomplete: Vec<TableRow>,
}

/// Diagnoses a table; none if it has too few rows to fit the nominal law and judge it.
#[must_use]
pub fn diagnose_table(
    table: &[TableRow],
    nominal: &TableLaw,
    measured_speed: bool,
) -> Option<RemovalDiagnosis> {
    let settings = |row: &TableRow| [row.force, row.time, row.speed, row.area, row.wear];
    // A setting without a column is not known of any row.
    let has: [bool; 5] =
        std::array::from_fn(|i| table.iter().any(|row| settings(row)[i].is_finite()));
    let complete = |row: &&TableRow| {
        row.volume > 0.0
            && settings(row)
                .iter()
                .zip(has)
                .all(|(v, has)| !has || v.is_finite())
    };
    let (mut rows, incomplete): (Vec<TableRow>, Vec<TableRow>) =
        table.iter().cloned().partition(|row| complete(&row));
    let (candidates, mut unreported) = candidates(&rows, nominal, measured_speed);
    let aside = set_aside(&mut rows, nominal, &candidates);
    let models = models(&rows, nominal, &candidates);
    let count = candidates.len().max(1);
    let forms = Forms::of(&models, &rows);
    let least = (0..models.len()).min_by(|a, b| {
        let score = |index: usize| forms.deviance[index] + price(&models[index], count);
        score(*a).total_cmp(&score(*b))
    })?;
    let chosen = forms.plainest(&models, least);
    let best = &models[chosen];
    let start = fit(&rows, nominal, &[])?;
    let evidence: Vec<f64> = (0..models.len())
        .map(|index| forms.criterion(&models, index) - forms.criterion(&models, chosen))
        .collect();
    let whole: f64 = evidence.iter().map(|e| (-0.5 * e).exp()).sum();
    let confidence = |of: Deviation| {
        let with = models
            .iter()
            .zip(&evidence)
            .filter(|(m, _)| m.free.contains(&of));
        (with.map(|(_, e)| (-0.5 * e).exp()).sum::<f64>() / whole).clamp(0.0, 1.0)
    };
    let any = models
        .iter()
        .zip(&evidence)
        .filter(|(m, _)| of_force(m) > 0);
    let any = any.map(|(_, e)| (-0.5 * e).exp()).sum::<f64>() / whole;
    let tried = OF_FORCE.into_iter().filter(|of| candidates.contains(of));
    let by_force = (any.min(1.0), tried.map(|of| (of, confidence(of))).collect());
    let found = |fitted: &Fit, of: Deviation| EffectValue {
        deviation: of,
        value: interval(fitted, of),
        confidence: confidence(of).min(sure_by_levels(&rows, &start.law, fitted, of)),
    };
    let mut not_needed = Vec::new();
    for of in candidates.iter().filter(|of| !best.free.contains(of)) {
        let mut free = best.free.clone();
        free.push(*of);
        match fit(&rows, nominal, &free) {
            Some(fitted) => not_needed.push(found(&fitted, *of)),
            None => unreported.push(*of),
        }
    }
    let mut every = rows.clone();
    every.extend(aside.iter().cloned());
    Some(RemovalDiagnosis {
        nominal: start.law,
        found: best.law,
        effects: best.free.iter().map(|of| found(best, *of)).collect(),
        by_force,
        not_needed,
        unreported,
        rivals: rivals(&models, chosen, &forms),
        before: Left::of(&start.law, &every),
        after: Left::of(&best.law, &every),
        left_out: best.left_out_rms(),
        rows,
        aside,
        incomplete,
    })
}

/// Deviations that rows can tell by themselves, and those that they cannot.
fn candidates(
    rows: &[TableRow],
    nominal: &TableLaw,
    measured_speed: bool,
) -> (Vec<Deviation>, Vec<Deviation>) {
    let spread = |of: &dyn Fn(&TableRow) -> f64| {
        let values = || rows.iter().map(of);
        let (low, high) = (
            values().fold(f64::INFINITY, f64::min),
            values().fold(0.0, f64::max),
        );
        high > 0.0 && (high - low) / high > LEAST_SPAN
    };
    let force = spread(&|row| row.force);
    let looked = |of: &Deviation| match of {
        Deviation::Coefficient => nominal.volume.is_some(),
        // A speed that was measured under load has lost already what it loses.
        Deviation::Sag => force && !measured_speed,
        Deviation::Force | Deviation::Threshold => force,
        Deviation::Wear => spread(&|row| row.wear),
        Deviation::Speed => spread(&|row| row.speed),
        Deviation::Time => spread(&|row| row.time),
        Deviation::Area => spread(&|row| row.area),
    };
    let moot = |of: &Deviation| match of {
        Deviation::Coefficient => nominal.volume.is_none(),
        Deviation::Sag => measured_speed,
        _ => false,
    };
    let (found, others): (Vec<_>, Vec<_>) = Deviation::ALL.into_iter().partition(looked);
    (found, others.into_iter().filter(|of| !moot(of)).collect())
}

/// Takes out rows that lie further from all that the law may be than chance puts any of so many.
fn set_aside(
    rows: &mut Vec<TableRow>,
    nominal: &TableLaw,
    candidates: &[Deviation],
) -> Vec<TableRow> {
    let curved = [Deviation::Threshold, Deviation::Sag];
    let free: Vec<Deviation> = candidates
        .iter()
        .copied()
        .filter(|of| !curved.contains(of))
        .collect();
    let most = (SET_ASIDE_MOST * rows.len() as f64) as usize;
    let mut aside = Vec::new();
    while aside.len() < most {
        let Some(fitted) = fit(rows, nominal, &free).filter(|f| f.freedom() > 3) else {
            break;
        };
        let (freedom, squares) = (fitted.freedom() as f64, fitted.squares);
        let size = |index: usize| {
            let own = rows[index].weight * fitted.residuals[index].powi(2)
                / (1.0 - fitted.leverage[index]).max(1e-9);
            // Over the scatter of the others.
            (own * (freedom - 1.0) / (squares - own).max(1e-12 * squares)).sqrt()
        };
        let Some(worst) = (0..rows.len()).max_by(|a, b| size(*a).total_cmp(&size(*b))) else {
            break;
        };
        let limit = student_exceeded(
            SET_ASIDE / (2.0 * rows.len() as f64),
            (fitted.freedom() - 1) as f64,
        );
        if size(worst) <= limit {
            break;
        }
        aside.push(rows.remove(worst));
    }
    aside
}

/// Every set of deviations fitted: forms of the force's law times all others.
fn models(rows: &[TableRow], nominal: &TableLaw, candidates: &[Deviation]) -> Vec<Fit> {
    use Deviation::{Force, Sag, Threshold};
    // A threshold beside a sag can hardly be distinguished from an exponent in any table.
    let forms: [&[Deviation]; 5] = [&[], &[Force], &[Threshold], &[Sag], &[Force, Threshold]];
    let of_force = [Force, Threshold, Sag];
    let others: Vec<Deviation> = candidates
        .iter()
        .copied()
        .filter(|of| !of_force.contains(of))
        .collect();
    let mut fits = Vec::new();
    for form in forms
        .iter()
        .filter(|form| form.iter().all(|of| candidates.contains(of)))
    {
        for chosen in 0..1_usize << others.len() {
            let with = others
                .iter()
                .enumerate()
                .filter(|(bit, _)| chosen >> bit & 1 == 1);
            let free: Vec<Deviation> = form
                .iter()
                .copied()
                .chain(with.map(|(_, of)| *of))
                .collect();
            fits.extend(fit(rows, nominal, &free).filter(possible));
        }
    }
    fits
}

/// Whether a fit is one of physics: a tool that wears does not take off more.
fn possible(fitted: &Fit) -> bool {
    let law = &fitted.law;
    let is_free = |of: Deviation| fitted.free.contains(&of);
    (!is_free(Deviation::Wear) || law.wear >= 0.0)
        && (!is_free(Deviation::Threshold) || law.threshold > 0.0)
        && (!is_free(Deviation::Sag) || law.sag > 0.0)
}

/// Levels of a setting in rows.
fn levels(rows: &[TableRow], of: impl Fn(&TableRow) -> f64) -> usize {
    let mut values: Vec<f64> = rows.iter().map(of).collect();
    values.sort_by(f64::total_cmp);
    let (mut count, mut last) = (0, f64::NEG_INFINITY);
    for value in values {
        if value > last + LEVEL * last.abs() || count == 0 {
            count += 1;
            last = value;
        }
    }
    count
}

/// -2 ln of the likelihood of each model, in which forms of the force's law are held apart by as many measurements as there are levels of the force:
/// rows at one level all say the same of what happens between two.
struct Forms {
    deviance: Vec<f64>,
}

/// Deviations that are forms of the force's law.
const OF_FORCE: [Deviation; 3] = [Deviation::Force, Deviation::Threshold, Deviation::Sag];

fn of_force(fitted: &Fit) -> usize {
    fitted
        .free
        .iter()
        .filter(|of| OF_FORCE.contains(of))
        .count()
}

/// Whether two models have the same deviations but for the form of the force's law.
fn alike(one: &Fit, other: &Fit) -> bool {
    let others = |m: &Fit| -> Vec<Deviation> {
        let free = m.free.iter().copied();
        free.filter(|of| !OF_FORCE.contains(of)).collect()
    };
    others(one) == others(other)
}

impl Forms {
    fn of(models: &[Fit], rows: &[TableRow]) -> Self {
        let levels = levels(rows, |row| row.force) as f64;
        let of = |m: &Fit| {
            let own = m.deviance();
            let single = models
                .iter()
                .filter(|other| of_force(other) == 1 && alike(other, m));
            let least = single.map(Fit::deviance).fold(f64::INFINITY, f64::min);
            match of_force(m) > 0 && least.is_finite() {
                true => least + (own - least) * (levels / m.measurements).min(1.0),
                false => own,
            }
        };
        Self {
            deviance: models.iter().map(of).collect(),
        }
    }

    /// Bayesian information criterion of a model.
    fn criterion(&self, models: &[Fit], index: usize) -> f64 {
        let fitted = &models[index];
        self.deviance[index] + fitted.numbers as f64 * fitted.measurements.ln()
    }

    /// A model, or the one with an exponent in the place of its threshold or sag where the rows do not tell the two apart.
    fn plainest(&self, models: &[Fit], index: usize) -> usize {
        let own = &models[index];
        let plainer = (0..models.len()).find(|other| {
            let free = &models[*other].free;
            of_force(&models[*other]) == 1
                && free.contains(&Deviation::Force)
                && alike(&models[*other], own)
        });
        let open = |other: &usize| {
            let behind = self.criterion(models, *other) - self.criterion(models, index);
            behind < 2.0 * TELLS.ln()
        };
        match of_force(own) {
            0 => index,
            _ => plainer.filter(open).unwrap_or(index),
        }
    }
}

/// Most that levels of a setting can say for its exponent: with so few the scatter from level to level is known as badly (degrees of freedom of clustered
/// errors: Cameron and Miller, J. Human Resources 50, 2015).
fn sure_by_levels(rows: &[TableRow], nominal: &TableLaw, fitted: &Fit, of: Deviation) -> f64 {
    let setting = |row: &TableRow| match of {
        Deviation::Force => row.force,
        Deviation::Speed => row.speed,
        Deviation::Time => row.time,
        _ => row.area,
    };
    let exponent = matches!(
        of,
        Deviation::Force | Deviation::Speed | Deviation::Time | Deviation::Area
    );
    let place = fitted.free.iter().position(|free| *free == of);
    let Some(error) = place.map(|place| fitted.errors[place]).filter(|_| exponent) else {
        return 1.0;
    };
    let freedom = levels(rows, setting)
        .saturating_sub(1)
        .min(fitted.freedom())
        .max(1);
    let off = (fitted.law.number(of) - nominal.number(of)) / error.max(f64::MIN_POSITIVE);
    1.0 - chance_beyond(off, freedom as f64)
}

/// What each further number must better a fit by to be named: as much as chance does in one table of twenty, shared among the candidates.
fn price(fitted: &Fit, candidates: usize) -> f64 {
    let rows = fitted.measurements;
    let hidden = fitted.numbers - fitted.free.len();
    (1..=fitted.free.len())
        .map(|number| {
            let freedom = (rows as usize).saturating_sub(hidden + number).max(1);
            let t = student_exceeded(FALSE_ALARM / (2.0 * candidates as f64), freedom as f64);
            rows * (t * t / freedom as f64).ln_1p()
        })
        .sum()
}

/// Value and 95 % interval by Student's t with robust errors [SI].
fn interval(fitted: &Fit, of: Deviation) -> [f64; 3] {
    let value = fitted.law.number(of);
    let place = fitted.free.iter().position(|free| *free == of);
    let error = place.map_or(0.0, |place| fitted.errors[place]);
    let reach = student_95(fitted.freedom() as f64) * error;
    match of {
        Deviation::Coefficient => [value, value * (-reach).exp(), value * reach.exp()],
        Deviation::Threshold | Deviation::Sag => [value, (value - reach).max(0.0), value + reach],
        _ => [value, value - reach, value + reach],
    }
}

/// Forms of other deviations, as many or fewer and one more at most, that stay within odds of 1 to 1000.
fn rivals(models: &[Fit], chosen: usize, forms: &Forms) -> Vec<Rival> {
    let best = &models[chosen];
    let holds = |whole: &Fit, part: &Fit| part.free.iter().all(|of| whole.free.contains(of));
    // Less would be a form without an effect that was found, more one with what is not needed: neither is a rival.
    let mut rivals: Vec<Rival> = models
        .iter()
        .enumerate()
        .filter(|(_, m)| m.numbers <= best.numbers && !holds(m, best) && !holds(best, m))
        .map(|(index, m)| Rival {
            deviations: m.free.clone(),
            law: m.law,
            odds: (0.5 * (forms.criterion(models, chosen) - forms.criterion(models, index))).exp(),
            rms: m.rms(),
        })
        .filter(|rival| rival.odds > 1e-3)
        .collect();
    rivals.sort_by(|a, b| b.odds.total_cmp(&a.odds));
    rivals.truncate(4);
    rivals
}
