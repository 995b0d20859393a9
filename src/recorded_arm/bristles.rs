//! How friction builds up after a reversal: bristles that bend over a length.
//!
//! ```text
//! dz/dq = (1 - z sign(q'))/d,      z -> s + (z - s) exp(-|dq|/d) over a step dq, s its sign
//! ```
//!
//! z share of the sliding friction that is reached [1], d length of the bristles [rad or m]. Source: Dahl, A solid friction model, Aerospace Corporation
//! TOR-0158(3107-18)-1, 1968; in the exact solution over a step.

/// Share of the sliding friction at each sample [1], from none at the first.
#[must_use]
pub fn bristles(position: &[f64], length: f64) -> Vec<f64> {
    let mut state = 0.0;
    let mut before = position.first().copied().unwrap_or(0.0);
    let mut out = Vec::with_capacity(position.len());
    for now in position {
        let moved = now - before;
        if moved != 0.0 {
            let sign = moved.signum();
            state = sign + (state - sign) * (-moved.abs() / length).exp();
        }
        before = *now;
        out.push(state);
    }
    out
}

/// Dry friction at each sample [N m] whose sliding value changes on the way: bristles of one stiffness, which a larger friction bends farther.
///
/// ```text
/// dF/dq = s_0 (1 - F sign(q')/g),    s_0 = F_c/d
/// ```
///
/// g sliding friction [N m], F_c what the length d is of [N m]. Source: Canudas de Wit et al., IEEE Transactions on Automatic Control 40 (1995), 419 (LuGre),
/// without its micro-damping.
#[must_use]
pub fn varying(position: &[f64], sliding: &[f64], length: f64, coulomb: f64) -> Vec<f64> {
    let mut force = 0.0;
    let mut before = position.first().copied().unwrap_or(0.0);
    let mut out = Vec::with_capacity(position.len());
    for (now, sliding) in position.iter().zip(sliding) {
        let moved = now - before;
        if moved != 0.0 {
            let aim = sliding * moved.signum();
            let own = if coulomb > 0.0 {
                length * (sliding / coulomb).abs().clamp(0.1, 10.0)
            } else {
                length
            };
            force = aim + (force - aim) * (-moved.abs() / own).exp();
        }
        before = *now;
        out.push(force);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn after_a_reversal_it_takes_a_length_times_the_logarithm_of_two_to_cross_zero() {
        let length = 1e-4;
        let there = (0..2000).map(|i| 1e-6 * f64::from(i));
        let back = (0..2000).map(|i| 2e-3 - 1e-6 * f64::from(i));
        let found = bristles(&there.chain(back).collect::<Vec<_>>(), length);
        assert!((found[1999] - 1.0).abs() < 1e-6);
        let crossing = found[2000..].iter().position(|z| *z < 0.0).unwrap();
        assert!((crossing as f64 * 1e-6 - length * 2f64.ln()).abs() < 2e-6);
    }
}
