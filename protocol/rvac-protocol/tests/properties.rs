//! Whatever can be said comes back as it was said, in text and in binary, and a damaged packet hurts only itself.

use proptest::prelude::{Just, Strategy, any, prop, prop_assert_eq, prop_oneof, proptest};
use rvac_protocol::PacketBuffer;
use rvac_protocol::binary::{read_drive, read_state, write_drive, write_state};
use rvac_protocol::crc::Direction;
use rvac_protocol::frame::{Framed, Framer};
use rvac_protocol::message::{
    Beep, Bumpers, ButtonProbe, ChargeState, Cliffs, Command, Currents, Drive, EncoderProbe, Gyro, Inhibits,
    LogLevel, LogText, MotionPhase, Motor, MotorCommand, Move, PROBE_BYTES, PROBE_CHANNELS, PROBE_PORTS,
    PackReading, Probe, ProbeTarget, Probed, ProbedContent, Report, Sequence, SerialProbe, State, WheelDrops,
};
use rvac_protocol::text::{
    Form, ReportPacket, read_command, read_report, write_command, write_command_with_crc, write_report,
    write_report_with_crc,
};
use rvac_units::{Angle, AngularSpeed, Current, Frequency, Length, Ratio, Speed, Throttle, Tick, Voltage};

fn drive() -> impl Strategy<Value = Drive> {
    (
        -2_000_000..=2_000_000,
        -8_000_000..=8_000_000,
        1..=1_000_u16,
        any::<u16>(),
        any::<u32>(),
    )
        .prop_map(|(speed, turn, lease_ms, sequence, tick)| Drive {
            speed: Speed(speed),
            turn: AngularSpeed(turn),
            lease_ms,
            sequence: Sequence(sequence),
            seen_tick: Tick(tick),
        })
}

fn motor() -> impl Strategy<Value = MotorCommand> {
    (
        0..7_usize,
        -1_000_000..=1_000_000,
        1..=1_000_u16,
        any::<u16>(),
        any::<u32>(),
    )
        .prop_map(|(motor, throttle, lease_ms, sequence, tick)| MotorCommand {
            motor: Motor::ALL[motor],
            throttle: Throttle::saturating_from_millionths(throttle),
            lease_ms,
            sequence: Sequence(sequence),
            seen_tick: Tick(tick),
        })
}

fn movement() -> impl Strategy<Value = Move> {
    let radius = prop::option::of(-10_000_000..=10_000_000);
    (-10_000_000..=10_000_000, radius, any::<u16>(), any::<u32>()).prop_map(
        |(length, radius, sequence, tick)| Move {
            length: Length(length),
            radius: radius.map(Length),
            sequence: Sequence(sequence),
            seen_tick: Tick(tick),
        },
    )
}

fn beep() -> impl Strategy<Value = Beep> {
    (prop_oneof![0..=0, 20..=20_000], 1..=10_000_u16, 0..=1_000_000).prop_map(
        |(pitch, duration_ms, volume)| Beep {
            pitch: Frequency(pitch),
            duration_ms,
            volume: Ratio::from_millionths(volume).expect("drawn from the range"),
        },
    )
}

fn probe() -> impl Strategy<Value = Probe> {
    let serial =
        (any::<u8>(), 300..=1_000_000_u32).prop_map(|(port, baud)| ProbeTarget::Serial { port, baud });
    let others = prop_oneof![
        Just(ProbeTarget::Analog),
        Just(ProbeTarget::Encoders),
        Just(ProbeTarget::Lines),
        Just(ProbeTarget::Buttons),
    ];
    let leased = prop_oneof![(serial, 1..=1_000_u16), (others, 0..=1_000_u16),];
    (leased, any::<u16>()).prop_map(|((target, lease_ms), sequence)| Probe {
        target,
        lease_ms,
        sequence: Sequence(sequence),
    })
}

