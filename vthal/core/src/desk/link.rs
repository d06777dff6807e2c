//! The robot at the other end of the link: bytes to and from it, its last report, and the quality of the link.

use brain::{Inhibit, LinkFault};
use rvac_api::{DeviceTable, LinkReading, LogLevel, Topic, Update, Versions};

use super::audience::Teller;
use super::command_failures::CommandFailures;
use super::driver::Brakes;
use super::journal::LogSource;
use super::link_facts::LinkFacts;
use super::link_loan::LoanFacts;
use super::strange_line::{LineCause, StrangeLine};
use crate::device::{
    CommandError, Description, DeviceCommand, DeviceEvent, DeviceIo, Greeting, LinkNews, Make, Report,
    SlowFacts, Supervisor, WheelSpeeds,
};
use crate::observe::{LinkView, currents_a};
use crate::refusal::{self, Refused};
use crate::{Direction, LinkLoss, Record, to_api};

/// The link and the robot at its other end.
#[derive(Debug, Default)]
pub(crate) struct LinkDesk {
    /// The robot's link, while it is open.
    device: Option<Supervisor>,
    /// The robot whose link was lost: what its wheels have counted goes on when it is back.
    lost_device: Option<Supervisor>,
    facts: LinkFacts,
    events: Vec<DeviceEvent>,
    /// Scratch, so that packets cost no list of their own.
    packets: Vec<(Direction, String)>,
    failures: CommandFailures,
    strange: StrangeLine,
}

impl LinkDesk {
    /// The line to a robot of this make is open.
    pub(crate) fn opened(&mut self, make: &Make, teller: &mut Teller<'_>) {
        let known = self.device.take().or_else(|| self.lost_device.take());
        let device = self.device.insert(known.unwrap_or_else(|| Supervisor::new(make)));
        device.open(&mut DeviceIo {
            now_us: teller.now_us,
            link: &mut teller.outputs.link,
            events: &mut self.events,
        });
        self.facts.opened(teller.now_us);
        self.strange.restart(teller.now_us);
        teller.log(LogLevel::Info, LogSource::Link, "link open".to_owned());
    }

    pub(crate) fn closed(&mut self, reason: &LinkLoss, teller: &mut Teller<'_>) {
        self.lost_device = self.device.take().or_else(|| self.lost_device.take());
        self.facts.closed();
        self.strange.restart(teller.now_us);
        let text = match reason {
            LinkLoss::HungUp => "link lost: the other end hung up; waiting for it".to_owned(),
            LinkLoss::NoAnswer { baud } => format!("no robot answers at {baud} baud; tries the next rate"),
            LinkLoss::Lent => "link lent: it is used again when the client is done".to_owned(),
            LinkLoss::Failed(error) => format!("link lost: {error}; waiting for it"),
        };
        teller.log(LogLevel::Warn, LogSource::Link, text);
    }

    /// The daemon ends: the robot, which was ordered to stop, is released.
    pub(crate) fn release(&mut self, teller: &mut Teller<'_>) {
        if let Some(device) = &mut self.device {
            device.forget_stillness();
            device.release(&mut DeviceIo {
                now_us: teller.now_us,
                link: &mut teller.outputs.link,
                events: &mut self.events,
            });
        }
    }

    /// Takes bytes from the robot; gives its events.
    pub(crate) fn receive(&mut self, bytes: &[u8], teller: &mut Teller<'_>) -> Vec<DeviceEvent> {
        self.facts.count_in(bytes.len());
        self.strange.count(bytes);
        self.tap_received(bytes, teller);
        let mut events = core::mem::take(&mut self.events);
        if let Some(device) = &mut self.device {
            let mut io = DeviceIo {
                now_us: teller.now_us,
                link: &mut teller.outputs.link,
                events: &mut events,
            };
            device.receive(bytes, &mut io);
        }
        events
    }

    /// So many of the bytes that were taken last came with an error of the serial port.
    pub(crate) fn count_framing_errors(&mut self, count: u32) {
        self.strange.count_framing_errors(count);
    }

