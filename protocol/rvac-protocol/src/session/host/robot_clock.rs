//! The robot's clock as its reports tell it.
//!
//! A seal does not make a tick true: a report may be repeated, overtaken or held back, and a clock may jump or stand. The
//! host sends the newest tick back with each motion, so one tick that is off by a minute would have the robot refuse all
//! motion for a minute. Here a tick counts only if it follows from the ones before.

use rvac_units::Tick;

/// A tick may be ahead of what those before and the host's own clock make likely by so much, ms: those were late.
const LEAD_MAX_MS: u32 = 500;
/// So many states in a row that follow from each other, but not from those before, tell that the robot's clock has jumped.
const AGREE: u8 = 5;
/// States of a slice of [`Offsets`]: those of a minute.
const SLICE_STATES: u16 = 3_000;

/// What the tick of a state says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TickVerdict {
    /// The state is newer than all before.
    New,
    /// It has the tick of the one before.
    Repeated,
    /// Its tick does not follow from those before.
    Stray,
    /// It is the last of some that agree upon another time; that counts from now on.
    Jumped,
}

/// A tick and when the host heard it.
#[derive(Clone, Copy, Debug)]
struct Heard {
    tick: Tick,
    at: Tick,
}

impl Heard {
    /// What the robot's clock shows more than the host's, as far as this tick tells; less than that if it was late.
    const fn offset(self) -> u32 {
        self.tick.since(self.at)
    }
}

/// By how much the robot's clock is ahead of the host's: by the punctual ones of the states of the last one to two slices,
/// because two clocks drift apart.
#[derive(Clone, Copy, Debug, Default)]
struct Offsets {
    now: Option<u32>,
    before: Option<u32>,
    states: u16,
}

impl Offsets {
    fn take(&mut self, heard: Heard) {
        self.states = self.states.saturating_add(1);
        if self.states > SLICE_STATES {
            *self = Self {
                now: None,
                before: self.now,
                states: 1,
            };
        }
        self.now = greater(self.now, Some(heard.offset()));
    }

    /// Whether a tick is not too far ahead.
    fn allow(&self, heard: Heard) -> bool {
        let latest = |offset: u32| Tick(heard.at.0.wrapping_add(offset)).after(LEAD_MAX_MS);
        greater(self.now, self.before).is_none_or(|offset| latest(offset).reached(heard.tick))
    }
}

/// The greater one of two offsets on clocks that wrap.
fn greater(one: Option<u32>, other: Option<u32>) -> Option<u32> {
    match (one, other) {
        (Some(a), Some(b)) if Tick(b).reached(Tick(a)) => Some(b),
        (Some(a), _) => Some(a),
        (None, other) => other,
    }
}

/// States that agree upon another time.
#[derive(Clone, Copy, Debug)]
struct OtherTime {
    newest: Heard,
    states: u8,
}

/// Follows the robot's clock during a session.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct RobotClock {
    /// Of states, events and the greeting.
    newest: Option<Heard>,
    /// Of the newest state, or the greeting.
    state: Option<Tick>,
    offsets: Offsets,
    /// The tick of the state that came last, right or not.
    last: Option<Tick>,
    other: Option<OtherTime>,
}

impl RobotClock {
    /// A session has begun with this tick.
    pub(super) fn begin(tick: Tick, at: Tick) -> Self {
        let heard = Heard { tick, at };
        let mut offsets = Offsets::default();
        offsets.take(heard);
        Self {
            newest: Some(heard),
            state: Some(tick),
            offsets,
            last: None,
            other: None,
        }
    }

    /// The newest tick and when it was heard.
    pub(super) fn newest(&self) -> Option<(Tick, Tick)> {
        self.newest.map(|heard| (heard.tick, heard.at))
    }

    /// Takes the tick of an event; a repeated one carries an old tick.
    pub(super) fn hear_event(&mut self, tick: Tick, at: Tick) {
        let heard = Heard { tick, at };
        if self.offsets.allow(heard) && self.newest.is_none_or(|newest| tick.reached(newest.tick)) {
            self.newest = Some(heard);
        }
    }

    /// Takes the tick of a state.
    pub(super) fn hear_state(&mut self, tick: Tick, at: Tick) -> TickVerdict {
        if self.last.replace(tick) == Some(tick) {
            return TickVerdict::Repeated;
        }
        let heard = Heard { tick, at };
        if self.offsets.allow(heard) && self.state.is_none_or(|state| tick.reached(state)) {
            self.state = Some(tick);
            self.offsets.take(heard);
            self.other = None;
            self.hear_event(tick, at);
            return TickVerdict::New;
        }
        if !self.agrees_upon(heard) {
            return TickVerdict::Stray;
        }
        *self = Self {
            last: self.last,
            ..Self::begin(tick, at)
        };
        TickVerdict::Jumped
    }

