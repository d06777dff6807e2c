//! Telemetry: `state` and `info` at their periods, events when something changes, log lines when there are any.

use rvac_protocol::message::{Bumpers, Cliffs, Event, Info, Inhibits, LogLevel, Report, State, WheelDrops};
use rvac_protocol::session::Mode;
use rvac_units::Tick;

use crate::board::{DockBeams, DustBox, Parts, ProximitySensors};
use crate::cord::Cord;
use crate::identity::name;
use crate::rate::RateCounter;
use crate::reflex::Reflexes;
use crate::senses::shown;
use crate::timing::Periodic;

const STATE_PERIOD_MS: u32 = 20;
const INFO_PERIOD_MS: u32 = 1_000;
const RATE_PERIOD_MS: u32 = 1_000;
/// Version of this crate, for `info`.
const VERSION: &str = env!("CARGO_PKG_VERSION");

/// What was reported last, what is due, and the counters of the loop.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reporter {
    pub(crate) bytes_in: RateCounter,
    pub(crate) bytes_out: RateCounter,
    steps: RateCounter,
    rates: Periodic,
    state: ReportSchedule,
    info: ReportSchedule,
    reported: ReportedFacts,
}

/// One kind of report: its period (0 = only on request) and whether one waits for the link.
#[derive(Clone, Copy, Debug)]
struct ReportSchedule {
    period_ms: u32,
    next: Periodic,
    waits: bool,
}

/// The facts whose changes are reported as events.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct ReportedFacts {
    bumpers: Bumpers,
    cliffs: Cliffs,
    wheel_drops: WheelDrops,
    docked: bool,
    inhibits: Inhibits,
}

impl ReportSchedule {
    const fn every(period_ms: u32, now: Tick) -> Self {
        Self {
            period_ms,
            next: Periodic::starting_at(now.after(period_ms)),
            waits: false,
        }
    }

    const fn update(&mut self, now: Tick) {
        if self.period_ms > 0 && self.next.is_due(now, self.period_ms) {
            self.waits = true;
        }
    }

    const fn take(&mut self) -> bool {
        core::mem::replace(&mut self.waits, false)
    }
}

impl ReportedFacts {
    fn of(reflexes: &Reflexes) -> Self {
        Self {
            bumpers: reflexes.bumpers(),
            cliffs: reflexes.cliffs(),
            wheel_drops: reflexes.wheel_drops(),
            docked: reflexes.dock.is_docked(),
            inhibits: reflexes.inhibits(),
        }
    }
}

impl Reporter {
    /// Nothing is due yet. The state at reset is no event.
    pub(crate) fn new(reflexes: &Reflexes, now: Tick) -> Self {
        Self {
            bytes_in: RateCounter::starting_at(now),
            bytes_out: RateCounter::starting_at(now),
            steps: RateCounter::starting_at(now),
            rates: Periodic::starting_at(now.after(RATE_PERIOD_MS)),
            state: ReportSchedule::every(STATE_PERIOD_MS, now),
            info: ReportSchedule::every(INFO_PERIOD_MS, now),
            reported: ReportedFacts::of(reflexes),
        }
    }

    /// One `info` was asked for.
    pub(crate) const fn want_info(&mut self) {
        self.info.waits = true;
    }

    /// One `state` was asked for.
    pub(crate) const fn want_state(&mut self) {
        self.state.waits = true;
    }

    /// Changes the pause between `state` reports; 0 = only when asked.
    pub(crate) const fn set_state_period(&mut self, period_ms: u32, now: Tick) {
        self.state = ReportSchedule::every(period_ms, now);
    }

    /// Changes the pause between `info` reports; 0 = only when asked.
    pub(crate) const fn set_info_period(&mut self, period_ms: u32, now: Tick) {
        self.info = ReportSchedule::every(period_ms, now);
    }

    /// Counts a pass that reports nothing.
    pub(crate) const fn count_pass(&mut self) {
        self.steps.add(1);
    }

