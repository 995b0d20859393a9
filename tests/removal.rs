//! A tool that turns takes a burr off and chamfers the edge, by closed forms of what it should have done.

use std::f64::consts::SQRT_2;

use idc_cell::cell::{Cell, CellError};
use idc_cell::physics::cutting_force::CuttingForce;
use idc_cell::physics::removal_law::RemovalLaw;
use idc_cell::physics::spindle::Spindle;
use idc_cell::recording::csv::EdgeProfile;
use idc_cell::recording::{Recording, schema};
use idc_cell::removal::{ToolShape, TurningTool};
use idc_cell::scenario::{
    BurrScenario, FeedFollows, FeedMeasure, PassScenario, RemovalScenario, Scenario, ToolScenario,
};
use idc_cell::simulation::SimulationError;

use crate::common::scenario;

/// Volume per work of force and speed [m3/J].
const COEFFICIENT: f64 = 1.2e-11;
/// Speed of the tool's surface against the part, but for the feed [m/s].
const SPEED: f64 = 8.0;

/// The nominal cell with a belt that takes off by Preston's law, without friction or cutting force unless asked for.
fn belt() -> Scenario {
    let mut cell = scenario("plate_edge_ideal");
    cell.process.force = 60.0;
    cell.process.settle_time = 0.5;
    cell.passes = vec![pass(60.0, 40e-3)];
    cell.tool = Some(ToolScenario {
        tool: TurningTool {
            shape: ToolShape::Belt { wheel_radius: 0.02 },
            sense: 1.0,
            lead: 0.0,
            lean: std::f64::consts::FRAC_PI_2,
        },
        spindle: Spindle {
            free_speed: SPEED / 0.02,
            stall_torque: f64::INFINITY,
        },
        while_following: true,
    });
    cell.removal = Some(RemovalScenario {
        wear_at_start: 0.0,
        law: RemovalLaw::preston(COEFFICIENT),
        contact_area: 1e-6,
        contact_length: 1e-3,
        cutting: CuttingForce {
            specific_energy: 0.0,
            friction: 0.0,
        },
    });
    cell.expect.clear();
    cell
}

fn pass(force: f64, feed: f64) -> PassScenario {
    PassScenario {
        force: Some(force),
        feed: Some(feed),
        expect: Vec::new(),
    }
}

struct Done {
    recording: Recording,
    edge: EdgeProfile,
    stop: Option<SimulationError>,
}

fn done(scenario: Scenario) -> Done {
    let cell = Cell::new(scenario).unwrap();
    let run = cell.run(&mut |_| ()).unwrap();
    Done {
        recording: run.recording,
        edge: run.edge.unwrap(),
        stop: run.stop,
    }
}

impl Done {
    fn of(&self, quantity: &str) -> &[f64] {
        self.recording.values(quantity).unwrap()
    }

    /// Integral of the removal rate over time [m3].
    fn integral(&self) -> f64 {
        let (time, rate) = (self.recording.time(), self.of(schema::REMOVAL_RATE));
        let first = time[0] * rate[0];
        let rest = time.windows(2).zip(&rate[1..]);
        first + rest.map(|(t, rate)| (t[1] - t[0]) * rate).sum::<f64>()
    }

    fn volume(&self) -> f64 {
        let spacing = self.edge.place[1] - self.edge.place[0];
        self.edge.section_removed.iter().sum::<f64>() * spacing
    }

    /// Mean of a signal over the middle half of the first pass.
    fn mean(&self, quantity: &str) -> f64 {
        let span = self.recording.phase("follow").unwrap();
        let samples = self.recording.samples_in(span);
        let quarter = samples.len() / 4;
        let middle = &self.of(quantity)[samples.start + quarter..samples.end - quarter];
        middle.iter().sum::<f64>() / middle.len() as f64
    }

    /// Indices of stations away from where the feed changes.
    fn middle(&self) -> std::ops::Range<usize> {
        self.edge.place.len() / 4..3 * self.edge.place.len() / 4
    }
}

#[test]
fn what_the_edge_lost_is_the_integral_of_the_removal_rate() {
    let mut cell = belt();
    cell.workpiece.burr = BurrScenario::Random {
        seed: 4,
        mean_height: 0.25e-3,
        height_deviation: 0.08e-3,
        correlation_length: 6e-3,
    };
    cell.passes = vec![pass(60.0, 40e-3), pass(45.0, 60e-3)];
    let run = done(cell);
    let (volume, integral) = (run.volume(), run.integral());
    assert!(run.stop.is_none() && volume > 1e-8);
    assert!(
        (volume / integral - 1.0).abs() < 1e-6,
        "{volume} {integral}"
    );
}

