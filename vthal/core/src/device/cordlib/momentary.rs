//! What came and went between two reports.
//!
//! Reports tell levels, and events tell changes. The firmware holds a pressed zone of the bumper for at least 30 ms (`RELEASE_MS` in
//! `firmware/cordlib/src/reflex/bumper.rs`), and a cliff and a hanging wheel for 50 ms (`CLEAR_MS` beside it), and reports every 20 ms
//! (`STATE_PERIOD_MS` in `firmware/cordlib/src/report.rs`). So on a clean line each of them is in a report. But a report waits while other
//! packets are on the line, and one that noise has damaged is not repeated; an event is repeated until the host has confirmed it. A level
//! that only an event has shown is therefore added to the next report, where all who look for contacts find it.

use rvac_protocol::message::{Bumpers, Cliffs, Event, NumberedEvent, State, WheelDrops};
use rvac_units::Tick;

/// An event that comes later than this after what it tells is not added, in ms: the robot is elsewhere by then. It allows for two
/// repetitions.
const LATE_MAX_MS: u32 = 300;

/// Number of levels: two zones of the bumper, three cliff sensors, two wheels.
const LEVELS: usize = 7;

/// Levels in which an event and a report can differ.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Levels {
    bumpers: Bumpers,
    cliffs: Cliffs,
    wheel_drops: WheelDrops,
}

impl Levels {
    const fn flags(&self) -> [bool; LEVELS] {
        let Self {
            bumpers,
            cliffs,
            wheel_drops,
        } = self;
        [
            bumpers.left,
            bumpers.right,
            cliffs.left,
            cliffs.middle,
            cliffs.right,
            wheel_drops.left,
            wheel_drops.right,
        ]
    }
}

/// Compares events with reports.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct MomentaryLevels {
    /// As the last events tell.
    told: Levels,
    watched: [Watched; LEVELS],
}

/// One level.
#[derive(Clone, Copy, Debug, Default)]
struct Watched {
    /// The newest report that shows it.
    shown: Option<Tick>,
    /// When it came, by an event, if no report has shown it since.
    unshown: Option<Tick>,
}

impl MomentaryLevels {
    /// Takes an event, in the order in which the firmware numbered them.
    pub(super) fn take(&mut self, event: &NumberedEvent) {
        let before = self.told;
        match event.kind {
            Event::Bump(bumpers) => self.told.bumpers = bumpers,
            Event::Cliff(cliffs) => self.told.cliffs = cliffs,
            Event::Lift(wheel_drops) => self.told.wheel_drops = wheel_drops,
            Event::Button { .. }
            | Event::Docked(_)
            | Event::MoveFinished(_)
            | Event::Inhibits(_)
            | Event::Stall(_) => return,
        }
        let changes = before.flags().into_iter().zip(self.told.flags());
        for (watched, (was, is)) in self.watched.iter_mut().zip(changes) {
            if is && !was {
                watched.comes(event.tick);
            }
        }
    }

    /// Adds to a report what came and went since the one before.
    pub(super) fn complete(&mut self, state: &mut State) {
        let shown = Levels {
            bumpers: state.bumpers,
            cliffs: state.cliffs,
            wheel_drops: state.wheel_drops,
        };
        let mut levels = shown.flags();
        for (watched, level) in self.watched.iter_mut().zip(&mut levels) {
            *level |= watched.is_missing(state.tick, *level);
        }
        let [
            left,
            right,
            cliff_left,
            middle,
            cliff_right,
            wheel_left,
            wheel_right,
        ] = levels;
        state.bumpers = Bumpers { left, right };
        state.cliffs = Cliffs {
            left: cliff_left,
            middle,
            right: cliff_right,
        };
        state.wheel_drops = WheelDrops {
            left: wheel_left,
            right: wheel_right,
        };
    }
}

impl Watched {
    const fn comes(&mut self, at: Tick) {
        let is_shown = matches!(self.shown, Some(shown) if shown.reached(at));
        if !is_shown {
            self.unshown = Some(at);
        }
    }

    /// Whether a report of this time lacks it.
    fn is_missing(&mut self, now: Tick, is_shown: bool) -> bool {
        if is_shown {
            *self = Self {
                shown: Some(now),
                unshown: None,
            };
            return false;
        }
        let come = self.unshown.filter(|come| now.reached(*come));
        if come.is_some() {
            self.unshown = None;
        }
        come.is_some_and(|come| now.since(come) <= LATE_MAX_MS)
    }
}

#[cfg(test)]
mod tests {
    use rvac_protocol::message::{Bumpers, Event, NumberedEvent, State};
    use rvac_units::Tick;

    use super::MomentaryLevels;

    const LEFT: Bumpers = Bumpers {
        left: true,
        right: false,
    };
    const NONE: Bumpers = Bumpers {
        left: false,
        right: false,
    };

    fn tell(levels: &mut MomentaryLevels, tick: u32, bumpers: Bumpers) {
        levels.take(&NumberedEvent {
            number: 0,
            tick: Tick(tick),
            kind: Event::Bump(bumpers),
        });
    }

    fn report(levels: &mut MomentaryLevels, tick: u32, bumpers: Bumpers) -> Bumpers {
        let mut state = State {
            tick: Tick(tick),
            bumpers,
            ..State::default()
        };
        levels.complete(&mut state);
        state.bumpers
    }

    #[test]
    fn a_press_that_no_report_shows_is_in_the_next_one() {
        let mut levels = MomentaryLevels::default();
        report(&mut levels, 100, NONE);
        tell(&mut levels, 105, LEFT);
        tell(&mut levels, 135, NONE);
        assert_eq!(report(&mut levels, 140, NONE), LEFT);
        assert_eq!(report(&mut levels, 160, NONE), NONE, "once");
    }

    #[test]
    fn a_press_that_a_report_shows_is_not_prolonged_in_whatever_order_they_come() {
        let mut levels = MomentaryLevels::default();
        tell(&mut levels, 105, LEFT);
        assert_eq!(report(&mut levels, 120, LEFT), LEFT);
        tell(&mut levels, 135, NONE);
        assert_eq!(report(&mut levels, 140, NONE), NONE);
        assert_eq!(report(&mut levels, 220, LEFT), LEFT);
        assert_eq!(report(&mut levels, 240, NONE), NONE);
        tell(&mut levels, 210, LEFT);
        assert_eq!(report(&mut levels, 260, NONE), NONE, "the event was repeated");
    }

    #[test]
    fn a_report_of_before_takes_no_press_and_an_event_that_comes_too_late_gives_none() {
        let mut levels = MomentaryLevels::default();
        tell(&mut levels, 105, LEFT);
        assert_eq!(report(&mut levels, 104, NONE), NONE);
        assert_eq!(report(&mut levels, 110, NONE), LEFT);
        tell(&mut levels, 130, NONE);
        tell(&mut levels, 200, LEFT);
        assert_eq!(report(&mut levels, 501, NONE), NONE);
    }
}
