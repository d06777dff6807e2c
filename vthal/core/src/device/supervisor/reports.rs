//! What the robot tells, as far as it concerns every make: lost words are repeated, and reports get what the robot itself does
//! not tell.

use brain::Inhibit;

use super::super::reflex::{HostReflexes, speed_limit_m_per_s};
use super::super::{CleanerDrive, DeadManKind, Description, DeviceEvent, DeviceIo, Report, StopSite};
use super::Supervisor;

/// Telemetry has had the time to know of a stop after this long.
const STOP_REPEAT_US: u64 = 200_000;

/// The name of the refusal of a command that was too old.
const STALE: &str = "stale";

/// What the reports of one chunk of bytes ask for.
#[derive(Clone, Copy, Debug, Default)]
struct Heard {
    /// A report knows nothing of the emergency stop, if there was one.
    knows_no_stop: bool,
    /// A wheel turns.
    turns: bool,
    /// A reflex of the host holds something new.
    is_held: bool,
}

impl Supervisor {
    /// What of the events since `before` concerns every make.
    pub(super) fn note(&mut self, before: usize, io: &mut DeviceIo<'_>) {
        let mut heard = Heard::default();
        for event in io.events.iter_mut().skip(before) {
            match event {
                DeviceEvent::Described(description) => self.described(description),
                DeviceEvent::Report(report) => self.take_report(report, &mut heard),
                DeviceEvent::Opened(_) | DeviceEvent::Closed => {
                    self.duties.forget_commands();
                    self.duties.in_control = false;
                    self.watch.rebase();
                    self.latches.rebase();
                    self.judge.restart(io.now_us);
                }
                DeviceEvent::Refused { reason: STALE, .. } => self.judge.refused_as_stale(io.now_us),
                DeviceEvent::ControlLost(_) => self.duties.in_control = false,
                _ => {}
            }
        }
        self.answer(heard, io);
    }

    fn described(&mut self, description: &mut Description) {
        let speed_max_m_per_s = &mut description.drive.speed_max_m_per_s;
        *speed_max_m_per_s = speed_max_m_per_s.min(speed_limit_m_per_s(description.reflexes));
        self.duties.reflexes = HostReflexes::of(description);
        self.duties.description = Some(description.clone());
    }

    /// Adds to a report what the robot itself does not tell.
    fn take_report(&mut self, report: &mut Report, heard: &mut Heard) {
        let now_us = self.duties.now_us;
        let described = self.duties.description.as_ref();
        let stop = described.map_or(StopSite::Device, |description| description.stop);
        if let Some(description) = described {
            self.watch.take(now_us, report, description.odometry);
        }
        if let Some(reflexes) = &mut self.duties.reflexes {
            heard.is_held |= reflexes.take(now_us, report);
        }
        if let Some(description) = described {
            let watched = (description.reflexes, self.duties.in_control);
            heard.is_held |= self.latches.take(now_us, report, watched);
        }
        heard.turns |= self.watch.turned();
        match stop {
            StopSite::Device => heard.knows_no_stop |= !report.inhibits.contains(Inhibit::Stopped),
            StopSite::Host => {
                heard.knows_no_stop |= self.watch.turned();
                if self.duties.stop_sent_us.is_some() {
                    report.inhibits.insert(Inhibit::Stopped);
                }
            }
        }
    }

    /// Does at once what the reports ask for.
    fn answer(&mut self, heard: Heard, io: &mut DeviceIo<'_>) {
        if heard.is_held {
            self.duties.dead_man.repeat_now();
            // As in `renew`.
            self.renew_wheels(io).ok();
            if self.is_lifted() || self.latches.any() {
                self.set_cleaners(CleanerDrive::Off, io).ok();
            }
        }
        if heard.knows_no_stop {
            self.repeat_lost_stop(io);
        }
        if heard.turns {
            self.repeat_lost_stand(io);
        }
    }

    /// A stop is not acknowledged: telemetry that does not know of it means that it was lost on the wire.
    fn repeat_lost_stop(&mut self, io: &mut DeviceIo<'_>) {
        let sent_us = self.duties.stop_sent_us;
        if sent_us.is_some_and(|sent_us| io.now_us >= sent_us + STOP_REPEAT_US) {
            self.duties.stop_sent_us = Some(io.now_us);
            self.device.stop(io);
        }
    }

    /// A robot that would drive for ever, and still turns its wheels though its command has ended, has not heard of that.
    fn repeat_lost_stand(&mut self, io: &mut DeviceIo<'_>) {
        let kind = self.description().map(|description| description.drive.dead_man);
        let keeps_driving = matches!(kind, Some(DeadManKind::None | DeadManKind::Distance));
        let ended = self.duties.in_control && self.duties.dead_man.setpoint().is_none();
        let stood_us = self.duties.stood_us;
        if keeps_driving && ended && stood_us.is_none_or(|stood_us| io.now_us >= stood_us + STOP_REPEAT_US) {
            self.stand(io).ok();
        }
    }
}
