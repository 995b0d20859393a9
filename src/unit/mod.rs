//! Units, each declared once: as keys of files, columns of recordings and logs name them.
//!
//! Factors of the pound and the inch are exact (NIST SP 811, 2008, app. B.8), the psi from them; normal litres are those of DIN 1343 (0 degrees Celsius,
//! 1.01325 bar), 1.2930 kg of air a cubic metre.

mod key;
mod si;

use std::f64::consts::PI;

pub(crate) use key::{look_alike, stem};
pub use si::{SiUnit, column_name, parse_column_name};

/// A unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unit {
    /// Symbol for people, and its name in logs.
    pub symbol: &'static str,
    /// End of keys and columns that carry it, without the underscore before.
    pub suffix: &'static str,
    /// Symbol of the SI unit of its kind.
    pub si: &'static str,
    /// Way to SI.
    pub conversion: Conversion,
    /// Offset added to a value before, where numbers do not begin at nothing.
    pub zero: f64,
    /// Whether keys of files may carry it.
    pub of_keys: bool,
    /// Whether logs may.
    pub of_logs: bool,
}

/// Way to SI. A division by a whole number gives the double nearest to the decimal that was written,
/// so that 32 mm is the same number as a literal 0.032; a product with its inverse would not.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Conversion {
    /// By a whole number.
    Divide(f64),
    /// By a factor.
    Multiply(f64),
}

use Conversion::{Divide, Multiply};

impl Conversion {
    /// What a value is multiplied by.
    #[must_use]
    pub fn factor(self) -> f64 {
        match self {
            Divide(divisor) => 1.0 / divisor,
            Multiply(factor) => factor,
        }
    }
}

const fn both(
    symbol: &'static str,
    suffix: &'static str,
    si: &'static str,
    conversion: Conversion,
) -> Unit {
    Unit {
        of_logs: true,
        ..keys(symbol, suffix, si, conversion)
    }
}

const fn keys(
    symbol: &'static str,
    suffix: &'static str,
    si: &'static str,
    conversion: Conversion,
) -> Unit {
    Unit {
        symbol,
        suffix,
        si,
        conversion,
        zero: 0.0,
        of_keys: true,
        of_logs: false,
    }
}

const fn logs(symbol: &'static str, si: &'static str, factor: f64) -> Unit {
    Unit {
        of_keys: false,
        ..both(symbol, "", si, Multiply(factor))
    }
}

/// Day [s].
const DAY: f64 = 86_400.0;
/// Pound, force [N].
const POUND_FORCE: f64 = 4.448_221_615_260_5;
/// Inch [m].
const INCH: f64 = 0.0254;
/// Kilogram, force [N]; standard gravity [m/s2].
const STANDARD_GRAVITY: f64 = 9.806_65;
/// Mass of a normal litre of air [kg].
const NORMAL_LITRE: f64 = 1.293e-3;

