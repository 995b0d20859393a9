//! What several cases know together of a family: which of its members is at work in all of them, where some share a part.
//!
//! ```text
//! P(m) ~ w(m) product over parts of Q,   w(m) = max(0.001, product of p_i(m) over that of the likeliest member)
//! Q = (1 - d) B(all) + d/2 (mean of B(all but i) + 1)           of a part that cases share
//! Q = (1 - d) + d B(all)                                       of parts that are each their own, together
//! B = int N(u; 0, T^2) product of N(u_i; u, s_i^2) du / product of N(u_i; 0, s_i^2 + T^2)          (Marshall, Rajguru and Slosar 2006)
//! u_i = k ln(v_i / nominal)
//! ```
//!
//! v_i number of the member in case i, k the power with which it scales what all of its family scale, u_i +- s_i that scale, T its prior: log-normal about nominal.
//! p_i probability of the member in case i alone, 0.01 at least. B is the odds of one value in several cases against a value for each: it grows with every value that agrees, and
//! falls where they do not. d is the doubt of what is stated: of a part that is stated to be shared, that one case has another or each its own; of parts that are
//! each their own, that they are off alike all the same (one drawing, one sheet copied).
//!
//! The cost of each case has the same penalty for each member's number, as if its prior had the same width in units of what the recordings resolve (Schwarz): so
//! has the scale here, whichever member moves it. The cases' own odds lean on the same laws and may be wrong alike: together they come to no more than the most
//! that is stated of anything.

/// Standard deviation of the prior of a scale [1]: a bore or a gain is usually 5 % off, and a bore acts by its square.
const PRIOR: f64 = 0.1;
/// Least standard deviation of a scale, as a share of its departure from nominal, and of itself [1]: what a model leaves out differs from case to case by no less,
/// and a load cell or a regulator is no more linear.
const MODEL: [f64; 2] = [0.05, 1e-3];
/// Least probability of a member in a case: below it none is named [1].
const LEAST_OF_CASE: f64 = 0.01;
/// Least odds of a member by all cases' own [1].
const LEAST: f64 = 1e-3;
/// Standard deviations of a number that is shown at the least size with nine chances in ten, at the least penalty [1].
const SHOWN: f64 = 3.0;

/// Doubt of what is stated of a part, and of parts that differ by their nominal values [1].
pub const STATED: f64 = 0.005;
/// That of parts with different identities and the same nominal value, which may come of one drawing or sheet [1].
pub const SAME_NOMINAL: f64 = 0.05;
/// That of parts of the same nominal value of which nothing is stated: they may be one, or not [1].
pub const NOT_STATED: f64 = 0.5;

/// A member of a family in one case.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InCase {
    /// Probability of the member there [1].
    pub probability: f64,
    /// The scale's logarithm and its standard deviation [1]; none where the case does not tell it.
    pub scale: Option<[f64; 2]>,
    /// Number of its part: cases with the same one share it.
    pub part: usize,
}

/// A member of a family in all cases.
#[derive(Debug, Clone, PartialEq)]
pub struct InAll {
    /// The cases, the same and in the same order for each member.
    pub cases: Vec<InCase>,
    /// Doubt of what is stated of its parts [1].
    pub doubt: f64,
}

/// Probability of each member, given that one and the same of them is at work in all cases [1].
#[must_use]
pub fn together(members: &[InAll]) -> Vec<f64> {
    let own = |m: &InAll| -> f64 {
        let all = m.cases.iter();
        all.map(|c| c.probability.max(LEAST_OF_CASE).ln()).sum()
    };
    let own: Vec<f64> = members.iter().map(own).collect();
    let likeliest = own.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let weigh =
        |(member, own): (&InAll, &f64)| (own - likeliest).max(LEAST.ln()) + member.agreement();
    let logarithms: Vec<f64> = members.iter().zip(&own).map(weigh).collect();
    let sum = log_sum(&logarithms);
    logarithms.iter().map(|l| (l - sum).exp()).collect()
}

impl InAll {
    /// Logarithm of the product of Q.
    fn agreement(&self) -> f64 {
        let mut parts: Vec<usize> = self.cases.iter().map(|c| c.part).collect();
        parts.sort_unstable();
        parts.dedup();
        if parts.len() == self.cases.len() {
            let all: Vec<[f64; 2]> = self.cases.iter().filter_map(|c| c.scale).collect();
            let alike = self.doubt.ln() + log_odds_of_one(&all);
            return log_sum(&[(1.0 - self.doubt).ln(), alike]);
        }
        let of_part = |part: &usize| {
            let ways: Vec<f64> = self.ways(*part).into_iter().map(|(way, _)| way).collect();
            log_sum(&ways)
        };
        parts.iter().map(of_part).sum()
    }

