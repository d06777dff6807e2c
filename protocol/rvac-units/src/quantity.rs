//! Integer quantities with their unit in the type.

/// A number lies outside of the range that its unit allows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OutOfRange;

macro_rules! quantity {
    ($(#[$doc:meta])* $name:ident($inner:ty), $unit:literal, $per_si:literal, $as_si:ident, $from_si:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(pub $inner);

        impl $name {
            /// Zero of this unit.
            pub const ZERO: Self = Self(0);

            #[doc = concat!("The value in ", $unit, ".")]
            #[must_use]
            pub fn $as_si(self) -> f64 {
                f64::from(self.0) / $per_si
            }

            #[doc = concat!("From a value in ", $unit, ", rounded to the nearest count; NaN becomes 0 and what does not fit saturates.")]
            #[must_use]
            pub fn $from_si(value: f64) -> Self {
                let scaled = value * $per_si;
                // `as` saturates and maps NaN to 0, which is what a bounded integer wants.
                Self((if scaled >= 0.0 { scaled + 0.5 } else { scaled - 0.5 }) as $inner)
            }

            /// Distance from zero; the most negative count saturates instead of overflowing.
            #[must_use]
            pub const fn magnitude(self) -> $inner {
                self.0.saturating_abs()
            }

            /// Sum that saturates at the ends of the integer range.
            #[must_use]
            pub const fn saturating_add(self, other: Self) -> Self {
                Self(self.0.saturating_add(other.0))
            }

            /// Difference that saturates at the ends of the integer range.
            #[must_use]
            pub const fn saturating_sub(self, other: Self) -> Self {
                Self(self.0.saturating_sub(other.0))
            }
        }
    };
}

quantity!(/// A length in micrometres: up to 2.1 km, finer than any encoder.
    Length(i32), "metres", 1e6, as_m, from_m);
quantity!(/// A speed in micrometres per second.
    Speed(i32), "metres per second", 1e6, as_m_per_s, from_m_per_s);
quantity!(/// An angle in microradians, counter-clockwise positive. Headings are totals and may exceed a full turn (up to 341 turns).
    Angle(i32), "radians", 1e6, as_rad, from_rad);
quantity!(/// An angular speed in microradians per second, counter-clockwise positive.
    AngularSpeed(i32), "radians per second", 1e6, as_rad_per_s, from_rad_per_s);
quantity!(/// A voltage in millivolts.
    Voltage(i32), "volts", 1e3, as_v, from_v);
quantity!(/// A current in milliamperes; into the battery is positive.
    Current(i32), "amperes", 1e3, as_a, from_a);
quantity!(/// A temperature in tenths of a degree Celsius.
    Temperature(i16), "degrees Celsius", 1e1, as_celsius, from_celsius);
quantity!(/// A frequency in hertz.
    Frequency(i32), "hertz", 1.0, as_hz, from_hz);

/// Parts of a whole, 0 to 1, in millionths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Ratio(i32);

/// Drive of a motor, -1 to 1, in millionths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Throttle(i32);

impl Ratio {
    /// Nothing of the whole.
    pub const ZERO: Self = Self(0);
    /// All of the whole.
    pub const ONE: Self = Self(1_000_000);

    /// Checks the range 0..=1,000,000 millionths.
    ///
    /// # Errors
    /// [`OutOfRange`] outside of it.
    pub const fn from_millionths(millionths: i32) -> Result<Self, OutOfRange> {
        if millionths < 0 || millionths > 1_000_000 {
            Err(OutOfRange)
        } else {
            Ok(Self(millionths))
        }
    }

    /// The value in millionths, 0..=1,000,000.
    #[must_use]
    pub const fn millionths(self) -> i32 {
        self.0
    }

    /// The value as a number from 0 to 1.
    #[must_use]
    pub fn as_f64(self) -> f64 {
        f64::from(self.0) / 1e6
    }
}

impl Throttle {
    /// Motor off.
    pub const ZERO: Self = Self(0);
    /// Full drive forward.
    pub const FULL: Self = Self(1_000_000);

    /// Checks the range -1,000,000..=1,000,000 millionths.
    ///
    /// # Errors
    /// [`OutOfRange`] outside of it.
    pub const fn from_millionths(millionths: i32) -> Result<Self, OutOfRange> {
        if millionths < -1_000_000 || millionths > 1_000_000 {
            Err(OutOfRange)
        } else {
            Ok(Self(millionths))
        }
    }

    /// Saturates into the range. For controllers, whose output is limited by design; values from a peer are checked instead.
    #[must_use]
    pub const fn saturating_from_millionths(millionths: i32) -> Self {
        if millionths < -1_000_000 {
            Self(-1_000_000)
        } else if millionths > 1_000_000 {
            Self(1_000_000)
        } else {
            Self(millionths)
        }
    }

    /// The value in millionths, -1,000,000..=1,000,000.
    #[must_use]
    pub const fn millionths(self) -> i32 {
        self.0
    }

    /// The value as a number from -1 to 1.
    #[must_use]
    pub fn as_f64(self) -> f64 {
        f64::from(self.0) / 1e6
    }
}

#[cfg(test)]
mod tests {
    use super::{Length, OutOfRange, Speed, Temperature, Throttle};

    #[test]
    fn si_conversion_rounds_and_saturates() {
        assert_eq!(Length::from_m(0.1), Length(100_000));
        assert_eq!(Length::from_m(-0.000_000_6), Length(-1));
        assert_eq!(Speed::from_m_per_s(f64::NAN), Speed::ZERO);
        assert_eq!(Speed::from_m_per_s(f64::INFINITY), Speed(i32::MAX));
        assert_eq!(Temperature::from_celsius(-12.34).as_celsius(), -12.3);
    }

    #[test]
    fn throttle_refuses_what_its_range_does_not_hold() {
        assert_eq!(Throttle::from_millionths(1_000_001), Err(OutOfRange));
        assert_eq!(
            Throttle::from_millionths(-1_000_000).map(Throttle::millionths),
            Ok(-1_000_000)
        );
        assert_eq!(
            Throttle::saturating_from_millionths(i32::MIN).millionths(),
            -1_000_000
        );
    }
}
