//! The values of each run, by its number.

use std::collections::BTreeSet;
use std::io::Read as _;
use std::path::Path;
use std::str::FromStr;

use rand::Rng;

use super::latin::{LatinHypercube, stream};
use super::variable::{Values, Variable, VaryError};
use crate::quantity::counted;
use crate::recording::csv::line_of;

/// Runs at most.
const MOST: usize = 10_000_000;
/// Length of a table of points at most [byte].
const LONGEST: u64 = 256_000_000;

/// How the points lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Sampling {
    /// Every combination, the last variable changing first.
    #[default]
    Grid,
    /// So many, each variable drawn for itself.
    Random(usize),
    /// So many as a Latin hypercube: of each variable's range as many equal parts, each of them once.
    Latin(usize),
}

impl FromStr for Sampling {
    type Err = VaryError;

    fn from_str(text: &str) -> Result<Self, VaryError> {
        let no = || VaryError::NoSampling {
            text: text.to_owned(),
        };
        if text == "grid" {
            return Ok(Self::Grid);
        }
        let (kind, count) = text.split_once(':').ok_or_else(no)?;
        let count = count.parse().ok().filter(|count| *count > 0);
        match (kind, count.ok_or_else(no)?) {
            ("random", count) => Ok(Self::Random(count)),
            ("latin", count) => Ok(Self::Latin(count)),
            _ => Err(no()),
        }
    }
}

/// Points of a sweep.
#[derive(Debug, Clone)]
pub struct Points {
    variables: Vec<Variable>,
    sampling: Sampling,
    seed: u64,
    count: usize,
    /// Of a Latin hypercube.
    latin: Option<LatinHypercube>,
    /// Of a table: its rows, in place of all else.
    table: Option<Rows>,
}

/// Rows of a table.
#[derive(Debug, Clone)]
struct Rows {
    file: String,
    values: Vec<Vec<String>>,
    /// Line of each in the file, from 1.
    lines: Vec<u64>,
}

impl Points {
    /// Points of variables.
    ///
    /// # Errors
    /// A key is given twice, a grid has a range that is not counted, or there are too many points.
    pub fn new(variables: Vec<Variable>, sampling: Sampling, seed: u64) -> Result<Self, VaryError> {
        once(variables.iter().map(|variable| variable.key.as_str()))?;
        let count = match sampling {
            Sampling::Grid => grid(&variables)?,
            Sampling::Random(count) | Sampling::Latin(count) => Some(count),
        };
        let count = count.filter(|count| (1..=MOST).contains(count));
        let count = count.ok_or_else(|| VaryError::Count {
            count: match sampling {
                Sampling::Grid => format!("more than {MOST}"),
                Sampling::Random(count) | Sampling::Latin(count) => count.to_string(),
            },
            most: MOST,
        })?;
        let latin = matches!(sampling, Sampling::Latin(_))
            .then(|| LatinHypercube::new(count, variables.len(), seed));
        Ok(Self {
            variables,
            sampling,
            seed,
            count,
            latin,
            table: None,
        })
    }

    /// Points of a table: a column for each key, a row for each run.
    ///
    /// # Errors
    /// The file cannot be read, or is no such table.
    pub fn table(path: &Path) -> Result<Self, VaryError> {
        let file = path.display().to_string();
        let (keys, rows) = read_table(path).map_err(|reason| VaryError::Table {
            file: file.clone(),
            reason,
        })?;
        let rows = Rows { file, ..rows };
        let variables = keys.into_iter().enumerate().map(|(place, key)| Variable {
            key,
            values: of_column(rows.values.iter().map(|row| row[place].as_str())),
        });
        Ok(Self {
            variables: variables.collect(),
            sampling: Sampling::Grid,
            seed: 0,
            count: rows.values.len(),
            latin: None,
            table: Some(rows),
        })
    }

    /// Number of runs.
    #[must_use]
    pub fn count(&self) -> usize {
        self.count
    }