    /// Ways in which the cases of a part may have it: terms of Q by their logarithms, each with the cases that have one value.
    fn ways(&self, part: usize) -> Vec<(f64, Vec<usize>)> {
        let tells = |i: &usize| self.cases[*i].part == part && self.cases[*i].scale.is_some();
        let all: Vec<usize> = (0..self.cases.len()).filter(tells).collect();
        let but = |left: usize| {
            all.iter()
                .copied()
                .filter(|i| *i != left)
                .collect::<Vec<_>>()
        };
        let odds = |of: &[usize]| log_odds_of_one(&self.scales(of));
        let half = (0.5 * self.doubt).ln();
        let each = half - (all.len().max(1) as f64).ln();
        let apart = all.iter().map(|left| but(*left));
        let mut ways: Vec<(f64, Vec<usize>)> = apart.map(|of| (each + odds(&of), of)).collect();
        ways.push((half, Vec::new()));
        ways.push(((1.0 - self.doubt).ln() + odds(&all), all));
        ways
    }

    /// What cases say of the scale.
    fn scales(&self, cases: &[usize]) -> Vec<[f64; 2]> {
        cases.iter().filter_map(|i| self.cases[*i].scale).collect()
    }

    /// Cases of a part that have one value by the likeliest way, and that value; none where each has its own.
    #[must_use]
    pub fn one_value(&self, part: usize) -> Option<(Vec<usize>, [f64; 2])> {
        let likeliest = self
            .ways(part)
            .into_iter()
            .max_by(|a, b| a.0.total_cmp(&b.0));
        let cases = likeliest
            .map(|(_, cases)| cases)
            .filter(|c| !c.is_empty())?;
        let value = common(&self.scales(&cases));
        Some((cases, value))
    }
}

/// Logarithm of a sum of terms that are given by their logarithms.
fn log_sum(logarithms: &[f64]) -> f64 {
    let most = logarithms.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    most + logarithms
        .iter()
        .map(|l| (l - most).exp())
        .sum::<f64>()
        .ln()
}

/// Standard deviation of a scale's logarithm that is not below what a model permits [1].
fn permitted([at, deviation]: [f64; 2]) -> f64 {
    deviation.max(MODEL[0] * at.abs()).max(MODEL[1])
}

/// Logarithm of the odds of one value against a value for each.
fn log_odds_of_one(scales: &[[f64; 2]]) -> f64 {
    let [at, deviation] = common(scales);
    let alone = |scale: &[f64; 2]| {
        let own = common(&[*scale]);
        (own[1] / PRIOR).ln() + 0.5 * (own[0] / own[1]).powi(2)
    };
    (deviation / PRIOR).ln() + 0.5 * (at / deviation).powi(2)
        - scales.iter().map(alone).sum::<f64>()
}

/// The one value of several cases: logarithm of the scale, and one standard deviation [1].
fn common(scales: &[[f64; 2]]) -> [f64; 2] {
    let (mut sum, mut weight) = (0.0, PRIOR.powi(-2));
    for scale in scales {
        let own = permitted(*scale).powi(-2);
        sum += own * scale[0];
        weight += own;
    }
    [sum / weight, weight.powf(-0.5)]
}

