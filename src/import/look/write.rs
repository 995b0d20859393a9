//! The draft of a map as a commented TOML file.

use std::fmt::Write;
use std::path::PathBuf;

use super::assign::{Pick, QUANTITIES, assign, described};
use super::joints::joints;
use super::seen::{Because, Draft, Looked, Seen, TimeSeen};
use super::time::{self, toml_text, written};
use super::units::{self, shown};
use crate::import::map::Pressure;
use crate::import::units::LogUnit;
use crate::recording::{Unit, schema};

/// Column at which comments begin.
const COMMENT: usize = 44;

/// Inputs of a whole device, and the remedy for one that the logs lack.
const DRIVING: [(&str, &str, &str); 3] = [
    (
        schema::SET_PRESSURE_GAUGE,
        "what the regulator is told",
        "value = 3.0\n# unit = \"bar\"\n# pressure = \"gauge\"",
    ),
    (
        schema::VALVE_EXTENDS,
        "when the valve extends the slide",
        "value = 1                               # extends throughout\n# unit = \"1\"",
    ),
    (
        schema::SURFACE_POSITION,
        "where the part stands along the stroke",
        "value = nan                             # no part; or where it stands throughout\n# unit = \"mm\"",
    ),
];

/// A text that grows, with what could not be told.
#[derive(Default)]
struct Page {
    text: String,
    open: Vec<String>,
    found: Vec<(String, String)>,
}

impl Page {
    fn line(&mut self, key: &str, value: &str, because: &Because) {
        let written = format!("{key} = {value}");
        self.put(&written, &because.to_string());
    }

    fn put(&mut self, written: &str, comment: &str) {
        // Writing into a text cannot fail.
        let _ = writeln!(
            self.text,
            "{written:<width$}# {comment}",
            width = COMMENT.max(written.chars().count() + 1)
        );
    }

    fn plain(&mut self, line: &str) {
        self.text += line;
        self.text.push('\n');
    }

    /// A key that the user must fill in.
    fn ask(&mut self, written: &str, what: &str, of: &str) {
        self.put(&format!("# {written}"), &format!("asked: {what}"));
        self.open.push(format!("{of}: {what}"));
    }
}

/// Drafts the map of logs, the alike together.
pub(super) fn draft(title: &str, kinds: &[(Looked, Vec<PathBuf>)]) -> Draft {
    let mut page = Page::default();
    page.plain("# Drafted by `idc new import --from` from what stands in the logs: each line says how sure it is and why. What is marked `asked` is to be filled in;");
    page.plain("# whatever is wrong can be changed. Keys, units and forms: assets/import/README.md of the project, or `idc schema import`.");
    page.plain("");
    page.plain("schema = 1");
    page.plain(&format!("title = {}", toml_text(title)));
    for (index, (looked, paths)) in kinds.iter().enumerate() {
        file(&mut page, looked, paths, index, kinds);
    }
    constants(&mut page);
    Draft {
        text: page.text,
        open: page.open,
        found: page.found,
    }
}

fn file(
    page: &mut Page,
    looked: &Looked,
    paths: &[PathBuf],
    index: usize,
    kinds: &[(Looked, Vec<PathBuf>)],
) {
    let names: Vec<String> = paths.iter().map(|path| name(path)).collect();
    page.plain("");
    page.plain(&format!("[[file]]   # {}", names.join(", ")));
    let is_text = looked.head.first().is_none_or(|line| line.key != "form");
    if is_text {
        page.line("form", "\"text\"", &Because::certain("it is one"));
    }
    for line in &looked.head {
        page.line(line.key, &line.value, &line.because);
    }
    let choice = time::choose(looked, paths.len());
    let taken = choice
        .as_ref()
        .map_or(Vec::new(), |choice| choice.places.clone());
    match &choice {
        Some(choice) => {
            let keys: Vec<String> = choice
                .keys
                .iter()
                .map(|(k, v)| format!("{k} = {v}"))
                .collect();
            let line = format!("time = {{ {} }}", keys.join(", "));
            match &choice.open {
                None => page.put(&line, &choice.because.to_string()),
                Some(what) => {
                    page.put(&line, &format!("asked: {what}"));
                    page.open.push(format!("times of {}: {what}", names[0]));
                }
            }
        }
        None if looked.time == TimeSeen::Column => page.ask(
            "time = { column = 1, unit = \"ms\" }",
            "no column rises from row to row or holds stamps",
            "times",
        ),
        None => {}
    }
    if index > 0 {
        page.put(
            "clock = \"shared\"",
            &format!(
                "asked: is it the clock of {}? else \"unknown\" with `aligned_by`",
                kinds[0]
                    .1
                    .first()
                    .map_or_else(String::new, |path| name(path))
            ),
        );
    }
    let given: Vec<String> = page
        .found
        .iter()
        .map(|(quantity, _)| quantity.clone())
        .collect();
    let mut picks = assign(&looked.columns, &taken);
    let of_device: Vec<usize> = picks.iter().map(|pick| pick.place).collect();
    picks.extend(joints(
        &looked.columns,
        &[taken.clone(), of_device].concat(),
    ));
    picks.retain(|pick| !given.iter().any(|quantity| *quantity == pick.quantity));
    for pick in &picks {
        channel(
            page,
            pick,
            &looked.columns[pick.place],
            &looked.columns,
            &picks,
        );
    }
    unused(page, looked, &taken, &picks);
}

