//! Everything that keeps the robot from moving, by name.

/// A named reason why the firmware refuses or has stopped motion. Rule numbers (S1 ...) are those of SAFETY.md.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Inhibit {
    /// Nobody has armed since the reset (S4), or since what ended the last arming.
    NotArmed = 0,
    /// Three resets within 60 s (S4). Latched.
    ResetLoop = 1,
    /// The lease ended or the link is silent (S1).
    LinkLost = 2,
    /// A bumper is pressed: only motion away from it is allowed (S6).
    Bumper = 3,
    /// A bumper stays pressed (S7). Latched.
    BumperStuck = 4,
    /// A cliff sensor sees no floor: only slow reverse is allowed (S8).
    Cliff = 5,
    /// Three cliffs within 5 s, or reversing did not help (S8). Latched.
    CliffTrapped = 6,
    /// A cliff sensor fails its self-test (S9).
    CliffSensorFault = 7,
    /// A wheel hangs: the robot is lifted or fell (S10).
    WheelDrop = 8,
    /// A wheel motor drew too much current or did not turn (S11). Latched.
    WheelStall = 9,
    /// The main brush is blocked (S11). Latched.
    BrushStall = 10,
    /// A wheel turned without or far above its command (S12). Latched.
    Runaway = 11,
    /// An encoder disagrees with its command in direction or is silent (S13). Latched.
    EncoderFault = 12,
    /// Wheels turn but the robot makes no progress (S15).
    NotMoving = 13,
    /// On the dock: motion needs an undock command (S19).
    Docked = 14,
    /// A person pressed a button while the robot moved (S28).
    ButtonStop = 15,
    /// `stop` was commanded.
    Stopped = 16,
    /// A self-check of the firmware failed (S21, S22). Latched.
    InternalFault = 17,
    /// The pack is below 1.1 V a cell (S16): return to the dock. Forbids nothing yet.
    BatteryLow = 18,
    /// The pack is below 1.0 V a cell (S16): brushes and suction are off.
    BatteryWeak = 19,
    /// The pack is below 0.9 V a cell (S16): everything is off.
    BatteryEmpty = 20,
    /// The pack is hotter than 55 degrees (S17): motors are off until it has cooled.
    BatteryHot = 21,
    /// The pack was hotter than 60 degrees (S17). Latched.
    BatteryOverheated = 22,
    /// The pack's temperature cannot be measured (S17). Latched.
    Thermistor = 23,
    /// The charger has found a fault (S18), which `info` names: no charging. Forbids no motion. Latched.
    ChargerFault = 24,
    /// Current flows into the pack though the charger is off (S18): keep off the dock. Forbids no motion. Latched.
    ChargerShorted = 25,
    /// The clock failed, or two clocks disagree (S20). Latched.
    Clock = 26,
    /// Memory failed its check (S21). Latched.
    Memory = 27,
}

impl Inhibit {
    /// All of them, in the order of their bits.
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

    /// The name on the wire, in logs and in every client.
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
    pub fn from_name(name: &[u8]) -> Option<Self> {
        Self::ALL
            .into_iter()
            .find(|inhibit| inhibit.name().as_bytes() == name)
    }

    /// Whether it stays until a `clear` names it and its cause is gone.
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
}

/// A set of inhibits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Inhibits(u32);

impl Inhibits {
    /// No inhibit.
    pub const NONE: Self = Self(0);

    /// From the bits on the wire. Bits of newer firmware are kept, so that "something unknown inhibits" is not lost.
    #[must_use]
    pub const fn from_bits(bits: u32) -> Self {
        Self(bits)
    }

    /// The bits on the wire: bit n is the inhibit with discriminant n.
    #[must_use]
    pub const fn bits(self) -> u32 {
        self.0
    }

    /// The members of this set that are not in `other`.
    #[must_use]
    pub const fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// Whether nothing inhibits.
    #[must_use]
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Whether `inhibit` is in the set.
    #[must_use]
    pub const fn contains(self, inhibit: Inhibit) -> bool {
        self.0 & (1 << inhibit as u32) != 0
    }

    /// Whether the two sets share a member.
    #[must_use]
    pub const fn intersects(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    /// Adds `inhibit`.
    pub const fn insert(&mut self, inhibit: Inhibit) {
        self.0 |= 1 << inhibit as u32;
    }

    /// Removes `inhibit`.
    pub const fn remove(&mut self, inhibit: Inhibit) {
        self.0 &= !(1 << inhibit as u32);
    }

    /// The known members, in the order of their bits.
    pub fn iter(self) -> impl Iterator<Item = Inhibit> {
        Inhibit::ALL
            .into_iter()
            .filter(move |inhibit| self.contains(*inhibit))
    }
}
