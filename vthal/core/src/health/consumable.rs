//! Parts that are changed or cleaned after hours of work, because nothing measures how worn or dirty they are.

use rvac_api::PartCare;

use crate::device::Part;

/// After a pause in the reports that is longer than this nobody knows whether a motor ran, microseconds.
const GAP_MAX_US: u64 = 500_000;

/// A part whose hours of work are counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Consumable {
    /// The brush below the robot.
    BrushMain,
    /// The brushes at its sides.
    BrushSides,
    /// The filter in front of the suction.
    Filter,
    /// Windows of the sensors that look at the floor and at walls.
    Sensors,
}

impl Consumable {
    /// All of them, in the order in which they are reported.
    pub const ALL: [Self; 4] = [Self::BrushMain, Self::BrushSides, Self::Filter, Self::Sensors];

    /// As clients name it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::BrushMain => "brush-main",
            Self::BrushSides => "brush-sides",
            Self::Filter => "filter",
            Self::Sensors => "sensors",
        }
    }

    /// The part of this name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|part| part.name() == name)
    }

    /// The part of a device without which there is none; sensors are on each.
    #[must_use]
    pub const fn of_device(self) -> Option<Part> {
        match self {
            Self::BrushMain => Some(Part::BrushMain),
            Self::BrushSides => Some(Part::BrushSides),
            Self::Filter => Some(Part::Vacuum),
            Self::Sensors => None,
        }
    }

    /// Hours of work after which people commonly see to it. The makers of the robots here give no figures; these are what the robots of
    /// Xiaomi and Roborock count (`ConsumableStatus` of python-miio).
    #[must_use]
    pub const fn life_h(self) -> u32 {
        match self {
            Self::BrushMain => 300,
            Self::BrushSides => 200,
            Self::Filter => 150,
            Self::Sensors => 30,
        }
    }

    /// What is done then.
    #[must_use]
    pub const fn care(self) -> PartCare {
        match self {
            Self::BrushMain | Self::BrushSides | Self::Filter => PartCare::Replace,
            Self::Sensors => PartCare::Clean,
        }
    }

    /// What to do about it when its time has come, for people.
    #[must_use]
    pub const fn remedy(self) -> &'static str {
        match self {
            Self::BrushMain => {
                "The main brush has worked for as long as such brushes usually last: replace it if its bristles are worn."
            }
            Self::BrushSides => {
                "The side brushes have worked for as long as such brushes usually last: replace them if they are bent or worn."
            }
            Self::Filter => "The filter has worked for as long as such filters usually last: replace it.",
            Self::Sensors => {
                "The sensors are due for cleaning: wipe their windows below and around the robot with a dry cloth."
            }
        }
    }
}

/// Which of them work at this moment.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AtWork {
    /// The main brush turns.
    pub brush_main: bool,
    /// The side brushes turn.
    pub brush_sides: bool,
    /// It sucks.
    pub vacuum: bool,
}

impl AtWork {
    const fn of(self, part: Consumable) -> bool {
        match part {
            Consumable::BrushMain => self.brush_main,
            Consumable::BrushSides => self.brush_sides,
            Consumable::Filter => self.vacuum,
            // Whatever cleans raises dust.
            Consumable::Sensors => self.brush_main || self.brush_sides || self.vacuum,
        }
    }
}

/// The work of one part since a person saw to it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PartWork {
    /// Seconds of work.
    pub worked_s: f64,
    /// When somebody saw to it, seconds since 1970; `None` = never, or by a board without a clock.
    pub since_s: Option<i64>,
    /// What it had worked before that, so that it can be taken back.
    pub before: Option<Before>,
    /// That it is due was said.
    pub is_told: bool,
}

/// The work of a part up to the moment in which a person saw to it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Before {
    /// Seconds of work.
    pub worked_s: f64,
    /// Since when.
    pub since_s: Option<i64>,
    /// That it was due had been said.
    pub is_told: bool,
}

impl PartWork {
    /// Hours of work.
    #[must_use]
    pub fn worked_h(&self) -> f64 {
        self.worked_s / 3_600.0
    }

    /// A person has seen to it.
    fn seen_to(self, now_s: Option<i64>) -> Self {
        Self {
            worked_s: 0.0,
            since_s: now_s,
            before: Some(Before {
                worked_s: self.worked_s,
                since_s: self.since_s,
                is_told: self.is_told,
            }),
            is_told: false,
        }
    }

    /// Nobody had: what it worked since counts to what it had worked before. `None` when there is nothing to take back.
    fn taken_back(self) -> Option<Self> {
        let before = self.before?;
        Some(Self {
            worked_s: before.worked_s + self.worked_s,
            since_s: before.since_s,
            before: None,
            is_told: before.is_told,
        })
    }
}

/// The work of all parts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Consumables {
    works: [PartWork; Consumable::ALL.len()],
    looked_us: Option<u64>,
}

impl Consumables {
    /// The work of a part.
    #[must_use]
    pub const fn work(&self, part: Consumable) -> &PartWork {
        &self.works[part as usize]
    }

