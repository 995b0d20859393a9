//! The file of a removal table: which tables of runs there are, what their columns are, and which law of removal is believed. Strict SI but for speed and
//! wear, which stay in the unit of their columns.

use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::{Value, json};

use super::check::Section;
use super::document::{Document, read_text};
use super::error::ScenarioError;
use super::schema::plain_schema;

/// Version of the format.
const SCHEMA: u32 = 1;
/// What `kind` says.
pub const REMOVAL_TABLE: &str = "removal_table";

fn sections() -> Vec<(String, Vec<&'static str>)> {
    let sections: [(&str, &[&str]); 6] = [
        (
            "",
            &["schema", "kind", "title", "tables", "columns", "believed"],
        ),
        ("tables", &["fit", "predict", "hold_back"]),
        ("tables.hold_back", &["column", "from", "to"]),
        (
            "columns",
            &[
                "force",
                "time",
                "feed",
                "speed",
                "speed_under_load",
                "area",
                "wear",
                "cumulate_wear",
                "volume",
                "weight",
            ],
        ),
        ("columns.*", &["name", "unit", "where_0", "scatter_percent"]),
        (
            "believed",
            &[
                "law",
                "reference_volume_mm3",
                "reference_force_n",
                "reference_time_s",
                "reference_feed_mm_per_s",
                "reference_speed",
                "reference_area_mm2",
                "force_exponent",
                "time_exponent",
                "speed_exponent",
                "area_exponent",
                "threshold_force_n",
                "speed_sag_per_n",
                "wear_rate",
            ],
        ),
    ];
    sections
        .map(|(table, keys)| (table.to_owned(), keys.to_vec()))
        .to_vec()
}

/// Kind of a file, whatever else stands in it.
#[derive(Deserialize)]
struct KindKeys {
    kind: Option<String>,
}

/// A table of runs: what a tool took off at which settings, and the law of removal that is believed.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct FileKeys {
    /// Version of the format.
    #[expect(dead_code, reason = "checked by Document::new")]
    #[schemars(range(min = 1, max = 1))]
    schema: u32,
    /// What the file is.
    #[expect(dead_code, reason = "checked before the file is read as this")]
    #[schemars(extend("const" = REMOVAL_TABLE))]
    kind: String,
    /// Name for people.
    title: Option<String>,
    /// Tables of runs, CSV with a header, from the file's folder.
    tables: TablesKeys,
    /// Which column is what.
    columns: ColumnsKeys,
    /// The law that is believed.
    believed: BelievedKeys,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct TablesKeys {
    /// Tables to diagnose from.
    #[schemars(length(min = 1))]
    fit: Vec<PathBuf>,
    /// Tables to be predicted once the law is fitted.
    #[serde(default)]
    predict: Vec<PathBuf>,
    /// Rows of the tables to fit that are kept back, to be predicted.
    hold_back: Option<HoldBack>,
}

