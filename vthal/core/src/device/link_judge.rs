//! Judges whether the link to the robot can be relied upon, for every make.
//!
//! What counts is not how much is bad on the line but whether sound reports come: undamaged, newer than all before, and soon
//! enough one after the other. While they do the robot drives, whatever else comes. When they do not, the fault has the name
//! of what came in their place, the robot stands, and it goes on by itself when sound reports have come for a while again. A
//! fault that comes back soon must stay away for longer, so that a link that changes all the time does not make the robot
//! start and stop all the time. Silence is no fault of this list: it has a name of its own, `link-lost`.

use brain::LinkFault;

use super::{Arrivals, LinkQuality};

/// Sound reports farther apart than a freshness divided by this halve the speed: the robot makes up to 3 cm meanwhile.
const STEADY_PARTS: u64 = 3;
/// The longest pause between reports is that of the last one to two of these.
const SLICE_US: u64 = 1_000_000;
/// So many other things in the place of reports tell what is wrong; fewer may come with a cable that is pulled.
const EVIDENCE_MIN: u32 = 3;
/// Until a robot has described itself, sound reports may take so long.
const FIRST_REPORT_US: u64 = 2_000_000;
/// When nothing at all has come for so long the link is silent, whatever was wrong with it before.
const SILENT_US: u64 = 2_000_000;
/// Reports that are too far apart twice within this time are late; once, the link was silent for a moment.
const LATE_AGAIN_US: u64 = 5_000_000;
/// Sound reports come for so long before the robot goes on.
const HEALED_US: u64 = 1_000_000;
/// A fault that comes back within this time must stay away for twice as long as before,
const RELAPSE_US: u64 = 10_000_000;
/// but no longer than this.
const HEALED_MAX_US: u64 = 8_000_000;
/// So many commands that are refused as too old within [`SLICE_US`] are a fault: those of a third of a second.
const STALE_MAX: u32 = 10;
/// A greater share of damaged commands halves the speed,
const LOST_POOR: f64 = 0.2;
/// and with a greater one than this leases end again and again.
const LOST_BAD: f64 = 0.67;

/// A fault began or is over. One that comes back soon is not told again.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum LinkNews {
    /// It began.
    Began(LinkFault),
    /// It is over and has not come back.
    Ended(Episode),
}

/// A fault from when it began until it was over for good.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Episode {
    pub(crate) fault: LinkFault,
    /// How often the robot stood for it.
    pub(crate) times: u32,
    since_us: u64,
    until_us: u64,
    /// Totals when it began.
    before: Arrivals,
    /// What came meanwhile.
    pub(crate) arrivals: Arrivals,
}

impl Episode {
    /// How long it lasted, seconds.
    pub(crate) const fn lasted_s(&self) -> f64 {
        self.until_us.saturating_sub(self.since_us) as f64 * 1e-6
    }
}

/// The judge of one link.
#[derive(Debug, Default)]
pub(super) struct LinkJudge {
    /// At the last look, and at the newest sound report.
    seen: Arrivals,
    reported: Arrivals,
    /// When anything came.
    heard_us: u64,
    /// The newest sound report since the line was opened or the session began, and since when they come soon enough.
    reported_us: Option<u64>,
    sound_since_us: u64,
    opened_us: u64,
    pauses: Pauses,
    /// The end of the last silence.
    silence_ended_us: Option<u64>,
    stale: StaleCommands,
    lost_share: f64,
    standing: Option<LinkFault>,
    /// The last fault, until it is over for good.
    episode: Option<Episode>,
    ended_us: Option<u64>,
    healed_after_us: u64,
    news: Vec<LinkNews>,
}

/// The longest pause between two sound reports, in this slice of time and the one before.
#[derive(Clone, Copy, Debug, Default)]
struct Pauses {
    since_us: u64,
    longest_us: u64,
    before_us: u64,
}

/// Commands that the robot refused as too old.
#[derive(Clone, Copy, Debug, Default)]
struct StaleCommands {
    since_us: u64,
    count: u32,
}

impl LinkJudge {
    /// The line was opened: all totals begin anew.
    pub(super) fn open(&mut self, now_us: u64) {
        self.seen = Arrivals::default();
        self.restart(now_us);
    }

    /// A session began or ended: what came before says nothing about what comes. A fault that stands goes on.
    pub(super) const fn restart(&mut self, now_us: u64) {
        self.reported_us = None;
        self.reported = self.seen;
        self.opened_us = now_us;
        self.heard_us = now_us;
    }

    /// The robot has refused a command because it was too old.
    pub(super) fn refused_as_stale(&mut self, now_us: u64) {
        if now_us.saturating_sub(self.stale.since_us) > SLICE_US {
            self.stale = StaleCommands {
                since_us: now_us,
                count: 0,
            };
        }
        self.stale.count = self.stale.count.saturating_add(1);
        if self.stale.count >= STALE_MAX {
            self.stale.count = 0;
            self.stand(now_us, LinkFault::CommandsStale);
        }
    }

    /// Looks at the link; a report is fresh for `fresh_us`, if the robot has described itself.
    pub(super) fn look(&mut self, now_us: u64, quality: LinkQuality, fresh_us: Option<u64>) {
        let new = quality.arrivals.since(self.seen);
        self.seen = quality.arrivals;
        if new != Arrivals::default() {
            self.heard_us = now_us;
        }
        self.lost_share = quality.lost_share;
        if now_us.saturating_sub(self.heard_us) > SILENT_US {
            self.reported = self.seen;
            self.end(now_us);
        } else {
            self.judge(now_us, new, fresh_us.unwrap_or(FIRST_REPORT_US));
        }
        self.close_episode(now_us);
    }

