//! Motion that the host has allowed, by the bytes on the wire.

use rvac_protocol::message::ResetCause;

use super::causes::{CauseTimes, Drives};
use super::limits::{
    DOCKED_MS, FRESH_MS, HAND_LEASE_MS, HAND_QUIET_MS, LEAVING_MS, RESET_WINDOW_MS, SILENCE_MS,
};
use super::said::{Heard, Said, read_heard, read_said};
use super::told::{Told, read_told};
use super::wire::Splitter;

/// S1: each motor is off 50 ms after its lease at the latest.
const LEASE_GRACE_MS: u64 = 50;
/// `stop`, the end of a session, and a late packet of the same millisecond.
const STOP_GRACE_MS: u64 = 20;
/// The firmware's clock may begin any of the longer times this much later.
const CLOCK_GRACE_MS: u64 = 200;
/// A button counts as pressed when it is down for this long: shorter is noise.
const BUTTON_HELD_MS: u32 = 20;
/// Being off the dock for this long ends what an undock command allowed.
const UNDOCKED_MS: u32 = 3_000;
/// Contacts that bounce open for less still hold the robot on its dock (S19), and debouncing takes its time.
const BOUNCE_MS: u32 = 400;
/// A robot answers an `arm` within this. A later refusal with its number is of another packet: numbers come round after
/// 65,536.
const ANSWER_MS: u64 = 1_000;
/// So many `arm`s may be on their way at once; a host that sends more is not understood.
const UNANSWERED_MAX: usize = 8;

/// Whether motion is armed, and what revokes that (SPEC.md section 4).
#[derive(Clone, Copy, Debug, Default)]
struct Arming {
    armed: bool,
    since_ms: u64,
    /// Armed by a packet without a session.
    typed: bool,
    /// The newest typed packet that arms or moves.
    typed_ms: u64,
    /// Motors must be off from here on: the permission has ended.
    off_ms: Option<u64>,
    /// Motors must be off from here on for a button, without the reaction time.
    button_ms: Option<u64>,
    undock: bool,
    number: Option<u16>,
}

impl Arming {
    fn lasts(&self, now_ms: u64) -> bool {
        self.armed && self.off_ms.is_none_or(|until| now_ms <= until)
    }

    /// Motors must be off from this time on, or from an earlier one that is known already.
    fn end(&mut self, off_ms: u64) {
        self.off_ms = Some(self.off_ms.map_or(off_ms, |known| known.min(off_ms)));
    }
}

/// Permissions given by the host.
#[derive(Clone, Debug, Default)]
pub(crate) struct HostPermission {
    to_robot: Splitter,
    from_robot: Splitter,
    session: u16,
    /// Session in which the present packet began.
    packet_session: u16,
    /// Newest valid packet with a CRC of the session; `None` = hand mode since the reset or by command.
    checked_ms: Option<u64>,
    reset_ms: u64,
    /// The firmware's clock began to count between the reset and this.
    clock_ms: u64,
    arming: Arming,
    /// States to which refused `arm`s return, the oldest first: more than one may be on its way.
    before: Vec<Arming>,
    newest_motion: Option<u16>,
    /// Ends of the leases of left and right wheel.
    wheels_until_ms: [u64; 2],
    /// Ends of the leases of main brush, side brushes and suction.
    cleaners_until_ms: [u64; 3],
    /// Times of the newest three resets other than power-on.
    resets_ms: [Option<u64>; 3],
    asked: AskedSpeed,
    /// For how long the contacts have been open.
    away_ms: u32,
    motors_ran: bool,
    button_while_running: bool,
}

/// The fastest rim that was asked for of late: a wheel needs its time to slow down.
#[derive(Clone, Copy, Debug, Default)]
struct AskedSpeed {
    /// In the present period and in the one before, mm/s.
    fastest: [i32; 2],
    period_end_ms: u64,
    /// Something was asked for until then that has no speed.
    any_until_ms: u64,
}

impl AskedSpeed {
    const PERIOD_MS: u64 = 1_500;

    fn take(&mut self, now_ms: u64, lease_ms: u64, rim_mm_per_s: Option<i32>) {
        self.pass(now_ms);
        match rim_mm_per_s {
            Some(rim) => self.fastest[0] = self.fastest[0].max(rim),
            None => self.any_until_ms = now_ms + lease_ms + Self::PERIOD_MS,
        }
    }

    fn pass(&mut self, now_ms: u64) {
        if now_ms >= self.period_end_ms {
            self.fastest = [0, self.fastest[0]];
            self.period_end_ms = now_ms + Self::PERIOD_MS;
        }
    }

    fn most_mm_per_s(&self, now_ms: u64) -> Option<i32> {
        (now_ms > self.any_until_ms).then_some(self.fastest[0].max(self.fastest[1]))
    }
}

