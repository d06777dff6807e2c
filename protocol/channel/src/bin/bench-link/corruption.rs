//! Damaged packets into a robot's session, and what it makes of them.

use std::collections::BTreeMap;

use rvac_channel::{Channel, FaultRates, Pcg32, ReceivedByte, switched_on};
use rvac_protocol::PacketBuffer;
use rvac_protocol::message::{BinaryKinds, Command, HostHello, ProtocolVersion, Report, State};
use rvac_protocol::session::{Mode, RobotEvent, RobotSession};
use rvac_protocol::text::write_command_with_crc;
use rvac_units::Tick;
use serde::Serialize;

use crate::traffic::Traffic;

/// What came of the packets of one kind of fault.
#[derive(Debug, Default, Serialize)]
pub(crate) struct CorruptionOutcome {
    /// Damaged packets.
    packets: u64,
    /// Commands carried out that the host never gave in this session with that number.
    wrong: u64,
    /// Commands carried out as given: the damage was beside them.
    right: u64,
    /// Stops that nobody gave. Stopping is obeyed in any form, so these are allowed.
    stops: u64,
}

/// The whole run.
#[derive(Debug)]
pub(crate) struct Corruption {
    pub(crate) kinds: BTreeMap<&'static str, CorruptionOutcome>,
    /// Whole packets among the damaged ones.
    pub(crate) valid_packets: u64,
    /// Whole packets that were not carried out although a separator stood between them and the damage.
    pub(crate) valid_packets_lost: u64,
}

impl Corruption {
    pub(crate) fn corrupted_packets(&self) -> u64 {
        self.kinds.values().map(|outcome| outcome.packets).sum()
    }

    pub(crate) fn wrong_actuations(&self) -> u64 {
        self.kinds.values().map(|outcome| outcome.wrong).sum()
    }

    pub(crate) fn print(&self) {
        println!(
            "{:<18} {:>12} {:>7} {:>10} {:>7}",
            "fault", "packets", "wrong", "unharmed", "stops"
        );
        for (kind, outcome) in &self.kinds {
            let CorruptionOutcome {
                packets,
                wrong,
                right,
                stops,
            } = outcome;
            println!("{kind:<18} {packets:>12} {wrong:>7} {right:>10} {stops:>7}");
        }
        println!(
            "{} corrupted packets, {} wrong actuations; {} of {} whole packets between them lost",
            self.corrupted_packets(),
            self.wrong_actuations(),
            self.valid_packets_lost,
            self.valid_packets
        );
    }
}

/// A kind of fault and how many of a thousand damaged packets have it.
struct CorruptionKind {
    name: &'static str,
    share: u32,
    damage: Damage,
}

enum Damage {
    Line(FaultRates),
    Splice,
    Echo,
    EarlierSession,
    Middle,
    Replay,
}

const KINDS: [CorruptionKind; 14] = [
    line(
        "bit-error-1e-2",
        180,
        FaultRates {
            bit_error: 1e-2,
            ..FaultRates::NONE
        },
    ),
    line(
        "bit-error-1e-3",
        180,
        FaultRates {
            bit_error: 1e-3,
            ..FaultRates::NONE
        },
    ),
    line(
        "bit-error-1e-4",
        50,
        FaultRates {
            bit_error: 1e-4,
            ..FaultRates::NONE
        },
    ),
    line(
        "bit-error-1e-5",
        5,
        FaultRates {
            bit_error: 1e-5,
            ..FaultRates::NONE
        },
    ),
    line(
        "lost-bytes",
        105,
        FaultRates {
            lost_byte: 0.02,
            ..FaultRates::NONE
        },
    ),
    line(
        "doubled-bytes",
        100,
        FaultRates {
            doubled_byte: 0.02,
            ..FaultRates::NONE
        },
    ),
    line(
        "cut-out",
        80,
        FaultRates {
            cut_out: 0.01,
            ..FaultRates::NONE
        },
    ),
    line(
        "burst",
        80,
        FaultRates {
            burst: 0.01,
            run_bytes_max: 8,
            ..FaultRates::NONE
        },
    ),
    line(
        "overrun",
        20,
        FaultRates {
            overrun: 0.01,
            ..FaultRates::NONE
        },
    ),
    CorruptionKind {
        name: "splice",
        share: 80,
        damage: Damage::Splice,
    },
    CorruptionKind {
        name: "echo",
        share: 30,
        damage: Damage::Echo,
    },
    CorruptionKind {
        name: "earlier-session",
        share: 40,
        damage: Damage::EarlierSession,
    },
    CorruptionKind {
        name: "middle",
        share: 30,
        damage: Damage::Middle,
    },
    CorruptionKind {
        name: "replay",
        share: 20,
        damage: Damage::Replay,
    },
];

