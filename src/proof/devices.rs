//! Devices of the laboratory on disk: nothing missing in one, a listed effect in the next.

use std::path::Path;

use super::case_conditions::CaseConditions;
use super::error::ProofError;
use super::sweep::SEEDS_PER_DRAW;
use crate::laboratory::{EFFECTS, Recipe, write_case};

/// Seed of the first device.
const FIRST_SEED: u64 = 3_000_000;
/// Usual least share of the largest plausible effect [1].
pub const LEAST_SHARE: f64 = 0.35;
/// Golden ratio less one: its multiples, less their whole parts, are spread evenly [1].
const GOLDEN: f64 = 0.618_033_988_749_895;

/// Which devices are drawn, for laws or for effects.
#[derive(Debug, Clone, PartialEq)]
pub struct DrawPlan {
    /// Devices.
    pub count: u64,
    /// Which devices are drawn.
    pub draw: u64,
    /// Length of each recording [s].
    pub duration: f64,
    /// Conditions under which they are recorded.
    pub conditions: CaseConditions,
    /// Least and largest share of the largest plausible effect; those of a draw are spread evenly between [1].
    pub shares: [f64; 2],
}

impl DrawPlan {
    /// Seeds of the devices, where the first of the first draw has one.
    pub(super) fn seeds(&self, first: u64) -> impl Iterator<Item = u64> {
        let first = SEEDS_PER_DRAW * self.draw + first;
        first..first + self.count
    }

    fn device(&self, index: u64, seed: u64) -> Recipe {
        // A draw begins at an effect of its own.
        let number = index / 2 + 7 * self.draw;
        let effect = &EFFECTS[number as usize % EFFECTS.len()];
        let [least, most] = self.shares;
        let share = least + (most - least) * (GOLDEN * number as f64).fract();
        let (name, effects) = match index % 2 {
            0 => (format!("nothing-{seed}"), Vec::new()),
            _ => (
                format!("{}-{seed}", effect.name),
                vec![(effect.name, share)],
            ),
        };
        Recipe {
            name,
            seed,
            effects,
            law: None,
            duration: self.duration,
            conditions: self.conditions.of(seed, self.duration),
        }
    }

    /// A device by the name of its case; none that the plan does not have.
    #[must_use]
    pub fn device_named(&self, name: &str) -> Option<Recipe> {
        let seeds = (0..).zip(self.seeds(FIRST_SEED));
        let mut recipes = seeds.map(|(index, seed)| self.device(index, seed));
        recipes.find(|recipe| recipe.name == name)
    }

    /// Writes devices with and without an effect into `cases` and their truth into `sealed`; `say` gets how many are written, of how many. Returns their names.
    ///
    /// # Errors
    /// The integrator cannot go on, a file that cannot be written.
    pub fn write_devices(
        &self,
        cases: &Path,
        sealed: &Path,
        say: &dyn Fn(usize, usize),
    ) -> Result<Vec<String>, ProofError> {
        let seeds = (0..).zip(self.seeds(FIRST_SEED));
        let recipes = seeds.map(|(index, seed)| Ok(self.device(index, seed)));
        write_recipes(recipes, (cases, sealed), say)
    }
}

/// Makes the cases of recipes, into a folder of cases and one of their truth. Returns their names.
///
/// # Errors
/// Those of the recipes, of the integrator, of a file that cannot be written.
pub fn write_recipes(
    recipes: impl Iterator<Item = Result<Recipe, ProofError>>,
    (cases, sealed): (&Path, &Path),
    say: &dyn Fn(usize, usize),
) -> Result<Vec<String>, ProofError> {
    let recipes: Vec<Recipe> = recipes.collect::<Result<_, _>>()?;
    for (index, recipe) in recipes.iter().enumerate() {
        let case = recipe.make()?;
        write_case(&case, &cases.join(&recipe.name), Some(sealed))?;
        say(index + 1, recipes.len());
    }
    Ok(recipes.into_iter().map(|recipe| recipe.name).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_second_device_lacks_nothing_and_the_others_have_effects_in_turn() {
        let plan = DrawPlan {
            count: 8,
            draw: 1,
            duration: 2.0,
            conditions: CaseConditions::Laboratory,
            shares: [LEAST_SHARE, 1.0],
        };
        let seeds = (0..).zip(plan.seeds(FIRST_SEED));
        let recipes: Vec<Recipe> = seeds.map(|(i, seed)| plan.device(i, seed)).collect();
        let found: Vec<usize> = recipes.iter().map(|r| r.effects.len()).collect();
        assert_eq!(found, [0, 1, 0, 1, 0, 1, 0, 1]);
        assert_ne!(recipes[1].effects[0].0, recipes[3].effects[0].0);
        let shares = recipes.iter().flat_map(|r| &r.effects).map(|e| e.1);
        assert!(shares.into_iter().all(|s| (LEAST_SHARE..=1.0).contains(&s)));
    }
}
