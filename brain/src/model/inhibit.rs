//! Reasons that keep a robot from moving or working, independent of its make.

use crate::model::named_enum::named_enum;

named_enum! {
    /// A reason that keeps a robot from moving or working. The names appear in logs, recordings and clients.
    Inhibit {
        /// No `arm` since the reset, or disarmed.
        NotArmed => "not-armed",
        /// Three resets within 60 s.
        ResetLoop => "reset-loop",
        /// The lease ended or the link is silent.
        LinkLost => "link-lost",
        /// A bumper is pressed: only motion away from it is allowed.
        Bumper => "bumper",
        /// A bumper stays pressed.
        BumperStuck => "bumper-stuck",
        /// A cliff sensor detects no floor: only slow reverse is allowed.
        Cliff => "cliff",
        /// Repeated cliffs, or reversing did not help.
        CliffTrapped => "cliff-trapped",
        /// A cliff sensor fails its self-test.
        CliffSensorFault => "cliff-sensor",
        /// A wheel has dropped: the robot was lifted or fell.
        WheelDrop => "wheel-drop",
        /// A wheel motor drew too much current or did not turn.
        WheelStall => "wheel-stall",
        /// The main brush is blocked.
        BrushStall => "brush-stall",
        /// A wheel turned without or far above its command.
        Runaway => "runaway",
        /// An encoder disagrees with its command in direction or is silent.
        EncoderFault => "encoder",
        /// Wheels turn but the robot does not move.
        NotMoving => "not-moving",
        /// On the dock: motion needs an undock command.
        Docked => "docked",
        /// A person pressed a button while the robot moved.
        ButtonStop => "button-stop",
        /// `stop` was commanded.
        Stopped => "stopped",
        /// A self-check of the firmware failed.
        InternalFault => "internal",
        /// The pack is below 1.1 V a cell: go to the dock. Forbids nothing yet.
        BatteryLow => "battery-low",
        /// The pack is below 1.0 V a cell: brushes and suction are off.
        BatteryWeak => "battery-weak",
        /// The pack is below 0.9 V a cell: everything is off.
        BatteryEmpty => "battery-empty",
        /// The pack is hotter than 55 degrees Celsius: motors are off until it has cooled.
        BatteryHot => "battery-hot",
        /// The pack was hotter than 60 degrees Celsius.
        BatteryOverheated => "battery-overheated",
        /// The pack's temperature cannot be measured.
        Thermistor => "thermistor",
        /// The charger reports a fault: no charging. Forbids no motion.
        ChargerFault => "charger-fault",
        /// Current flows into the pack though the charger is off: stay off the dock. Forbids no motion.
        ChargerShorted => "charger-shorted",
        /// The clock failed, or two clocks disagree.
        Clock => "clock",
        /// Memory failed its check.
        Memory => "memory",
        /// What comes over the line is not the robot's. This and all that follow are of the host, not of the firmware.
        LinkGarbled => "link-garbled",
        /// Reports arrive damaged.
        LinkCorrupted => "link-corrupted",
        /// Reports come too seldom.
        LinkLate => "link-late",
        /// Reports come, and the robot's clock in them stands.
        ClockFrozen => "clock-frozen",
        /// The robot's clock jumps.
        ClockJumped => "clock-jumped",
        /// Most commands reach the robot damaged.
        CommandsLost => "commands-lost",
        /// The robot refuses commands because they are too old when they reach it.
        CommandsStale => "commands-stale",
        /// Values that this robot needs to move, or to see where there is no floor, were never measured.
        NotCalibrated => "not-calibrated",
    }
}

impl Inhibit {
    /// Whether it stays until it is cleared by name after its cause is gone.
    #[must_use]
    pub const fn is_latched(self) -> bool {
        matches!(
            self,
            Self::ResetLoop
                | Self::BumperStuck
                | Self::CliffTrapped
                | Self::WheelStall
                | Self::BrushStall
                | Self::Runaway
                | Self::EncoderFault
                | Self::InternalFault
                | Self::BatteryOverheated
                | Self::Thermistor
                | Self::ChargerFault
                | Self::ChargerShorted
                | Self::Clock
                | Self::Memory
        )
    }

