//! The picture of an effect: the signals that show it most, nominal and with it.

use super::super::error::AppError;
use super::page::title;
use crate::demonstration::{self as scene, ArmStage, Signal, Signals, Stage};
use crate::document::{Figure, Panel, Role, Series, Stroke};
use crate::effects::Effect;
use crate::figure::svg;
use crate::recorded_arm::vocabulary::ArmEffectName;

/// Largest distance of a line with fewer points from the one with all, as a share of its panel's height: a third of a pixel.
const BESIDE_LINE: f64 = 2e-3;

/// A picture, and how much of it the effect is.
pub(super) struct Picture {
    pub svg: String,
    /// Largest difference of a signal, as a share of its range in the picture.
    pub difference: f64,
}

/// Runs the scene of an effect nominal and with it, and draws both.
pub(super) fn picture(effect: &Effect, stage: &Stage) -> Result<Picture, AppError> {
    let shown = scene::of(effect);
    let title = title(effect, &stage.nominal, stage.most_observable_joint);
    drawn(
        &stage.runs(effect)?,
        shown.window,
        Some(shown.signals),
        title,
    )
}

/// The picture of an effect of an arm file: the readings that it changes most, over the whole run.
pub(super) fn picture_of_arm(
    effect: &ArmEffectName,
    stage: &ArmStage,
    title: String,
) -> Result<Picture, AppError> {
    drawn(&stage.runs(effect)?, None, None, title)
}

/// Draws runs without an effect and with it: signals of these keys, or all.
fn drawn(
    runs: &[Signals; 2],
    window: Option<[f64; 2]>,
    keys: Option<&[&str]>,
    title: String,
) -> Result<Picture, AppError> {
    let time = &runs[0].time;
    let count = time.len().min(runs[1].time.len());
    let span = match window {
        None => 0..count,
        Some(window) => {
            let [from, to] = window.map(|at| time.partition_point(|time| *time < at).min(count));
            from..to
        }
    };
    let mut difference = 0.0f64;
    let mut panels = Vec::new();
    let both = |key: &str| {
        let mut all = runs.iter();
        let mut own = || all.next()?.signals.iter().find(|signal| signal.key == key);
        Some((own()?, own()?))
    };
    let pairs: Vec<(&Signal, &Signal)> = match keys {
        Some(keys) => keys.iter().filter_map(|key| both(key)).collect(),
        None => runs[0].signals.iter().zip(&runs[1].signals).collect(),
    };
    for (nominal, with) in pairs {
        let values = [nominal, with].map(|signal| &signal.values[span.clone()]);
        let all = || values.iter().copied().flatten();
        let low = all().copied().fold(f64::INFINITY, f64::min);
        let range = all().copied().fold(f64::NEG_INFINITY, f64::max) - low;
        let off = values[0].iter().zip(values[1]).map(|(a, b)| (a - b).abs());
        if range > 0.0 {
            difference = difference.max(off.fold(0.0, f64::max) / range);
        }
        let line = |label: &str, values: &[f64], role, stroke| {
            let time = &time[span.clone()];
            let kept = thinned(time, values, BESIDE_LINE * range);
            let of = |values: &[f64]| kept.iter().map(|&index| values[index]).collect::<Vec<_>>();
            Series::new(label, of(time), of(values), role, stroke)
        };
        let mut series = Vec::new();
        let is_outlet = nominal.title.starts_with("Regulator");
        if let (true, Some(set)) = (is_outlet, runs[0].set.get(span.clone())) {
            series.push(line("set", set, Role::Command, Stroke::Raw));
        }
        series.push(line("nominal", values[0], Role::Measured, Stroke::Truth));
        series.push(line(
            "with the effect",
            values[1],
            Role::Force,
            Stroke::Plain,
        ));
        panels.push(Panel {
            title: nominal.title.clone(),
            vertical_label: format!("{} [{}]", nominal.axis, nominal.unit),
            series,
            ..Panel::default()
        });
    }
    let svg = svg(&Figure { title, panels })?;
    Ok(Picture { svg, difference })
}

/// Which samples a line needs to lie nowhere further than a tolerance from all of them (Ramer 1972, Douglas and Peucker 1973).
fn thinned(time: &[f64], values: &[f64], tolerance: f64) -> Vec<usize> {
    let Some(last) = time.len().checked_sub(1) else {
        return Vec::new();
    };
    let mut kept = vec![0, last];
    let mut open = vec![(0, last)];
    while let Some((from, to)) = open.pop() {
        let slope = (values[to] - values[from]) / (time[to] - time[from]);
        let off = |index: usize| {
            (values[index] - values[from] - slope * (time[index] - time[from])).abs()
        };
        let far = (from + 1..to).max_by(|&a, &b| off(a).total_cmp(&off(b)));
        if let Some(far) = far.filter(|far| off(*far) > tolerance) {
            kept.push(far);
            open.extend([(from, far), (far, to)]);
        }
    }
    kept.sort_unstable();
    kept.dedup();
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thinned_line_stays_near_the_whole_one() {
        let time: Vec<f64> = (0..2000).map(|index| 1e-3 * f64::from(index)).collect();
        let values: Vec<f64> = time.iter().map(|t| (9.0 * t).sin() + t.floor()).collect();
        let kept = thinned(&time, &values, 1e-2);
        assert!(kept.len() < 100, "{}", kept.len());
        assert_eq!((kept[0], kept[kept.len() - 1]), (0, 1999));
        for pair in kept.windows(2) {
            let [from, to] = [pair[0], pair[1]];
            for index in from..to {
                let share = (time[index] - time[from]) / (time[to] - time[from]);
                let line = values[from] + share * (values[to] - values[from]);
                assert!((values[index] - line).abs() <= 1e-2 + 1e-12);
            }
        }
    }
}
