//! A bounding-volume tree over triangles, for finding those near a point.
//!
//! A binary tree of axis-aligned boxes in one array in depth-first order: the left child follows its
//! parent, so that a walk needs only the place to go on from when a box is missed.

use glam::DVec3;

/// Most triangles in a leaf.
const LEAF_SIZE: usize = 2;

/// An axis-aligned box [m].
#[derive(Debug, Clone, Copy)]
pub(crate) struct Bounds {
    pub(crate) low: DVec3,
    pub(crate) high: DVec3,
}

impl Bounds {
    pub(crate) fn of(points: [DVec3; 3]) -> Self {
        Self {
            low: points[0].min(points[1]).min(points[2]),
            high: points[0].max(points[1]).max(points[2]),
        }
    }

    fn joined(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }

    fn centre(self) -> DVec3 {
        0.5 * (self.low + self.high)
    }

    /// Half the surface [m^2], to which the chance that a query meets the box is proportional.
    fn half_surface(self) -> f64 {
        let size = self.high - self.low;
        size.dot(DVec3::new(size.y, size.z, size.x))
    }

    /// Squared distance of a point from the box, 0 inside [m^2].
    fn distance_squared(&self, point: DVec3) -> f64 {
        (point.clamp(self.low, self.high) - point).length_squared()
    }
}

#[derive(Debug, Clone, Copy)]
struct Node {
    bounds: Bounds,
    /// Where the walk goes on when this box is missed.
    skip: u32,
    /// Items of a leaf as a range of the order; empty in an inner node.
    first: u32,
    count: u32,
}

/// The tree.
#[derive(Debug, Clone)]
pub(crate) struct Bvh {
    nodes: Vec<Node>,
    order: Vec<u32>,
}

impl Bvh {
    /// Builds the tree, from the root down.
    pub(crate) fn new(items: &[Bounds]) -> Self {
        let mut tree = Self {
            nodes: Vec::new(),
            order: (0..items.len() as u32).collect(),
        };
        if !items.is_empty() {
            tree.build(items, 0, items.len());
        }
        tree
    }

    fn build(&mut self, items: &[Bounds], from: usize, to: usize) {
        let bounds_of = |item: &u32| items[*item as usize];
        let range = &mut self.order[from..to];
        let bounds = range
            .iter()
            .map(bounds_of)
            .reduce(Bounds::joined)
            .expect("a node has at least one item");
        let node = self.nodes.len();
        let is_leaf = range.len() <= LEAF_SIZE;
        let middle = if is_leaf {
            to
        } else {
            from + split(items, range)
        };
        self.nodes.push(Node {
            bounds,
            skip: 0,
            first: from as u32,
            count: if is_leaf { (to - from) as u32 } else { 0 },
        });
        if !is_leaf {
            self.build(items, from, middle);
            self.build(items, middle, to);
        }
        self.nodes[node].skip = self.nodes.len() as u32;
    }

    /// The items in the order of the leaves, in which neighbours are close in memory.
    pub(crate) fn order(&self) -> &[u32] {
        &self.order
    }

    /// Calls `visit` with the place in [`Self::order`] of each item in a leaf whose box comes within
    /// `reach` [m] of the point.
    pub(crate) fn visit_near(&self, point: DVec3, reach: f64, mut visit: impl FnMut(usize)) {
        let limit = reach * reach;
        let mut place = 0;
        while let Some(node) = self.nodes.get(place) {
            if node.bounds.distance_squared(point) > limit {
                place = node.skip as usize;
                continue;
            }
            let range = node.first as usize..(node.first + node.count) as usize;
            range.for_each(&mut visit);
            place += 1;
        }
    }
}

/// Smaller side of a cut as a share of the items: one in so many. It bounds the depth of the tree.
const LEAST_SHARE: usize = 8;

/// Sorts the range along the axis that is best to cut, and says after how many items to cut it: where
/// the sum of both sides' surface times items is least (the surface area heuristic).
fn split(items: &[Bounds], range: &mut [u32]) -> usize {
    let bounds_of = |item: u32| items[item as usize];
    let sort = |range: &mut [u32], axis: usize| {
        range.sort_unstable_by(|&one, &other| {
            let [one_centre, other_centre] =
                [one, other].map(|item| bounds_of(item).centre()[axis]);
            one_centre.total_cmp(&other_centre).then(one.cmp(&other))
        });
    };
    let least = (range.len() / LEAST_SHARE).max(1);
    let allowed = least..=range.len() - least;
    let mut best = (f64::INFINITY, 0, range.len() / 2);
    let mut right_costs = vec![0.0; range.len()];
    for axis in 0..3 {
        sort(range, axis);
        let mut joined = bounds_of(range[range.len() - 1]);
        for place in (1..range.len()).rev() {
            joined = joined.joined(bounds_of(range[place]));
            right_costs[place] = joined.half_surface() * (range.len() - place) as f64;
        }
        joined = bounds_of(range[0]);
        for place in 1..range.len() {
            let cost = joined.half_surface() * place as f64 + right_costs[place];
            if cost < best.0 && allowed.contains(&place) {
                best = (cost, axis, place);
            }
            joined = joined.joined(bounds_of(range[place]));
        }
    }
    sort(range, best.1);
    best.2
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_all_items_in_reach_and_few_others() {
        // Small boxes along a spiral, which is dense in the middle.
        let boxes: Vec<Bounds> = (0..1000)
            .map(|i| {
                let t = f64::from(i) * 0.05;
                let centre = DVec3::new(t * t.cos(), t * t.sin(), 0.3 * t);
                Bounds {
                    low: centre - 0.1,
                    high: centre + 0.1,
                }
            })
            .collect();
        let tree = Bvh::new(&boxes);
        for i in 0..200 {
            let t = f64::from(i) * 0.3;
            let point = DVec3::new(t, -0.3 * t, 5.0);
            let mut found = Vec::new();
            tree.visit_near(point, 2.0, |place| found.push(tree.order()[place]));
            let count = found.len();
            found.sort_unstable();
            found.dedup();
            assert_eq!(found.len(), count);
            let near: Vec<u32> = (0..1000)
                .filter(|&item: &u32| boxes[item as usize].distance_squared(point) <= 4.0)
                .collect();
            assert!(near.iter().all(|item| found.binary_search(item).is_ok()));
            assert!(count <= 4 * near.len() + 40, "{count} {}", near.len());
        }
        Bvh::new(&[]).visit_near(DVec3::ZERO, 1.0, |_| panic!("nothing to visit"));
    }

    #[test]
    fn equal_boxes_do_not_make_a_deep_tree() {
        let same = Bounds {
            low: DVec3::ZERO,
            high: DVec3::ONE,
        };
        let tree = Bvh::new(&vec![same; 20_000]);
        let mut count = 0;
        tree.visit_near(DVec3::ZERO, 0.1, |_| count += 1);
        assert_eq!(count, 20_000);
    }
}
