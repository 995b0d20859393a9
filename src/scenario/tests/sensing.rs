//! `[sensing]`: presets, kinds, each key in its field, each misuse refused.

use super::super::largest_set_pressure;
use super::{MINIMAL, MINIMAL_BENCH, read, read_bench, text_refused};
use crate::sensing::parameters::{
    paper_accelerometer, paper_load_cell, paper_position, paper_set_value,
};
use crate::sensing::{
    AccelerometerParameters, AdcParameters, AmplifierParameters, CommandChain, FilterParameters,
    InstrumentationAmplifierParameters, LoadCellParameters, Measurement, OutletPressureParameters,
    PositionSensorParameters, PwmFilterParameters, SensingParameters, SetValueParameters,
};

/// Reads tables at the end of both formats, which must agree.
fn sensing(keys: &str) -> SensingParameters {
    let of_bench = read_bench(&format!("{MINIMAL_BENCH}{keys}\n"));
    let of_cell = read(&format!("{MINIMAL}{keys}\n")).unwrap().sensing;
    assert_eq!(of_bench.unwrap().sensing, of_cell, "{keys}");
    of_cell
}

/// Refuses tables below the nine lines of the minimal bench.
fn refused(keys: &str, location: &str, words: &str) {
    text_refused(&format!("{MINIMAL_BENCH}{keys}\n"), location, words);
}

#[test]
fn the_presets_are_those_of_the_chain() {
    let ideal = SensingParameters::ideal();
    for none in ["", "[sensing]", "[sensing]\npreset = \"ideal\""] {
        assert_eq!(sensing(none), ideal, "{none}");
    }
    let paper = sensing("[sensing]\npreset = \"paper\"");
    assert_eq!(paper, SensingParameters::paper());
    let white = SensingParameters::white(1.0, 2e-5, 600.0, 0.25, f64::INFINITY);
    assert_eq!(sensing("[sensing]\npreset = \"white\""), white);
}

#[test]
fn a_stages_own_kind_goes_before_the_presets() {
    let paper = SensingParameters::paper();
    let mut expected = paper;
    expected.force = Measurement::Ideal;
    expected.command = CommandChain::Ideal;
    expected.stroke = Measurement::White {
        standard_deviation: 2e-5,
    };
    let keys = "[sensing]\npreset = \"paper\"\nforce.kind = \"ideal\"\ncommand.kind = \"ideal\"\nstroke.kind = \"white\"";
    assert_eq!(sensing(keys), expected);
    let mut expected = SensingParameters::ideal();
    expected.command = paper.command;
    expected.regulator_pressure = paper.regulator_pressure;
    expected.acceleration = paper.acceleration;
    let keys = "[sensing]\ncommand.kind = \"real\"\nregulator_pressure.kind = \"real\"\nacceleration.kind = \"real\"";
    assert_eq!(sensing(keys), expected);
}

#[test]
fn white_noise_is_in_the_keys_unit() {
    let keys = "[sensing]\npreset = \"white\"\nsample_rate_hz = 200\n[sensing.force]\nstandard_deviation_n = 2\n\
                [sensing.stroke]\nstandard_deviation_mm = 0.1\n[sensing.regulator_pressure]\nstandard_deviation_pa = 300\n\
                [sensing.acceleration]\nstandard_deviation_m_per_s2 = 0.5";
    let expected = SensingParameters::white(2.0, 1e-4, 300.0, 0.5, 200.0);
    assert_eq!(sensing(keys), expected);
}

#[test]
fn every_key_of_the_command_reaches_its_field() {
    let keys = "[sensing.command]\nkind = \"real\"\nfull_scale_bar_gauge = 5\nfull_input_v = 10\npwm_high_v = 3.3\npwm_bits = 12\n\
                pwm_frequency_hz = 980\nresistance_ohm = 4700\ncapacitance_uf = 22\namplifier_gain = 3\n\
                feedback_resistor_error = 0.05\nground_resistor_error = -0.02";
    let expected = SetValueParameters {
        full_scale: 5e5,
        full_voltage: 10.0,
        pwm: PwmFilterParameters {
            high_voltage: 3.3,
            bits: 12,
            frequency: 980.0,
            resistance: 4700.0,
            capacitance: 22e-6,
        },
        amplifier: AmplifierParameters {
            nominal_gain: 3.0,
            feedback_resistor_error: 0.05,
            ground_resistor_error: -0.02,
        },
    };
    assert_eq!(sensing(keys).command, CommandChain::Real(expected));
}

