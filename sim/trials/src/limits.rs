//! Reaction times of the rules. Made by cargo xtask codegen from protocol/rules.toml. Do not edit.

/// A limit of rules.toml.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limit {
    /// The rule and the name, as in `S6.stop`.
    pub name: &'static str,
    /// Milliseconds.
    pub ms: u32,
}

/// S1: a lease of 250 ms and the way of the last command.
pub const S1_SILENCE: Limit = Limit {
    name: "S1.silence",
    ms: 300,
};

/// S1: a lease of 1,000 ms and the way of the last command.
pub const S1_CLEANERS: Limit = Limit {
    name: "S1.cleaners",
    ms: 1_050,
};

/// S2.
pub const S2_NONE_ACTS: Limit = Limit {
    name: "S2.none-acts",
    ms: 0,
};

/// S3.
pub const S3_NONE_ACTS: Limit = Limit {
    name: "S3.none-acts",
    ms: 0,
};

/// S3.
pub const S3_FRESH: Limit = Limit {
    name: "S3.fresh",
    ms: 400,
};

/// S4.
pub const S4_OFF: Limit = Limit {
    name: "S4.off",
    ms: 1,
};

/// S4.
pub const S4_WINDOW: Limit = Limit {
    name: "S4.window",
    ms: 60_000,
};

/// S5: the period of the SR8730's watchdog.
pub const S5_RESET: Limit = Limit {
    name: "S5.reset",
    ms: 256,
};

/// S6.
pub const S6_STOP: Limit = Limit {
    name: "S6.stop",
    ms: 20,
};

/// S7.
pub const S7_HELD: Limit = Limit {
    name: "S7.held",
    ms: 10_000,
};

/// S7.
pub const S7_BACKING: Limit = Limit {
    name: "S7.backing",
    ms: 3_000,
};

/// S8.
pub const S8_STOP: Limit = Limit {
    name: "S8.stop",
    ms: 20,
};

/// S8: the speed is known from some counts of the encoder only.
pub const S8_OVERSHOOT: Limit = Limit {
    name: "S8.overshoot",
    ms: 100,
};

/// S8.
pub const S8_WINDOW: Limit = Limit {
    name: "S8.window",
    ms: 5_000,
};

/// S8.
pub const S8_SAME: Limit = Limit {
    name: "S8.same",
    ms: 300,
};

/// S9.
pub const S9_BLIND: Limit = Limit {
    name: "S9.blind",
    ms: 1_000,
};

/// S10.
pub const S10_OFF: Limit = Limit {
    name: "S10.off",
    ms: 50,
};

/// S10.
pub const S10_GROUNDED: Limit = Limit {
    name: "S10.grounded",
    ms: 1_000,
};

/// S11.
pub const S11_OVER_CURRENT: Limit = Limit {
    name: "S11.over-current",
    ms: 100,
};

/// S11.
pub const S11_STANDSTILL: Limit = Limit {
    name: "S11.standstill",
    ms: 300,
};

/// S11.
pub const S11_REVERSE: Limit = Limit {
    name: "S11.reverse",
    ms: 500,
};

/// S11.
pub const S11_TRIED: Limit = Limit {
    name: "S11.tried",
    ms: 10_000,
};

/// S12.
pub const S12_FOUND: Limit = Limit {
    name: "S12.found",
    ms: 250,
};

/// S13.
pub const S13_FOUND: Limit = Limit {
    name: "S13.found",
    ms: 500,
};

/// S14.
pub const S14_STOP: Limit = Limit {
    name: "S14.stop",
    ms: 5_000,
};

/// S15.
pub const S15_FOUND: Limit = Limit {
    name: "S15.found",
    ms: 2_000,
};

/// S16.
pub const S16_LOW: Limit = Limit {
    name: "S16.low",
    ms: 10_000,
};

/// S16.
pub const S16_WEAK: Limit = Limit {
    name: "S16.weak",
    ms: 2_000,
};

/// S16.
pub const S16_EMPTY: Limit = Limit {
    name: "S16.empty",
    ms: 500,
};

/// S17.
pub const S17_HOT: Limit = Limit {
    name: "S17.hot",
    ms: 1_000,
};

/// S17.
pub const S17_UNMEASURED: Limit = Limit {
    name: "S17.unmeasured",
    ms: 2_000,
};

/// S18.
pub const S18_OVER_CURRENT: Limit = Limit {
    name: "S18.over-current",
    ms: 100,
};

/// S18: readings of 200 ms, and a pass.
pub const S18_STALE: Limit = Limit {
    name: "S18.stale",
    ms: 201,
};

/// S18: eleven envelopes of 20 ms, because the one in which it breaks can still pass for sound, and the passes around them.
pub const S18_THERMISTOR: Limit = Limit {
    name: "S18.thermistor",
    ms: 225,
};

