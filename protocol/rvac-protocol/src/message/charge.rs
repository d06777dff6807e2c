//! Phase, end and fault of the charger, by name.

macro_rules! names {
    ($(#[$doc:meta])* $type:ident: $count:literal { $($(#[$each:meta])* $variant:ident => $name:literal,)* }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum $type {
            $($(#[$each])* $variant,)*
        }

        impl $type {
            /// All of them.
            pub const ALL: [Self; $count] = [$(Self::$variant,)*];

            /// The name on the wire.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name,)*
                }
            }

            /// The one with exactly this name.
            #[must_use]
            pub fn from_name(name: &[u8]) -> Option<Self> {
                Self::ALL.into_iter().find(|one| one.name().as_bytes() == name)
            }
        }
    };
}

pub(super) use names;

names! {
    /// Phase of the charger's state machine (table of the charger in SAFETY.md).
    ChargePhase: 6 {
        /// No current is wanted, or not allowed to flow.
        Idle => "idle",
        /// A deeply discharged pack gets a tenth of its capacity an hour.
        Precharge => "precharge",
        /// Full current.
        Fast => "fast",
        /// The last percent after a good end, at a tenth of the capacity an hour.
        TopOff => "top-off",
        /// Full: short pulses make up for the load of the electronics.
        Maintain => "maintain",
        /// A fault: no current until a person clears it.
        Fault => "fault",
    }
}

names! {
    /// What ended the last charge.
    ChargeEnd: 10 {
        /// dT/dt: the temperature rose fast.
        TemperatureSlope => "slope",
        /// -dV: the voltage fell from its peak.
        NegativeDeltaV => "drop",
        /// 0dV: the voltage stopped rising.
        ZeroDeltaV => "plateau",
        /// dT: the pack is much warmer than at the start.
        TemperatureRise => "rise",
        /// The pack is too warm to continue.
        Hot => "hot",
        /// The voltage is higher than that of a good pack.
        Voltage => "voltage",
        /// More charge went in than the pack can hold.
        Charge => "charge",
        /// It took too long.
        Time => "time",
        /// The robot left the dock, or the dock lost its supply.
        Undocked => "undocked",
        /// The host requested it.
        Stopped => "stopped",
    }
}

names! {
    /// Why the charger is in `fault`.
    ChargeFault: 18 {
        /// The pack is hotter than any charge may make it.
        TooHot => "too-hot",
        /// More current than the set point allows.
        OverCurrent => "over-current",
        /// Current flows though the charger is off: its transistor is shorted. Only driving off the dock cuts it.
        Shorted => "shorted",
        /// The current sensor shows a current that cannot flow: its offset is wrong.
        CurrentOffset => "current-zero",
        /// The charger is on and no current is seen.
        NoCurrent => "no-current",
        /// The converter's readings are too old.
        Stale => "stale",
        /// The thermistor is not connected.
        ThermistorOpen => "thermistor-open",
        /// The thermistor's line is shorted.
        ThermistorShorted => "thermistor-shorted",
        /// The thermistor shows what no pack in a home has.
        ThermistorRange => "thermistor-range",
        /// The thermistor's reading jumped.
        ThermistorJump => "thermistor-jump",
        /// The thermistor's reading never changes.
        ThermistorFrozen => "thermistor-frozen",
        /// The pack's voltage jumped: a cell or a contact.
        VoltageJump => "voltage-jump",
        /// The supply gives more than the board stands.
        Adapter => "adapter",
        /// There is no pack.
        NoBattery => "no-battery",
        /// The pack is so empty that a cell may be reversed.
        DeepDischarge => "deep-discharge",
        /// A deeply discharged pack did not recover in time.
        Precharge => "precharge",
        /// The dock's contacts open and close again and again.
        Contact => "contact",
        /// The third fault within a day.
        Repeated => "repeated",
    }
}

/// What the charger tells beside the battery's figures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ChargerStatus {
    /// Where it stands.
    pub phase: ChargePhase,
    /// How the last charge since the reset ended, if one has.
    pub end: Option<ChargeEnd>,
    /// What is wrong; there in `fault` only.
    pub fault: Option<ChargeFault>,
}
