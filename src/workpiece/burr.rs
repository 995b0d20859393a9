//! Burr height over the path length of an edge.
//!
//! The random burr is a log-normal process: `exp(m + d g(s))` of a band-limited Gaussian process `g`
//! of unit variance, so that it is smooth, never negative, and has exactly the stated mean and
//! standard deviation. `g` is a sum of cosines whose wave numbers are drawn from the spectrum of the
//! covariance `exp(-s^2 / (2 l^2))` (Shinozuka and Deodatis, Appl. Mech. Rev. 44(4), 1991).

use std::f64::consts::TAU;
use std::path::Path;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::error::{WorkpieceError, require};

/// Cosines in the random burr.
const WAVES: usize = 64;

/// The only header a burr table may have.
const TABLE_HEADER: [&str; 2] = ["position_mm", "height_mm"];

/// Height of a burr above the edge [m] over path length [m].
#[derive(Debug, Clone, PartialEq)]
pub enum BurrProfile {
    /// The same height everywhere.
    Constant {
        /// Height [m].
        height: f64,
    },
    /// A smooth random height, the same for the same seed.
    SeededRandom(RandomBurr),
    /// A measured height, linear between its rows.
    FromTable(BurrTable),
    /// One raised cosine.
    Bump {
        /// Path length of the middle [m].
        position: f64,
        /// Height in the middle [m].
        height: f64,
        /// Width from foot to foot [m].
        width: f64,
    },
}

/// Log-normal random burr, see the module's description.
#[derive(Debug, Clone, PartialEq)]
pub struct RandomBurr {
    /// Mean of the logarithm, and factor of the Gaussian process in it.
    log_mean: f64,
    log_deviation: f64,
    /// Wave number [1/m] and phase [rad] of each cosine.
    waves: Vec<(f64, f64)>,
}

/// Positions [m] and heights [m] of a measured burr, positions increasing.
#[derive(Debug, Clone, PartialEq)]
pub struct BurrTable {
    rows: Vec<(f64, f64)>,
}

impl BurrProfile {
    /// No burr at all.
    pub const NONE: Self = Self::Constant { height: 0.0 };

    /// The same height [m] everywhere.
    ///
    /// # Errors
    /// The height is negative or not finite.
    pub fn constant(height: f64) -> Result<Self, WorkpieceError> {
        require("burr height [m]", height, height >= 0.0, "0 or more")?;
        Ok(Self::Constant { height })
    }

    /// One raised cosine at path length `position` [m], `height` [m] high, `width` [m] wide.
    ///
    /// # Errors
    /// A number is not finite or out of its range.
    pub fn bump(position: f64, height: f64, width: f64) -> Result<Self, WorkpieceError> {
        require("burr bump position [m]", position, true, "a number")?;
        require("burr bump height [m]", height, height >= 0.0, "0 or more")?;
        require("burr bump width [m]", width, width > 0.0, "more than 0")?;
        Ok(Self::Bump {
            position,
            height,
            width,
        })
    }

    /// A random burr with this mean height [m], standard deviation [m] and correlation length [m]
    /// (distance over which the correlation of the logarithm falls to exp(-1/2) = 0.61).
    ///
    /// # Errors
    /// A number is not finite or out of its range.
    pub fn seeded_random(
        seed: u64,
        mean: f64,
        standard_deviation: f64,
        correlation_length: f64,
    ) -> Result<Self, WorkpieceError> {
        require("mean burr height [m]", mean, mean > 0.0, "more than 0")?;
        require(
            "standard deviation of burr height [m]",
            standard_deviation,
            standard_deviation >= 0.0,
            "0 or more",
        )?;
        require(
            "burr correlation length [m]",
            correlation_length,
            correlation_length > 0.0,
            "more than 0",
        )?;
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        let waves = (0..WAVES)
            .map(|_| {
                // Box-Muller; 1 - u lies in (0, 1], where the logarithm is finite.
                let radius = (-2.0 * (1.0 - generator.random::<f64>()).ln()).sqrt();
                let normal = radius * (TAU * generator.random::<f64>()).cos();
                (normal / correlation_length, TAU * generator.random::<f64>())
            })
            .collect();
        let log_variance = (standard_deviation / mean).powi(2).ln_1p();
        Ok(Self::SeededRandom(RandomBurr {
            log_mean: mean.ln() - log_variance / 2.0,
            log_deviation: log_variance.sqrt(),
            waves,
        }))
    }