    /// Lets time pass; gives the events of the robot.
    pub(crate) fn pass_time(&mut self, teller: &mut Teller<'_>) -> Vec<DeviceEvent> {
        self.facts.pass_time(teller.now_us);
        self.look(teller.now_us);
        self.tell_link_news(teller);
        self.tell_strange_line(teller);
        let mut events = core::mem::take(&mut self.events);
        if let Some(device) = &mut self.device
            && teller.now_us >= device.next_wake_us()
        {
            let mut io = DeviceIo {
                now_us: teller.now_us,
                link: &mut teller.outputs.link,
                events: &mut events,
            };
            device.poll(&mut io);
            teller.outputs.next_rate |= device.gives_up_rate(teller.now_us);
        }
        events
    }

    /// Whether it is worth a line in the log that a command failed in this way.
    pub(crate) fn is_failure_news(&mut self, now_us: u64, kind: &'static str) -> bool {
        self.failures.is_news(now_us, kind)
    }

    /// Why the link cannot be relied upon, unless it is silent.
    pub(crate) fn fault(&self) -> Option<LinkFault> {
        self.device.as_ref().and_then(Supervisor::link_fault)
    }

    /// Name of why bytes come over the line and no robot describes itself, if they do.
    pub(crate) fn strange_cause(&self) -> Option<&'static str> {
        self.strange.cause().map(LineCause::name)
    }

    fn tell_strange_line(&mut self, teller: &mut Teller<'_>) {
        let Some(device) = &self.device else { return };
        if device.is_attached() {
            self.strange.forget(teller.now_us);
            return;
        }
        let came = device.link_quality().arrivals;
        let packets = came.reports.wrapping_add(came.repeated).wrapping_add(came.stray);
        let Some(sight) = self.strange.look(teller.now_us, packets) else {
            return;
        };
        let name = sight.cause.name();
        let text = format!(
            "{name}: {} Seen: {sight}, no packet of a robot.",
            refusal::text(name)
        );
        teller.log(LogLevel::Warn, LogSource::Link, text);
    }

    fn tell_link_news(&mut self, teller: &mut Teller<'_>) {
        for text in self.failures.ended(teller.now_us) {
            teller.log(LogLevel::Warn, LogSource::Link, text);
        }
        let Some(device) = &mut self.device else { return };
        for news in device.take_link_news() {
            let (level, text) = link_line(news);
            teller.log(level, LogSource::Link, text);
        }
    }

    /// Takes the list of events back, so that the next ones cost no memory of their own.
    pub(crate) fn reuse(&mut self, events: Vec<DeviceEvent>) {
        if self.events.is_empty() {
            self.events = events;
        }
    }

    /// Sends a command to the robot. A new reason for a failure goes to the log.
    pub(crate) fn command(&mut self, command: DeviceCommand, teller: &mut Teller<'_>) {
        let Some(device) = &mut self.device else { return };
        let mut io = DeviceIo {
            now_us: teller.now_us,
            link: &mut teller.outputs.link,
            events: &mut self.events,
        };
        if let Err(error) = device.command(command, &mut io)
            && self.facts.is_new_error(error)
        {
            let text = format!("{command:?} was not sent: {error}");
            teller.log(LogLevel::Debug, LogSource::Link, text);
        }
    }

    /// Sends what the expert of this name typed.
    ///
    /// # Errors
    /// Nothing was sent.
    pub(crate) fn send_raw(
        &mut self,
        packet: &str,
        expert: &str,
        teller: &mut Teller<'_>,
    ) -> Result<(), Refused> {
        let device = self.device.as_mut().ok_or("no-robot")?;
        let mut io = DeviceIo {
            now_us: teller.now_us,
            link: &mut teller.outputs.link,
            events: &mut self.events,
        };
        let sent = device.raw(packet, &mut io);
        if sent == Err(CommandError::Syntax) {
            return Err("raw-syntax");
        }
        let text = format!("{expert} sends raw {packet}");
        teller.log(LogLevel::Warn, LogSource::Client, text);
        sent.map_err(|_| "not-sent")
    }

    pub(crate) fn next_wake_us(&self) -> Option<u64> {
        self.device.as_ref().map(Supervisor::next_wake_us)
    }

    /// Whether a robot is there that takes commands.
    pub(crate) fn is_attached(&self) -> bool {
        self.device.as_ref().is_some_and(Supervisor::is_attached)
    }

    /// Whether nothing moves according to the newest reports, or nothing is known because no robot is connected.
    pub(crate) fn stands_still(&self) -> bool {
        let device = self.device.as_ref().filter(|device| device.is_attached());
        device.is_none_or(|device| device.still_reports() > 0)
    }

    pub(crate) fn greeted(&mut self, greeting: &Greeting) {
        self.facts.greeted(greeting);
    }

    pub(crate) fn take_report(&mut self, now_us: u64, report: Report) {
        self.facts.take_report(now_us, report);
    }

    pub(crate) fn take_slow_facts(&mut self, facts: SlowFacts) {
        self.facts.slow = Some(facts);
    }

    /// The description of the robot, once it has sent it.
    pub(crate) fn description(&self) -> Option<&Description> {
        self.device.as_ref().and_then(Supervisor::description)
    }

    /// What whoever asks for the line must know.
    pub(crate) fn loan_facts(&self) -> LoanFacts {
        let slow = self.facts.slow.as_ref();
        LoanFacts {
            is_attached: self.is_attached(),
            stands_still: self.stands_still(),
            is_docked: self.report().is_some_and(|report| report.docked)
                || self.description().is_some_and(|robot| !robot.may_have_dock()),
            charge: slow
                .and_then(|slow| slow.battery.as_ref())
                .map(|battery| battery.charge),
        }
    }

    /// The newest report.
    pub(crate) fn report(&self) -> Option<&Report> {
        self.facts.report.as_ref()
    }

    /// Speeds of the wheels.
    pub(crate) fn wheel_speeds(&self) -> WheelSpeeds {
        self.facts.wheel_speeds
    }

    /// What the motors draw, of a robot that measures it.
    pub(crate) fn currents_a(&self) -> Option<[f32; 3]> {
        currents_a(self.report()?)
    }

    /// Whether the robot has confirmed the last stop.
    pub(crate) fn brakes(&self) -> Brakes {
        let knows = self
            .report()
            .is_some_and(|report| report.inhibits.contains(Inhibit::Stopped));
        if self.device.as_ref().is_some_and(Supervisor::is_latched) && !knows {
            Brakes::Braking
        } else {
            Brakes::Free
        }
    }

    /// Judges the link as it is now.
    pub(crate) fn look(&mut self, now_us: u64) {
        if let Some(device) = &mut self.device {
            device.look_at_link(now_us);
        }
    }

    /// The state of the link for the brain.
    pub(crate) fn view(&self, now_us: u64) -> LinkView {
        let attached = self.device.as_ref().filter(|device| device.is_attached());
        let up = attached
            .and_then(Supervisor::fresh_us)
            .is_some_and(|fresh_us| self.facts.is_fresh(now_us, fresh_us));
        let fault = self.fault();
        LinkView {
            up: up && fault.is_none(),
            fault,
            speed_share: self.device.as_ref().map_or(1.0, Supervisor::speed_share),
        }
    }

    /// Versions of all that is at work, with a daemon of this one.
    pub(crate) fn versions(&self, daemon: &str) -> Versions {
        let description = self.description();
        Versions {
            vthal: daemon.to_owned(),
            brain: daemon.to_owned(),
            firmware: description.map(|robot| robot.identity.firmware.clone()),
            cordlib: self.facts.slow.as_ref().and_then(|slow| slow.library.clone()),
            protocol: description.map(|robot| robot.identity.protocol),
        }
    }

    /// What clients receive of the robot's parts.
    pub(crate) fn table(&self, now_us: u64, daemon: &str) -> DeviceTable {
        let (bytes_in_per_s, bytes_out_per_s) = self.facts.bytes_per_s();
        let slow = self.facts.slow.as_ref();
        let mut table = DeviceTable {
            versions: self.versions(daemon),
            battery: slow.and_then(|slow| slow.battery.as_ref()).map(to_api::battery),
            main_loop_hz: slow.and_then(|slow| slow.main_loop_hz),
            bytes_out_per_s,
            bytes_in_per_s,
            link: self.reading(now_us),
            ..DeviceTable::default()
        };
        if let (Some(report), Some(description)) = (self.report(), self.description()) {
            fill_from_report(&mut table, report, description);
            table.wheel_left_m_per_s = self.facts.wheel_speeds.left_m_per_s;
            table.wheel_right_m_per_s = self.facts.wheel_speeds.right_m_per_s;
        }
        table
    }

    fn reading(&self, now_us: u64) -> LinkReading {
        let quality = self
            .device
            .as_ref()
            .map(Supervisor::link_quality)
            .unwrap_or_default();
        LinkReading {
            up: self.view(now_us).up,
            age_ms: self.facts.age_ms(now_us).unwrap_or(u32::MAX),
            bad_share: quality.bad_share,
            round_trip_ms: quality.round_trip_ms,
            resets: self.facts.resets(),
            reset_cause: self.facts.reset_cause().map(str::to_owned),
            reconnects: self.facts.reconnects(),
            binary: quality.is_binary,
        }
    }

    fn tap_received(&mut self, bytes: &[u8], teller: &mut Teller<'_>) {
        if wants_packets(teller) {
            self.tap(Direction::FromRobot, bytes, teller);
        }
    }

    /// Shows what was sent since the link's output was this long.
    pub(crate) fn tap_sent(&mut self, link_before: usize, teller: &mut Teller<'_>) {
        let sent = teller.outputs.link.len() - link_before;
        if sent == 0 {
            return;
        }
        self.facts.count_out(sent);
        if wants_packets(teller) {
            let link = core::mem::take(&mut teller.outputs.link);
            let bytes = link.get(link_before..).unwrap_or_default();
            self.tap(Direction::ToRobot, bytes, teller);
            teller.outputs.link = link;
        }
    }

    fn tap(&mut self, direction: Direction, bytes: &[u8], teller: &mut Teller<'_>) {
        if let Some(device) = &mut self.device {
            device.tap(direction, bytes, &mut self.packets);
            tell_packets(&mut self.packets, teller);
        }
    }
}

