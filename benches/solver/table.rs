//! Every method on every case.

use std::ops::Range;

use super::adaptive;
use super::case::Case;
use super::fixed::{Fixed, Method};
use super::legs::{Run, Stepper, Stops};
use super::model::State;
use super::watch::{Measured, measure};

/// Rounds at least, of which the best counts.
const ROUNDS: usize = 3;
/// Where the cost is taken apart from the whole [s]: in the first case the piston starts to move, meets the load cell and presses.
pub const WINDOW: (f64, f64) = (1.0, 2.5);
/// Every case.
const ALL: Range<usize> = 0..STIFF + 1;
/// Index of the case with small chambers, after those with golden files.
pub const STIFF: usize = 3;
/// Relative tolerances.
const TOLERANCES: [f64; 3] = [1e-4, 1e-6, 1e-8];
/// Name of the loop's own integrator.
pub const OWN: &str = "the device's own";
/// As a loop needs it: it may change something at each of its steps.
pub const RENEWED: &str = "restarted every ms";
const STOPS: [(Stops, &str); 3] = [
    (Stops::Free, "free"),
    (Stops::Held, "stopped every ms"),
    (Stops::Renewed, RENEWED),
];

/// Takes one run of a case and tells the samples.
type Go<'a> = &'a mut dyn FnMut(&Case, &mut dyn FnMut(f64, &State));

/// Hands a solver for a case, at a tolerance, on.
pub type Solver = fn(&Case, f64, &mut dyn FnMut(&mut dyn Stepper));

/// A method with one setting on every case; `None` where it was not measured.
pub struct Row {
    /// The method.
    pub name: String,
    /// Its setting.
    pub setting: String,
    /// On each case.
    pub measured: Vec<Option<Measured>>,
}

/// All that is measured; each row is printed as it comes.
pub struct Table<'a> {
    cases: &'a [Case],
    rows: Vec<Row>,
}

impl Table<'_> {
    /// One row, with some of the cases.
    fn row(&mut self, name: &str, setting: &str, wanted: Range<usize>, go: Go<'_>) {
        print!("{name:<28} {setting:<26}");
        let mut row = Row {
            name: name.to_owned(),
            setting: setting.to_owned(),
            measured: Vec::new(),
        };
        for (index, case) in self.cases.iter().enumerate() {
            if !wanted.contains(&index) {
                let width = if index == 0 { 27 } else { 19 };
                print!("{:width$}|", "");
                row.measured.push(None);
                continue;
            }
            let measured = measure(case, ROUNDS, WINDOW, &mut |seen| go(case, seen));
            if index == 0 {
                print!(" {:>7.3}", measured.inside);
            }
            print!(" {:>8.3} {:>8.1e} |", measured.whole, measured.error);
            row.measured.push(Some(measured));
        }
        println!();
        self.rows.push(row);
    }

    fn own(&mut self) {
        for audited in [true, false] {
            for substeps in [1, 2, 4, 8] {
                let ledger = if audited { ", ledger" } else { "" };
                let setting = format!("at least {substeps} sub-steps{ledger}");
                self.row(OWN, &setting, ALL, &mut |case, seen| {
                    case.run_device(substeps, audited, seen);
                });
            }
        }
    }

    /// Methods of fixed step, with as many sub-steps as make sense: an explicit one is not even stable on the small chambers with fewer than 100.
    fn fixed_steps(&mut self) {
        let explicit = [
            Method::Classical4,
            Method::ThreeEighths,
            Method::Heun3,
            Method::Ralston3,
        ];
        for method in explicit {
            for substeps in [1, 2, 4, 8] {
                self.fixed(Fixed::new(method, substeps), 0..STIFF);
            }
            for substeps in [64, 128, 256] {
                self.fixed(Fixed::new(method, substeps), STIFF..STIFF + 1);
            }
        }
        for method in [Method::Ros2, Method::Ros3, Method::Rodas3] {
            for substeps in [1, 2, 4, 8, 16] {
                self.fixed(Fixed::new(method, substeps), ALL);
            }
        }
        for substeps in [2, 8, 32] {
            let unlocated = Fixed {
                located: false,
                ..Fixed::new(Method::Classical4, substeps)
            };
            self.fixed(unlocated, 0..STIFF);
        }
    }

    fn fixed(&mut self, method: Fixed, wanted: Range<usize>) {
        let blind = if method.located { "" } else { ", unlocated" };
        let setting = format!("{} sub-steps{blind}", method.substeps);
        let name = method.method.name();
        self.row(name, &setting, wanted, &mut |case, seen| {
            method.run(&case.model, &case.timetable, case.start, seen);
        });
    }

    /// A solver that chooses its own steps, at all tolerances and stops.
    pub fn solver(&mut self, name: &str, with: Solver) {
        for tolerance in TOLERANCES {
            for (stops, how) in STOPS {
                let setting = format!("{tolerance:.0e} {how}");
                self.row(name, &setting, ALL, &mut |case, seen| {
                    let milliseconds;
                    let samples = if stops == Stops::Free {
                        &case.times
                    } else {
                        milliseconds = case.milliseconds();
                        &milliseconds
                    };
                    let run = Run {
                        model: &case.model,
                        timetable: &case.timetable,
                        start: case.start,
                        stops,
                        samples,
                    };
                    with(case, tolerance, &mut |stepper| run.go(stepper, seen));
                });
            }
        }
    }
}

/// Measures and prints everything.
pub fn print(cases: &[Case]) -> Vec<Row> {
    println!(
        "\nmicroseconds a simulated millisecond, best of at least {ROUNDS} rounds; largest error over full scale"
    );
    print!("{:<28} {:<26} {:>7}", "", "", "1-2.5 s");
    for case in cases {
        print!(" {:>8} {:>8} |", case.name, "error");
    }
    println!();
    let mut table = Table {
        cases,
        rows: Vec::new(),
    };
    table.own();
    table.fixed_steps();
    table.solver("DOPRI5 (diff.-equations)", |case, tolerance, go| {
        go(&mut *adaptive::dopri5(&case.model, tolerance));
    });
    table.solver("DOP853 (diff.-equations)", |case, tolerance, go| {
        go(&mut *adaptive::dop853(&case.model, tolerance));
    });
    table.solver("Radau5 (diff.-equations)", |case, tolerance, go| {
        go(&mut *adaptive::radau5(&case.model, tolerance));
    });
    table.solver("Kvaerno5 (diff.-equations)", |case, tolerance, go| {
        go(&mut *adaptive::kvaerno5(&case.model, tolerance));
    });
    #[cfg(feature = "diffsol")]
    super::diffsol_crate::add_to(&mut table);
    #[cfg(not(feature = "diffsol"))]
    println!("diffsol: not measured; it comes with --features diffsol");
    table.rows
}