/// All of them, those of a kind together, the SI unit first. Stamps count from 1970.
#[rustfmt::skip] // A table: a kind a block.
pub const UNITS: &[Unit] = &[
    both("s", "s", "s", Divide(1.0)), both("ms", "ms", "s", Divide(1e3)), logs("us", "s", 1e-6), logs("ns", "s", 1e-9), logs("min", "s", 60.0),
    logs("h", "s", 3600.0), logs("d", "s", DAY), logs("100ns", "s", 1e-7), Unit { zero: -116_444_736e9, ..logs("filetime", "s", 1e-7) },
    Unit { zero: -621_355_968e9, ..logs("dotnet_ticks", "s", 1e-7) }, Unit { zero: -25_569.0, ..logs("excel_days", "s", DAY) },
    Unit { zero: -25_569e6, ..logs("excel_microdays", "s", DAY * 1e-6) }, Unit { zero: -719_529.0, ..logs("matlab_days", "s", DAY) },
    Unit { zero: -2_082_844_800.0, ..logs("labview_s", "s", 1.0) },
    both("m", "m", "m", Divide(1.0)), both("mm", "mm", "m", Divide(1e3)), logs("cm", "m", 1e-2), both("um", "um", "m", Divide(1e6)), logs("in", "m", INCH),
    logs("ft", "m", 12.0 * INCH),
    both("m/s", "m_per_s", "m/s", Divide(1.0)), both("mm/s", "mm_per_s", "m/s", Divide(1e3)), logs("m/min", "m/s", 1.0 / 60.0),
    logs("mm/min", "m/s", 1e-3 / 60.0), logs("in/s", "m/s", INCH),
    both("m/s2", "m_per_s2", "m/s2", Divide(1.0)), both("mm/s2", "mm_per_s2", "m/s2", Divide(1e3)), logs("g", "m/s2", STANDARD_GRAVITY),
    both("N", "n", "N", Divide(1.0)), logs("kN", "N", 1e3), logs("mN", "N", 1e-3), logs("lbf", "N", POUND_FORCE), logs("kgf", "N", STANDARD_GRAVITY),
    logs("daN", "N", 10.0), logs("cN", "N", 1e-2), logs("gf", "N", STANDARD_GRAVITY * 1e-3),
    both("N m", "n_m", "N m", Divide(1.0)), both("N mm", "n_mm", "N m", Divide(1e3)), logs("lbf in", "N m", POUND_FORCE * INCH),
    both("Pa", "pa", "Pa", Divide(1.0)), logs("hPa", "Pa", 1e2), logs("kPa", "Pa", 1e3), logs("MPa", "Pa", 1e6), logs("mbar", "Pa", 1e2),
    logs("bar", "Pa", 1e5), logs("psi", "Pa", POUND_FORCE / (INCH * INCH)), logs("atm", "Pa", 101_325.0), logs("kgf/cm2", "Pa", STANDARD_GRAVITY * 1e4),
    logs("mmHg", "Pa", 133.322_387_415), logs("inHg", "Pa", 3_386.389), logs("torr", "Pa", 101_325.0 / 760.0),
    both("kg", "kg", "kg", Divide(1.0)),
    both("kg/s", "kg_per_s", "kg/s", Divide(1.0)), logs("g/s", "kg/s", 1e-3), logs("Nl/min", "kg/s", NORMAL_LITRE / 60.0),
    both("K", "k", "K", Divide(1.0)), Unit { zero: 273.15, ..logs("degC", "K", 1.0) }, Unit { zero: 459.67, ..logs("degF", "K", 5.0 / 9.0) },
    both("V", "v", "V", Divide(1.0)), logs("mV", "V", 1e-3),
    both("A", "a", "A", Divide(1.0)), logs("mA", "A", 1e-3),
    both("rad", "rad", "rad", Divide(1.0)), logs("mrad", "rad", 1e-3), both("deg", "deg", "rad", Multiply(PI / 180.0)),
    both("rad/s", "rad_per_s", "rad/s", Divide(1.0)), both("deg/s", "deg_per_s", "rad/s", Multiply(PI / 180.0)),
    logs("rpm", "rad/s", PI / 30.0),
    Unit { suffix: "1", ..logs("1", "1", 1.0) }, logs("%", "1", 1e-2),
    both("W", "w", "W", Divide(1.0)), Unit { suffix: "j", ..logs("J", "J", 1.0) }, Unit { suffix: "m3_per_s", ..logs("m3/s", "m3/s", 1.0) },
    // Of keys of files alone.
    keys("mm3/s", "mm3_per_s", "m3/s", Divide(1e9)), keys("mm3/J", "mm3_per_j", "m3/J", Divide(1e9)), keys("J/mm3", "j_per_mm3", "J/m3", Multiply(1e9)),
    keys("mm3", "mm3", "m3", Divide(1e9)), keys("1/min", "rpm", "rad/s", Multiply(PI / 30.0)), keys("kJ", "kj", "J", Multiply(1e3)),
    keys("mV/V", "mv_per_v", "V/V", Divide(1e3)), keys("Pa s/kg", "pa_s_per_kg", "Pa s/kg", Divide(1.0)),
    keys("N m/A", "n_m_per_a", "N m/A", Divide(1.0)), keys("kg m2", "kg_m2", "kg m2", Divide(1.0)),
    keys("N m s/rad", "n_m_s_per_rad", "N m s/rad", Divide(1.0)), keys("N m/rad", "n_m_per_rad", "N m/rad", Divide(1.0)), keys("Pa/s", "pa_per_s", "Pa/s", Divide(1.0)), keys("N/Pa", "n_per_pa", "N/Pa", Divide(1.0)),
    keys("N s/m", "n_s_per_m", "N s/m", Divide(1.0)), keys("N/m", "n_per_m", "N/m", Divide(1.0)), keys("N/m^1.5", "n_per_m15", "N/m^1.5", Divide(1.0)),
    keys("rad/s2", "rad_per_s2", "rad/s2", Divide(1.0)),
    keys("N/s", "n_per_s", "N/s", Divide(1.0)), keys("mm/s3", "mm_per_s3", "m/s3", Divide(1e3)), keys("1/s", "per_s", "1/s", Divide(1.0)),
    keys("J/(kg K)", "j_per_kg_k", "J/(kg K)", Divide(1.0)), keys("bar gauge", "bar_gauge", "Pa", Multiply(1e5)),
    keys("Pa absolute", "pa_absolute", "Pa", Divide(1.0)), keys("cm3", "cm3", "m3", Divide(1e6)), keys("mm2", "mm2", "m2", Divide(1e6)),
    keys("m3", "m3", "m3", Divide(1.0)), keys("m2", "m2", "m2", Divide(1.0)), keys("W/K", "w_per_k", "W/K", Divide(1.0)),
    keys("ohm", "ohm", "ohm", Divide(1.0)), keys("uF", "uf", "F", Divide(1e6)), keys("Hz", "hz", "Hz", Divide(1.0)),
    keys("", "", "", Divide(1.0)),
];

#[cfg(test)]
mod tests {
    use super::*;