/// The line of the log for a fault of the link.
fn link_line(news: LinkNews) -> (LogLevel, String) {
    match news {
        LinkNews::Began(fault) => {
            let name = fault.name();
            (LogLevel::Warn, format!("{name}: {}", refusal::text(name)))
        }
        LinkNews::Ended(episode) => {
            let (name, times, lasted_s) = (episode.fault.name(), episode.times, episode.lasted_s());
            let came = episode.arrivals;
            let text = format!(
                "{name} is over: {times} times within {lasted_s:.1} s, with {} sound reports, {} pieces of garbage, {} wrong \
                 check sums, {} repeated and {} stray reports",
                came.reports, came.garbled, came.corrupted, came.repeated, came.stray
            );
            (LogLevel::Info, text)
        }
    }
}

fn wants_packets(teller: &Teller<'_>) -> bool {
    teller.records_run() || teller.has_followers(Topic::Packets)
}

fn tell_packets(packets: &mut Vec<(Direction, String)>, teller: &mut Teller<'_>) {
    let time_us = teller.now_us;
    let is_followed = teller.has_followers(Topic::Packets);
    for (direction, text) in packets.drain(..) {
        teller.record(|| Record::Packet {
            time_us,
            direction,
            text: text.clone(),
        });
        if is_followed {
            let update = Update::Packet {
                t: to_api::seconds(time_us),
                direction: direction.symbol(),
                text,
            };
            teller.tell(Topic::Packets, update);
        }
    }
}

fn fill_from_report(table: &mut DeviceTable, report: &Report, description: &Description) {
    table.bumpers = [report.contacts.left, report.contacts.right];
    table.cliffs = [report.cliffs.left, report.cliffs.middle, report.cliffs.right];
    table.wheel_drops = [report.wheel_drops.left, report.wheel_drops.right];
    table.proximity = report
        .proximity
        .iter()
        .take(usize::from(description.sensors.proximity))
        .copied()
        .collect();
    table.currents_a = currents_a(report);
    let running = report.cleaners;
    table.cleaners = [running.brush_main, running.brush_sides, running.vacuum];
    table.dust_box = report.dust_box;
    table.docked = report.docked;
}