impl HostPermission {
    pub(crate) fn heard(&mut self, now_ms: u64, byte: Option<u8>) {
        // A packet belongs to the session in which it began, even if silence ends that meanwhile.
        if self.to_robot.is_between_packets() {
            self.packet_session = self.session;
        }
        let session = self.packet_session;
        let Some(heard) = self
            .to_robot
            .push(byte)
            .and_then(|packet| read_heard(packet, session))
        else {
            return;
        };
        // Without a session a CRC is optional and makes no host.
        let checked = heard.checked && session != 0;
        if checked {
            self.checked_ms = Some(now_ms);
        } else if !self.hand(now_ms) && heard.word != Heard::Stop {
            return;
        }
        if !checked && heard.word.moves() {
            self.arming.typed_ms = now_ms;
        }
        self.obey(now_ms, heard.word, checked);
    }

    fn hand(&self, now_ms: u64) -> bool {
        self.session == 0
            || self
                .checked_ms
                .is_none_or(|checked| now_ms > checked + SILENCE_MS)
    }

    fn obey(&mut self, now_ms: u64, word: Heard, checked: bool) {
        match word {
            Heard::Stop => self.arming.end(now_ms + STOP_GRACE_MS),
            Heard::Hand => {
                if checked {
                    self.arming.end(now_ms + STOP_GRACE_MS);
                }
                self.session = 0;
                self.checked_ms = None;
            }
            // A host's arm without a number is refused, and the number of a typed one means nothing.
            Heard::Arm { number, undock } if !checked || number.is_some() => self.arm(
                now_ms,
                Arming {
                    // A robot that stands elsewhere has no dock to leave.
                    undock: undock && self.away_ms <= BOUNCE_MS,
                    number: number.filter(|_| checked),
                    typed: !checked,
                    ..Arming::default()
                },
            ),
            Heard::Clear => self.resets_ms = [None; 3],
            Heard::Wheels {
                wheels,
                lease_ms,
                mark,
                rim_mm_per_s,
            } if self.is_fresh(now_ms, mark) => {
                self.asked.take(now_ms, lease_ms, rim_mm_per_s);
                let until_ms = now_ms
                    + if checked {
                        lease_ms
                    } else {
                        lease_ms.min(HAND_LEASE_MS)
                    };
                for (end_ms, covered) in self.wheels_until_ms.iter_mut().zip(wheels) {
                    if covered {
                        *end_ms = until_ms;
                    }
                }
            }
            Heard::Cleaner {
                cleaner,
                lease_ms,
                mark,
            } if self.is_fresh(now_ms, mark) => {
                if let Some(end_ms) = self.cleaners_until_ms.get_mut(cleaner) {
                    *end_ms = now_ms + lease_ms;
                }
            }
            Heard::Arm { .. } | Heard::Wheels { .. } | Heard::Cleaner { .. } | Heard::Other => {}
        }
    }

    fn arm(&mut self, now_ms: u64, arming: Arming) {
        if !arming.typed && arming.number == self.arming.number {
            return;
        }
        if self.before.len() == UNANSWERED_MAX {
            self.before.remove(0);
        }
        self.before.push(self.arming);
        self.arming = Arming {
            armed: true,
            since_ms: now_ms,
            typed_ms: now_ms,
            ..arming
        };
    }

    /// S3: not older than 400 ms, and newer than the newest motion of this session.
    fn is_fresh(&mut self, now_ms: u64, mark: super::said::Mark) -> bool {
        if let Some(tick) = mark.tick {
            let age = |since_ms| (now_ms.saturating_sub(since_ms) as u32).wrapping_sub(tick) as i32;
            // Neither older than the youngest it can be, nor younger than the oldest.
            if age(self.clock_ms) > FRESH_MS || age(self.reset_ms) < 0 {
                return false;
            }
        }
        if let (Some(number), Some(newest)) = (mark.number, self.newest_motion) {
            let ahead = number.wrapping_sub(newest);
            if ahead == 0 || ahead >= 0x8000 {
                return false;
            }
        }
        self.newest_motion = mark.number.or(self.newest_motion);
        true
    }

    /// Takes a byte of the robot; returns what it tells about itself.
    pub(crate) fn said(&mut self, now_ms: u64, byte: u8) -> Option<Told> {
        let session = self.session;
        let packet = self.from_robot.push(Some(byte))?;
        let (said, told) = (read_said(packet, session), read_told(packet, session));
        self.note(now_ms, said);
        told
    }

    fn note(&mut self, now_ms: u64, said: Option<Said>) {
        match said {
            Some(Said::Session(number)) if number != self.session => {
                self.session = number;
                self.checked_ms = Some(now_ms);
                self.newest_motion = None;
                self.arming.number = None;
                self.arming.end(now_ms + STOP_GRACE_MS);
            }
            Some(Said::Refused(number))
                if self.arming.number == Some(number) && now_ms <= self.arming.since_ms + ANSWER_MS =>
            {
                self.arming = Arming {
                    number: Some(number),
                    ..self.before.pop().unwrap_or_default()
                };
            }
            Some(Said::Refused(number)) => self
                .before
                .retain(|arming| arming.number != Some(number) || now_ms > arming.since_ms + ANSWER_MS),
            _ => {}
        }
    }

