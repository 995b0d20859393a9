//! A table of runs as a case: what a tool took off at which settings, against the nominal law.

use std::path::{Path, PathBuf};
use std::time::Instant;

use super::error::CaseError;
use super::rig::RIG;
use crate::diagnosis::answer::Answer;
use crate::diagnosis::removal::answer::{AnswerContext, answer};
use crate::diagnosis::removal::{
    Deviation, Left, Reference, RemovalDiagnosis, TableLaw, TableRow, diagnose_table,
};
use crate::recording::csv::read_named;
use crate::recording::long_column::LongColumn;
use crate::recording::provenance::Provenance;
use crate::scenario::removal_table::{RemovalTableFile, TableColumn, load_removal_table};

/// Columns of a prediction.
const COLUMNS: [&str; 4] = ["table", "line", "removed_mm3", "predicted_mm3"];
/// Cubic millimetres in a cubic metre.
const MM3: f64 = 1e9;
/// Fewest rows to judge a law by: a few more than it has numbers.
const LEAST_ROWS: usize = 5;

/// File and tables, read and checked.
pub struct RemovalCase {
    /// Name of the folder.
    pub name: String,
    /// The file.
    pub file: RemovalTableFile,
    /// The nominal law.
    pub nominal: TableLaw,
    /// Rows to fit.
    pub rows: Vec<TableRow>,
    /// Rows to predict.
    pub unseen: Vec<TableRow>,
}

/// Result of a diagnosis, with the files that it comes to.
pub struct RemovalDiagnosed {
    /// The finding.
    pub answer: Answer,
    /// What it rests on.
    pub diagnosis: RemovalDiagnosis,
    /// The improved law as a file.
    pub improved: String,
    /// Its prediction of the rows kept back.
    pub prediction: Option<String>,
}

impl RemovalCase {
    /// Reads the folder of a case.
    ///
    /// # Errors
    /// What is wrong with file or tables.
    pub fn from_folder(folder: &Path) -> Result<Self, CaseError> {
        let whole = folder.canonicalize();
        let whole = whole.as_deref().unwrap_or(folder);
        let name = whole.file_name().unwrap_or_default().display().to_string();
        let case = Self::from_file(&folder.join(RIG), name)?;
        let usable = case.rows.iter().filter(|row| row.volume > 0.0).count();
        if usable < LEAST_ROWS {
            return Err(case.few(usable));
        }
        Ok(case)
    }

    /// Reads a file and its tables.
    ///
    /// # Errors
    /// What is wrong with them.
    pub fn from_file(path: &Path, name: String) -> Result<Self, CaseError> {
        let file = load_removal_table(path)?;
        let (mut rows, mut unseen) = (Vec::new(), Vec::new());
        for table in &file.fit {
            let (read, kept) = rows_of(&file, table)?;
            rows.extend(read);
            unseen.extend(kept);
        }
        for table in &file.predict {
            let (read, kept) = rows_of(&file, table)?;
            unseen.extend(read.into_iter().chain(kept));
        }
        let nominal = law_of(&file, &rows);
        for row in &rows {
            if row.volume > 0.0
                && !nominal.log_ratio(row).is_finite()
                && row.area.is_finite() == file.area.is_some()
            {
                return Err(CaseError::Row {
                    file: row.table.clone(),
                    line: row.line,
                    column: file.force.name.clone(),
                    value: row.force / file.force.factor,
                    expected: "a force beyond the nominal threshold, as something was taken off",
                });
            }
        }
        Ok(Self {
            name,
            file,
            nominal,
            rows,
            unseen,
        })
    }

    fn few(&self, rows: usize) -> CaseError {
        CaseError::FewRows {
            file: self.file.path.display().to_string(),
            rows,
            least: LEAST_ROWS,
        }
    }

    /// Diagnoses it.
    ///
    /// # Errors
    /// Too few rows with every setting known, a source that cannot be read again.
    pub fn diagnose(&self) -> Result<RemovalDiagnosed, CaseError> {
        let start = Instant::now();
        let diagnosis = diagnose_table(&self.rows, &self.nominal, self.file.speed_under_load)
            .ok_or_else(|| self.few(self.rows.iter().filter(|row| row.volume > 0.0).count()))?;
        let context = AnswerContext {
            case: &self.name,
            is_feed: self.file.is_feed,
            rows_of_model: self.rows.iter().filter(|row| row.weight < 1.0).count(),
            unseen: &self.unseen,
        };
        let mut answer = answer(&diagnosis, &context, start.elapsed().as_secs_f64());
        answer.details.provenance = self.provenance()?;
        Ok(RemovalDiagnosed {
            answer,
            improved: improved(&self.file, &diagnosis),
            prediction: (!self.unseen.is_empty())
                .then(|| predicted(&diagnosis.found, &self.unseen)),
            diagnosis,
        })
    }

