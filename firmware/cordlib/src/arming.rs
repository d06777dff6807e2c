//! Who may move the robot: the one state machine of arming. Its table stands in SPEC.md, section 4, and in SAFETY.md.
//!
//! Each permission has a [`Holder`] and ends by itself: that of a host with its session (S1, S2), that of a person who types
//! and that of the board's own firmware 10 s after their last motion, leaving the dock after 20 s on its contacts (S19), the
//! escape from a shorted charger with its try (S18). A reset (S4), `stop`, a button (S28), arriving on the dock and being
//! taken off it (S19) end any of them. Whoever wants to go on must arm again.

use rvac_protocol::message::{ArmingState, Inhibit, Inhibits};
use rvac_units::Tick;

use crate::rules::arming::{LEAVING_MS, LEFT_MS, QUIET_MS};
use crate::timing::HoldTimer;

/// Codes of the states that allow something, in memory. Any two of them, and any of them and that of [`LOCKED`], differ in
/// sixteen bits, and any other pattern counts as locked: no flip of fewer bits gives a permission (S21).
const ARMED: u32 = 0x5555_5555;
const LEAVING_DOCK: u32 = 0x3333_3333;
const HAND: u32 = 0x0F0F_0F0F;
const DOCK_ESCAPE: u32 = 0x00FF_00FF;
const LOCKED: u32 = 0x0000_FFFF;

/// Who may move the robot, and whose signs of life keep the permission.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Holder {
    /// The host of the session with this number. The board's own firmware shares the permission (S27).
    Session(u16),
    /// A person who types, without a session.
    Typist,
    /// The board's own firmware, without a session.
    Board,
    /// The escape from a shorted charger.
    Escape,
}

/// Everything that can happen to a permission.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ArmingEvent {
    /// `arm` off the contacts.
    Arm(Holder),
    /// `arm` with `undock`.
    Undock(Holder),
    /// `stop` was commanded.
    Stop,
    /// A person pressed a button while the robot moved.
    Button,
    /// A session began or ended.
    SessionChange,
    /// The contacts closed.
    Arrival,
    /// The contacts opened though nobody had told the robot to leave.
    TakenOff,
    /// The contacts have been open for so long that the robot has left.
    Left,
    /// The robot was told to leave and still stands on the contacts.
    StoodTooLong,
    /// The holder has no session and has commanded no motion for long.
    FellQuiet,
    /// Current flows though the charger is off.
    EscapeBegins,
    /// A try to escape is over.
    EscapeOver,
}

/// What the permission depends on in each pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ArmingFacts {
    /// The contacts are closed, debounced.
    pub(crate) docked: bool,
    /// Number of the open session, 0 = none.
    pub(crate) session: u16,
}

/// The present permission. Locked at first.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arming {
    code: u32,
    holder: Holder,
    /// When it was given.
    armed: Tick,
    /// When its holder last commanded motion.
    renewed: Tick,
    away: HoldTimer,
    /// What ended earlier motion: `stopped`, `button-stop`, `link-lost`.
    inhibits: Inhibits,
}

impl Default for Arming {
    fn default() -> Self {
        Self {
            code: LOCKED,
            holder: Holder::Board,
            armed: Tick(0),
            renewed: Tick(0),
            away: HoldTimer::default(),
            inhibits: Inhibits::NONE,
        }
    }
}

impl Holder {
    /// The state after `arm` off the dock.
    const fn state(self) -> ArmingState {
        match self {
            Self::Typist => ArmingState::Hand,
            Self::Session(_) | Self::Board | Self::Escape => ArmingState::Armed,
        }
    }

    const fn has_session(self) -> bool {
        matches!(self, Self::Session(_))
    }
}