    const fn bit(self) -> u64 {
        1 << self as u64
    }
}

/// Name of an inhibit that is not known here and came without a name.
const UNKNOWN: &str = "unknown-inhibit";

/// A set of inhibits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Inhibits {
    known: u64,
    other: Option<&'static str>,
}

impl Inhibits {
    /// No inhibit.
    pub const NONE: Self = Self {
        known: 0,
        other: None,
    };

    /// Whether nothing inhibits.
    #[must_use]
    pub const fn is_empty(self) -> bool {
        self.known == 0 && self.other.is_none()
    }

    /// Whether `inhibit` is in the set.
    #[must_use]
    pub const fn contains(self, inhibit: Inhibit) -> bool {
        self.known & inhibit.bit() != 0
    }

    /// Adds `inhibit`.
    pub const fn insert(&mut self, inhibit: Inhibit) {
        self.known |= inhibit.bit();
    }

    /// Takes `inhibit` out.
    pub const fn remove(&mut self, inhibit: Inhibit) {
        self.known &= !inhibit.bit();
    }

    /// Adds an inhibit that [`Inhibit`] lacks, by the name that the make gives it. Only the newest is kept: the robot needs a
    /// person for any of them.
    pub const fn insert_other(&mut self, name: &'static str) {
        self.other = Some(name);
    }

    /// Adds an inhibit without a known name.
    pub const fn insert_unknown(&mut self) {
        self.insert_other(UNKNOWN);
    }

    /// The set of these names, as from [`Self::names`]. An unknown name becomes an unknown inhibit.
    #[must_use]
    pub fn from_names<'a>(names: impl IntoIterator<Item = &'a str>) -> Self {
        let mut all = Self::NONE;
        for name in names {
            match Inhibit::from_name(name) {
                Some(inhibit) => all.insert(inhibit),
                None => all.insert_unknown(),
            }
        }
        all
    }

    /// An inhibit that [`Inhibit`] lacks.
    #[must_use]
    pub const fn other(self) -> Option<&'static str> {
        self.other
    }

    /// The known members, in the order of [`Inhibit::all`].
    pub fn iter(self) -> impl Iterator<Item = Inhibit> {
        Inhibit::all().filter(move |inhibit| self.contains(*inhibit))
    }

    /// The names of all members; one that [`Inhibit`] lacks comes last.
    pub fn names(self) -> impl Iterator<Item = &'static str> {
        self.iter().map(Inhibit::name).chain(self.other)
    }
}

impl FromIterator<Inhibit> for Inhibits {
    fn from_iter<T: IntoIterator<Item = Inhibit>>(inhibits: T) -> Self {
        let mut all = Self::NONE;
        for inhibit in inhibits {
            all.insert(inhibit);
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::{Inhibit, Inhibits};

    #[test]
    fn names_are_unique_and_found_again() {
        for inhibit in Inhibit::all() {
            assert_eq!(Inhibit::from_name(inhibit.name()), Some(inhibit));
        }
    }

    #[test]
    fn unknown_inhibits_are_kept() {
        let mut inhibits: Inhibits = [Inhibit::WheelDrop, Inhibit::NotArmed].into_iter().collect();
        inhibits.insert_other("flux-capacitor");
        assert!(inhibits.names().eq(["not-armed", "wheel-drop", "flux-capacitor"]));
        for known in [Inhibit::WheelDrop, Inhibit::NotArmed] {
            inhibits.remove(known);
        }
        assert!(!inhibits.is_empty());
        let read = Inhibits::from_names(["flux-capacitor", "docked"]);
        assert!(read.names().eq(["docked", "unknown-inhibit"]));
    }
}
