//! The device of the source paper where it differs from one that exists: seals without friction, and between slide and part no more than a soft spring.

use super::{Number, contact, cylinder};

/// Numbers of an ideal device, whatever its model file says [SI].
static IDEAL: &[(&Number, f64)] = &[
    (&cylinder::SEAL_COULOMB, 0.0),
    (&cylinder::SEAL_STATIC, 0.0),
    (&cylinder::SEAL_VISCOUS, 0.0),
    (&cylinder::SEAL_PRESSURE, 0.0),
    (&contact::CONTACT_STIFFNESS, 1.5e5),
    (&contact::CONTACT_DAMPING, 4e2),
];

impl Number {
    /// Value in an ideal device [SI]; none where that does not differ from others.
    pub fn ideal(&self) -> Option<f64> {
        let mut known = IDEAL.iter();
        known
            .find(|(number, _)| std::ptr::eq(*number, self))
            .map(|(_, value)| *value)
    }

    /// Value where a file gives none, of an ideal device or of one that exists [SI].
    pub fn default_of(&self, ideal: bool) -> f64 {
        self.ideal().filter(|_| ideal).unwrap_or(self.default)
    }
}
