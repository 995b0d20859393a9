//! What a file calls the joints and links of its arm.

/// Names of links and numbers of joints.
#[derive(Debug, Clone, Copy)]
pub(super) struct Names<'a> {
    /// Links behind the moving joints, base first.
    pub links: &'a [String],
    /// Number of each joint in columns, from 1, base first.
    pub numbers: &'a [usize],
}

impl Names<'_> {
    /// Place in the chain of the joint that columns give this number.
    pub fn joint(self, number: f64) -> Option<usize> {
        (self.numbers.iter()).position(|own| number == *own as f64)
    }
}
