//! The draft of a map as a commented TOML file.

use std::fmt::Write;
use std::path::PathBuf;

use super::assign::{Pick, QUANTITIES, described};
use super::sections::{self, Sections};
use super::seen::{Because, Draft, Looked, Seen, TimeSeen};
use super::table::is_vector;
use super::time::{self, TimeChoice, toml_text, written};
use super::units::{self, shown};
use crate::import::map::Pressure;
use crate::import::units::LogUnit;
use crate::recording::{Unit, schema};

/// Column at which comments begin.
const COMMENT: usize = 44;

/// End of the quantity of a joint's angle.
const ENCODER: &str = "_encoder";

/// Inputs of a whole device, and the remedy for one that the logs lack.
const DRIVING: [(&str, &str, &str); 3] = [
    (
        schema::SET_PRESSURE_GAUGE,
        "set pressure of the regulator",
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

/// A text that grows, with what could not be determined.
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
    let given: Vec<String> = page
        .found
        .iter()
        .map(|(quantity, _)| quantity.clone())
        .collect();
    let parts = sections::of(looked, paths.len(), &given);
    for (number, part) in parts.sections.iter().enumerate() {
        page.plain("");
        let of = if number == 0 {
            ""
        } else {
            ", another clock of it"
        };
        page.plain(&format!("[[file]]   # {}{of}", names.join(", ")));
        if number > 0 {
            page.put("same_log = true", "the log of the [[file]] before");
        }
        form(page, looked, number > 0);
        if let Some((column, value)) = &part.rows {
            let chosen = format!(
                "rows = {{ column = {}, value = {} }}",
                written(column),
                toml_text(value)
            );
            page.put(&chosen, "each row has another variable; these are its rows");
        }
        times(page, part.time.as_ref(), looked, &names[0]);
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
        for pick in &part.picks {
            let odd = looked.odd_units.get(pick.place).cloned().flatten();
            let column = &parts.columns[pick.place];
            channel(page, pick, column, odd, &parts.columns, &parts.picks);
        }
    }
    unused(page, &parts);
}

/// The form of a log; of its further clocks without the reasons.
fn form(page: &mut Page, looked: &Looked, is_again: bool) {
    let again = "as above";
    let is_text = looked.head.first().is_none_or(|line| line.key != "form");
    if is_text && is_again {
        page.put("form = \"text\"", again);
    } else if is_text {
        page.line("form", "\"text\"", &Because::certain("it is one"));
    }
    for line in &looked.head {
        let asked = looked.asked.iter().find(|(key, _)| *key == line.key);
        match asked {
            // What stands there is no mark, so that nothing is read before it is filled in.
            Some((key, question)) => {
                page.put(&format!("{key} = \"\""), &format!("asked: {question}"));
                if !is_again {
                    page.open.push(format!("{key}: {question}"));
                }
            }
            None if is_again => page.put(&format!("{} = {}", line.key, line.value), again),
            None => page.line(line.key, &line.value, &line.because),
        }
    }
    if !is_again {
        for note in &looked.notes {
            page.plain(&format!("# {note}"));
        }
    }
}

/// The times of a section, or what is asked of them.
fn times(page: &mut Page, choice: Option<&TimeChoice>, looked: &Looked, name: &str) {
    let Some(choice) = choice else {
        if looked.time == TimeSeen::Column {
            let what = time::nothing_found(looked);
            page.ask("time = { column = 1, unit = \"ms\" }", &what, "times");
        }
        return;
    };
    let keys: Vec<String> = choice
        .keys
        .iter()
        .map(|(k, v)| format!("{k} = {v}"))
        .collect();
    let rate = choice
        .sample_rate
        .map(|rate| format!("sample_rate_hz = {}", plain(rate)));
    let time = (!keys.is_empty()).then(|| format!("time = {{ {} }}", keys.join(", ")));
    let lines = [time, rate];
    let lines = lines.iter().flatten();
    match &choice.open {
        None => lines.for_each(|line| page.put(line, &choice.because.to_string())),
        Some(what) => {
            let mut lines: Vec<String> = lines.cloned().collect();
            if lines.is_empty() {
                lines.push("time = { column = 1, unit = \"ms\" }".to_owned());
            }
            let sign = if choice.is_blocked { "# " } else { "" };
            for line in lines {
                page.put(&format!("{sign}{line}"), &format!("asked: {what}"));
            }
            page.open.push(format!("times of {name}: {what}"));
        }
    }
}

/// A rate with no more digits than tell it.
fn plain(rate: f64) -> String {
    let rounded = (rate * 1e3).round() / 1e3;
    let near = (rate.round() / rate - 1.0).abs() < 1e-9;
    if near {
        format!("{}", rate.round())
    } else {
        format!("{rounded}")
    }
}

fn channel(
    page: &mut Page,
    pick: &Pick,
    column: &Seen,
    odd: Option<String>,
    columns: &[Seen],
    picks: &[Pick],
) {
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
    let said = pick
        .unit
        .as_ref()
        .or(column.unit.as_ref())
        .filter(|said| said.unit.si == pick.kind);
    let (unit, because) = match said {
        Some(said) => (said.unit, said.because.clone()),
        None if pick.kind == Unit::One => match crate::import::units::named("1") {
            Some(unit) => (unit, Because::certain("on and off have no unit")),
            None => return,
        },
        None => match by_size(column, odd, pick.kind, [low, high]) {
            Ok(found) => found,
            Err(what) => {
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

/// A unit by the size of a column's numbers, or the question where that does not tell it, or its name says one that nobody here knows.
fn by_size(
    column: &Seen,
    odd: Option<String>,
    kind: Unit,
    [low, high]: [f64; 2],
) -> Result<(&'static LogUnit, Because), String> {
    let choices = units::choices(kind);
    if let Some(odd) = odd.or_else(|| units::odd_unit(&column.name)) {
        return Err(format!(
            "the log says `{odd}`, which is no unit known here; `gain` makes one of it, one of {choices}"
        ));
    }
    units::by_size(kind, [low, high]).ok_or_else(|| {
        let range = format!("{} to {}", shown(low), shown(high));
        format!("nothing says it, and {range} is usual in no unit alone; one of {choices}")
    })
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
fn unused(page: &mut Page, parts: &Sections) {
    let all = parts.columns.iter().enumerate();
    let left: Vec<(usize, &Seen)> = all
        .filter(|(place, _)| !parts.taken.contains(place))
        .filter(|(place, _)| !parts.picks.iter().any(|pick| pick.place == *place))
        .collect();
    if left.is_empty() {
        return;
    }
    page.plain("");
    page.plain("# Not used:");
    for (place, column) in left {
        let sample = parts.samples.get(place).map_or("", String::as_str);
        let what = match column.range() {
            Some([low, high]) => {
                let unit = column.unit.as_ref().map_or("", |said| said.unit.name);
                let electric = ["V", "mV", "A", "mA"].contains(&unit);
                let hint = if electric {
                    "; of a sensor `gain` and `offset` make its unit of it"
                } else {
                    ""
                };
                format!("{} to {} {unit}{hint}", shown(low), shown(high))
            }
            None if is_vector(sample) => format!(
                "vectors such as `{sample}`; `column = \"{}[0]\"` is the first element",
                column.name
            ),
            None if sample.is_empty() => "no numbers".to_owned(),
            None => format!("no numbers, `{sample}`"),
        };
        page.plain(format!("#   {}: {what}", described(column)).trim_end());
    }
}

/// Inputs of a whole device that no log holds.
fn constants(page: &mut Page) {
    let found: Vec<&String> = page.found.iter().map(|(quantity, _)| quantity).collect();
    let is_input = |quantity: &&String| DRIVING.iter().any(|(own, ..)| quantity == own);
    let is_joint = |quantity: &&String| quantity.ends_with(ENCODER);
    if found.iter().any(is_joint) && !found.iter().any(is_input) {
        // An arm alone has no device that is driven.
        return;
    }
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