    /// Counts a pass and notes what is due. In hand mode there is no unrequested `state`.
    fn tick(&mut self, mode: Mode, now: Tick) {
        self.steps.add(1);
        if self.rates.is_due(now, RATE_PERIOD_MS) {
            self.steps.take(now);
            self.bytes_in.take(now);
            self.bytes_out.take(now);
        }
        self.info.update(now);
        if mode == Mode::Checked {
            self.state.update(now);
        }
    }
}

impl<P: Parts> Cord<P> {
    /// Queues an event for every fact that has changed since it was reported.
    pub(crate) fn queue_events(&mut self, now: Tick) {
        let reported = self.reporter.reported;
        let facts = ReportedFacts::of(&self.reflexes);
        if facts == reported {
            return;
        }
        self.reporter.reported = facts;
        let changes = [
            (facts.bumpers != reported.bumpers, Event::Bump(facts.bumpers)),
            (facts.cliffs != reported.cliffs, Event::Cliff(facts.cliffs)),
            (
                facts.wheel_drops != reported.wheel_drops,
                Event::Lift(facts.wheel_drops),
            ),
            (facts.docked != reported.docked, Event::Docked(facts.docked)),
            (
                facts.inhibits != reported.inhibits,
                Event::Inhibits(facts.inhibits),
            ),
        ];
        for (_, kind) in changes.into_iter().filter(|(changed, _)| *changed) {
            self.session.queue_event(kind, now);
        }
        let new = Inhibits::from_bits(facts.inhibits.bits() & !reported.inhibits.bits());
        for inhibit in new.iter().filter(|inhibit| inhibit.is_latched()) {
            self.journal.note(LogLevel::Error, "latched", inhibit.name());
        }
    }

    /// Writes the next packet if the last one is gone: what the session wants sent, then rare reports, then `state`.
    pub(crate) fn fill_transmitter(&mut self, now: Tick) {
        self.reporter.tick(self.session.mode(), now);
        self.probing.gather(&mut self.board.probe, now);
        let Some(packet) = self.transmitter.next() else {
            return;
        };
        if self.session.next_packet(packet) {
            return;
        }
        let report = if self.reporter.info.take() {
            Report::Info(self.info())
        } else if let Some((level, text)) = self.journal.take() {
            Report::Log { level, text }
        } else if let Some(probed) = self.probing.take(&mut self.board.probe, now) {
            Report::Probed(probed)
        } else if self.reporter.state.take() {
            Report::State(self.state(now))
        } else {
            return;
        };
        if let Some(packet) = self.transmitter.next() {
            // No `info`, `state` or log line is too long for a packet; if one were, the buffer would be empty.
            self.session.encode(&report, packet).ok();
        }
    }

    fn info(&mut self) -> Info {
        Info {
            firmware_version: name(self.parameters.firmware),
            cordlib_version: name(VERSION),
            main_steps_hz: self.reporter.steps.per_second(),
            battery: self.battery(),
            bandwidth_in: self.reporter.bytes_in.per_second(),
            bandwidth_out: self.reporter.bytes_out.per_second(),
            link: self.session.counters(),
            arming: Some(self.reflexes.arming.state()),
        }
    }

    fn state(&mut self, now: Tick) -> State {
        State {
            tick: now,
            count_left: shown(self.fitted.encoders, self.senses.counts.left),
            count_right: shown(self.fitted.encoders, self.senses.counts.right),
            gyro: self.senses.gyro,
            bumpers: self.reflexes.bumpers(),
            cliffs: self.reflexes.cliffs(),
            wheel_drops: self.reflexes.wheel_drops(),
            proximity: shown(self.fitted.proximity > 0, self.board.proximity.closeness()),
            dock: shown(self.fitted.dock_receivers > 0, self.board.dock_beams.symbols()),
            buttons: self.reflexes.buttons(),
            dust_box: self.board.dust_box.inserted(),
            currents: self.senses.currents,
            pack: self.pack(),
            charge: self.charge_state(),
            docked: self.reflexes.dock.is_docked(),
            inhibits: self.reflexes.inhibits(),
            motion: self.motion.phase(),
            cleaners: self.cleaning.running(),
        }
    }
}
