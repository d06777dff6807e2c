//! The conversation, both real ends on a virtual clock.

mod pair;

use pair::{Pair, identity};
use rvac_protocol::crc::{Direction, packet_crc};
use rvac_protocol::message::{
    ArmingState, BinaryKinds, Bumpers, Command, CommandName, CommandNames, Drive, Event, Info, Inhibit, Move,
    Name, Parameter, Refusal, Report, Sequence,
};
use rvac_protocol::session::{HostEvent, Mode, RobotEvent, RobotSession, SendError, SessionEnd};
use rvac_protocol::text::write_command_with_crc;
use rvac_protocol::{PacketBuffer, message::LinkCounters};
use rvac_units::{AngularSpeed, Length, Speed, Tick};

const DRIVE: Command = Command::Drive(Drive {
    speed: Speed(200_000),
    turn: AngularSpeed(-300_000),
    lease_ms: 250,
    sequence: Sequence(0),
    seen_tick: Tick(0),
});

const ARM: Command = Command::Arm {
    sequence: Sequence(0),
    undock: false,
};

fn drives(pair: &Pair) -> usize {
    pair.commands()
        .iter()
        .filter(|command| command.name() == CommandName::Drive)
        .count()
}

fn arms(pair: &Pair) -> usize {
    pair.commands()
        .iter()
        .filter(|command| command.name() == CommandName::Arm)
        .count()
}

fn events(pair: &Pair) -> Vec<Event> {
    pair.host_events
        .iter()
        .filter_map(|event| match event {
            HostEvent::Report(Report::Event(event)) => Some(event.kind),
            _ => None,
        })
        .collect()
}

fn refusals(pair: &Pair) -> Vec<Refusal> {
    pair.host_events
        .iter()
        .filter_map(|event| match event {
            HostEvent::Answered { refusal, .. } => *refusal,
            _ => None,
        })
        .collect()
}

#[test]
fn a_session_opens_and_the_robot_describes_itself() {
    let pair = Pair::open(BinaryKinds::ALL);
    assert_eq!(pair.robot.mode(), Mode::Checked);
    assert_eq!(pair.robot.session(), pair.host.session());
    let described = pair
        .host_events
        .iter()
        .any(|event| *event == HostEvent::Described(identity().description));
    assert!(described, "{:?}", pair.host_events);
    assert_eq!(pair.host.understood(), CommandNames::ALL);
}

#[test]
fn a_session_opens_over_a_line_that_loses_every_other_packet() {
    let mut pair = Pair::new(BinaryKinds::ALL);
    let mut count = 0;
    pair.to_robot = Box::new(move |bytes| {
        count += 1;
        if count % 2 == 1 {
            bytes.clear();
        }
    });
    pair.run_ms(1_000);
    assert!(pair.host.is_open());
}

#[test]
fn driving_arrives_fresh_and_in_binary() {
    let mut pair = Pair::open(BinaryKinds::ALL);
    for _ in 0..50 {
        pair.send(DRIVE).unwrap();
        pair.run_ms(20);
    }
    assert_eq!(drives(&pair), 50);
    assert!(pair.said_by_robot.contains(&rvac_protocol::binary::STATE));
    assert_eq!(refusals(&pair), []);
}

#[test]
fn stale_buffers_never_drive() {
    let mut pair = Pair::open(BinaryKinds::NONE);
    let mut buffer = PacketBuffer::new();
    pair.host.send(DRIVE, pair.now, &mut buffer).unwrap();
    let late = buffer.as_bytes().to_vec();
    pair.run_ms(450);
    pair.inject(&late);
    pair.run_ms(5);
    assert_eq!(drives(&pair), 0);
    assert_eq!(refusals(&pair), [Refusal::Stale]);
}

#[test]
fn motion_that_is_not_newer_is_refused() {
    let mut pair = Pair::open(BinaryKinds::NONE);
    let mut buffer = PacketBuffer::new();
    pair.host.send(DRIVE, pair.now, &mut buffer).unwrap();
    pair.inject(buffer.as_bytes());
    pair.inject(buffer.as_bytes());
    pair.run_ms(5);
    assert_eq!(drives(&pair), 1);
    assert_eq!(refusals(&pair), [Refusal::Old]);
}