    /// What is varied.
    #[must_use]
    pub fn variables(&self) -> &[Variable] {
        &self.variables
    }

    /// Whether the points are every combination: variables then do not go together.
    #[must_use]
    pub fn is_table(&self) -> bool {
        self.table.is_some()
    }

    /// Values of a variable that are checked before anything is run: those at its ends, or all that are named, as they are written.
    #[must_use]
    pub fn to_check(&self, variable: usize) -> Vec<String> {
        let of = &self.variables[variable];
        let (Some(rows), Values::Between(ends)) = (&self.table, &of.values) else {
            return of.to_check();
        };
        let written = ends.iter().filter_map(|end| {
            let mut column = rows.values.iter().map(|row| &row[variable]);
            column.find(|value| value.parse() == Ok(*end)).cloned()
        });
        written.collect()
    }

    /// Where a value of a variable stands: the file and the line of the first row that has it. None where it was typed.
    #[must_use]
    pub fn place_of(&self, variable: usize, value: &str) -> Option<String> {
        let rows = self.table.as_ref()?;
        let row = (rows.values.iter()).position(|row| row[variable] == value)?;
        Some(format!("{}: line {}", rows.file, rows.lines[row]))
    }

    /// How they lie, in words.
    #[must_use]
    pub fn words(&self) -> String {
        match (self.sampling, &self.table) {
            (_, Some(_)) => "the points of a table".to_owned(),
            (Sampling::Grid, None) => "every combination".to_owned(),
            (Sampling::Random(_), None) => format!("drawn at random, seed {}", self.seed),
            (Sampling::Latin(_), None) => format!("a Latin hypercube, seed {}", self.seed),
        }
    }

    /// The values of a run, from 0, in the order of the variables.
    #[must_use]
    pub fn at(&self, run: usize) -> Vec<String> {
        if let Some(rows) = &self.table {
            return rows.values[run].clone();
        }
        match (self.sampling, &self.latin) {
            (_, Some(latin)) => {
                let values = self.variables.iter().zip(latin.shares(run));
                values
                    .map(|(variable, share)| variable.at_share(share))
                    .collect()
            }
            (Sampling::Grid | Sampling::Latin(_), None) => {
                let mut rest = run;
                let mut values: Vec<String> = (self.variables.iter().rev())
                    .map(|variable| {
                        let count = variable.count().unwrap_or(1);
                        let value = variable.at(rest % count);
                        rest /= count;
                        value
                    })
                    .collect();
                values.reverse();
                values
            }
            (Sampling::Random(_), None) => {
                // A stream each, so that more runs leave the first ones as they are.
                let mut random = stream(self.seed, run as u64);
                let value = |variable: &Variable| variable.at_share(random.random());
                self.variables.iter().map(value).collect()
            }
        }
    }
}

