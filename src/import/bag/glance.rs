//! A bag looked at: the fields of its topics that are numbers, those of joints by their names, with their values.

use std::path::Path;

use super::definition::definition;
use super::field::{Definition, Field, Kind, Picked};
use super::open;
use super::store::Scan;
use crate::import::error::ImportError;

/// Overview of a bag.
pub(in crate::import) struct Glance {
    /// Its fields.
    pub fields: Vec<FieldSeen>,
    /// Whether every message has a stamp.
    pub stamped: bool,
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
    definition: Definition,
    fields: Vec<(FieldSeen, Field, Picked)>,
    is_new: bool,
}

/// Looks through a bag; topics whose messages cannot be read are left out.
pub(in crate::import) fn glance(path: &Path) -> Result<Glance, ImportError> {
    let stores = open(path)?;
    let scan = Scan::of(&stores);
    let mut topics: Vec<Topic> = Vec::new();
    for there in &scan.there {
        if let Ok(definition) = definition(there) {
            let message = there.schema.as_ref().map(|(name, ..)| name.clone());
            topics.push(Topic {
                name: there.topic.clone(),
                message: message.unwrap_or_default(),
                definition,
                fields: Vec::new(),
                is_new: true,
            });
        }
    }
    let stamped = |topic: &Topic| {
        let stamp = topic.definition.field("header.stamp");
        stamp.is_some_and(|(_, kind)| kind == Kind::Stamp)
    };
    let stamped = !topics.is_empty() && topics.iter().all(stamped);
    stores.visit(|message| -> Result<(), ImportError> {
        let of_message = |topic: &&mut Topic| topic.name == message.there.topic;
        let Some(topic) = topics.iter_mut().find(of_message) else {
            return Ok(());
        };
        // What does not fit its definition is told when it is imported.
        let Ok(read) = topic.definition.decode(message.data) else {
            return Ok(());
        };
        if topic.is_new {
            topic.fields = fields(topic, &read.joints());
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
                && !seen.frames.contains(&frame)
            {
                seen.frames.push(frame);
            }
        }
        Ok(())
    })?;
    let all = topics.into_iter().flat_map(|topic| topic.fields);
    let fields = all.map(|(seen, ..)| seen);
    Ok(Glance {
        fields: fields.filter(|seen| !seen.values.is_empty()).collect(),
        stamped,
    })
}

/// Fields of a topic's messages: elements of joints by their names, others by their paths.
fn fields(topic: &Topic, joints: &[String]) -> Vec<(FieldSeen, Field, Picked)> {
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
        for joint in joints {
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
        path.starts_with("header.") || path.contains("covariance") || path.contains("layout.")
    };
    for path in definition.numbers() {
        if in_list(&path) || noise(&path) {
            continue;
        }
        if let Some((field, _)) = definition.field(&path) {
            found.push((seen(&path, None), field, Picked::default()));
        }
    }
    found
}
