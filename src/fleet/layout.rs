//! FOLDER/DEVICE/DATE: devices by their names, recordings by their dates.

use std::path::{Path, PathBuf};

/// Recordings of a fleet.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Layout {
    /// Devices by name.
    pub devices: Vec<Device>,
    /// What stands there and is not taken, and why.
    pub passed_over: Vec<(PathBuf, String)>,
}

/// A device.
#[derive(Debug, Clone, PartialEq)]
pub struct Device {
    /// Name of its folder.
    pub name: String,
    /// Its recordings, the first one first.
    pub recordings: Vec<Dated>,
}

/// What was recorded at a time.
#[derive(Debug, Clone, PartialEq)]
pub struct Dated {
    /// Name of its file or folder.
    pub name: String,
    /// Days since 1970-01-01, with their fraction where the name has a time [d].
    pub day: f64,
    /// The file, or the folder.
    pub path: PathBuf,
    /// Files of it.
    pub files: Vec<PathBuf>,
}

/// A folder that holds no fleet.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum FleetError {
    /// It cannot be read.
    #[error("cannot read {folder}: {reason}")]
    Read {
        /// The folder.
        folder: String,
        /// Why.
        reason: String,
    },
    /// Nothing in it is a recording by its date.
    #[error(
        "{folder} holds no recordings of devices; expected {folder}/DEVICE/DATE, each DATE a recording or a folder of them whose name begins as 2026-03-01 or 20260301"
    )]
    Empty {
        /// The folder.
        folder: String,
    },
    /// An effect that no recording can be fitted with.
    #[error("{file}: {reason}")]
    Nominal {
        /// The file.
        file: String,
        /// Why.
        reason: String,
    },
}

/// Reads the layout; names are looked at, no recording is opened.
///
/// # Errors
/// The folder cannot be read, or holds none.
pub fn scan(folder: &Path) -> Result<Layout, FleetError> {
    let mut layout = Layout::default();
    for path in entries(folder)? {
        if !path.is_dir() {
            continue;
        }
        let mut recordings = Vec::new();
        for dated in entries(&path)? {
            let name = name_of(&dated);
            let Some(day) = day_of(&name) else {
                let why = "its name does not begin with a date, as in 2026-03-01";
                layout.passed_over.push((dated, why.to_owned()));
                continue;
            };
            let files: Vec<PathBuf> = match dated.is_dir() {
                true => all_files(&dated)?,
                false => vec![dated.clone()],
            };
            let files: Vec<PathBuf> = files.into_iter().filter(|f| is_recording(f)).collect();
            if files.is_empty() {
                let why = "no recording in it (.csv, .parquet)";
                layout.passed_over.push((dated, why.to_owned()));
                continue;
            }
            recordings.push(Dated {
                name,
                day,
                path: dated,
                files,
            });
        }
        recordings.sort_by(|a, b| a.day.total_cmp(&b.day).then_with(|| a.name.cmp(&b.name)));
        if !recordings.is_empty() {
            let name = name_of(&path);
            layout.devices.push(Device { name, recordings });
        }
    }
    match layout.devices.is_empty() {
        true => Err(FleetError::Empty {
            folder: folder.display().to_string(),
        }),
        false => Ok(layout),
    }
}

fn name_of(path: &Path) -> String {
    path.file_name().unwrap_or_default().display().to_string()
}

fn is_recording(path: &Path) -> bool {
    let extension = path.extension().and_then(|extension| extension.to_str());
    extension.is_some_and(|e| ["csv", "parquet"].contains(&e.to_ascii_lowercase().as_str()))
}

/// What a folder holds, in the order of names.
fn entries(folder: &Path) -> Result<Vec<PathBuf>, FleetError> {
    let cannot = |error: std::io::Error| FleetError::Read {
        folder: folder.display().to_string(),
        reason: error.to_string(),
    };
    let read = std::fs::read_dir(folder).map_err(cannot)?;
    let mut found = Vec::new();
    for entry in read {
        found.push(entry.map_err(cannot)?.path());
    }
    found.sort();
    Ok(found)
}

/// Files of a dated folder, and of runs in it.
fn all_files(folder: &Path) -> Result<Vec<PathBuf>, FleetError> {
    let mut found = Vec::new();
    for path in entries(folder)? {
        match path.is_dir() {
            true => found.extend(entries(&path)?.into_iter().filter(|path| path.is_file())),
            false => found.push(path),
        }
    }
    Ok(found)
}

