//! Reasons that keep a robot from moving or working, independent of its make.

/// A reason that keeps a robot from moving or working. The names appear in logs, recordings and clients.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Inhibit {
    /// No `arm` since the reset, or disarmed.
    NotArmed,
    /// Three resets within 60 s.
    ResetLoop,
    /// The lease ended or the link is silent.
    LinkLost,
    /// A bumper is pressed: only motion away from it is allowed.
    Bumper,
    /// A bumper stays pressed.
    BumperStuck,
    /// A cliff sensor detects no floor: only slow reverse is allowed.
    Cliff,
    /// Repeated cliffs, or reversing did not help.
    CliffTrapped,
    /// A cliff sensor fails its self-test.
    CliffSensorFault,
    /// A wheel has dropped: the robot was lifted or fell.
    WheelDrop,
    /// A wheel motor drew too much current or did not turn.
    WheelStall,
    /// The main brush is blocked.
    BrushStall,
    /// A wheel turned without or far above its command.
    Runaway,
    /// An encoder disagrees with its command in direction or is silent.
    EncoderFault,
    /// Wheels turn but the robot does not move.
    NotMoving,
    /// On the dock: motion needs an undock command.
    Docked,
    /// A person pressed a button while the robot moved.
    ButtonStop,
    /// `stop` was commanded.
    Stopped,
    /// A self-check of the firmware failed.
    InternalFault,
    /// The pack is below 1.1 V a cell: go to the dock. Forbids nothing yet.
    BatteryLow,
    /// The pack is below 1.0 V a cell: brushes and suction are off.
    BatteryWeak,
    /// The pack is below 0.9 V a cell: everything is off.
    BatteryEmpty,
    /// The pack is hotter than 55 degrees Celsius: motors are off until it has cooled.
    BatteryHot,
    /// The pack was hotter than 60 degrees Celsius.
    BatteryOverheated,
    /// The pack's temperature cannot be measured.
    Thermistor,
    /// The charger reports a fault: no charging. Forbids no motion.
    ChargerFault,
    /// Current flows into the pack though the charger is off: stay off the dock. Forbids no motion.
    ChargerShorted,
    /// The clock failed, or two clocks disagree.
    Clock,
    /// Memory failed its check.
    Memory,
}

impl Inhibit {
    /// All of them, in display order.
    pub const ALL: [Self; 28] = [
        Self::NotArmed,
        Self::ResetLoop,
        Self::LinkLost,
        Self::Bumper,
        Self::BumperStuck,
        Self::Cliff,
        Self::CliffTrapped,
        Self::CliffSensorFault,
        Self::WheelDrop,
        Self::WheelStall,
        Self::BrushStall,
        Self::Runaway,
        Self::EncoderFault,
        Self::NotMoving,
        Self::Docked,
        Self::ButtonStop,
        Self::Stopped,
        Self::InternalFault,
        Self::BatteryLow,
        Self::BatteryWeak,
        Self::BatteryEmpty,
        Self::BatteryHot,
        Self::BatteryOverheated,
        Self::Thermistor,
        Self::ChargerFault,
        Self::ChargerShorted,
        Self::Clock,
        Self::Memory,
    ];

    /// The name in logs, in recordings and in every client.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::NotArmed => "not-armed",
            Self::ResetLoop => "reset-loop",
            Self::LinkLost => "link-lost",
            Self::Bumper => "bumper",
            Self::BumperStuck => "bumper-stuck",
            Self::Cliff => "cliff",
            Self::CliffTrapped => "cliff-trapped",
            Self::CliffSensorFault => "cliff-sensor",
            Self::WheelDrop => "wheel-drop",
            Self::WheelStall => "wheel-stall",
            Self::BrushStall => "brush-stall",
            Self::Runaway => "runaway",
            Self::EncoderFault => "encoder",
            Self::NotMoving => "not-moving",
            Self::Docked => "docked",
            Self::ButtonStop => "button-stop",
            Self::Stopped => "stopped",
            Self::InternalFault => "internal",
            Self::BatteryLow => "battery-low",
            Self::BatteryWeak => "battery-weak",
            Self::BatteryEmpty => "battery-empty",
            Self::BatteryHot => "battery-hot",
            Self::BatteryOverheated => "battery-overheated",
            Self::Thermistor => "thermistor",
            Self::ChargerFault => "charger-fault",
            Self::ChargerShorted => "charger-shorted",
            Self::Clock => "clock",
            Self::Memory => "memory",
        }
    }

    /// The inhibit with exactly this name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|inhibit| inhibit.name() == name)
    }

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

    const fn bit(self) -> u32 {
        1 << self as u32
    }
}

/// Name of an inhibit that is not known here and came without a name.
const UNKNOWN: &str = "unknown-inhibit";

/// A set of inhibits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Inhibits {
    known: u32,
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

    /// The known members, in the order of [`Inhibit::ALL`].
    pub fn iter(self) -> impl Iterator<Item = Inhibit> {
        Inhibit::ALL
            .into_iter()
            .filter(move |inhibit| self.contains(*inhibit))
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
        for inhibit in Inhibit::ALL {
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
