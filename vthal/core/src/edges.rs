//! What a robot feels that comes and goes: bumpers, cliffs, a wheel that hangs, the dock, the link. The one place of the daemon
//! where levels become times; whoever asks since when something is felt asks here.

use brain::{LinkFault, Observation};

/// When a level came, and when it was last there.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct LevelTimes {
    /// Host time in microseconds; `None` = it is not there.
    came_us: Option<u64>,
    /// When it was there last.
    seen_us: Option<u64>,
}

impl LevelTimes {
    /// Takes whether it is there now. `true` if it has just come.
    pub(crate) fn take(&mut self, now_us: u64, is_there: bool) -> bool {
        let comes = is_there && self.came_us.is_none();
        self.came_us = is_there.then(|| self.came_us.unwrap_or(now_us));
        if is_there {
            self.seen_us = Some(now_us);
        }
        comes
    }

    /// Since when it is there; `None` = it is not.
    pub(crate) const fn since_us(self) -> Option<u64> {
        self.came_us
    }

    pub(crate) const fn is_there(self) -> bool {
        self.came_us.is_some()
    }

    /// Whether it has been there for so long without a pause.
    pub(crate) fn has_lasted(self, now_us: u64, span_us: u64) -> bool {
        self.came_us
            .is_some_and(|came_us| now_us >= came_us.saturating_add(span_us))
    }

    /// Whether it was there less than so long ago.
    pub(crate) const fn was_there_within(self, now_us: u64, span_us: u64) -> bool {
        matches!(self.seen_us, Some(seen_us) if now_us < seen_us.saturating_add(span_us))
    }
}

/// Something that comes and goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Sign {
    BumperLeft,
    BumperRight,
    CliffLeft,
    CliffFront,
    CliffRight,
    WheelDrop,
    Docked,
    LinkLost,
}

impl Sign {
    /// All of them, in the order in which they are reported.
    const ALL: [Self; 8] = [
        Self::BumperLeft,
        Self::BumperRight,
        Self::CliffLeft,
        Self::CliffFront,
        Self::CliffRight,
        Self::WheelDrop,
        Self::Docked,
        Self::LinkLost,
    ];

    /// As clients and records name it.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::BumperLeft => "bumper-left",
            Self::BumperRight => "bumper-right",
            Self::CliffLeft => "cliff-left",
            Self::CliffFront => "cliff-front",
            Self::CliffRight => "cliff-right",
            Self::WheelDrop => "wheel-drop",
            Self::Docked => "docked",
            Self::LinkLost => "link-lost",
        }
    }

    fn is_in(self, observation: &Observation) -> bool {
        match self {
            Self::BumperLeft => observation.contacts.left,
            Self::BumperRight => observation.contacts.right,
            Self::CliffLeft => observation.cliffs.left,
            Self::CliffFront => observation.cliffs.middle,
            Self::CliffRight => observation.cliffs.right,
            Self::WheelDrop => observation.wheel_drop,
            Self::Docked => observation.docked,
            // What is wrong with a link that is not silent is among the inhibits.
            Self::LinkLost => !observation.link_up && LinkFault::of_inhibits(observation.inhibits).is_none(),
        }
    }
}

/// The edges of what is felt: when each sign that is there came.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Edges {
    /// In the order of [`Sign::ALL`].
    levels: [LevelTimes; Sign::ALL.len()],
}

impl Edges {
    /// Takes in what is felt now.
    pub(crate) fn take(&mut self, now_us: u64, observation: &Observation) {
        for (sign, level) in Sign::ALL.into_iter().zip(&mut self.levels) {
            level.take(now_us, sign.is_in(observation));
        }
    }

    /// Since when a sign is there; `None` = it is not.
    pub(crate) fn since_us(&self, sign: Sign) -> Option<u64> {
        let mut all = Sign::ALL.into_iter().zip(self.levels);
        all.find(|(other, _)| *other == sign)?.1.since_us()
    }

    /// The signs that are there.
    pub(crate) fn present(&self) -> impl Iterator<Item = Sign> {
        let all = Sign::ALL.into_iter().zip(self.levels);
        all.filter_map(|(sign, level)| level.is_there().then_some(sign))
    }
}

#[cfg(test)]
mod tests {
    use brain::Observation;

    use super::{Edges, Sign};

    #[test]
    fn a_sign_that_stays_came_once_and_one_that_comes_back_comes_anew() {
        let mut edges = Edges::default();
        let felt = |wheel_drop, docked| Observation {
            wheel_drop,
            docked,
            link_up: true,
            ..Observation::default()
        };
        for (now_us, wheel_drop, docked, since_us) in [
            (10, true, false, Some(10)),
            (20, true, true, Some(10)),
            (30, false, true, None),
            (40, true, true, Some(40)),
        ] {
            edges.take(now_us, &felt(wheel_drop, docked));
            assert_eq!(edges.since_us(Sign::WheelDrop), since_us);
        }
        assert_eq!(edges.since_us(Sign::Docked), Some(20));
        let present: Vec<Sign> = edges.present().collect();
        assert_eq!(present, [Sign::WheelDrop, Sign::Docked]);
    }
}
