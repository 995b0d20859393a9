//! A set of effects with its fit.

use super::Fit;
use super::free::Free;
use crate::effects::{Effect, UNLISTED, vocabulary};
use crate::plant::{Formula, Latent, PlantParameters};
use std::ops::Range;

/// A set of effects, fitted together with what is tolerated.
#[derive(Debug, Clone)]
pub struct Hypothesis {
    /// The effects.
    pub effects: Vec<&'static Effect>,
    /// The fit: tolerated quantities first, then the effects' in order, then phases of what is periodic in each recording.
    pub fit: Fit,
    /// Variables on which a model discrepancy depends, the surest first; empty where there is none. The term is in the description, its
    /// coefficients come last among what is free.
    pub depends_on: Vec<&'static str>,
}

impl Hypothesis {
    /// The model discrepancy, if there is one.
    pub fn unlisted(&self) -> Option<&Latent> {
        self.fit.prediction.plant.latent.as_ref()
    }

    /// The formula of the model discrepancy, if it is one.
    pub fn formula(&self) -> Option<&Formula> {
        self.unlisted()?.formula()
    }

    /// The same without the derivatives of its fit, which are most of what it takes to keep: of one that is fitted again before they are asked for.
    pub(in crate::diagnosis) fn without_columns(mut self) -> Self {
        self.fit.columns = Vec::new();
        self
    }

    /// Names of the effects, sorted.
    pub fn names(&self) -> Vec<&'static str> {
        let mut names: Vec<&'static str> = self.effects.iter().map(|e| e.name).collect();
        names.sort_unstable();
        names
    }

    /// Whether these effects are all that it takes.
    pub(in crate::diagnosis) fn is_of(&self, effects: &[&'static Effect]) -> bool {
        let mut names: Vec<&str> = effects.iter().map(|effect| effect.name).collect();
        names.sort_unstable();
        self.unlisted().is_none() && self.names() == names
    }

    /// Names of the effects as people read them, the model discrepancy last.
    pub fn effect_display_names(&self) -> Vec<String> {
        let effects = self.effects.iter();
        let unnamed = self.unlisted().map(|_| UNLISTED.to_owned());
        effects
            .map(|effect| effect_display_name(effect.name))
            .chain(unnamed)
            .collect()
    }

    /// Whether the nominal model is all that it takes.
    pub fn finds_nothing(&self) -> bool {
        self.effects.is_empty() && self.unlisted().is_none()
    }

    /// Number of the free quantities that are tolerated ones; the effects', phases and those of a model discrepancy follow.
    pub fn tolerated(&self, nominal: &PlantParameters) -> usize {
        let own: usize = self
            .effects
            .iter()
            .map(|effect| effect.parameters(nominal).len())
            .sum();
        let is_phase = |f: &&Free| self.effects.iter().any(|e| e.has_phase(&f.quantity));
        let phases = self.fit.free.iter().filter(is_phase).count();
        self.fit.free.len() - own - phases - self.unlisted().map_or(0, Latent::numbers)
    }

    /// Places of an effect's numbers among the free quantities.
    pub fn numbers_of(&self, nominal: &PlantParameters, index: usize) -> Range<usize> {
        let count = |effect: &&'static Effect| effect.parameters(nominal).len();
        let before: usize = self.effects[..index].iter().map(count).sum();
        let first = self.tolerated(nominal) + before;
        first..first + count(&self.effects[index])
    }
}

/// Whether a hypothesis has the effects of another, or laws in their place that exclude them.
pub(in crate::diagnosis) fn covers(one: &Hypothesis, other: &Hypothesis) -> bool {
    let mut others = other.effects.iter();
    others.all(|effect| one.effects.iter().any(|known| known.excludes(effect)))
}

/// Whether the effects of two hypotheses are the same but for laws that exclude one another.
pub(in crate::diagnosis) fn is_equivalent(one: &Hypothesis, other: &Hypothesis) -> bool {
    one.effects.len() == other.effects.len() && covers(one, other) && covers(other, one)
}

/// Name of an effect, with the joint that it is about.
pub fn effect_display_name(effect: &str) -> String {
    match vocabulary(effect) {
        (name, Some(joint)) => format!("{name} (joint {joint})"),
        (name, None) => name.to_owned(),
    }
}
