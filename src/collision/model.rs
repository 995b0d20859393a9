//! The bodies of a cell and the pairs of them that are checked.

use std::collections::BTreeMap;

use glam::DVec3;
use glamx::DPose3;

use super::Positions;
use super::ball::{ALLOWED, RiddenEdge};
use super::body::{Body, Mount, SolidError};
use crate::arm::chain::{JointKind, KinematicChain, MAX_JOINTS};
use crate::arm::kinematics::link_poses;

/// Depth to which bodies that stand still may reach into each other [m]: a robot bolted to a table stands on its surface or a little in it.
const SETTLED: f64 = 1e-3;

/// A bound that decides lies at least this far beyond a margin [m].
const BEYOND: f64 = 1e-5;

/// What a body is in the cell, by which its pairs are chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// The arm's base or one of its links.
    Robot,
    /// The device's cylinders.
    Device,
    /// The device's slide and the tool on it beside its ball: it works on the part, without a margin.
    Tool,
    /// The part.
    Part,
    /// An obstacle.
    Obstacle,
    /// The floor.
    Floor,
}

impl Role {
    fn in_words(self) -> &'static str {
        match self {
            Self::Robot => "a link of the arm",
            Self::Device => "the device",
            Self::Tool => "the tool",
            Self::Part => "the part",
            Self::Obstacle => "an obstacle",
            Self::Floor => "the floor",
        }
    }
}

/// Description of a model.
pub struct ModelRequest<'a> {
    /// The arm with the device's slide as its last joint.
    pub chain: &'a KinematicChain,
    /// Its base in the world.
    pub world_from_base: DPose3,
    /// All bodies.
    pub bodies: Vec<(Role, Body)>,
    /// The ball and what it rides.
    pub ridden: Option<RiddenEdge>,
    /// Least clearance [m].
    pub margin: f64,
    /// Bodies that may meet, by name.
    pub allowed: &'a [[String; 2]],
}

/// A model that cannot be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ModelError {
    /// A body without volume.
    #[error("the collision shape of {body} is refused: {source}")]
    Solid {
        /// The body.
        body: String,
        /// Why.
        source: SolidError,
    },
    /// The robot collides with itself where its joints are at zero.
    #[error("with all joints at zero, or at the limit nearest to it, {first} and {second} reach {:.1} mm into each other; joints lie between them, so their shapes cannot be right: mend the URDF's collision geometry, or let them meet with collision.allowed_pairs = [[\"{first}\", \"{second}\"]]", 1e3 * depth)]
    AtRest {
        /// One link.
        first: String,
        /// The other.
        second: String,
        /// Depth [m].
        depth: f64,
    },
    /// Two bodies of one name, of which nothing else could tell which is meant.
    #[error(
        "`{name}` is the name of {first} and of {second}, expected different names: give an obstacle another (`name` in [[obstacle]]), a link in the URDF file"
    )]
    SameName {
        /// The name.
        name: String,
        /// What the one is.
        first: &'static str,
        /// What the other is.
        second: &'static str,
    },
    /// A pair that may meet names a body that is not there.
    #[error("collision.allowed_pairs names {name}, expected bodies of the cell: {known}")]
    UnknownBody {
        /// The name.
        name: String,
        /// Those there are.
        known: String,
    },
}

/// Two bodies that must not meet.
#[derive(Debug, Clone)]
pub struct Pair {
    /// Number of the body that more joints move.
    pub(super) moved: usize,
    /// Number of the other; none for the ball on the part.
    pub(super) other: Option<usize>,
    /// Farthest that a point of the one gets from each joint between them [m], or 1 of a sliding one.
    pub(super) levers: Positions,
    /// Least clearance [m].
    pub(super) margin: f64,
}

impl Pair {
    /// Way that points of the one may have moved against the other with ways of the joints [m], no less.
    pub(super) fn moved_by(&self, ways: &Positions) -> f64 {
        self.levers
            .iter()
            .zip(ways)
            .map(|(lever, way)| lever * way)
            .sum()
    }
}

/// A body where it is in the world.
#[derive(Debug, Clone, PartialEq)]
pub struct PlacedBody<'a> {
    /// What it is in the cell.
    pub role: Role,
    /// Its name.
    pub name: &'a str,
    /// Whether a joint moves it.
    pub moves: bool,
    /// Corners of its surface in the world [m]; of round shapes those of an inscribed one.
    pub corners: Vec<DVec3>,
}