const fn line(name: &'static str, share: u32, rates: FaultRates) -> CorruptionKind {
    CorruptionKind {
        name,
        share,
        damage: Damage::Line(rates),
    }
}

/// A whole packet goes after this many damaged ones: it keeps the session open and shows that the robot still listens.
const VALID_EVERY: u64 = 16;

/// Feeds `packets` damaged packets to a robot in checked mode.
pub(crate) fn run(packets: u64, seed: u64) -> Corruption {
    let mut bench = CorruptionBench::new(seed);
    for index in 0..packets {
        bench.damaged();
        if index % VALID_EVERY == 0 {
            bench.valid();
        }
    }
    bench.result
}

struct CorruptionBench {
    random: Pcg32,
    channels: Vec<Option<Channel>>,
    robot: RobotSession,
    now: Tick,
    traffic: Traffic,
    earlier: Traffic,
    echo: Vec<u8>,
    last: Vec<u8>,
    received: Vec<ReceivedByte>,
    result: Corruption,
}

impl CorruptionBench {
    fn new(seed: u64) -> Self {
        let now = Tick(1_000);
        let robot = open_robot(now);
        let session = robot.session();
        let channels = KINDS.iter().zip(1..).map(|(kind, index)| match kind.damage {
            Damage::Line(rates) => Some(Channel::new(seed.wrapping_mul(1_000) + index, rates)),
            _ => None,
        });
        Self {
            random: Pcg32::new(seed),
            channels: channels.collect(),
            now,
            traffic: Traffic::new(session),
            earlier: Traffic::new(session ^ 0x2A5C),
            echo: Vec::new(),
            last: Vec::new(),
            received: Vec::new(),
            result: Corruption {
                kinds: KINDS
                    .iter()
                    .map(|kind| (kind.name, CorruptionOutcome::default()))
                    .collect(),
                valid_packets: 0,
                valid_packets_lost: 0,
            },
            robot,
        }
    }

    fn damaged(&mut self) {
        self.now = self.now.after(1);
        let kind = self.draw_kind();
        let packet = self.traffic.packet(&mut self.random, self.now);
        self.received.clear();
        match KINDS[kind].damage {
            Damage::Line(_) => self.pass_until_damaged(kind, &packet),
            Damage::Splice => {
                let cut = self.random.below(self.last.len() as u32) as usize;
                let resume = self.random.below(packet.len() as u32) as usize;
                let spliced = [&self.last[..cut], &packet[resume..]].concat();
                self.receive_whole(&spliced);
            }
            Damage::Echo => {
                let echo = std::mem::take(&mut self.echo);
                self.receive_whole(&echo);
                self.echo = echo;
            }
            Damage::EarlierSession => {
                let packet = self.earlier.packet(&mut self.random, self.now);
                self.receive_whole(&packet);
            }
            Damage::Middle => {
                let begin = 1 + self.random.below(packet.len() as u32 - 1) as usize;
                self.receive_whole(&packet[begin..]);
            }
            Damage::Replay => {
                let last = std::mem::take(&mut self.last);
                self.receive_whole(&last);
                self.last = last;
            }
        }
        self.last = packet;
        self.feed_and_judge(kind);
    }

    fn draw_kind(&mut self) -> usize {
        let mut draw = self.random.below(KINDS.iter().map(|kind| kind.share).sum());
        KINDS
            .iter()
            .position(|kind| {
                let hit = draw < kind.share;
                draw = draw.saturating_sub(kind.share);
                hit
            })
            .unwrap_or(0)
    }

    fn receive_whole(&mut self, bytes: &[u8]) {
        self.received
            .extend(bytes.iter().copied().map(ReceivedByte::Byte));
    }

