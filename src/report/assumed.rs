//! What of a result rests on values that nobody has measured in public.

use crate::document::{Block, Section};
use crate::quantity::{counted, listed};
use crate::scenario::AssumedValue;

/// Keys of a device model file.
const DEVICE: &str = "device.";

/// The section; none where nothing rests on such values. `file` lists them.
pub fn assumed(values: &[AssumedValue], file: &str) -> Option<Section<'static>> {
    let mut groups: Vec<(&str, Vec<&AssumedValue>)> = Vec::new();
    for value in values {
        match groups.iter_mut().find(|(known, _)| *known == value.decides) {
            Some((_, group)) => group.push(value),
            None => groups.push((&value.decides, vec![value])),
        }
    }
    if groups.is_empty() {
        return None;
    }
    let rests = groups.iter().map(|(decides, group)| {
        let of_device = |value: &&&AssumedValue| value.key.starts_with(DEVICE);
        let device = group.iter().filter(of_device).count();
        let mut words: Vec<String> = (group.iter())
            .filter(|value| !of_device(value))
            .map(|value| match value.default {
                true => format!("{} (default)", value.key),
                false => value.key.clone(),
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
        "These numbers rest on values that nobody has measured in public (assumed): {}. {file} lists them; measure your own.",
        rests.join("; ")
    );
    Some(Section::new("Assumed values", vec![Block::Paragraph(text)]).appendix())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_stand_by_what_they_decide() {
        let value = |key: &str, default, decides: &str| AssumedValue {
            key: key.to_owned(),
            default,
            decides: decides.to_owned(),
        };
        let values = [
            value("removal.a", false, "leg"),
            value("removal.b", true, "power"),
            value("removal.c", true, "leg"),
            value("device.d", true, "force"),
            value("device.e", true, "force"),
        ];
        let section = assumed(&values, "summary.json").unwrap();
        let [Block::Paragraph(text)] = &section.blocks[..] else {
            panic!("another block");
        };
        assert_eq!(
            text,
            "These numbers rest on values that nobody has measured in public (assumed): leg on removal.a and removal.c (default); power on removal.b (default); force on 2 values that the device model marks as judged. summary.json lists them; measure your own."
        );
        assert!(assumed(&[], "summary.json").is_none());
    }
}
