//! A bag looked at: the fields of its topics that are numbers, those of joints by their names, with their values.

use std::collections::HashMap;
use std::path::Path;
use std::rc::Rc;

use super::definition::definition;
use super::field::{Definition, Field, Kind, Picked};
use super::message::There;
use super::open;
use super::store::{Scan, Stores};
use crate::file::Limit;
use crate::import::error::ImportError;
use crate::import::log::EPOCH;

/// Fields of a bag, frames of a field and remarks that are kept, at most.
const MOST_FIELDS: usize = 4096;
const MOST_FRAMES: usize = 64;
const MOST_NOTES: usize = 20;

/// Overview of a bag.
pub(in crate::import) struct Glance {
    /// Its fields.
    pub fields: Vec<FieldSeen>,
    /// Whether every message has a header with a place for a stamp.
    pub stamped: bool,
    /// Messages whose stamp is zero, and messages.
    pub zero_stamps: [usize; 2],
    /// Remarks on it, each a part of a sentence.
    pub notes: Vec<String>,
}

/// A field, or an element of a list by its joint.
pub(in crate::import) struct FieldSeen {
    /// As a map has it: `/topic.field`.
    pub column: String,
    /// Type of the messages.
    pub message: String,
    /// The field.
    pub path: String,
    /// The joint that it is of.
    pub joint: Option<String>,
    /// Whether it is true or false.
    pub is_bool: bool,
    /// Frames that its messages are of.
    pub frames: Vec<String>,
    /// Its values.
    pub values: Vec<f64>,
}

/// A topic while it is looked at.
struct Topic {
    name: String,
    message: String,
    definition: Rc<Definition>,
    fields: Vec<(FieldSeen, Field, Picked)>,
    stamp: Option<Field>,
    is_new: bool,
}

/// Looks through a bag; topics whose messages cannot be read are left out.
pub(in crate::import) fn glance(path: &Path, limit: Limit) -> Result<Glance, ImportError> {
    let stores = open(path, limit)?;
    let scan = Scan::of(&stores);
    let mut topics: Vec<Topic> = Vec::new();
    let mut notes = notes(&stores, &scan);
    // Many topics may share a definition.
    let mut known: HashMap<_, Result<Rc<Definition>, String>> = HashMap::new();
    for there in &scan.there {
        let key = (there.schema.as_ref().map(Rc::as_ptr), &there.encoding);
        let read = known
            .entry(key)
            .or_insert_with(|| definition(there).map(Rc::new));
        match read {
            Ok(definition) => topics.push(Topic::new(there, Rc::clone(definition))),
            Err(found) => notes.push(format!("{} cannot be read, {found}", there.topic)),
        }
    }
    if notes.len() > MOST_NOTES {
        let more = notes.len() - MOST_NOTES;
        notes.truncate(MOST_NOTES);
        notes.push(format!("and {more} more"));
    }
    let mut left = MOST_FIELDS;
    let names = topics.iter().enumerate();
    let places: HashMap<String, usize> = names
        .map(|(place, own)| (own.name.clone(), place))
        .collect();
    let stamped = !topics.is_empty() && topics.iter().all(|topic| topic.stamp.is_some());
    let (mut zero_stamps, mut latest) = ([0, 0], 0);
    stores.visit(|message| -> Result<(), ImportError> {
        let place = places.get(&message.there.topic);
        let Some(topic) = place.and_then(|place| topics.get_mut(*place)) else {
            return Ok(());
        };
        // What does not fit its definition is reported when it is imported.
        let plain = message.plain().unwrap_or_default();
        let Ok(read) = topic.definition.decode(&plain) else {
            return Ok(());
        };
        if let Some(stamp) = topic.stamp.as_ref().and_then(|stamp| read.stamp(stamp)) {
            zero_stamps[0] += usize::from(stamp == 0);
            zero_stamps[1] += 1;
            latest = latest.max(stamp);
        }
        if topic.is_new {
            topic.fields = fields(topic, &read.joints(), left);
            left -= topic.fields.len();
            topic.is_new = false;
        }
        for (seen, field, picked) in &mut topic.fields {
            let number = match read.place_of(picked) {
                Ok(Some(place)) => read.number(&field.at(place)),
                Ok(None) => read.number(field),
                Err(_) => None,
            };
            seen.values.extend(number);
            if let Some(frame) = read.frame().filter(|_| number.is_some())
                && seen.frames.len() < MOST_FRAMES
                && !seen.frames.contains(&frame)
            {
                seen.frames.push(frame);
            }
        }
        Ok(())
    })?;
    // A simulated clock begins at zero.
    if latest != 0 && (latest as f64) < EPOCH * 1e9 {
        zero_stamps[0] = 0;
    }
    let all = topics.into_iter().flat_map(|topic| topic.fields);
    let fields = all.map(|(seen, ..)| seen);
    Ok(Glance {
        fields: fields.filter(|seen| !seen.values.is_empty()).collect(),
        stamped,
        zero_stamps,
        notes,
    })
}

impl Topic {
    fn new(there: &There, definition: Rc<Definition>) -> Self {
        let message = there.schema.as_ref().map(|schema| schema.name.clone());
        let stamp = definition.field("header.stamp");
        let stamp = stamp.filter(|(_, kind)| *kind == Kind::Stamp);
        Self {
            name: there.topic.clone(),
            message: message.unwrap_or_default(),
            stamp: stamp.map(|(field, _)| field),
            definition,
            fields: Vec::new(),
            is_new: true,
        }
    }
}

/// Remarks on a bag's files.
fn notes(stores: &Stores, scan: &Scan) -> Vec<String> {
    let mut notes = Vec::new();
    if !stores.missing.is_empty() {
        let names = stores.missing.join(", ");
        notes.push(format!("its metadata.yaml names {names}, not there"));
    }
    if let Some(cause) = &scan.cause {
        notes.push(format!("it breaks off: {cause}"));
    }
    notes
}

/// Fields of a topic's messages: elements of joints by their names, others by their paths.
fn fields(topic: &Topic, joints: &[String], most: usize) -> Vec<(FieldSeen, Field, Picked)> {
    let definition = &topic.definition;
    let seen = |path: &str, joint: Option<&String>| FieldSeen {
        column: format!("{}.{path}", topic.name),
        message: topic.message.clone(),
        path: path.to_owned(),
        joint: joint.cloned(),
        is_bool: definition.is_bool(path),
        frames: Vec::new(),
        values: Vec::new(),
    };
    let lists = if joints.is_empty() {
        Vec::new()
    } else {
        definition.lists()
    };
    let mut found = Vec::new();
    for list in &lists {
        let Some((field, _)) = definition.field(&format!("{list}[0]")) else {
            continue;
        };
        for joint in joints.iter().take(most - found.len()) {
            let picked = Picked {
                joint: Some(joint.clone()),
                frame: None,
            };
            found.push((seen(list, Some(joint)), field.clone(), picked));
        }
    }
    let in_list = |path: &String| {
        lists
            .iter()
            .any(|list| path.starts_with(&format!("{list}[")))
    };
    let noise = |path: &String| {
        path.starts_with("header.") || path.contains("variance") || path.contains("layout.")
    };
    for path in definition.numbers() {
        if in_list(&path) || noise(&path) {
            continue;
        }
        if found.len() == most {
            break;
        }
        if let Some((field, _)) = definition.field(&path) {
            found.push((seen(&path, None), field, Picked::default()));
        }
    }
    found
}
