//! The supply of the robot's charging switch: an adapter in the dock.

/// A supply behind the robot's switch. The switch conducts for short pulses in a share of its envelope; what flows on
/// average is that share of what would flow if all pulses were given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Supply {
    /// Without load, volts.
    pub open_v: f64,
    /// Between it and the pack when all pulses are given, ohm: switch, shunt and the share of the pulses.
    pub series_ohm: f64,
    /// No more than this, ampere.
    pub limit_a: f64,
    /// While the dock has not detected the robot, ampere.
    pub unasked_a: f64,
}

impl Supply {
    /// A dock of the usual kind.
    pub const USUAL: Self = Self {
        open_v: 24.0,
        series_ohm: 5.5,
        limit_a: 1.5,
        unasked_a: 0.02,
    };

    /// Mean current into a pack of this voltage, ampere; `duty` is the share of the envelope, 0..1.
    #[must_use]
    pub fn current_a(&self, duty: f64, pack_v: f64, asked: bool) -> f64 {
        if duty <= 0.0 {
            return 0.0;
        }
        let limit_a = if asked { self.limit_a } else { self.unasked_a };
        let driven_a = duty * (self.open_v - pack_v) / self.series_ohm;
        driven_a.clamp(0.0, limit_a)
    }
}
