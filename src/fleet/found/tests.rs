//! What is found in numbers that are planted: results of recordings are made here, no diagnosis runs.

use super::*;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// A number with the unit of the registry.
const NUMBER: &str = "dead_volume_cm3";

/// Recordings of a device, one a day, whose tolerated number follows a law.
fn recorded(device: &str, days: usize, value: impl Fn(usize) -> f64) -> Vec<Recording> {
    let of = |day: usize| {
        let value = value(day);
        Recording {
            device: device.to_owned(),
            name: format!("day {day}"),
            day: 20_000.0 + day as f64,
            id: format!("{device} {day}"),
            result: Diagnosed {
                verdict: "nothing_missing".to_owned(),
                tolerated: vec![NumberFound {
                    name: NUMBER.to_owned(),
                    value,
                    low: value - 1.0,
                    high: value + 1.0,
                }],
                ..Diagnosed::default()
            },
            followed: None,
        }
    };
    (0..days).map(of).collect()
}

fn found(recordings: &[Recording]) -> Found {
    let mut names: Vec<&str> = recordings.iter().map(|r| r.device.as_str()).collect();
    names.dedup();
    let devices = names.iter().map(|name| crate::fleet::Device {
        name: (*name).to_owned(),
        recordings: Vec::new(),
    });
    let layout = Layout {
        devices: devices.collect(),
        passed_over: Vec::new(),
    };
    Found::of(recordings, &layout, ("idc", &[]))
}

/// Noise of a device, the same in each run.
fn noise(seed: u64, count: usize) -> Vec<f64> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    (0..count).map(|_| random.random_range(-0.5..0.5)).collect()
}

/// A number that falls from 20 to 12 on a day is said to go from 20 to 12, in the table, in the line and of a growth alike; the step is 8, not -8.
#[test]
fn a_change_goes_from_what_was_to_what_is() {
    let noise = noise(1, 30);
    let step = recorded("a", 30, |day| {
        noise[day] + if day < 14 { 20.0 } else { 12.0 }
    });
    let found_step = found(&step);
    let changed = &found_step.devices[0].changed[0];
    assert_eq!(changed.since.kind, "step");
    assert_eq!(changed.since.date, date_of_day(20_014.0));
    assert!((changed.before - 20.0).abs() < 0.3, "{changed:?}");
    assert!((changed.after - 12.0).abs() < 0.3, "{changed:?}");
    assert!(changed.per_day.unwrap()[0] < 0.0, "{changed:?}");
    let line = found_step.devices[0].lines().join("\n");
    let (before, after) = line.split_once(" to ").unwrap();
    let first = |text: &str| -> f64 { text.split(' ').next().unwrap().parse().unwrap() };
    let last = before.rsplit(' ').next().unwrap();
    assert!((last.parse::<f64>().unwrap() - 20.0).abs() < 0.3, "{line}");
    assert!((first(after) - 12.0).abs() < 0.3, "{line}");
    let growth = recorded("a", 30, |day| {
        noise[day] + 5.0 + 0.8 * day.saturating_sub(9) as f64
    });
    let found_growth = found(&growth);
    let changed = &found_growth.devices[0].changed[0];
    assert_eq!(changed.since.kind, "growth");
    assert!((changed.before - 5.0).abs() < 0.5, "{changed:?}");
    assert!(
        (changed.after - (5.0 + 0.8 * 20.0)).abs() < 0.5,
        "{changed:?}"
    );
    // Where nothing is planted nothing is found.
    let quiet = found(&recorded("a", 30, |day| 20.0 + noise[day]));
    assert!(quiet.devices[0].changed.is_empty(), "{quiet:?}");
    assert_eq!(quiet.verdict(), "Nothing was found in 1 device.");
}

/// Devices that lie at 9.8, 9.9, 10, 10.1 and 10.2 have a spread of 0.15 (1.4826 times the median distance from their median); a sixth one is like them at
/// five such spreads from their middle and unlike them at seven, on either side.
#[test]
fn a_device_is_unlike_the_others_from_six_of_their_spreads_on() {
    let spread = NORMAL_MAD * 0.1;
    let others = [9.8, 9.9, 10.0, 10.1, 10.2];
    let unlike_at = |spreads: f64| {
        let mut all: Vec<Recording> = Vec::new();
        for (place, value) in others.iter().enumerate() {
            all.extend(recorded(&format!("d{place}"), 8, |_| *value));
        }
        all.extend(recorded("odd", 8, |_| 10.0 + spreads * spread));
        found(&all).unlike
    };
    for like in [0.0, 3.0, 5.0, -5.0] {
        assert!(unlike_at(like).is_empty(), "{like}: {:?}", unlike_at(like));
    }
    for far in [7.0, -7.0, 40.0] {
        let found = unlike_at(far);
        let names: Vec<&str> = found.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["odd"], "{far}");
        assert!(found[0].1.contains("the others 10"), "{found:?}");
    }
}

/// Of three devices none is unlike the others; a device whose own number scatters counts by its last seven recordings.
#[test]
fn few_devices_are_not_compared_and_old_recordings_do_not_count() {
    let three = [10.0, 10.1, 90.0].map(|value| recorded(&format!("d{value}"), 8, |_| value));
    assert!(found(&three.concat()).unlike.is_empty());
    let mut all: Vec<Recording> = Vec::new();
    for (place, value) in [9.9, 10.0, 10.1, 10.05].iter().enumerate() {
        all.extend(recorded(&format!("d{place}"), 20, |_| *value));
    }
    all.extend(recorded(
        "mended",
        20,
        |day| if day < 12 { 90.0 } else { 10.0 },
    ));
    assert!(found(&all).unlike.is_empty(), "{:?}", found(&all).unlike);
}

/// An effect that one device alone has, seen in three of its recordings and later, is its own; one seen in a single recording is no alarm.
#[test]
fn an_effect_that_one_device_alone_has_is_named_with_it() {
    let mut all: Vec<Recording> = Vec::new();
    for place in 0..4 {
        all.extend(recorded(&format!("d{place}"), 6, |_| 10.0));
    }
    let leak = ("external_leak".to_owned(), Vec::new());
    for recording in &mut all[20..] {
        recording.result.effects.push(leak.clone());
    }
    all[3]
        .result
        .effects
        .push(("stick_slip".to_owned(), Vec::new()));
    let found = found(&all);
    assert_eq!(
        found.unlike,
        [("d3".to_owned(), "it alone has external leak".to_owned())]
    );
    let effect = &found.devices[3].effects[0];
    assert_eq!((effect.seen, effect.of), (4, 6));
    assert_eq!(effect.first_seen, date_of_day(20_002.0));
    assert_eq!(found.devices[0].single, [("stick_slip".to_owned(), 1)]);
    assert!(found.devices[0].effects.is_empty());
}
