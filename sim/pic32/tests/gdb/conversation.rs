//! What the debugger says and hears, packet by packet.

use crate::program::{COUNTER, FUNCTION, LOOP, machine};
use pic32::gdb::{DebugChip, DebugTarget, Session};
use pic32::machine::Grounded;

/// A packet around a text without special characters.
fn packet(text: &str) -> Vec<u8> {
    let sum = text.bytes().fold(0_u8, u8::wrapping_add);
    format!("${text}#{sum:02x}").into_bytes()
}

/// Says something and gives the answer without its frame. A running program is given some moments.
fn ask(session: &mut Session, target: &mut dyn DebugTarget, text: &str) -> String {
    session.receive(&packet(text), target);
    for _ in 0..10 {
        session.run(target);
    }
    let output = String::from_utf8(session.take_output()).expect("answers are ASCII");
    let answer = output
        .strip_prefix("+$")
        .unwrap_or_else(|| panic!("{text}: {output}"));
    let (answer, sum) = answer.split_at(answer.len() - 3);
    let right = answer.bytes().fold(0_u8, u8::wrapping_add);
    assert_eq!(sum, format!("#{right:02x}"), "{text}: {output}");
    answer.to_owned()
}

/// A register or word as the protocol writes it.
fn told(value: u32) -> String {
    value
        .to_le_bytes()
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect()
}

#[test]
fn a_program_is_stopped_looked_at_changed_and_continued() {
    let (mut machine, mut around) = (machine(), Grounded);
    let mut chip = DebugChip::new(&mut machine, &mut around);
    let mut session = Session::new();
    let mut says = |text: &str| ask(&mut session, &mut chip, text);
    let talk = [
        ("?", "T05thread:1;".to_owned()),
        ("p25", told(0xBFC0_0000)),
        (&format!("Z0,{FUNCTION:x},4"), "OK".to_owned()),
        ("c", "T05thread:1;swbreak:;".to_owned()),
        ("p25", told(FUNCTION)),
        ("p2", told(1)),
        ("p1f", told(LOOP + 12)),
        (&format!("m{COUNTER:x},4"), told(1)),
        ("vCont;c", "T05thread:1;swbreak:;".to_owned()),
        // Where a breakpoint is, the debugger takes it away before it steps.
        (&format!("z0,{FUNCTION:x},4"), "OK".to_owned()),
        ("s", "T05thread:1;".to_owned()),
        ("p25", told(FUNCTION + 4)),
        // The jump takes its delay slot along.
        ("vCont;s:1", "T05thread:1;".to_owned()),
        ("p25", told(LOOP + 12)),
        (&format!("P2={}", told(0x1000)), "OK".to_owned()),
        (&format!("Z1,{FUNCTION:x},4"), "OK".to_owned()),
        ("c", "T05thread:1;swbreak:;".to_owned()),
        (&format!("m{COUNTER:x},4"), told(0x1001)),
        (&format!("M{COUNTER:x},2:beef"), "OK".to_owned()),
        (&format!("m{COUNTER:x},4"), "beef0000".to_owned()),
        ("m9d000000,4", told(0x2442_0001)),
        ("m0,4", "E14".to_owned()),
        ("m80007ffe,4", "E14".to_owned()),
        ("Z0,0,4", "E14".to_owned()),
        ("Z2,80000100,4", String::new()),
        ("p26", "xxxxxxxx".to_owned()),
        ("p48", "E22".to_owned()),
        ("mzz", "E22".to_owned()),
        ("what?", String::new()),
    ];
    for (text, expected) in talk {
        assert_eq!(says(text), expected, "{text}");
    }
}

#[test]
fn all_registers_go_out_and_come_in() {
    let (mut machine, mut around) = (machine(), Grounded);
    let mut chip = DebugChip::new(&mut machine, &mut around);
    let mut session = Session::new();
    let registers = ask(&mut session, &mut chip, "g");
    assert_eq!(registers.len(), 38 * 8);
    let mut words: Vec<String> = (0..38).map(|number| told(0x1100_0000 + number)).collect();
    // Status keeps what can be written; Cause, too.
    words[32] = told(0x0040_0004);
    words[36] = told(0x0080_0000);
    words[37] = told(LOOP);
    assert_eq!(
        ask(&mut session, &mut chip, &format!("G{}", words.concat())),
        "OK"
    );
    words[0] = told(0);
    words[35] = told(0);
    assert_eq!(ask(&mut session, &mut chip, "g"), words.concat());
}

#[test]
fn a_running_program_is_interrupted() {
    let (mut machine, mut around) = (machine(), Grounded);
    let mut chip = DebugChip::new(&mut machine, &mut around);
    let mut session = Session::new();
    session.receive(&packet("c"), &mut chip);
    for _ in 0..3 {
        session.run(&mut chip);
        assert!(session.is_running());
    }
    assert_eq!(session.take_output(), b"+");
    session.receive(b"\x03", &mut chip);
    assert_eq!(session.take_output(), packet("T02thread:1;"));
    assert!(!session.is_running());
    let cycle = chip.cycle();
    assert!(cycle >= 3 * 800_000, "{cycle}");
    // Time stands while the program does.
    session.run(&mut chip);
    assert_eq!(chip.cycle(), cycle);
}

