//! Faces that bound nothing: doubles, needles, fins, loose sheets, walls within the part.

use std::collections::BTreeMap;

use glam::DVec3;

use super::sides::Sides;
use super::{Flaw, Surface};

/// Triangles flatter than this share of the part's extent are needles [1].
const FLAT: f64 = 1e-9;
/// Largest share of the surface that is taken out as fins or loose faces, and as a wall within the part [1].
const FIN: f64 = 0.02;
const WALL: f64 = 0.25;

impl Surface {
    pub(super) fn has_needles(&self, size: f64) -> bool {
        (0..self.triangles.len()).any(|triangle| self.is_needle(triangle, size))
    }

    fn is_needle(&self, triangle: usize, size: f64) -> bool {
        let [a, b, c] = self.corners(triangle);
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        self.normal(triangle).length() <= FLAT * size * longest
    }

    /// Needles leave a vertex on their neighbour's side, which is joined afterwards.
    pub(super) fn take_out_needles(&mut self, size: f64) {
        let out: Vec<bool> = (0..self.triangles.len())
            .map(|triangle| self.is_needle(triangle, size))
            .collect();
        self.take_out(Flaw::Needle, &out);
    }

    fn take_out(&mut self, flaw: Flaw, out: &[bool]) {
        let gone = (0..out.len()).filter(|triangle| out[*triangle]);
        let places: Vec<DVec3> = gone.map(|triangle| self.middle(triangle)).collect();
        self.record(flaw, places);
        self.without(out);
    }

    /// A body that the file holds several times, whichever way it is wound: one stays.
    pub(super) fn take_out_copies(&mut self) {
        let key = |triangle: &[u32; 3]| {
            let mut key = *triangle;
            key.sort_unstable();
            key
        };
        let mut first: BTreeMap<[u32; 3], usize> = BTreeMap::new();
        for (index, triangle) in self.triangles.iter().enumerate() {
            first.entry(key(triangle)).or_insert(index);
        }
        if first.len() == self.triangles.len() {
            return;
        }
        let mut single: Vec<usize> = first.values().copied().collect();
        single.sort_unstable();
        let triangles: Vec<[u32; 3]> = single.iter().map(|index| self.triangles[*index]).collect();
        let sides = Sides::new(&triangles);
        let (run_of, count) = sides.runs();
        let mut closed = vec![true; count];
        for side in sides.all().filter(|side| side.half_edges.len() != 2) {
            for half_edge in side.half_edges {
                closed[run_of[half_edge as usize / 3]] = false;
            }
        }
        // Of closed bodies the triangles that stay.
        let kept: BTreeMap<[u32; 3], usize> = (single.iter().zip(&triangles).zip(run_of))
            .filter(|(_, run)| closed[*run])
            .map(|((index, triangle), _)| (key(triangle), *index))
            .collect();
        let out: Vec<bool> = (self.triangles.iter().enumerate())
            .map(|(index, triangle)| kept.get(&key(triangle)).is_some_and(|kept| *kept != index))
            .collect();
        self.take_out(Flaw::Twice, &out);
    }

    /// Of triangles with the same corners one stays where that closes the surface to its neighbours, else none.
    pub(super) fn take_out_twice(&mut self) {
        let mut same: BTreeMap<[u32; 3], Vec<usize>> = BTreeMap::new();
        for (index, triangle) in self.triangles.iter().enumerate() {
            let mut key = *triangle;
            key.sort_unstable();
            same.entry(key).or_default().push(index);
        }
        let mut out = vec![false; self.triangles.len()];
        // Triangles on each side, by its direction.
        let mut at_side: BTreeMap<[u32; 2], usize> = BTreeMap::new();
        let sides = |[a, b, c]: [u32; 3]| [[a, b], [b, c], [c, a]];
        if same.values().any(|all| all.len() > 1) {
            for side in self.triangles.iter().flat_map(|triangle| sides(*triangle)) {
                *at_side.entry(side).or_default() += 1;
            }
        }
        let count = |side: [u32; 2]| at_side.get(&side).copied().unwrap_or(0);
        for (key, all) in same.into_iter().filter(|(_, all)| all.len() > 1) {
            let ahead = |index: &usize| {
                let [a, b, c] = self.triangles[*index];
                [[a, b, c], [b, c, a], [c, a, b]].contains(&key)
            };
            let (ahead, back): (Vec<usize>, Vec<usize>) =
                all.iter().partition(|index| ahead(index));
            // Of each way the neighbours that are wound as it is, and of both together the sides with an odd number of them.
            let (mut with_ahead, mut with_back, mut open) = (0, 0, 0);
            for [from, to] in sides(key) {
                let (against, along) = (
                    count([to, from]) - back.len(),
                    count([from, to]) - ahead.len(),
                );
                with_ahead += against;
                with_back += along;
                open += (against + along) % 2;
            }
            let (more, fewer) = if (with_ahead, ahead.len()) >= (with_back, back.len()) {
                (ahead, back)
            } else {
                (back, ahead)
            };
            let kept = usize::from(open > 1);
            for index in more.into_iter().skip(kept).chain(fewer) {
                out[index] = true;
            }
        }
        self.take_out(Flaw::Twice, &out);
    }

    /// Takes out sheets with an open border and small walls, as long as that leaves fewer faulty edges.
    pub(super) fn take_out_fins(&mut self) {
        for _ in 0..8 {
            let sides = Sides::new(&self.triangles);
            let (run_of, count) = sides.runs();
            let whole = self.whole_area();
            let mut areas = vec![0.0; count];
            for (triangle, run) in run_of.iter().enumerate() {
                areas[*run] += self.area(triangle);
            }
            let mut open = vec![0_usize; count];
            // Of each run the edges of more than two triangles: all, and those that are sound without it.
            let mut shared = vec![[0_usize; 2]; count];
            for side in sides.all() {
                let runs: Vec<usize> = side
                    .half_edges
                    .iter()
                    .map(|h| run_of[*h as usize / 3])
                    .collect();
                match runs.len() {
                    1 => open[runs[0]] += 1,
                    2 => {}
                    _ => {
                        for (place, &run) in runs.iter().enumerate() {
                            if runs[..place].contains(&run) {
                                continue;
                            }
                            let left = runs.iter().filter(|other| **other != run).count();
                            shared[run][0] += 1;
                            shared[run][1] += usize::from(left % 2 == 0);
                        }
                    }
                }
            }
            let is_fin = |run: &usize| open[*run] > 0 && areas[*run] <= FIN * whole;
            let is_wall = |run: &usize| {
                let [all, sound] = shared[*run];
                open[*run] == 0 && all > 0 && all == sound && areas[*run] <= WALL * whole
            };
            let chosen = (0..count)
                .filter(is_fin)
                .min_by(|a, b| areas[*a].total_cmp(&areas[*b]));
            let odd = sides
                .all()
                .any(|side| side.half_edges.len() > 2 && side.half_edges.len() % 2 == 1);
            let wall = (0..count).filter(is_wall).filter(|_| odd);
            let chosen = chosen.or_else(|| wall.min_by(|a, b| areas[*a].total_cmp(&areas[*b])));
            let Some(chosen) = chosen else {
                return;
            };
            let out: Vec<bool> = run_of.iter().map(|run| *run == chosen).collect();
            self.take_out(Flaw::Fin, &out);
        }
    }
}