    /// A value in a unit and what it is in SI, from handbooks (NIST SP 811; DIN 1343; UNIX, Windows, .NET, Excel, MATLAB and LabVIEW epochs), in whole numbers of
    /// everyday things rather than the factors above.
    #[rustfmt::skip] // A table.
    const WORTH: &[(&str, f64, f64)] = &[
        ("s", 3.0, 3.0), ("ms", 250.0, 0.25), ("us", 40.0, 4e-5), ("ns", 7.0, 7e-9), ("min", 1.5, 90.0), ("h", 2.0, 7200.0), ("d", 1.0, 86_400.0), ("100ns", 10.0, 1e-6),
        // Midnight of 2000-01-01 UTC is 946 684 800 s in each epoch.
        ("filetime", 125_911_584_000_000_000.0, 946_684_800.0), ("dotnet_ticks", 630_822_816_000_000_000.0, 946_684_800.0),
        ("excel_days", 36_526.0, 946_684_800.0), ("excel_microdays", 36_526e6, 946_684_800.0), ("matlab_days", 730_486.0, 946_684_800.0), ("labview_s", 3_029_529_600.0, 946_684_800.0),
        ("m", 2.0, 2.0), ("mm", 25.0, 0.025), ("cm", 50.0, 0.5), ("um", 900.0, 9e-4), ("in", 2.0, 0.0508), ("ft", 10.0, 3.048),
        ("m/s", 4.0, 4.0), ("mm/s", 40.0, 0.04), ("m/min", 30.0, 0.5), ("mm/min", 600.0, 0.01), ("in/s", 10.0, 0.254), ("m/s2", 1.0, 1.0), ("mm/s2", 500.0, 0.5), ("g", 2.0, 19.6133),
        ("N", 5.0, 5.0), ("kN", 0.5, 500.0), ("mN", 200.0, 0.2), ("lbf", 10.0, 44.482_216_152_605), ("kgf", 50.0, 490.3325), ("daN", 49.0, 490.0), ("cN", 100.0, 1.0), ("gf", 1000.0, 9.80665),
        ("N m", 3.0, 3.0), ("N mm", 1500.0, 1.5), ("lbf in", 100.0, 11.298_482_902_761_67),
        ("Pa", 7.0, 7.0), ("hPa", 1013.25, 101_325.0), ("kPa", 600.0, 6e5), ("MPa", 0.6, 6e5), ("mbar", 500.0, 5e4), ("bar", 6.0, 6e5), ("psi", 100.0, 689_475.729_316_8),
        ("atm", 1.0, 101_325.0), ("kgf/cm2", 1.0, 98_066.5), ("mmHg", 760.0, 101_325.0), ("inHg", 29.92, 101_320.6), ("torr", 760.0, 101_325.0), ("kg", 2.0, 2.0),
        // 60 normal litres a minute are one a second, 22.414 of which are a mole of air of 28.96 g.
        ("kg/s", 1.0, 1.0), ("g/s", 3.0, 3e-3), ("Nl/min", 60.0, 28.96e-3 / 22.414),
        ("K", 300.0, 300.0), ("degC", 20.0, 293.15), ("degF", 68.0, 293.15), ("V", 5.0, 5.0), ("mV", 300.0, 0.3), ("A", 2.0, 2.0), ("mA", 20.0, 0.02),
        ("rad", 1.0, 1.0), ("mrad", 5.0, 5e-3), ("deg", 180.0, PI), ("rad/s", 1.0, 1.0), ("deg/s", 360.0, 2.0 * PI), ("rpm", 3000.0, 100.0 * PI), ("1", 0.5, 0.5), ("%", 12.0, 0.12), ("W", 750.0, 750.0), ("m3/s", 2.0, 2.0), ("J", 40.0, 40.0),
    ];

    #[test]
    fn each_unit_of_a_log_is_worth_what_handbooks_say() {
        let of_logs = UNITS.iter().filter(|unit| unit.of_logs);
        for unit in of_logs {
            let row = WORTH.iter().find(|(symbol, ..)| *symbol == unit.symbol);
            let Some((symbol, value, si)) = row else {
                panic!("`{}` has no row here", unit.symbol);
            };
            let found = (value + unit.zero) * unit.conversion.factor();
            // 760 mm of mercury are an atmosphere to 1.5e-7, molar masses have four digits.
            let within = match *symbol {
                "Nl/min" => 1e-3,
                "inHg" => 1e-5,
                _ => 2e-7,
            };
            assert!((found / si - 1.0).abs() < within, "{symbol}: {found}, {si}");
        }
    }

    #[test]
    fn a_key_and_a_log_of_one_unit_are_worth_the_same() {
        for unit in UNITS.iter().filter(|unit| unit.of_keys) {
            let twins = UNITS.iter().filter(|other| other.symbol == unit.symbol);
            for twin in twins {
                assert!((twin.conversion.factor() / unit.conversion.factor() - 1.0).abs() < 1e-15);
            }
        }
    }
}