#[test]
fn chamfer_burr_and_passes_follow_the_closed_forms() {
    // Section that comes off at the removal rate that was, over the middle of a pass; the rate is Preston's at the force and speed that were.
    let taken = |run: &Done, phase: &str| {
        let span = run.recording.phase(phase).unwrap();
        let samples = run.recording.samples_in(span);
        let quarter = samples.len() / 4;
        let middle = samples.start + quarter..samples.end - quarter;
        let (force, speed) = (run.of(schema::CONTACT_FORCE), run.of(schema::CUTTING_SPEED));
        let count = middle.len() as f64;
        let work: f64 = middle.clone().map(|i| force[i] * speed[i]).sum();
        let rate: f64 = middle.map(|i| run.of(schema::REMOVAL_RATE)[i]).sum();
        assert!(
            (COEFFICIENT * work / rate - 1.0).abs() < 5e-3,
            "{work} {rate}"
        );
        rate / count / 40e-3
    };
    let plain = done(belt());
    let at = plain.middle();
    let once_taken = taken(&plain, "follow");
    // The belt runs along the edge: its speed and the feed add up or take from each other.
    let nominal = COEFFICIENT * 60.0 * SPEED / 40e-3;
    assert!(
        (once_taken / nominal - 1.0).abs() < 0.02,
        "{once_taken} {nominal}"
    );
    for i in at.clone() {
        let depth = plain.edge.chamfer_leg[i] / SQRT_2;
        assert!((depth / once_taken.sqrt() - 1.0).abs() < 1e-4, "{depth}");
    }
    // A burr of which half the section comes off in a pass.
    let (height, section) = (0.5e-3, 2.0 * nominal);
    let mut burred = belt();
    burred.workpiece.burr = BurrScenario::Constant { height };
    burred.workpiece.burr_root = 2.0 * section / height;
    let once = done(burred.clone());
    let left = height * (1.0 - taken(&once, "follow") / section).sqrt();
    for i in at.clone() {
        assert!((once.edge.burr_after[i] / left - 1.0).abs() < 1e-4);
        assert_eq!(once.edge.chamfer_leg[i], 0.0);
    }
    // The second pass just takes the rest, the third makes a chamfer of what is beyond.
    burred.passes = vec![pass(60.0, 40e-3); 3];
    let thrice = done(burred);
    let all: f64 = ["follow", "follow_2", "follow_3"]
        .map(|phase| taken(&thrice, phase))
        .iter()
        .sum();
    for i in at {
        assert_eq!(thrice.edge.burr_after[i], 0.0);
        let depth = thrice.edge.chamfer_leg[i] / SQRT_2;
        assert!(
            (depth / (all - section).sqrt() - 1.0).abs() < 2e-4,
            "{depth}"
        );
    }
}

#[test]
fn a_second_pass_meets_what_the_first_left() {
    // A burr narrower than what the device can follow: the first pass meets it, the second hardly.
    let mut cell = belt();
    cell.workpiece.burr = BurrScenario::Bump {
        position: 0.14,
        height: 0.4e-3,
        width: 12e-3,
    };
    cell.workpiece.burr_root = 0.2e-3;
    cell.passes = vec![pass(60.0, 40e-3), pass(60.0, 40e-3)];
    let run = done(cell);
    let stroke = run.of(schema::STROKE);
    let used = |name: &str| {
        let span = run.recording.phase(name).unwrap();
        let places = run.of(schema::PATH_LENGTH);
        let near = (run.recording.samples_in(span)).filter(|&i| (places[i] - 0.14).abs() < 0.02);
        let strokes: Vec<f64> = near.map(|i| stroke[i]).collect();
        let least = strokes.iter().copied().fold(f64::INFINITY, f64::min);
        strokes.iter().copied().fold(f64::NEG_INFINITY, f64::max) - least
    };
    let (first, second) = (used("follow"), used("follow_2"));
    assert!(first > 0.3e-3, "{first}");
    assert!(second < 0.3 * first, "{first} {second}");
}

#[test]
fn a_force_that_varies_is_a_section_that_varies_by_the_exponent() {
    // The same edge at forces 5 % apart: each section against the force that made it.
    for exponent in [1.0, 2.05] {
        let of = |force: f64| {
            let mut cell = belt();
            cell.passes = vec![pass(force, 40e-3)];
            let removal = cell.removal.as_mut().unwrap();
            removal.law.reference_force = 60.0;
            removal.law.rate = COEFFICIENT * 60.0;
            removal.law.force_exponent = exponent;
            let run = done(cell);
            run.edge.section_removed[run.middle()].iter().sum::<f64>()
        };
        let ratio: f64 = of(63.0) / of(57.0);
        let found = ratio.ln() / (63.0f64 / 57.0).ln();
        assert!((found / exponent - 1.0).abs() < 1e-3, "{found}");
    }
}

