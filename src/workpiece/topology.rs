//! Half-edge connectivity of a closed triangle surface.
//!
//! Half-edge `3 t + k` runs in triangle `t` from its vertex `k` to its vertex `k + 1`; its twin is
//! the same edge seen from the neighbouring triangle, running the other way.

use super::error::MeshFault;

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
    /// Pairs all half-edges; fails unless each edge has exactly two triangles of matching winding.
    pub(crate) fn new(triangles: &[[u32; 3]]) -> Result<Self, MeshFault> {
        let count = 3 * triangles.len() as u32;
        let mut sides: Vec<(u32, u32, u32)> = (0..count)
            .map(|half_edge| {
                let (from, to) = (start_of(triangles, half_edge), end_of(triangles, half_edge));
                (from.min(to), from.max(to), half_edge)
            })
            .collect();
        sides.sort_unstable();
        let mut twins = vec![u32::MAX; count as usize];
        let (mut open, mut non_manifold, mut misoriented) = (0, 0, 0);
        for edge in sides.chunk_by(|one, other| (one.0, one.1) == (other.0, other.1)) {
            match *edge {
                [_] => open += 1,
                [(_, _, first), (_, _, second)] => {
                    if start_of(triangles, first) == start_of(triangles, second) {
                        misoriented += 1;
                    }
                    twins[first as usize] = second;
                    twins[second as usize] = first;
                }
                _ => non_manifold += 1,
            }
        }
        if open + non_manifold + misoriented > 0 {
            return Err(MeshFault::NotClosed {
                open,
                non_manifold,
                misoriented,
            });
        }
        Ok(Self { twins })
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
        let fault = |triangles: &[[u32; 3]]| Topology::new(triangles).unwrap_err();
        assert_eq!(
            fault(&TETRAHEDRON[..3]),
            MeshFault::NotClosed {
                open: 3,
                non_manifold: 0,
                misoriented: 0
            }
        );
        let mut flipped = TETRAHEDRON;
        flipped[3].swap(0, 1);
        assert_eq!(
            fault(&flipped),
            MeshFault::NotClosed {
                open: 0,
                non_manifold: 0,
                misoriented: 3
            }
        );
        let mut fin = TETRAHEDRON.to_vec();
        fin.push([0, 1, 4]);
        assert_eq!(
            fault(&fin),
            MeshFault::NotClosed {
                open: 2,
                non_manifold: 1,
                misoriented: 0
            }
        );
    }
}
