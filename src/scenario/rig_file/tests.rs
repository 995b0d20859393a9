//! Rig files that are right, and what is said of those that are not.

use crate::scenario::effects::{WrittenEffect, as_written};
use std::collections::BTreeSet;
use std::path::Path;

use super::*;
use crate::flange::{CoveredRuns, FLANGE_NUMBERS, FittedFlange, FlangeModel, Reader, Ripple};
use crate::plant::{Basis, ContactLaw, Latent, Port, SensorErrors, Variable};

/// A rig file as its owner writes it.
pub(crate) const RIG: &str = r#"# The device by its nominal values.
schema = 1

[cylinder]
count = 2                      # identical
bore_m = 0.025
rod_m = 0.01
stroke_m = 0.05
dead_volume_m3 = { value = 1.454e-05, tolerance = 0.1 }   # each chamber
moving_mass_kg = { value = 5.09, tolerance = 0.01 }
gravity_along_axis_m_per_s2 = -9.81

[end_stop]
stiffness_n_per_m = 1000000
damping_n_s_per_m = 2000

[regulator]
gain = { value = 1, tolerance = 0.01 }
time_constant_s = { value = 0.158, tolerance = 0.1 }

[valve]
supply_orifice_m2 = { value = 1.589e-06, tolerance = 0.05 }
exhaust_orifice_m2 = { value = 1.274e-06, tolerance = 0.05 }
discharge_coefficient = 0.95

[gas]
specific_gas_constant_j_per_kg_k = 287.05
heat_capacity_ratio = 1.4
temperature_k = 293.15
atmosphere_pa = 101325.0

[contact]
stiffness_n_per_m = { value = 211000, tolerance = 0.1 }
damping_n_s_per_m = { value = 388, tolerance = 0.3 }

[sensors]
rate_hz = 250
force_n = 0.8
stroke_m = 2e-05
regulator_pressure_pa = 400.0
acceleration_m_per_s2 = 0.15

[recordings]
fit = ["stairs.csv", "ride.csv"]
predict = "predict.csv"
"#;

/// Friction and a late load cell, as a diagnosis adds them.
pub(crate) const EFFECTS: &str = r"
[effect.channel_time_offset]
offset_s = 0.012

[effect.coulomb_viscous_friction]
coulomb_force_n = { value = 12.5, low = 12, high = 13.5 }
viscous_coefficient_n_s_per_m = 90
presliding_displacement_m = 4e-5
";

fn read(text: &str) -> RigFile {
    from_text(Path::new("rig.toml"), text).unwrap()
}

fn refused(from: &str, to: &str, says: &str) {
    let text = RIG.to_owned() + EFFECTS;
    assert!(text.contains(from), "{from}");
    let text = text.replacen(from, to, 1);
    let message = from_text(Path::new("rig.toml"), &text)
        .unwrap_err()
        .to_string();
    assert_eq!(message, format!("rig.toml:{says}"), "{to}");
}

#[test]
fn a_nominal_rig_is_what_its_file_says_and_nothing_besides() {
    let rig = read(RIG);
    let device = &rig.plant.device;
    assert_eq!(device.cylinder_count, 2);
    assert_eq!(
        (device.bore, device.rod, device.full_stroke),
        (0.025, 0.01, 0.05)
    );
    assert_eq!((device.dead_volume, device.moving_mass), (1.454e-5, 5.09));
    assert_eq!(
        (device.supply_orifice, device.exhaust_orifice),
        (1.589e-6, 1.274e-6)
    );
    assert_eq!(
        (device.regulator.gain, device.regulator.time_constant),
        (1.0, 0.158)
    );
    assert_eq!(device.regulator.dead_time, 0.0);
    assert_eq!(
        (device.end_stop.stiffness, device.end_stop.damping),
        (1e6, 2e3)
    );
    assert_eq!(device.gas.atmosphere, 101_325.0);
    assert_eq!(rig.plant.gravity_along_extension, -9.81);
    assert_eq!(
        rig.plant.contact.law,
        ContactLaw::Linear {
            stiffness: 211_000.0
        }
    );
    assert_eq!(rig.plant.contact.damping, 388.0);
    assert_eq!(rig.plant.sensors, SensorErrors::NONE);
    assert_eq!((rig.rate, rig.noise), (250.0, [400.0, 2e-5, 0.8, 0.15]));
    assert_eq!(rig.fit, ["stairs.csv", "ride.csv"]);
    assert_eq!(rig.predict.as_deref(), Some("predict.csv"));
    assert!(rig.effects.is_empty());
    for number in quantities::NUMBERS {
        assert!(number.quantity().get(&rig.plant).is_finite(), "{number:?}");
    }
}

