//! An edge before and after it was worked, station by station: edge_profile.csv.

use std::path::Path;

use crate::recording::RecordingError;

/// Names of the file's columns, in their order.
const COLUMNS: [&str; 5] = [
    "position_mm",
    "burr_before_mm",
    "burr_after_mm",
    "chamfer_leg_mm",
    "section_removed_mm2",
];

/// One value a station in each list.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct EdgeProfile {
    /// Place along the edge [m].
    pub place: Vec<f64>,
    /// Height of the burr before any work [m].
    pub burr_before: Vec<f64>,
    /// Height of the burr that is left [m].
    pub burr_after: Vec<f64>,
    /// Leg of the chamfer [m].
    pub chamfer_leg: Vec<f64>,
    /// Section that was taken, of burr and edge [m2].
    pub section_removed: Vec<f64>,
}

impl EdgeProfile {
    fn columns(&self) -> [(&Vec<f64>, f64); 5] {
        [
            (&self.place, 1e3),
            (&self.burr_before, 1e3),
            (&self.burr_after, 1e3),
            (&self.chamfer_leg, 1e3),
            (&self.section_removed, 1e6),
        ]
    }

    /// As comma-separated values, in millimetres.
    pub fn text(&self) -> String {
        let mut text = COLUMNS.join(",") + "\n";
        for row in 0..self.place.len() {
            let values = self.columns().map(|(values, factor)| {
                // Nine digits: what a reader recomputes from it agrees with what was printed.
                format!("{:.9e}", values[row] * factor)
                    .parse::<f64>()
                    .map_or_else(|_| String::new(), |value| format!("{value}"))
            });
            text += &values.join(",");
            text.push('\n');
        }
        text
    }

    /// Reads what [`EdgeProfile::text`] wrote.
    ///
    /// # Errors
    /// The file cannot be read, or a field is no number.
    pub fn read(path: &Path) -> Result<Self, RecordingError> {
        let fail = |error: csv::Error| RecordingError::read(path, error);
        let file = crate::file::open(path).map_err(|e| RecordingError::read(path, e))?;
        let mut reader = csv::Reader::from_reader(file);
        let mut profile = Self::default();
        for row in reader.deserialize::<[f64; 5]>() {
            let [place, before, after, leg, removed] = row.map_err(fail)?;
            profile.place.push(place * 1e-3);
            profile.burr_before.push(before * 1e-3);
            profile.burr_after.push(after * 1e-3);
            profile.chamfer_leg.push(leg * 1e-3);
            profile.section_removed.push(removed * 1e-6);
        }
        Ok(profile)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_to_nine_digits() {
        let profile = EdgeProfile {
            place: vec![0.05e-3, 0.15e-3],
            burr_before: vec![0.3e-3, 1.0e-3 / 3.0],
            burr_after: vec![0.0, 0.1e-3],
            chamfer_leg: vec![0.2e-3, 0.0],
            section_removed: vec![0.0425e-6, 0.01e-6 / 7.0],
        };
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("edge_profile.csv");
        std::fs::write(&path, profile.text()).unwrap();
        let read = EdgeProfile::read(&path).unwrap();
        for ((written, _), (read, _)) in profile.columns().iter().zip(read.columns()) {
            for (written, read) in written.iter().zip(read) {
                assert!((written - read).abs() <= 1e-8 * written.abs());
            }
        }
    }
}
