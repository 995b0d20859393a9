//! Standard cylinders: bores with the rod that goes with each.
//!
//! Bores of ISO 6432 (8 to 25 mm) and ISO 15552 (32 to 100 mm). ISO 15552 fixes the thread of the rod's end and leaves the rod's diameter to the
//! makers; the diameters here are those that cylinders to both standards usually have. `rod_mm` in the study file replaces them.

/// Bore and rod diameter [mm].
pub(super) const STANDARD_CYLINDERS: [(f64, f64); 12] = [
    (8.0, 4.0),
    (10.0, 4.0),
    (12.0, 6.0),
    (16.0, 6.0),
    (20.0, 8.0),
    (25.0, 10.0),
    (32.0, 12.0),
    (40.0, 16.0),
    (50.0, 20.0),
    (63.0, 20.0),
    (80.0, 25.0),
    (100.0, 25.0),
];

/// Rod of a standard bore [mm].
pub(super) fn standard_rod(bore: f64) -> Option<f64> {
    STANDARD_CYLINDERS
        .iter()
        .find(|(standard, _)| *standard == bore)
        .map(|(_, rod)| *rod)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bores_grow_and_rods_fit_into_them() {
        assert!(STANDARD_CYLINDERS.is_sorted_by(|a, b| a.0 < b.0 && a.1 <= b.1));
        assert!(STANDARD_CYLINDERS.iter().all(|(bore, rod)| rod < bore));
        assert_eq!(standard_rod(32.0), Some(12.0));
        assert_eq!(standard_rod(33.0), None);
    }
}
