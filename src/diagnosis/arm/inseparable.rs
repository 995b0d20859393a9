//! What cannot be distinguished, in sentences.

use nalgebra::DMatrix;

use super::base_parameters::{BaseParameters, Together};
use super::input::ArmInput;
use super::quantity_words::{by_owner, named, phrase};
use crate::quantity::{capital, listed};
use crate::recorded_arm::Quantity;

/// Partners that are all named; of more what they are of.
const NAMED: usize = 3;
/// Correlation of two numbers from which they can hardly be distinguished [1].
const ENTANGLED: f64 = 0.9;

/// What no motion shows, and what no motion tells apart.
#[must_use]
pub fn sentences(input: &ArmInput, base: &BaseParameters) -> Vec<String> {
    let mut all = Vec::new();
    if !base.silent.is_empty() {
        all.push(format!("Nothing shows of {}.", phrase(input, &base.silent)));
    }
    let is_gain = |t: &&Together| matches!(t.quantity, Quantity::InverseGain(_));
    let (gains, others): (Vec<_>, Vec<_>) = base.together.iter().partition(is_gain);
    if !gains.is_empty() {
        all.push(
            "Drive gains and everything that they multiply (masses, inertias, friction): only their ratios; one mass or one gain that is known fixes the others."
                .to_owned(),
        );
    }
    let mut owners: Vec<(String, Vec<&Together>)> = Vec::new();
    for together in others {
        let owner = named(input, together.quantity).owner;
        match owners.iter_mut().find(|(own, _)| *own == owner) {
            Some((_, own)) => own.push(together),
            None => owners.push((owner, vec![together])),
        }
    }
    all.extend(owners.iter().map(|(_, own)| of_owner(input, own)));
    all
}

/// What of one link, joint or sensor shows only together with others.
fn of_owner(input: &ArmInput, own: &[&Together]) -> String {
    let quantities: Vec<Quantity> = own.iter().map(|t| t.quantity).collect();
    let mut with: Vec<Quantity> = own.iter().flat_map(|t| t.with.iter().copied()).collect();
    with.sort();
    with.dedup();
    with.retain(|quantity| !quantities.contains(quantity));
    let with = if with.len() <= NAMED {
        let each = by_owner(input, &with).into_iter();
        let each = each.map(|(owner, parts)| format!("the {} of {owner}", listed(&parts)));
        listed(&each.collect::<Vec<_>>())
    } else {
        let mut owners: Vec<String> = by_owner(input, &with).into_iter().map(|(o, _)| o).collect();
        owners.sort_by_key(|owner| input.links.iter().position(|link| link == owner));
        format!("numbers of {}", listed(&owners))
    };
    format!(
        "{}: only together with {with}.",
        capital(&phrase(input, &quantities))
    )
}

/// Sets of numbers of which an interval of one hangs on the others, by the covariance of all.
#[must_use]
pub fn entangled(
    input: &ArmInput,
    quantities: &[Quantity],
    covariance: &DMatrix<f64>,
) -> Vec<String> {
    let count = quantities.len();
    let correlation =
        |i: usize, j: usize| covariance[(i, j)] / (covariance[(i, i)] * covariance[(j, j)]).sqrt();
    let mut taken = vec![false; count];
    let mut all = Vec::new();
    for first in 0..count {
        if taken[first] {
            continue;
        }
        let mut set = vec![first];
        let mut next = 0;
        taken[first] = true;
        while next < set.len() {
            let from = set[next];
            for (other, taken) in taken.iter_mut().enumerate() {
                if !*taken && correlation(from, other).abs() > ENTANGLED {
                    *taken = true;
                    set.push(other);
                }
            }
            next += 1;
        }
        if set.len() > 1 {
            set.sort_unstable();
            let own: Vec<Quantity> = set.iter().map(|i| quantities[*i]).collect();
            all.push(format!("{}.", capital(&phrase(input, &own))));
        }
    }
    all
}
