//! Faces wound against their neighbours: of what hangs together the smaller share is turned.

use glam::DVec3;

use super::sides::Sides;
use super::{Flaw, Surface};
use crate::workpiece::topology::start_of;

impl Surface {
    pub(super) fn turn(&mut self) {
        let twins = Sides::new(&self.triangles).twins();
        let agrees = |half_edge: u32, twin: u32| {
            start_of(&self.triangles, half_edge) != start_of(&self.triangles, twin)
        };
        // Of each triangle whether it is turned against the first of its run.
        let mut turned: Vec<Option<bool>> = vec![None; self.triangles.len()];
        let mut out = vec![false; self.triangles.len()];
        for seed in 0..turned.len() {
            if turned[seed].is_some() {
                continue;
            }
            turned[seed] = Some(false);
            let (mut run, mut waiting) = (vec![seed], vec![seed]);
            let mut one_sided = false;
            while let Some(triangle) = waiting.pop() {
                let own = turned[triangle] == Some(true);
                for half_edge in 3 * triangle as u32..3 * triangle as u32 + 3 {
                    let Some(twin) = twins[half_edge as usize] else {
                        continue;
                    };
                    let other = twin as usize / 3;
                    let expected = own == agrees(half_edge, twin);
                    match turned[other] {
                        None => {
                            turned[other] = Some(expected);
                            run.push(other);
                            waiting.push(other);
                        }
                        Some(found) => one_sided |= found != expected,
                    }
                }
            }
            let share = |way: bool| {
                run.iter()
                    .filter(|t| turned[**t] == Some(way))
                    .map(|t| self.area(*t))
                    .sum::<f64>()
            };
            let fewer = share(true) <= share(false);
            // A surface of one side cannot be wound one way.
            if !one_sided {
                for triangle in run {
                    out[triangle] = turned[triangle] == Some(fewer);
                }
            }
        }
        let places: Vec<DVec3> = (0..out.len())
            .filter(|t| out[*t])
            .map(|t| self.middle(t))
            .collect();
        for (triangle, _) in self.triangles.iter_mut().zip(&out).filter(|(_, out)| **out) {
            triangle.swap(1, 2);
        }
        self.record(Flaw::Turned, places);
    }
}
