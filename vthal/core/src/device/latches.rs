//! What latches for robots without reflexes, as in our own firmware: a bumper that stays pressed (S7) and a cliff that does not end or
//! comes again and again (S8). Nothing moves then until a person has cleared it by its name.

use brain::{Inhibit, Inhibits};

use super::reflex::is_host;
use super::{CommandError, Reflexes, Report};
use crate::edges::LevelTimes;

/// A bumper that stays pressed for so long while the robot backs off is stuck.
const STUCK_BACKING_US: u64 = 3_000_000;
/// One that stays pressed for so long anyhow is stuck, while somebody may move the robot: at rest it may stand against a wall, and the dock may
/// press it for ever.
const STUCK_US: u64 = 10_000_000;
/// A bumper or a cliff that backing off by this has not ended holds the robot, metres.
const BACKED_MAX_M: f64 = 0.15;
/// So many cliffs within this time hold the robot.
const CLIFFS_MAX: usize = 3;
const CLIFFS_WINDOW_US: u64 = 5_000_000;
/// Floor that is seen for a moment while the robot brakes along an edge or backs off does not make it a second cliff.
const SAME_CLIFF_US: u64 = 300_000;

/// The latches of one robot, and what leads to them.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct HostLatches {
    latched: Inhibits,
    /// Mean way of both wheels in the last report, metres.
    way_m: Option<f64>,
    bumper: BumperLatch,
    cliff: CliffLatch,
}

/// State of S7.
#[derive(Clone, Copy, Debug, Default)]
struct BumperLatch {
    pressed: LevelTimes,
    pressed_in_control: LevelTimes,
    pressed_backing: LevelTimes,
    /// Way backed while pressed, less the way forward since: no sensor looks backwards, so a contact that opens and closes again does
    /// not restart it.
    backed_m: f64,
}

/// State of S8.
#[derive(Clone, Copy, Debug, Default)]
struct CliffLatch {
    seen: LevelTimes,
    /// Way backed since the cliff came, metres.
    backed_m: f64,
    onsets_us: [Option<u64>; CLIFFS_MAX],
}

impl HostLatches {
    /// Takes a report, whose ways have signs, and whether the host has the robot's wheels; marks in the report what is latched. `true` if
    /// something latches now.
    pub(super) fn take(
        &mut self,
        now_us: u64,
        report: &mut Report,
        (sites, in_control): (Reflexes, bool),
    ) -> bool {
        let before = self.latched;
        let way_m = 0.5 * (report.travel.left_m + report.travel.right_m);
        let ahead_m = self.way_m.replace(way_m).map_or(0.0, |last_m| way_m - last_m);
        if is_host(sites.bump) && self.bumper.is_stuck(now_us, (report, in_control), ahead_m) {
            self.latched.insert(Inhibit::BumperStuck);
        }
        if is_host(sites.cliff) && self.cliff.is_trapped(now_us, report, ahead_m) {
            self.latched.insert(Inhibit::CliffTrapped);
        }
        for inhibit in self.latched.iter() {
            report.inhibits.insert(inhibit);
        }
        before != self.latched
    }

    /// Whether anything is latched: then nothing moves.
    pub(super) const fn any(&self) -> bool {
        !self.latched.is_empty()
    }

    /// Whether the host has latched this.
    pub(super) const fn holds(&self, inhibit: Inhibit) -> bool {
        self.latched.contains(inhibit)
    }

    /// A person has seen to it.
    ///
    /// # Errors
    /// Its cause is still there.
    pub(super) fn clear(&mut self, inhibit: Inhibit) -> Result<(), CommandError> {
        let cause_remains = match inhibit {
            Inhibit::BumperStuck => self.bumper.pressed.is_there(),
            _ => self.cliff.seen.is_there(),
        };
        if cause_remains {
            return Err(CommandError::Held);
        }
        self.latched.remove(inhibit);
        if inhibit == Inhibit::BumperStuck {
            self.bumper.backed_m = 0.0;
        }
        Ok(())
    }

    /// The next report says nothing about the way before.
    pub(super) const fn rebase(&mut self) {
        self.way_m = None;
    }
}

impl BumperLatch {
    fn is_stuck(&mut self, now_us: u64, (report, in_control): (&Report, bool), ahead_m: f64) -> bool {
        let (is_pressed, backs) = (report.contacts.any(), ahead_m < 0.0);
        self.pressed.take(now_us, is_pressed);
        self.pressed_in_control
            .take(now_us, is_pressed && in_control && !report.docked);
        self.pressed_backing.take(now_us, is_pressed && backs);
        if ahead_m > 0.0 || (is_pressed && backs) {
            self.backed_m = (self.backed_m - ahead_m).max(0.0);
        }
        self.pressed_in_control.has_lasted(now_us, STUCK_US)
            || self.pressed_backing.has_lasted(now_us, STUCK_BACKING_US)
            || (is_pressed && self.backed_m > BACKED_MAX_M)
    }
}

