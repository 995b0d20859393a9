//! The first place of a motion at which bodies come nearer than they may, for each pair, and how deep they get.

use super::model::{CollisionModel, Links, Pair};
use super::motion::{Cubic, JointMotion};

/// Way of a pair below which the time between two moments is not halved further [m].
const FINEST: f64 = 1e-4;

/// Distance beyond which no pair is measured, but bounded [m]: the time between is halved sooner than all of a surface is looked at.
const NEAR: f64 = 0.05;

/// A place in a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// The knot before it.
    pub knot: usize,
    /// Share of the way to the next [1].
    pub share: f64,
}

/// Two bodies that come too near.
#[derive(Debug, Clone, PartialEq)]
pub struct Meeting {
    /// Their names.
    pub names: [String; 2],
    /// First place at which they do.
    pub first: Place,
    /// Knot at which they reach deepest into each other.
    pub deepest: usize,
    /// How deep they do there, or at the first place if that is more [m]; negative where they are still apart, by less than the margin.
    pub depth: f64,
    /// Clearance asked for [m].
    pub margin: f64,
}

impl CollisionModel {
    /// Pairs that stand still in the world and reach into each other.
    #[must_use]
    pub fn static_penetrations(&self) -> Vec<Meeting> {
        let links = self.links(&[0.0; crate::arm::chain::MAX_JOINTS]);
        let still = self
            .pairs
            .iter()
            .filter(|pair| pair.moved_by(&[1.0; crate::arm::chain::MAX_JOINTS]) == 0.0);
        let meets = still.filter(|pair| {
            self.distance(pair, &links, 0.0) <= pair.margin || self.is_enclosed(pair, &links)
        });
        meets
            .map(|pair| Meeting {
                names: self.named(pair),
                first: Place {
                    knot: 0,
                    share: 0.0,
                },
                deepest: 0,
                depth: self.depth(pair, &links, 0.0),
                margin: pair.margin.max(0.0),
            })
            .collect()
    }

    /// The first of the pairs that is too near at joint positions.
    #[must_use]
    pub fn meeting_at(&self, positions: &super::Positions) -> Option<Meeting> {
        let links = self.links(positions);
        let too_near = |pair: &&Pair| {
            self.distance(pair, &links, pair.margin.max(0.0)) <= pair.margin
                || self.is_enclosed(pair, &links)
        };
        let pair = self.pairs.iter().find(too_near)?;
        Some(Meeting {
            names: self.named(pair),
            first: Place {
                knot: 0,
                share: 0.0,
            },
            deepest: 0,
            depth: self.depth(pair, &links, pair.margin.max(0.0) + 1e-9),
            margin: pair.margin.max(0.0),
        })
    }

    /// The pair that comes too near first along a motion.
    #[must_use]
    pub fn first_meeting(&self, motion: &JointMotion) -> Option<Meeting> {
        let sweep = Sweep::new(self, motion);
        let found = self
            .pairs
            .iter()
            .filter_map(|pair| Some((pair, sweep.first(pair)?)));
        let order = |place: Place| place.knot as f64 + place.share;
        let (pair, place) = found.min_by(|a, b| order(a.1).total_cmp(&order(b.1)))?;
        Some(sweep.meeting(pair, place))
    }

    /// All pairs that come too near along a motion, in the order of the pairs.
    #[must_use]
    pub fn meetings(&self, motion: &JointMotion) -> Vec<Meeting> {
        let sweep = Sweep::new(self, motion);
        let found = self
            .pairs
            .iter()
            .filter_map(|pair| Some((pair, sweep.first(pair)?)));
        found
            .map(|(pair, place)| sweep.meeting(pair, place))
            .collect()
    }

    /// Whether all pairs keep their distance along a motion.
    #[must_use]
    pub fn is_free(&self, motion: &JointMotion) -> bool {
        let sweep = Sweep::new(self, motion);
        self.pairs.iter().all(|pair| sweep.first(pair).is_none())
    }
}

/// A motion with the links' poses at its knots.
/// A stretch of the way between two knots.
struct Stretch<'a> {
    cubic: &'a Cubic,
    /// Shares of the way at its ends [1].
    shares: [f64; 2],
    /// Poses of the links there.
    links: [&'a Links; 2],
    /// Distances of the pair there [m].
    apart: [f64; 2],
}

struct Sweep<'a> {
    model: &'a CollisionModel,
    motion: &'a JointMotion,
    links: Vec<Links>,
    /// Ways of the joints up to each knot.
    ways: Vec<super::Positions>,
}

impl<'a> Sweep<'a> {
    fn new(model: &'a CollisionModel, motion: &'a JointMotion) -> Self {
        let mut ways = vec![[0.0; crate::arm::chain::MAX_JOINTS]];
        for cubic in &motion.cubics {
            let mut sum = ways[ways.len() - 1];
            for (sum, way) in sum.iter_mut().zip(cubic.ways()) {
                *sum += way;
            }
            ways.push(sum);
        }
        Self {
            model,
            motion,
            links: motion.knots.iter().map(|knot| model.links(knot)).collect(),
            ways,
        }
    }

