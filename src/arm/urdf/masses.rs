//! Masses that the file does not give: by key, or estimated from the links' shapes and the robot's whole mass.

use super::solid::{of_density_one, rod, with_mass};
use super::tree::{Placed, Tree};
use super::{ArmOptions, CollisionShape, Refusal};
use crate::arm::chain::BodyInertia;

/// What is known of masses beside the file's.
pub(super) struct Masses<'a> {
    pub options: &'a ArmOptions,
    /// Shapes, each with the place in the tree of the link of the file that it belongs to.
    pub shapes: &'a [(usize, CollisionShape)],
    /// Links whose file gives a mass, but no inertia.
    pub without_inertia: &'a [String],
}

impl Masses<'_> {
    /// Whether shapes are asked for.
    pub fn needs_shapes(options: &ArmOptions, without_inertia: &[String]) -> bool {
        let by_key = !options.link_masses.is_empty() || options.whole_mass.is_some();
        by_key || !without_inertia.is_empty()
    }

    /// Checks that the links named by keys are there and move.
    pub fn check(&self, tree: &Tree) -> Result<(), Refusal> {
        let refused = |link: &String, why| {
            Err(Refusal::MassUnknown {
                link: link.clone(),
                why,
            })
        };
        for link in self.options.link_masses.keys() {
            match tree.index_of(link) {
                None => return refused(link, "the arm does not have"),
                Some(0) => return refused(link, "belongs to the base and stands still"),
                Some(_) => {}
            }
        }
        Ok(())
    }

    /// The body of a link of the file with the mass that a key gives it, in its own frame, and whether where its mass lies is estimated from its shape.
    pub fn given(
        &self,
        place: usize,
        placed: &Placed,
        body: BodyInertia,
    ) -> Result<(BodyInertia, bool), Refusal> {
        let name = &placed.link.name;
        let by_key = self.options.link_masses.get(name).copied();
        let without = self.without_inertia.contains(name)
            || (by_key.is_some() && body.inertia == glam::DMat3::ZERO);
        let unspread = without && body.mass > 0.0;
        let mass = match by_key {
            Some(mass) if body.mass > 0.0 && !unspread => {
                return Ok((with_mass(&body, mass), false));
            }
            Some(mass) => mass,
            None if unspread => body.mass,
            None => return Ok((body, false)),
        };
        let own = self.shapes.iter().filter(|(owner, _)| *owner == place);
        let solid = of_density_one(own.map(|(_, shape)| shape));
        let seen = solid.seen_from(&placed.moving_from_link.inverse());
        let shape = if seen.mass > 0.0 {
            seen
        } else {
            rod(glam::DVec3::ZERO)
        };
        let mut spread = with_mass(&shape, mass);
        if unspread && body.mass > 0.0 {
            spread.centre_of_mass = body.centre_of_mass;
        }
        Ok((spread, true))
    }

    /// Bodies of the moving links that have no mass at all, in their frames: their shares, by volume, of what the known masses leave of the robot's.
    pub fn estimate(
        &self,
        tree: &Tree,
        own: &[(BodyInertia, bool)],
    ) -> Result<Vec<Option<BodyInertia>>, Refusal> {
        let count = tree.moving.len();
        let mut known = vec![0.0; count + 1];
        for (placed, (body, _)) in tree.placed.iter().zip(own) {
            known[placed.link_index] += body.mass;
        }
        let lacking: Vec<usize> = (1..=count).filter(|index| known[*index] <= 0.0).collect();
        let mut found = vec![None; count];
        let Some(&first) = lacking.first() else {
            return Ok(found);
        };
        let Some(whole) = self.options.whole_mass else {
            if self.options.is_recorded {
                return Ok(found);
            }
            return Err(Refusal::NoMass {
                link: tree.link_names()[first].clone(),
                why: "no <inertial> with a mass in it or in what is fixed to it",
            });
        };
        let solids: Vec<BodyInertia> = (0..=count)
            .map(|index| {
                let own = self.shapes.iter().map(|(_, shape)| shape);
                of_density_one(own.filter(|shape| shape.link_index == index))
            })
            .collect();
        let solids: Vec<BodyInertia> = solids
            .into_iter()
            .enumerate()
            .map(|(index, solid)| match index {
                _ if solid.mass > 0.0 || index == 0 => solid,
                _ => rod(next_joint(tree, index)),
            })
            .collect();
        let weighed: f64 = known.iter().sum();
        let left = whole - weighed;
        if left <= 0.0 {
            return Err(Refusal::WholeMass {
                whole,
                known: weighed,
            });
        }
        let base = if known[0] > 0.0 { 0.0 } else { solids[0].mass };
        let volume: f64 = base + lacking.iter().map(|i| solids[*i].mass).sum::<f64>();
        for index in lacking {
            let share = left * solids[index].mass / volume;
            found[index - 1] = Some(with_mass(&solids[index], share));
        }
        Ok(found)
    }
}

/// Where the next joint, or the tip, is in the frame of a moving link [m].
fn next_joint(tree: &Tree, index: usize) -> glam::DVec3 {
    match tree.moving.get(index) {
        Some(next) => next.parent_from_joint.translation,
        None => tree.tip_from_last.translation,
    }
}