fn probed() -> impl Strategy<Value = Probed> {
    let encoders = (
        any::<i32>(),
        any::<i32>(),
        any::<u32>(),
        any::<u32>(),
        any::<Option<u32>>(),
    )
        .prop_map(|(left, right, left_illegal, right_illegal, brush)| {
            ProbedContent::Encoders(EncoderProbe {
                left,
                right,
                left_illegal,
                right_illegal,
                brush,
            })
        });
    let buttons = (any::<u16>(), any::<bool>())
        .prop_map(|(level, pressed)| ProbedContent::Buttons(ButtonProbe { level, pressed }));
    let bytes = prop::collection::vec(any::<u8>(), 0..=PROBE_BYTES);
    let serial = (any::<u32>(), any::<u32>(), bytes).prop_map(|(at, lost, bytes)| {
        let bytes = bytes.as_slice().try_into().expect("drawn to fit");
        ProbedContent::Serial(SerialProbe { at, lost, bytes })
    });
    let content = prop_oneof![
        any::<[u16; PROBE_CHANNELS]>().prop_map(ProbedContent::Analog),
        encoders,
        any::<[u16; PROBE_PORTS]>().prop_map(ProbedContent::Lines),
        buttons,
        serial,
    ];
    (any::<u32>(), content).prop_map(|(tick, content)| Probed {
        tick: Tick(tick),
        content,
    })
}

fn command() -> impl Strategy<Value = Command> {
    prop_oneof![
        drive().prop_map(Command::Drive),
        motor().prop_map(Command::Motor),
        movement().prop_map(Command::Move),
        beep().prop_map(Command::Beep),
        (any::<u16>(), any::<bool>()).prop_map(|(sequence, undock)| Command::Arm {
            sequence: Sequence(sequence),
            undock
        }),
        (any::<u16>(), any::<bool>()).prop_map(|(sequence, wanted)| Command::Charge {
            sequence: Sequence(sequence),
            wanted
        }),
        probe().prop_map(Command::Probe),
    ]
}

fn current() -> impl Strategy<Value = Current> {
    (-32_767..=32_767).prop_map(Current)
}

const CHARGES: [ChargeState; 4] = [
    ChargeState::Discharging,
    ChargeState::Charging,
    ChargeState::Full,
    ChargeState::Fault,
];
const MOTIONS: [MotionPhase; 5] = [
    MotionPhase::Idle,
    MotionPhase::Drive,
    MotionPhase::Move,
    MotionPhase::Motor,
    MotionPhase::Reflex,
];

fn gyro() -> impl Strategy<Value = Gyro> {
    (any::<i32>(), any::<i32>()).prop_map(|(heading, rate)| Gyro {
        heading: Angle(heading),
        rate: AngularSpeed(rate),
    })
}

fn touch() -> impl Strategy<Value = (Bumpers, Cliffs, WheelDrops)> {
    any::<[bool; 7]>().prop_map(|flags| {
        let [
            bump_left,
            bump_right,
            cliff_left,
            cliff_middle,
            cliff_right,
            drop_left,
            drop_right,
        ] = flags;
        let bumpers = Bumpers {
            left: bump_left,
            right: bump_right,
        };
        let cliffs = Cliffs {
            left: cliff_left,
            middle: cliff_middle,
            right: cliff_right,
        };
        let wheel_drops = WheelDrops {
            left: drop_left,
            right: drop_right,
        };
        (bumpers, cliffs, wheel_drops)
    })
}

fn currents() -> impl Strategy<Value = Currents> {
    (current(), current(), current()).prop_map(|(wheel_left, wheel_right, brush_main)| Currents {
        wheel_left,
        wheel_right,
        brush_main,
    })
}

fn pack() -> impl Strategy<Value = PackReading> {
    (0..=65_535, current()).prop_map(|(voltage, current)| PackReading {
        voltage: Voltage(voltage),
        current,
    })
}

fn state() -> impl Strategy<Value = State> {
    let totals = (any::<u32>(), any::<i32>(), any::<i32>(), any::<u32>());
    let bytes = (any::<[u8; 8]>(), any::<[u8; 4]>(), any::<u8>(), 0..8_u8);
    let power = (prop::option::of(currents()), prop::option::of(pack()));
    let rest = (
        0..4_usize,
        0..5_usize,
        prop::option::of(any::<bool>()),
        any::<bool>(),
    );
    (totals, prop::option::of(gyro()), touch(), bytes, power, rest).prop_map(
        |(totals, gyro, (bumpers, cliffs, wheel_drops), bytes, power, rest)| {
            let (tick, count_left, count_right, inhibits) = totals;
            let (proximity, dock, buttons, cleaners) = bytes;
            let (currents, pack) = power;
            let (charge, motion, dust_box, docked) = rest;
            State {
                tick: Tick(tick),
                count_left,
                count_right,
                gyro,
                bumpers,
                cliffs,
                wheel_drops,
                proximity,
                dock,
                buttons,
                dust_box,
                currents,
                pack,
                charge: CHARGES[charge],
                docked,
                inhibits: Inhibits::from_bits(inhibits),
                motion: MOTIONS[motion],
                cleaners,
            }
        },
    )
}

