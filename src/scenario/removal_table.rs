//! The file of a removal table: which tables of runs there are, what their columns are, and the nominal law of removal. Strict SI but for speed and
//! wear, which stay in the unit of their columns.

use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::{Value, json};

use crate::keys::check::Section;
use crate::keys::declaration::of_file;
use crate::keys::declaration::{Plain, keys};
use crate::keys::document::{Document, read_text};
use crate::keys::error::ScenarioError;

/// Version of the format.
const SCHEMA: u32 = 1;
/// What `kind` says.
pub const REMOVAL_TABLE: &str = "removal_table";

/// Kind of a file, whatever else stands in it.
#[derive(Deserialize)]
struct KindKeys {
    kind: Option<String>,
}

impl Plain for FileKind {}

/// The one kind of such a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
enum FileKind {
    /// A table of runs.
    RemovalTable,
}

impl Plain for Law {}

/// Law of removal.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
enum Law {
    /// In proportion to force, speed and time.
    Preston,
    /// The same above a threshold force.
    Threshold,
    /// Powers of them.
    Power,
}

keys! {
    /// A table of runs: what a tool took off at which settings, and the nominal law of removal.
    struct FileKeys {
        /// version of the format
        schema: u32 = "schema" in 1..=1;
        /// what the file is
        kind: FileKind = "kind";
        /// name for people
        title: Option<String> = "title";
        /// tables of runs, CSV with a header, from the file's folder
        tables: TablesKeys = "tables";
        /// which column is what
        columns: ColumnsKeys = "columns";
        /// the nominal law
        nominal: NominalKeys = "believed";
    }

    /// `[tables]`.
    struct TablesKeys {
        /// tables to diagnose from
        fit: Vec<PathBuf> = "fit", being "at least one";
        /// tables to be predicted once the law is fitted
        predict: Option<Vec<PathBuf>> = "predict";
        /// rows of the tables to fit that are kept back, to be predicted
        hold_back: Option<HoldBack> = "hold_back";
    }

    /// Rows of the tables to fit that are kept back, to be predicted.
    pub struct HoldBack {
        /// column
        column: String = "column";
        /// from this value on, in the column's unit
        from: f64 = "from";
        /// up to this one
        to: f64 = "to";
    }

    /// `[columns]`.
    struct ColumnsKeys {
        /// normal force
        force: ColumnKeys = "force";
        /// grinding time, of a tool that rests; none beside `feed`
        time: Option<ColumnKeys> = "time";
        /// feed, of a tool that moves; none beside `time`
        feed: Option<ColumnKeys> = "feed";
        /// speed of the tool, in one unit throughout
        speed: Option<ColumnKeys> = "speed";
        /// whether the speed is that under load; false: as set without load, which may sag
        speed_under_load: bool = "speed_under_load", or true;
        /// contact area
        area: Option<ColumnKeys> = "area";
        /// wear before the run, in any unit
        wear: Option<ColumnKeys> = "wear";
        /// whether the wear is the sum of force x time x speed of the rows before, each table beginning with a new tool
        cumulate_wear: bool = "cumulate_wear", or false;
        /// volume that came off
        volume: ColumnKeys = "volume";
        /// column that is 0 of rows that count less
        weight: Option<WeightKeys> = "weight";
    }

    /// A column.
    struct ColumnKeys {
        /// name in the header
        name: String = "name";
        /// unit of its values
        unit: Option<String> = "unit";
        /// standard deviation of a volume, as far as it is known of how it is measured [%]
        scatter: Option<f64> = "scatter_percent" in 0..=100, shown "0";
    }

    /// `[columns.weight]`.
    struct WeightKeys {
        /// name in the header
        name: String = "name";
        /// weight of rows where it is 0; of the others 1
        where_0: f64 = "where_0" in 0.01..=1.0;
    }

    /// `[believed]`: the nominal law.
    struct NominalKeys {
        /// in proportion to force, speed and time; the same above a threshold force; powers of them
        law: Law = "law";
        /// volume that comes off at the reference settings; left out: to be fitted
        volume: Option<f64> = "reference_volume_mm3" in 1e-9..=1e9;
        /// force at which that comes off; left out: the mean of the table, as those below
        force: Option<f64> = "reference_force_n" in 1e-9..=1e9;
        /// time in which that comes off
        time: Option<f64> = "reference_time_s" in 1e-9..=1e9;
        /// feed at which that comes off
        feed: Option<f64> = "reference_feed_mm_per_s" in 1e-9..=1e9;
        /// speed at which that comes off, in the unit of its column
        speed: Option<f64> = "reference_speed" in 1e-9..=1e9;
        /// contact area at which that comes off
        area: Option<f64> = "reference_area_mm2" in 1e-9..=1e9;
        /// exponent of the force; needed with "power"
        force_exponent: Option<f64> = "force_exponent" in -5..=5, shown "1";
        /// exponent of the time, or of one over the feed
        time_exponent: f64 = "time_exponent" in -5..=5, or 1.0;
        /// exponent of the speed
        speed_exponent: f64 = "speed_exponent" in -5..=5, or 1.0;
        /// exponent of the contact area
        area_exponent: f64 = "area_exponent" in -5..=5, or 0.0;
        /// force below which nothing comes off; needed with "threshold"
        threshold: Option<f64> = "threshold_force_n" in 0.0..=1e5, shown "0";
        /// share of the speed that is lost per force [1/N]
        sag: f64 = "speed_sag_per_n" in 0..=10, or 0.0;
        /// natural logarithm of the volume that is lost per wear, in the unit of its column
        wear: f64 = "wear_rate" in 0.0..=1e9, or 0.0;
    }
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

/// Nominal law, [SI] but for speed and wear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NominalRemoval {
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
    pub nominal: NominalRemoval,
}

