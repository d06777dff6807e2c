//! Both ends of the session over a damaged line: what must arrive arrives, once, in order, and as it was meant.

use rvac_channel::{Channel, FaultRates, ReceivedByte, switched_on};
use rvac_protocol::PacketBuffer;
use rvac_protocol::message::{BinaryKinds, Command, Drive, Event, Report, Sequence, State};
use rvac_protocol::session::{HostEvent, HostSession, RobotEvent, RobotSession};
use rvac_units::{AngularSpeed, Speed, Tick};

/// Milliseconds between two commands that must arrive.
const ARM_MS: u32 = 170;
/// Milliseconds between two events.
const EDGE_MS: u32 = 230;
/// Speed that the host asks for; anything else would be a wrong actuation.
const SPEED: Speed = Speed(123_000);

/// Two ends, two lines, one millisecond a step.
struct Link {
    robot: RobotSession,
    host: HostSession,
    to_robot: Channel,
    to_host: Channel,
    now: Tick,
    /// Numbers of the commands that must arrive, as sent and as carried out.
    armed: (Vec<Sequence>, Vec<Sequence>),
    /// Buttons of the events, as they happened and as delivered.
    events: (Vec<u8>, Vec<u8>),
    drives: u32,
    sessions: u32,
}

impl Link {
    fn new(seed: u64, rates: FaultRates) -> Self {
        let now = Tick(u32::MAX - 5_000);
        Self {
            robot: switched_on(now),
            host: HostSession::new(BinaryKinds::ALL, now),
            to_robot: Channel::new(seed, rates),
            to_host: Channel::new(seed + 1, rates),
            now,
            armed: (Vec::new(), Vec::new()),
            events: (Vec::new(), Vec::new()),
            drives: 0,
            sessions: 0,
        }
    }

    fn step(&mut self, elapsed_ms: u32) {
        self.now = self.now.after(1);
        let mut buffer = PacketBuffer::new();
        while self.host.poll(self.now).is_some() {}
        if self.host.is_open() {
            self.command(elapsed_ms);
            if elapsed_ms.is_multiple_of(EDGE_MS) {
                self.happen();
            }
        }
        while self.host.next_packet(&mut buffer) {
            self.carry_to_robot(&buffer);
        }
        self.note(|link| link.robot.poll(link.now));
        if elapsed_ms.is_multiple_of(20) {
            let state = Report::State(State {
                tick: self.now,
                ..State::default()
            });
            self.robot.encode(&state, &mut buffer).expect("a state fits");
            self.carry_to_host(&buffer);
        }
        while self.robot.next_packet(&mut buffer) {
            self.carry_to_host(&buffer);
        }
    }

    fn command(&mut self, elapsed_ms: u32) {
        let mut buffer = PacketBuffer::new();
        let placeholder = Sequence(0);
        if elapsed_ms.is_multiple_of(ARM_MS) {
            let arm = Command::Arm {
                sequence: placeholder,
                undock: false,
            };
            if let Ok(Some(sequence)) = self.host.send(arm, self.now, &mut buffer) {
                self.armed.0.push(sequence);
                self.carry_to_robot(&buffer);
            }
        }
        if elapsed_ms.is_multiple_of(50) {
            let drive = Command::Drive(Drive {
                speed: SPEED,
                turn: AngularSpeed(0),
                lease_ms: 250,
                sequence: placeholder,
                seen_tick: Tick(0),
            });
            self.host
                .send(drive, self.now, &mut buffer)
                .expect("the session is open");
            self.carry_to_robot(&buffer);
        }
    }

    fn happen(&mut self) {
        let button = self.events.0.len() as u8;
        self.events.0.push(button);
        let kind = Event::Button {
            button,
            pressed: true,
        };
        self.robot.queue_event(kind, self.now);
    }

