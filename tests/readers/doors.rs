//! The readers of foreign files, a door each: bytes go in, and how far they came goes out. The tests and the fuzz targets of `fuzz/` call the same ones.

use std::path::{Path, PathBuf};

use idc_cell::arm::urdf::{
    ArmError, ArmOptions, draft_of, load_arm, mesh_files, mount_of_recorded,
};
use idc_cell::diagnosis::answer::Answer;
use idc_cell::document::{html, markdown};
use idc_cell::import::{ImportError, draft, import, load_map, map_of_bag};
use idc_cell::plant::{Expression, SYMBOLS, Unit};
use idc_cell::recording::csv::{EdgeProfile, read_cell_csv, read_csv, read_log_csv, read_readings};
use idc_cell::recording::long_table::read_long;
use idc_cell::recording::parquet::read_parquet;
use idc_cell::recording::{RecordedChannel, Recording, RecordingError, Unit as SiUnit};
use idc_cell::report::{RunReport, Sketches};
use idc_cell::run::RunResult;
use idc_cell::scenario::arm_file::load_arm_file;
use idc_cell::scenario::postures_file::load_postures_file;
use idc_cell::scenario::removal_table::load_removal_table;
use idc_cell::scenario::rig_file::load_rig;
use idc_cell::scenario::{ScenarioError, load_any, load_device, load_recorded_cell};
use idc_cell::workpiece::{BurrProfile, load_mesh};

use super::zip::workbook;

/// How far a reader came with its input.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Reached {
    /// It was refused for what it begins with, or is no file of its format at all.
    Header,
    /// It was refused for what stands in it.
    Content,
    /// It was read.
    End,
}

/// A reader.
pub struct Door {
    /// Its name, which its fuzz target has too.
    pub name: &'static str,
    /// Ending of its files.
    ending: &'static str,
    read: fn(&Path, &Room) -> Reached,
}

const fn at(name: &'static str, ending: &'static str, read: fn(&Path, &Room) -> Reached) -> Door {
    Door { name, ending, read }
}

/// All of them.
#[rustfmt::skip] // A table: one door a line.
pub const DOORS: [Door; 26] = [
    at("scenario", "toml", |file, _| of_keys(load_any(file))),
    at("device", "toml", |file, _| of_keys(load_device(file))),
    at("rig", "toml", |file, _| of_keys(load_rig(file))),
    at("recorded_arm", "toml", |file, _| of_keys(load_arm_file(file))),
    at("recorded_cell", "toml", |file, _| of_keys(load_recorded_cell(file))),
    at("postures", "toml", |file, _| of_keys(load_postures_file(file))),
    at("removal_table", "toml", |file, _| of_keys(load_removal_table(file))),
    at("import_map", "toml", |file, _| of_keys(load_map(file))),
    at("urdf", "urdf", urdf),
    at("stl", "stl", mesh),
    at("obj", "obj", mesh),
    at("collada", "dae", mesh),
    at("ply", "ply", mesh),
    at("gltf", "gltf", mesh),
    at("csv", "csv", csv),
    at("text_log", "csv", log),
    at("mcap", "mcap", log),
    at("run_bag", "mcap", run_bag),
    at("sqlite", "db3", log),
    at("mat", "mat", log),
    at("parquet_log", "parquet", log),
    at("tdms", "tdms", log),
    at("spreadsheet", "xlsx", log),
    at("parquet", "parquet", parquet),
    at("expression", "txt", expression),
    at("result", "json", result),
];

/// The door of a name.
pub fn door(name: &str) -> &'static Door {
    let found = DOORS.iter().find(|door| door.name == name);
    found.expect("a door of that name is listed")
}

impl Door {
    /// Reads these bytes as a file of its kind.
    pub fn open(&self, room: &Room, bytes: &[u8]) -> Reached {
        let file = room.scenarios().join(format!("input.{}", self.ending));
        let is_bare = self.ending == "xlsx" && !bytes.starts_with(b"PK");
        // The check sums of an archive would keep all but a few inputs out: what is changed is the sheet in it.
        let written = match is_bare {
            true => std::fs::write(&file, workbook(bytes)),
            false => std::fs::write(&file, bytes),
        };
        written.expect("the folder can be written to");
        (self.read)(&file, room)
    }
}

/// A folder with the files that others lead to.
pub struct Room {
    folder: tempfile::TempDir,
    /// Map of a log, by its ending.
    maps: Vec<(&'static str, idc_cell::import::ImportMap)>,
}

impl Room {
    /// Makes one, of the files of the project that lies there.
    pub fn new(project: &Path) -> Self {
        let folder = tempfile::tempdir().expect("a folder can be made");
        for name in [
            "models/device.toml",
            "models/arm/arm10.urdf",
            "models/arm/arm10.toml",
            "assets/plate.stl",
            "assets/bracket.stl",
        ] {
            let copy = folder.path().join(name);
            std::fs::create_dir_all(copy.parent().expect("it has a folder")).expect("made");
            std::fs::copy(project.join(name), copy).expect("the project has it");
        }
        std::fs::create_dir(folder.path().join("scenarios")).expect("a folder can be made");
        let map = |(ending, keys): (&'static str, &str)| {
            let file = folder.path().join("map.toml");
            let text = format!("schema = 1\ntitle = \"A map\"\n[[file]]\n{keys}");
            std::fs::write(&file, text).expect("the folder can be written to");
            (ending, load_map(&file).expect("the map is one"))
        };
        let maps = MAPS.map(map).into();
        Self { folder, maps }
    }

