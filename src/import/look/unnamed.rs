//! Joints in columns without names, by the makers' order of them; what is taken for a speed must be the slope of its position.
//!
//! Sources: Universal Robots, "Real-Time Client Interface", port 30003, the columns of its table; the same without what follows the currents, as logs of
//! its actual and target values are published: time, positions, speeds, currents, target currents, target torques.

use super::assign::Pick;
use super::numbered::{Signal, quantity, si};
use super::seen::{Because, SaidUnit, Seen};
use super::wrench;
use crate::import::map::Column;
use crate::import::units;

/// Joints of these arms.
const JOINTS: usize = 6;
/// Largest angle of theirs [rad].
const TURN: f64 = 6.6;
/// Way below which a joint is held still [rad].
const STILL: f64 = 0.05;
/// Shares within which a speed is the slope of its position [1].
const SLOPE: std::ops::RangeInclusive<f64> = 0.8..=1.25;

/// An order of columns, each from 0 where its first joint stands.
struct Order {
    /// Columns: so many, or at least so many.
    count: usize,
    is_exact: bool,
    signals: &'static [(Signal, usize)],
    /// Where forces and torques at the tool stand.
    force: Option<usize>,
    name: &'static str,
}

/// What speaks of forces at the tool in these logs.
const FORCE: &str = "in the base's axes, and without the declared payload's weight";

const ORDERS: [Order; 2] = [
    Order {
        count: 31,
        is_exact: true,
        signals: &[
            (Signal::Position, 1),
            (Signal::Speed, 7),
            (Signal::Current, 13),
        ],
        force: None,
        name: "time, positions, speeds, currents, target currents, target torques",
    },
    Order {
        count: 49,
        is_exact: false,
        signals: &[
            (Signal::Position, 31),
            (Signal::Command, 1),
            (Signal::Speed, 37),
            (Signal::Current, 43),
        ],
        force: Some(67),
        name: "the real-time interface of Universal Robots",
    },
];

/// Joints in the order of a maker, base first.
pub(super) fn unnamed_joints(columns: &[Seen]) -> Vec<Pick> {
    let is_bare =
        |column: &Seen| column.name.is_empty() && matches!(column.column, Column::Number(_));
    if !columns.iter().all(is_bare) {
        return Vec::new();
    }
    let mut orders = ORDERS.iter().filter(|order| {
        columns.len() == order.count || !order.is_exact && columns.len() > order.count
    });
    orders
        .find_map(|order| Some(order.picks(columns, order.fits(columns)?)))
        .unwrap_or_default()
}

impl Order {
    fn start(&self, signal: Signal) -> Option<usize> {
        let own = self.signals.iter().find(|(own, _)| *own == signal);
        own.map(|(_, start)| *start)
    }

    /// Whether columns are in this order, and how sure that is.
    fn fits(&self, columns: &[Seen]) -> Option<Because> {
        let time = columns[0].numbers();
        let is_rising = time.len() > 2 && time.windows(2).filter(|t| t[1] < t[0]).count() < 2;
        let (position, speed) = (self.start(Signal::Position)?, self.start(Signal::Speed)?);
        let is_angle = |place: usize| {
            let range = columns[place].range();
            range.is_some_and(|[low, high]| low >= -TURN && high <= TURN)
        };
        if !is_rising || !(position..position + JOINTS).all(is_angle) {
            return None;
        }
        let (mut both, mut of_position, mut of_speed) = (0.0, 0.0, 0.0);
        for joint in 0..JOINTS {
            let angle = columns[position + joint].numbers();
            let rate = columns[speed + joint].numbers();
            for index in 1..time.len().min(angle.len()).min(rate.len()) {
                let way = angle[index] - angle[index - 1];
                let mean = 0.5 * (rate[index] + rate[index - 1]);
                let other = mean * (time[index] - time[index - 1]);
                if way.is_finite() && other.is_finite() {
                    both += way * other;
                    of_position += way * way;
                    of_speed += other * other;
                }
            }
        }
        let width = |place: usize| columns[place].range().map_or(0.0, |[low, high]| high - low);
        let is_still = (position..position + JOINTS).all(|place| width(place) < STILL);
        if is_still && self.is_exact {
            let why = format!("as many columns as {} have; nothing moves", self.name);
            return Some(Because::likely(why));
        }
        let alike = SLOPE.contains(&(both / of_speed)) && SLOPE.contains(&(both / of_position));
        let why = format!(
            "in the order of {}: speeds are slopes of positions",
            self.name
        );
        alike.then(|| Because::likely(why))
    }

    fn picks(&self, columns: &[Seen], because: Because) -> Vec<Pick> {
        let mut picks = Vec::new();
        for (signal, start) in self.signals {
            let unit = units::named(match signal {
                Signal::Position | Signal::Command => "rad",
                Signal::Speed => "rad/s",
                Signal::Current => "A",
                Signal::Torque => "Nm",
            });
            for joint in 0..JOINTS {
                let quantity = format!("joint_{}_{}", joint + 1, quantity(*signal));
                let mut pick = Pick::new(quantity, start + joint, because.clone(), si(*signal));
                pick.unit = unit.map(|unit| SaidUnit {
                    unit,
                    pressure: None,
                    because: because.clone(),
                });
                picks.push(pick);
            }
        }
        let force = self.force.filter(|start| start + 6 <= columns.len());
        let places: Vec<usize> = force.map_or(Vec::new(), |start| (start..start + 6).collect());
        let moves = |place: &usize| {
            columns[*place]
                .range()
                .is_some_and(|[low, high]| low < high)
        };
        if places.iter().any(moves) {
            picks.extend(wrench::picks(columns, &places, Some(FORCE)));
        }
        picks
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::import::look::seen::Cells;

    fn log(count: usize, [position, speed]: [usize; 2], rate: f64) -> Vec<Seen> {
        let value = |place: usize, time: f64| match place {
            0 => time + 80.0,
            _ if (position..position + JOINTS).contains(&place) => (rate * time).sin(),
            _ if (speed..speed + JOINTS).contains(&place) => rate * (rate * time).cos(),
            _ => 9.0 * (3.0 * rate * time).sin(),
        };
        let seen = |place: usize| Seen {
            column: Column::Number(place + 1),
            name: String::new(),
            joint: None,
            frames: Vec::new(),
            unit: None,
            cells: Cells::Numbers(
                (0..500)
                    .map(|i| value(place, 0.01 * f64::from(i)))
                    .collect(),
            ),
        };
        (0..count).map(seen).collect()
    }

    #[test]
    fn joints_are_found_by_the_order_of_their_columns_where_speeds_are_slopes() {
        let short = unnamed_joints(&log(31, [1, 7], 2.0));
        assert_eq!((short.len(), short[12].place), (18, 13));
        assert_eq!(short[12].quantity, "joint_1_current");
        let long = unnamed_joints(&log(102, [31, 37], 2.0));
        assert_eq!((long[0].place, long.len()), (31, 30));
        assert_eq!(long[29].quantity, "wrench_torque_z");
        // Another order, and still columns of something else.
        assert!(unnamed_joints(&log(31, [7, 13], 2.0)).is_empty());
        assert!(unnamed_joints(&log(102, [1, 37], 0.0)).is_empty());
    }
}
