//! A panel with its numbers, as the page's script takes it.

use serde_json::{Value, json};

use super::super::packed;
use super::super::thin::kept;
use super::super::{Horizontal, Panel, Series, Stroke};

/// A series with its own places, and how it is joined to the others.
struct Drawn<'a> {
    label: &'a str,
    series: &'a Series<'a>,
    places: Vec<f64>,
    values: Vec<f64>,
}

impl Panel<'_> {
    /// Data for the script, with at most about so many samples; and of how many they are.
    pub(super) fn data(&self, most: usize) -> (Value, [usize; 2]) {
        let panel = self;
        let mut drawn: Vec<Drawn<'_>> = Vec::new();
        let mut areas: Vec<[usize; 2]> = Vec::new();
        for series in &panel.series {
            if series.stroke == Stroke::Area {
                areas.push([drawn.len(), drawn.len() + 1]);
                drawn.extend(edges(series));
            } else {
                drawn.push(Drawn {
                    label: &series.label,
                    series,
                    places: series.horizontal.to_vec(),
                    values: series.values.to_vec(),
                });
            }
        }
        let shared = drawn.windows(2).all(|two| two[0].places == two[1].places);
        let (places, columns) = if shared {
            on_shared_places(drawn.iter().collect::<Vec<_>>().as_slice())
        } else {
            on_all_places(&drawn)
        };
        let (mut lines, mut clouds): (Vec<&[f64]>, Vec<&[f64]>) = Default::default();
        for (drawn, values) in drawn.iter().zip(&columns) {
            match drawn.series.stroke {
                Stroke::Points => clouds.push(values),
                _ => lines.push(values),
            }
        }
        let kept = kept(places.len(), &lines, &clouds, most);
        let of = |values: &[f64]| packed(kept.iter().map(|i| values[*i]));
        let series = drawn.iter().zip(&columns).map(|(drawn, values)| {
            json!({
                "label": drawn.label,
                "role": format!("{:?}", drawn.series.role),
                "stroke": format!("{:?}", drawn.series.stroke),
                "stepwise": drawn.series.stepwise,
                "joined": !shared,
                "values": of(values),
            })
        });
        let bands = panel.bands.iter();
        let bands = bands.map(|band| json!({"from": coarse(band.from), "to": coarse(band.to)}));
        let markers = panel.markers.iter();
        let markers = markers.map(|marker| json!({"label": marker.label, "at": coarse(marker.at)}));
        let x = match &panel.horizontal {
            Horizontal::Time => "time [s]",
            Horizontal::Quantity(name) => name,
        };
        let data = json!({
            "x": x,
            "y": panel.vertical_label,
            "group": self.group,
            "at": of(&places),
            "series": series.collect::<Vec<_>>(),
            "areas": areas,
            "bands": bands.collect::<Vec<_>>(),
            "markers": markers.collect::<Vec<_>>(),
            "spans": self.spans.iter().map(|span| span.map(coarse)).collect::<Vec<_>>(),
            "within": self.within.map(|ends| ends.map(coarse)),
        });
        (data, [kept.len(), places.len()])
    }

    /// Whether all that it shows are points.
    pub(super) fn is_cloud(&self) -> bool {
        let mut series = self.series.iter();
        series.all(|series| series.stroke == Stroke::Points)
    }

    /// Numbers that its panel has, the places counted once.
    pub(super) fn numbers(&self) -> usize {
        let lengths = self.series.iter().map(|s| s.values.len());
        lengths.max().unwrap_or(0) * (self.series.len() + 1)
    }
}

/// An area is drawn between its edges: there, and back.
fn edges<'a>(series: &'a Series<'a>) -> [Drawn<'a>; 2] {
    let half = series.values.len() / 2;
    let there = (&series.horizontal[..half], &series.values[..half]);
    let back = |values: &[f64]| values[half..].iter().rev().copied().collect();
    [
        Drawn {
            label: &series.label,
            series,
            places: there.0.to_vec(),
            values: there.1.to_vec(),
        },
        Drawn {
            label: "",
            series,
            places: back(&series.horizontal),
            values: back(&series.values),
        },
    ]
}

