//! Effect of the resistors' tolerance and of the chain's rounding, and of a proportional term on top.

use super::bench::{Edit, LEVELS, run_all};
use super::{ROUNDING, heading, quick};
use crate::paper_page::{is_in_the_page, markdown};

#[test]
fn the_chains_rounding_alone() {
    let nominal = run_all(&quick(&[]));
    let command = |bits| {
        vec![
            Edit::Text("sensing.command.kind", "real"),
            Edit::Count("sensing.command.pwm_bits", bits),
        ]
    };
    let reading = Edit::Text("sensing.regulator_pressure.kind", "real");
    let mut both = command(8);
    both.push(reading.clone());
    let mut rows = vec![heading(&["stage"], &[])];
    // Half a step of 6 bar, seen in the reading [bar].
    let (duty, code) = (0.5 * 6.0 / 255.0, 0.5 * 6.0 / (0.8 * 1024.0));
    for (name, edits, most) in [
        ("set value in 255 steps", command(8), duty),
        ("actual value in 819 steps of the ADC", vec![reading], code),
        ("both", both, duty + code),
    ] {
        let shown = run_all(&quick(&edits));
        let mut cells = vec![name.to_owned()];
        let mut limits = vec![format!("{name}: at most")];
        for ((shown, nominal), level) in shown.iter().zip(&nominal).zip(&LEVELS) {
            let off = 100.0 * (shown.outlet_read / nominal.outlet_read - 1.0);
            let limit = 100.0 * most / level.pressure;
            // The PWM's ripple is left.
            assert!(off.abs() < limit + 0.005, "{name}: {off} of {limit} %");
            assert!(limit < level.printed, "{name} could be it");
            // No minus zero.
            cells.push(format!("{:+.2} %", (100.0 * off).round() / 100.0 + 0.0));
            limits.push(format!("{limit:.2} %"));
        }
        rows.extend([cells, limits]);
    }
    is_in_the_page("rounding", &markdown(&rows));
}

#[test]
fn amplifiers_of_bought_resistors() {
    let nominal = run_all(&[]);
    let mut rows = vec![heading(&["resistors of"], &["could be it"])];
    for (tolerance, expected) in [(0.01, false), (0.05, false), (0.1, true)] {
        let edits = [
            Edit::Text("sensing.command.kind", "real"),
            Edit::Count("sensing.command.pwm_bits", 16),
            Edit::Key("sensing.command.feedback_resistor_error", tolerance),
            Edit::Key("sensing.command.ground_resistor_error", -tolerance),
        ];
        let mut cells = vec![format!("{:.0} %", 100.0 * tolerance)];
        let mut could = true;
        for ((shown, nominal), level) in run_all(&edits).iter().zip(&nominal).zip(&LEVELS) {
            let off = 100.0 * (shown.outlet_read / nominal.outlet_read - 1.0);
            assert!((off - 75.0 * tolerance / (1.0 - tolerance)).abs() < 0.02);
            could &= off > level.printed;
            cells.push(format!("{off:.2} %"));
        }
        assert_eq!(could, expected);
        cells.push(if could { "yes" } else { "no" }.to_owned());
        rows.push(cells);
    }
    is_in_the_page("resistors", &markdown(&rows));
}

/// Ways in which a deviation could have been counted: name, sign, and whether it is of the actual value.
const COUNTED: [(&str, f64, bool); 4] = [
    ("actual higher, of the estimate", 1.0, false),
    ("actual lower, of the estimate", -1.0, false),
    ("actual higher, of the actual", 1.0, true),
    ("actual lower, of the actual", -1.0, true),
];

/// Deviation [%] of an actual value over the estimate.
fn counted(ratio: f64, of_actual: bool) -> f64 {
    100.0 * (ratio - 1.0) / if of_actual { ratio } else { 1.0 }
}

/// Largest distance [%] from the printed figures with a gain on top of each level's own factor.
fn miss(gain: f64, factors: &[f64; 4], sign: f64, of_actual: bool) -> f64 {
    let off = LEVELS
        .iter()
        .zip(factors)
        .map(|(level, factor)| (sign * counted(gain * factor, of_actual) - level.printed).abs());
    off.fold(0.0, f64::max)
}

/// The way of counting and the gain that come nearest to the four printed figures, and how near.
fn nearest(factors: &[f64; 4]) -> (usize, f64, f64) {
    let mut best = (0, 0.0, f64::INFINITY);
    for (way, &(_, sign, of_actual)) in COUNTED.iter().enumerate() {
        for index in 4_000..9_000 {
            let gain = 1.0 + sign * 1e-5 * f64::from(index);
            let miss = miss(gain, factors, sign, of_actual);
            if miss < best.2 {
                best = (way, gain, miss);
            }
        }
    }
    best
}

/// A proportional term is not the printed figures; with the set value's steps it can be, for a full scale that the paper does not state.
#[test]
fn a_proportional_term_on_top_of_the_set_values_steps() {
    let nominal = run_all(&quick(&[]));
    let mut rows = vec![heading(
        &["set value's steps", "counted", "gain"],
        &["farthest from the printed"],
    )];
    let mut within = Vec::new();
    for full_scale in [None, Some(4.0), Some(5.0), Some(6.0), Some(8.0), Some(10.0)] {
        let chain = full_scale.map_or(Vec::new(), |full_scale| {
            vec![
                Edit::Text("sensing.command.kind", "real"),
                Edit::Key("sensing.command.full_scale_bar_gauge", full_scale),
            ]
        });
        let stepped = run_all(&quick(&chain));
        let factors = std::array::from_fn(|i| stepped[i].outlet / nominal[i].outlet);
        let (way, gain, predicted) = nearest(&factors);
        let (name, sign, of_actual) = COUNTED[way];
        let edits = [
            chain,
            vec![Edit::Key("device.override.regulator_gain", gain)],
        ]
        .concat();
        let mut cells = vec![
            full_scale.map_or("none".to_owned(), |scale| {
                format!("8 bits of {scale:.0} bar")
            }),
            name.to_owned(),
            format!("{gain:.4}"),
        ];
        let mut farthest = 0f64;
        for ((shown, nominal), level) in run_all(&quick(&edits)).iter().zip(&nominal).zip(&LEVELS) {
            let off = sign * counted(shown.outlet_read / nominal.outlet_read, of_actual);
            farthest = farthest.max((off - level.printed).abs());
            cells.push(format!("{off:.2} %"));
        }
        assert!(
            (farthest - predicted).abs() < 1e-3,
            "{farthest} {predicted}"
        );
        cells.push(format!("{farthest:.3}"));
        rows.push(cells);
        if farthest < ROUNDING {
            within.push(full_scale);
        }
    }
    // Half of 6.5 - 6.0 is the best that one factor can do.
    assert_eq!(rows[1].last().unwrap(), "0.250");
    assert_eq!(within, [Some(5.0)]);
    is_in_the_page("steps", &markdown(&rows));
}
