//! An edge with a burr, as far as it has been worked: burr first, then chamfer (`physics::chamfer`), at stations a tenth of a millimetre apart.

use crate::physics::chamfer;
use crate::workpiece::{BurrProfile, EdgeCurve};

/// Longest distance between stations [m].
const SPACING: f64 = 1e-4;

/// The edge at one station.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgeStationState {
    /// Angle of the part between its faces [rad].
    pub angle: f64,
    /// Height of the burr before any work [m].
    pub burr_before: f64,
    /// Section of the burr before any work [m2].
    pub burr_section: f64,
    /// Section that was taken, of the burr and below it [m2].
    pub removed: f64,
}

impl EdgeStationState {
    /// Height of the burr that is left [m].
    pub fn burr(&self) -> f64 {
        chamfer::residual_height(self.burr_before, self.burr_section, self.removed)
    }

    /// Section of the chamfer [m2].
    pub fn chamfer_section(&self) -> f64 {
        (self.removed - self.burr_section).max(0.0)
    }

    /// Leg of the chamfer [m].
    pub fn leg(&self) -> f64 {
        chamfer::leg(self.chamfer_section(), self.angle)
    }

    /// Height of the surface along the bisector above the sharp edge [m].
    fn height(&self) -> f64 {
        self.burr() - chamfer::depth(self.chamfer_section(), self.angle)
    }
}

/// Where a ball rides on the edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ride {
    /// Lift of its centre from where the sharp edge carries it [m].
    pub lift: f64,
    /// Derivative of that along the edge [1].
    pub slope: f64,
}

/// The whole edge.
#[derive(Debug, Clone)]
pub struct EdgeState {
    spacing: f64,
    stations: Vec<EdgeStationState>,
    heights: Vec<f64>,
    /// Least and greatest height so far [m].
    range: [f64; 2],
}

impl EdgeState {
    /// An edge that was not worked, with a burr of a root thickness [m].
    pub fn new(edge: &EdgeCurve, burr: Option<&BurrProfile>, root: f64) -> Self {
        let count = (edge.length / SPACING).ceil().max(1.0);
        let spacing = edge.length / count;
        let station = |i: usize| {
            let place = (i as f64 + 0.5) * spacing;
            let point = edge.at(place);
            let height = burr.map_or(0.0, |burr| burr.height(place));
            EdgeStationState {
                angle: std::f64::consts::PI - point.normal_a.angle_between(point.normal_b),
                burr_before: height,
                burr_section: chamfer::burr_section(height, root),
                removed: 0.0,
            }
        };
        let stations: Vec<_> = (0..count as usize).map(station).collect();
        let heights: Vec<f64> = stations.iter().map(EdgeStationState::height).collect();
        let range = heights
            .iter()
            .fold([0.0, 0.0], |[low, high], h| [low, f64::max(high, *h)]);
        Self {
            spacing,
            stations,
            heights,
            range,
        }
    }

    /// Distance between stations [m].
    pub fn spacing(&self) -> f64 {
        self.spacing
    }

    /// The stations, from the start of the edge; each stands in the middle of its stretch.
    pub fn stations(&self) -> &[EdgeStationState] {
        &self.stations
    }

    /// Place of a station [m].
    pub fn place(&self, station: usize) -> f64 {
        (station as f64 + 0.5) * self.spacing
    }

    /// Volume taken so far [m3].
    pub fn removed_volume(&self) -> f64 {
        self.stations.iter().map(|s| s.removed).sum::<f64>() * self.spacing
    }

