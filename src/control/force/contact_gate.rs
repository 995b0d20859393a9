//! Whether the tool is on the part. Without contact there is no force to feed back, and an integral would only wind up for the impact.

/// Share of the desired force above which the tool counts as pressing [1].
const SHARE: f64 = 0.1;
/// Force below which nothing counts, three times a load cell's noise [N].
const LEAST: f64 = 3.0;

/// Whether a measured force [N] shows that the tool presses, when `desired` [N] is wanted.
pub(super) fn presses(measured: f64, desired: f64) -> bool {
    measured > (SHARE * desired).max(LEAST)
}

#[cfg(test)]
mod tests {
    use super::presses;

    #[test]
    fn noise_is_no_contact_and_a_tenth_of_the_force_is() {
        assert!(!presses(2.9, 10.0) && presses(3.1, 10.0));
        assert!(!presses(19.0, 200.0) && presses(21.0, 200.0));
    }
}