#[test]
fn numbers_with_a_tolerance_are_listed_with_their_place_in_the_rig() {
    let rig = read(RIG);
    let listed: Vec<(&str, f64, f64)> = rig
        .tolerances
        .iter()
        .map(|t| (t.key, t.value, t.tolerance))
        .collect();
    assert_eq!(
        listed,
        [
            ("cylinder.dead_volume_m3", 1.454e-5, 0.1),
            ("cylinder.moving_mass_kg", 5.09, 0.01),
            ("regulator.gain", 1.0, 0.01),
            ("regulator.time_constant_s", 0.158, 0.1),
            ("valve.supply_orifice_m2", 1.589e-6, 0.05),
            ("valve.exhaust_orifice_m2", 1.274e-6, 0.05),
            ("contact.stiffness_n_per_m", 211_000.0, 0.1),
            ("contact.damping_n_s_per_m", 388.0, 0.3),
        ]
    );
    let mut plant = rig.plant.clone();
    for tolerance in &rig.tolerances {
        assert_eq!(tolerance.quantity.get(&plant), tolerance.value);
        tolerance.quantity.set(&mut plant, 2.0 * tolerance.value);
        assert_eq!(tolerance.quantity.get(&plant), 2.0 * tolerance.value);
    }
}

#[test]
fn an_interval_is_a_tolerance() {
    let text = RIG.replace(
        "{ value = 5.09, tolerance = 0.01 }",
        "{ value = 5.0, low = 4.9, high = 5.05 }",
    );
    let mass = read(&text).tolerances[1];
    assert_eq!(mass.value, 5.0);
    assert!((mass.tolerance - 0.02).abs() < 1e-12);
}

#[test]
fn effects_become_part_of_the_rig_and_are_listed() {
    let rig = read(&(RIG.to_owned() + EFFECTS));
    let seals = &rig.plant.device.seal_friction;
    assert_eq!((seals.coulomb, seals.static_force), (12.5, 12.5));
    assert_eq!((seals.viscous, seals.presliding_displacement), (90.0, 4e-5));
    assert_eq!(rig.plant.sensors.force_delay, 0.012);
    let listed: Vec<(&str, &[f64])> = rig
        .effects
        .iter()
        .map(|present| (present.effect.name, present.values.as_slice()))
        .collect();
    assert_eq!(
        listed,
        [
            ("coulomb_viscous_friction", &[12.5, 90.0, 4e-5][..]),
            ("channel_time_offset", &[0.012][..])
        ]
    );
}

#[test]
fn the_practice_like_file_without_recordings_is_a_rig_too() {
    let text = RIG.split("[recordings]").next().unwrap();
    let rig = read(text);
    assert!(rig.fit.is_empty() && rig.predict.is_none());
}

#[test]
fn a_sensor_that_is_not_named_is_not_there_and_one_must_be() {
    let without = |keys: &[&str]| {
        let lines = RIG.lines();
        let kept = lines.filter(|line| !keys.iter().any(|key| line.starts_with(key)));
        kept.map(|line| format!("{line}\n")).collect::<String>()
    };
    let rig = from_text(Path::new("rig.toml"), &without(&["acceleration_m_per_s2"])).unwrap();
    assert_eq!(rig.sensors(), [true, true, true, false]);
    let keys = [
        "acceleration_m_per_s2",
        "regulator_pressure_pa",
        "stroke_m = 2",
        "force_n",
    ];
    let none = from_text(Path::new("rig.toml"), &without(&keys)).unwrap_err();
    assert!(none.to_string().contains("one sensor at least"), "{none}");
}

#[test]
fn parts_that_are_shared_are_stated_by_an_identity_and_not_assumed() {
    let stated = "[shares]\nforce_sensor = \" LC-7 \"\n";
    let rig = read(&(RIG.to_owned() + stated));
    let of = ["cylinder", "force_sensor", "regulator"].map(|part| rig.shares.of(part));
    assert_eq!(of, [None, Some("LC-7"), None]);
    assert_eq!(read(RIG).shares.of("force_sensor"), None);
    // An improved file is of the same parts.
    let improved = improved_text(&rig, &Improved::default());
    assert_eq!(read(&improved).shares, rig.shares);
    let instead = |keys: &str| format!("[shares]\n{keys}\n\n[effect.channel_time_offset]");
    let refuse = |keys: &str, says: &str| {
        refused("[effect.channel_time_offset]", &instead(keys), says);
    };
    refuse(
        "force_senser = \"LC-7\"",
        "48:1: unknown key `shares.force_senser`; did you mean `force_sensor`?",
    );
    refuse(
        "regulator = 7",
        "48:13: `shares.regulator` is 7, expected a text in quotes",
    );
    refuse(
        "cylinder = \" \"",
        "48:1: `shares.cylinder` is \" \", expected a text",
    );
}