    /// Takes a change of a part back.
    pub const fn put_back(&mut self, part: Consumable, work: PartWork) {
        *self.work_mut(part) = work;
    }

    pub(super) const fn work_mut(&mut self, part: Consumable) -> &mut PartWork {
        &mut self.works[part as usize]
    }

    /// Takes in a moment of a monotonic clock. Gives the seconds of work that were added for a part at most.
    pub fn take(&mut self, now_us: u64, at_work: AtWork) -> f64 {
        let before_us = self.looked_us.replace(now_us).unwrap_or(now_us);
        let passed_us = now_us.saturating_sub(before_us);
        if passed_us > GAP_MAX_US {
            return 0.0;
        }
        let passed_s = passed_us as f64 / 1e6;
        let mut added_s = 0.0;
        for part in Consumable::ALL.into_iter().filter(|part| at_work.of(*part)) {
            self.work_mut(part).worked_s += passed_s;
            added_s = passed_s;
        }
        added_s
    }

    /// Parts that have become due and of which that was not said yet; from now on it was.
    pub fn newly_due(&mut self) -> Vec<Consumable> {
        let is_new = |part: &Consumable| {
            let work = self.work(*part);
            !work.is_told && work.worked_h() >= f64::from(part.life_h())
        };
        let due: Vec<Consumable> = Consumable::ALL.into_iter().filter(is_new).collect();
        for part in &due {
            self.work_mut(*part).is_told = true;
        }
        due
    }

    /// A person has seen to a part; gives its work as it was.
    pub fn see_to(&mut self, part: Consumable, now_s: Option<i64>) -> PartWork {
        let work = self.work_mut(part);
        let after = work.seen_to(now_s);
        core::mem::replace(work, after)
    }

    /// The last of that is taken back; gives the work of the part as it was, or nothing when nobody has seen to it.
    pub fn take_back(&mut self, part: Consumable) -> Option<PartWork> {
        let work = self.work_mut(part);
        let after = work.taken_back()?;
        Some(core::mem::replace(work, after))
    }
}

#[cfg(test)]
mod tests {
    use super::{AtWork, Consumable, Consumables};

    const BRUSHES: AtWork = AtWork {
        brush_main: true,
        brush_sides: false,
        vacuum: false,
    };

    fn work(parts: &mut Consumables, from_us: u64, seconds: u64, at_work: AtWork) {
        for tenth in 0..=10 * seconds {
            parts.take(from_us + tenth * 100_000, at_work);
        }
    }

    fn worked_s(parts: &Consumables) -> [f64; 4] {
        Consumable::ALL.map(|part| parts.work(part).worked_s.round())
    }

    #[test]
    fn each_part_counts_the_time_in_which_its_motor_runs() {
        let mut parts = Consumables::default();
        work(&mut parts, 0, 60, BRUSHES);
        work(&mut parts, 60_000_000, 60, AtWork::default());
        let sucks = AtWork {
            vacuum: true,
            ..AtWork::default()
        };
        work(&mut parts, 120_000_000, 30, sucks);
        assert_eq!(worked_s(&parts), [60.0, 0.0, 30.0, 90.0]);
        parts.take(500_000_000, BRUSHES);
        assert_eq!(
            worked_s(&parts)[0],
            60.0,
            "nobody knows what it did in a long silence"
        );
    }

    #[test]
    fn a_part_is_due_once_until_somebody_has_seen_to_it() {
        let mut parts = Consumables::default();
        parts.work_mut(Consumable::Sensors).worked_s = 30.0 * 3_600.0 - 1.0;
        assert_eq!(parts.newly_due(), []);
        work(&mut parts, 0, 2, BRUSHES);
        assert_eq!(parts.newly_due(), [Consumable::Sensors]);
        work(&mut parts, 10_000_000, 60, BRUSHES);
        assert_eq!(parts.newly_due(), [], "it is said once");
        parts.see_to(Consumable::Sensors, Some(1_800_000_000));
        parts.work_mut(Consumable::Sensors).worked_s = 31.0 * 3_600.0;
        assert_eq!(
            parts.newly_due(),
            [Consumable::Sensors],
            "and once again after the next hours"
        );
    }

    #[test]
    fn what_was_pressed_by_mistake_is_taken_back_with_the_work_since() {
        let mut parts = Consumables::default();
        work(&mut parts, 0, 60, BRUSHES);
        assert_eq!(parts.take_back(Consumable::BrushMain), None);
        parts.see_to(Consumable::BrushMain, Some(7));
        assert_eq!(parts.work(Consumable::BrushMain).since_s, Some(7));
        work(&mut parts, 60_000_000, 20, BRUSHES);
        assert_eq!(worked_s(&parts)[0], 20.0);
        parts.take_back(Consumable::BrushMain).expect("can be");
        assert_eq!(worked_s(&parts)[0], 80.0);
        assert_eq!(parts.work(Consumable::BrushMain).since_s, None);
        assert_eq!(parts.take_back(Consumable::BrushMain), None, "only once");
    }
}