fn channel(page: &mut Page, pick: &Pick, column: &Seen, columns: &[Seen], picks: &[Pick]) {
    page.plain("");
    page.plain("[[file.channel]]");
    page.line("quantity", &format!("{:?}", pick.quantity), &pick.because);
    let [low, high] = column.range().unwrap_or_default();
    let range = format!("{} to {}", shown(low), shown(high));
    page.put(&format!("column = {}", written(&column.column)), &range);
    if let Some(joint) = &column.joint {
        page.plain(&format!("joint = {}", toml_text(joint)));
    }
    if let [first, _, ..] = &column.frames[..] {
        let frames: Vec<String> = column.frames.iter().map(|f| format!("`{f}`")).collect();
        page.ask(
            &format!("frame = {}", toml_text(first)),
            &format!(
                "messages of the frames {} are in it; which is meant?",
                frames.join(", ")
            ),
            &described(column),
        );
    }
    page.found
        .push((pick.quantity.to_string(), described(column)));
    let said = column
        .unit
        .as_ref()
        .filter(|said| said.unit.si == pick.kind);
    let (unit, because) = match said {
        Some(said) => (said.unit, said.because.clone()),
        None if pick.kind == Unit::One => match crate::import::units::named("1") {
            Some(unit) => (unit, Because::certain("on and off have no unit")),
            None => return,
        },
        None => match units::by_size(pick.kind, [low, high]) {
            Some(found) => found,
            None => {
                let what = format!(
                    "nothing says it, and {range} is usual in no unit alone; one of {}",
                    units::choices(pick.kind)
                );
                page.ask(
                    "unit = \"\"",
                    &what,
                    &format!("unit of {}", described(column)),
                );
                if pick.kind == Unit::Pascal {
                    page.put(
                        "pressure = \"gauge\"",
                        "likely: most sensors are; or \"absolute\"",
                    );
                }
                return;
            }
        },
    };
    page.line("unit", &format!("{:?}", unit.name), &because);
    if pick.kind == Unit::Pascal {
        let by_name = said.and_then(|said| Some((said.pressure?, said.because.clone())));
        match by_name.or_else(|| against(pick, column, unit, columns, picks)) {
            Some((pressure, because)) => {
                let word = match pressure {
                    Pressure::Gauge => "\"gauge\"",
                    Pressure::Absolute => "\"absolute\"",
                };
                page.line("pressure", word, &because);
            }
            None => page.ask(
                "pressure = \"gauge\"",
                &format!("it never rests, so that {range} {} may be above the atmosphere (\"gauge\") or \"absolute\"", unit.name),
                &described(column),
            ),
        }
    }
}

/// What a pressure is against, by where it rests or as another one of its log.
fn against(
    pick: &Pick,
    column: &Seen,
    unit: &LogUnit,
    columns: &[Seen],
    picks: &[Pick],
) -> Option<(Pressure, Because)> {
    let of_other = || {
        // What two pressures of one log are against is the same.
        let other = picks
            .iter()
            .find(|other| other.kind == Unit::Pascal && other.place != pick.place)?;
        let own = &columns[other.place];
        let unit = own.unit.as_ref()?.unit;
        let (pressure, _) = units::by_rest(own.numbers(), unit)?;
        Some((
            pressure,
            Because::likely(format!("as {} is", described(own))),
        ))
    };
    units::by_rest(column.numbers(), unit).or_else(of_other)
}

/// Columns that were taken for nothing.
fn unused(page: &mut Page, looked: &Looked, taken: &[usize], picks: &[Pick]) {
    let all = looked.columns.iter().enumerate();
    let left: Vec<&Seen> = all
        .filter(|(place, _)| !taken.contains(place) && !picks.iter().any(|p| p.place == *place))
        .map(|(_, column)| column)
        .collect();
    if left.is_empty() {
        return;
    }
    page.plain("");
    page.plain("# Not used:");
    for column in left {
        let what = match column.range() {
            Some([low, high]) => {
                let unit = column.unit.as_ref().map_or("", |said| said.unit.name);
                format!("{} to {} {unit}", shown(low), shown(high))
            }
            None => "no numbers".to_owned(),
        };
        page.plain(format!("#   {}: {what}", described(column)).trim_end());
    }
}

/// Inputs of a whole device that no log holds.
fn constants(page: &mut Page) {
    let found: Vec<&String> = page.found.iter().map(|(quantity, _)| quantity).collect();
    let measured = QUANTITIES
        .iter()
        .any(|(quantity, _)| found.iter().any(|f| *f == quantity));
    let absent: Vec<_> = DRIVING
        .iter()
        .filter(|(quantity, ..)| !found.iter().any(|f| f == quantity))
        .collect();
    if !measured && page.open.is_empty() {
        page.open.push(
            "no column is known by its name or unit: each needs a [[file.channel]]".to_owned(),
        );
    }
    for (quantity, what, keys) in absent {
        page.plain("");
        page.plain(&format!("# Asked, for `idc diagnose` of a whole device: {what}. No column looks like it. A [[file.channel]] names one; if it never changes:"));
        page.plain("# [[constant]]");
        page.plain(&format!("# quantity = {quantity:?}"));
        page.plain(&format!("# {keys}"));
    }
}

fn name(path: &std::path::Path) -> String {
    let name = path.file_name().unwrap_or(path.as_os_str());
    name.to_string_lossy()
        .chars()
        .filter(|c| !c.is_control())
        .collect()
}
