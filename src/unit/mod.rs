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
    // Of keys of files alone.
    keys("mm3/s", "mm3_per_s", "m3/s", Divide(1e9)), keys("mm3/J", "mm3_per_j", "m3/J", Divide(1e9)), keys("J/mm3", "j_per_mm3", "J/m3", Multiply(1e9)),
    keys("mm3", "mm3", "m3", Divide(1e9)), keys("1/min", "rpm", "rad/s", Multiply(PI / 30.0)), keys("kJ", "kj", "J", Multiply(1e3)),
    keys("mV/V", "mv_per_v", "V/V", Divide(1e3)), keys("Pa s/kg", "pa_s_per_kg", "Pa s/kg", Divide(1.0)),
    keys("N m/A", "n_m_per_a", "N m/A", Divide(1.0)), keys("kg m2", "kg_m2", "kg m2", Divide(1.0)),
    keys("N m s/rad", "n_m_s_per_rad", "N m s/rad", Divide(1.0)), keys("N m/rad", "n_m_per_rad", "N m/rad", Divide(1.0)), keys("Pa/s", "pa_per_s", "Pa/s", Divide(1.0)), keys("N/Pa", "n_per_pa", "N/Pa", Divide(1.0)),
    keys("N s/m", "n_s_per_m", "N s/m", Divide(1.0)), keys("N/m", "n_per_m", "N/m", Divide(1.0)), keys("N/m^1.5", "n_per_m15", "N/m^1.5", Divide(1.0)),
    keys("N/s", "n_per_s", "N/s", Divide(1.0)), keys("mm/s3", "mm_per_s3", "m/s3", Divide(1e3)), keys("1/s", "per_s", "1/s", Divide(1.0)),
    keys("J/(kg K)", "j_per_kg_k", "J/(kg K)", Divide(1.0)), keys("bar gauge", "bar_gauge", "Pa", Multiply(1e5)),
    keys("Pa absolute", "pa_absolute", "Pa", Divide(1.0)), keys("cm3", "cm3", "m3", Divide(1e6)), keys("mm2", "mm2", "m2", Divide(1e6)),
    keys("m3", "m3", "m3", Divide(1.0)), keys("m2", "m2", "m2", Divide(1.0)), keys("W/K", "w_per_k", "W/K", Divide(1.0)),
    keys("ohm", "ohm", "ohm", Divide(1.0)), keys("uF", "uf", "F", Divide(1e6)), keys("Hz", "hz", "Hz", Divide(1.0)), keys("W", "w", "W", Divide(1.0)),
    keys("", "", "", Divide(1.0)),
    // Of columns alone.
    Unit { of_keys: false, ..keys("m3/s", "m3_per_s", "m3/s", Divide(1.0)) }, Unit { of_keys: false, ..keys("J", "j", "J", Divide(1.0)) },
];