impl ArmingEvent {
    /// The end of a permission, for people.
    pub(crate) const fn explanation(self) -> &'static str {
        match self {
            Self::StoodTooLong => "still on the dock after 20 s",
            Self::FellQuiet => "no motion command for 10 s",
            Self::SessionChange => "its session is gone",
            _ => "",
        }
    }

    /// The state that follows.
    const fn next(self, now: ArmingState, holder: Holder) -> ArmingState {
        match (now, self) {
            // The escape depends on the current alone, and on a person who stops it.
            (ArmingState::DockEscape, Self::Stop | Self::Button | Self::EscapeOver) => ArmingState::Locked,
            (ArmingState::DockEscape, _) | (_, Self::EscapeBegins) => ArmingState::DockEscape,
            (_, Self::Undock(_)) => ArmingState::LeavingDock,
            (_, Self::Arm(by)) => by.state(),
            (ArmingState::LeavingDock, Self::Left) => holder.state(),
            // Contacts that bounce on the way out are no arrival.
            (ArmingState::LeavingDock, Self::Arrival | Self::TakenOff) => now,
            (_, Self::Left | Self::EscapeOver) => now,
            (
                _,
                Self::Stop
                | Self::Button
                | Self::SessionChange
                | Self::Arrival
                | Self::TakenOff
                | Self::StoodTooLong
                | Self::FellQuiet,
            ) => ArmingState::Locked,
        }
    }
}

impl Arming {
    /// The present state.
    pub(crate) const fn state(&self) -> ArmingState {
        match self.code {
            ARMED => ArmingState::Armed,
            LEAVING_DOCK => ArmingState::LeavingDock,
            HAND => ArmingState::Hand,
            DOCK_ESCAPE => ArmingState::DockEscape,
            _ => ArmingState::Locked,
        }
    }

    /// Whether nobody may move the robot.
    pub(crate) const fn is_locked(&self) -> bool {
        matches!(self.state(), ArmingState::Locked)
    }

    /// Whether the robot backs off a dock whose current nothing else can stop.
    pub(crate) const fn is_escaping(&self) -> bool {
        matches!(self.state(), ArmingState::DockEscape)
    }

    /// Whether motion is allowed on the dock's contacts.
    pub(crate) const fn may_leave_dock(&self) -> bool {
        matches!(self.state(), ArmingState::LeavingDock | ArmingState::DockEscape)
    }

    /// Whether motion commands of `by` are carried out.
    pub(crate) fn lets_move(&self, by: Holder) -> bool {
        !self.is_locked() && self.holder == by
    }

    /// Takes what has happened.
    pub(crate) fn take(&mut self, event: ArmingEvent, now: Tick) {
        let escapes = self.is_escaping();
        match event {
            ArmingEvent::Stop => self.inhibits.insert(Inhibit::Stopped),
            ArmingEvent::Button => self.inhibits.insert(Inhibit::ButtonStop),
            ArmingEvent::Arm(by) | ArmingEvent::Undock(by) if !escapes => self.give_to(by, now),
            ArmingEvent::EscapeBegins => self.give_to(Holder::Escape, now),
            _ => {}
        }
        self.code = match event.next(self.state(), self.holder) {
            ArmingState::Locked => LOCKED,
            ArmingState::Armed => ARMED,
            ArmingState::LeavingDock => LEAVING_DOCK,
            ArmingState::Hand => HAND,
            ArmingState::DockEscape => DOCK_ESCAPE,
        };
    }

    const fn give_to(&mut self, holder: Holder, now: Tick) {
        self.holder = holder;
        self.armed = now;
        self.renewed = now;
        self.away.restart();
        self.inhibits = Inhibits::NONE;
    }

    /// Lets time pass; returns what has happened by it. The caller takes care of the motion of a permission that ended.
    pub(crate) fn pass(&mut self, facts: ArmingFacts, now: Tick) -> Option<ArmingEvent> {
        let event = self.due(facts, now)?;
        self.take(event, now);
        Some(event)
    }

    fn due(&mut self, facts: ArmingFacts, now: Tick) -> Option<ArmingEvent> {
        let leaving = self.state() == ArmingState::LeavingDock;
        let left = self.away.for_at_least(leaving && !facts.docked, now, LEFT_MS);
        if self.is_locked() || self.is_escaping() {
            return None;
        }
        let expected = match self.holder {
            Holder::Session(number) => number,
            Holder::Typist | Holder::Board | Holder::Escape => 0,
        };
        let quiet = !self.holder.has_session() && now.since(self.renewed) >= QUIET_MS;
        if expected != facts.session {
            Some(ArmingEvent::SessionChange)
        } else if quiet {
            Some(ArmingEvent::FellQuiet)
        } else if leaving && facts.docked && now.since(self.armed) >= LEAVING_MS {
            Some(ArmingEvent::StoodTooLong)
        } else {
            left.then_some(ArmingEvent::Left)
        }
    }

    /// The holder has commanded a motor.
    pub(crate) const fn renew(&mut self, now: Tick) {
        self.renewed = now;
    }

