//! How good the link is, and what that means for speed.

/// What the quality of the link allows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Verdict {
    /// At most 1 % of the packets of the last 5 s were bad: full speed.
    #[default]
    Good,
    /// More than 1 %: half speed.
    Poor,
    /// More than 10 %: stop.
    Bad,
}

/// Quality of the link as the host sees it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LinkQuality {
    /// Packets of the last 5 s, in both directions as far as known.
    pub packets: u32,
    /// Bad ones among them.
    pub bad: u32,
    /// Newest round trip of a numbered command in ms.
    pub round_trip_ms: Option<u32>,
    /// What this allows.
    pub verdict: Verdict,
}