    /// Sends the packet over the faulty line until the line does harm it.
    fn pass_until_damaged(&mut self, kind: usize, packet: &[u8]) {
        let Some(channel) = self.channels[kind].as_mut() else {
            return;
        };
        loop {
            self.received.clear();
            for byte in packet {
                channel.pass(*byte, &mut self.received);
            }
            channel.idle(&mut self.received);
            let unharmed = self.received.len() == packet.len()
                && self
                    .received
                    .iter()
                    .zip(packet)
                    .all(|(received, sent)| *received == ReceivedByte::Byte(*sent));
            if !unharmed {
                return;
            }
        }
    }

    fn feed_and_judge(&mut self, kind: usize) {
        let mut outcome = CorruptionOutcome {
            packets: 1,
            ..CorruptionOutcome::default()
        };
        let received = std::mem::take(&mut self.received);
        for byte in received.iter().chain(&[ReceivedByte::Byte(0x1F)]) {
            match self.feed(*byte) {
                Some(Command::Stop) => outcome.stops += 1,
                Some(command) if self.traffic.has_said(&command) => outcome.right += 1,
                Some(_) => outcome.wrong += 1,
                None => {}
            }
        }
        self.received = received;
        self.forget_answers();
        let total = self.result.kinds.entry(KINDS[kind].name).or_default();
        total.packets += outcome.packets;
        total.wrong += outcome.wrong;
        total.right += outcome.right;
        total.stops += outcome.stops;
    }

    fn feed(&mut self, byte: ReceivedByte) -> Option<Command> {
        let event = match byte {
            ReceivedByte::Byte(byte) => self.robot.receive(byte, self.now),
            ReceivedByte::FramingError => {
                self.robot.framing_error();
                None
            }
            ReceivedByte::Overrun => {
                self.robot.overrun();
                None
            }
        };
        match event? {
            RobotEvent::Command(command) => {
                if let (true, Some(sequence)) = (command.must_arrive(), command.sequence()) {
                    self.robot.answer(sequence, None);
                }
                Some(command)
            }
            RobotEvent::SessionOpened | RobotEvent::SessionClosed(_) => {
                unreachable!("no hello and no hand is sent, and whole packets keep the session open")
            }
        }
    }

    /// A whole packet must be carried out, whatever came before its separator.
    fn valid(&mut self) {
        self.now = self.now.after(1);
        let packet = self.traffic.packet(&mut self.random, self.now);
        let mut carried_out = false;
        for byte in &packet {
            carried_out |= self.feed(ReceivedByte::Byte(*byte)).is_some();
        }
        self.result.valid_packets += 1;
        self.result.valid_packets_lost += u64::from(!carried_out);
        let state = Report::State(State {
            tick: self.now,
            ..State::default()
        });
        let mut buffer = PacketBuffer::new();
        self.robot.encode(&state, &mut buffer).expect("a state fits");
        self.echo = buffer.as_bytes().to_vec();
        self.last = packet;
        self.forget_answers();
    }

    fn forget_answers(&mut self) {
        let mut buffer = PacketBuffer::new();
        while self.robot.next_packet(&mut buffer) {}
    }
}

/// A robot as its host has greeted it.
pub(crate) fn open_robot(now: Tick) -> RobotSession {
    let mut robot = switched_on(now);
    let hello = Command::Hello(HostHello {
        version_min: ProtocolVersion::MIN,
        version_max: ProtocolVersion::CURRENT,
        binary: BinaryKinds::ALL,
    });
    let mut buffer = PacketBuffer::new();
    write_command_with_crc(&hello, 0, &mut buffer).expect("a hello fits");
    for byte in buffer.as_bytes() {
        assert!(
            robot
                .receive(*byte, now)
                .is_none_or(|event| event == RobotEvent::SessionOpened)
        );
    }
    assert_eq!(robot.mode(), Mode::Checked);
    robot
}

#[cfg(test)]
mod tests {
    use super::{KINDS, run};

    #[test]
    fn every_kind_of_fault_occurs_and_none_moves_the_robot_wrongly() {
        let result = run(20_000, 3);
        assert_eq!(result.corrupted_packets(), 20_000);
        assert_eq!(result.wrong_actuations(), 0);
        assert_eq!(result.valid_packets_lost, 0);
        assert!(result.valid_packets > 1_000);
        for kind in &KINDS {
            assert!(result.kinds[kind.name].packets > 0, "{}", kind.name);
        }
    }

    #[test]
    fn the_same_seed_gives_the_same_run() {
        let table = |seed| format!("{:?}", run(2_000, seed).kinds);
        assert_eq!(table(5), table(5));
        assert_ne!(table(5), table(6));
    }
}