/// What a case says of a scale that would have been named from such a logarithm on, and was not.
#[must_use]
pub fn not_shown(least: f64) -> [f64; 2] {
    [0.0, least.abs() / SHOWN]
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use rand_distr::StandardNormal;

    /// A gain of one load cell and bores that are each their own, of which the cases alone say nothing.
    fn gain_and_bore(scales: &[[f64; 2]], doubt: f64) -> [f64; 2] {
        let member = |parts: &dyn Fn(usize) -> usize, doubt| InAll {
            cases: (scales.iter().enumerate())
                .map(|(i, scale)| InCase {
                    probability: 0.5,
                    scale: Some(*scale),
                    part: parts(i),
                })
                .collect(),
            doubt,
        };
        let both = [member(&|_| 0, STATED), member(&|i| i, doubt)];
        let found = together(&both);
        [found[0], found[1]]
    }

    fn drawn(count: usize, of_each: f64, of_all: f64, deviation: f64) -> Vec<[f64; 2]> {
        let mut random = ChaCha8Rng::seed_from_u64(39);
        let mut normal = || random.sample::<f64, _>(StandardNormal);
        let mut one = || {
            [
                of_all + of_each * normal() + deviation * normal(),
                deviation,
            ]
        };
        (0..count).map(|_| one()).collect()
    }

    fn normal(x: f64, deviation: f64) -> f64 {
        (-0.5 * (x / deviation).powi(2)).exp() / (deviation * std::f64::consts::TAU.sqrt())
    }

    #[test]
    fn twelve_cases_decide_between_a_gain_of_one_load_cell_and_bores_of_their_own() {
        let gain = gain_and_bore(&drawn(12, 0.0, 1.031_f64.ln(), 2e-3), STATED);
        assert!(gain[0] > 0.99 && gain[0] < 0.999, "{gain:?}");
        let bores = gain_and_bore(&drawn(12, 0.03, 0.0, 2e-3), STATED);
        assert!(bores[1] > 0.99 && bores[1] < 0.999, "{bores:?}");
        // One load cell and one drawing: nothing tells them apart but what is stated.
        let one_sheet = gain_and_bore(&drawn(12, 0.0, 0.05, 2e-3), NOT_STATED);
        assert!((one_sheet[0] - 0.995 / 1.495).abs() < 1e-3, "{one_sheet:?}");
    }

    #[test]
    fn few_cases_or_wide_ones_leave_it_open() {
        let open = |p: [f64; 2]| p[0] > 0.2 && p[0] < 0.8;
        let wide = gain_and_bore(&[[0.03, 0.08], [0.05, 0.1]], STATED);
        assert!(open(wide), "{wide:?}");
        let nothing = gain_and_bore(&[[0.0, 0.2]; 12], STATED);
        assert!(open(nothing), "{nothing:?}");
        let one = gain_and_bore(&[[0.03, 1e-3]], STATED);
        assert!((one[0] - 0.5).abs() < 1e-12, "{one:?}");
    }

    #[test]
    fn a_model_that_errs_by_a_twentieth_is_no_proof() {
        // Values that differ by 5 % of their effect, each to a thousandth of that: not one part by their own account.
        let near: Vec<[f64; 2]> = [0.0300, 0.0315, 0.0308, 0.0301].map(|u| [u, 3e-5]).to_vec();
        let found = gain_and_bore(&near, STATED);
        assert!(
            found[0] > 0.5 && found.iter().all(|p| *p < 0.999),
            "{found:?}"
        );
        let [at, deviation] = common(&near);
        assert!(
            (at - 0.0306).abs() < 2e-4 && deviation > 5e-4,
            "{at} {deviation}"
        );
    }

    #[test]
    fn the_odds_of_one_value_are_those_of_an_integral_and_of_two_normals() {
        let scales = [[0.021, 4e-3], [0.034, 7e-3], [0.027, 2e-3]];
        let step = 1e-5;
        let integral: f64 = (-40_000..=40_000)
            .map(|i| {
                let u = step * f64::from(i);
                let likelihoods = scales.iter().map(|s| normal(s[0] - u, s[1]));
                step * normal(u, PRIOR) * likelihoods.product::<f64>()
            })
            .sum();
        let alone = |s: &[f64; 2]| normal(s[0], s[1].hypot(PRIOR));
        let apart: f64 = scales.iter().map(alone).product();
        let odds = log_odds_of_one(&scales);
        assert!((odds - (integral / apart).ln()).abs() < 1e-9, "{odds}");
        // Two of one deviation: their mean and their difference are independent.
        let (a, b, s) = (0.05, 0.062, 8e-3);
        let mean = normal(0.5 * (a + b), (0.5 * s * s + PRIOR * PRIOR).sqrt());
        let together = mean * normal(a - b, 2f64.sqrt() * s);
        let exact = (together / (alone(&[a, s]) * alone(&[b, s]))).ln();
        assert!((log_odds_of_one(&[[a, s], [b, s]]) - exact).abs() < 1e-12);
    }

    #[test]
    fn a_case_that_has_another_part_than_it_states_is_found_among_those_that_agree() {
        let mut cases: Vec<InCase> = (drawn(5, 0.0, 0.03, 1e-3).into_iter())
            .map(|scale| InCase {
                probability: 0.5,
                scale: Some(scale),
                part: 0,
            })
            .collect();
        let agree = |cases: &[InCase]| {
            let all = InAll {
                cases: cases.to_vec(),
                doubt: STATED,
            };
            all.one_value(0)
        };
        assert_eq!(agree(&cases).unwrap().0, [0, 1, 2, 3, 4]);
        cases[2].scale = Some([-0.01, 1e-3]);
        let (those, [value, _]) = agree(&cases).unwrap();
        assert_eq!(those, [0, 1, 3, 4]);
        assert!((value - 0.03).abs() < 2e-3, "{value}");
        for (i, case) in cases.iter_mut().enumerate() {
            case.scale = Some([0.02 * i as f64 - 0.04, 1e-3]);
        }
        assert_eq!(agree(&cases), None);
    }

    #[test]
    fn cases_that_say_nothing_of_it_speak_against_one_gain_and_the_own_odds_count_once() {
        let mut all = drawn(4, 0.0, 0.03, 2e-3);
        assert!(gain_and_bore(&all, STATED)[0] > 0.99);
        all.extend([not_shown(0.005); 3]);
        assert!(gain_and_bore(&all, STATED)[0] < 0.05);
        let member = |probability: f64| InAll {
            cases: (0..12)
                .map(|part| InCase {
                    probability,
                    scale: None,
                    part,
                })
                .collect(),
            doubt: STATED,
        };
        let own = together(&[member(0.3), member(0.6), member(0.0)]);
        let of = |weight: f64| weight / 1.002;
        for (own, expected) in own.iter().zip([of(1e-3), of(1.0), of(1e-3)]) {
            assert!((own - expected).abs() < 1e-12, "{own:?}");
        }
    }
}
