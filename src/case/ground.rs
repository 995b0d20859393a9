//! Known ground: what recordings took a rig through, and where a prediction leaves it.
//!
//! Ranges of states and inputs, and planes of two of them: of the speed over the stroke, and of what the regulator has still to follow over its outlet. A plane
//! knows another direction, a longer step or one that begins elsewhere, where each range by itself has seen its values.

use std::collections::BTreeMap;

use crate::diagnosis::answer::details::UnknownGround;
use crate::plant::{PlantInputs, PlantParameters, Trajectory, simulate};

/// What there is at a sample, by name.
const SERIES: [&str; 7] = [
    "outlet_pa",
    "set_less_outlet_pa",
    "stroke_m",
    "speed_m_per_s",
    "force_n",
    "surface_rate_m_per_s",
    "set_pressure_pa",
];
/// Planes: one over another, by their places among the series.
const PLANES: [(usize, usize); 2] = [(1, 0), (3, 2)];
/// Parts of the range of what a plane is over.
const PARTS: usize = 8;
/// Share of its range by which a value may lie beyond it and still be known [1].
const MARGIN: f64 = 0.25;
/// The same of a plane: its parts are coarse [1].
const PLANE_MARGIN: f64 = 0.3;
/// Time for which a rig that left known ground is not back on it [s].
const LASTS: f64 = 0.1;
/// Name of the longest time.
const DURATION: &str = "duration_s";

type Values = [Vec<f64>; SERIES.len()];

fn series(inputs: &PlantInputs, truth: &Trajectory) -> Values {
    let count = inputs.time.len();
    let rate = |i: usize| {
        let to = i.max(1);
        (inputs.surface[to] - inputs.surface[to - 1]) / (inputs.time[to] - inputs.time[to - 1])
    };
    let of = |value: &dyn Fn(usize) -> f64| (0..count).map(value).collect::<Vec<f64>>();
    let set = &inputs.set_pressure;
    [
        of(&|i| truth.outlet[i]),
        of(&|i| set[i] - truth.outlet[i]),
        of(&|i| truth.stroke[i]),
        of(&|i| truth.speed[i]),
        of(&|i| truth.contact_force[i]),
        of(&rate),
        set.clone(),
    ]
}

fn ends(values: impl Iterator<Item = f64>) -> Option<[f64; 2]> {
    let finite = values.filter(|value| value.is_finite());
    finite.fold(None, |ends: Option<[f64; 2]>, value| {
        let [low, high] = ends.unwrap_or([value; 2]);
        Some([low.min(value), high.max(value)])
    })
}

fn name_of((one, over): (usize, usize)) -> String {
    format!("{}_by_{}", SERIES[one], SERIES[over])
}

/// What recordings cover as a model runs them, by name.
pub(super) fn covered<'a>(
    runs: impl Iterator<Item = (&'a PlantInputs, &'a Trajectory)>,
) -> BTreeMap<String, Vec<f64>> {
    let mut longest = 0.0f64;
    let mut all: Vec<Values> = Vec::new();
    for (inputs, truth) in runs {
        longest = longest.max(inputs.time[inputs.time.len() - 1] - inputs.time[0]);
        all.push(series(inputs, truth));
    }
    let mut found = BTreeMap::from([(DURATION.to_owned(), vec![0.0, longest])]);
    let flat = |index: usize| all.iter().flat_map(move |run| run[index].iter().copied());
    for (index, name) in SERIES.into_iter().enumerate() {
        if let Some([low, high]) = ends(flat(index)) {
            found.insert(name.to_owned(), vec![low, high]);
        }
    }
    for plane in PLANES {
        if let Some(parts) = parts(flat(plane.0).zip(flat(plane.1)), ends(flat(plane.1))) {
            found.insert(name_of(plane), parts);
        }
    }
    found
}

