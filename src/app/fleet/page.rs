//! The page of a fleet.

use super::super::error::AppError;
use super::table::TABLE;
use crate::document::{
    Block, Cell, Column, Document, Fact, Figure, Horizontal, Marker, Panel, Role, Section, Series,
    Stroke, Table, Tone,
};
use crate::figure::svg;
use crate::fleet::{DeviceFound, Found, NumberChanged, NumberSeries, date_of_day, words};
use crate::quantity::display_name::{display_name, number};
use crate::report::sources;

/// The document of a fleet.
pub(in super::super) fn document(found: &Found) -> Result<Document<'static>, AppError> {
    let something = found
        .devices
        .iter()
        .any(|d| !d.effects.is_empty() || !d.changed.is_empty());
    let mut sections = vec![devices(found)];
    sections.extend(changed(found));
    sections.extend(courses(found)?);
    sections.extend(listed(
        "Unlike the others",
        ["device", "in what"],
        &found.unlike,
    ));
    sections.extend(listed("Not read", ["recording", "why"], &found.unread));
    sections.push(sources(&found.program, &found.files));
    let facts = [
        ("recordings", found.recordings.to_string(), String::new()),
        (
            "searched",
            found.searched.to_string(),
            "the others were predicted to the noise by the nominal or the last improved model"
                .to_owned(),
        ),
    ];
    Ok(Document {
        title: "Fleet".to_owned(),
        verdict: found.verdict(),
        tone: if something { Tone::Found } else { Tone::Good },
        facts: facts
            .map(|(name, value, remark)| Fact {
                name: name.to_owned(),
                value: value.into(),
                remark,
            })
            .to_vec(),
        sections,
        footer: format!(
            "Made by idc fleet. {TABLE} beside this page has a row for each number of each recording."
        ),
        ..Document::default()
    })
}

fn devices(found: &Found) -> Section<'static> {
    let row = |device: &DeviceFound| {
        let effects: Vec<String> = device.lines();
        let single = device
            .single
            .iter()
            .map(|(name, count)| format!("{} ({count})", words(name)));
        vec![
            Cell::from(device.name.clone()),
            Cell::from(format!("{} to {}", device.first, device.last)),
            Cell::from(device.recordings.to_string()),
            Cell::Verdict(
                match effects.is_empty() {
                    true => "nothing".to_owned(),
                    false => effects.join("; "),
                },
                effects.is_empty(),
            ),
            Cell::from(single.collect::<Vec<_>>().join(", ")),
        ]
    };
    let columns = vec![
        Column::of_words("device"),
        Column::of_words("dates"),
        Column::of_numbers("recordings"),
        Column::of_words("found"),
        Column::of_words("in single recordings"),
    ];
    let caption = "Found: in at least three recordings and in half of those since. What single recordings show is no alarm.";
    let table = Table::new(caption, columns, found.devices.iter().map(row).collect());
    Section::new("Devices", vec![Block::Table(table)])
}

fn changed(found: &Found) -> Option<Section<'static>> {
    let rows = found.devices.iter().flat_map(|device| {
        device.changed.iter().map(move |changed: &NumberChanged| {
            let (name, unit) = display_name(&changed.number);
            let per_day = changed.per_day.map_or(String::new(), |[slope, low, high]| {
                format!("{} ({} to {})", number(slope), number(low), number(high))
            });
            let chance = 100.0 * changed.since.probability;
            [
                device.name.clone(),
                words(&changed.effect),
                name,
                unit,
                number(changed.before),
                number(changed.after),
                changed.since.words(),
                per_day,
                format!("{chance:.2}"),
            ]
            .map(Cell::from)
            .to_vec()
        })
    });
    let rows: Vec<Vec<Cell>> = rows.collect();
    let columns = vec![
        Column::of_words("device"),
        Column::of_words("effect"),
        Column::of_words("number"),
        Column::of_words("unit"),
        Column::of_numbers("before"),
        Column::of_numbers("at the end"),
        Column::of_words("since (95 %)"),
        Column::of_numbers("trend a day (95 %)"),
        Column::of_numbers("chance [%]"),
    ];
    let words = "Chance: how often a number that does not change shows as much. All numbers of the fleet together give a false alarm in one of twenty reports.";
    (!rows.is_empty()).then(|| {
        let table = Table::new("", columns, rows);
        Section::new(
            "Numbers that changed",
            vec![Block::Hint(words.to_owned()), Block::Table(table)],
        )
    })
}

/// Numbers of effects, and those that changed, over the days.
fn courses(found: &Found) -> Result<Option<Section<'static>>, AppError> {
    let mut blocks = Vec::new();
    for device in &found.devices {
        let of = |series: &&NumberSeries| {
            let same = |c: &&NumberChanged| c.effect == series.effect && c.number == series.number;
            !series.effect.is_empty() || device.changed.iter().any(|c| same(&c))
        };
        let panels: Vec<Panel<'static>> = (device.series.iter().filter(of))
            .filter_map(|series| panel(device, series))
            .collect();
        if panels.is_empty() {
            continue;
        }
        blocks.push(Block::Heading(device.name.clone()));
        let title = String::new();
        blocks.push(Block::Picture(
            device.name.clone(),
            svg(&Figure { title, panels })?,
        ));
    }
    Ok((!blocks.is_empty()).then(|| Section::new("Over the days", blocks)))
}

fn panel(device: &DeviceFound, series: &NumberSeries) -> Option<Panel<'static>> {
    let first = *series.days.first()?;
    let days: Vec<f64> = series.days.iter().map(|day| day - first).collect();
    let last = *days.last()?;
    let change = device
        .changed
        .iter()
        .find(|c| c.effect == series.effect && c.number == series.number);
    let at = change.and_then(|change| {
        let place = series
            .days
            .iter()
            .position(|day| date_of_day(*day) == change.since.date)?;
        Some((days[place], change.since.date.clone()))
    });
    let markers = at.filter(|(at, _)| (0.0..=last).contains(at));
    let (name, unit) = display_name(&series.number);
    let label = match unit.as_str() {
        "" => name,
        unit => format!("{name} [{unit}]"),
    };
    Some(Panel {
        title: words(&series.effect),
        vertical_label: label,
        horizontal: Horizontal::Quantity(format!("days since {}", date_of_day(first))),
        series: vec![Series::new(
            "",
            days,
            series.values.clone(),
            Role::Estimate,
            Stroke::Points,
        )],
        markers: markers
            .map(|(at, label)| Marker { label, at })
            .into_iter()
            .collect(),
        ..Panel::default()
    })
}

fn listed(title: &str, columns: [&str; 2], pairs: &[(String, String)]) -> Option<Section<'static>> {
    let row =
        |(one, other): &(String, String)| vec![Cell::from(one.clone()), Cell::from(other.clone())];
    (!pairs.is_empty()).then(|| {
        let table = Table::new(
            "",
            columns.map(Column::of_words).to_vec(),
            pairs.iter().map(row).collect(),
        );
        Section::new(title, vec![Block::Table(table)])
    })
}
