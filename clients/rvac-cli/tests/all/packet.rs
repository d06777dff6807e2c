//! `rvac packet`, as a person calls it.

use std::process::Output;

use crate::program::rvac;

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).expect("text")
}

/// The CRC by a second implementation, straight from the specification: bit by bit, reflected.
fn reference_crc(direction: u8, session: u16, packet: &[u8]) -> u32 {
    let length = u16::try_from(packet.len()).expect("short").to_le_bytes();
    let head = [direction, session.to_le_bytes()[0], session.to_le_bytes()[1]];
    let mut register = u32::MAX;
    for byte in head.iter().chain(packet).chain(&length) {
        register ^= u32::from(*byte);
        for _ in 0..8 {
            register = if register & 1 == 1 {
                register >> 1 ^ 0x82F6_3B78
            } else {
                register >> 1
            };
        }
    }
    !register
}

const DRIVE: &str = r#"{"c":"drive","v":0.2,"w":0,"ttl":250,"n":41,"t":81234}"#;

#[test]
fn crcs_agree_with_the_specification() {
    for (session, direction, sign) in [
        ("0", "to-robot", b'>'),
        ("4711", "to-robot", b'>'),
        ("4711", "from-robot", b'<'),
    ] {
        let output = rvac(
            [
                "packet",
                "crc",
                DRIVE,
                "--session",
                session,
                "--direction",
                direction,
            ],
            b"",
        );
        let crc = reference_crc(sign, session.parse().expect("a number"), DRIVE.as_bytes());
        assert_eq!(stdout(&output), format!("{DRIVE}*{crc:08X}\n"));
    }
}

#[test]
fn what_is_sealed_checks_in_its_own_session_only() {
    let with_crc = stdout(&rvac(["packet", "seal", "--session", "7"], DRIVE.as_bytes()));
    let good = rvac(["packet", "check", "--session", "7"], with_crc.as_bytes());
    assert_eq!(
        (stdout(&good).as_str(), good.status.code()),
        ("CRC right\n", Some(0))
    );
    let other = rvac(["packet", "check", "--session", "8"], with_crc.as_bytes());
    assert!(stdout(&other).starts_with("wrong CRC: "), "{}", stdout(&other));
    assert_eq!(other.status.code(), Some(1));
    let echo = rvac(
        ["packet", "check", "--session", "7", "--direction", "from-robot"],
        with_crc.as_bytes(),
    );
    assert_eq!(echo.status.code(), Some(1));
}

#[test]
fn meaning_and_refusals_are_shown_by_name() {
    let decode = |packet: &str| stdout(&rvac(["packet", "decode", packet], b""));
    assert!(decode(r#"{"c":"drive","v":0.2,"w":0}"#).contains("meaning: Drive("));
    assert!(decode(r#"{"c":"drive","v":99,"w":0}"#).contains("refused: range"));
    assert!(decode(r#"{"c":"drive","v":0.1,"v":0.1,"w":0}"#).contains("refused: duplicate"));
    assert!(decode(r#"{"c":"drive","v":0.1,"w":0,"x":1}"#).contains("refused: key"));
    assert!(decode(r#"{"c":"m"}"#).contains("refused: unknown"));
    assert!(decode("{\"c\":").contains("refused: "));
    assert!(decode(r#"{"c":"stop"}"#).contains("meaning: Stop"));
}

#[test]
fn reports_and_binary_packets_are_read() {
    let report = r#"{"c":"log","level":"warn","str":"brush"}"#;
    let output = rvac(["packet", "decode", report, "--direction", "from-robot"], b"");
    assert!(stdout(&output).contains("meaning: Log"), "{}", stdout(&output));
    // A binary drive: 0.1 m/s, no turn, 250 ms, number 1, tick 100000; its CRC little endian.
    let mut packet = vec![0x81];
    packet.extend(100_000_i32.to_le_bytes());
    packet.extend(0_i32.to_le_bytes());
    packet.extend(250_u16.to_le_bytes());
    packet.extend(1_u16.to_le_bytes());
    packet.extend(100_000_u32.to_le_bytes());
    packet.extend(reference_crc(b'>', 5, &packet).to_le_bytes());
    let stuffed = packet.iter().flat_map(|byte| match byte {
        0x1D..=0x1F => vec![0x1D, byte ^ 0x20],
        other => vec![*other],
    });
    let hex: String = stuffed.map(|byte| format!("{byte:02x}")).collect();
    let output = rvac(["packet", "decode", "--hex", "--session", "5", &hex], b"");
    assert!(
        stdout(&output).contains(r#"twin:    {"c":"drive","v":0.1"#),
        "{}",
        stdout(&output)
    );
    assert_eq!(output.status.code(), Some(0));
}

#[test]
fn several_packets_come_from_the_input_and_bad_input_is_named() {
    let output = rvac(
        ["packet", "decode"],
        b"{\"c\":\"info\"}\r\n\n{\"c\":\"state\"}\x1f{\"c\":\"nothing\"}\n",
    );
    assert_eq!(stdout(&output).matches("meaning: ").count(), 2);
    assert_eq!(stdout(&output).matches("refused: unknown").count(), 1);
    assert_eq!(output.status.code(), Some(1));
    let output = rvac(["packet", "decode", "--hex", "8xyz"], b"");
    assert!(
        String::from_utf8_lossy(&output.stderr).contains("hexadecimal"),
        "{output:?}"
    );
    let long = rvac(["packet", "seal", &"x".repeat(300)], b"");
    assert!(String::from_utf8_lossy(&long.stderr).contains("256"), "{long:?}");
    assert_eq!(long.status.code(), Some(1));
}

#[test]
fn errors_name_the_place_and_the_remedy() {
    let output = rvac(["status", "--socket", "/nowhere/vthal.sock"], b"");
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        text.contains("/nowhere/vthal.sock") && text.contains("--socket"),
        "{text}"
    );
    assert_eq!(output.status.code(), Some(1));
    let output = rvac(["term", "--port", "/nowhere/tty"], b"");
    assert!(
        String::from_utf8_lossy(&output.stderr).contains("/nowhere/tty"),
        "{output:?}"
    );
    let output = rvac(["replay", "/nowhere/run.mcap"], b"");
    assert!(
        String::from_utf8_lossy(&output.stderr).contains("/nowhere/run.mcap"),
        "{output:?}"
    );
}
