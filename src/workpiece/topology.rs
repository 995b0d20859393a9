//! Half-edge connectivity of a closed triangle surface.
//!
//! Half-edge `3 t + k` runs in triangle `t` from its vertex `k` to its vertex `k + 1`; its twin is
//! the same edge seen from the neighbouring triangle, running the other way.

use super::error::{EdgeFault, EdgeFlaw};

/// For each half-edge its twin.
#[derive(Debug, Clone)]
pub(crate) struct Topology {
    twins: Vec<u32>,
}

/// The triangle that a half-edge belongs to.
pub(crate) fn triangle_of(half_edge: u32) -> usize {
    (half_edge / 3) as usize
}

/// The half-edge that follows in the same triangle.
pub(crate) fn next_in_triangle(half_edge: u32) -> u32 {
    let corner = half_edge % 3;
    half_edge - corner + (corner + 1) % 3
}

/// The vertex that a half-edge starts from.
pub(crate) fn start_of(triangles: &[[u32; 3]], half_edge: u32) -> u32 {
    triangles[triangle_of(half_edge)][(half_edge % 3) as usize]
}

/// The vertex that a half-edge ends in.
pub(crate) fn end_of(triangles: &[[u32; 3]], half_edge: u32) -> u32 {
    start_of(triangles, next_in_triangle(half_edge))
}

impl Topology {
    /// Pairs all half-edges; fails with the faulty edges unless each has exactly two triangles of matching winding.
    pub(crate) fn new(triangles: &[[u32; 3]]) -> Result<Self, Vec<EdgeFault<u32>>> {
        let count = 3 * triangles.len() as u32;
        let mut sides: Vec<(u32, u32, u32)> = (0..count)
            .map(|half_edge| {
                let (from, to) = (start_of(triangles, half_edge), end_of(triangles, half_edge));
                (from.min(to), from.max(to), half_edge)
            })
            .collect();
        sides.sort_unstable();
        let mut twins = vec![u32::MAX; count as usize];
        let mut faults = Vec::new();
        for edge in sides.chunk_by(|one, other| (one.0, one.1) == (other.0, other.1)) {
            let flaw = match *edge {
                [_] => Some(EdgeFlaw::Open),
                [(_, _, first), (_, _, second)] => {
                    twins[first as usize] = second;
                    twins[second as usize] = first;
                    let same = start_of(triangles, first) == start_of(triangles, second);
                    same.then_some(EdgeFlaw::Misoriented)
                }
                _ => Some(EdgeFlaw::NonManifold),
            };
            faults.extend(flaw.map(|flaw| EdgeFault {
                flaw,
                ends: [edge[0].0, edge[0].1],
            }));
        }
        if faults.is_empty() {
            Ok(Self { twins })
        } else {
            Err(faults)
        }
    }

    /// The same edge in the neighbouring triangle.
    pub(crate) fn twin(&self, half_edge: u32) -> u32 {
        self.twins[half_edge as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TETRAHEDRON: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

    #[test]
    fn twins_run_opposite_ways() {
        let topology = Topology::new(&TETRAHEDRON).unwrap();
        for half_edge in 0..12 {
            let twin = topology.twin(half_edge);
            assert_eq!(topology.twin(twin), half_edge);
            assert_eq!(
                start_of(&TETRAHEDRON, half_edge),
                end_of(&TETRAHEDRON, twin)
            );
            assert_ne!(triangle_of(half_edge), triangle_of(twin));
        }
    }

    #[test]
    fn faults_are_counted() {
        let faults = |triangles: &[[u32; 3]]| {
            let faults = Topology::new(triangles).unwrap_err();
            [EdgeFlaw::Open, EdgeFlaw::NonManifold, EdgeFlaw::Misoriented]
                .map(|flaw| faults.iter().filter(|fault| fault.flaw == flaw).count())
        };
        assert_eq!(faults(&TETRAHEDRON[..3]), [3, 0, 0]);
        let mut flipped = TETRAHEDRON;
        flipped[3].swap(0, 1);
        assert_eq!(faults(&flipped), [0, 0, 3]);
        let mut fin = TETRAHEDRON.to_vec();
        fin.push([0, 1, 4]);
        assert_eq!(faults(&fin), [2, 1, 0]);
        let first = Topology::new(&fin).unwrap_err()[0];
        assert_eq!(
            first,
            EdgeFault {
                flaw: EdgeFlaw::NonManifold,
                ends: [0, 1]
            }
        );
    }
}
