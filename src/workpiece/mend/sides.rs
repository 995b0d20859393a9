//! The sides of a surface's triangles, those of one edge together.

use crate::workpiece::topology::{end_of, next_in_triangle, start_of};

/// Half-edges (as in [`crate::workpiece::topology`]) in the order of their edges.
pub(super) struct Sides {
    sorted: Vec<(u32, u32, u32)>,
    /// Of each half-edge whether it runs from the lower vertex to the higher.
    forwards: Vec<bool>,
}

/// The half-edges of one edge.
pub(super) struct Side {
    /// Its vertices, the lower first.
    pub(super) ends: [u32; 2],
    pub(super) half_edges: Vec<u32>,
    /// Those that run from the lower vertex to the higher.
    pub(super) forwards: usize,
}

impl Side {
    /// Whether just two triangles of one winding meet here.
    pub(super) fn is_sound(&self) -> bool {
        self.half_edges.len() == 2 && self.forwards == 1
    }
}

impl Sides {
    pub(super) fn new(triangles: &[[u32; 3]]) -> Self {
        let count = 3 * triangles.len() as u32;
        let ends = |half_edge| (start_of(triangles, half_edge), end_of(triangles, half_edge));
        let mut sorted: Vec<(u32, u32, u32)> = (0..count)
            .map(|half_edge| {
                let (from, to) = ends(half_edge);
                (from.min(to), from.max(to), half_edge)
            })
            .collect();
        sorted.sort_unstable();
        let forwards = (0..count).map(|half_edge| ends(half_edge).0 < ends(half_edge).1);
        Self {
            sorted,
            forwards: forwards.collect(),
        }
    }

    pub(super) fn all(&self) -> impl Iterator<Item = Side> + '_ {
        let chunks = self
            .sorted
            .chunk_by(|one, other| (one.0, one.1) == (other.0, other.1));
        chunks.map(|chunk| Side {
            ends: [chunk[0].0, chunk[0].1],
            half_edges: chunk.iter().map(|side| side.2).collect(),
            forwards: chunk
                .iter()
                .filter(|side| self.forwards[side.2 as usize])
                .count(),
        })
    }

    /// Half-edges without a neighbour.
    pub(super) fn open(&self) -> impl Iterator<Item = u32> + '_ {
        self.all()
            .filter(|side| side.half_edges.len() == 1)
            .map(|side| side.half_edges[0])
    }

    /// The neighbour of each half-edge across edges of just two triangles.
    pub(super) fn twins(&self) -> Vec<Option<u32>> {
        let mut twins = vec![None; self.forwards.len()];
        for side in self.all() {
            if let [one, other] = side.half_edges[..] {
                twins[one as usize] = Some(other);
                twins[other as usize] = Some(one);
            }
        }
        twins
    }

    /// Runs of triangles that hang together over edges of just two: each triangle's run, and their number.
    pub(super) fn runs(&self) -> (Vec<usize>, usize) {
        let twins = self.twins();
        let mut run_of = vec![usize::MAX; twins.len() / 3];
        let mut count = 0;
        for seed in 0..run_of.len() {
            if run_of[seed] != usize::MAX {
                continue;
            }
            let mut waiting = vec![seed];
            run_of[seed] = count;
            while let Some(triangle) = waiting.pop() {
                for twin in twins[3 * triangle..3 * triangle + 3].iter().flatten() {
                    let other = *twin as usize / 3;
                    if run_of[other] == usize::MAX {
                        run_of[other] = count;
                        waiting.push(other);
                    }
                }
            }
            count += 1;
        }
        (run_of, count)
    }
}

/// The border's half-edge that follows an open one, about the vertex in which it ends; none where the fan leads back to it.
pub(super) fn next_on_border(twins: &[Option<u32>], half_edge: u32) -> Option<u32> {
    let mut next = next_in_triangle(half_edge);
    for _ in 0..twins.len() {
        match twins[next as usize] {
            None => return Some(next),
            Some(twin) => next = next_in_triangle(twin),
        }
    }
    None
}