    fn scenarios(&self) -> PathBuf {
        self.folder.path().join("scenarios")
    }
}

/// Maps of the logs that `seeds` makes, by the logs' endings.
const MAPS: [(&str, &str); 7] = [
    (
        "csv",
        "form = \"text\"\nseparator = \",\"\nheader_lines = 1\nnames_line = 1\ntime = { column = \"t\", unit = \"s\" }\n[[file.channel]]\nquantity = \"force\"\ncolumn = \"F\"\nunit = \"N\"\n",
    ),
    (
        "mcap",
        "form = \"bag\"\ntime = { column = \"header.stamp\" }\naccept_truncated = true\n[[file.channel]]\nquantity = \"force\"\ncolumn = \"/wrench.wrench.force.z\"\nunit = \"N\"\n",
    ),
    (
        "db3",
        "form = \"bag\"\ntime = { column = \"header.stamp\" }\naccept_truncated = true\n[[file.channel]]\nquantity = \"force\"\ncolumn = \"/wrench.wrench.force.z\"\nunit = \"N\"\n",
    ),
    (
        "mat",
        "form = \"mat5\"\naccept_truncated = true\ntime = { column = \"t\", unit = \"ms\" }\n[[file.channel]]\nquantity = \"force\"\ncolumn = \"F\"\nunit = \"N\"\n",
    ),
    (
        "parquet",
        "form = \"parquet\"\ntime = { column = \"stamp\", unit = \"ms\" }\n[[file.channel]]\nquantity = \"force\"\ncolumn = \"contact_force_n\"\nunit = \"N\"\n",
    ),
    (
        "tdms",
        "form = \"tdms\"\naccept_truncated = true\n[[file.channel]]\nquantity = \"force\"\ncolumn = \"Bench/Force\"\nunit = \"N\"\n",
    ),
    (
        "xlsx",
        "form = \"spreadsheet\"\nheader_lines = 1\nnames_line = 1\ntime = { column = \"t\", unit = \"s\" }\n[[file.channel]]\nquantity = \"force\"\ncolumn = \"F\"\nunit = \"N\"\n",
    ),
];

/// Every refusal has its words.
fn said(error: &impl std::fmt::Display) {
    assert!(!error.to_string().is_empty(), "a refusal says nothing");
}

fn of_keys<T>(read: Result<T, ScenarioError>) -> Reached {
    let Err(error) = read else {
        return Reached::End;
    };
    said(&error);
    match error {
        ScenarioError::Syntax { .. }
        | ScenarioError::Schema { .. }
        | ScenarioError::Read { .. } => Reached::Header,
        _ => Reached::Content,
    }
}

fn urdf(file: &Path, _: &Room) -> Reached {
    let drafted = draft_of(file);
    let [base_link, tip] = match (&drafted, mount_of_recorded(file)) {
        (Ok(draft), _) => [
            draft.mount.base_link.clone(),
            Some(draft.mount.flange_link.clone()),
        ],
        (_, Ok(mount)) => [mount.base_link, Some(mount.flange_link)],
        _ => [None, None],
    };
    let mut options = ArmOptions {
        base_link,
        tip_link: tip.unwrap_or_else(|| "tool0".to_owned()),
        ..ArmOptions::default()
    };
    let _ = mesh_files(file, &options);
    let mut reached = Reached::Header;
    for is_recorded in [false, true] {
        options.is_recorded = is_recorded;
        let own = match load_arm(file, &options) {
            Ok(_) => Reached::End,
            Err(error) => {
                said(&error);
                match error {
                    ArmError::Refused { .. } => Reached::Content,
                    _ => Reached::Header,
                }
            }
        };
        reached = reached.max(own);
    }
    reached
}

fn mesh(file: &Path, _: &Room) -> Reached {
    match idc_cell::mesh_file::read(file) {
        Ok(_) => {
            // As a part: points joined, holes mended or named.
            if let Err(error) = load_mesh(file, 1e-3) {
                said(&error);
            }
            Reached::End
        }
        Err(error) => {
            said(&error);
            let words = error.to_string();
            let past = PAST_HEADER.iter().any(|part| words.contains(part));
            if past {
                Reached::Content
            } else {
                Reached::Header
            }
        }
    }
}

/// What refusals of a mesh say that lie behind its header, or behind well-formed XML or JSON.
const PAST_HEADER: [&str; 3] = [": line ", "is not supported", "malformed mesh: its <"];

/// How far a table came: a refused header is one at its first line.
fn of_table<T>(read: Result<T, RecordingError>) -> Reached {
    let Err(error) = read else {
        return Reached::End;
    };
    said(&error);
    match error {
        RecordingError::Read { .. } | RecordingError::Column { .. } => Reached::Header,
        _ => Reached::Content,
    }
}

fn csv(file: &Path, _: &Room) -> Reached {
    let burr = BurrProfile::from_csv(file).inspect_err(said);
    let edge = EdgeProfile::read(file);
    [
        of_table(read_csv(file)),
        of_table(read_readings(file)),
        of_table(read_cell_csv(file, 2)),
        of_table(read_log_csv(file, |_| true)),
        of_table(edge),
        burr.map_or(Reached::Header, |_| Reached::End),
    ]
    .into_iter()
    .max()
    .expect("there are some")
}

fn of_log<T>(read: Result<T, ImportError>) -> Reached {
    let Err(error) = read else {
        return Reached::End;
    };
    said(&error);
    match error {
        ImportError::Read { .. }
        | ImportError::Form { .. }
        | ImportError::Encoding { .. }
        | ImportError::Recording(RecordingError::Read { .. }) => Reached::Header,
        _ => Reached::Content,
    }
}

/// A log by a map that is given, and by the map that is drafted from it.
fn log(file: &Path, room: &Room) -> Reached {
    let files = [file.to_owned()];
    let ending = file.extension().unwrap_or_default();
    let maps = room.maps.iter().filter(|(own, _)| *own == ending);
    let given = maps.map(|(_, map)| of_log(import(map, &files))).max();
    let drafted = match draft("A log", &files) {
        Ok(draft) => {
            let path = room.scenarios().join("draft.toml");
            std::fs::write(&path, &draft.text).expect("the folder can be written to");
            // Where questions are open it is not complete.
            let read = load_map(&path).inspect_err(said);
            let read = read.map(|map| of_log(import(&map, &files)));
            read.unwrap_or(Reached::Content).max(Reached::Content)
        }
        Err(error) => of_log::<()>(Err(error)),
    };
    given.map_or(drafted, |given| given.max(drafted))
}

/// A bag that says itself what it holds.
fn run_bag(file: &Path, _: &Room) -> Reached {
    match map_of_bag(file) {
        Ok(Some(map)) => of_log(import(&map, &[])).max(Reached::Content),
        Ok(None) => Reached::Header,
        Err(error) => of_log::<()>(Err(error)),
    }
}

fn parquet(file: &Path, _: &Room) -> Reached {
    of_table(read_long(file)).max(of_table(read_parquet(file)))
}

/// A law's expression, over the variables of a law and two constants.
fn expression(file: &Path, _: &Room) -> Reached {
    let Ok(text) = std::fs::read_to_string(file) else {
        return Reached::Header;
    };
    let names: Vec<&str> = SYMBOLS.iter().map(|s| s.name).chain(["c", "n"]).collect();
    let mut units: Vec<Option<Unit>> =
        (SYMBOLS.iter().map(|symbol| Unit::read(symbol.unit).ok())).collect();
    units.resize(names.len(), None);
    let read = match Expression::read(&text, &names) {
        Ok(read) => read,
        Err(error) => {
            said(&error);
            assert!(
                text.get(error.span.clone()).is_some(),
                "a place in the text"
            );
            // It was parsed, and a name of it was looked up in vain.
            let is_name = !error.reason.starts_with("expected a number");
            return if is_name {
                Reached::Content
            } else {
                Reached::Header
            };
        }
    };
    let values: Vec<f64> = (0..names.len()).map(|place| 0.5 + place as f64).collect();
    let _ = read.value(&values);
    let checks = [
        read.check_units(&units, Unit::ONE),
        read.check_finite(&values),
    ];
    for error in checks.iter().filter_map(|check| check.as_ref().err()) {
        said(error);
        assert!(
            text.get(error.span.clone()).is_some(),
            "a place in the text"
        );
    }
    let is_good = checks.iter().all(Result::is_ok);
    if is_good {
        Reached::End
    } else {
        Reached::Content
    }
}

/// What a run or a diagnosis came to; of a run the report is made.
fn result(file: &Path, _: &Room) -> Reached {
    let bytes = std::fs::read(file).expect("it was written");
    if serde_json::from_slice::<serde_json::Value>(&bytes).is_err() {
        return Reached::Header;
    }
    let answer = serde_json::from_slice::<Answer>(&bytes).inspect_err(said);
    let run = serde_json::from_slice::<RunResult>(&bytes).inspect_err(said);
    if let Ok(run) = &run {
        let force = RecordedChannel::new("contact_force", SiUnit::Newton, vec![1.0, 2.0]);
        let recording = Recording::new(vec![0.0, 1.0], vec![force], Vec::new());
        let report = RunReport {
            result: run,
            recording: &recording.expect("it is one"),
            sketches: &Sketches::default(),
            profile: None,
        };
        let document = report.document();
        assert!(!markdown(&document).is_empty() && html(&document).starts_with("<!DOCTYPE"));
    }
    if answer.is_ok() || run.is_ok() {
        Reached::End
    } else {
        Reached::Content
    }
}
