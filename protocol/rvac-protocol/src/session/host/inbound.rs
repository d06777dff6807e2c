//! Packets from the robot.

use rvac_units::Tick;

use super::event_order::{Arrival, EventOrder};
use super::robot_clock::{RobotClock, TickVerdict};
use super::{
    GREETING_INCOMPATIBLE_MS, GREETING_MS, Gathering, HostCore, HostEvent, HostPhase, LinkCounters, PING_MS,
    SILENCE_MS,
};
use crate::binary;
use crate::crc::{Direction, packet_crc};
use crate::frame::{Framed, PACKET_BYTES_MAX, Poison};
use crate::message::{
    Acknowledgement, BinaryKinds, Info, NumberedEvent, ProtocolVersion, Report, RobotHello, Sequence, State,
};
use crate::session::BAD_IN_ROW_MAX;
use crate::text::{InfoPart, ReportPacket, read_report};

impl HostCore {
    pub(super) fn take(&mut self, framed: Framed<'_>, now: Tick) -> Option<HostEvent> {
        self.now = now;
        match framed {
            Framed::Checked(text) => {
                self.good();
                self.take_text(text)
            }
            Framed::Binary { kind, body } => self.take_binary(kind, body),
            Framed::BadCrc { text, crc } => self.take_bad_crc(text, crc),
            Framed::BinaryBadCrc => self.corrupted(),
            // A robot sends a CRC with every packet: this is none of its packets, or not the whole of one.
            Framed::Unchecked(_) => {
                count(&mut self.counters.bad_crc);
                self.garbled()
            }
            Framed::Poisoned(poison) => {
                if matches!(poison, Poison::TooLong | Poison::ControlByte) {
                    count(&mut self.counters.malformed);
                }
                count(&mut self.counters.resync);
                self.garbled()
            }
        }
    }

    fn take_bad_crc(&mut self, text: &[u8], found: u32) -> Option<HostEvent> {
        if self.session != 0
            && found == packet_crc(Direction::RobotToHost, 0, text)
            && let Ok(ReportPacket::Report(Report::Hello(hello))) = read_report(text)
        {
            self.good();
            return self.take_hello(hello);
        }
        self.corrupted()
    }

    fn take_binary(&mut self, kind: u8, body: &[u8]) -> Option<HostEvent> {
        self.good();
        if kind != binary::STATE || !self.binary.state {
            return self.unreadable();
        }
        match binary::read_state(body) {
            Ok(state) => self.take_state(state),
            Err(_) => self.unreadable(),
        }
    }

    fn take_text(&mut self, text: &[u8]) -> Option<HostEvent> {
        match read_report(text) {
            Ok(ReportPacket::Report(report)) => self.take_report(report),
            Ok(ReportPacket::Info(part)) => self.take_info(part),
            Err(_) => self.unreadable(),
        }
    }

    fn take_report(&mut self, report: Report) -> Option<HostEvent> {
        match report {
            Report::Hello(hello) => self.take_hello(hello),
            Report::Describe(row) => self.gathering.take(&row).map(HostEvent::Described),
            Report::State(state) => {
                // A robot that agreed on a binary form and sends text has stopped using it, and so does the host.
                self.binary_left |= self.binary.state;
                self.take_state(state)
            }
            Report::Event(event) => self.take_event(event),
            Report::Acknowledgement(answer) => self.take_answer(answer),
            Report::Info(_) | Report::Probed(_) | Report::Log { .. } => Some(HostEvent::Report(report)),
        }
    }

    /// Only a state that is newer than all before goes on: another one tells nothing of the present.
    fn take_state(&mut self, state: State) -> Option<HostEvent> {
        match self.clock.hear_state(state.tick, self.now) {
            TickVerdict::New => {}
            TickVerdict::Jumped => count(&mut self.arrivals.clock_jumps),
            TickVerdict::Repeated => {
                count(&mut self.arrivals.repeated);
                return None;
            }
            TickVerdict::Stray => {
                count(&mut self.arrivals.stray);
                return None;
            }
        }
        count(&mut self.arrivals.states);
        self.state_wanted = false;
        Some(HostEvent::Report(Report::State(state)))
    }

    fn take_event(&mut self, event: NumberedEvent) -> Option<HostEvent> {
        self.clock.hear_event(event.tick, self.now);
        match self.event_order.take(event.number, self.now) {
            Arrival::Next => Some(HostEvent::Report(Report::Event(event))),
            Arrival::Hold => None,
            Arrival::Lost(count) => Some(HostEvent::EventsLost { count }),
        }
    }

    fn take_info(&mut self, part: InfoPart) -> Option<HostEvent> {
        if part.battery.is_some() {
            self.info_battery = part.battery;
        }
        if let Some(link) = part.link {
            self.judge_outbound(link);
            self.info_link = link;
        }
        let firmware = part.firmware?;
        Some(HostEvent::Report(Report::Info(Info {
            firmware_version: firmware.firmware_version,
            cordlib_version: firmware.cordlib_version,
            main_steps_hz: firmware.main_steps_hz,
            battery: self.info_battery,
            bandwidth_in: firmware.bandwidth_in,
            bandwidth_out: firmware.bandwidth_out,
            link: self.info_link,
            arming: firmware.arming,
        })))
    }

    /// Outbound quality follows from the robot's counters since its last `info`.
    fn judge_outbound(&mut self, link: LinkCounters) {
        let old = self.info_link;
        if old == LinkCounters::default() {
            return;
        }
        let good = link.accepted.checked_sub(old.accepted);
        let bad_crcs = link.bad_crc.checked_sub(old.bad_crc);
        let resyncs = link.resync.checked_sub(old.resync);
        if let (Some(good), Some(bad_crcs), Some(resyncs)) = (good, bad_crcs, resyncs) {
            self.outbound
                .record(good, bad_crcs.saturating_add(resyncs), self.now);
        }
    }