    fn carry_to_robot(&mut self, buffer: &PacketBuffer) {
        let mut received = Vec::new();
        for byte in buffer.as_bytes() {
            self.to_robot.pass(*byte, &mut received);
        }
        self.to_robot.idle(&mut received);
        for byte in received {
            self.note(|link| match byte {
                ReceivedByte::Byte(byte) => link.robot.receive(byte, link.now),
                ReceivedByte::FramingError => {
                    link.robot.framing_error();
                    None
                }
                ReceivedByte::Overrun => {
                    link.robot.overrun();
                    None
                }
            });
        }
    }

    fn note(&mut self, event: impl FnOnce(&mut Self) -> Option<RobotEvent>) {
        match event(self) {
            Some(RobotEvent::Command(Command::Arm { sequence, .. })) => {
                self.armed.1.push(sequence);
                self.robot.answer(sequence, None);
            }
            Some(RobotEvent::Command(Command::Drive(drive))) => {
                assert_eq!(drive.speed, SPEED);
                self.drives += 1;
            }
            Some(RobotEvent::SessionOpened) => self.sessions += 1,
            Some(RobotEvent::Command(_) | RobotEvent::SessionClosed(_)) | None => {}
        }
    }

    fn carry_to_host(&mut self, buffer: &PacketBuffer) {
        let mut received = Vec::new();
        for byte in buffer.as_bytes() {
            self.to_host.pass(*byte, &mut received);
        }
        self.to_host.idle(&mut received);
        for byte in received {
            let event = match byte {
                ReceivedByte::Byte(byte) => self.host.receive(byte, self.now),
                ReceivedByte::FramingError => {
                    self.host.framing_error();
                    None
                }
                ReceivedByte::Overrun => {
                    self.host.overrun();
                    None
                }
            };
            if let Some(HostEvent::Report(Report::Event(event))) = event
                && let Event::Button { button, .. } = event.kind
            {
                self.events.1.push(button);
            }
        }
    }
}

fn run(rates: FaultRates) -> Link {
    let mut link = Link::new(11, rates);
    for elapsed_ms in 0..30_000 {
        link.step(elapsed_ms);
    }
    link
}

#[test]
fn a_clean_line_is_good_and_loses_nothing() {
    let link = run(FaultRates::NONE);
    assert_eq!(link.armed.0, link.armed.1);
    assert_eq!(link.events.0, link.events.1);
    assert_eq!(link.host.quality().both().bad, 0);
    assert_eq!(link.sessions, 1);
    assert!(link.drives > 590, "{} drives", link.drives);
}

#[test]
fn a_noisy_line_confuses_nobody() {
    let link = run(FaultRates {
        bit_error: 2e-4,
        lost_byte: 2e-4,
        doubled_byte: 2e-4,
        ..FaultRates::NONE
    });
    assert_eq!(link.sessions, 1);
    let mut carried_out = link.armed.1.clone();
    carried_out.sort_by_key(|sequence| sequence.0);
    // The last ones may still be under way.
    let missing = link.armed.0.len() - carried_out.len();
    assert!(missing <= 1, "{missing} commands did not arrive");
    assert!(link.armed.0.starts_with(&carried_out), "each once, and no other");
    assert!(link.events.0.starts_with(&link.events.1));
    assert!(
        link.events.0.len() - link.events.1.len() <= 2,
        "{:?}",
        link.events
    );
    assert!(link.host.quality().both().bad_share() > 0.01);
    assert!(link.drives > 400, "{} drives", link.drives);
}

#[test]
fn a_line_that_cuts_out_comes_back() {
    let mut link = Link::new(3, FaultRates::NONE);
    let dead = FaultRates {
        lost_byte: 1.0,
        ..FaultRates::NONE
    };
    for elapsed_ms in 0..10_000 {
        match elapsed_ms {
            2_000 => link.to_robot.set_rates(dead),
            5_500 => link.to_robot.set_rates(FaultRates::NONE),
            _ => {}
        }
        link.step(elapsed_ms);
    }
    assert_eq!(link.sessions, 2);
    assert!(link.host.is_open());
}