/// Keys and rows of a table; or the fault, and what was expected. What the file holds is not repeated before it is known to be such a table.
fn read_table(path: &Path) -> Result<(Vec<String>, Rows), String> {
    let file = crate::file::open(path).map_err(|e| e.to_string())?;
    let mut text = String::new();
    let read = file.take(LONGEST + 1).read_to_string(&mut text);
    read.map_err(|e| e.to_string())?;
    if text.len() as u64 > LONGEST {
        return Err(format!(
            "it is longer than {LONGEST} bytes, expected a table of at most as many"
        ));
    }
    let text = text.trim_start_matches('\u{feff}');
    let mut reader = csv::ReaderBuilder::new()
        .trim(csv::Trim::All)
        .flexible(true)
        .from_reader(text.as_bytes());
    let keys = reader.headers().map_err(|e| e.to_string())?;
    let keys: Vec<String> = keys.iter().map(str::to_owned).collect();
    if let Some(place) = keys.iter().position(|key| !is_key(key)) {
        return Err(format!(
            "line 1: column {} has no key for a name, expected a key of the scenario by its dotted path for each column",
            place + 1
        ));
    }
    let twice = |(place, key)| keys[..place].contains(key);
    if let Some((_, key)) = keys.iter().enumerate().find(|column| twice(*column)) {
        return Err(format!(
            "line 1: {key} is given twice, expected each key once"
        ));
    }
    let (mut values, mut lines) = (Vec::new(), Vec::new());
    for record in reader.records() {
        let record = record.map_err(|e| e.to_string())?;
        let line = line_of(text, record.position());
        if record.len() != keys.len() {
            return Err(format!(
                "line {line}: it has {}, expected {}, one for each key",
                counted(record.len(), "value"),
                keys.len()
            ));
        }
        for (key, value) in keys.iter().zip(&record) {
            let number = value.parse::<f64>();
            if value.is_empty() || number.is_ok_and(|number| !number.is_finite()) {
                return Err(format!(
                    "line {line}: `{key}` is `{value}`, expected a value that is finite"
                ));
            }
        }
        values.push(record.iter().map(str::to_owned).collect());
        lines.push(line);
        if values.len() > MOST {
            return Err(format!("line {line}: there are more runs than {MOST}"));
        }
    }
    if values.is_empty() {
        return Err("it has no points, expected a line of values for each run".to_owned());
    }
    let file = String::new();
    Ok((
        keys,
        Rows {
            file,
            values,
            lines,
        },
    ))
}

/// Whether a text may be a dotted key.
fn is_key(text: &str) -> bool {
    let is_letter = |letter: char| letter.is_ascii_alphanumeric() || "_.-[]".contains(letter);
    text.starts_with(|letter: char| letter.is_ascii_alphabetic()) && text.chars().all(is_letter)
}

fn once<'a>(keys: impl Iterator<Item = &'a str>) -> Result<(), VaryError> {
    let mut seen = BTreeSet::new();
    for key in keys {
        if !seen.insert(key) {
            let key = key.to_owned();
            return Err(VaryError::Twice { key });
        }
    }
    Ok(())
}

/// Number of all combinations; none where it is too large to count.
fn grid(variables: &[Variable]) -> Result<Option<usize>, VaryError> {
    let mut product = Some(1usize);
    for variable in variables {
        let count = variable.count().ok_or_else(|| VaryError::Uncounted {
            key: variable.key.clone(),
        })?;
        product = product.and_then(|product| product.checked_mul(count));
    }
    Ok(product)
}

