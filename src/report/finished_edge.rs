//! The finished edge of a run: chamfer and burr along it.

use std::borrow::Cow;

use crate::document::{Band, Block, Horizontal, Marker, Panel, Role, Section, Series, Stroke};
use crate::recording::csv::EdgeProfile;
use crate::run::RunResult;

/// Chamfer's leg with its tolerance, and the burr before and after, along the edge.
pub fn finished_edge<'a>(profile: &EdgeProfile, result: &RunResult) -> Section<'a> {
    let millimetres = |values: &[f64]| -> Vec<f64> { values.iter().map(|v| 1e3 * v).collect() };
    let places = millimetres(&profile.place);
    let series = |label: &str, values: &[f64], role, stroke| Series {
        label: label.to_owned(),
        horizontal: Cow::Owned(places.clone()),
        values: Cow::Owned(millimetres(values)),
        role,
        stroke,
        stepwise: false,
    };
    let ends = ends(&places, result.metric("ends_length_mm"));
    let chart = |title: &str, label: &str, series, bands, within| {
        Block::Panel(Panel {
            within,
            title: title.to_owned(),
            vertical_label: label.to_owned(),
            horizontal: Horizontal::Quantity("length along the edge [mm]".to_owned()),
            series,
            bands,
            markers: ends.clone(),
            group: "finished edge".to_owned(),
            ..Panel::default()
        })
    };
    let limits = result
        .chamfer
        .and_then(|limits| Some([limits.leg_min_mm, limits.leg_max_mm?]));
    let band = limits.map(|[from, to]| Band {
        label: "tolerance".to_owned(),
        from,
        to,
    });
    // From nothing on, with the whole tolerance.
    let most = profile.chamfer_leg.iter().map(|leg| 1e3 * leg);
    let most = most.chain(limits.map(|[_, high]| high)).fold(0.0, f64::max);
    let leg = series("leg", &profile.chamfer_leg, Role::Force, Stroke::Plain);
    let mut blocks = vec![chart(
        "Leg of the chamfer",
        "leg [mm]",
        vec![leg],
        band.into_iter().collect(),
        (most > 0.0).then_some([0.0, 1.08 * most]),
    )];
    if profile.burr_before.iter().any(|height| *height > 0.0) {
        let burrs = vec![
            series(
                "before",
                &profile.burr_before,
                Role::Command,
                Stroke::Dashed,
            ),
            series("after", &profile.burr_after, Role::Force, Stroke::Plain),
        ];
        blocks.push(chart(
            "Height of the burr",
            "height [mm]",
            burrs,
            Vec::new(),
            None,
        ));
    }
    if !ends.is_empty() {
        let words = "Between the two lines the tool has passed with its whole contact length; the numbers of the ends are of what lies outside them.";
        blocks.push(Block::Hint(words.to_owned()));
    }
    let words = "The burr comes off first, from its tip, then the edge is chamfered. A secondary burr, pushed over by the tool, is not modelled.";
    blocks.push(Block::Hint(words.to_owned()));
    Section::new("Finished edge", blocks)
}

/// Where the ends begin that the numbers of the edge leave out: where the tool is set on and lifted off.
fn ends(places: &[f64], length: Option<f64>) -> Vec<Marker> {
    let (Some(first), Some(last)) = (places.first(), places.last()) else {
        return Vec::new();
    };
    let Some(length) = length.filter(|length| *length > 0.0) else {
        return Vec::new();
    };
    let marker = |label: &str, at| Marker {
        label: label.to_owned(),
        at,
    };
    vec![marker("end", first + length), marker("end", last - length)]
}