#[test]
fn every_key_of_pressure_force_and_adc_reaches_its_field() {
    let keys = "[sensing.regulator_pressure]\nkind = \"real\"\nstandard_deviation_pa = 50\nfull_scale_bar_gauge = 10\nzero_v = 1\n\
                full_v = 5\nscale_error = 0.06\nconverter_gain = 0.7\nassumed_converter_gain = 0.75\n\
                [sensing.force]\nkind = \"real\"\nstandard_deviation_n = 0.5\ncapacity_kg = 100\nrated_output_mv_per_v = 3\n\
                excitation_v = 10\nzero_offset_n = -4\ngain_resistor_ohm = 120\nassumed_gain_resistor_ohm = 130\n\
                reference_v = 0.5\nlowest_output_v = 0.1\nhighest_output_v = 4.8\n\
                [sensing.adc]\nbits = 12\nreference_v = 4.096\nnoise_steps = 1.5";
    let adc = AdcParameters {
        bits: 12,
        reference: 4.096,
        noise: 1.5,
    };
    let pressure = OutletPressureParameters {
        full_scale: 1e6,
        zero_voltage: 1.0,
        full_voltage: 5.0,
        scale_error: 0.06,
        converter_gain: 0.7,
        assumed_converter_gain: 0.75,
        noise: 50.0,
        adc,
    };
    let force = LoadCellParameters {
        capacity: 980.665,
        rated_output: 3e-3,
        excitation: 10.0,
        zero_offset: -4.0,
        noise: 0.5,
        amplifier: InstrumentationAmplifierParameters {
            gain_resistor: 120.0,
            reference_voltage: 0.5,
            lowest_output: 0.1,
            highest_output: 4.8,
        },
        assumed_gain_resistor: 130.0,
        adc,
    };
    let read = sensing(keys);
    assert_eq!(read.regulator_pressure, Measurement::Real(pressure));
    let Measurement::Real(cell) = read.force else {
        panic!("{:?}", read.force)
    };
    assert!((cell.capacity - force.capacity).abs() < 1e-12);
    let capacity = force.capacity;
    assert_eq!(LoadCellParameters { capacity, ..cell }, force);
}

#[test]
fn every_key_of_stroke_and_acceleration_reaches_its_field() {
    let keys = "[sensing.stroke]\nkind = \"real\"\nstandard_deviation_mm = 0.5\ngain = 1.01\noffset_mm = -0.2\nresolution_mm = 0.1\n\
                [sensing.acceleration]\nkind = \"real\"\nstandard_deviation_m_per_s2 = 0.04\nbias_m_per_s2 = -0.3\n\
                range_m_per_s2 = 20\nresolution_m_per_s2 = 0";
    let read = sensing(keys);
    let stroke = PositionSensorParameters {
        gain: 1.01,
        offset: -2e-4,
        noise: 5e-4,
        resolution: 1e-4,
    };
    assert_eq!(read.stroke, Measurement::Real(stroke));
    let acceleration = AccelerometerParameters {
        bias: -0.3,
        noise: 0.04,
        range: 20.0,
        resolution: 0.0,
    };
    assert_eq!(read.acceleration, Measurement::Real(acceleration));
    assert_eq!(
        (paper_position().noise, paper_accelerometer().noise),
        (2e-5, 0.02)
    );
    assert!((paper_accelerometer().resolution - 0.1596).abs() < 5e-5);
    assert_eq!(paper_load_cell().noise, 1.0);
}

#[test]
fn every_kind_of_filter_is_read() {
    for (keys, expected) in [
        ("kind = \"none\"", FilterParameters::None),
        (
            "kind = \"first_order\"\ntime_constant_ms = 20",
            FilterParameters::FirstOrder {
                time_constant: 0.02,
            },
        ),
        (
            "kind = \"bessel\"\ncutoff_hz = 49.9",
            FilterParameters::Bessel2 { cutoff: 49.9 },
        ),
        (
            "kind = \"median\"\nlength = 5",
            FilterParameters::Median { length: 5 },
        ),
    ] {
        let read = sensing(&format!(
            "[sensing]\npreset = \"paper\"\n[sensing.filter]\n{keys}"
        ));
        assert_eq!(read.force_filter, expected);
    }
    // No filter needs no rate.
    let none = sensing("[sensing.filter]\nkind = \"none\"");
    assert_eq!(none, SensingParameters::ideal());
}