/// The bodies of a cell and the pairs of them that are checked.
#[derive(Clone)]
pub struct CollisionModel {
    pub(super) chain: KinematicChain,
    pub(super) world_from_base: DPose3,
    pub(super) bodies: Vec<(Role, Body)>,
    pub(super) ridden: Option<RiddenEdge>,
    pub(super) pairs: Vec<Pair>,
    /// A sphere about each body, in its frame: centre and radius [m].
    spheres: Vec<(DVec3, f64)>,
    /// Pairs of the robot's own that touch at rest and are left out, by name.
    pub touching_at_rest: Vec<[String; 2]>,
}

/// Poses of all links at joint positions.
pub(super) type Links = [DPose3; MAX_JOINTS];

impl CollisionModel {
    /// Chooses the pairs: not those that a joint connects, nor those with one link between them that touch at rest.
    ///
    /// # Errors
    /// The robot collides with itself at rest, or a pair that may meet names no body.
    pub fn new(request: ModelRequest<'_>) -> Result<Self, ModelError> {
        let mut model = Self {
            chain: request.chain.clone(),
            world_from_base: request.world_from_base,
            spheres: request
                .bodies
                .iter()
                .map(|(_, body)| body.sphere())
                .collect(),
            bodies: request.bodies,
            ridden: request.ridden,
            pairs: Vec::new(),
            touching_at_rest: Vec::new(),
        };
        model.check_names(request.allowed)?;
        let allowed = |one: &str, two: &str| {
            let is = |pair: &[String; 2]| {
                (pair[0] == one && pair[1] == two) || (pair[0] == two && pair[1] == one)
            };
            request.allowed.iter().any(is)
        };
        let links = model.links(&model.rest());
        for second in 0..model.bodies.len() {
            for first in 0..second {
                let names = [first, second].map(|body| model.bodies[body].1.name.clone());
                if !allowed(&names[0], &names[1])
                    && let Some(pair) = model.pair(first, second, request.margin, &links)?
                {
                    model.pairs.push(pair);
                }
            }
        }
        model.pairs.extend(model.ball_pair());
        Ok(model)
    }

    fn check_names(&self, allowed: &[[String; 2]]) -> Result<(), ModelError> {
        // The floor is drawn nowhere, and obstacles may be one.
        let named = self.bodies.iter().filter(|(role, _)| *role != Role::Floor);
        let mut known = BTreeMap::new();
        for (role, body) in named {
            if let Some(first) = known.insert(&body.name, *role) {
                return Err(ModelError::SameName {
                    name: body.name.clone(),
                    first: first.in_words(),
                    second: role.in_words(),
                });
            }
        }
        let is_body = |name: &&String| self.bodies.iter().any(|(_, body)| body.name == **name);
        match allowed.iter().flatten().find(|name| !is_body(name)) {
            None => Ok(()),
            Some(name) => Err(ModelError::UnknownBody {
                name: name.clone(),
                known: self.names().collect::<Vec<_>>().join(", "),
            }),
        }
    }