/// The day of a name, and its time where it has one: `2026-03-01`, `20260301T0600`, `2026-03-01_06-30 shift`.
fn day_of(name: &str) -> Option<f64> {
    let digits = |text: &str| -> Option<u32> {
        (!text.is_empty() && text.bytes().all(|b| b.is_ascii_digit())).then(|| text.parse().ok())?
    };
    let dashed = name
        .get(..10)
        .filter(|text| text.as_bytes()[4] == b'-' && text.as_bytes()[7] == b'-');
    let (year, month, day, rest) = match dashed {
        Some(text) => (
            digits(&text[..4])?,
            digits(&text[5..7])?,
            digits(&text[8..])?,
            &name[10..],
        ),
        None => {
            let text = name.get(..8)?;
            digits(text)?;
            (
                digits(&text[..4])?,
                digits(&text[4..6])?,
                digits(&text[6..])?,
                &name[8..],
            )
        }
    };
    if !(1..=12).contains(&month) || !(1..=31).contains(&day) {
        return None;
    }
    let time: String = rest
        .strip_prefix(['T', 't', '_', ' '])
        .map(|rest| {
            rest.chars()
                .filter(|c| !":-".contains(*c))
                .take_while(char::is_ascii_digit)
                .take(4)
                .collect()
        })
        .unwrap_or_default();
    let minutes = match (time.get(..2), time.get(2..4)) {
        (Some(hours), Some(minutes)) => 60 * digits(hours)? + digits(minutes)?,
        (Some(hours), None) => 60 * digits(hours)?,
        _ => 0,
    };
    let minutes = if minutes < 24 * 60 { minutes } else { 0 };
    Some(
        days_from(i64::from(year), i64::from(month), i64::from(day)) as f64
            + f64::from(minutes) / 1440.0,
    )
}

/// Days since 1970-01-01 of a date of the Gregorian calendar.
fn days_from(year: i64, month: i64, day: i64) -> i64 {
    // Years begin in March, so that a leap day is the last.
    let year = if month <= 2 { year - 1 } else { year };
    let (era, of_era) = (year.div_euclid(400), year.rem_euclid(400));
    let of_year = (153 * ((month + 9) % 12) + 2) / 5 + day - 1;
    era * 146_097 + of_era * 365 + of_era / 4 - of_era / 100 + of_year - 719_468
}

/// The date of a day since 1970-01-01, as `2026-03-01`.
#[must_use]
pub fn date_of_day(day: f64) -> String {
    let shifted = day.floor() as i64 + 719_468;
    let (era, of_era) = (shifted.div_euclid(146_097), shifted.rem_euclid(146_097));
    let year = (of_era - of_era / 1460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year + year / 4 - year / 100);
    let month = (5 * of_year + 2) / 153;
    let day = of_year - (153 * month + 2) / 5 + 1;
    let month = if month < 10 { month + 3 } else { month - 9 };
    let year = year + 400 * era + i64::from(month <= 2);
    format!("{year:04}-{month:02}-{day:02}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_days_and_days_are_dates() {
        assert_eq!(day_of("1970-01-01"), Some(0.0));
        assert_eq!(day_of("2000-03-01.csv"), Some(11_017.0));
        assert_eq!(day_of("20240229T0600_early"), Some(19_782.25));
        assert_eq!(day_of("2024-02-29_18-30"), Some(19_782.0 + 18.5 / 24.0));
        for none in [
            "",
            "notes",
            "2026-13-01",
            "2026-3-1",
            "202603",
            "über-2026-",
        ] {
            assert_eq!(day_of(none), None, "{none}");
        }
        for day in [0.0, 11_016.0, 19_782.5, 20_513.0] {
            assert_eq!(day_of(&date_of_day(day)), Some(f64::floor(day)));
        }
    }

    #[test]
    fn devices_and_dates_are_read_and_what_is_neither_is_reported() {
        let folder = tempfile::tempdir().unwrap();
        let write = |path: &str| {
            let path = folder.path().join(path);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, "t").unwrap();
        };
        assert!(matches!(scan(folder.path()), Err(FleetError::Empty { .. })));
        for path in [
            "b/2026-03-02.csv",
            "b/2026-03-01/ride.csv",
            "b/2026-03-01/press.csv",
            "b/notes.txt",
            "a/2026-03-01/run/samples.parquet",
            "a/2026-03-02/readme.md",
            "stray.csv",
        ] {
            write(path);
        }
        let layout = scan(folder.path()).unwrap();
        let names: Vec<&str> = layout
            .devices
            .iter()
            .map(|device| device.name.as_str())
            .collect();
        assert_eq!(names, ["a", "b"]);
        let dates: Vec<(&str, usize)> = (layout.devices[1].recordings.iter())
            .map(|dated| (dated.name.as_str(), dated.files.len()))
            .collect();
        assert_eq!(dates, [("2026-03-01", 2), ("2026-03-02.csv", 1)]);
        assert_eq!(layout.passed_over.len(), 2);
    }
}