    pub(crate) fn reset(&mut self, now_ms: u64, cause: ResetCause) {
        self.session = 0;
        self.checked_ms = None;
        self.reset_ms = now_ms;
        self.clock_ms = now_ms;
        self.arming = Arming::default();
        self.before.clear();
        self.newest_motion = None;
        self.wheels_until_ms = [0; 2];
        self.cleaners_until_ms = [0; 3];
        self.to_robot = Splitter::default();
        self.from_robot = Splitter::default();
        if cause == ResetCause::PowerOn {
            self.resets_ms = [None; 3];
        } else {
            self.resets_ms.rotate_right(1);
            self.resets_ms[0] = Some(now_ms);
        }
    }

    pub(crate) fn clock_started(&mut self, now_ms: u64) {
        self.clock_ms = now_ms;
    }

    /// The fastest rim that was asked for, mm/s; `None` = any.
    pub(crate) fn asked_mm_per_s(&self, now_ms: u64) -> Option<i32> {
        self.asked.most_mm_per_s(now_ms)
    }

    pub(crate) fn update(&mut self, now_ms: u64, standing: &CauseTimes) {
        self.asked.pass(now_ms);
        self.away_ms = standing.undocked_ms;
        if standing.button_ms == 1 {
            self.button_while_running = self.motors_ran;
        }
        self.motors_ran = standing.motors_run;
        if standing.button_ms == BUTTON_HELD_MS && self.button_while_running {
            let pressed_ms = now_ms - u64::from(BUTTON_HELD_MS);
            if self.arming.since_ms < pressed_ms {
                self.arming.button_ms = Some(pressed_ms);
            }
        }
        // A robot that was told to leave though it stood elsewhere has left after the same time.
        if standing.undocked_ms > UNDOCKED_MS && now_ms > self.arming.since_ms + u64::from(UNDOCKED_MS) {
            self.arming.undock = false;
        }
        if self.has_run_out(now_ms, standing) {
            self.arming.end(now_ms);
        }
    }

    /// Silence of the host or of the person who types, an arrival at the dock, or a robot that does not leave it.
    fn has_run_out(&self, now_ms: u64, standing: &CauseTimes) -> bool {
        let Arming {
            typed,
            typed_ms,
            undock,
            since_ms,
            ..
        } = self.arming;
        let heard_ms = if typed {
            typed_ms + HAND_QUIET_MS + CLOCK_GRACE_MS
        } else {
            self.checked_ms.unwrap_or(0) + SILENCE_MS + LEASE_GRACE_MS
        };
        let at_dock = if undock {
            standing.docked_ms > 0 && now_ms > since_ms + LEAVING_MS + CLOCK_GRACE_MS
        } else {
            standing.docked_ms > DOCKED_MS
        };
        now_ms > heard_ms || at_dock
    }

    /// Whether nobody may move the robot, or somebody may from this millisecond on.
    pub(crate) fn rests(&self, now_ms: u64) -> bool {
        let Arming {
            armed,
            since_ms,
            off_ms,
            button_ms,
            ..
        } = self.arming;
        !armed || now_ms <= since_ms + 1 || off_ms.is_some() || button_ms.is_some()
    }

    pub(crate) fn armed(&self, now_ms: u64) -> bool {
        self.in_force(now_ms).any(|arming| arming.lasts(now_ms))
    }

    /// The newest `arm`, and while the robot may not have read it yet, the one before.
    fn in_force(&self, now_ms: u64) -> impl Iterator<Item = &Arming> {
        let is_fresh = now_ms <= self.arming.since_ms + STOP_GRACE_MS;
        let earlier = self.before.last().filter(|_| is_fresh);
        core::iter::once(&self.arming).chain(earlier)
    }

    /// How long ago a button stopped the robot, if nobody has armed since.
    pub(crate) fn button_age_ms(&self, now_ms: u64) -> Option<u64> {
        self.arming
            .button_ms
            .map(|pressed| now_ms.saturating_sub(pressed))
    }

    pub(crate) fn may_undock(&self, now_ms: u64) -> bool {
        self.in_force(now_ms)
            .any(|arming| arming.undock && arming.lasts(now_ms))
    }

    /// Whether a lease covers each wheel that is driven.
    pub(crate) fn covers_wheels(&self, now_ms: u64, drives: &Drives) -> bool {
        are_covered(now_ms, self.wheels_until_ms, drives.wheels)
    }

    /// Whether a lease covers each brush that is driven, and the suction.
    pub(crate) fn covers_cleaners(&self, now_ms: u64, drives: &Drives) -> bool {
        are_covered(now_ms, self.cleaners_until_ms, drives.cleaners)
    }

    /// Three resets within a minute, the last of them the present start.
    pub(crate) fn reset_loop(&self) -> bool {
        matches!(self.resets_ms, [Some(newest), _, Some(oldest)] if newest - oldest < RESET_WINDOW_MS)
    }
}

fn are_covered<const N: usize>(now_ms: u64, until_ms: [u64; N], drives: [i32; N]) -> bool {
    until_ms
        .into_iter()
        .zip(drives)
        .all(|(until_ms, drive)| drive == 0 || now_ms <= until_ms + LEASE_GRACE_MS)
}