#[test]
fn climb_cutting_pulls_the_arm_along_and_conventional_holds_it_back() {
    let along = |sense: f64| {
        let mut cell = belt();
        // The belt's wheel lies across the edge: its surface runs along it.
        let tool = cell.tool.as_mut().unwrap();
        tool.tool.sense = sense;
        cell.removal.as_mut().unwrap().cutting.friction = 0.3;
        // The plate's edge runs along the world's -y.
        done(cell).mean(schema::CONTACT_FORCE_Y)
    };
    // The ball climbs from what is cut to what is not: that holds it back either way.
    let (one, other) = (along(1.0), along(-1.0));
    assert!(
        (0.5 * (one - other).abs() - 0.3 * 60.0).abs() < 0.6,
        "{one} {other}"
    );
    assert!(one * other < 0.0, "{one} {other}");
}

#[test]
fn a_spindle_that_cannot_turn_its_tool_is_refused_or_stops_the_run() {
    let mut cell = belt();
    cell.removal.as_mut().unwrap().cutting.friction = 0.5;
    cell.tool.as_mut().unwrap().spindle.stall_torque = 0.5;
    let refused = Cell::new(cell.clone()).err().unwrap();
    assert!(
        matches!(refused, CellError::SpindleStalls { pass: 1, .. }),
        "{refused}"
    );
    // Enough for the force that is asked for, but not for what a burr presses with.
    cell.tool.as_mut().unwrap().spindle.stall_torque = 0.605;
    cell.workpiece.burr = BurrScenario::Bump {
        position: 0.14,
        height: 1e-3,
        width: 6e-3,
    };
    let run = done(cell);
    let Some(SimulationError::Stalled { edge_length, .. }) = run.stop else {
        panic!("{:?}", run.stop);
    };
    assert!((edge_length - 0.14).abs() < 0.01, "{edge_length}");
}

#[test]
fn a_feed_that_follows_the_power_takes_a_burr_more_slowly() {
    let mut cell = belt();
    let removal = cell.removal.as_mut().unwrap();
    removal.cutting.friction = 0.4;
    let constant = done(cell.clone());
    let power = constant.mean(schema::SPINDLE_POWER);
    cell.process.feed_follows = Some(FeedFollows {
        by: FeedMeasure::Power,
        limit: 0.8 * power,
        least_share: 0.2,
        time_constant: 0.05,
    });
    let slowed = done(cell);
    let following = |run: &Done| {
        let span = run.recording.phase("follow").unwrap();
        span.end - span.start
    };
    // The power does not depend on the feed: the feed settles at the limit over it.
    let ratio = following(&constant) / following(&slowed);
    assert!((ratio - 0.8).abs() < 0.02, "{ratio}");
    let section = |run: &Done| run.edge.section_removed[run.middle()].iter().sum::<f64>();
    let more = section(&slowed) / section(&constant);
    assert!((more - 1.25).abs() < 0.01, "{more}");
}

#[test]
fn a_tool_that_lies_along_the_normal_does_not_cut_and_is_refused() {
    let mut cell = belt();
    let tool = &mut cell.tool.as_mut().unwrap().tool;
    tool.shape = ToolShape::Ball { radius: 5e-3 };
    tool.lean = 0.0;
    let refused = Cell::new(cell.clone()).err().unwrap();
    assert!(
        matches!(refused, CellError::ToolDoesNotCut { .. }),
        "{refused}"
    );
    let tool = &mut cell.tool.as_mut().unwrap().tool;
    tool.shape = ToolShape::Cone {
        half_angle: 0.5,
        flank: 8e-3,
        contact: 4e-3,
        tip_radius: 0.0,
    };
    let refused = Cell::new(cell.clone()).err().unwrap();
    assert!(
        matches!(refused, CellError::ConeOffEdge { .. }),
        "{refused}"
    );
    // The reported angle puts the flank on the edge.
    cell.tool.as_mut().unwrap().tool.lean = std::f64::consts::FRAC_PI_2 - 0.5;
    assert!(Cell::new(cell).is_ok());
}