#[test]
fn a_fault_of_the_program_stops_it() {
    let (mut machine, mut around) = (machine(), Grounded);
    machine.cpu_mut().set_register(5, 0x0040_0000);
    let mut chip = DebugChip::new(&mut machine, &mut around);
    let mut session = Session::new();
    assert_eq!(ask(&mut session, &mut chip, "c"), "T0bthread:1;");
    assert_eq!(ask(&mut session, &mut chip, "?"), "T0bthread:1;");
    // At the vector of boot flash, for a bus error.
    assert_eq!(ask(&mut session, &mut chip, "p25"), told(0xBFC0_0380));
    assert_eq!(ask(&mut session, &mut chip, "p24"), told(7 << 2));
}

#[test]
fn registers_of_the_chip_are_memory_too() {
    let (mut machine, mut around) = (machine(), Grounded);
    let mut chip = DebugChip::new(&mut machine, &mut around);
    let mut session = Session::new();
    // LATA: all but bits 8 and 11 to 13 exist.
    assert_eq!(ask(&mut session, &mut chip, "Mbf886020,4:2301ffff"), "OK");
    let [low, high] = [0x23, 0x01];
    let found = ask(&mut session, &mut chip, "mbf886020,4");
    assert_eq!(found, format!("{low:02x}{:02x}0000", high & 0xC6));
    assert_eq!(ask(&mut session, &mut chip, "mbf886020,1"), "23");
    assert_eq!(ask(&mut session, &mut chip, "Mbf886021,1:00"), "E14");
}

#[test]
fn the_chip_can_be_reset_and_asked_for_the_time() {
    let (mut machine, mut around) = (machine(), Grounded);
    let mut chip = DebugChip::new(&mut machine, &mut around);
    let mut session = Session::new();
    for _ in 0..8 {
        ask(&mut session, &mut chip, "s");
    }
    let hex = |text: &str| text.bytes().map(|byte| format!("{byte:02x}")).collect::<String>();
    let cycle = chip.cycle();
    let answer = ask(&mut session, &mut chip, &format!("qRcmd,{}", hex("cycle")));
    assert_eq!(answer, hex(&format!("{cycle} cycles of SYSCLK since power-on\n")));
    ask(&mut session, &mut chip, &format!("qRcmd,{}", hex("reset")));
    assert_eq!(ask(&mut session, &mut chip, "p25"), told(0xBFC0_0000));
}

#[test]
fn damage_on_the_way_is_repaired() {
    let (mut machine, mut around) = (machine(), Grounded);
    let mut chip = DebugChip::new(&mut machine, &mut around);
    let mut session = Session::new();
    session.receive(b"$?#00", &mut chip);
    assert_eq!(session.take_output(), b"-");
    session.receive(b"$?#3f", &mut chip);
    let answer = session.take_output();
    session.receive(b"-", &mut chip);
    assert_eq!(session.take_output(), answer[1..]);
    assert_eq!(ask(&mut session, &mut chip, "QStartNoAckMode"), "OK");
    session.receive(b"+$?#3f", &mut chip);
    assert_eq!(session.take_output(), answer[1..]);
}

#[test]
fn the_description_comes_in_pieces() {
    let (mut machine, mut around) = (machine(), Grounded);
    let mut chip = DebugChip::new(&mut machine, &mut around);
    let mut session = Session::new();
    let mut text = String::new();
    loop {
        let place = text.len();
        let answer = ask(
            &mut session,
            &mut chip,
            &format!("qXfer:features:read:target.xml:{place:x},100"),
        );
        text.push_str(&answer[1..]);
        if answer.starts_with('l') {
            break;
        }
        assert_eq!(answer.len(), 0x101);
    }
    assert!(text.starts_with("<?xml") && text.ends_with("</target>"));
    assert_eq!(text.matches("<reg ").count(), 38 + 34);
}

#[test]
fn no_bytes_make_it_fail() {
    let (mut machine, mut around) = (machine(), Grounded);
    let mut chip = DebugChip::new(&mut machine, &mut around);
    let mut session = Session::new();
    let words = [
        "g",
        "G12",
        "p",
        "pffffffff",
        "P2",
        "P2=1",
        "m",
        "m,",
        "mffffffff,ffffffff",
        "M80000000,4:12",
        "X80000000,2:}",
    ];
    let more = [
        "Z",
        "Z0",
        "Z0,",
        "z9,0,0",
        "qXfer:features:read:target.xml:ffffffff,ffffffff",
        "qRcmd,zz",
        "vCont;",
        "v",
        "",
    ];
    for text in words.into_iter().chain(more) {
        let answer = ask(&mut session, &mut chip, text);
        assert!(answer.len() < 0x4000, "{text}");
    }
    for byte in 0..=u8::MAX {
        session.receive(&[b'$', byte, byte, b'#', b'0', b'0', byte], &mut chip);
    }
    session.take_output();
    assert!(ask(&mut session, &mut chip, "?").starts_with('T'));
}