#[test]
fn a_command_that_must_arrive_is_carried_out_once_however_often_it_comes() {
    let mut pair = Pair::open(BinaryKinds::NONE);
    pair.to_host = Box::new(|bytes| bytes.clear());
    let sequence = pair.send(ARM).unwrap();
    pair.run_ms(450);
    assert_eq!(arms(&pair), 1);
    pair.to_host = Box::new(|_| {});
    pair.run_ms(150);
    assert_eq!(arms(&pair), 1);
    let answered = HostEvent::Answered {
        sequence,
        refusal: None,
    };
    assert_eq!(
        pair.host_events
            .iter()
            .filter(|event| **event == answered)
            .count(),
        1
    );
}

#[test]
fn a_command_without_an_answer_is_given_up() {
    let mut pair = Pair::open(BinaryKinds::NONE);
    pair.answering = false;
    let sequence = pair.send(ARM).unwrap().unwrap();
    pair.run_ms(1_200);
    assert!(pair.host_events.contains(&HostEvent::Unanswered(sequence)));
    assert_eq!(arms(&pair), 1);
}

#[test]
fn at_most_eight_commands_are_under_way() {
    let mut pair = Pair::open(BinaryKinds::NONE);
    pair.answering = false;
    for _ in 0..8 {
        pair.send(ARM).unwrap();
    }
    assert_eq!(pair.send(ARM), Err(SendError::Busy));
}

#[test]
fn a_refused_command_is_answered_with_its_reason_every_time() {
    let mut pair = Pair::open(BinaryKinds::NONE);
    pair.answering = false;
    let clear = Command::Clear {
        sequence: Sequence(0),
        inhibit: Inhibit::WheelStall,
    };
    let sequence = pair.send(clear).unwrap().unwrap();
    pair.run_ms(3);
    pair.robot.answer(sequence, Some(Refusal::CauseRemains));
    pair.run_ms(3);
    assert_eq!(refusals(&pair), [Refusal::CauseRemains]);
}

#[test]
fn edges_arrive_once_and_in_order_over_a_bad_line() {
    let mut pair = Pair::open(BinaryKinds::NONE);
    let mut random = 1_u32;
    pair.to_host = Box::new(move |bytes| {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        if random >> 31 != 0 {
            bytes.clear();
        }
    });
    let kinds: Vec<_> = (0..10_u8)
        .map(|button| Event::Button {
            button,
            pressed: true,
        })
        .collect();
    for kind in &kinds {
        pair.robot.queue_event(*kind, pair.now);
        pair.run_ms(7);
    }
    pair.run_ms(1_900);
    assert_eq!(events(&pair), kinds);
}

#[test]
fn an_overflow_of_edges_is_reported() {
    let mut pair = Pair::open(BinaryKinds::NONE);
    for _ in 0..20 {
        pair.robot.queue_event(Event::Bump(Bumpers::default()), pair.now);
    }
    pair.run_ms(1_000);
    let lost: u16 = pair
        .host_events
        .iter()
        .filter_map(|event| match event {
            HostEvent::EventsLost { count } => Some(*count),
            _ => None,
        })
        .sum();
    assert_eq!(lost, 4);
    assert_eq!(events(&pair).len(), 16);
}

#[test]
fn silence_ends_a_session_and_the_host_opens_another() {
    let mut pair = Pair::open(BinaryKinds::NONE);
    let first = pair.host.session();
    pair.to_robot = Box::new(|bytes| bytes.clear());
    pair.to_host = Box::new(|bytes| bytes.clear());
    pair.run_ms(2_600);
    assert_eq!(pair.robot.mode(), Mode::Hand);
    assert!(
        pair.robot_events
            .contains(&RobotEvent::SessionClosed(SessionEnd::Silence))
    );
    assert!(pair.host_events.contains(&HostEvent::Silent));
    pair.to_robot = Box::new(|_| {});
    pair.to_host = Box::new(|_| {});
    pair.run_ms(600);
    assert!(pair.host.is_open());
    assert_ne!(pair.host.session(), first);
}

