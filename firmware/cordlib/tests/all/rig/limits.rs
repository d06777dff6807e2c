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

/// S6.
pub const S6_STOP: Limit = Limit {
    name: "S6.stop",
    ms: 20,
};

/// S8.
pub const S8_STOP: Limit = Limit {
    name: "S8.stop",
    ms: 20,
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
pub const S18_SHORTED: Limit = Limit {
    name: "S18.shorted",
    ms: 1_100,
};

/// S18: found, three beeps and two seconds of warning, and then backing off.
pub const S18_ESCAPE: Limit = Limit {
    name: "S18.escape",
    ms: 3_500,
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

/// S28.
pub const S28_STOP: Limit = Limit {
    name: "S28.stop",
    ms: 50,
};

/// stop.
pub const STOP_OFF: Limit = Limit {
    name: "stop.off",
    ms: 30,
};