/// Least and largest value in each part of the range of what it is over; a part without any takes those of its neighbours.
fn parts(pairs: impl Iterator<Item = (f64, f64)>, over: Option<[f64; 2]>) -> Option<Vec<f64>> {
    let [low, high] = over.filter(|[low, high]| high > low)?;
    let mut seen: [Option<[f64; 2]>; PARTS] = [None; PARTS];
    for (value, at) in pairs.filter(|(value, at)| value.is_finite() && at.is_finite()) {
        let part = &mut seen[part_of(at, [low, high])];
        let [least, most] = part.unwrap_or([value; 2]);
        *part = Some([least.min(value), most.max(value)]);
    }
    let of = |part: usize| {
        let near = (0..PARTS).filter_map(|other| Some((other.abs_diff(part), seen[other]?)));
        near.min_by_key(|(distance, _)| *distance)
            .map(|(_, ends)| ends)
    };
    let all: Option<Vec<[f64; 2]>> = (0..PARTS).map(of).collect();
    Some(all?.into_iter().flatten().collect())
}

fn part_of(at: f64, [low, high]: [f64; 2]) -> usize {
    let share = (at - low) / (high - low) * PARTS as f64;
    (share.clamp(0.0, (PARTS - 1) as f64)) as usize
}

/// Whether each sample of a run is on unknown ground, and where and why.
pub(super) fn unknown(
    covered: &BTreeMap<String, Vec<f64>>,
    plant: &PlantParameters,
    inputs: &PlantInputs,
) -> (Vec<bool>, Vec<UnknownGround>) {
    let truth = simulate(plant, inputs).truth;
    let values = series(inputs, &truth);
    let start = inputs.time[0];
    let mut flags = vec![false; inputs.time.len()];
    let mut found = Vec::new();
    let mut add =
        |name: &str, value: &dyn Fn(usize) -> f64, beyond: &dyn Fn(usize) -> Option<[f64; 2]>| {
            for span in spans(&inputs.time, beyond) {
                let worst = |i: &usize| {
                    let [low, high] = beyond(*i).unwrap_or([0.0; 2]);
                    (low - value(*i)).max(value(*i) - high)
                };
                let outside = (span.clone()).filter(|i| beyond(*i).is_some());
                let Some(at) = outside.max_by(|a, b| worst(a).total_cmp(&worst(b))) else {
                    continue;
                };
                let until = inputs.time[span.end - 1] + LASTS;
                flags[span.start..inputs.time.partition_point(|t| *t <= until)].fill(true);
                found.push(UnknownGround {
                    variable: name.to_owned(),
                    start_s: inputs.time[span.start],
                    end_s: inputs.time[span.end - 1],
                    value: value(at),
                    covered: beyond(at).unwrap_or([0.0; 2]),
                });
            }
        };
    if let Some([_, longest]) = covered.get(DURATION).map(|v| [v[0], v[v.len() - 1]]) {
        let value = |i: usize| inputs.time[i] - start;
        add(DURATION, &value, &|i| {
            (value(i) > (1.0 + MARGIN) * longest).then_some([0.0, longest])
        });
    }
    for (index, name) in SERIES.into_iter().enumerate() {
        let Some([low, high]) = covered
            .get(name)
            .and_then(|v| <[f64; 2]>::try_from(v.as_slice()).ok())
        else {
            continue;
        };
        let margin = MARGIN * (high - low);
        let value = |i: usize| values[index][i];
        let beyond = |i: usize| {
            let out = value(i) < low - margin || value(i) > high + margin;
            out.then_some([low, high])
        };
        add(name, &value, &beyond);
    }
    for plane in PLANES {
        let name = name_of(plane);
        let over = covered
            .get(SERIES[plane.1])
            .and_then(|v| <[f64; 2]>::try_from(v.as_slice()).ok());
        let (Some(parts), Some(over)) = (covered.get(&name).filter(|p| p.len() == 2 * PARTS), over)
        else {
            continue;
        };
        let all = ends(parts.iter().copied()).unwrap_or([0.0; 2]);
        let margin = PLANE_MARGIN * (all[1] - all[0]);
        let value = |i: usize| values[plane.0][i];
        let beyond = |i: usize| {
            let part = part_of(values[plane.1][i], over);
            // The neighbouring parts too: their border is nowhere in particular.
            let near = &parts[2 * part.saturating_sub(1)..(2 * part + 4).min(2 * PARTS)];
            let [low, high] = ends(near.iter().copied())?;
            let out = value(i) < low - margin || value(i) > high + margin;
            out.then_some([low, high])
        };
        add(&name, &value, &beyond);
    }
    (flags, found)
}