#[test]
fn a_reset_of_the_robot_is_noticed_and_old_packets_do_not_pass() {
    let mut pair = Pair::open(BinaryKinds::NONE);
    let mut buffer = PacketBuffer::new();
    pair.host.send(ARM, pair.now, &mut buffer).unwrap();
    let of_old_session = buffer.as_bytes().to_vec();
    pair.reset_robot();
    pair.run_ms(50);
    assert!(
        pair.host_events
            .iter()
            .any(|event| matches!(event, HostEvent::Closed(_)))
    );
    pair.run_ms(300);
    assert!(pair.host.is_open());
    pair.inject(&of_old_session);
    pair.run_ms(50);
    assert_eq!(arms(&pair), 0);
    assert_eq!(pair.robot.counters().bad_crc, 1);
}

#[test]
fn three_bad_packets_end_the_binary_form_on_both_sides() {
    let mut pair = Pair::open(BinaryKinds::ALL);
    for _ in 0..3 {
        pair.inject(b"\x81broken\x1f");
    }
    pair.run_ms(100);
    pair.said_by_robot.clear();
    pair.send(DRIVE).unwrap();
    pair.run_ms(50);
    assert!(!pair.said_by_robot.contains(&rvac_protocol::binary::STATE));
    assert_eq!(drives(&pair), 1);
    let mut buffer = PacketBuffer::new();
    pair.host.send(DRIVE, pair.now, &mut buffer).unwrap();
    assert!(buffer.as_bytes().starts_with(br#"{"c":"drive""#));
}

#[test]
fn stop_is_obeyed_in_any_form_and_mode() {
    let mut of_another_session = PacketBuffer::new();
    write_command_with_crc(&Command::Stop, 4_711, &mut of_another_session).unwrap();
    let forms: [&[u8]; 5] = [
        b"stop\x1f",
        b"{\"c\":\"stop\"}\x1e",
        b"{\"x\":[1,{}],\"c\":\"stop\",\"n\":\"?\"}*00000000\x1f",
        b"{\"c\":\"stop\"}*5b1d6f0a{\"c\":\x1f",
        of_another_session.as_bytes(),
    ];
    for form in forms {
        let mut pair = Pair::open(BinaryKinds::ALL);
        pair.inject(form);
        pair.run_ms(2);
        assert_eq!(pair.commands(), [Command::Stop], "{}", form.escape_ascii());
        let mut pair = Pair::new(BinaryKinds::ALL);
        pair.inject(form);
        pair.run_ms(2);
        assert_eq!(pair.commands(), [Command::Stop], "{}", form.escape_ascii());
    }
}

#[test]
fn stop_can_be_sent_before_a_session_is_open() {
    let mut pair = Pair::new(BinaryKinds::ALL);
    pair.send(Command::Stop).unwrap();
    assert_eq!(pair.send(DRIVE), Err(SendError::NotOpen));
    pair.run_ms(2);
    assert_eq!(pair.commands(), [Command::Stop]);
}

/// A robot that no host has greeted, and what it makes of typed packets.
fn typed(packets: &str) -> Vec<Command> {
    let mut pair = Pair::new(BinaryKinds::NONE);
    pair.to_host = Box::new(|bytes| bytes.clear());
    pair.to_robot = Box::new(|bytes| {
        if bytes.starts_with(b"U") {
            bytes.clear();
        }
    });
    pair.inject(packets.replace('|', "\x1f").as_bytes());
    pair.run_ms(5);
    assert_eq!(pair.robot.mode(), Mode::Hand);
    pair.commands()
}

#[test]
fn a_person_may_type_and_motion_is_clamped() {
    let commands = typed(
        r#"{"c":"drive","v":1.5,"w":-3,"ttl":900}|{"c":"drive","v":0.05,"w":0}|{"c":"move","length":-2}|"#,
    );
    let [
        Command::Drive(fast),
        Command::Drive(slow),
        Command::Move(movement),
    ] = commands[..]
    else {
        panic!("{commands:?}");
    };
    assert_eq!(
        (fast.speed, fast.turn, fast.lease_ms),
        (Speed(100_000), AngularSpeed(-500_000), 500)
    );
    assert_eq!((slow.speed, slow.lease_ms), (Speed(50_000), 250));
    assert_eq!((movement.length, movement.radius), (Length(-50_000), None));
}

#[test]
fn a_typed_motor_command_of_2016_works_and_its_prefixes_do_not() {
    assert_eq!(
        typed(r#"{"c":"motor","motor":"wheel left","throttle":0.2}|"#).len(),
        1
    );
    for refused in [
        r#"{"c":"m","motor":"w","throttle":1}|"#,
        r#"{"c":"","motor":""}|"#,
        r#"{"c":"motor","motor":"w","throttle":0.1}|"#,
        r#"{"c":"motor","motor":"wheel left"}|"#,
        r#"{"c":"motor","motor":"wheel left","throttle":nan}|"#,
        r#"{"c":"motor","motor":"wheel left","throttle":99999}|"#,
        r#"{"c":"motor","motor":"wheel left","throttle":"1"}|"#,
        r#"{"c":"motor","motor":"wheel left","throttle":0.1,"speed":1}|"#,
        r#"{"c":"motor","motor":"wheel left","throttle":0.1,"throttle":0.1}|"#,
    ] {
        assert_eq!(typed(refused), [], "{refused}");
    }
}

#[test]
fn packets_without_crc_are_refused_in_checked_mode_and_hand_leaves_it() {
    let mut pair = Pair::open(BinaryKinds::NONE);
    pair.inject(b"{\"c\":\"info\"}\x1f");
    pair.run_ms(3);
    assert_eq!(pair.commands(), []);
    assert_eq!(refusals(&pair), [Refusal::NoCrc]);
    let mut buffer = PacketBuffer::new();
    write_command_with_crc(&Command::Hand, pair.robot.session(), &mut buffer).unwrap();
    pair.inject(buffer.as_bytes());
    pair.inject(b"{\"c\":\"info\"}\x1f");
    pair.run_ms(1);
    assert_eq!(pair.commands(), [Command::Info]);
    assert!(
        pair.robot_events
            .contains(&RobotEvent::SessionClosed(SessionEnd::Hand))
    );
}

#[test]
fn info_arrives_whole_although_it_takes_three_packets() {
    let mut pair = Pair::open(BinaryKinds::NONE);
    let info = Info {
        firmware_version: Name::try_from("0.1.0").unwrap(),
        cordlib_version: Name::try_from("0.1.0").unwrap(),
        main_steps_hz: 12_345,
        battery: None,
        bandwidth_in: 1_000,
        bandwidth_out: 5_000,
        link: LinkCounters {
            accepted: 7,
            ..LinkCounters::default()
        },
        arming: Some(ArmingState::Hand),
    };
    pair.report(&Report::Info(info.clone()));
    assert_eq!(
        pair.host_events.last(),
        Some(&HostEvent::Report(Report::Info(info)))
    );
}

#[test]
fn bad_packets_are_counted_and_time_heals() {
    let bad_share = |pair: &Pair| pair.host.quality().both().bad_share();
    let mut pair = Pair::open(BinaryKinds::NONE);
    pair.run_ms(4_000);
    assert_eq!(bad_share(&pair), 0.0);
    assert_eq!(pair.host.quality().round_trip_ms, Some(0));
    let mut count = 0;
    pair.to_host = Box::new(move |bytes| {
        count += 1;
        if count % 20 == 0 {
            bytes[0] ^= 4;
        }
    });
    pair.run_ms(2_000);
    assert!((0.01..0.1).contains(&bad_share(&pair)));
    let mut count = 0;
    pair.to_host = Box::new(move |bytes| {
        count += 1;
        if count % 3 == 0 {
            bytes[0] ^= 4;
        }
    });
    pair.run_ms(3_000);
    assert!(bad_share(&pair) > 0.1);
    pair.to_host = Box::new(|_| {});
    pair.run_ms(6_000);
    assert_eq!(bad_share(&pair), 0.0);
}

#[test]
fn a_robot_without_a_common_version_still_stops() {
    let mut pair = Pair::new(BinaryKinds::NONE);
    pair.to_host = Box::new(|bytes| bytes.clear());
    let hello = br#"{"c":"hello","min":9,"max":12,"bin":""}"#;
    let crc = rvac_protocol::crc::packet_crc(rvac_protocol::crc::Direction::HostToRobot, 0, hello);
    pair.to_robot = Box::new(move |bytes| {
        if bytes.starts_with(b"U") {
            *bytes = hello.to_vec();
            bytes.push(b'*');
            bytes.extend(rvac_protocol::crc::to_hex(crc));
            bytes.push(0x1F);
        }
    });
    pair.send(Command::Stop).unwrap();
    pair.run_ms(300);
    assert_eq!(pair.robot.mode(), Mode::Hand);
    assert_eq!(pair.commands(), [Command::Stop]);
}

#[test]
fn a_command_that_is_longer_than_the_robot_takes_is_not_sent() {
    let mut pair = Pair::new(BinaryKinds::NONE);
    pair.to_host = Box::new(|bytes| {
        if let Some(at) = bytes.windows(12).position(|window| window == br#""packet":256"#) {
            let separator = bytes
                .iter()
                .rposition(|byte| *byte == b'*')
                .expect("the hello has a CRC");
            bytes.truncate(separator);
            bytes.splice(at..at + 12, *br#""packet":40"#);
            let begin = bytes
                .iter()
                .position(|byte| *byte == b'{')
                .expect("the hello is an object");
            let crc = rvac_protocol::crc::packet_crc(
                rvac_protocol::crc::Direction::RobotToHost,
                0,
                &bytes[begin..],
            );
            bytes.push(b'*');
            bytes.extend(rvac_protocol::crc::to_hex(crc));
            bytes.push(0x1F);
        }
    });
    pair.run_ms(50);
    assert!(pair.host.is_open());
    assert_eq!(pair.send(DRIVE), Err(SendError::Range));
    assert_eq!(pair.send(Command::State), Ok(None));
}

#[test]
fn without_telemetry_the_host_asks_for_the_clock_before_it_is_too_old() {
    let mut pair = Pair::open(BinaryKinds::NONE);
    pair.state_ms = 0;
    pair.run_ms(200);
    pair.send(DRIVE).unwrap();
    pair.run_ms(2);
    assert!(pair.commands().contains(&Command::State));
}

#[test]
fn moves_and_settings_reach_the_firmware_as_they_were_meant() {
    let mut pair = Pair::open(BinaryKinds::ALL);
    let set = Command::Set {
        sequence: Sequence(0),
        parameter: Parameter::StatePeriod,
        value: 20,
    };
    pair.send(set).unwrap();
    let movement = Command::Move(Move {
        length: Length(-1_500_000),
        radius: Some(Length(0)),
        sequence: Sequence(0),
        seen_tick: Tick(0),
    });
    pair.send(movement).unwrap();
    pair.run_ms(2);
    let [Command::Set { parameter, value, .. }, Command::Move(arrived)] = pair.commands()[..] else {
        panic!("{:?}", pair.commands());
    };
    assert_eq!((parameter, value), (Parameter::StatePeriod, 20));
    assert_eq!(
        (arrived.length, arrived.radius),
        (Length(-1_500_000), Some(Length(0)))
    );
}

/// Motion with a key of the future: taken where a CRC shows that a program wrote it, refused where a person typed it.
#[test]
fn an_unknown_key_of_motion_is_a_typing_error_without_a_crc_only() {
    let text = r#"{"c":"drive","v":0.05,"w":0,"ttl":250,"n":1,"t":0,"soft":true}"#;
    let hear = |robot: &mut RobotSession, packet: &str| {
        let bytes = packet.bytes().chain([0x1F]);
        bytes.filter_map(|byte| robot.receive(byte, Tick(1))).last()
    };
    let seal = |session: u16, text: &str| {
        let crc = packet_crc(Direction::HostToRobot, session, text.as_bytes());
        format!("{text}*{crc:08X}")
    };
    let mut robot = RobotSession::new(identity(), Tick(0));
    assert_eq!(hear(&mut robot, text), None, "typed");
    let taken = hear(&mut robot, &seal(0, text));
    assert!(
        matches!(taken, Some(RobotEvent::Command(Command::Drive(_)))),
        "hand mode: {taken:?}"
    );
    let opened = hear(&mut robot, &seal(0, r#"{"c":"hello","min":1,"max":1}"#));
    assert_eq!(opened, Some(RobotEvent::SessionOpened));
    let session = robot.session();
    let taken = hear(&mut robot, &seal(session, text));
    assert!(
        matches!(taken, Some(RobotEvent::Command(Command::Drive(_)))),
        "checked mode: {taken:?}"
    );
}