    fn take_answer(&mut self, answer: Acknowledgement) -> Option<HostEvent> {
        let Acknowledgement { sequence, refusal } = answer;
        if let Some(number) = sequence {
            if let Some((_, sent)) = self.ping.under_way.take_if(|(ping, _)| *ping == number) {
                self.round_trip_ms = Some(self.now.since(sent));
                return None;
            }
            if let Some(round_trip) = self.delivery.answered(number, self.now) {
                self.round_trip_ms = round_trip.or(self.round_trip_ms);
                return Some(HostEvent::Answered { sequence, refusal });
            }
        }
        // An answer to a repeat after the first answer is redundant.
        refusal
            .is_some()
            .then_some(HostEvent::Answered { sequence, refusal })
    }

    fn take_hello(&mut self, hello: RobotHello) -> Option<HostEvent> {
        let common =
            hello.version_min <= ProtocolVersion::CURRENT && hello.version_max >= ProtocolVersion::MIN;
        if !common {
            return self.take_incompatible(&hello);
        }
        if hello.session == self.session && self.phase == HostPhase::Open {
            return None;
        }
        if hello.session != 0 {
            return Some(self.open(hello));
        }
        let was_open = self.phase == HostPhase::Open;
        if was_open {
            self.close();
            return Some(HostEvent::Closed(hello));
        }
        None
    }

    fn take_incompatible(&mut self, hello: &RobotHello) -> Option<HostEvent> {
        let already_reported = matches!(
            self.phase,
            HostPhase::Greeting {
                reported_incompatible: true,
                ..
            }
        );
        self.close();
        self.phase = HostPhase::Greeting {
            due: self.now.after(GREETING_INCOMPATIBLE_MS),
            reported_incompatible: true,
        };
        (!already_reported).then_some(HostEvent::Incompatible {
            version_min: hello.version_min,
            version_max: hello.version_max,
        })
    }

    fn open(&mut self, hello: RobotHello) -> HostEvent {
        self.close();
        self.phase = HostPhase::Open;
        self.session = hello.session;
        self.packet_max = usize::from(hello.packet_max);
        self.binary = self.binary_wanted.common(hello.binary);
        self.clock = RobotClock::begin(hello.tick, self.now);
        self.gathering = Gathering::begin();
        self.ping.due = self.now.after(PING_MS);
        HostEvent::Opened(hello)
    }

    /// Drops the session; the next greeting is due at once.
    fn close(&mut self) {
        while let Some(sequence) = self.delivery.take_any() {
            self.events.push_back(HostEvent::Unanswered(sequence)).ok();
        }
        self.phase = HostPhase::Greeting {
            due: self.now,
            reported_incompatible: false,
        };
        self.session = 0;
        self.packet_max = PACKET_BYTES_MAX;
        self.binary = BinaryKinds::NONE;
        self.binary_left = false;
        self.bad_in_row = 0;
        self.clock = RobotClock::default();
        self.event_order = EventOrder::default();
        self.gathering = Gathering::default();
        self.ping.under_way = None;
        self.state_wanted = false;
        self.info_link = LinkCounters::default();
    }

    pub(super) fn poll(&mut self, now: Tick) -> Option<HostEvent> {
        self.now = now;
        self.inbound.turn(now);
        self.outbound.turn(now);
        if let Some(event) = self.events.pop_front() {
            return Some(event);
        }
        if self.phase != HostPhase::Open {
            return None;
        }
        if now.since(self.heard) > SILENCE_MS {
            self.close();
            return Some(HostEvent::Silent);
        }
        self.delivery.take_hopeless(now).map(HostEvent::Unanswered)
    }

    pub(super) fn next_poll(&self) -> Tick {
        if !self.events.is_empty() {
            return self.now;
        }
        match self.phase {
            HostPhase::Greeting { due, .. } => due,
            HostPhase::Open if !self.delivery.is_empty() => self.now.after(super::delivery::REPEAT_MS),
            HostPhase::Open if !self.gathering.is_finished() => {
                self.now.after(super::description::ASK_AGAIN_MS)
            }
            HostPhase::Open => self.ping.due,
        }
    }

    fn good(&mut self) {
        count(&mut self.counters.accepted);
        self.heard = self.now;
        self.bad_in_row = 0;
        self.inbound.record(1, 0, self.now);
    }

    fn corrupted(&mut self) -> Option<HostEvent> {
        count(&mut self.counters.bad_crc);
        count(&mut self.arrivals.corrupted);
        self.bad()
    }

    fn garbled(&mut self) -> Option<HostEvent> {
        count(&mut self.arrivals.garbled);
        self.bad()
    }

    fn bad(&mut self) -> Option<HostEvent> {
        self.inbound.record(0, 1, self.now);
        self.bad_in_row = self.bad_in_row.saturating_add(1);
        if self.bad_in_row >= BAD_IN_ROW_MAX {
            self.binary_left = true;
        }
        None
    }

    /// Undamaged, but of a newer robot: counted, but not as a fault of the line.
    fn unreadable(&mut self) -> Option<HostEvent> {
        count(&mut self.counters.refused);
        None
    }

    /// The number for the next command.
    pub(super) fn take_sequence(&mut self) -> Sequence {
        let sequence = self.next_sequence;
        self.next_sequence = sequence.next();
        sequence
    }

    /// When to greet again after a greeting.
    pub(super) fn greeting_pause_ms(reported_incompatible: bool) -> u32 {
        if reported_incompatible {
            GREETING_INCOMPATIBLE_MS
        } else {
            GREETING_MS
        }
    }
}

fn count(total: &mut u32) {
    *total = total.wrapping_add(1);
}