#[test]
fn values_in_common_units_are_recognised() {
    refused(
        "atmosphere_pa = 101325.0",
        "atmosphere_pa = 1.01325",
        "30:1: `gas.atmosphere_pa` is 1.01325 Pa, expected 50000 to 110000 Pa (it looks like bar; a rig file is in SI)",
    );
    refused(
        "bore_m = 0.025",
        "bore_m = 25",
        "6:1: `cylinder.bore_m` is 25 m, expected 0.002 to 0.3 m (it looks like mm; a rig file is in SI)",
    );
    refused(
        "{ value = 1.454e-05, tolerance = 0.1 }",
        "{ value = 14.54, tolerance = 0.1 }",
        "9:1: `cylinder.dead_volume_m3` is 14.54 m3, expected 1e-8 to 0.005 m3 (it looks like cm3; a rig file is in SI)",
    );
    refused(
        "temperature_k = 293.15",
        "temperature_k = 20",
        "29:1: `gas.temperature_k` is 20 K, expected 200 to 500 K (it looks like degrees Celsius; a rig file is in SI)",
    );
    refused(
        "regulator_pressure_pa = 400.0",
        "regulator_pressure_pa = 0.004",
        "40:1: `sensors.regulator_pressure_pa` is 0.004 Pa, expected 1 to 100000 Pa (it looks like bar; a rig file is in SI)",
    );
}

#[test]
fn keys_that_are_wrong_are_named_with_the_right_one() {
    refused(
        "bore_m = 0.025",
        "bore_mm = 25",
        "6:1: unknown key `cylinder.bore_mm`; the key is `bore_m`, in m",
    );
    refused(
        "gain = {",
        "gian = {",
        "18:1: unknown key `regulator.gian`; did you mean `gain`?",
    );
    refused(
        "tolerance = 0.1 }   #",
        "tolerence = 0.1 }   #",
        "9:39: unknown key `cylinder.dead_volume_m3.tolerence`; did you mean `tolerance`?",
    );
    refused(
        "[valve]",
        "[vlave]",
        "21:2: unknown key `vlave`; did you mean `valve`?",
    );
    refused(
        "bore_m = 0.025\n",
        "",
        "4:2: `cylinder.bore_m` is missing, expected it to be given in m",
    );
    refused(
        "[effect.coulomb_viscous_friction]",
        "[effect.coulomb_friction]",
        "50:9: unknown key `effect.coulomb_friction`; did you mean `coulomb_viscous_friction`?",
    );
    refused(
        "offset_s = 0.012",
        "delay_s = 0.012",
        "48:1: unknown key `effect.channel_time_offset.delay_s`; known here are offset_s",
    );
    refused(
        "viscous_coefficient_n_s_per_m = 90\n",
        "",
        "50:9: `effect.coulomb_viscous_friction.viscous_coefficient_n_s_per_m` is missing, expected every number of the effect to be given",
    );
}