    /// Reads a table with the header `position_mm,height_mm`, positions strictly increasing.
    ///
    /// # Errors
    /// The file cannot be read, or a row is not of this form.
    pub fn from_csv(path: &Path) -> Result<Self, WorkpieceError> {
        let file = crate::file::open(path).map_err(|source| WorkpieceError::Read {
            file: path.to_owned(),
            source,
        })?;
        let fault = |line: u64, reason: String| WorkpieceError::BurrTable {
            file: path.to_owned(),
            line,
            reason,
        };
        let csv_fault = |error: csv::Error| {
            let line = error.position().map_or(1, csv::Position::line);
            match error.kind() {
                csv::ErrorKind::UnequalLengths { len, .. } => {
                    fault(line, format!("{len} fields, expected 2"))
                }
                _ => fault(line, error.to_string()),
            }
        };
        let mut reader = csv::ReaderBuilder::new()
            .trim(csv::Trim::All)
            .comment(Some(b'#'))
            .from_reader(file);
        let header = reader.headers().map_err(csv_fault)?;
        if header != TABLE_HEADER.as_slice() {
            let found: Vec<&str> = header.iter().collect();
            let expected = TABLE_HEADER.join(",");
            let reason = format!("header is '{}', expected '{expected}'", found.join(","));
            return Err(fault(1, reason));
        }
        let mut rows: Vec<(f64, f64)> = Vec::new();
        for record in reader.records() {
            let record = record.map_err(csv_fault)?;
            let line = record.position().map_or(0, csv::Position::line);
            let mut numbers = [0.0; 2];
            for ((number, field), name) in numbers.iter_mut().zip(&record).zip(TABLE_HEADER) {
                let parsed: Option<f64> = field.parse().ok();
                *number = parsed.filter(|value| value.is_finite()).ok_or_else(|| {
                    fault(line, format!("{name} is '{field}', expected a number"))
                })?;
            }
            let [position, height] = numbers.map(|millimetres| millimetres * 1e-3);
            if height < 0.0 {
                let reason = format!("height_mm is {}, expected 0 or more", numbers[1]);
                return Err(fault(line, reason));
            }
            if let Some(&(last, _)) = rows.last()
                && position <= last
            {
                let reason = format!(
                    "position_mm is {}, expected more than the {} of the row above",
                    numbers[0],
                    last * 1e3
                );
                return Err(fault(line, reason));
            }
            rows.push((position, height));
        }
        if rows.len() < 2 {
            let reason = format!("{} rows, expected at least 2", rows.len());
            return Err(fault(reader.position().line(), reason));
        }
        Ok(Self::FromTable(BurrTable { rows }))
    }

    /// Height [m] at path length `position` [m]. A table holds its end values outside its rows.
    pub fn height(&self, position: f64) -> f64 {
        match self {
            Self::Constant { height } => *height,
            Self::SeededRandom(random) => random.height(position),
            Self::FromTable(table) => table.height(position),
            Self::Bump {
                position: middle,
                height,
                width,
            } => {
                let phase = (position - middle) / width;
                if phase.abs() < 0.5 {
                    0.5 * height * (1.0 + (TAU * phase).cos())
                } else {
                    0.0
                }
            }
        }
    }

    /// Positions [m] that any sampling must hit: a table's rows, a bump's feet and middle.
    pub fn landmarks(&self) -> Vec<f64> {
        match self {
            Self::Constant { .. } | Self::SeededRandom(_) => Vec::new(),
            Self::FromTable(table) => table.rows.iter().map(|row| row.0).collect(),
            Self::Bump {
                position, width, ..
            } => vec![position - width / 2.0, *position, position + width / 2.0],
        }
    }

    /// Refuses a table that does not cover a path of this length [m], and a bump that does not touch it.
    ///
    /// # Errors
    /// The path begins before the table or ends beyond it, or the bump lies beside the path.
    pub fn require_cover(&self, length: f64) -> Result<(), WorkpieceError> {
        // A table written in millimetres to three decimals may miss the end by a rounding.
        const SLACK: f64 = 1e-6;
        let (from, to, expected, fits) = match self {
            Self::FromTable(table) => {
                let (from, to) = (table.rows[0].0, table.rows[table.rows.len() - 1].0);
                (
                    from,
                    to,
                    "it to cover",
                    from <= SLACK && to >= length - SLACK,
                )
            }
            Self::Bump {
                position, width, ..
            } => {
                let (from, to) = (position - width / 2.0, position + width / 2.0);
                (from, to, "it to lie within", from < length && to > 0.0)
            }
            Self::Constant { .. } | Self::SeededRandom(_) => return Ok(()),
        };
        if !fits {
            return Err(WorkpieceError::BurrCoverage {
                from,
                to,
                length,
                expected,
            });
        }
        Ok(())
    }
}

impl RandomBurr {
    fn height(&self, position: f64) -> f64 {
        let sum: f64 = self
            .waves
            .iter()
            .map(|&(wave_number, phase)| (wave_number * position + phase).cos())
            .sum();
        let unit = sum * (2.0 / WAVES as f64).sqrt();
        (self.log_mean + self.log_deviation * unit).exp()
    }
}

impl BurrTable {
    fn height(&self, position: f64) -> f64 {
        let after = self.rows.partition_point(|row| row.0 <= position);
        if after == 0 {
            return self.rows[0].1;
        }
        if after == self.rows.len() {
            return self.rows[after - 1].1;
        }
        let ((left, low), (right, high)) = (self.rows[after - 1], self.rows[after]);
        low + (high - low) * (position - left) / (right - left)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(text: &str) -> Result<BurrProfile, WorkpieceError> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("burr.csv");
        std::fs::write(&path, text).unwrap();
        BurrProfile::from_csv(&path)
    }