    /// The files that it is made of, as they stand now.
    ///
    /// # Errors
    /// One that is gone.
    pub fn provenance(&self) -> Result<Provenance, CaseError> {
        let folder = self.file.path.parent().unwrap_or(Path::new("")).to_owned();
        let tables = self.file.fit.iter().chain(&self.file.predict);
        let mut sources: Vec<(String, PathBuf)> = tables
            .map(|t| (t.display().to_string(), folder.join(t)))
            .collect();
        sources.insert(0, (RIG.to_owned(), self.file.path.clone()));
        let named = sources
            .iter()
            .map(|(name, path)| (name.as_str(), path.as_path()));
        Ok(Provenance::of(named, None)?)
    }
}

/// What the law of a file predicts of the rows of a table.
pub struct TablePrediction {
    /// As comma-separated values.
    pub csv: String,
    /// The same as columns.
    pub columns: Vec<(String, LongColumn)>,
    /// How far it is from what was measured.
    pub left: Left,
}

/// Predicts the rows of a table by the law of a file.
///
/// # Errors
/// A file or table that cannot be read, a law without its coefficient.
pub fn predict_table(path: &Path, table: &Path) -> Result<TablePrediction, CaseError> {
    let file = load_removal_table(path)?;
    let whole = table.canonicalize().unwrap_or_else(|_| table.to_owned());
    let (mut rows, kept) = rows_of(&file, &whole)?;
    rows.extend(kept);
    let law = law_of(&file, &rows);
    if law.volume.is_none() {
        return Err(CaseError::NoCoefficient {
            file: path.display().to_string(),
        });
    }
    let names = rows.iter().map(|row| row.table.clone()).collect();
    let numbers =
        |of: &dyn Fn(&TableRow) -> f64| LongColumn::Numbers(rows.iter().map(of).collect());
    let columns = [
        LongColumn::Names(names),
        numbers(&|row| row.line as f64),
        numbers(&|row| row.volume * MM3),
        numbers(&|row| law.volume_of(row) * MM3),
    ];
    Ok(TablePrediction {
        csv: predicted(&law, &rows),
        columns: COLUMNS
            .map(str::to_owned)
            .into_iter()
            .zip(columns)
            .collect(),
        left: Left::of(&law, &rows),
    })
}

/// Rows of a table to fit, and those that are kept back.
fn rows_of(
    file: &RemovalTableFile,
    table: &Path,
) -> Result<(Vec<TableRow>, Vec<TableRow>), CaseError> {
    let folder = file.path.parent().unwrap_or(Path::new(""));
    let settings = [
        Some(&file.force),
        file.time.as_ref(),
        file.speed.as_ref(),
        file.area.as_ref(),
        file.wear.as_ref(),
        Some(&file.volume),
    ];
    let mut names: Vec<&str> = settings.iter().flatten().map(|c| c.name.as_str()).collect();
    names.extend(file.weight.iter().map(|(name, _)| name.as_str()));
    names.extend(file.hold_back.iter().map(|held| held.column.as_str()));
    let read = read_named(&folder.join(table), &names)?;
    let (mut fit, mut kept, mut worn) = (Vec::new(), Vec::new(), 0.0);
    for (index, line) in read.lines.iter().enumerate() {
        let mut columns = read.columns.iter().map(|values| values[index]);
        let mut next = || columns.next().unwrap_or(f64::NAN);
        let mut values = [f64::NAN; 6];
        for (place, column) in settings.iter().enumerate() {
            if let Some(column) = column {
                let written = next();
                check(table, *line, (column, place), written)?;
                values[place] = written * column.factor;
            }
        }
        let [force, time, speed, area, wear, volume] = values;
        let time = if file.is_feed { 1.0 / time } else { time };
        let weight = match &file.weight {
            Some((_, weight)) if next() == 0.0 => *weight,
            _ => 1.0,
        };
        let held = file.hold_back.as_ref().is_some_and(|held| {
            let value = next();
            held.from <= value && value <= held.to
        });
        let row = TableRow {
            table: table.display().to_string(),
            line: *line,
            force,
            time,
            speed,
            area,
            wear: if file.cumulate_wear { worn } else { wear },
            volume,
            weight,
            scatter: file.scatter,
        };
        worn += force * time * if speed.is_finite() { speed } else { 1.0 };
        if held { kept.push(row) } else { fit.push(row) }
    }
    Ok((fit, kept))
}