impl CliffLatch {
    fn is_trapped(&mut self, now_us: u64, report: &Report, ahead_m: f64) -> bool {
        let comes = self.seen.take(now_us, report.cliffs.any());
        if !self.seen.is_there() {
            return false;
        }
        if comes && !self.is_same_cliff(now_us) {
            self.backed_m = 0.0;
            // A robot that is carried sees cliffs too.
            if (report.is_driven || ahead_m != 0.0) && self.is_third_onset(now_us) {
                return true;
            }
        }
        self.backed_m = (self.backed_m - ahead_m).max(0.0);
        self.backed_m > BACKED_MAX_M
    }

    fn is_same_cliff(&self, now_us: u64) -> bool {
        let is_fresh = |onset_us: &u64| now_us.saturating_sub(*onset_us) <= SAME_CLIFF_US;
        self.onsets_us.iter().flatten().any(is_fresh)
    }

    /// Notes an onset; true if it is the third within the window. The count then starts anew.
    fn is_third_onset(&mut self, now_us: u64) -> bool {
        for place in &mut self.onsets_us {
            if place.is_some_and(|onset_us| now_us.saturating_sub(onset_us) > CLIFFS_WINDOW_US) {
                *place = None;
            }
        }
        if let Some(place) = self.onsets_us.iter_mut().find(|place| place.is_none()) {
            *place = Some(now_us);
        }
        let is_third = self.onsets_us.iter().all(Option::is_some);
        if is_third {
            self.onsets_us = [None; CLIFFS_MAX];
        }
        is_third
    }
}

#[cfg(test)]
mod tests {
    use brain::Inhibit;
    use brain::observation::{Cliffs, Contacts};

    use super::super::{CommandError, ReflexSite, Reflexes, Report, WheelTravel};
    use super::HostLatches;

    const HOST: ReflexSite = ReflexSite::Host { latency_s: 0.1 };
    const ALL: Reflexes = Reflexes {
        bump: HOST,
        cliff: HOST,
        lift: HOST,
    };

    /// Reports ten times a second while the robot drives at this speed; when it latched, in tenths of a second.
    fn latches_after(latches: &mut HostLatches, report: Report, m_per_s: f64) -> Option<u64> {
        latches_in(latches, (report, true), m_per_s)
    }

    fn latches_in(
        latches: &mut HostLatches,
        (report, in_control): (Report, bool),
        m_per_s: f64,
    ) -> Option<u64> {
        (0..=150).find(|tenths| {
            let way_m = 0.1 * m_per_s * *tenths as f64;
            let mut told = report;
            told.travel = WheelTravel {
                left_m: way_m,
                right_m: way_m,
                speeds: None,
            };
            latches.take(tenths * 100_000, &mut told, (ALL, in_control))
        })
    }

    fn pressed(docked: bool) -> Report {
        Report {
            contacts: Contacts {
                left: true,
                right: false,
            },
            docked,
            ..Report::default()
        }
    }

    #[test]
    fn a_bumper_that_stays_pressed_latches_and_is_cleared_when_it_is_free() {
        let mut latches = HostLatches::default();
        assert_eq!(latches_after(&mut latches, pressed(false), 0.0), Some(100));
        assert_eq!(latches.clear(Inhibit::BumperStuck), Err(CommandError::Held));
        let mut free = Report::default();
        latches.take(15_100_000, &mut free, (ALL, true));
        assert!(
            free.inhibits.contains(Inhibit::BumperStuck),
            "until it is cleared"
        );
        assert_eq!(latches.clear(Inhibit::BumperStuck), Ok(()));
        assert!(!latches.any());
    }

    #[test]
    fn backing_off_makes_it_sooner_and_at_rest_and_on_the_dock_it_may_be_pressed() {
        let after = |report, m_per_s| latches_after(&mut HostLatches::default(), report, m_per_s);
        assert_eq!(after(pressed(false), -0.02), Some(31), "three seconds of backing");
        assert_eq!(after(pressed(false), -0.08), Some(19), "15 cm");
        assert_eq!(after(pressed(true), 0.0), None);
        let at_rest = latches_in(&mut HostLatches::default(), (pressed(false), false), 0.0);
        assert_eq!(at_rest, None);
    }

    #[test]
    fn a_cliff_that_backing_off_does_not_end_and_a_third_one_are_traps() {
        let cliff = Report {
            cliffs: Cliffs {
                middle: true,
                ..Cliffs::default()
            },
            is_driven: true,
            ..Report::default()
        };
        let mut latches = HostLatches::default();
        assert_eq!(latches_after(&mut latches, cliff, -0.08), Some(19));
        let mut latches = HostLatches::default();
        let mut take = |at_us, report| latches.take(at_us, &mut { report }, (ALL, true));
        for (at_us, report, is_trap) in [
            (0, cliff, false),
            (100_000, Report::default(), false),
            (200_000, cliff, false),
            (400_000, Report::default(), false),
            (2_000_000, cliff, false),
            (2_100_000, Report::default(), false),
            (4_000_000, cliff, true),
        ] {
            assert_eq!(take(at_us, report), is_trap, "{at_us} µs");
        }
    }
}