    /// Names of its bodies.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.bodies.iter().map(|(_, body)| body.name.as_str())
    }

    /// Pairs of bodies that are checked, by name; not that of the ball on the part.
    pub fn checked(&self) -> impl Iterator<Item = [String; 2]> {
        let pairs = self.pairs.iter().filter(|pair| pair.other.is_some());
        pairs.map(|pair| self.named(pair))
    }

    /// Its bodies.
    pub fn bodies(&self) -> impl Iterator<Item = &Body> {
        self.bodies.iter().map(|(_, body)| body)
    }

    /// Its bodies, and what each is in the cell.
    pub fn bodies_with_roles(&self) -> impl Iterator<Item = &(Role, Body)> {
        self.bodies.iter()
    }

    /// Its bodies in the world with the joints at positions; without, those that stand.
    pub fn placed_at(&self, positions: Option<&[f64]>) -> Vec<PlacedBody<'_>> {
        let mut all = [0.0; MAX_JOINTS];
        for (joint, position) in all.iter_mut().zip(positions.unwrap_or_default()) {
            *joint = *position;
        }
        let links = self.links(&all);
        let shown = self.bodies.iter();
        let shown = shown.filter(|(_, body)| positions.is_some() || body.mount.joints() == 0);
        shown
            .map(|(role, body)| {
                let pose = body.mount.pose(&links);
                let solids = body.solids.iter().flat_map(|solid| solid.triangles().0);
                PlacedBody {
                    role: *role,
                    name: &body.name,
                    moves: body.mount.joints() > 0,
                    corners: solids.map(|corner| pose.transform_point(corner)).collect(),
                }
            })
            .collect()
    }

    /// All joints at zero, or at the limit nearest to it.
    fn rest(&self) -> Positions {
        let mut rest = [0.0; MAX_JOINTS];
        for (value, joint) in rest.iter_mut().zip(&self.chain.joints) {
            *value = 0f64.clamp(joint.lower, joint.upper);
        }
        rest
    }

    /// Poses of the links at joint positions.
    pub(super) fn links(&self, positions: &Positions) -> Links {
        let count = self.chain.len();
        let mut links = [DPose3::IDENTITY; MAX_JOINTS];
        link_poses(
            &self.chain,
            self.world_from_base,
            &positions[..count],
            &mut links[..count],
        );
        links
    }

    /// The pair of two bodies, if it is to be checked.
    fn pair(
        &mut self,
        first: usize,
        second: usize,
        margin: f64,
        links: &Links,
    ) -> Result<Option<Pair>, ModelError> {
        use Role::{Device, Floor, Obstacle, Part, Robot, Tool};
        let joints = [first, second].map(|body| self.bodies[body].1.mount.joints());
        let (moved, other) = if joints[0] > joints[1] {
            (first, second)
        } else {
            (second, first)
        };
        let fewer = joints[0].min(joints[1]);
        let between = joints[0].max(joints[1]) - fewer;
        let roles = [self.bodies[first].0, self.bodies[second].0];
        let margin = match roles {
            [Robot | Device | Tool, Robot | Device | Tool] if between <= 1 => return Ok(None),
            // Of the arm's shapes what touches at rest is made so; what is mounted on it may be in its way.
            [Robot, Robot] => {
                if self.touch_at_rest([moved, other], between, margin, links)? {
                    return Ok(None);
                }
                margin
            }
            // Obstacles and the floor are each other's business; the base stands on the floor.
            [Obstacle | Floor, Obstacle] | [Obstacle, Floor] => {
                return Ok(None);
            }
            [Robot, Floor] if between == 0 => return Ok(None),
            [Tool, Part] => 0.0,
            _ if between == 0 => -SETTLED,
            _ => margin,
        };
        let levers = self.levers(moved, fewer);
        Ok(Some(Pair {
            moved,
            other: Some(other),
            levers,
            margin,
        }))
    }

    /// Whether two bodies of the robot, nearer than the margin at rest, are left out.
    fn touch_at_rest(
        &mut self,
        [moved, other]: [usize; 2],
        between: usize,
        margin: f64,
        links: &Links,
    ) -> Result<bool, ModelError> {
        let [a, b] = [moved, other].map(|body| &self.bodies[body].1);
        let poses = [a, b].map(|body| body.mount.pose(links));
        if a.distance(poses[0], b, poses[1], margin) > margin {
            return Ok(false);
        }
        let depth = a.depth(poses[0], b, poses[1], margin).unwrap_or(0.0);
        let [first, second] = [b.name.clone(), a.name.clone()];
        if between > 2 && depth > SETTLED {
            return Err(ModelError::AtRest {
                first,
                second,
                depth,
            });
        }
        if between <= 2 {
            self.touching_at_rest.push([first, second]);
        }
        Ok(between <= 2)
    }

    /// Farthest that points of a body get from each joint after the first `from` that moves it.
    fn levers(&self, body: usize, from: usize) -> Positions {
        let body = &self.bodies[body].1;
        self.levers_of(body.extent(), body.mount.joints(), from)
    }

    fn levers_of(&self, extent: f64, joints: usize, from: usize) -> Positions {
        let mut levers = [0.0; MAX_JOINTS];
        let mut reach = extent;
        for index in (from..joints).rev() {
            let joint = &self.chain.joints[index];
            let travel = match joint.kind {
                JointKind::Revolute => {
                    levers[index] = reach;
                    0.0
                }
                JointKind::Prismatic => {
                    levers[index] = 1.0;
                    joint.lower.abs().max(joint.upper.abs())
                }
            };
            reach += joint.parent_from_joint.translation.length() + travel;
        }
        levers
    }

    fn ball_pair(&self) -> Option<Pair> {
        let ridden = self.ridden.as_ref()?;
        let joints = self.chain.len();
        let tool = self
            .bodies
            .iter()
            .position(|(role, _)| *role == Role::Tool)?;
        Some(Pair {
            moved: tool,
            other: None,
            levers: self.levers_of(ridden.centre.length(), joints, 0),
            margin: -ALLOWED * ridden.radius,
        })
    }

    /// Distance of a pair [m]; a lower bound of it, more than its margin and no less than `enough`, where that is more.
    pub(super) fn distance(&self, pair: &Pair, links: &Links, enough: f64) -> f64 {
        let enough = enough.max(pair.margin.max(0.0) + BEYOND);
        let moved = &self.bodies[pair.moved].1;
        let at = moved.mount.pose(links);
        match (pair.other, &self.ridden) {
            (Some(other), _) => {
                let other = &self.bodies[other].1;
                let other_at = other.mount.pose(links);
                let distance = moved.distance(at, other, other_at, enough);
                // Standing bodies that are settled into each other, no deeper than the pair's margin.
                if distance <= 0.0 && pair.margin < 0.0 {
                    return -moved.depth(at, other, other_at, 0.0).unwrap_or(0.0);
                }
                distance
            }
            (None, Some(ridden)) => ridden.distance(at, enough.max(0.0)),
            (None, None) => f64::INFINITY,
        }
    }

    /// Farthest that a point of the one body of a pair is moved against the other between two moments [m], no less.
    pub(super) fn shift(&self, pair: &Pair, [from, to]: [&Links; 2]) -> f64 {
        let moved = &self.bodies[pair.moved].1;
        let seen = |links: &Links| {
            let at = moved.mount.pose(links);
            match pair.other {
                Some(other) => self.bodies[other].1.mount.pose(links).inverse() * at,
                None => at,
            }
        };
        let (centre, radius) = match (pair.other, &self.ridden) {
            (None, Some(ridden)) => (ridden.centre, 0.0),
            _ => self.spheres[pair.moved],
        };
        let (before, after) = (seen(from), seen(to));
        let way = after.transform_point(centre) - before.transform_point(centre);
        let turn = (after.rotation * before.rotation.inverse()).normalize();
        // Twice the sine of half the angle, times the radius.
        way.length() + 2.0 * radius * turn.xyz().length()
    }

    /// Depth by which a pair reaches into each other, negative where it is apart [m].
    pub(super) fn depth(&self, pair: &Pair, links: &Links, reach: f64) -> f64 {
        let Some(other) = pair.other else {
            return -self.distance(pair, links, reach);
        };
        let (moved, other) = (&self.bodies[pair.moved].1, &self.bodies[other].1);
        let poses = [moved, other].map(|body| body.mount.pose(links));
        let depth = moved.depth(poses[0], other, poses[1], reach);
        let enclosed = other.encloses(poses[1], moved, poses[0]);
        match depth {
            // From inside to the nearest surface, and out of it with all that it is.
            _ if enclosed => {
                let nearest = moved.distance(poses[0], other, poses[1], f64::INFINITY);
                nearest + 2.0 * moved.extent()
            }
            Some(depth) => depth,
            None => -reach,
        }
    }

    /// Whether one body of a pair lies wholly in the other.
    pub(super) fn is_enclosed(&self, pair: &Pair, links: &Links) -> bool {
        let Some(other) = pair.other else {
            return false;
        };
        let (moved, other) = (&self.bodies[pair.moved].1, &self.bodies[other].1);
        let poses = [moved, other].map(|body| body.mount.pose(links));
        other.encloses(poses[1], moved, poses[0]) || moved.encloses(poses[0], other, poses[1])
    }

    /// Names of a pair's bodies.
    pub(super) fn named(&self, pair: &Pair) -> [String; 2] {
        let moved = match pair.other {
            Some(_) => self.bodies[pair.moved].1.name.clone(),
            None => "tool's ball".to_owned(),
        };
        let other = match pair.other {
            Some(other) => self.bodies[other].1.name.clone(),
            None => "part".to_owned(),
        };
        [moved, other]
    }

    /// Puts a body that stands in the world elsewhere.
    pub fn move_body(&mut self, name: &str, pose: DPose3) {
        for (_, body) in &mut self.bodies {
            if body.name == name && matches!(body.mount, Mount::World(_)) {
                body.mount = Mount::World(pose);
            }
        }
    }

    /// The same cell with the part elsewhere.
    #[must_use]
    pub fn with_part_at(&self, world_from_part: DPose3) -> Self {
        let mut moved = self.clone();
        for (role, body) in &mut moved.bodies {
            if *role == Role::Part {
                body.mount = Mount::World(world_from_part);
            }
        }
        if let Some(ridden) = &mut moved.ridden {
            ridden.world_from_part = world_from_part;
        }
        moved
    }

    /// Lowest of its standing bodies along the world's z [m].
    pub fn lowest(bodies: &[(Role, Body)]) -> f64 {
        let heights = bodies.iter().filter_map(|(_, body)| match body.mount {
            Mount::World(pose) => Some(body.span(pose, DVec3::Z)[0]),
            Mount::Link(_) => None,
        });
        heights.fold(f64::INFINITY, f64::min)
    }
}