/// Places in rising order, and the values there.
fn on_shared_places(drawn: &[&Drawn<'_>]) -> (Vec<f64>, Vec<Vec<f64>>) {
    let Some(first) = drawn.first() else {
        return (Vec::new(), Vec::new());
    };
    let mut order: Vec<usize> = (0..first.places.len()).collect();
    order.retain(|i| first.places[*i].is_finite());
    order.sort_by(|a, b| first.places[*a].total_cmp(&first.places[*b]));
    let of = |values: &[f64]| -> Vec<f64> { order.iter().map(|i| values[*i]).collect() };
    let columns = drawn.iter().map(|drawn| of(&drawn.values)).collect();
    (of(&first.places), columns)
}

/// The places of all series, one after the other in rising order, NaN where a series has no value.
fn on_all_places(drawn: &[Drawn<'_>]) -> (Vec<f64>, Vec<Vec<f64>>) {
    let mut places: Vec<(f64, usize, usize)> = Vec::new();
    for (owner, drawn) in drawn.iter().enumerate() {
        let own = drawn.places.iter().enumerate();
        places.extend(own.map(|(index, place)| (*place, owner, index)));
    }
    places.retain(|(place, ..)| place.is_finite());
    places.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut columns = vec![vec![f64::NAN; places.len()]; drawn.len()];
    for (row, (_, owner, index)) in places.iter().enumerate() {
        columns[*owner][row] = drawn[*owner].values[*index];
    }
    (
        places.into_iter().map(|(place, ..)| place).collect(),
        columns,
    )
}

/// A number to what a picture shows of it: one that went through a file may differ in its last bit.
fn coarse(value: f64) -> f64 {
    format!("{value:.6e}").parse().unwrap_or(value)
}

/// Little-endian `f32` in base64.
fn packed(values: impl Iterator<Item = f64>) -> String {
    packed::text(values.flat_map(|v| (v as f32).to_le_bytes()))
}

#[cfg(test)]
mod tests {
    use base64::Engine as _;
    use base64::engine::general_purpose::STANDARD;

    use super::*;
    use crate::document::Role;

    fn chart(series: Vec<Series<'_>>) -> Panel<'_> {
        Panel {
            vertical_label: "force [N]".to_owned(),
            series,
            ..Panel::default()
        }
    }

    fn unpacked(value: &Value) -> Vec<f32> {
        let bytes = STANDARD.decode(value.as_str().unwrap()).unwrap();
        let words = bytes.chunks_exact(4);
        words
            .map(|word| f32::from_le_bytes(word.try_into().unwrap()))
            .collect()
    }

    #[test]
    fn signals_on_one_time_axis_share_it() {
        let time = vec![0.0, 0.5, 1.0];
        let signal = |values: Vec<f64>| {
            Series::new("a", time.clone(), values, Role::Measured, Stroke::Plain)
        };
        let (data, count) = chart(vec![
            signal(vec![1.0, 2.0, 3.0]),
            signal(vec![4.0, 5.0, f64::NAN]),
        ])
        .data(100);
        assert_eq!(count, [3, 3]);
        assert_eq!(unpacked(&data["at"]), [0.0, 0.5, 1.0]);
        assert_eq!(unpacked(&data["series"][0]["values"]), [1.0, 2.0, 3.0]);
        assert!(unpacked(&data["series"][1]["values"])[2].is_nan());
        assert_eq!(data["series"][0]["joined"], false);
    }

    #[test]
    fn an_area_is_two_edges_and_clouds_are_sorted() {
        // A band from 0 to 2 with its edges at 0, 1 and 2, there and back, over a cloud elsewhere.
        let band = Series::new(
            "band",
            vec![0.0, 1.0, 2.0, 2.0, 1.0, 0.0],
            vec![-1.0, -2.0, -3.0, 3.0, 2.0, 1.0],
            Role::Band,
            Stroke::Area,
        );
        let cloud = Series::new(
            "cloud",
            vec![1.5, 0.5],
            vec![7.0, 8.0],
            Role::Measured,
            Stroke::Points,
        );
        let (data, _) = chart(vec![band, cloud]).data(100);
        assert_eq!(data["areas"], json!([[0, 1]]));
        let known = |column: usize| -> Vec<f32> {
            let mut values = unpacked(&data["series"][column]["values"]);
            values.retain(|value| !value.is_nan());
            values
        };
        assert_eq!(known(0), [-1.0, -2.0, -3.0]);
        assert_eq!(known(1), [1.0, 2.0, 3.0]);
        assert_eq!(known(2), [8.0, 7.0]);
        assert!(unpacked(&data["at"]).is_sorted());
        assert_eq!(data["series"][2]["joined"], true);
    }
    #[test]
    fn a_thinned_cloud_is_as_wide_as_the_whole_one() {
        // Sums of four waves of unlike lengths lie about as noise does: thick in the middle, thin far out.
        let noise = |seed: f64| -> Vec<f64> {
            let wave = |i: i32, k: i32| (f64::from(i) * (seed + 1.7 * f64::from(k))).sin();
            (0..4000)
                .map(|i| (0..4).map(|k| wave(i, k)).sum())
                .collect()
        };
        let places = noise(0.37);
        let cloud = |label: &'static str, seed| {
            Series::new(
                label,
                places.clone(),
                noise(seed),
                Role::Measured,
                Stroke::Points,
            )
        };
        let both = chart(vec![cloud("before", 0.61), cloud("after", 0.83)]);
        let (data, [kept, of]) = both.data(1333);
        assert!(of == 4000 && kept.abs_diff(1333) < 20, "{kept} of {of}");
        let spread = |values: &[f64]| {
            let count = values.len() as f64;
            let mean = values.iter().sum::<f64>() / count;
            (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / count).sqrt()
        };
        for (which, seed) in [(0, 0.61), (1, 0.83)] {
            let thinned = unpacked(&data["series"][which]["values"]);
            let thinned: Vec<f64> = thinned.into_iter().map(f64::from).collect();
            let share = spread(&thinned) / spread(&noise(seed));
            assert!((share - 1.0).abs() < 0.05, "{share}");
        }
    }
}