/// Largest departure of the mean force from 5 N [N] over inclinations of the tool's axis from straight down over level to straight up, of a cell that has
/// the device, the contact and, where asked for, the force controller of another scenario.
fn off_five_newtons(other: &str, controlled: bool) -> f64 {
    let real = scenario(other);
    let turns = [-45.0f64, -20.0, 0.0, 45.0, 90.0, 135.0];
    let off = turns.map(|turn| {
        let mut cell = scenario("plate_edge_ideal");
        cell.device = real.device.clone();
        cell.nominal = real.nominal.clone();
        if controlled {
            cell.controller = real.controller.clone();
            cell.sensing = real.sensing;
        }
        // The tool comes down forwards, 45 degrees steep: turning gravity about the edge turns the whole cell about it.
        let gravity = cell.simulation.gravity;
        cell.simulation.gravity = glam::DQuat::from_rotation_y(turn.to_radians()) * gravity;
        cell.nominal.device.opposing_pressure = 0.5e5;
        cell.process.force = 5.0;
        cell.passes = vec![pass(5.0, 20e-3)];
        cell.expect.clear();
        let cell = Cell::new(cell).unwrap_or_else(|error| panic!("{turn}: {error}"));
        let [along, _] = cell.gravity_on_edge;
        let expected = 9.81 * (turn + 45.0).to_radians().cos();
        assert!((along - expected).abs() < 0.01, "{turn}: {along}");
        let run = cell.run(&mut |_| ()).unwrap();
        assert!(run.stop.is_none(), "{turn}: {:?}", run.stop);
        let span = run.recording.phase("follow").unwrap();
        let force = run.recording.values(schema::CONTACT_FORCE).unwrap();
        let follow = &force[run.recording.samples_in(span)];
        let mean = follow.iter().sum::<f64>() / follow.len() as f64;
        (mean - 5.0).abs()
    });
    off.into_iter().fold(0.0, f64::max)
}

#[test]
fn five_newtons_are_held_at_any_inclination_with_an_opposing_pressure() {
    let off = off_five_newtons("plate_edge_ideal", false);
    println!("without seal friction: {off} N");
    assert!(off < 0.02 * 5.0, "{off} N");
}

// docs/EVIDENCE.md has the figures.
#[test]
fn seals_hold_back_up_to_their_breakaway_force_of_five_newtons_and_a_load_cell_takes_it_out() {
    let seals = scenario("plate_edge").nominal.device.seal_friction;
    assert_eq!(
        (seals.coulomb, seals.static_force, seals.viscous),
        (10.0, 14.0, 50.0)
    );
    let alone = off_five_newtons("plate_edge", false);
    let controlled = off_five_newtons("plate_edge", true);
    println!("with seals {alone} N, with a force controller {controlled} N");
    // The slide comes to rest as the arm sets the tool on: what rubs then lies between both.
    assert!(
        (seals.coulomb..=seals.static_force).contains(&alone),
        "{alone} N"
    );
    assert!(controlled < 0.02 * 5.0, "{controlled} N");
}

#[test]
fn a_tool_that_comes_worn_goes_on_from_there() {
    let worn = |at_start: f64| {
        let mut cell = belt();
        let removal = cell.removal.as_mut().unwrap();
        removal.law.wear_work = 20e3;
        removal.wear_at_start = at_start;
        done(cell)
    };
    let (new, old) = (worn(0.0), worn(14e3));
    let last = |run: &Done| *run.of(schema::TOOL_WEAR).last().unwrap();
    assert_eq!(new.of(schema::TOOL_WEAR)[0], 0.0);
    assert_eq!(old.of(schema::TOOL_WEAR)[0], 14e3);
    assert!(((last(&old) - last(&new)) / 14e3 - 1.0).abs() < 1e-2);
    // The same work at exp(-w / w0) of the rate.
    let ratio = old.volume() / new.volume();
    assert!((ratio / (-0.7f64).exp() - 1.0).abs() < 1e-2, "{ratio}");
}

/// The wear is the work of force and speed: 60 N at 8 m/s for as long as the tool presses, and what force and speed of the recording add up to, at half the speed half
/// of it. A wear that grew by force and time alone would be an eighth.
#[test]
fn a_tool_wears_by_force_times_speed_times_time() {
    let at = |speed: f64| {
        let mut cell = belt();
        cell.tool.as_mut().unwrap().tool.shape = ToolShape::Belt { wheel_radius: 0.02 };
        cell.tool.as_mut().unwrap().spindle.free_speed = speed / 0.02;
        done(cell)
    };
    let worn = |run: &Done| *run.of(schema::TOOL_WEAR).last().unwrap();
    let fast = at(SPEED);
    let (force, speed) = (
        fast.of(schema::CONTACT_FORCE),
        fast.of(schema::CUTTING_SPEED),
    );
    let work: f64 = (fast.recording.time().windows(2).enumerate())
        .map(|(i, t)| (t[1] - t[0]) * force[i + 1] * speed[i + 1])
        .sum();
    assert!(
        (worn(&fast) / work - 1.0).abs() < 0.01,
        "{} {work}",
        worn(&fast)
    );
    let span = fast.recording.phase("follow").unwrap();
    let samples = fast.recording.samples_in(span);
    let time = fast.recording.time();
    let follow = time[samples.end - 1] - time[samples.start];
    let nominal = 60.0 * SPEED * follow;
    assert!(
        (worn(&fast) / nominal - 1.0).abs() < 0.03,
        "{} {nominal}",
        worn(&fast)
    );
    let ratio = worn(&at(0.5 * SPEED)) / worn(&fast);
    assert!((ratio - 0.5).abs() < 0.01, "{ratio}");
}
