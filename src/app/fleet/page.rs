//! The page of a fleet.

use super::table::TABLE;
use crate::diagnosis::answer::words::display_name;
use crate::document::{
    Block, Cell, Column, Document, Fact, Horizontal, Marker, Panel, Role, Section, Series, Stroke,
    Table, Tone,
};
use crate::fleet::{DeviceFound, Found, NumberChanged, NumberSeries, date_of_day, words};
use crate::quantity::display_name::number;
use crate::quantity::{DIGITS, significant};
use crate::report::sources;

/// The document of a fleet.
pub(in super::super) fn document(found: &Found) -> Document<'static> {
    let something = found
        .devices
        .iter()
        .any(|d| !d.effects.is_empty() || !d.changed.is_empty());
    let mut sections = vec![devices(found)];
    sections.extend(changed(found));
    sections.extend(courses(found));
    sections.extend(listed(
        "Unlike the others",
        "device | in what",
        &found.unlike,
    ));
    sections.extend(listed("Not read", "recording | why", &found.unread));
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
    Document {
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
    }
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
    let columns = Column::list("device | dates | #recordings | found | in single recordings");
    let caption = "Found: in at least three recordings, and in half of those since it was first seen. What single recordings show is no alarm.";
    let table = Table::new(caption, columns, found.devices.iter().map(row).collect());
    Section::new("Devices", vec![Block::Table(table)])
}

fn changed(found: &Found) -> Option<Section<'static>> {
    let rows = found.devices.iter().flat_map(|device| {
        device.changed.iter().map(move |changed: &NumberChanged| {
            let (name, unit, factor) = display_name(&changed.number);
            let per_day = changed.per_day.map_or(String::new(), |trend| {
                let [slope, low, high] = trend.map(|value| factor * value);
                format!("{} ({} to {})", number(slope), number(low), number(high))
            });
            let chance = 100.0 * changed.since.probability;
            [
                device.name.clone(),
                words(&changed.effect),
                name,
                unit.to_owned(),
                number(factor * changed.before),
                number(factor * changed.after),
                changed.since.words(),
                per_day,
                format!("{chance:.2}"),
            ]
            .map(Cell::from)
            .to_vec()
        })
    });
    let rows: Vec<Vec<Cell>> = rows.collect();
    let columns = Column::list(
        "device | effect | number | unit | #before | #at the end | since (95 %) | #trend a day (95 %) | #chance [%]",
    );
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
fn courses(found: &Found) -> Option<Section<'static>> {
    let (mut rows, mut panels) = (Vec::new(), Vec::new());
    for device in &found.devices {
        let of = |series: &&NumberSeries| {
            let same = |c: &&NumberChanged| c.effect == series.effect && c.number == series.number;
            !series.effect.is_empty() || device.changed.iter().any(|c| same(&c))
        };
        for series in device.series.iter().filter(of) {
            rows.extend(ends(device, series));
            panels.extend(panel(device, series).map(Block::Panel));
        }
    }
    let columns = "device | of | number | unit | #first day | #last day | #least | #largest";
    (!rows.is_empty()).then(|| {
        let caption = "An effect that was found is fitted to all recordings of its device; before it was first seen its number lies at the end of its range at which it does nothing.";
        let table = Block::Table(Table::new(caption, Column::list(columns), rows));
        Section::new("Over the days", [table].into_iter().chain(panels).collect())
    })
}

/// Where a number begins and ends, and between what it lies.
fn ends(device: &DeviceFound, series: &NumberSeries) -> Option<Vec<Cell>> {
    let (name, unit, factor) = display_name(&series.number);
    let of = match series.effect.as_str() {
        "" => "nominal".to_owned(),
        effect => words(effect),
    };
    let values = &series.values;
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let shown = [*values.first()?, *values.last()?, least, most];
    let shown = shown.map(|value| Cell::from(significant(factor * value, DIGITS)));
    let words = [device.name.clone(), of, name, unit.to_owned()].map(Cell::from);
    Some(words.into_iter().chain(shown).collect())
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
    let (name, unit, factor) = display_name(&series.number);
    let label = match unit {
        "" => name,
        unit => format!("{name} [{unit}]"),
    };
    let values: Vec<f64> = series.values.iter().map(|value| factor * value).collect();
    Some(Panel {
        title: format!("{}: {}", device.name, words(&series.effect)),
        vertical_label: label,
        horizontal: Horizontal::Quantity(format!("days since {}", date_of_day(first))),
        series: vec![Series::new(
            "",
            days,
            values,
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

fn listed(title: &str, columns: &str, pairs: &[(String, String)]) -> Option<Section<'static>> {
    let row =
        |(one, other): &(String, String)| vec![Cell::from(one.clone()), Cell::from(other.clone())];
    (!pairs.is_empty()).then(|| {
        let table = Table::new("", Column::list(columns), pairs.iter().map(row).collect());
        Section::new(title, vec![Block::Table(table)])
    })
}