    /// Whether enough states agree upon another time, this one included.
    fn agrees_upon(&mut self, heard: Heard) -> bool {
        let follows = |other: &OtherTime| {
            let step_ms = heard.tick.since(other.newest.tick);
            step_ms <= heard.at.since(other.newest.at).saturating_add(LEAD_MAX_MS)
        };
        let states = self
            .other
            .filter(follows)
            .map_or(0, |other| other.states)
            .saturating_add(1);
        self.other = Some(OtherTime {
            newest: heard,
            states,
        });
        states >= AGREE
    }
}

#[cfg(test)]
mod tests {
    use rvac_units::Tick;

    use super::RobotClock;
    use super::TickVerdict::{self, Jumped, New, Repeated, Stray};

    const BEGIN: u32 = u32::MAX - 50;

    /// Each tick after the begin is heard so many milliseconds after the begin, and judged so.
    #[track_caller]
    fn check(states: impl IntoIterator<Item = (u32, u32, TickVerdict)>) {
        let mut clock = RobotClock::begin(Tick(BEGIN), Tick(7));
        for (tick, at, verdict) in states {
            let found = clock.hear_state(Tick(BEGIN).after(tick), Tick(7).after(at));
            assert_eq!(found, verdict, "{tick} at {at}");
        }
    }

    #[test]
    fn states_in_order_are_new_also_across_the_wrap_and_after_a_pause() {
        check([
            (20, 20, New),
            (40, 40, New),
            (60, 3_000, New),
            (80, 3_000, New),
            // Much was lost between two that came at once.
            (3_000, 3_001, New),
            (3_600, 3_020, Stray),
        ]);
        check([(3_000, 3_000, New), (3_020, 3_020, New)]);
    }

    #[test]
    fn a_repeated_an_overtaken_and_a_stray_state_are_not_new() {
        check([
            (20, 20, New),
            (20, 20, Repeated),
            (60, 60, New),
            (40, 60, Stray),
            (80, 80, New),
            (60_100, 100, Stray),
            (120, 120, New),
        ]);
    }

    #[test]
    fn states_that_agree_upon_another_time_are_believed() {
        for jump in [60_000, u32::MAX - 60_000] {
            let verdicts = [Stray, Stray, Stray, Stray, Jumped, New, New];
            check((1..).zip(verdicts).map(|(n, verdict)| {
                let at: u32 = 20 * n;
                (jump.wrapping_add(at), at, verdict)
            }));
        }
    }

    #[test]
    fn what_comes_again_a_second_later_does_not_turn_the_clock_back() {
        check((1..50).flat_map(|n| {
            let at = 1_000 + 20 * n;
            [(at, at, New), (at - 1_000, at, Stray)]
        }));
    }

    #[test]
    fn events_move_the_clock_on_and_never_back_or_far_ahead() {
        let mut clock = RobotClock::begin(Tick(1_000), Tick(0));
        for (tick, newest) in [(1_030, 1_030), (1_010, 1_030), (90_000, 1_030)] {
            clock.hear_event(Tick(tick), Tick(30));
            assert_eq!(clock.newest(), Some((Tick(newest), Tick(30))), "{tick}");
        }
        // An event may overtake a state.
        assert_eq!(clock.hear_state(Tick(1_020), Tick(40)), New);
        assert_eq!(clock.newest(), Some((Tick(1_030), Tick(30))));
        // Nor does one that comes again after a minute hold it back.
        clock.hear_event(Tick(30_000), Tick(60_000));
        assert_eq!(clock.hear_state(Tick(61_020), Tick(60_020)), New);
        assert_eq!(clock.newest(), Some((Tick(61_020), Tick(60_020))));
    }

    #[test]
    fn clocks_that_drift_apart_by_two_percent_stay_together() {
        for period in [98, 102] {
            let mut clock = RobotClock::begin(Tick(0), Tick(0));
            for n in 1..100_000 {
                assert_eq!(clock.hear_state(Tick(100 * n), Tick(period * n)), New);
            }
            let stray = clock.hear_state(Tick(100 * 100_000 + 60_000), Tick(period * 100_000));
            assert_eq!(stray, Stray, "{period}");
        }
    }
}
