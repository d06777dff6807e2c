//! Units of the figures in rules.toml: how each is written for people, in Rust and in C.

use crate::codegen::rust_name;
use serde::Deserialize;

/// A unit. Figures are whole numbers of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub(super) enum Unit {
    #[serde(rename = "1")]
    One,
    #[serde(rename = "ms")]
    Ms,
    #[serde(rename = "min")]
    Minutes,
    #[serde(rename = "nm")]
    Nm,
    #[serde(rename = "um")]
    Um,
    #[serde(rename = "um/s")]
    UmPerS,
    #[serde(rename = "mm/s")]
    MmPerS,
    #[serde(rename = "urad")]
    Urad,
    #[serde(rename = "urad/s")]
    UradPerS,
    #[serde(rename = "c°C")]
    CentiCelsius,
    #[serde(rename = "mV")]
    Mv,
    #[serde(rename = "mA")]
    Ma,
    #[serde(rename = "millionths")]
    Millionths,
}

/// Milliseconds from which a time is written in seconds, minutes and hours.
const SECONDS_FROM_MS: i64 = 1_000;
const MINUTES_FROM_MS: i64 = 120_000;
const HOURS_FROM_MS: i64 = 7_200_000;

impl Unit {
    /// The end of a constant's name, and its usual type.
    pub(super) const fn in_code(self) -> (&'static str, &'static str) {
        match self {
            Self::One => ("", "u8"),
            Self::Ms => ("_MS", "u32"),
            Self::Minutes => ("_MIN", "u32"),
            Self::Nm => ("_NM", "i64"),
            Self::Um => ("_UM", "u32"),
            Self::UmPerS => ("_UM_PER_S", "i32"),
            Self::MmPerS => ("_MM_PER_S", "i32"),
            Self::Urad => ("_URAD", "i64"),
            Self::UradPerS => ("_URAD_PER_S", "i32"),
            Self::CentiCelsius => ("_CC", "i32"),
            Self::Mv => ("_MV", "i32"),
            Self::Ma => ("_MA", "i32"),
            Self::Millionths => ("_MILLIONTHS", "i32"),
        }
    }

    /// Billionths of the unit's base: only units of one quantity convert.
    const fn billionths(self) -> (char, i64) {
        match self {
            Self::Nm => ('m', 1),
            Self::Um => ('m', 1_000),
            Self::UmPerS => ('v', 1_000),
            Self::MmPerS => ('v', 1_000_000),
            Self::One
            | Self::Ms
            | Self::Minutes
            | Self::Urad
            | Self::UradPerS
            | Self::CentiCelsius
            | Self::Mv
            | Self::Ma
            | Self::Millionths => ('-', 0),
        }
    }

    /// `value` in another unit, if that is exact.
    pub(super) fn convert(self, value: i64, to: Self) -> Option<i64> {
        if self == to {
            return Some(value);
        }
        let ((quantity, from), (wanted, into)) = (self.billionths(), to.billionths());
        let base = value.checked_mul(from)?;
        (quantity == wanted && into > 0 && base % into == 0).then(|| base / into)
    }

    /// As people read it.
    pub(super) fn shown(self, value: i64) -> String {
        match self {
            Self::One => grouped(value),
            Self::Ms => time(value),
            Self::Minutes => format!("{value} min"),
            Self::Nm => format!("{} m", decimal(value, 9)),
            Self::Um => format!("{} m", decimal(value, 6)),
            Self::UmPerS => format!("{} m/s", decimal(value, 6)),
            Self::MmPerS => format!("{} m/s", decimal(value, 3)),
            Self::Urad => format!("{} rad", decimal(value, 6)),
            Self::UradPerS => format!("{} rad/s", decimal(value, 6)),
            Self::CentiCelsius => format!("{} °C", decimal(value, 2)),
            Self::Mv => format!("{} V", decimal(value, 3)),
            Self::Ma => format!("{} mA", grouped(value)),
            Self::Millionths => format!("{} %", decimal(value, 4)),
        }
    }
}

fn time(ms: i64) -> String {
    let (divisor, places, unit) = match ms {
        HOURS_FROM_MS.. if ms % 360_000 == 0 => (360_000, 1, "h"),
        MINUTES_FROM_MS.. if ms % 60_000 == 0 => (60_000, 0, "min"),
        SECONDS_FROM_MS.. if ms % 100 == 0 => (100, 1, "s"),
        _ => (1, 0, "ms"),
    };
    let count = ms / divisor;
    match places {
        0 => format!("{} {unit}", grouped(count)),
        _ => format!("{} {unit}", decimal(count, 1)),
    }
}

/// `value` divided by a power of ten, without zeros at the end.
fn decimal(value: i64, places: usize) -> String {
    let digits = format!("{:0width$}", value.unsigned_abs(), width = places + 1);
    let (whole, fraction) = digits.split_at(digits.len() - places);
    let sign = if value < 0 { "-" } else { "" };
    match fraction.trim_end_matches('0') {
        "" => format!("{sign}{whole}"),
        fraction => format!("{sign}{whole}.{fraction}"),
    }
}

/// With a comma between thousands.
pub(super) fn grouped(value: i64) -> String {
    rust_name::number(value).replace('_', ",")
}

#[cfg(test)]
mod tests {
    use super::{Unit, grouped};

    #[test]
    fn figures_are_written_as_people_read_them() {
        for (unit, value, shown) in [
            (Unit::Ms, 256, "256 ms"),
            (Unit::Ms, 1_050, "1,050 ms"),
            (Unit::Ms, 60_000, "60 s"),
            (Unit::Ms, 1_800_000, "30 min"),
            (Unit::Ms, 12_600_000, "3.5 h"),
            (Unit::Nm, 150_000_000, "0.15 m"),
            (Unit::UmPerS, -100_000, "-0.1 m/s"),
            (Unit::CentiCelsius, 5_500, "55 °C"),
            (Unit::Mv, 1_100, "1.1 V"),
            (Unit::Millionths, 300_000, "30 %"),
        ] {
            assert_eq!(unit.shown(value), shown);
        }
        assert_eq!(grouped(1_234_567), "1,234,567");
    }

    #[test]
    fn only_units_of_one_quantity_convert() {
        assert_eq!(Unit::Nm.convert(150_000_000, Unit::Um), Some(150_000));
        assert_eq!(Unit::UmPerS.convert(125_000, Unit::MmPerS), Some(125));
        assert_eq!(Unit::Nm.convert(1, Unit::Um), None);
        assert_eq!(Unit::Ms.convert(1, Unit::Um), None);
    }
}
