//! The values of each run, by its number.

use std::collections::BTreeSet;
use std::path::Path;
use std::str::FromStr;

use rand::Rng;

use super::latin::{LatinHypercube, stream};
use super::variable::{Values, Variable, VaryError};

/// Runs at most.
const MOST: usize = 10_000_000;

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
    rows: Option<Vec<Vec<String>>>,
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
            rows: None,
        })
    }

    /// Points of a table: a column for each key, a row for each run.
    ///
    /// # Errors
    /// The file cannot be read, or is no such table.
    pub fn table(path: &Path) -> Result<Self, VaryError> {
        let refuse = |reason: String| VaryError::Table {
            file: path.display().to_string(),
            reason,
        };
        let file = crate::file::open(path).map_err(|e| refuse(e.to_string()))?;
        let mut reader = csv::ReaderBuilder::new()
            .trim(csv::Trim::All)
            .from_reader(file);
        let keys = reader.headers().map_err(|e| refuse(e.to_string()))?.clone();
        once(keys.iter())?;
        if keys
            .iter()
            .any(|key| key.is_empty() || key.parse::<f64>().is_ok())
        {
            let first = keys.iter().collect::<Vec<_>>().join(",");
            return Err(refuse(format!(
                "its first line is `{first}`, expected a key of the scenario by its dotted path for each column"
            )));
        }
        let mut rows: Vec<Vec<String>> = Vec::new();
        for (line, record) in reader.records().enumerate() {
            let record = record.map_err(|e| refuse(e.to_string()))?;
            let row: Vec<String> = record.iter().map(str::to_owned).collect();
            if let Some(place) = row.iter().position(String::is_empty) {
                let (line, key) = (line + 2, &keys[place]);
                return Err(refuse(format!(
                    "line {line} has no value for `{key}`, expected one for each key"
                )));
            }
            rows.push(row);
        }
        if rows.is_empty() {
            return Err(refuse(
                "it has no points, expected a line of values for each run".to_owned(),
            ));
        }
        let variables = keys.iter().enumerate().map(|(place, key)| Variable {
            key: key.to_owned(),
            values: of_column(rows.iter().map(|row| row[place].as_str())),
        });
        Ok(Self {
            variables: variables.collect(),
            sampling: Sampling::Grid,
            seed: 0,
            count: rows.len(),
            latin: None,
            rows: Some(rows),
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
        self.rows.is_some()
    }

    /// How they lie, in words.
    #[must_use]
    pub fn words(&self) -> String {
        match (self.sampling, &self.rows) {
            (_, Some(_)) => "the points of a table".to_owned(),
            (Sampling::Grid, None) => "every combination".to_owned(),
            (Sampling::Random(_), None) => format!("drawn at random, seed {}", self.seed),
            (Sampling::Latin(_), None) => format!("a Latin hypercube, seed {}", self.seed),
        }
    }

    /// The values of a run, from 0, in the order of the variables.
    #[must_use]
    pub fn at(&self, run: usize) -> Vec<String> {
        if let Some(rows) = &self.rows {
            return rows[run].clone();
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
            ("1,2\n3,4\n", "its first line is `1,2`"),
            ("a,b\n1\n", "found record with 1 fields"),
            ("a,b\n1,\n", "line 2 has no value for `b`"),
            ("a,a\n1,2\n", "a is given twice"),
        ] {
            let refused = read(text).unwrap_err().to_string();
            assert!(refused.contains(expected), "{text}: {refused}");
        }
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