/// The values of a column: its ends, where all are numbers.
fn of_column<'a>(values: impl Iterator<Item = &'a str> + Clone) -> Values {
    let numbers: Option<Vec<f64>> = values.clone().map(|value| value.parse().ok()).collect();
    match numbers {
        Some(numbers) => {
            let low = numbers.iter().copied().fold(f64::INFINITY, f64::min);
            let high = numbers.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            Values::Between([low, high])
        }
        None => {
            let each: BTreeSet<&str> = values.collect();
            Values::Listed(each.into_iter().map(str::to_owned).collect())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(texts: &[&str], sampling: &str) -> Points {
        let variables = texts.iter().map(|text| Variable::parse(text).unwrap());
        Points::new(variables.collect(), sampling.parse().unwrap(), 7).unwrap()
    }

    #[test]
    fn a_grid_has_each_combination_once_the_last_changing_first() {
        let grid = points(&["a=1,2", "b=1..3"], "grid");
        let all: Vec<String> = (0..grid.count())
            .map(|run| grid.at(run).join(" "))
            .collect();
        assert_eq!(all, ["1 1", "1 2", "1 3", "2 1", "2 2", "2 3"]);
    }

    #[test]
    fn a_latin_hypercube_has_each_part_of_each_range_once() {
        let latin = points(&["a=0.0..1.0", "b=1..50", "c=x,y"], "latin:50");
        let (mut parts, mut whole, mut named) = (vec![0; 50], vec![0; 50], [0; 2]);
        for run in 0..50 {
            let values = latin.at(run);
            parts[(values[0].parse::<f64>().unwrap() * 50.0) as usize] += 1;
            whole[values[1].parse::<usize>().unwrap() - 1] += 1;
            named[usize::from(values[2] == "y")] += 1;
        }
        assert!(parts.iter().chain(&whole).all(|count| *count == 1));
        assert_eq!(named, [25, 25]);
        // Variables are shuffled each for itself.
        let same = (0..50).filter(|run| {
            let values = latin.at(*run);
            (values[0].parse::<f64>().unwrap() * 50.0) as usize + 1
                == values[1].parse::<usize>().unwrap()
        });
        assert!(same.count() < 10);
    }

    #[test]
    fn more_random_runs_begin_with_the_same_ones() {
        let [few, many] = ["random:10", "random:1000"].map(|n| points(&["a=2.0..4.0"], n));
        assert!((0..10).all(|run| few.at(run) == many.at(run)));
        let mean = (0..1000)
            .map(|run| many.at(run)[0].parse::<f64>().unwrap())
            .sum::<f64>()
            / 1e3;
        assert!((mean - 3.0).abs() < 0.08, "{mean}");
    }

    #[test]
    fn a_table_s_rows_are_the_points() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("points.csv");
        let read = |text: &str| {
            std::fs::write(&path, text).unwrap();
            Points::table(&path)
        };
        let points = read("process.force_n, device.model\n30,a.toml\n60.5,b.toml\n").unwrap();
        assert_eq!(
            (points.count(), points.at(1)),
            (2, vec!["60.5".to_owned(), "b.toml".to_owned()])
        );
        assert_eq!(points.variables()[0].values, Values::Between([30.0, 60.5]));
        for (text, expected) in [
            ("a,b\n", "it has no points"),
            ("1,2\n3,4\n", "points.csv: line 1: column 1 has no key"),
            (
                "a,b\n\n1\n",
                "points.csv: line 3: it has 1 value, expected 2",
            ),
            ("a,b\n\"1\n\",2\n1,\n", "line 4: `b` is ``, expected"),
            ("a,b\n1,inf\n", "points.csv: line 2: `b` is `inf`"),
            ("a,a\n1,2\n", "points.csv: line 1: a is given twice"),
        ] {
            let refused = read(text).unwrap_err().to_string();
            assert!(refused.contains(expected), "{text}: {refused}");
        }
        // Of a file that is no such table nothing is shown.
        let refused = read("root:$y$secret:19000\nb\n").unwrap_err().to_string();
        assert!(!refused.contains("secret"), "{refused}");
    }

    #[test]
    fn a_value_of_a_table_has_its_place() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("points.csv");
        std::fs::write(&path, "a,b\n1e2,x\n\n7.50,y\n20,x\n").unwrap();
        let points = Points::table(&path).unwrap();
        assert_eq!(points.to_check(0), ["7.50", "1e2"]);
        let place = |variable, value| points.place_of(variable, value).unwrap();
        assert!(place(0, "7.50").ends_with("points.csv: line 4"));
        assert!(place(1, "x").ends_with("points.csv: line 2"));
        assert!(place(0, "20").ends_with("points.csv: line 5"));
    }

    #[test]
    fn what_cannot_be_counted_is_refused() {
        let refused = |texts: &[&str], sampling: &str| {
            let variables = texts.iter().map(|text| Variable::parse(text).unwrap());
            let points = Points::new(variables.collect(), sampling.parse().unwrap(), 0);
            points.unwrap_err().to_string()
        };
        assert!(refused(&["a=1.0..2.0"], "grid").contains("a..b:COUNT"));
        assert!(refused(&["a=1,2", "a=3"], "grid").contains("a is given twice"));
        assert!(refused(&["a=1..5000", "b=1..5000"], "grid").contains("runs, expected 1 to"));
        for text in ["sobol:4", "random", "random:0", "latin:x"] {
            assert!(text.parse::<Sampling>().is_err(), "{text}");
        }
    }
}
