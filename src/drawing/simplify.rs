//! Triangles taken out of bodies where that is seen least: plane faces first, round ones as little as all others.
//!
//! Sides are drawn together in the order of the error that it makes, the sum of squared distances of the kept end from the planes of all
//! triangles that met there (M. Garland, P. Heckbert, Surface simplification using quadric error metrics, SIGGRAPH 1997), as a share
//! of the size of the body. Kept corners stay where they are, so that a bore keeps its radius.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

use glam::DVec3;

/// Weight of a border's plane: what is open there would show as a gap [1].
const BORDER: f64 = 10.0;
/// Cosine beyond which a triangle may not turn in one step [1].
const TURN: f64 = 0.5;
/// Share of the squared length of a side added to its error, so that of equals the shortest goes first [1].
const LENGTH: f64 = 1e-9;

/// Bodies with corners of their own, as one set of triangles.
pub(super) struct Bodies {
    /// Corners [m].
    pub(super) corners: Vec<DVec3>,
    pub(super) triangles: Vec<[u32; 3]>,
    /// Of each corner the size of its body [m].
    pub(super) sizes: Vec<f64>,
}

/// A symmetric 4 x 4 matrix: squared distance from planes.
#[derive(Debug, Clone, Copy, Default)]
struct Quadric([f64; 10]);

impl Quadric {
    /// Of a plane through a point.
    fn plane(normal: DVec3, point: DVec3, weight: f64) -> Self {
        let [a, b, c] = normal.to_array();
        let d = -normal.dot(point);
        let terms = [
            a * a,
            a * b,
            a * c,
            a * d,
            b * b,
            b * c,
            b * d,
            c * c,
            c * d,
            d * d,
        ];
        Self(terms.map(|term| weight * term))
    }

    fn add(&mut self, other: &Self) {
        for (own, term) in self.0.iter_mut().zip(other.0) {
            *own += term;
        }
    }

    fn at(&self, point: DVec3) -> f64 {
        let [x, y, z] = point.to_array();
        let [aa, ab, ac, ad, bb, bc, bd, cc, cd, dd] = self.0;
        let squares = aa * x * x + bb * y * y + cc * z * z;
        squares + 2.0 * (ab * x * y + ac * x * z + ad * x + bc * y * z + bd * y + cd * z) + dd
    }
}

/// A side to be drawn together: its error, by bits, as errors are not negative; the end that goes, the one that stays, and their ages.
type Step = Reverse<(u64, u32, u32, [u32; 2])>;

struct Work {
    /// Corners in shares of the size of their body, about the first one, so that rounding is small.
    places: Vec<DVec3>,
    triangles: Vec<Option<[u32; 3]>>,
    around: Vec<Vec<u32>>,
    quadrics: Vec<Quadric>,
    ages: Vec<u32>,
    heap: BinaryHeap<Step>,
}

/// At most so many of the triangles, over the same corners.
pub(super) fn simplify(bodies: &Bodies, most: usize) -> Vec<[u32; 3]> {
    let mut left = bodies.triangles.len();
    if left <= most {
        return bodies.triangles.clone();
    }
    let mut work = Work::new(bodies);
    while left > most {
        let Some(Reverse((_, gone, kept, ages))) = work.heap.pop() else {
            break;
        };
        if ages == [gone, kept].map(|corner| work.ages[corner as usize])
            && work.may_draw(gone, kept)
        {
            left -= work.draw(gone, kept);
        }
    }
    work.triangles.into_iter().flatten().collect()
}

