//! Faults that a person must see to.

use super::inhibit::Inhibit;
use super::named_enum::named_enum;

named_enum! {
    /// Fault that a person must see to. Each has the name of the [`crate::Inhibit`] that reports it.
    Fault {
        /// Three resets within a minute.
        ResetLoop => "reset-loop",
        /// The firmware gave up on a bumper.
        BumperStuck => "bumper-stuck",
        /// The firmware gave up on a cliff.
        CliffTrapped => "cliff-trapped",
        /// A cliff sensor fails its self-test.
        CliffSensor => "cliff-sensor",
        /// A wheel motor is blocked.
        WheelStall => "wheel-stall",
        /// The main brush is blocked.
        BrushStall => "brush-stall",
        /// A wheel turned without command.
        Runaway => "runaway",
        /// An encoder disagrees with its command.
        Encoder => "encoder",
        /// The firmware failed a self-check.
        Internal => "internal",
        /// The pack is empty: everything is off (S16).
        BatteryEmpty => "battery-empty",
        /// The pack is hot (S17).
        BatteryHot => "battery-hot",
        /// The pack was dangerously hot (S17).
        BatteryOverheated => "battery-overheated",
        /// The pack's temperature cannot be measured (S17).
        Thermistor => "thermistor",
        /// Current flows though the charger is off (S18).
        ChargerShorted => "charger-shorted",
        /// The clock of the microcontroller failed (S20).
        Clock => "clock",
        /// The memory of the microcontroller failed (S21).
        Memory => "memory",
        /// Newer firmware inhibits for a reason this brain does not know.
        UnknownInhibit => "unknown-inhibit",
    }
}

impl Fault {
    /// The fault of the same name.
    pub(crate) fn of_inhibit(inhibit: Inhibit) -> Self {
        Self::from_name(inhibit.name()).unwrap_or(Self::UnknownInhibit)
    }
}
