//! A line in segments, each a resistance and then a volume: all but the last eliminated from an implicit step.
//!
//! ```text
//! c (p_j - h_j) = (p_{j-1} - p_j)/r - (p_j - p_{j+1})/r,     c = V/(N R T share)      (telegraph equation without inertia, in N segments)
//! p_j = A_j + B_j p_{j+1},   B_j = k/D_j,   A_j = (h_j + k A_{j-1})/D_j,   D_j = 1 + k (2 - B_{j-1}),   k = 1/(c r)      (Thomas's elimination)
//! ```
//!
//! p_0 pressure before the line, A_0 = p_0, B_0 = 0; h_j pressure that a segment keeps from the earlier stages; r resistance of a segment [Pa s/kg].
//! The last segment sees a pressure A/(1 - B) behind a resistance r/(1 - B).

/// Segments of a line at most: there its step response is within 1 % of the limit of many.
pub const MOST_SEGMENTS: usize = 8;
/// Segments before the last at most.
pub const UPSTREAM: usize = MOST_SEGMENTS - 1;

/// An implicit step of the segments before the last.
#[derive(Debug, Clone, Copy)]
pub struct LineChain {
    /// Their number.
    count: usize,
    /// Resistance of a segment [Pa s/kg].
    resistance: f64,
    /// k [1].
    exchange: f64,
    /// Pressures that the segments keep [Pa absolute].
    held: [f64; UPSTREAM],
    /// B_j [1].
    shares: [f64; UPSTREAM],
}

impl LineChain {
    /// Segments of a resistance [Pa s/kg] and a storage c [kg/(s Pa)], from the pressures that they keep [Pa absolute].
    pub fn new(resistance: f64, storage: f64, held: &[f64]) -> Self {
        let mut chain = Self {
            count: held.len(),
            resistance,
            exchange: 1.0 / (storage * resistance),
            held: [0.0; UPSTREAM],
            shares: [0.0; UPSTREAM],
        };
        let mut before = 0.0;
        for (j, pressure) in held.iter().enumerate() {
            chain.held[j] = *pressure;
            chain.shares[j] = chain.exchange / (1.0 + chain.exchange * (2.0 - before));
            before = chain.shares[j];
        }
        chain
    }

    /// Resistance that the last segment sees [Pa s/kg].
    pub fn resistance(&self) -> f64 {
        self.resistance / (1.0 - self.last_share())
    }

    fn last_share(&self) -> f64 {
        match self.count {
            0 => 0.0,
            count => self.shares[count - 1],
        }
    }

    /// A_j for a pressure before the line [Pa absolute].
    fn offsets(&self, before: f64) -> [f64; UPSTREAM] {
        let mut offsets = [0.0; UPSTREAM];
        let (mut last, mut share) = (before, 0.0);
        let segments = offsets.iter_mut().zip(&self.held).zip(&self.shares);
        for ((offset, held), own) in segments.take(self.count) {
            let divisor = 1.0 + self.exchange * (2.0 - share);
            last = (held + self.exchange * last) / divisor;
            share = *own;
            *offset = last;
        }
        offsets
    }

    /// Pressure that the last segment sees [Pa absolute] for one before the line.
    pub fn seen(&self, before: f64) -> f64 {
        match self.count {
            0 => before,
            count => self.offsets(before)[count - 1] / (1.0 - self.last_share()),
        }
    }

    /// d seen / d before [1].
    pub fn gain(&self) -> f64 {
        let product: f64 = self.shares[..self.count].iter().product();
        product / (1.0 - self.last_share())
    }

    /// Pressures of the segments before the last [Pa absolute] from that before the line and that in the last.
    pub fn pressures(&self, before: f64, last: f64) -> [f64; UPSTREAM] {
        let mut pressures = self.offsets(before);
        let mut next = last;
        for j in (0..self.count).rev() {
            pressures[j] += self.shares[j] * next;
            next = pressures[j];
        }
        pressures
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_segments_balances_are_met_and_the_last_sees_its_equivalent() {
        let (r, c) = (3e7, 4e-9);
        let held = [2.1e5, 1.9e5, 1.8e5];
        let chain = LineChain::new(r, c, &held);
        let (before, last) = (3e5, 1.5e5);
        let p = chain.pressures(before, last);
        let all = [before, p[0], p[1], p[2], last];
        for j in 1..4 {
            let flow = (all[j - 1] - all[j]) / r - (all[j] - all[j + 1]) / r;
            assert!((c * (all[j] - held[j - 1]) / flow - 1.0).abs() < 1e-9);
        }
        let inflow = (p[2] - last) / r;
        let seen = (chain.seen(before) - last) / chain.resistance();
        assert!((seen / inflow - 1.0).abs() < 1e-12);
        let gain = (chain.seen(before + 1e3) - chain.seen(before)) / 1e3;
        assert!((gain / chain.gain() - 1.0).abs() < 1e-9);
    }

    #[test]
    fn in_no_time_every_segment_keeps_its_pressure() {
        let chain = LineChain::new(2.0, f64::INFINITY, &[7.0, 6.0]);
        assert_eq!(chain.pressures(9.0, 1.0)[..2], [7.0, 6.0]);
        assert_eq!((chain.seen(9.0), chain.resistance()), (6.0, 2.0));
    }
}