    /// Takes a volume [m3], spread evenly over what of the stretch from one place to another [m] lies on the edge. Returns whether any of it does.
    pub fn remove(&mut self, from: f64, to: f64, volume: f64) -> bool {
        let length = self.spacing * self.stations.len() as f64;
        let (from, to) = (from.clamp(0.0, length), to.clamp(0.0, length));
        if to <= from {
            return false;
        }
        let per_length = volume / (to - from);
        let first = (from / self.spacing) as usize;
        let last = ((to / self.spacing) as usize).min(self.stations.len() - 1);
        for i in first..=last {
            let (low, high) = (i as f64 * self.spacing, (i + 1) as f64 * self.spacing);
            let overlap = to.min(high) - from.max(low);
            if overlap > 0.0 {
                self.stations[i].removed += per_length * overlap / self.spacing;
                self.heights[i] = self.stations[i].height();
                self.range[0] = self.range[0].min(self.heights[i]);
            }
        }
        true
    }

    /// Where a ball of a radius [m] rides at a place [m]: the envelope of the ball over the heights, linear between stations and level beyond the ends.
    pub fn ride(&self, place: f64, radius: f64) -> Ride {
        let [low, high] = self.range;
        let reach = ((2.0 * radius * (high - low)).sqrt() + 2.0 * self.spacing).min(radius);
        let at = |place: f64| place / self.spacing - 0.5;
        let last = self.stations.len() as isize - 1;
        let height = |i: isize| self.heights[i.clamp(0, last) as usize];
        let mut best = Ride {
            lift: f64::NEG_INFINITY,
            slope: 0.0,
        };
        let mut drop = 0.0;
        let mut look = |i: isize| {
            let start = (i as f64 + 0.5) * self.spacing - place;
            let near = start.max(-start - self.spacing).max(0.0);
            let (left, right) = (height(i), height(i + 1));
            // It rides no higher anywhere on the segment than on the higher of its ends would stand at the nearer.
            if left.max(right) - 0.5 * near * near / radius <= best.lift {
                return high - 0.5 * near * near / radius > best.lift;
            }
            let tilt = (right - left) / self.spacing;
            // Where the ball is parallel to the segment, or its end nearer to that.
            let tangent = radius * tilt / tilt.mul_add(tilt, 1.0).sqrt();
            let u = tangent.clamp(start, start + self.spacing);
            let root = (radius * radius - u * u).max(0.0).sqrt();
            let lift = left + tilt * (u - start) - u * u / (radius + root);
            if lift > best.lift {
                best = Ride { lift, slope: u };
                drop = root;
            }
            true
        };
        // From the segment under the ball outwards, each way until none can carry it.
        let under = at(place).floor() as isize;
        let [first, end] = [place - reach, place + reach].map(|place| at(place).floor() as isize);
        look(under);
        let mut behind = (first..under).rev();
        while behind.next().is_some_and(&mut look) {}
        let mut ahead = under + 1..=end;
        while ahead.next().is_some_and(&mut look) {}
        best.slope /= drop.max(1e-3 * radius);
        best
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workpiece::test_parts::cube;
    use crate::workpiece::{EdgeSearch, list_edges};

    /// An edge of a cube of 0.1 m.
    fn edge() -> EdgeCurve {
        let list = list_edges(&cube(), &EdgeSearch::default());
        list.edges.get(1).unwrap().clone()
    }

    #[test]
    fn what_was_taken_is_what_was_asked_for_wherever_it_was() {
        let mut state = EdgeState::new(&edge(), None, 1e-4);
        let mut sum = 0.0;
        for i in 0..2000 {
            let place = 0.1 * f64::from(i) / 2000.0;
            let volume = 1e-12 * (1.0 + (f64::from(i) * 0.01).sin());
            state.remove(place - 3e-4, place + 3e-4, volume);
            sum += volume;
        }
        assert!((state.removed_volume() / sum - 1.0).abs() < 1e-12);
        assert!(!state.remove(-2e-3, -1e-3, 1e-9));
        assert!((state.removed_volume() / sum - 1.0).abs() < 1e-12);
    }

    #[test]
    fn two_passes_take_the_burr_first_and_then_the_edge() {
        let burr = BurrProfile::constant(0.3e-3).unwrap();
        let mut state = EdgeState::new(&edge(), Some(&burr), 0.1e-3);
        // A burr of 0.015 mm2; each pass takes 0.01 mm2.
        let pass = |state: &mut EdgeState| state.remove(0.0, 0.1, 0.01e-6 * 0.1);
        pass(&mut state);
        let left = 0.3e-3 * (1.0f64 / 3.0).sqrt();
        let middle = state.stations()[500];
        assert!((middle.burr() - left).abs() < 1e-12 && middle.leg() == 0.0);
        pass(&mut state);
        let middle = state.stations()[500];
        assert_eq!(middle.burr(), 0.0);
        let leg = (2.0f64 * 0.005e-6).sqrt();
        assert!((middle.leg() - leg).abs() < 1e-12, "{}", middle.leg());
        // The ball now rides lower by the chamfer's depth.
        let ride = state.ride(0.05, 5e-3);
        assert!((ride.lift + 0.005e-6f64.sqrt()).abs() < 1e-12);
        assert!(ride.slope.abs() < 1e-12);
    }

    #[test]
    fn an_edge_that_was_not_worked_is_ridden_as_its_burr() {
        let burr = BurrProfile::seeded_random(3, 0.2e-3, 0.06e-3, 4e-3).unwrap();
        let state = EdgeState::new(&edge(), Some(&burr), 1e-4);
        let ridden = burr.ridden_by_ball(5e-3, 0.1, 2e-5).unwrap();
        for i in 1..90 {
            let place = 1e-3 * f64::from(i) + 0.3e-4;
            let ride = state.ride(place, 5e-3);
            // A tenth of a millimetre of a profile that bends over 4 mm.
            assert!((ride.lift - ridden.lift(place)).abs() < 0.5e-6, "{place}");
            assert!((ride.slope - ridden.slope(place)).abs() < 5e-3, "{place}");
        }
    }

    #[test]
    fn a_notch_narrower_than_the_ball_does_not_let_it_in() {
        let mut state = EdgeState::new(&edge(), None, 1e-4);
        state.remove(0.0499, 0.0501, 0.25e-6 * 0.2e-3);
        let notch = state.stations()[500].leg();
        assert!(notch > 0.5e-3);
        // Its depth of half a millimetre is hardly felt over a fifth of a millimetre.
        let ride = state.ride(0.05, 5e-3);
        assert!(ride.lift > -3e-6, "{}", ride.lift);
    }

    #[test]
    fn stations_stand_in_the_middle_of_equal_stretches() {
        let state = EdgeState::new(&edge(), None, 1e-4);
        let count = state.stations().len();
        assert!((state.spacing() * count as f64 - 0.1).abs() < 1e-12);
        assert!((state.place(0) - 0.5 * state.spacing()).abs() < 1e-15);
        assert!((state.place(count - 1) + 0.5 * state.spacing() - 0.1).abs() < 1e-12);
    }

    #[test]
    fn a_ball_rides_on_the_highest_of_the_circles_about_it() {
        let mut state = EdgeState::new(&edge(), None, 1e-4);
        // A notch, and a ball that is far wider: by brute force over fine places.
        state.remove(0.049, 0.0505, 2e-10);
        let radius = 5e-3;
        let height = |place: f64| {
            let at = place / state.spacing() - 0.5;
            let left = at.floor();
            let of = |i: f64| state.heights[(i.max(0.0) as usize).min(state.heights.len() - 1)];
            of(left) + (at - left) * (of(left + 1.0) - of(left))
        };
        for place in [0.02, 0.046, 0.0483, 0.0495, 0.0499, 0.0512, 0.053] {
            let circle =
                |off: f64| height(place + off) + (radius * radius - off * off).sqrt() - radius;
            let lift = (-4999..=4999)
                .map(|i| circle(f64::from(i) * 1e-6))
                .fold(f64::NEG_INFINITY, f64::max);
            let found = state.ride(place, radius).lift;
            assert!((found - lift).abs() < 2e-8, "{place}: {found} for {lift}");
        }
    }
}