    fn judge(&mut self, now_us: u64, new: Arrivals, fresh_us: u64) {
        if new.reports > 0 {
            self.take_report(now_us, new, fresh_us);
        } else if self.pause_us(now_us) > fresh_us
            && let Some(fault) = cause(self.seen.since(self.reported))
        {
            self.stand(now_us, fault);
        }
        if self.lost_share > LOST_BAD && self.reported_us.is_some() {
            self.stand(now_us, LinkFault::CommandsLost);
        }
        let is_sound = self.reported_us.is_some()
            && self.pause_us(now_us) <= fresh_us
            && now_us.saturating_sub(self.sound_since_us) >= self.healed_after_us;
        if is_sound {
            self.end(now_us);
        }
    }

    /// The fault that stands.
    pub(super) const fn fault(&self) -> Option<LinkFault> {
        self.standing
    }

    /// Share of its speed that the robot may drive at.
    pub(super) fn speed_share(&self, fresh_us: u64) -> f64 {
        let is_steady = self.pauses.longest_us().saturating_mul(STEADY_PARTS) <= fresh_us;
        if is_steady && self.lost_share <= LOST_POOR {
            1.0
        } else {
            0.5
        }
    }

    /// What began or ended since the last call.
    pub(super) fn take_news(&mut self) -> Vec<LinkNews> {
        core::mem::take(&mut self.news)
    }

    fn pause_us(&self, now_us: u64) -> u64 {
        now_us.saturating_sub(self.reported_us.unwrap_or(self.opened_us))
    }

    fn take_report(&mut self, now_us: u64, new: Arrivals, fresh_us: u64) {
        match self.reported_us {
            None => self.sound_since_us = now_us,
            Some(_) => {
                let pause_us = self.pause_us(now_us);
                self.pauses.note(now_us, pause_us);
                if pause_us > fresh_us {
                    self.end_pause(now_us);
                }
            }
        }
        if new.clock_jumps > 0 {
            self.stand(now_us, LinkFault::ClockJumped);
        }
        self.reported_us = Some(now_us);
        self.reported = self.seen;
    }

    /// A sound report comes after a pause in which there were none for too long.
    fn end_pause(&mut self, now_us: u64) {
        self.sound_since_us = now_us;
        let is_again = |ended_us: u64| now_us.saturating_sub(ended_us) <= LATE_AGAIN_US;
        match cause(self.seen.since(self.reported)) {
            Some(fault) => self.stand(now_us, fault),
            None => {
                if self.silence_ended_us.replace(now_us).is_some_and(is_again) {
                    self.stand(now_us, LinkFault::Late);
                }
            }
        }
    }

    fn stand(&mut self, now_us: u64, fault: LinkFault) {
        self.sound_since_us = now_us;
        if self.standing.is_some() {
            return;
        }
        let is_relapse = self
            .ended_us
            .is_some_and(|ended_us| now_us.saturating_sub(ended_us) <= RELAPSE_US);
        self.healed_after_us = match is_relapse {
            true => self.healed_after_us.saturating_mul(2).min(HEALED_MAX_US),
            false => HEALED_US,
        };
        self.standing = Some(fault);
        match &mut self.episode {
            Some(episode) if episode.fault == fault => episode.times = episode.times.saturating_add(1),
            _ => self.begin_episode(now_us, fault),
        }
    }

    fn begin_episode(&mut self, now_us: u64, fault: LinkFault) {
        let episode = Episode {
            fault,
            times: 1,
            since_us: now_us,
            until_us: now_us,
            before: self.seen,
            arrivals: Arrivals::default(),
        };
        let last = self.episode.replace(episode);
        self.news.extend(last.map(LinkNews::Ended));
        self.news.push(LinkNews::Began(fault));
    }

    /// The fault that stands, if any, is over.
    fn end(&mut self, now_us: u64) {
        if self.standing.take().is_none() {
            return;
        }
        self.ended_us = Some(now_us);
        if let Some(episode) = &mut self.episode {
            episode.until_us = now_us;
            episode.arrivals = self.seen.since(episode.before);
        }
    }

    fn close_episode(&mut self, now_us: u64) {
        let is_over = |episode: &mut Episode| now_us.saturating_sub(episode.until_us) > RELAPSE_US;
        if self.standing.is_none() {
            self.news
                .extend(self.episode.take_if(is_over).map(LinkNews::Ended));
        }
    }
}

impl Pauses {
    fn note(&mut self, now_us: u64, pause_us: u64) {
        if now_us.saturating_sub(self.since_us) >= SLICE_US {
            *self = Self {
                since_us: now_us,
                longest_us: 0,
                before_us: self.longest_us,
            };
        }
        self.longest_us = self.longest_us.max(pause_us);
    }

    fn longest_us(self) -> u64 {
        self.longest_us.max(self.before_us)
    }
}

/// What came in the place of sound reports: if other reports did, the robot's clock is wrong.
fn cause(missed: Arrivals) -> Option<LinkFault> {
    let is_evidence = |count: u32| count >= EVIDENCE_MIN;
    if is_evidence(missed.repeated) && missed.repeated >= missed.stray {
        Some(LinkFault::ClockFrozen)
    } else if is_evidence(missed.stray) {
        Some(LinkFault::ClockJumped)
    } else if is_evidence(missed.corrupted) && missed.corrupted >= missed.garbled {
        Some(LinkFault::Corrupted)
    } else if is_evidence(missed.garbled) {
        Some(LinkFault::Garbled)
    } else {
        None
    }
}

#[cfg(test)]
mod tests;
