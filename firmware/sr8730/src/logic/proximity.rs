//! The seven infrared proximity sensors behind their multiplexers.
//!
//! Each scan of the ADC, once a millisecond, belongs to one sensor: first with its emitter dark, then lit. The
//! difference is the reflected light. Select lines change only after a lit scan has ended and the emitter is off again:
//! three lines cannot change at once, and the multiplexers pass through other channels.

/// Sensors, in the order of the channels: right, middle right, front right, front, front left, middle left, left.
pub const SENSORS: usize = 7;
/// Channel of the emitter that looks straight ahead, which also talks to the dock.
pub const FRONT_CHANNEL: u8 = 3;

/// Target of one scan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ScanTarget {
    /// Channel of both multiplexers, 0..=6.
    pub channel: u8,
    /// Whether the emitter is lit.
    pub lit: bool,
}

/// The order of the scans: one number, so that an interrupt and the main loop can share it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sweep(u8);

impl Sweep {
    /// Number of scans for all sensors.
    pub const LOOKS: u8 = 2 * SENSORS as u8;

    /// At the first sensor, dark.
    #[must_use]
    pub const fn new() -> Self {
        Self(0)
    }

    /// The present target.
    #[must_use]
    pub const fn look(self) -> ScanTarget {
        ScanTarget {
            channel: self.0 / 2,
            lit: self.0 & 1 == 1,
        }
    }

    /// The next target.
    #[must_use]
    pub const fn next(self) -> Self {
        if self.0 + 1 < Self::LOOKS {
            Self(self.0 + 1)
        } else {
            Self(0)
        }
    }
}

/// Calibrated readings for no object and for contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ProximityScale {
    none: i32,
    span: i32,
}

impl ProximityScale {
    /// `None` if the two do not differ.
    #[must_use]
    pub const fn new(none: i32, touching: i32) -> Option<Self> {
        let span = touching.saturating_sub(none);
        if span > 0 { Some(Self { none, span }) } else { None }
    }

    /// 0 = nothing, 255 = touching, for one pair of readings.
    #[must_use]
    pub const fn closeness(self, dark: u16, lit: u16) -> u8 {
        let above = (lit as i32).saturating_sub(dark as i32).saturating_sub(self.none);
        if above <= 0 {
            return 0;
        }
        // The span is positive by construction; readings have ten bits.
        match above.saturating_mul(255).checked_div(self.span) {
            Some(closeness) if closeness < 255 => closeness as u8,
            _ => 255,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{ProximityScale, SENSORS, ScanTarget, Sweep};

    #[test]
    fn each_sensor_is_seen_dark_then_lit_and_the_channel_changes_only_into_the_dark() {
        let mut sweep = Sweep::new();
        let mut looks = std::vec::Vec::new();
        for _ in 0..2 * SENSORS {
            looks.push(sweep.look());
            let next = sweep.next();
            if next.look().channel != sweep.look().channel {
                assert!(sweep.look().lit && !next.look().lit);
            }
            sweep = next;
        }
        assert_eq!(sweep, Sweep::new());
        for channel in 0..7 {
            assert!(looks.contains(&ScanTarget { channel, lit: false }));
            assert!(looks.contains(&ScanTarget { channel, lit: true }));
        }
    }

    #[test]
    fn closeness_runs_from_none_to_touching() {
        let scale = ProximityScale::new(6, 700).unwrap();
        for (dark, lit, closeness) in [
            (100, 100, 0),
            (100, 106, 0),
            (100, 453, 127),
            (100, 800, 255),
            (100, 1_023, 255),
            (900, 100, 0),
        ] {
            assert_eq!(scale.closeness(dark, lit), closeness, "{dark} {lit}");
        }
    }

    #[test]
    fn a_scale_without_a_span_is_none() {
        assert_eq!(ProximityScale::new(700, 700), None);
        assert_eq!(ProximityScale::new(700, 6), None);
    }
}
