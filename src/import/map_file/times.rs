//! The times of a map's file.

use super::channels::unit;
use super::keys::{DateOrderKey, FormKey, TimeKeys, TwoNumbersKey};
use super::texts::single;
use crate::import::map::TimeMap;
use crate::import::stamps::{DateOrder, TwoNumbers};
use crate::import::units;
use crate::keys::check::Section;
use crate::keys::document::Document;
use crate::recording::Unit;
use crate::scenario::ScenarioError;

/// `[file.time]` of a file of that form; `rate` is whether the file has a sample rate, which makes times of a counter.
pub(super) fn time_map(
    document: &Document<'_>,
    table: &str,
    form: FormKey,
    keys: &TimeKeys,
    rate: Option<f64>,
) -> Result<TimeMap, ScenarioError> {
    let section = Section::new(document, format!("{table}.time"));
    if rate.is_some() && keys.unit.is_some() {
        let reason = "with `sample_rate_hz` in [[file]] the column counts samples and has no unit"
            .to_owned();
        return Err(section.misplaced("unit", reason));
    }
    if keys.unit.is_none() && rate.is_none() && matches!(form, FormKey::Mat5) {
        let expected = format!("one of {}", units::of_kind(Unit::Second).join(", "));
        return Err(section.missing("unit", &expected));
    }
    let of_stamps = [
        ("date_column", keys.date_column.is_some()),
        ("date_order", keys.date_order.is_some()),
        ("year", keys.year.is_some()),
        ("two_numbers", keys.two_numbers.is_some()),
    ];
    for (key, given) in [("thousands_mark", keys.thousands_mark.is_some())]
        .into_iter()
        .chain(of_stamps)
    {
        let has_texts = matches!(
            form,
            FormKey::Text | FormKey::Spreadsheet | FormKey::Parquet
        );
        if given && !has_texts {
            return Err(section.misplaced(key, "only a text has it".to_owned()));
        }
    }
    if let Some((key, _)) = of_stamps.into_iter().find(|(_, given)| *given)
        && (keys.unit.is_some() || rate.is_some())
    {
        let reason =
            "with a `unit` or a sample rate the times are numbers, and no stamps".to_owned();
        return Err(section.misplaced(key, reason));
    }
    let mark = |text: &String| single(&section, "thousands_mark", text, "such as \".\" or \"'\"");
    Ok(TimeMap {
        column: keys.column.0.clone(),
        unit: match &keys.unit {
            Some(name) => Some(unit(&section, name, Some(&[Unit::Second]))?),
            None => None,
        },
        thousands_mark: keys.thousands_mark.as_ref().map(mark).transpose()?,
        date_column: keys.date_column.as_ref().map(|column| column.0.clone()),
        date_order: keys.date_order.map(|order| match order {
            DateOrderKey::YearMonthDay => DateOrder::YearMonthDay,
            DateOrderKey::DayMonthYear => DateOrder::DayMonthYear,
            DateOrderKey::MonthDayYear => DateOrder::MonthDayYear,
        }),
        year: keys.year,
        two_numbers: keys.two_numbers.map(|numbers| match numbers {
            TwoNumbersKey::MinutesSeconds => TwoNumbers::MinutesSeconds,
            TwoNumbersKey::HoursMinutes => TwoNumbers::HoursMinutes,
        }),
    })
}