#[test]
fn a_key_without_meaning_for_its_kind_is_refused() {
    for (keys, location, words) in [
        (
            "[sensing.force]\ncapacity_kg = 20",
            "11:1",
            "`sensing.force.capacity_kg` cannot stand here: kind = \"ideal\", the preset's, has no other key",
        ),
        (
            "[sensing]\npreset = \"paper\"\n[sensing.force]\nkind = \"ideal\"\ncapacity_kg = 20",
            "14:1",
            "`sensing.force.capacity_kg` cannot stand here: kind = \"ideal\" has no other key",
        ),
        (
            "[sensing.stroke]\nkind = \"white\"\nstandard_deviation_mm = 0.1\ngain = 1",
            "13:1",
            "`sensing.stroke.gain` cannot stand here: kind = \"white\" has standard_deviation_mm",
        ),
        (
            "[sensing]\npreset = \"white\"\nacceleration = { bias_m_per_s2 = 1 }",
            "12:18",
            "`sensing.acceleration.bias_m_per_s2` cannot stand here: kind = \"white\", the preset's, has standard_deviation_m_per_s2",
        ),
        (
            "[sensing]\npreset = \"white\"\n[sensing.command]\npwm_bits = 8",
            "13:1",
            "`sensing.command.pwm_bits` cannot stand here: kind = \"ideal\", the preset's, has no other key",
        ),
        (
            "[sensing.adc]\nbits = 12",
            "11:1",
            "`sensing.adc.bits` cannot stand here: it reads regulator pressure and force, and neither has kind = \"real\"",
        ),
        (
            "[sensing]\npreset = \"paper\"\n[sensing.filter]\nkind = \"bessel\"\nlength = 3",
            "14:1",
            "`sensing.filter.length` cannot stand here: kind = \"bessel\" has cutoff_hz",
        ),
        (
            "[sensing.filter]\nkind = \"none\"\ncutoff_hz = 3",
            "12:1",
            "`sensing.filter.cutoff_hz` cannot stand here: kind = \"none\" has no other key",
        ),
    ] {
        refused(keys, location, words);
    }
}

#[test]
fn what_is_no_choice_or_no_key_is_refused() {
    for (keys, location, words) in [
        (
            "[sensing]\npreset = \"real\"",
            "11:10",
            "`sensing.preset` is \"real\", expected one of `ideal`, `paper`, `white`",
        ),
        (
            "[sensing.command]\nkind = \"white\"",
            "11:8",
            "`sensing.command.kind` is \"white\", expected one of `ideal`, `real`",
        ),
        (
            "[sensing.force]\nkind = \"paper\"",
            "11:8",
            "`sensing.force.kind` is \"paper\", expected one of `ideal`, `white`, `real`",
        ),
        (
            "[sensing.filter]\nkind = \"kalman\"",
            "11:8",
            "`sensing.filter.kind` is \"kalman\", expected one of `none`, `first_order`, `bessel`, `median`",
        ),
        (
            "[sensing.filter]\ncutoff_hz = 3",
            "10:1",
            "`sensing.filter.kind` is missing, expected it to be given, it has no default",
        ),
        (
            "[sensing]\npreset = \"paper\"\n[sensing.filter]\nkind = \"median\"",
            "12:10",
            "`sensing.filter.length` is missing, expected it to be given with kind = \"median\"",
        ),
        (
            "[sensing.force]\nexcitation_mv = 5000",
            "11:1",
            "unknown key `sensing.force.excitation_mv`; the key is `excitation_v`, in V",
        ),
        (
            "[sensing.force]\ngain_resistor_kohm = 0.1",
            "11:1",
            "unknown key `sensing.force.gain_resistor_kohm`; the key is `gain_resistor_ohm`, in ohm",
        ),
        (
            "[sensing.stroke]\nkind = \"real\"\nbits = 10",
            "12:1",
            "unknown key `sensing.stroke.bits`; `bits` belongs to [sensing.adc]",
        ),
        (
            "[sensing]\nfilter = \"bessel\"",
            "11:10",
            "`sensing.filter` is \"bessel\", expected a table",
        ),
        (
            "[sensing.adc]\nbits = 10.5",
            "11:8",
            "`sensing.adc.bits` is 10.5, expected a whole number, 0 or more",
        ),
    ] {
        refused(keys, location, words);
    }
}