    #[test]
    fn bump_and_constant_have_their_heights() {
        let bump = BurrProfile::bump(0.1, 4e-4, 0.02).unwrap();
        assert_eq!(bump.height(0.1), 4e-4);
        assert!((bump.height(0.105) - 2e-4).abs() < 1e-15);
        assert_eq!(bump.height(0.09), 0.0);
        assert_eq!(bump.height(0.2), 0.0);
        assert_eq!(BurrProfile::constant(3e-4).unwrap().height(7.0), 3e-4);
        assert!(BurrProfile::constant(-1e-4).is_err());
        assert!(BurrProfile::bump(0.0, 1e-4, 0.0).is_err());
        assert!(BurrProfile::bump(f64::NAN, 1e-4, 0.1).is_err());
    }

    #[test]
    fn random_burr_has_the_stated_statistics() {
        let (mean, deviation, correlation) = (3e-4, 1e-4, 4e-3);
        // Many seeds: one realisation of 64 waves only approaches the ensemble.
        let (mut sum, mut squares, mut products, mut log_squares, mut count) =
            (0.0, 0.0, 0.0, 0.0, 0.0);
        for seed in 0..400 {
            let burr = BurrProfile::seeded_random(seed, mean, deviation, correlation).unwrap();
            for sample in 0..20 {
                let position = f64::from(sample) * 0.02;
                let height = burr.height(position);
                assert!(height > 0.0);
                sum += height;
                squares += (height - mean).powi(2);
                let variance = (deviation / mean).powi(2).ln_1p();
                let logarithm = |s: f64| burr.height(s).ln() - (mean.ln() - variance / 2.0);
                products += logarithm(position) * logarithm(position + correlation);
                log_squares += logarithm(position).powi(2);
                count += 1.0;
            }
        }
        assert!((sum / count / mean - 1.0).abs() < 0.02);
        assert!(((squares / count).sqrt() / deviation - 1.0).abs() < 0.05);
        assert!((products / log_squares - (-0.5_f64).exp()).abs() < 0.03);
    }

    #[test]
    fn random_burr_depends_on_its_seed_alone() {
        let burr = |seed| BurrProfile::seeded_random(seed, 3e-4, 1e-4, 4e-3).unwrap();
        assert_eq!(burr(7), burr(7));
        assert_ne!(burr(7).height(0.1), burr(8).height(0.1));
        let flat = BurrProfile::seeded_random(7, 3e-4, 0.0, 4e-3).unwrap();
        assert!((flat.height(0.123) - 3e-4).abs() < 1e-18);
    }

    #[test]
    fn table_is_linear_between_rows() {
        let burr = table("position_mm,height_mm\n0,0.1\n# a remark\n100, 0.3\n300,0\n").unwrap();
        for (position, height) in [
            (0.0, 1e-4),
            (0.05, 2e-4),
            (0.1, 3e-4),
            (0.2, 1.5e-4),
            (0.4, 0.0),
        ] {
            assert!((burr.height(position) - height).abs() < 1e-15, "{position}");
        }
        burr.require_cover(0.3).unwrap();
        let message = burr.require_cover(0.301).unwrap_err().to_string();
        assert!(
            message.ends_with("expected it to cover 0 mm to 301.000 mm"),
            "{message}"
        );
        let bump = BurrProfile::bump(0.4, 1e-4, 0.02).unwrap();
        bump.require_cover(0.391).unwrap();
        let message = bump.require_cover(0.389).unwrap_err().to_string();
        assert!(message.contains("390.000 mm to 410.000 mm"), "{message}");
    }

    #[test]
    fn table_faults_name_file_and_line() {
        for (text, line, expected) in [
            ("position,height\n0,1\n", 1, "position_mm,height_mm"),
            ("", 1, "position_mm,height_mm"),
            ("position_mm,height_mm\n0,1\n1,x\n", 3, "'x'"),
            ("position_mm,height_mm\n0,1\n1,inf\n", 3, "'inf'"),
            ("position_mm,height_mm\n0,1\n0,1\n", 3, "row above"),
            ("position_mm,height_mm\n0,1\n1,-0.5\n", 3, "-0.5"),
            ("position_mm,height_mm\n0,1\n1,2,3\n", 3, "3 fields"),
            ("position_mm,height_mm\n0,1\n", 3, "1 rows"),
        ] {
            let message = table(text).unwrap_err().to_string();
            assert!(
                message.contains(&format!("burr.csv, line {line}")),
                "{message}"
            );
            assert!(message.contains(expected), "{message}");
        }
        let missing = BurrProfile::from_csv(Path::new("/nowhere/burr.csv")).unwrap_err();
        assert!(missing.to_string().contains("/nowhere/burr.csv"));
    }
}