/// Refuses what a setting or a volume cannot be; one that is empty is not known.
fn check(
    table: &Path,
    line: u64,
    (column, place): (&TableColumn, usize),
    value: f64,
) -> Result<(), CaseError> {
    // Wear and volume may be nothing.
    let least_is_zero = place >= 4;
    let wrong = if least_is_zero {
        value < 0.0
    } else {
        value <= 0.0
    };
    // Without force or volume a row says nothing.
    let absent = value.is_nan() && (place == 0 || place == 5);
    if !wrong && !absent {
        return Ok(());
    }
    Err(CaseError::Row {
        file: table.display().to_string(),
        line,
        column: column.name.clone(),
        value,
        expected: if least_is_zero {
            "0 or more"
        } else {
            "a number above 0"
        },
    })
}

/// The nominal law, its reference the mean of the rows' logarithms where the file states none.
fn law_of(file: &RemovalTableFile, rows: &[TableRow]) -> TableLaw {
    let mean = |of: fn(&TableRow) -> f64| {
        let logs: Vec<f64> = rows
            .iter()
            .map(|row| of(row).ln())
            .filter(|l| l.is_finite())
            .collect();
        (logs.iter().sum::<f64>() / logs.len() as f64).exp()
    };
    let nominal = &file.nominal;
    let [force, time, speed, area] = nominal.exponents;
    TableLaw {
        volume: nominal.volume,
        reference: Reference {
            force: nominal.force.unwrap_or_else(|| mean(|row| row.force)),
            time: nominal.time.unwrap_or_else(|| mean(|row| row.time)),
            speed: nominal.speed.unwrap_or_else(|| mean(|row| row.speed)),
            area: nominal.area.unwrap_or_else(|| mean(|row| row.area)),
        },
        force,
        time,
        speed,
        area,
        threshold: nominal.threshold,
        sag: nominal.sag,
        wear: nominal.wear,
    }
}

/// The file with the law as found, in place of what it says of it.
fn improved(file: &RemovalTableFile, diagnosis: &RemovalDiagnosis) -> String {
    let law = &diagnosis.found;
    let mut text = String::new();
    let mut within = false;
    for line in file.text.lines() {
        if line.trim_start().starts_with('[') {
            within = line.trim() == "[believed]";
        }
        if !within {
            text += line;
            text.push('\n');
        }
    }
    text +=
        "\n[believed]                       # as a diagnosis has improved it\nlaw = \"power\"\n";
    let mut put = |key: &str, value: f64| text += &format!("{key} = {value:?}\n");
    put(
        "reference_volume_mm3",
        law.number(Deviation::Coefficient) * 1e9,
    );
    let at = &law.reference;
    put("reference_force_n", at.force);
    match (&file.time, file.is_feed) {
        (None, _) => {}
        (Some(_), true) => put("reference_feed_mm_per_s", 1e3 / at.time),
        (Some(_), false) => put("reference_time_s", at.time),
    }
    if file.speed.is_some() {
        put("reference_speed", at.speed);
    }
    if file.area.is_some() {
        put("reference_area_mm2", at.area * 1e6);
    }
    for of in Deviation::ALL.into_iter().skip(1) {
        put(of.key(), law.number(of));
    }
    for of_effect in &diagnosis.effects {
        let [value, low, high] = of_effect.value;
        let scale = if of_effect.deviation == Deviation::Coefficient {
            1e9
        } else {
            1.0
        };
        let [value, low, high] = [value, low, high].map(|v| v * scale);
        let key = of_effect.deviation.key();
        text += &format!("# found: {key} = {value:.4e}, 95 % of {low:.3e} to {high:.3e}\n");
    }
    text
}

/// Rows with what a law predicts.
fn predicted(law: &TableLaw, rows: &[TableRow]) -> String {
    let mut text = format!("{}\n", COLUMNS.join(","));
    for row in rows {
        let [measured, predicted] = [row.volume, law.volume_of(row)].map(|v| v * MM3);
        let shown = if predicted.is_finite() {
            format!("{predicted:.6e}")
        } else {
            String::new()
        };
        text += &format!("{},{},{measured:.6e},{shown}\n", row.table, row.line);
    }
    text
}