impl Work {
    fn new(bodies: &Bodies) -> Self {
        let count = bodies.corners.len();
        let origin = bodies.corners.first().copied().unwrap_or_default();
        let places = bodies.corners.iter().zip(&bodies.sizes);
        let mut work = Self {
            places: places
                .map(|(corner, size)| (*corner - origin) / *size)
                .collect(),
            triangles: bodies
                .triangles
                .iter()
                .map(|triangle| Some(*triangle))
                .collect(),
            around: vec![Vec::new(); count],
            quadrics: vec![Quadric::default(); count],
            ages: vec![0; count],
            heap: BinaryHeap::new(),
        };
        let mut sides: BTreeMap<(u32, u32), (usize, u32)> = BTreeMap::new();
        for (index, triangle) in bodies.triangles.iter().enumerate() {
            let normal = work.normal(*triangle);
            let quadric = Quadric::plane(normal, work.place(triangle[0]), 1.0);
            for corner in 0..3 {
                let (from, to) = (triangle[corner], triangle[(corner + 1) % 3]);
                work.around[from as usize].push(index as u32);
                work.quadrics[from as usize].add(&quadric);
                let side = sides
                    .entry((from.min(to), from.max(to)))
                    .or_insert((0, index as u32));
                side.0 += 1;
            }
        }
        for (&(from, to), &(count, triangle)) in &sides {
            if count == 1 {
                let along = (work.place(to) - work.place(from)).normalize_or_zero();
                let normal = work
                    .normal(bodies.triangles[triangle as usize])
                    .cross(along);
                let quadric = Quadric::plane(normal, work.place(from), BORDER);
                work.quadrics[from as usize].add(&quadric);
                work.quadrics[to as usize].add(&quadric);
            }
        }
        for &(from, to) in sides.keys() {
            work.offer(from, to);
        }
        work
    }

    fn place(&self, corner: u32) -> DVec3 {
        self.places[corner as usize]
    }

    fn normal(&self, triangle: [u32; 3]) -> DVec3 {
        let [a, b, c] = triangle.map(|corner| self.place(corner));
        (b - a).cross(c - a).normalize_or_zero()
    }

    /// Puts a side in line, with the end that goes with the smaller error.
    fn offer(&mut self, one: u32, other: u32) {
        let mut quadric = self.quadrics[one as usize];
        quadric.add(&self.quadrics[other as usize]);
        let length = LENGTH * self.place(one).distance_squared(self.place(other));
        let error = |kept: u32| quadric.at(self.place(kept)).max(0.0) + length;
        let (gone, kept) = if error(one) <= error(other) {
            (other, one)
        } else {
            (one, other)
        };
        let ages = [gone, kept].map(|corner| self.ages[corner as usize]);
        self.heap
            .push(Reverse((error(kept).to_bits(), gone, kept, ages)));
    }

    /// Whether no triangle turns over or loses its area.
    fn may_draw(&self, gone: u32, kept: u32) -> bool {
        self.around[gone as usize].iter().all(|&index| {
            let Some(triangle) = self.triangles[index as usize] else {
                return true;
            };
            if triangle.contains(&kept) || !triangle.contains(&gone) {
                return true;
            }
            let moved = triangle.map(|corner| if corner == gone { kept } else { corner });
            self.normal(triangle).dot(self.normal(moved)) > TURN
        })
    }

    /// Draws a side together; returns the triangles that it took.
    fn draw(&mut self, gone: u32, kept: u32) -> usize {
        let quadric = self.quadrics[gone as usize];
        self.quadrics[kept as usize].add(&quadric);
        let mut taken = 0;
        for index in std::mem::take(&mut self.around[gone as usize]) {
            let Some(triangle) =
                self.triangles[index as usize].filter(|triangle| triangle.contains(&gone))
            else {
                continue;
            };
            if triangle.contains(&kept) {
                self.triangles[index as usize] = None;
                taken += 1;
            } else {
                self.triangles[index as usize] =
                    Some(triangle.map(|corner| if corner == gone { kept } else { corner }));
                self.around[kept as usize].push(index);
            }
        }
        self.ages[gone as usize] += 1;
        self.ages[kept as usize] += 1;
        let triangles = &self.triangles;
        self.around[kept as usize].retain(|index| triangles[*index as usize].is_some());
        let mut near: Vec<u32> = self.around[kept as usize]
            .iter()
            .filter_map(|index| self.triangles[*index as usize])
            .flatten()
            .collect();
        near.sort_unstable();
        near.dedup();
        for other in near.into_iter().filter(|other| *other != kept) {
            self.offer(kept, other);
        }
        taken
    }
}