/// Stretches in which a variable is beyond what was covered, of two samples at least; those less than the time for which it lasts apart are one.
fn spans(time: &[f64], beyond: &dyn Fn(usize) -> Option<[f64; 2]>) -> Vec<std::ops::Range<usize>> {
    let mut found: Vec<std::ops::Range<usize>> = Vec::new();
    for i in (0..time.len()).filter(|i| beyond(*i).is_some()) {
        match found.last_mut() {
            Some(last) if time[i] - time[last.end - 1] < LASTS => last.end = i + 1,
            _ => found.push(i..i + 1),
        }
    }
    found.retain(|span| span.len() > 1);
    found
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::plant::InitialState;
    use crate::scenario::rig_file::{RigFile, from_text};
    use std::path::Path;

    /// A regulator whose gain is known to a tenth.
    pub fn regulator() -> RigFile {
        let text = "schema = 2\n[rig]\nchain = \"regulator\"\n[regulator]\ngain = { value = 1.0, tolerance = 0.1 }\ntime_constant_s = 0.1\n[sensors]\nrate_hz = 100\nregulator_pressure_pa = 400.0\n[recordings]\nfit = [\"a.csv\"]\n";
        from_text(Path::new("rig.toml"), text).unwrap()
    }

    /// A second at each of some set pressures [Pa gauge].
    pub fn steps(levels: &[f64]) -> PlantInputs {
        let set_pressure: Vec<f64> = levels.iter().flat_map(|level| [*level; 100]).collect();
        let count = set_pressure.len();
        PlantInputs {
            cell: None,
            motion: None,
            initial: InitialState::AtRest,
            place: 0,
            set_pressure,
            extends: vec![true; count],
            surface: vec![f64::NAN; count],
            time: (0..count).map(|i| 0.01 * i as f64).collect(),
        }
    }

    fn leaves(inputs: &PlantInputs) -> Vec<String> {
        let plant = regulator().plant;
        let fitted = steps(&[0.0, 1e5, 0.0, 2e5, 1e5, 0.0]);
        let truth = simulate(&plant, &fitted).truth;
        let covered = covered(std::iter::once((&fitted, &truth)));
        let (flags, found) = unknown(&covered, &plant, inputs);
        assert_eq!(flags.contains(&true), !found.is_empty());
        let mut names: Vec<String> = found.into_iter().map(|ground| ground.variable).collect();
        names.dedup();
        names
    }

    #[test]
    fn what_was_covered_is_known_and_what_leaves_it_is_not() {
        assert!(leaves(&steps(&[0.0, 1e5, 0.0, 2e5, 1e5, 0.0])).is_empty());
        assert!(leaves(&steps(&[0.0, 1.1e5, 0.0])).is_empty());
        assert!(leaves(&steps(&[0.0, 4e5])).contains(&"outlet_pa".to_owned()));
        assert_eq!(leaves(&steps(&[0.0; 9])), [DURATION]);
    }

    /// Large steps were seen both ways, and at a high outlet none downwards.
    #[test]
    fn a_step_from_where_none_began_is_unknown_ground() {
        let plane = name_of(PLANES[0]);
        let parts = [-1e5, 4e5].repeat(PARTS);
        let covered = BTreeMap::from([
            ("outlet_pa".to_owned(), vec![0.0, 4e5]),
            ("set_less_outlet_pa".to_owned(), vec![-4e5, 4e5]),
            (plane.clone(), parts),
        ]);
        let plant = regulator().plant;
        let names = |levels: &[f64]| -> Vec<String> {
            let (_, found) = unknown(&covered, &plant, &steps(levels));
            found.into_iter().map(|ground| ground.variable).collect()
        };
        assert_eq!(names(&[0.0, 4e5, 0.0]), [plane]);
        assert!(names(&[0.0, 4e5, 3e5]).is_empty());
    }
}