#[test]
fn values_that_are_wrong_are_refused_with_what_was_expected() {
    refused(
        "bore_m = 0.025",
        "bore_m = \"0.025\"",
        "6:10: `cylinder.bore_m` is \"0.025\", expected a number or { value, tolerance }, in m",
    );
    refused(
        "bore_m = 0.025",
        "bore_m = nan",
        "6:1: `cylinder.bore_m` is NaN m, expected 0.002 to 0.3 m",
    );
    refused(
        "count = 2",
        "count = 1.5",
        "5:1: `cylinder.count` is 1.5, expected a whole number",
    );
    refused(
        "rod_m = 0.01",
        "rod_m = 0.03",
        "7:1: `cylinder.rod_m` is 0.03 m, expected less than bore_m, 0.025 m",
    );
    refused(
        "tolerance = 0.1 }   #",
        "tolerance = 10 }   #",
        "9:39: `cylinder.dead_volume_m3.tolerance` is 10, expected 0 to less than 1, a share of the value",
    );
    refused(
        "{ value = 5.09, tolerance = 0.01 }",
        "{ value = 5.09, low = 5.1, high = 5.2 }",
        "10:34: `cylinder.moving_mass_kg.low` is 5.1, expected at most the value, 5.09",
    );
    refused(
        "{ value = 5.09, tolerance = 0.01 }",
        "{ value = 5.09, low = -1e300, high = 5.2 }",
        "10:34: `cylinder.moving_mass_kg.low` is -1e300, expected no farther from the value than 1000 times itself",
    );
    refused(
        "force_n = 0.8",
        "force_n = { value = 0.8, tolerance = 0.1 }",
        "38:1: `sensors.force_n` cannot stand here: this number is taken to be exact",
    );
    refused(
        "\"ride.csv\"",
        "\"stairs.csv\"",
        "44:22: `recordings.fit[1]` is \"stairs.csv\" again, expected each recording once",
    );
    refused(
        "schema = 1",
        "schema = 3",
        "2:10: schema is 3, expected 1 to 2",
    );
    refused(
        "offset_s = 0.012",
        "offset_s = 12",
        "48:1: `effect.channel_time_offset.offset_s` is 12 s, expected -1 to 1 s (it looks like ms; a rig file is in SI)",
    );
    refused(
        "[effect.channel_time_offset]\noffset_s = 0.012",
        "[effect.stribeck_friction]\ncoulomb_force_n = 8\nstatic_force_n = 12\nstribeck_velocity_m_per_s = 0.01\nviscous_coefficient_n_s_per_m = 9\npresliding_displacement_m = 4e-5",
        "47:9: `effect.stribeck_friction` cannot stand here: coulomb_viscous_friction stands in its place already",
    );
}

/// The whole catalogue, each at a start of its own, groups apart.
fn found() -> Vec<WrittenEffect<'static>> {
    let rig = read(RIG);
    let periodic = [3.0, 37.0];
    let clues = crate::effects::Clues {
        plant: &rig.plant,
        largest_force: 200.0,
        periodic: &periodic,
        bumps: &[],
    };
    let mut groups = BTreeSet::new();
    crate::effects::CATALOGUE
        .iter()
        .filter(|effect| effect.group.is_none_or(|group| groups.insert(group)))
        .map(|effect| {
            let start = effect.starts(&clues).remove(0);
            let parameters = effect.parameters(&rig.plant);
            let numbered = parameters.iter().zip(start).enumerate();
            let parameters = numbered
                .map(|(i, (parameter, value))| {
                    let value = value * 1.012_345_678_9 + 1e-9;
                    let interval = parameter.reported.then_some([value - 1e-9, value + 1e-9]);
                    (parameter.quantity.name, value, interval.filter(|_| i == 0))
                })
                .collect();
            WrittenEffect {
                effect,
                law: None,
                parameters,
            }
        })
        .collect()
}

#[test]
fn an_improved_file_reads_back_as_the_rig_that_was_found() {
    let rig = read(RIG);
    let found = found();
    assert!(found.len() > 25, "{}", found.len());
    let tolerated: Vec<(&str, f64, f64, f64)> = rig
        .tolerances
        .iter()
        .map(|t| (t.key, 1.012_345_678 * t.value, t.value, 1.02 * t.value))
        .collect();
    let mut expected = rig.plant.clone();
    for (tolerance, moved) in rig.tolerances.iter().zip(&tolerated) {
        tolerance.quantity.set(&mut expected, as_written(moved.1));
    }
    for improved in &found {
        let values: Vec<f64> = improved
            .parameters
            .iter()
            .map(|p| as_written(p.1))
            .collect();
        let parameters = improved.effect.parameters(&expected);
        for (parameter, value) in parameters.iter().zip(values) {
            parameter.quantity.set(&mut expected, value);
        }
    }
    let text = improved_text(
        &rig,
        &Improved {
            tolerated: &tolerated,
            effects: &found,
            ..Improved::default()
        },
    );
    let improved = read(&text);
    assert_eq!(improved.plant, expected);
    assert_ne!(improved.plant, rig.plant);
    assert_eq!(improved.effects.len(), found.len());
    assert_eq!((improved.noise, improved.fit), (rig.noise, rig.fit));
    let mass = improved.tolerances[1];
    assert_eq!(mass.key, "cylinder.moving_mass_kg");
    assert!((mass.tolerance - 0.0122).abs() < 1e-4, "{}", mass.tolerance);
    // Once more, with nothing found: the effects go, what else was found stays.
    let again = read(&improved_text(&read(&text), &Improved::default()));
    assert!(again.effects.is_empty());
    assert_eq!(again.tolerances[1].value, mass.value);
}