    /// The holder has commanded motion: the link of the wheels is alive.
    pub(crate) const fn hear(&mut self, now: Tick) {
        self.renew(now);
        self.inhibits.remove(Inhibit::LinkLost);
    }

    /// A lease ran out while the robot moved.
    pub(crate) const fn lose_link(&mut self) {
        self.inhibits.insert(Inhibit::LinkLost);
    }

    /// Inhibits that follow.
    pub(crate) const fn inhibits(&self) -> Inhibits {
        let mut inhibits = self.inhibits;
        if self.is_locked() {
            inhibits.insert(Inhibit::NotArmed);
        }
        inhibits
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use std::vec::Vec;

    use super::{
        ARMED, Arming, ArmingEvent, ArmingFacts, DOCK_ESCAPE, HAND, Holder, LEAVING_DOCK, LEAVING_MS,
        LEFT_MS, LOCKED, QUIET_MS,
    };
    use ArmingState::{Armed, DockEscape, Hand, LeavingDock, Locked};
    use rvac_protocol::message::{ArmingState, Inhibit};
    use rvac_units::Tick;

    const HOST: Holder = Holder::Session(7);
    const EVENTS: [ArmingEvent; 14] = [
        ArmingEvent::Arm(HOST),
        ArmingEvent::Arm(Holder::Typist),
        ArmingEvent::Undock(HOST),
        ArmingEvent::Undock(Holder::Typist),
        ArmingEvent::Stop,
        ArmingEvent::Button,
        ArmingEvent::SessionChange,
        ArmingEvent::Arrival,
        ArmingEvent::TakenOff,
        ArmingEvent::Left,
        ArmingEvent::StoodTooLong,
        ArmingEvent::FellQuiet,
        ArmingEvent::EscapeBegins,
        ArmingEvent::EscapeOver,
    ];
    /// The states that follow, in the order of [`EVENTS`]: `.` locked, `A` armed, `L` leaving the dock, `H` hand, `E`
    /// escape. The host holds the permission, in `Hand` the typist.
    const TABLE: [(ArmingState, &str); 5] = [
        (Locked, "AHLL........E."),
        (Armed, "AHLL.....A..EA"),
        (LeavingDock, "AHLL...LLA..EL"),
        (Hand, "AHLL.....H..EH"),
        (DockEscape, "EEEE..EEEEEEE."),
    ];

    fn each_event_in_each_state() -> impl Iterator<Item = (ArmingState, ArmingEvent, ArmingState)> {
        TABLE.into_iter().flat_map(|(state, row)| {
            let after = row.chars().map(|letter| match letter {
                'A' => Armed,
                'L' => LeavingDock,
                'H' => Hand,
                'E' => DockEscape,
                _ => Locked,
            });
            EVENTS
                .into_iter()
                .zip(after)
                .map(move |(event, after)| (state, event, after))
        })
    }

    fn in_state(state: ArmingState, now: Tick) -> Arming {
        let mut arming = Arming::default();
        let event = match state {
            Locked => return arming,
            Armed => ArmingEvent::Arm(HOST),
            LeavingDock => ArmingEvent::Undock(HOST),
            Hand => ArmingEvent::Arm(Holder::Typist),
            DockEscape => ArmingEvent::EscapeBegins,
        };
        arming.take(event, now);
        assert_eq!(arming.state(), state);
        arming
    }

    #[test]
    fn every_event_in_every_state_leads_where_the_table_says() {
        assert_eq!(each_event_in_each_state().count(), 5 * EVENTS.len());
        for (state, event, after) in each_event_in_each_state() {
            let mut arming = in_state(state, Tick(5));
            arming.take(event, Tick(9));
            assert_eq!(arming.state(), after, "{state:?} {event:?}");
            let not_armed = arming.inhibits().contains(Inhibit::NotArmed);
            assert_eq!(not_armed, after == Locked, "{state:?} {event:?}");
        }
    }

    #[test]
    fn only_the_holder_moves_the_robot() {
        let anybody = [
            HOST,
            Holder::Session(8),
            Holder::Typist,
            Holder::Board,
            Holder::Escape,
        ];
        for (state, event, after) in each_event_in_each_state() {
            let mut arming = in_state(state, Tick(0));
            arming.take(event, Tick(0));
            let movers = anybody.iter().filter(|by| arming.lets_move(**by)).count();
            assert_eq!(movers, usize::from(after != Locked), "{state:?} {event:?}");
        }
    }

    #[test]
    fn what_a_stop_and_a_button_leave_behind_ends_with_the_next_arm() {
        for (event, inhibit) in [
            (ArmingEvent::Stop, Inhibit::Stopped),
            (ArmingEvent::Button, Inhibit::ButtonStop),
        ] {
            for (state, _) in TABLE {
                let mut arming = in_state(state, Tick(0));
                arming.lose_link();
                arming.take(event, Tick(0));
                assert!(arming.is_locked() && arming.inhibits().contains(inhibit));
                arming.hear(Tick(0));
                assert!(arming.is_locked() && !arming.inhibits().contains(Inhibit::LinkLost));
                arming.take(ArmingEvent::Arm(HOST), Tick(0));
                assert!(arming.inhibits().is_empty());
            }
        }
    }

    /// Milliseconds until the permission ends by itself or changes, and the event; starts around the wrap of the clock.
    fn change_after(mut arming: Arming, start: Tick, facts: ArmingFacts) -> Option<(u32, ArmingEvent)> {
        (0..60_000).find_map(|ms| Some((ms, arming.pass(facts, start.after(ms))?)))
    }

    #[test]
    fn each_permission_ends_in_its_time() {
        use ArmingEvent::{Arm, EscapeBegins, FellQuiet, Left, SessionChange, StoodTooLong, Undock};
        let home = |session| ArmingFacts {
            docked: true,
            session,
        };
        let away = |session| ArmingFacts {
            docked: false,
            session,
        };
        let start = Tick(u32::MAX - 3_000);
        let table = [
            (Arm(HOST), away(7), None),
            (Arm(HOST), away(8), Some((0, SessionChange))),
            (Arm(HOST), away(0), Some((0, SessionChange))),
            (Undock(HOST), home(0), Some((0, SessionChange))),
            (Undock(HOST), home(7), Some((LEAVING_MS, StoodTooLong))),
            (Undock(HOST), away(7), Some((LEFT_MS, Left))),
            (Undock(Holder::Typist), home(0), Some((QUIET_MS, FellQuiet))),
            (Arm(Holder::Typist), away(0), Some((QUIET_MS, FellQuiet))),
            (Arm(Holder::Typist), away(7), Some((0, SessionChange))),
            (Arm(Holder::Board), away(0), Some((QUIET_MS, FellQuiet))),
            (EscapeBegins, home(7), None),
            (EscapeBegins, home(0), None),
        ];
        for (event, facts, expected) in table {
            let mut arming = Arming::default();
            arming.take(event, start);
            assert_eq!(change_after(arming, start, facts), expected, "{event:?}");
        }
    }

    #[test]
    fn motion_keeps_a_typist_and_holds_no_robot_on_its_dock() {
        let mut arming = in_state(Hand, Tick(0));
        let away = ArmingFacts {
            docked: false,
            session: 0,
        };
        for ms in 0..60_000 {
            assert_eq!(arming.pass(away, Tick(ms)), None);
            if ms % (QUIET_MS - 1) == 0 {
                arming.renew(Tick(ms));
            }
        }
        let mut arming = in_state(LeavingDock, Tick(0));
        let home = ArmingFacts {
            docked: true,
            session: 7,
        };
        let ended = (0..60_000).find(|ms| {
            arming.renew(Tick(*ms));
            arming.pass(home, Tick(*ms)).is_some()
        });
        assert_eq!(ended, Some(LEAVING_MS));
    }

    #[test]
    fn no_flip_of_fewer_than_sixteen_bits_gives_or_widens_a_permission() {
        let codes = [ARMED, LEAVING_DOCK, HAND, DOCK_ESCAPE, LOCKED];
        let distances: Vec<u32> = codes
            .iter()
            .flat_map(|one| codes.iter().map(move |other| (one ^ other).count_ones()))
            .collect();
        assert!(
            distances.iter().all(|bits| *bits == 0 || *bits >= 16),
            "{distances:?}"
        );
        for (state, _) in TABLE {
            for bit in 0..32 {
                let mut arming = in_state(state, Tick(0));
                arming.code ^= 1 << bit;
                assert!(arming.is_locked(), "{state:?} {bit}");
            }
        }
    }
}
