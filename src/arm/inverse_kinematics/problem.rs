//! A pose that is wanted: how, and what came of it.

/// Which rotations of the tip are wanted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TipOrientation {
    /// All three.
    Full,
    /// Any rotation about the tip's own z axis will do (a tool that is symmetric about it).
    FreeAboutZ,
}

/// Settings of the search.
#[derive(Debug, Clone, PartialEq)]
pub struct IkOptions {
    /// Largest position error accepted [m].
    pub position_tolerance: f64,
    /// Largest orientation error accepted [rad].
    pub orientation_tolerance: f64,
    /// Which rotations of the tip are wanted.
    pub orientation: TipOrientation,
    /// Steps from one start [-].
    pub max_iterations: usize,
    /// Random starts after the given one has failed [-].
    pub random_starts: usize,
    /// Seed of the random starts.
    pub seed: u64,
}

impl Default for IkOptions {
    fn default() -> Self {
        Self {
            position_tolerance: 1e-9,
            orientation_tolerance: 1e-9,
            orientation: TipOrientation::Full,
            max_iterations: 100,
            random_starts: 100,
            seed: 1,
        }
    }
}

/// Joint positions that reach the pose.
#[derive(Debug, Clone, PartialEq)]
pub struct IkSolution {
    /// Joint positions [rad or m].
    pub q: Vec<f64>,
    /// Distance left [m].
    pub position_error: f64,
    /// Angle left [rad].
    pub orientation_error: f64,
    /// Steps taken, over all starts [-].
    pub iterations: usize,
    /// Random starts used; zero if the given start led there, one more than allowed if only a search that
    /// passed outside the limits did [-].
    pub random_starts_used: usize,
}

/// The axis that stands in the way.
#[derive(Debug, Clone, PartialEq)]
pub struct LimitingAxis {
    /// Index of the joint in the chain.
    pub joint: usize,
    /// Name of the joint.
    pub name: String,
    /// Position it would need, or has in the nearest pose found [rad or m].
    pub position: f64,
    /// The limit nearest to that [rad or m].
    pub limit: f64,
}

/// Why a pose is not reached.
#[derive(Debug, Clone, PartialEq)]
pub struct IkFailure {
    /// Joint positions of the nearest pose found within the limits [rad or m].
    pub q: Vec<f64>,
    /// Distance left there [m].
    pub position_error: f64,
    /// Angle left there [rad].
    pub orientation_error: f64,
    /// Whether the pose would be reached without position limits; if so, `axis` is the one most over its
    /// limit, otherwise the one nearest to its limit in the nearest pose found.
    pub reachable_without_limits: bool,
    /// The axis in the way; none if the chain has no finite limit.
    pub axis: Option<LimitingAxis>,
}