#[test]
fn an_improved_file_differs_from_the_nominal_one_by_the_diagnosis_alone() {
    let rig = read(RIG);
    let friction = WrittenEffect {
        law: None,
        effect: crate::effects::CATALOGUE
            .iter()
            .find(|effect| effect.name == "coulomb_viscous_friction")
            .unwrap(),
        parameters: vec![
            ("coulomb_force_n", 13.200_000_000_004, Some([12.8, 13.6])),
            ("viscous_coefficient_n_s_per_m", 90.123_456_789_123, None),
            ("presliding_displacement_m", 4.123_456_789_123e-5, None),
        ],
    };
    let moved = [(
        "cylinder.dead_volume_m3",
        1.471_234_567_891e-5,
        1.45e-5,
        1.5e-5,
    )];
    let expected = RIG.replace(
        "{ value = 1.454e-05, tolerance = 0.1 }   # each chamber",
        "{ value = 1.47123457e-5, low = 1.45e-5, high = 1.5e-5 }   # each chamber",
    );
    // What has effects is of the version that has them as a list.
    let expected = expected.replace("schema = 1", "schema = 2")
        + "
# Found: seals and guides rub: a dry part and one that grows with speed.
[[effect]]
name = \"coulomb_viscous_friction\"
coulomb_force_n = { value = 13.2, low = 12.8, high = 13.6 }
viscous_coefficient_n_s_per_m = 90.1234568
presliding_displacement_m = 4.12345679e-5
";
    assert_eq!(
        improved_text(
            &rig,
            &Improved {
                tolerated: &moved,
                effects: &[friction],
                ..Improved::default()
            }
        ),
        expected
    );
    assert_eq!(improved_text(&rig, &Improved::default()), RIG);
}

/// Terms of either kind, in numbers as a file holds them.
fn terms() -> [Latent; 3] {
    let hats = Latent {
        port: Port::PistonForce,
        variable: Variable::Stroke,
        directed: true,
        basis: Basis::Hats {
            ends: [0.012_345_7, 0.023_456_8],
        },
        coefficients: vec![0.0, -31.2346, 4.0, 1.5e-7],
    };
    let flow = Latent {
        port: Port::FirstChamberFlow,
        variable: Variable::PressureDifference,
        directed: false,
        basis: Basis::Hats {
            ends: [-412_000.0, 588_123.0],
        },
        coefficients: vec![1.25e-5; 24],
    };
    let waves = Latent {
        port: Port::OutletPressure,
        variable: Variable::Time,
        directed: false,
        basis: Basis::Waves { frequency: 6.40123 },
        coefficients: vec![4100.0, -800.25, 120.0, 95.5],
    };
    [hats, flow, waves]
}

#[test]
fn a_model_discrepancy_reads_back_as_it_was_found() {
    let rig = read(RIG);
    for term in terms() {
        let text = improved_text(
            &rig,
            &Improved {
                unnamed: Some(&term),
                ..Improved::default()
            },
        );
        let mut expected = rig.plant.clone();
        expected.latent = Some(term);
        assert_eq!(read(&text).plant, expected, "{text}");
        // A file with a term in place of which another is found has that one alone.
        let none = improved_text(&read(&text), &Improved::default());
        assert_eq!(read(&none).plant, rig.plant);
    }
    let mut ragged = terms()[0].clone();
    ragged.coefficients[1] = -31.234_600_000_004;
    let text = improved_text(
        &rig,
        &Improved {
            unnamed: Some(&ragged),
            ..Improved::default()
        },
    );
    assert_eq!(read(&text).plant.latent, Some(terms()[0].clone()));
    assert!(text.ends_with(
        "[latent]\nport = \"piston_force\"\nvariable = \"stroke_m\"\ndirected = true\nfrom_m = 0.0123457\nto_m = 0.0234568\nvalue_n = [0.0, -31.2346, 4.0, 1.5e-7]\n"
    ), "{text}");
}

