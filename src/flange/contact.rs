//! One-sided contact with damping.
//!
//! ```text
//! N = max(0, k d (1 + c d'))  for d > 0, else 0                   (Hunt and Crossley 1975, with an exponent of 1)
//! ```
//!
//! N contact force [N], d approach of the bodies [m], k stiffness [N/m], c damping by the stiffness [s/m]. Leaves out: adhesion, a stiffness that grows as
//! the bodies flatten.

/// Contact force [N].
pub(super) fn contact_force(stiffness: f64, damping: f64, approach: f64, rate: f64) -> f64 {
    if approach > 0.0 {
        (stiffness * approach * (1.0 + damping * rate)).max(0.0)
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::contact_force;

    #[test]
    fn it_presses_and_never_pulls() {
        assert_eq!(contact_force(1e6, 0.3, 1e-4, 0.0), 100.0);
        assert_eq!(contact_force(1e6, 0.3, -1e-4, 1.0), 0.0);
        assert_eq!(contact_force(1e6, 0.3, 1e-4, -10.0), 0.0);
    }
}
