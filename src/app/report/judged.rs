//! What of a result rests on values that nobody has measured in public.

use serde_json::Value;

use crate::diagnosis::answer::words::listed;
use crate::document::{Block, Section};
use crate::quantity::counted;

/// Table whose values are told by their number alone, there being many.
const DEVICE: &str = "device.";

/// The part of a page that says so; none where no such value is in use. `file` is the document's.
pub(super) fn judged(document: &Value, file: &str) -> Option<Section<'static>> {
    let values = document["judged"].as_array()?;
    let mut groups: Vec<(&str, Vec<&Value>)> = Vec::new();
    for value in values {
        let decides = value["decides"].as_str()?;
        match groups.iter_mut().find(|(known, _)| *known == decides) {
            Some((_, group)) => group.push(value),
            None => groups.push((decides, vec![value])),
        }
    }
    if groups.is_empty() {
        return None;
    }
    let rests = groups.iter().map(|(decides, group)| {
        let key = |value: &Value| value["key"].as_str().unwrap_or_default().to_owned();
        let of_device = |value: &&&Value| key(value).starts_with(DEVICE);
        let device = group.iter().filter(of_device).count();
        let mut words: Vec<String> = (group.iter())
            .filter(|value| !of_device(value))
            .map(|value| match value["default"] == true {
                true => format!("{} (default)", key(value)),
                false => key(value),
            })
            .collect();
        if device > 0 {
            let many = counted(device, "value");
            words.push(format!("{many} that the device model marks as judged"));
        }
        format!("{decides} on {}", listed(&words))
    });
    let rests: Vec<String> = rests.collect();
    let text = format!(
        "These numbers rest on values that nobody has measured in public (judged): {}. {file} lists them; measure your own.",
        rests.join("; ")
    );
    Some(Section::new("Judged values", vec![Block::Paragraph(text)]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_listed_by_what_they_decide() {
        let value = |key: &str, default: bool, decides: &str| serde_json::json!({ "key": key, "default": default, "decides": decides });
        let document = serde_json::json!({ "judged": [
            value("removal.a", false, "leg"),
            value("removal.b", true, "power"),
            value("removal.c", true, "leg"),
            value("device.d", true, "force"),
            value("device.e", true, "force"),
        ] });
        let section = judged(&document, "summary.json").unwrap();
        let [Block::Paragraph(text)] = &section.blocks[..] else {
            panic!("another block");
        };
        assert_eq!(
            text,
            "These numbers rest on values that nobody has measured in public (judged): leg on removal.a and removal.c (default); power on removal.b (default); force on 2 values that the device model marks as judged. summary.json lists them; measure your own."
        );
        assert!(judged(&serde_json::json!({}), "summary.json").is_none());
        assert!(judged(&serde_json::json!({ "judged": [] }), "summary.json").is_none());
    }
}