    /// Way of a pair between two knots [m], no less.
    fn way(&self, pair: &Pair, from: usize, to: usize) -> f64 {
        let mut ways = self.ways[to];
        for (way, before) in ways.iter_mut().zip(&self.ways[from]) {
            *way -= before;
        }
        pair.moved_by(&ways)
    }

    /// Distance of a pair [m], or a lower bound of it with which it is free over a way to either side; where that is long, another bound will do.
    fn distance(&self, pair: &Pair, links: &Links, way: f64) -> f64 {
        let enough = pair.margin + (0.5 * way).min(NEAR);
        self.model.distance(pair, links, enough)
    }

    /// First place at which a pair comes nearer than it may.
    fn first(&self, pair: &Pair) -> Option<Place> {
        let last = self.links.len() - 1;
        let whole = self.way(pair, 0, last);
        let start = self.distance(pair, &self.links[0], whole);
        if start <= pair.margin || self.model.is_enclosed(pair, &self.links[0]) {
            return Some(Place {
                knot: 0,
                share: 0.0,
            });
        }
        if last == 0 {
            return None;
        }
        let end = self.distance(pair, &self.links[last], whole);
        self.between(pair, [0, last], [start, end])
    }

    /// Between two knots, at the first of which the pair keeps its distance.
    fn between(&self, pair: &Pair, [from, to]: [usize; 2], apart: [f64; 2]) -> Option<Place> {
        let way = self.way(pair, from, to);
        if 0.5 * (apart[0] + apart[1] - way) > pair.margin {
            return None;
        }
        if to == from + 1 {
            let cubic = &self.motion.cubics[from];
            let stretch = Stretch {
                cubic,
                shares: [0.0, 1.0],
                links: [&self.links[from], &self.links[to]],
                apart,
            };
            return self
                .within(pair, &stretch)
                .map(|share| Place { knot: from, share });
        }
        let middle = usize::midpoint(from, to);
        let there = self.distance(pair, &self.links[middle], way);
        self.between(pair, [from, middle], [apart[0], there])
            .or_else(|| {
                if there <= pair.margin {
                    return Some(Place {
                        knot: middle,
                        share: 0.0,
                    });
                }
                self.between(pair, [middle, to], [there, apart[1]])
            })
    }

    /// Within a cubic that spans shares of the way between two knots, with the links' poses at its ends.
    fn within(&self, pair: &Pair, stretch: &Stretch<'_>) -> Option<f64> {
        let Stretch {
            cubic,
            shares: [from, to],
            links: [start, end],
            apart,
        } = *stretch;
        let way = self.short_way(pair, cubic, [start, end]);
        if 0.5 * (apart[0] + apart[1] - way) > pair.margin {
            return None;
        }
        if way < FINEST {
            return (apart[1] <= pair.margin).then_some(to);
        }
        let halves = cubic.halves();
        let middle = 0.5 * (from + to);
        let links = self.model.links(halves[0].end());
        let there = self.distance(pair, &links, way);
        let first = Stretch {
            cubic: &halves[0],
            shares: [from, middle],
            links: [start, &links],
            apart: [apart[0], there],
        };
        self.within(pair, &first).or_else(|| {
            if there <= pair.margin {
                return Some(middle);
            }
            let second = Stretch {
                cubic: &halves[1],
                shares: [middle, to],
                links: [&links, end],
                apart: [there, apart[1]],
            };
            self.within(pair, &second)
        })
    }

    /// Way of a pair along a cubic [m], no less: the lesser of both bounds.
    fn short_way(&self, pair: &Pair, cubic: &Cubic, ends: [&Links; 2]) -> f64 {
        let ways = cubic.ways();
        let mut turned = 0.0;
        let mut lever: f64 = 0.0;
        for (way, own) in ways.iter().zip(&pair.levers) {
            if *own > 0.0 {
                turned += way;
                lever = lever.max(*own);
            }
        }
        // A joint that slides moves points by its own way, which turns of others multiply.
        let remainder = 2.0 * lever.max(1.0) * turned * turned;
        let bent = 2.0 * pair.moved_by(&cubic.bends());
        let second = self.model.shift(pair, ends) + remainder + bent;
        pair.moved_by(&ways).min(second)
    }

    /// A meeting that begins at a place, with its depth.
    fn meeting(&self, pair: &Pair, first: Place) -> Meeting {
        const LOOKS: usize = 300;
        let reach = pair.margin.max(0.0) + 1e-9;
        let stride = self.links.len().div_ceil(LOOKS).max(1);
        let knots = (0..self.links.len()).step_by(stride);
        let depths = knots.map(|knot| (knot, self.model.depth(pair, &self.links[knot], reach)));
        let deepest = depths.max_by(|a, b| a.1.total_cmp(&b.1));
        let (deepest, depth) = deepest.unwrap_or((first.knot, -reach));
        Meeting {
            names: self.model.named(pair),
            first,
            deepest,
            depth,
            margin: pair.margin.max(0.0),
        }
    }
}