/// Whether a file says that it is of a removal table; not where it cannot be read.
#[must_use]
pub fn is_removal_table(path: &Path) -> bool {
    let Ok(text) = read_text(path) else {
        return false;
    };
    let kind =
        Document::new(path, &text, u32::MAX).and_then(|document| document.parse::<KindKeys>(&[]));
    kind.is_ok_and(|keys| keys.kind.as_deref() == Some(REMOVAL_TABLE))
}

/// Reads and checks the file.
///
/// # Errors
/// File, line, column and key of what is wrong, what was found and what was expected.
pub fn load_removal_table(path: &Path) -> Result<RemovalTableFile, ScenarioError> {
    let text = read_text(path)?;
    let document = Document::new(path, &text, SCHEMA)?;
    let keys: FileKeys = document.read()?;
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
    let nominal = nominal(&document, &keys.nominal, is_feed)?;
    let speed = optional("speed", &keys.columns.speed, &SPEEDS)?;
    Ok(RemovalTableFile {
        title: keys.title.unwrap_or_default(),
        fit: keys.tables.fit,
        predict: keys.tables.predict.unwrap_or_default(),
        hold_back: keys.tables.hold_back,
        force: column(&columns, "force", &keys.columns.force, &FORCES)?,
        time,
        is_feed,
        speed_under_load: speed.is_some() && keys.columns.speed_under_load,
        speed,
        area: optional("area", &keys.columns.area, &AREAS)?,
        wear: optional("wear", &keys.columns.wear, &[])?,
        cumulate_wear: keys.columns.cumulate_wear,
        scatter: keys.columns.volume.scatter.unwrap_or(0.0) / 100.0,
        volume: column(&columns, "volume", &keys.columns.volume, &VOLUMES)?,
        weight: (keys.columns.weight).map(|weight| (weight.name, weight.where_0)),
        nominal,
        path: path.to_owned(),
        text: text.clone(),
    })
}

/// Schema of the file.
#[must_use]
pub fn schema() -> Value {
    let mut schema = of_file::<FileKeys>("A table of runs of idc");
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
    if keys.scatter.is_some() && key != "volume" {
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

fn nominal(
    document: &Document<'_>,
    keys: &NominalKeys,
    is_feed: bool,
) -> Result<NominalRemoval, ScenarioError> {
    let section = Section::new(document, "believed");
    let needed = match keys.law {
        Law::Threshold if keys.threshold.is_none() => Some(("threshold_force_n", "threshold")),
        Law::Power if keys.force_exponent.is_none() => Some(("force_exponent", "power")),
        _ => None,
    };
    if let Some((key, law)) = needed {
        return Err(section.missing(key, &format!("it to be given of law = {law:?}")));
    }
    if keys.volume.is_some() && keys.force.is_none() {
        let expected = "the settings at which the tool takes off `reference_volume_mm3`";
        return Err(section.missing("reference_force_n", expected));
    }
    Ok(NominalRemoval {
        volume: keys.volume,
        force: keys.force,
        time: match is_feed {
            true => keys.feed.map(|feed| 1.0 / feed),
            false => keys.time,
        },
        speed: keys.speed,
        area: keys.area,
        exponents: [
            keys.force_exponent.unwrap_or(1.0),
            keys.time_exponent,
            keys.speed_exponent,
            keys.area_exponent,
        ],
        threshold: keys.threshold.unwrap_or(0.0),
        sag: keys.sag,
        wear: keys.wear,
    })
}
