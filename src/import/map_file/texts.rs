//! The form of a text: what stands between its fields and in its numbers, and where its rows begin.

use super::keys::{FileKeys, FormKey};
use crate::import::encoding;
use crate::import::map::{Separator, TextForm};
use crate::keys::check::Section;
use crate::scenario::ScenarioError;

/// What a text's keys say of its form.
pub(super) fn text_form(section: &Section<'_>, keys: &FileKeys) -> Result<TextForm, ScenarioError> {
    let separator = match (&keys.separator, &keys.field_widths) {
        (Some(_), Some(_)) => {
            let reason = "fields have widths, or something between them".to_owned();
            return Err(section.misplaced("field_widths", reason));
        }
        (None, Some(widths)) if widths.is_empty() || widths.contains(&0) => {
            let expected = "a width of at least 1 for each field".to_owned();
            return Err(section.refuse("field_widths", format!("{widths:?}"), expected));
        }
        (None, Some(widths)) => Separator::Widths(widths.clone()),
        (None, None) if matches!(keys.form, FormKey::Spreadsheet) => Separator::Character(b'\t'),
        (None, None) => Separator::Character(b','),
        (Some(name), None) => match name.as_str() {
            "whitespace" => Separator::Whitespace,
            "tab" => Separator::Character(b'\t'),
            name => {
                let character = single(section, "separator", name, "\"whitespace\" or \"tab\"")?;
                Separator::Character(u8::try_from(character).map_err(|_| {
                    let expected = "a character of ASCII".to_owned();
                    section.refuse("separator", format!("{name:?}"), expected)
                })?)
            }
        },
    };
    let header_lines = keys
        .header_lines
        .unwrap_or(usize::from(keys.names_line.is_some()));
    if let Some(line) = keys.names_line {
        section.count("names_line", line, 1..=header_lines.max(1))?;
    }
    let decimal_mark = match &keys.decimal_mark {
        Some(mark) => single(section, "decimal_mark", mark, "such as \".\" or \",\"")?,
        None => '.',
    };
    // Where fields are quoted a comma may stand between them and within them.
    let both = u8::try_from(decimal_mark).is_ok_and(|mark| separator == Separator::Character(mark));
    if both && decimal_mark != ',' {
        let expected = "another character than between fields".to_owned();
        return Err(section.refuse("decimal_mark", format!("{decimal_mark:?}"), expected));
    }
    let thousands_mark = match &keys.thousands_mark {
        Some(mark) => Some(single(
            section,
            "thousands_mark",
            mark,
            "such as \".\" or \"'\"",
        )?),
        None => None,
    };
    if thousands_mark == Some(decimal_mark) {
        let expected = "another character than `decimal_mark`".to_owned();
        return Err(section.refuse("thousands_mark", format!("{decimal_mark:?}"), expected));
    }
    if let Some(name) = &keys.encoding
        && !encoding::is_known(name)
    {
        let expected =
            "an encoding, such as \"utf-8\", \"windows-1252\", \"utf-16le\" or \"utf-16be\"";
        return Err(section.refuse("encoding", format!("{name:?}"), expected.to_owned()));
    }
    Ok(TextForm {
        encoding: keys.encoding.clone(),
        separator,
        decimal_mark,
        thousands_mark,
        header_lines,
        names_line: keys.names_line,
        skips_stray_lines: keys.skip_stray_lines.unwrap_or(false),
    })
}

/// A text of one character.
pub(super) fn single(
    section: &Section<'_>,
    key: &str,
    text: &str,
    besides: &str,
) -> Result<char, ScenarioError> {
    let mut characters = text.chars();
    match (characters.next(), characters.next()) {
        (Some(character), None) => Ok(character),
        _ => Err(section.refuse(
            key,
            format!("{text:?}"),
            format!("one character, {besides}"),
        )),
    }
}
