//! Which cases there are: those that the project ships, and the sizes of a sweep.

use super::case::Recipe;
use super::conditions::Conditions;
use super::dirt::Dirt;
use super::trajectory::LaboratoryError;

/// Visibility of an effect at its least size, beside all that is tolerated, in standard deviations [1]. A test that looks for one number in ten thousand
/// readings, and at dozens of effects, asks for some 20 of twice the log-likelihood (Schwarz's ln n, and as much for having looked at so many): 4^2 is
/// short of it, whatever the test.
pub const LOST: f64 = 4.0;
/// Ratio of the shares at which an effect is looked at on the way down [1].
const STEP: f64 = 1.0 / 3.0;
/// Halvings, in the logarithm, of the step in which it is lost.
const HALVINGS: usize = 5;
/// Least share [1]: an effect that shows even then is not lost.
const LEAST: f64 = 1e-3;

/// Shares of the largest plausible effect: 1, and in equal ratios down to the one at which it is lost.
///
/// # Errors
/// The integrator cannot go on.
///
/// # Panics
/// An effect that does not exist.
pub fn sizes(
    effect: &'static str,
    seed: u64,
    duration: f64,
    count: usize,
) -> Result<Vec<f64>, LaboratoryError> {
    let lost = if count > 1 {
        lost_share(effect, seed, duration)?
    } else {
        1.0
    };
    let step = |size: usize| size as f64 / (count.max(2) - 1) as f64;
    Ok((0..count).map(|size| lost.powf(step(size))).collect())
}

fn lost_share(effect: &'static str, seed: u64, duration: f64) -> Result<f64, LaboratoryError> {
    let recipe = Recipe {
        name: effect.to_owned(),
        seed,
        effects: Vec::new(),
        law: None,
        duration,
        conditions: Conditions::default(),
    };
    let mut shows = recipe.visibility(effect)?;
    let mut seen = 1.0;
    if shows(seen)? <= LOST {
        return Ok(seen);
    }
    let mut lost = STEP;
    while shows(lost)? > LOST {
        seen = lost;
        lost *= STEP;
        if lost < LEAST {
            return Ok(LEAST);
        }
    }
    for _ in 0..HALVINGS {
        let middle = (seen * lost).sqrt();
        if shows(middle)? > LOST {
            seen = middle;
        } else {
            lost = middle;
        }
    }
    Ok(lost)
}

/// The cases that the project ships: recordings of 4 s.
pub fn shipped() -> Vec<Recipe> {
    let recipe = |name: &str, seed: u64, effects: &[(&'static str, f64)]| Recipe {
        name: name.to_owned(),
        seed,
        effects: effects.to_vec(),
        law: None,
        duration: 4.0,
        conditions: Conditions::default(),
    };
    let dirty = |recipe: Recipe| Recipe {
        conditions: Conditions {
            dirt: Some(Dirt::USUAL),
            ..Conditions::default()
        },
        ..recipe
    };
    vec![
        recipe("case-01", 101, &[]),
        recipe("case-02", 102, &[("coulomb_viscous_friction", 1.0)]),
        recipe("case-03", 103, &[("transport_delay", 0.4)]),
        recipe("case-04", 104, &[("hose_volume", 1.0)]),
        recipe("case-05", 105, &[("force_sensor_gain_error", 1.0)]),
        recipe(
            "case-06",
            106,
            &[("cross_piston_leakage", 1.0), ("tool_runout", 1.0)],
        ),
        recipe("case-07", 107, &[("sticky_spot", 1.0)]),
        dirty(recipe("case-08", 108, &[("return_spring_load", 1.0)])),
        dirty(recipe("case-09", 109, &[])),
        recipe("case-10", 110, &[("heat_transfer", 0.4)]),
    ]
}