fn report_of(text: &[u8]) -> Report {
    match read_report(text) {
        Ok(ReportPacket::Report(report)) => report,
        other => panic!("{other:?}: {}", text.escape_ascii()),
    }
}

proptest! {
    #[test]
    fn commands_come_back(command in command()) {
        let mut buffer = PacketBuffer::new();
        prop_assert_eq!(write_command(&command, &mut buffer), Ok(()));
        prop_assert_eq!(read_command(buffer.as_bytes(), Form::Checked), Ok(command));
    }

    #[test]
    fn telemetry_comes_back_in_both_forms(state in state()) {
        let mut buffer = PacketBuffer::new();
        prop_assert_eq!(write_report(&Report::State(state), &mut buffer), Ok(()));
        prop_assert_eq!(report_of(buffer.as_bytes()), Report::State(state));
        prop_assert_eq!(read_state(&write_state(&state)[1..]), Ok(state));
    }

    #[test]
    fn raw_readings_come_back_and_fit_a_packet(probed in probed()) {
        let mut buffer = PacketBuffer::new();
        prop_assert_eq!(write_report_with_crc(&Report::Probed(probed.clone()), 1, &mut buffer), Ok(()));
        buffer.clear();
        prop_assert_eq!(write_report(&Report::Probed(probed.clone()), &mut buffer), Ok(()));
        prop_assert_eq!(report_of(buffer.as_bytes()), Report::Probed(probed));
    }

    #[test]
    fn drives_come_back_in_binary(drive in drive()) {
        let packet = write_drive(&drive).expect("drawn from the range");
        prop_assert_eq!(read_drive(&packet[1..]), Ok(drive));
    }

    #[test]
    fn log_lines_come_back_or_are_cut(text in "\\PC{0,60}") {
        let mut line = LogText::new();
        for character in text.chars() {
            if line.push(character).is_err() {
                break;
            }
        }
        let report = Report::Log { level: LogLevel::Warn, text: line.clone() };
        let mut buffer = PacketBuffer::new();
        prop_assert_eq!(write_report(&report, &mut buffer), Ok(()));
        let Report::Log { text, .. } = report_of(buffer.as_bytes()) else {
            panic!("a log line became something else");
        };
        prop_assert_eq!(text, line);
    }

    #[test]
    fn after_any_garbage_and_a_separator_the_next_packet_is_read(
        garbage in prop::collection::vec(any::<u8>(), 0..600),
        command in command(),
    ) {
        let mut framer = Framer::new(Direction::HostToRobot);
        for byte in garbage {
            framer.push(byte);
        }
        framer.push(0x1F);
        let mut buffer = PacketBuffer::new();
        write_command_with_crc(&command, 0, &mut buffer).expect("drawn from the range");
        let mut read = Vec::new();
        for byte in buffer.as_bytes() {
            if let Some(Framed::Checked(text)) = framer.push(*byte) {
                read.push(read_command(text, Form::Checked));
            }
        }
        prop_assert_eq!(read, [Ok(command)]);
    }

    #[test]
    fn what_we_take_for_json_is_json(text in r#"[\{\}\[\],:"\\ 0-9a-z.eE+-]{0,40}"#) {
        let packet = format!("{{\"c\":\"info\",\"x\":{text}}}");
        if read_command(packet.as_bytes(), Form::Checked).is_ok() {
            let read = serde_json::from_str::<serde_json::Value>(&packet);
            // Numbers that no 64-bit float holds are JSON, too.
            assert!(read.is_ok() || read.is_err_and(|error| error.to_string().contains("out of range")), "{packet}");
        }
    }
}