/// Rows of the tables to fit that are kept back, to be predicted.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HoldBack {
    /// Column.
    pub column: String,
    /// From this value on, in the column's unit.
    pub from: f64,
    /// Up to this one.
    pub to: f64,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct ColumnsKeys {
    /// Normal force.
    force: ColumnKeys,
    /// Grinding time, of a tool that rests; none beside `feed`.
    time: Option<ColumnKeys>,
    /// Feed, of a tool that moves; none beside `time`.
    feed: Option<ColumnKeys>,
    /// Speed of the tool, in one unit throughout.
    speed: Option<ColumnKeys>,
    /// Whether the speed is that under load; false: as set without load, which may sag.
    #[schemars(extend("default" = true))]
    speed_under_load: Option<bool>,
    /// Contact area.
    area: Option<ColumnKeys>,
    /// Wear before the run, in any unit.
    wear: Option<ColumnKeys>,
    /// Whether the wear is the sum of force x time x speed of the rows before, each table beginning with a new tool.
    #[serde(default)]
    cumulate_wear: bool,
    /// Volume that came off.
    volume: ColumnKeys,
    /// Column that is 0 of rows that count less.
    weight: Option<WeightKeys>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct ColumnKeys {
    /// Name in the header.
    name: String,
    /// Unit of its values.
    unit: Option<String>,
    /// Standard deviation of a volume, as far as it is known of how it is measured [%].
    #[schemars(range(min = 0, max = 100), extend("default" = 0))]
    scatter_percent: Option<f64>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct WeightKeys {
    /// Name in the header.
    name: String,
    /// Weight of rows where it is 0; of the others 1.
    #[schemars(range(min = 0.01, max = 1))]
    where_0: f64,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct BelievedKeys {
    /// "preston": in proportion to force, speed and time; "threshold": the same above a threshold force; "power": powers of them.
    #[schemars(extend("enum" = LAWS))]
    law: String,
    /// Volume that comes off at the reference settings [mm3]; left out: to be fitted.
    #[schemars(range(min = 1e-9, max = 1e9))]
    reference_volume_mm3: Option<f64>,
    /// Force at which that comes off [N]; left out: the mean of the table, as those below.
    #[schemars(range(min = 1e-9, max = 1e9))]
    reference_force_n: Option<f64>,
    /// Time in which that comes off [s].
    #[schemars(range(min = 1e-9, max = 1e9))]
    reference_time_s: Option<f64>,
    /// Feed at which that comes off [mm/s].
    #[schemars(range(min = 1e-9, max = 1e9))]
    reference_feed_mm_per_s: Option<f64>,
    /// Speed at which that comes off, in the unit of its column.
    #[schemars(range(min = 1e-9, max = 1e9))]
    reference_speed: Option<f64>,
    /// Contact area at which that comes off [mm2].
    #[schemars(range(min = 1e-9, max = 1e9))]
    reference_area_mm2: Option<f64>,
    /// Exponent of the force; needed with "power".
    #[schemars(range(min = -5, max = 5), extend("default" = 1))]
    force_exponent: Option<f64>,
    /// Exponent of the time, or of one over the feed.
    #[schemars(range(min = -5, max = 5), extend("default" = 1))]
    time_exponent: Option<f64>,
    /// Exponent of the speed.
    #[schemars(range(min = -5, max = 5), extend("default" = 1))]
    speed_exponent: Option<f64>,
    /// Exponent of the contact area.
    #[schemars(range(min = -5, max = 5), extend("default" = 0))]
    area_exponent: Option<f64>,
    /// Force below which nothing comes off [N]; needed with "threshold".
    #[schemars(range(min = 0, max = 1e5), extend("default" = 0))]
    threshold_force_n: Option<f64>,
    /// Share of the speed that is lost per force [1/N].
    #[schemars(range(min = 0, max = 10), extend("default" = 0))]
    speed_sag_per_n: Option<f64>,
    /// Natural logarithm of the volume that is lost per wear, in the unit of its column.
    #[schemars(range(min = 0, max = 1e9), extend("default" = 0))]
    wear_rate: Option<f64>,
}

/// A column and its unit.
#[derive(Debug, Clone, PartialEq)]
pub struct TableColumn {
    /// Name in the header.
    pub name: String,
    /// Its unit as written; empty where it is free.
    pub unit: String,
    /// That unit in SI.
    pub factor: f64,
}

/// Law that is believed, [SI] but for speed and wear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BelievedRemoval {
    /// Volume at the reference settings [m3]; none: to be fitted.
    pub volume: Option<f64>,
    /// Reference force [N]; none: the mean of the table. So the others.
    pub force: Option<f64>,
    /// Reference time [s], or one over the feed [s/m].
    pub time: Option<f64>,
    /// Reference speed in the column's unit.
    pub speed: Option<f64>,
    /// Reference area [m2].
    pub area: Option<f64>,
    /// Exponents of force, time, speed and area [1].
    pub exponents: [f64; 4],
    /// Threshold [N].
    pub threshold: f64,
    /// Share of the speed lost per force [1/N].
    pub sag: f64,
    /// Natural logarithm lost per wear.
    pub wear: f64,
}

/// The file, checked.
#[derive(Debug, Clone)]
pub struct RemovalTableFile {
    /// Its path.
    pub path: PathBuf,
    /// Its title.
    pub title: String,
    /// Its text.
    pub text: String,
    /// Tables to fit.
    pub fit: Vec<PathBuf>,
    /// Tables to predict.
    pub predict: Vec<PathBuf>,
    /// Rows kept back.
    pub hold_back: Option<HoldBack>,
    /// Force.
    pub force: TableColumn,
    /// Grinding time, or feed.
    pub time: Option<TableColumn>,
    /// Whether `time` is a feed.
    pub is_feed: bool,
    /// Cutting speed.
    pub speed: Option<TableColumn>,
    /// Whether the speed was measured under load.
    pub speed_under_load: bool,
    /// Contact area.
    pub area: Option<TableColumn>,
    /// Wear before the run.
    pub wear: Option<TableColumn>,
    /// Whether the wear is the sum of force x speed x time of the rows before, each table beginning with a new tool.
    pub cumulate_wear: bool,
    /// Volume.
    pub volume: TableColumn,
    /// Standard deviation of a volume over it that is known of how it is measured [1].
    pub scatter: f64,
    /// Column that is 0 of rows of less weight, and that weight.
    pub weight: Option<(String, f64)>,
    /// The law.
    pub believed: BelievedRemoval,
}

/// Whether a file says that it is of a removal table; not where it cannot be read.
#[must_use]
pub fn is_removal_table(path: &Path) -> bool {
    let Ok(text) = read_text(path) else {
        return false;
    };
    let kind = Document::new(path, &text, u32::MAX)
        .and_then(|document| document.parse::<KindKeys>(&sections()));
    kind.is_ok_and(|keys| keys.kind.as_deref() == Some(REMOVAL_TABLE))
}

/// Reads and checks the file.
///
/// # Errors
/// File, line, column and key of what is wrong, what was found and what was expected.
pub fn load_removal_table(path: &Path) -> Result<RemovalTableFile, ScenarioError> {
    let text = read_text(path)?;
    let document = Document::new(path, &text, SCHEMA)?;
    let keys: FileKeys = document.parse(&sections())?;
    let tables = Section::new(&document, "tables");
    if keys.tables.fit.is_empty() {
        return Err(tables.refuse("fit", "empty".into(), "the tables to diagnose from".into()));
    }
    let columns = Section::new(&document, "columns");
    let is_feed = keys.columns.feed.is_some();
    let time = match (&keys.columns.time, &keys.columns.feed) {
        (Some(_), Some(_)) => {
            let expected = "either `time` of a tool at rest or `feed` of one that moves";
            return Err(columns.refuse("feed", "beside `time`".into(), expected.into()));
        }
        (Some(time), None) => Some(column(&columns, "time", time, &TIMES)?),
        (None, Some(feed)) => Some(column(&columns, "feed", feed, &FEEDS)?),
        (None, None) => None,
    };
    if keys.columns.cumulate_wear && (keys.columns.wear.is_some() || time.is_none()) {
        let expected = "false beside a column of the wear, or without one of time or feed";
        return Err(columns.refuse("cumulate_wear", "true".into(), expected.into()));
    }
    let optional = |key: &str, keys: &Option<ColumnKeys>, units: &[(&str, f64)]| {
        keys.as_ref()
            .map(|keys| column(&columns, key, keys, units))
            .transpose()
    };
    let weight = match keys.columns.weight {
        None => None,
        Some(weight) => {
            let section = Section::new(&document, "columns.weight");
            Some((
                weight.name,
                section.number("where_0", weight.where_0, 0.01..=1.0)?,
            ))
        }
    };
    let believed = believed(&document, &keys.believed, is_feed)?;
    let speed = optional("speed", &keys.columns.speed, &SPEEDS)?;
    Ok(RemovalTableFile {
        title: keys.title.unwrap_or_default(),
        fit: keys.tables.fit,
        predict: keys.tables.predict,
        hold_back: keys.tables.hold_back,
        force: column(&columns, "force", &keys.columns.force, &FORCES)?,
        time,
        is_feed,
        speed_under_load: speed.is_some() && keys.columns.speed_under_load.unwrap_or(true),
        speed,
        area: optional("area", &keys.columns.area, &AREAS)?,
        wear: optional("wear", &keys.columns.wear, &[])?,
        cumulate_wear: keys.columns.cumulate_wear,
        scatter: Section::new(&document, "columns.volume").number(
            "scatter_percent",
            keys.columns.volume.scatter_percent.unwrap_or(0.0),
            0.0..=100.0,
        )? / 100.0,
        volume: column(&columns, "volume", &keys.columns.volume, &VOLUMES)?,
        weight,
        believed,
        path: path.to_owned(),
        text: text.clone(),
    })
}

/// Schema of the file.
#[must_use]
pub fn schema() -> Value {
    let mut schema = plain_schema::<FileKeys>();
    let columns = &mut schema["properties"]["columns"]["properties"];
    let units: [(&str, &[(&str, f64)]); 7] = [
        ("force", &FORCES),
        ("time", &TIMES),
        ("feed", &FEEDS),
        ("speed", &SPEEDS),
        ("area", &AREAS),
        ("wear", &[]),
        ("volume", &VOLUMES),
    ];
    for (key, units) in units {
        let column = &mut columns[key];
        let names: Vec<&str> = units.iter().map(|(name, _)| *name).collect();
        if !names.is_empty() {
            column["properties"]["unit"]["enum"] = json!(names);
            column["required"] = json!(["name", "unit"]);
        }
        if let Some(keys) = column["properties"]
            .as_object_mut()
            .filter(|_| key != "volume")
        {
            keys.remove("scatter_percent");
        }
    }
    schema
}

/// Words for a law.
const LAWS: [&str; 3] = ["preston", "threshold", "power"];
const FORCES: [(&str, f64); 2] = [("N", 1.0), ("kN", 1e3)];
const TIMES: [(&str, f64); 3] = [("s", 1.0), ("ms", 1e-3), ("min", 60.0)];
const FEEDS: [(&str, f64); 4] = [
    ("mm/s", 1e-3),
    ("m/s", 1.0),
    ("mm/min", 1e-3 / 60.0),
    ("m/min", 1.0 / 60.0),
];
const SPEEDS: [(&str, f64); 3] = [("1/min", 1.0), ("m/s", 1.0), ("m/min", 1.0)];
const AREAS: [(&str, f64); 3] = [("mm2", 1e-6), ("cm2", 1e-4), ("m2", 1.0)];
const VOLUMES: [(&str, f64); 3] = [("mm3", 1e-9), ("cm3", 1e-6), ("m3", 1.0)];

/// A column whose unit is one of those; any where there are none.
fn column(
    columns: &Section<'_>,
    key: &str,
    keys: &ColumnKeys,
    units: &[(&str, f64)],
) -> Result<TableColumn, ScenarioError> {
    columns.text(&format!("{key}.name"), &keys.name)?;
    if keys.scatter_percent.is_some() && key != "volume" {
        let reason = "the scatter that counts is that of the volume".to_owned();
        return Err(columns.misplaced(&format!("{key}.scatter_percent"), reason));
    }
    let unit = keys.unit.clone().unwrap_or_default();
    let factor = match units {
        [] => 1.0,
        _ => {
            let known = units.iter().find(|(name, _)| *name == unit);
            let names: Vec<&str> = units.iter().map(|(name, _)| *name).collect();
            let expected = || format!("one of {}", names.join(", "));
            match (known, &keys.unit) {
                (Some((_, factor)), _) => *factor,
                (None, Some(_)) => {
                    return Err(columns.refuse(&format!("{key}.unit"), unit, expected()));
                }
                (None, None) => {
                    return Err(columns.missing(&format!("{key}.unit"), &expected()));
                }
            }
        }
    };
    Ok(TableColumn {
        name: keys.name.clone(),
        unit,
        factor,
    })
}

fn believed(
    document: &Document<'_>,
    keys: &BelievedKeys,
    is_feed: bool,
) -> Result<BelievedRemoval, ScenarioError> {
    let section = Section::new(document, "believed");
    let needed: &[(&str, bool)] = match keys.law.as_str() {
        "preston" => &[],
        "threshold" => &[("threshold_force_n", keys.threshold_force_n.is_some())],
        "power" => &[("force_exponent", keys.force_exponent.is_some())],
        other => {
            let expected =
                "\"preston\", \"threshold\" (with a threshold force) or \"power\" (with exponents)";
            return Err(section.refuse("law", format!("{other:?}"), expected.into()));
        }
    };
    if let Some((key, _)) = needed.iter().find(|(_, given)| !given) {
        return Err(section.missing(key, &format!("it to be given of law = {:?}", keys.law)));
    }
    let positive = |key: &str, value: Option<f64>| {
        value
            .map(|value| section.number(key, value, 1e-9..=1e9))
            .transpose()
    };
    let exponent = |key: &str, value: Option<f64>, usual: f64| {
        section.number_or(key, value, usual, -5.0..=5.0)
    };
    let feed = positive("reference_feed_mm_per_s", keys.reference_feed_mm_per_s)?;
    let time = positive("reference_time_s", keys.reference_time_s)?;
    let volume = positive("reference_volume_mm3", keys.reference_volume_mm3)?;
    let force = positive("reference_force_n", keys.reference_force_n)?;
    if volume.is_some() && force.is_none() {
        let expected = "the settings at which the tool takes off `reference_volume_mm3`";
        return Err(section.missing("reference_force_n", expected));
    }
    Ok(BelievedRemoval {
        volume,
        force,
        time: if is_feed {
            feed.map(|feed| 1.0 / feed)
        } else {
            time
        },
        speed: positive("reference_speed", keys.reference_speed)?,
        area: positive("reference_area_mm2", keys.reference_area_mm2)?,
        exponents: [
            exponent("force_exponent", keys.force_exponent, 1.0)?,
            exponent("time_exponent", keys.time_exponent, 1.0)?,
            exponent("speed_exponent", keys.speed_exponent, 1.0)?,
            exponent("area_exponent", keys.area_exponent, 0.0)?,
        ],
        threshold: section.number_or(
            "threshold_force_n",
            keys.threshold_force_n,
            0.0,
            0.0..=1e5,
        )?,
        sag: section.number_or("speed_sag_per_n", keys.speed_sag_per_n, 0.0, 0.0..=10.0)?,
        wear: section.number_or("wear_rate", keys.wear_rate, 0.0, 0.0..=1e9)?,
    })
}
