//! The files of a draft: one for each clock of a log, or for each variable of a log in which rows have different ones.

use super::assign::{Pick, assign};
use super::clocks::{Clocks, clocks};
use super::joints::joints;
use super::named::named_joints;
use super::numbered::numbered_joints;
use super::seen::{Looked, Seen, TimeSeen};
use super::time::{self, TimeChoice};
use super::unnamed::unnamed_joints;
use super::wrench::wrench;
use crate::import::map::Column;
use crate::recording::{Unit, schema};

/// A file of the map.
pub(super) struct Section {
    /// Its times; none where nothing looks like them.
    pub time: Option<TimeChoice>,
    /// The rows that it is of, where each row has another variable.
    pub rows: Option<(Column, String)>,
    pub picks: Vec<Pick>,
}

/// All files of a log.
pub(super) struct Sections {
    pub sections: Vec<Section>,
    /// The columns that the picks are of.
    pub columns: Vec<Seen>,
    /// Places of those that hold times.
    pub taken: Vec<usize>,
    /// The picks of all files.
    pub picks: Vec<Pick>,
    /// The first field of each column.
    pub samples: Vec<String>,
}

/// The files of a log, of which `logs` are there one behind the other, for quantities that are not given yet.
pub(super) fn of(looked: &Looked, logs: usize, given: &[String]) -> Sections {
    let mut all = if looked.variables.is_empty() {
        of_columns(looked, logs, given)
    } else {
        of_variables(looked, logs, given)
    };
    // The fastest clock counts: others are read off between their samples. Of clocks alike to a percent or two the first column's.
    let class = |section: &Section| (100.0 * rate(section).log10()).round();
    all.sections.sort_by(|a, b| class(b).total_cmp(&class(a)));
    if all.sections.iter().any(|section| !section.picks.is_empty()) {
        all.sections.retain(|section| !section.picks.is_empty());
    } else {
        all.sections.truncate(1);
    }
    all
}

fn rate(section: &Section) -> f64 {
    section.time.as_ref().map_or(0.0, |time| time.rate)
}

/// Quantities of the device, or of an arm alone, in columns, but for those at some places and those that are given.
fn all_picks(columns: &[Seen], taken: &[usize], given: &[String]) -> Vec<Pick> {
    let with = |picks: &[Pick], taken: &[usize]| -> Vec<usize> {
        let places = picks.iter().map(|pick| pick.place);
        places.chain(taken.iter().copied()).collect()
    };
    // What has the number or the name of a joint is nothing of the device.
    let mut of_arm = numbered_joints(columns, taken);
    if of_arm.is_empty() {
        of_arm = named_joints(columns, taken);
    }
    if of_arm.is_empty() {
        of_arm = unnamed_joints(columns);
    }
    let mut picks = assign(columns, &with(&of_arm, taken));
    let of_cell = picks.iter().any(is_of_device);
    let in_bag = joints(columns, &with(&picks, &with(&of_arm, taken)), of_cell);
    of_arm.extend(in_bag);
    if of_arm.is_empty() || of_cell {
        picks.extend(of_arm);
    } else {
        // Joints first: their times are those of the recording.
        let readings = wrench(columns, &with(&of_arm, taken));
        picks = of_arm;
        picks.extend(readings);
    }
    picks.retain(|pick| !given.iter().any(|quantity| *quantity == pick.quantity));
    picks
}

/// Whether a quantity is one that an arm without a device does not have: an arm has poses and forces of its own.
fn is_of_device(pick: &Pick) -> bool {
    pick.kind == Unit::Pascal || pick.quantity == schema::VALVE_EXTENDS && pick.because.is_certain
}

/// Files of a log with a column for each variable.
fn of_columns(looked: &Looked, logs: usize, given: &[String]) -> Sections {
    let columns = &looked.columns;
    let whole = |time: Option<TimeChoice>| {
        let taken = time
            .as_ref()
            .map_or(Vec::new(), |choice| choice.places.clone());
        let picks = all_picks(columns, &taken, given);
        let section = Section {
            time,
            rows: None,
            picks: picks.clone(),
        };
        (vec![section], taken, picks)
    };
    let (sections, taken, picks) = match (&looked.time, clocks(looked, logs)) {
        (TimeSeen::Messages { column, because }, _) => {
            whole(Some(time::of_messages(column, because)))
        }
        (TimeSeen::Waveforms, _) => whole(None),
        (TimeSeen::Column, Clocks::One) => whole(time::choose(columns, &looked.rates, logs)),
        (TimeSeen::Column, Clocks::Open(question)) => {
            let is_time = |place: &usize| time::is_time(*place, &columns[*place], logs);
            let places = (0..columns.len()).filter(is_time).collect();
            whole(Some(TimeChoice::asked(question, places)))
        }
        (TimeSeen::Column, Clocks::Each(groups)) => {
            let taken: Vec<usize> = groups.iter().map(|group| group.clock).collect();
            let picks = all_picks(columns, &taken, given);
            let section = |group: &super::clocks::Group| Section {
                time: Some(time::of_column(columns, group.clock, &looked.rates, logs)),
                rows: None,
                picks: (picks.iter())
                    .filter(|pick| group.columns.contains(&pick.place))
                    .cloned()
                    .collect(),
            };
            (groups.iter().map(section).collect(), taken, picks)
        }
    };
    Sections {
        sections,
        columns: columns.clone(),
        taken,
        picks,
        samples: looked.samples.clone(),
    }
}

/// Files of a log in which each row has another variable.
fn of_variables(looked: &Looked, logs: usize, given: &[String]) -> Sections {
    let variables = &looked.variables;
    let columns: Vec<Seen> = variables
        .iter()
        .map(|variable| variable.column.clone())
        .collect();
    let picks = all_picks(&columns, &[], given);
    let section = |(place, variable): (usize, &super::seen::Variable)| Section {
        time: time::choose(&variable.columns, &looked.rates, logs),
        rows: Some((variable.chooser.clone(), variable.value.clone())),
        picks: (picks.iter())
            .filter(|pick| pick.place == place)
            .cloned()
            .collect(),
    };
    Sections {
        sections: variables.iter().enumerate().map(section).collect(),
        columns,
        taken: Vec::new(),
        picks,
        samples: Vec::new(),
    }
}