#[test]
fn a_term_that_is_not_right_is_refused_by_its_key() {
    let [hats, _, waves] = terms().map(|term| {
        improved_text(
            &read(RIG),
            &Improved {
                unnamed: Some(&term),
                ..Improved::default()
            },
        )
    });
    let says = |text: &str, right: &str, wrong: &str, expected: &str| {
        assert!(text.contains(right), "{text}");
        let text = text.replace(right, wrong);
        let message = from_text(Path::new("rig.toml"), &text)
            .unwrap_err()
            .to_string();
        assert!(message.contains(expected), "{message}");
    };
    for (right, wrong, expected) in [
        (
            "\"piston_force\"",
            "\"piston\"",
            "`latent.port` is \"piston\", expected one of \"piston_force\", \"friction\", \"set_pressure\", \"outlet_pressure\"",
        ),
        (
            "\"stroke_m\"",
            "3",
            "`latent.variable` is 3, expected one of \"time\"",
        ),
        (
            "directed = true",
            "directed = 1",
            "`latent.directed` is 1, expected true or false",
        ),
        (
            "directed = true\n",
            "",
            "`latent.directed` is missing, expected true or false",
        ),
        (
            "to_m = 0.0234568",
            "to_m = 0.01",
            "`latent.to_m` is 0.01, expected more than from_m, 0.0123457",
        ),
        (
            "to_m =",
            "to_mm =",
            "unknown key `latent.to_mm`; did you mean `to_m`?",
        ),
        (
            "value_n = [",
            "value_pa = [",
            "unknown key `latent.value_pa`",
        ),
        (
            "[0.0, -31.2346, 4.0, 1.5e-7]",
            "[0.0]",
            "`latent.value_n` is a list of 1, expected a list of 2 to 24 numbers",
        ),
        (
            "-31.2346",
            "nan",
            "`latent.value_n[1]` is NaN, expected a number from",
        ),
        (
            "from_m = 0.0123457",
            "from_m = \"low\"",
            "`latent.from_m` is \"low\", expected a number from",
        ),
        (
            "from_m =",
            "frequency_hz = 3\nfrom_m =",
            "`latent.frequency_hz` cannot stand here: a periodic term is one over time",
        ),
    ] {
        says(&hats, right, wrong, expected);
    }
    says(
        &waves,
        "frequency_hz = 6.40123",
        "frequency_hz = 0",
        "`latent.frequency_hz` is 0, expected a number from 0.001 to 10000",
    );
    says(
        &waves,
        "cosine_pa = [-800.25, 95.5]",
        "cosine_pa = [95.5]",
        "`latent.cosine_pa` is a list of 1, expected a list of 2",
    );
}

#[test]
fn a_fitted_flange_is_written_and_read_back() {
    let rig = "schema = 2\n[rig]\nchain = \"contact_flange\"\n[cylinder]\nmoving_mass_kg = 3.38\n[regulator]\ntime_constant_s = 0.05\n[sensors]\nforce_n = 0.1\n";
    let model = |mass: f64| {
        let mut numbers = [0.5; FLANGE_NUMBERS];
        numbers[0] = mass;
        FlangeModel::of(&numbers)
    };
    let fitted = FittedFlange {
        models: vec![model(3.4), model(1.0 / 3.0)],
        reader: Reader {
            period: 1.0 / 480.0,
            gain: 1.43,
        },
        ripple: Some(Ripple {
            ratio: 0.02,
            bandwidth: 15.0,
        }),
        half_widths: [0.3, 0.2, 0.5, 0.25],
        covered: CoveredRuns {
            approach: [0.1, 0.25],
            before: [10.0, 100.0],
            desired: [35.0, 100.0],
        },
    };
    let written = Improved {
        flange: Some(&fitted),
        ..Improved::default()
    };
    let text = improved_text(&read(rig), &written);
    let again = read(&text);
    assert_eq!(again.flange.as_ref(), Some(&fitted));
    // A second diagnosis writes its own in place of it.
    assert_eq!(
        improved_text(&again, &written).matches("[flange]").count(),
        1
    );
    let refused = |from: &str, to: &str, says: &str| {
        assert!(text.contains(from), "{from}");
        let error = from_text(Path::new("rig.toml"), &text.replacen(from, to, 1));
        let words = error.unwrap_err().to_string();
        assert!(words.contains(says), "{words}");
    };
    refused("head_mass_kg = 5e-1\n", "", "head_mass_kg");
    refused("head_mass_kg", "head_mass", "head_mass");
    refused(
        "arm_ripple_bandwidth_hz = 1.5e1\n",
        "",
        "arm_ripple_bandwidth_hz",
    );
    refused("moving_mass_kg = 3.4e0", "moving_mass_kg = -1", "expected");
}
