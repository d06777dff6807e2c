//! Raw readings for calibration: once while nothing can move, as a stream under a lease.

use crate::rig::{Rig, motor};
use cordlib::board::Received;
use rvac_protocol::message::{
    ButtonProbe, Capabilities, Command, EncoderProbe, Motor, Probe, ProbeTarget, Probed, ProbedContent,
    Refusal, Report, Sequence, SerialProbe,
};

const SERIAL: ProbeTarget = ProbeTarget::Serial {
    port: 1,
    baud: 57_600,
};

fn probe(target: ProbeTarget, lease_ms: u16) -> Command {
    Command::Probe(Probe {
        target,
        lease_ms,
        sequence: Sequence(0),
    })
}

fn probed(rig: &Rig) -> Vec<Probed> {
    rig.reports
        .iter()
        .filter_map(|report| match report {
            Report::Probed(probed) => Some(probed.clone()),
            _ => None,
        })
        .collect()
}

fn pieces(rig: &Rig) -> Vec<SerialProbe> {
    probed(rig)
        .into_iter()
        .map(|probed| match probed.content {
            ProbedContent::Serial(serial) => serial,
            other => panic!("{other:?}"),
        })
        .collect()
}

#[test]
fn each_target_is_answered_once() {
    let mut rig = Rig::connected(0);
    let pins = &mut rig.cord.board_mut().probe;
    pins.analog[4] = 790;
    pins.encoders = EncoderProbe {
        left: 12,
        right: -3,
        left_illegal: 1,
        right_illegal: 0,
        brush: Some(77),
    };
    pins.lines[6] = 0x8200;
    pins.buttons = ButtonProbe {
        level: 512,
        pressed: true,
    };
    let expected = [
        (ProbeTarget::Analog, ProbedContent::Analog(pins.analog)),
        (ProbeTarget::Encoders, ProbedContent::Encoders(pins.encoders)),
        (ProbeTarget::Lines, ProbedContent::Lines(pins.lines)),
        (ProbeTarget::Buttons, ProbedContent::Buttons(pins.buttons)),
    ];
    for (target, content) in expected {
        rig.reports.clear();
        assert_eq!(rig.ask(probe(target, 0)), Ok(()));
        rig.run(500);
        let answers: Vec<_> = probed(&rig).into_iter().map(|probed| probed.content).collect();
        assert_eq!(answers, [content]);
    }
}

#[test]
fn an_armed_robot_is_probed_under_a_lease_only() {
    let mut rig = Rig::armed(0);
    assert_eq!(rig.ask(probe(ProbeTarget::Encoders, 0)), Err(Refusal::Inhibited));
    rig.repeated = vec![motor(Motor::WheelLeft, 0.5)];
    rig.run(200);
    assert_eq!(rig.ask(probe(ProbeTarget::Encoders, 500)), Ok(()));
    rig.reports.clear();
    rig.run(2_000);
    let answers = probed(&rig).len();
    assert!(
        (9..=11).contains(&answers),
        "every 50 ms for half a second: {answers}"
    );
    assert!(!rig.wheels_off(), "it disturbs nothing");
    rig.send(Command::Stop);
    rig.run(10);
    assert_eq!(rig.ask(probe(ProbeTarget::Encoders, 0)), Ok(()), "stopped");
}

#[test]
fn a_serial_port_is_read_byte_by_byte_in_order() {
    let mut rig = Rig::connected(0);
    assert_eq!(rig.ask(probe(SERIAL, 1_000)), Ok(()));
    let sent: Vec<u8> = (0..=255).cycle().take(2_000).collect();
    for (millisecond, bytes) in sent.chunks(3).enumerate() {
        if let Some(queue) = &mut rig.cord.board_mut().probe.serial {
            queue.extend(bytes);
        }
        // Renewed before it ends, as a client does.
        if millisecond % 400 == 399 {
            rig.send(probe(SERIAL, 1_000));
        }
        rig.run(1);
    }
    rig.cord.board_mut().probe.lost = 7;
    rig.run(200);
    let pieces = pieces(&rig);
    let mut at = 0;
    let mut received = Vec::new();
    for piece in &pieces {
        assert_eq!(piece.at, at);
        assert!(!piece.bytes.is_empty() && piece.bytes.len() <= 64);
        at += piece.bytes.len() as u32;
        received.extend_from_slice(&piece.bytes);
    }
    assert_eq!(received, sent);
    assert_eq!(rig.cord.board().probe.opened, 1, "renewing opens nothing anew");
    rig.run(1_000);
    assert!(rig.cord.board().probe.serial.is_none(), "the lease is over");
}

#[test]
fn what_the_board_cannot_do_is_refused_by_name() {
    let mut rig = Rig::connected(0);
    for (port, baud, refusal) in [(2, 9_600, Refusal::Absent), (1, 230_400, Refusal::Range)] {
        let target = ProbeTarget::Serial { port, baud };
        assert_eq!(rig.ask(probe(target, 100)), Err(refusal));
    }
    let mut bare = Rig::switched_on_as(0, |parameters| {
        parameters.fitted = Some(Capabilities {
            encoders: true,
            ..Capabilities::default()
        });
    });
    bare.connect();
    assert_eq!(bare.ask(probe(ProbeTarget::Lines, 0)), Err(Refusal::Absent));
}

#[test]
fn the_end_of_a_session_ends_it() {
    let mut rig = Rig::connected(0);
    rig.ask(probe(SERIAL, 1_000)).expect("the port opens");
    rig.host_dead = true;
    rig.cord
        .board_mut()
        .link
        .to_robot
        .extend(b"\x1f".iter().map(|byte| Received::Byte(*byte)));
    rig.run(1_100);
    assert!(rig.cord.board().probe.serial.is_none());
}

#[test]
fn a_person_can_type_it() {
    let mut rig = Rig::switched_on(0);
    rig.host_dead = true;
    rig.run(50);
    rig.cord.board_mut().link.to_host.clear();
    rig.cord.board_mut().probe.analog = [7; 16];
    rig.cord.board_mut().link.to_robot.extend(
        b"{\"c\":\"probe\",\"of\":\"analog\"}\x1f"
            .iter()
            .map(|byte| Received::Byte(*byte)),
    );
    let mut said = Vec::new();
    for _ in 0..100 {
        rig.cord.board_mut().clock.0 += 1;
        rig.cord.step();
        said.append(&mut rig.cord.board_mut().link.to_host);
    }
    let said = String::from_utf8(said).expect("text");
    assert!(said.contains("{\"a\":0}"), "{said}");
    assert!(
        said.contains("\"of\":\"analog\",\"raw\":\"7 7 7 7 7 7 7 7 7 7 7 7 7 7 7 7\""),
        "{said}"
    );
}