#[test]
fn values_at_odds_with_each_other_are_refused() {
    let real = |stage: &str, keys: &str| format!("[sensing.{stage}]\nkind = \"real\"\n{keys}");
    for (keys, location, words) in [
        (
            real("regulator_pressure", "full_v = 1.25"),
            "12:1",
            "`sensing.regulator_pressure.full_v` is 1.25 V, expected more than zero_v, 1.25 V",
        ),
        (
            real("regulator_pressure", "zero_v = 7"),
            "12:1",
            "`sensing.regulator_pressure.zero_v` is 7 V, expected less than full_v, 6.25 V",
        ),
        (
            real("force", "lowest_output_v = 6"),
            "12:1",
            "`sensing.force.lowest_output_v` is 6 V, expected less than highest_output_v, 5 V",
        ),
        (
            real("force", "lowest_output_v = 0.1"),
            "12:1",
            "`sensing.force.lowest_output_v` is 0.1 V, expected at most reference_v, 0 V",
        ),
        (
            real("force", "reference_v = -0.1"),
            "12:1",
            "`sensing.force.reference_v` is -0.1 V, expected at least lowest_output_v, 0 V",
        ),
        (
            real("force", "reference_v = 5.1"),
            "12:1",
            "`sensing.force.reference_v` is 5.1 V, expected at most highest_output_v, 5 V",
        ),
        (
            real("force", "gain_resistor_ohm = 0"),
            "12:1",
            "`sensing.force.gain_resistor_ohm` is 0 ohm, expected 6 to 1000000 ohm",
        ),
        (
            real("command", "amplifier_gain = 1"),
            "12:1",
            "`sensing.command.amplifier_gain` is 1, expected 1.01 to 100",
        ),
        (
            real("command", "pwm_bits = 17"),
            "12:1",
            "`sensing.command.pwm_bits` is 17, expected 1 to 16",
        ),
        (
            "[sensing]\npreset = \"white\"\n[sensing.filter]\nkind = \"median\"\nlength = 3".into(),
            "10:2",
            "`sensing.sample_rate_hz` is missing, expected it to be given in Hz, for [sensing.filter] works from sample to sample",
        ),
        (
            "[sensing]\nsample_rate_hz = 40\n[sensing.filter]\nkind = \"bessel\"\ncutoff_hz = 20"
                .into(),
            "14:1",
            "`sensing.filter.cutoff_hz` is 20 Hz, expected less than 20 Hz, half the sample rate",
        ),
        (
            "[sensing]\nsample_rate_hz = 40\n[sensing.filter]\nkind = \"median\"\nlength = 4"
                .into(),
            "14:1",
            "`sensing.filter.length` is 4, expected an odd number",
        ),
        (
            "[sensing]\nsample_rate_hz = 1001".into(),
            "11:1",
            "`sensing.sample_rate_hz` is 1001 Hz, expected at most 1000 Hz, one sample a step",
        ),
        (
            "[sensing]\npreset = \"paper\"\n[simulation]\nstep_ms = 12".into(),
            "13:1",
            "`simulation.step_ms` is 12 ms, expected at most 10 ms, the sample period of [sensing]",
        ),
    ] {
        refused(&keys, location, words);
    }
    for fits in ["sample_rate_hz = 1000", "sample_rate_hz = 0.1"] {
        let period = 1.0 / sensing(&format!("[sensing]\n{fits}")).sample_rate;
        assert!((1e-3..=10.0).contains(&period));
    }
    let slow = "[sensing]\npreset = \"paper\"\n[simulation]\nstep_ms = 10";
    assert_eq!(sensing(slow).sample_rate, 100.0);
}

#[test]
fn a_set_pressure_that_the_chain_cannot_give_is_refused_with_its_voltage() {
    let bench = |pressure: f64, keys: &str| {
        format!(
            "[[command]]\nat_s = 1\nset_pressure_bar_gauge = {pressure}\n[sensing.command]\nkind = \"real\"\n{keys}"
        )
    };
    for (pressure, keys, words) in [
        (
            7.0,
            "",
            "7 bar gauge, 9.333 V at the regulator, expected 0 to 6 bar gauge, the 0 to 8 V that [sensing.command] can give",
        ),
        (
            6.001,
            "",
            "6.001 bar gauge, 8.001 V at the regulator, expected 0 to 6 bar gauge, the 0 to 8 V that [sensing.command] can give",
        ),
        // PWM and amplifier end below the regulator's full input.
        (
            5.0,
            "amplifier_gain = 1.2",
            "5 bar gauge, 6.667 V at the regulator, expected 0 to 4.5 bar gauge, the 0 to 6 V that [sensing.command] can give",
        ),
        // They go beyond it, which helps nothing.
        (
            6.5,
            "amplifier_gain = 3",
            "6.5 bar gauge, 8.667 V at the regulator, expected 0 to 6 bar gauge, the 0 to 8 V that [sensing.command] can give",
        ),
    ] {
        let key = "`command[0].set_pressure_bar_gauge` is";
        refused(&bench(pressure, keys), "12:1", &format!("{key} {words}"));
    }
    for (pressure, keys) in [
        (6.0, ""),
        (0.0, ""),
        (4.5, "amplifier_gain = 1.2"),
        (16.0, "full_scale_bar_gauge = 16"),
    ] {
        let text = format!("{MINIMAL_BENCH}{}\n", bench(pressure, keys));
        assert!(read_bench(&text).is_ok(), "{pressure} {keys}");
    }
    // The ideal way has no volts.
    let ideal = format!("{MINIMAL_BENCH}[[command]]\nat_s = 1\nset_pressure_bar_gauge = 16\n");
    assert!(read_bench(&ideal).is_ok());
    assert_eq!(largest_set_pressure(&CommandChain::Ideal), f64::INFINITY);
    let paper = CommandChain::Real(paper_set_value());
    assert_eq!(largest_set_pressure(&paper), 6e5);
}