/// S18.
pub const S18_UNSUPPLIED: Limit = Limit {
    name: "S18.unsupplied",
    ms: 100,
};

/// S18.
pub const S18_SHORTED: Limit = Limit {
    name: "S18.shorted",
    ms: 1_100,
};

/// S18: found, three beeps and two seconds of warning, and then backing off.
pub const S18_ESCAPE: Limit = Limit {
    name: "S18.escape",
    ms: 3_500,
};

/// S18: found, and three tries with their warnings and pauses.
pub const S18_OFF_DOCK: Limit = Limit {
    name: "S18.off-dock",
    ms: 20_000,
};

/// S18.
pub const S18_WARNING: Limit = Limit {
    name: "S18.warning",
    ms: 2_000,
};

/// S18.
pub const S18_TRY: Limit = Limit {
    name: "S18.try",
    ms: 2_000,
};

/// S18.
pub const S18_CHARGE: Limit = Limit {
    name: "S18.charge",
    ms: 12_600_000,
};

/// S18: by the gate, which knows nothing of charges.
pub const S18_FLOW: Limit = Limit {
    name: "S18.flow",
    ms: 12_960_000,
};

/// S18: a rest that ends a charge.
pub const S18_REST: Limit = Limit {
    name: "S18.rest",
    ms: 1_800_000,
};

/// S19.
pub const S19_STOP: Limit = Limit {
    name: "S19.stop",
    ms: 20,
};

/// S19.
pub const S19_LEAVING: Limit = Limit {
    name: "S19.leaving",
    ms: 20_000,
};

/// S19: from the death of a host that has armed, with its silence and the start of a charge.
pub const S19_CHARGED_AGAIN: Limit = Limit {
    name: "S19.charged-again",
    ms: 10_000,
};

/// S19: from the `arm` of a host that does nothing, with its 20 s.
pub const S19_CHARGED_AGAIN_IDLE: Limit = Limit {
    name: "S19.charged-again-idle",
    ms: 30_000,
};

/// S20.
pub const S20_OFF: Limit = Limit {
    name: "S20.off",
    ms: 10,
};

/// S21.
pub const S21_MEMORY: Limit = Limit {
    name: "S21.memory",
    ms: 60_000,
};

/// S21.
pub const S21_REGISTER: Limit = Limit {
    name: "S21.register",
    ms: 20,
};

/// S22.
pub const S22_RESET: Limit = Limit {
    name: "S22.reset",
    ms: 1,
};

/// S23.
pub const S23_STOP: Limit = Limit {
    name: "S23.stop",
    ms: 400,
};

/// S23.
pub const S23_PAD: Limit = Limit {
    name: "S23.pad",
    ms: 2_000,
};

/// S28.
pub const S28_STOP: Limit = Limit {
    name: "S28.stop",
    ms: 50,
};

/// S29.
pub const S29_NEVER_START: Limit = Limit {
    name: "S29.never-start",
    ms: 0,
};

/// stop.
pub const STOP_OFF: Limit = Limit {
    name: "stop.off",
    ms: 30,
};

/// arming.
pub const ARMING_NONE_ACTS: Limit = Limit {
    name: "arming.none-acts",
    ms: 0,
};

/// arming.
pub const ARMING_SILENCE: Limit = Limit {
    name: "arming.silence",
    ms: 2_000,
};

/// arming.
pub const ARMING_HAND_LEASE: Limit = Limit {
    name: "arming.hand-lease",
    ms: 500,
};

/// arming.
pub const ARMING_QUIET: Limit = Limit {
    name: "arming.quiet",
    ms: 10_000,
};

/// arming: a session that begins ends hand mode as `stop` does.
pub const ARMING_SESSION: Limit = Limit {
    name: "arming.session",
    ms: 30,
};

/// Reports: the slowest debouncing, a report every 20 ms and the line.
pub const REPORTS_TOLD: Limit = Limit {
    name: "reports.told",
    ms: 400,
};

/// Reports.
pub const REPORTS_UNTOLD: Limit = Limit {
    name: "reports.untold",
    ms: 200,
};

/// A report as text, up to 251 bytes, crosses the line in 22 ms, and what comes true meanwhile waits for the next.
pub const REPORT_MS: u32 = 45;

/// After a reset the firmware checks its image, and the host must find it again, before anything is told.
pub const RECONNECT_MS: u32 = 8_000;

/// The charger's pulses are looked at as means of 20 ms.
pub const ENVELOPE_MS: u32 = 20;

/// Longest period of what implements a rule, in milliseconds.
#[must_use]
pub fn period_ms(rule: &str) -> u32 {
    match rule {
        "S9" => 910,
        _ => 1_000,
    }
}
