//! What Rust says of packets, in the words of `host/verdicts.c`, and the golden vectors as cases.

use cord_c::host::{folder, from_hex, hex};
use rvac_protocol::crc::Direction;
use rvac_protocol::frame::{Framed, Framer, Poison};
use rvac_protocol::message::{Command, LedPattern, Probe, ProbeTarget, Refusal};
use rvac_protocol::text::{Form, is_stop, read_command};
use rvac_units::Tick;
use serde_json::Value;

/// The tick of hand mode.
pub(crate) const TICK: u32 = 5_000;

pub(crate) fn vectors(file: &str) -> Vec<Value> {
    let path = folder().join(format!("../../protocol/vectors/{file}.json"));
    let text = std::fs::read_to_string(&path).expect("the vectors");
    let mut file: Value = serde_json::from_str(&text).expect("JSON");
    match file["vectors"].take() {
        Value::Array(vectors) if !vectors.is_empty() => vectors,
        other => panic!("no vectors but {other}"),
    }
}

pub(crate) fn session(vector: &Value) -> u16 {
    vector["session"].as_u64().expect("a session") as u16
}

fn poison(poison: Poison) -> &'static str {
    match poison {
        Poison::TooLong => "too-long",
        Poison::ControlByte => "control-byte",
        Poison::FramingError => "framing-error",
        Poison::Overrun => "overrun",
    }
}

/// What Rust finds in a stream, in the program's words.
pub(crate) fn framing(stream: &[u8], session: u16) -> String {
    let mut framer = Framer::new(Direction::HostToRobot);
    framer.set_session(session);
    let mut out = String::new();
    for byte in stream {
        let told = match framer.push(*byte) {
            None => continue,
            Some(Framed::Unchecked(text)) => format!("open:{}", hex(text)),
            Some(Framed::Checked(text)) => format!("sealed:{}", hex(text)),
            Some(Framed::BadCrc { text, .. }) => format!("missealed:{}", hex(text)),
            Some(Framed::Binary { kind, body }) => format!("binary:{kind:02x}{}", hex(body)),
            Some(Framed::BinaryBadCrc) => "binary-missealed:".to_owned(),
            Some(Framed::Poisoned(reason)) => format!("{}:", poison(reason)),
        };
        out += " ";
        out += &told;
    }
    out
}

fn form(number: usize) -> Form {
    let now = Tick(TICK);
    [Form::Checked, Form::Hand { now }, Form::SealedHand { now }][number % 3]
}

fn place<T: PartialEq>(all: &[T], one: &T) -> usize {
    all.iter().position(|other| other == one).expect("one of all")
}

/// The program's fields of a command: what, detail, flag, value, second, lease, number, tick.
fn fields(command: &Command) -> [i64; 8] {
    use rvac_protocol::message::{Inhibit, Parameter};
    let sequence = command.sequence().map_or(0, |sequence| i64::from(sequence.0));
    let plain = |what: usize, flag: bool| [what as i64, 0, i64::from(flag), 0, 0, 0, sequence, 0];
    match command {
        Command::Hello(hello) => {
            let kinds = i64::from(hello.binary.state) + 2 * i64::from(hello.binary.drive);
            [
                i64::from(hello.version_min.0),
                i64::from(hello.version_max.0),
                kinds,
                0,
                0,
                0,
                0,
                0,
            ]
        }
        Command::Describe { row } => plain(usize::from(*row), false),
        Command::Drive(_) | Command::Motor(_) | Command::Move(_) => motion_fields(command, sequence),
        Command::Beep(beep) => {
            let volume = i64::from(beep.volume.millionths());
            [
                0,
                0,
                0,
                i64::from(beep.pitch.0),
                volume,
                i64::from(beep.duration_ms),
                0,
                0,
            ]
        }
        Command::Led(led) => {
            let pattern = place(&LedPattern::ALL, &led.pattern) as i64;
            [
                i64::from(led.led),
                pattern,
                0,
                i64::from(led.brightness.millionths()),
                0,
                0,
                0,
                0,
            ]
        }
        Command::Arm { undock, .. } => plain(0, *undock),
        Command::Clear { inhibit, .. } => plain(place(&Inhibit::ALL, inhibit), false),
        Command::Set { parameter, value, .. } => {
            let what = place(&Parameter::ALL, parameter) as i64;
            [what, 0, 0, i64::from(*value), 0, 0, sequence, 0]
        }
        Command::Seen { event } => [0, 0, 0, 0, 0, 0, i64::from(*event), 0],
        Command::Charge { wanted, .. } => plain(0, *wanted),
        Command::Probe(probe) => probe_fields(probe, sequence),
        Command::Hand | Command::Info | Command::State | Command::Stop | Command::Ping { .. } => {
            plain(0, false)
        }
    }
}

/// The same of motion.
fn motion_fields(command: &Command, sequence: i64) -> [i64; 8] {
    match command {
        Command::Drive(drive) => [
            0,
            0,
            0,
            i64::from(drive.speed.0),
            i64::from(drive.turn.0),
            i64::from(drive.lease_ms),
            sequence,
            i64::from(drive.seen_tick.0),
        ],
        Command::Motor(motor) => [
            place(&rvac_protocol::message::Motor::ALL, &motor.motor) as i64,
            0,
            0,
            i64::from(motor.throttle.millionths()),
            0,
            i64::from(motor.lease_ms),
            sequence,
            i64::from(motor.seen_tick.0),
        ],
        Command::Move(movement) => [
            0,
            0,
            0,
            i64::from(movement.length.0),
            movement
                .radius
                .map_or(i64::from(i32::MIN), |radius| i64::from(radius.0)),
            0,
            sequence,
            i64::from(movement.seen_tick.0),
        ],
        _ => [0; 8],
    }
}

/// The same of a probe.
fn probe_fields(probe: &Probe, sequence: i64) -> [i64; 8] {
    let (what, port, baud) = match probe.target {
        ProbeTarget::Analog => (0, 0, 0),
        ProbeTarget::Encoders => (1, 0, 0),
        ProbeTarget::Lines => (2, 0, 0),
        ProbeTarget::Buttons => (3, 0, 0),
        ProbeTarget::Serial { port, baud } => (4, i64::from(port), i64::from(baud)),
    };
    [what, port, 0, baud, 0, i64::from(probe.lease_ms), sequence, 0]
}

/// Rust's verdict on a text, in the program's words.
pub(crate) fn verdict(text: &[u8], number: usize) -> String {
    let stop = u8::from(is_stop(text));
    match read_command(text, form(number)) {
        Ok(command) => {
            let fields = fields(&command).map(|field| field.to_string()).join(" ");
            format!("{stop} command {} {fields}", command.name() as u8)
        }
        Err(refused) => {
            let why = place(&Refusal::ALL, &refused.refusal) + 1;
            let sequence = refused
                .sequence
                .map_or("-".to_owned(), |number| number.0.to_string());
            format!("{stop} refused {why} {sequence}")
        }
    }
}

/// What a cord is asked.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Question {
    /// Packets in a stream, with the CRCs of this session.
    Stream(u16, Vec<u8>),
    /// A command in a text; the number says how strict.
    Text(usize, Vec<u8>),
}

/// A question and what is right.
pub(crate) type Case = (Question, String);

pub(crate) fn stream_case(stream: &[u8], session: u16) -> Case {
    (
        Question::Stream(session, stream.to_vec()),
        framing(stream, session),
    )
}

pub(crate) fn text_case(text: &[u8], number: usize) -> Case {
    (Question::Text(number, text.to_vec()), verdict(text, number))
}

/// The golden vectors themselves say what is right; Rust's own tests hold Rust to them.
pub(crate) fn golden() -> Vec<Case> {
    let mut cases = Vec::new();
    for vector in vectors("framing") {
        let stream = from_hex(vector["stream_hex"].as_str().expect("a stream"));
        cases.push(stream_case(&stream, session(&vector)));
    }
    for vector in vectors("seals") {
        let text = vector["packet"].as_str().expect("a packet");
        if vector["direction"] == ">" && !text.is_empty() {
            let stream = format!("{text}*{}\u{1f}", vector["seal"].as_str().expect("a CRC"));
            let expected = format!(" sealed:{}", hex(text.as_bytes()));
            let question = Question::Stream(session(&vector), stream.into_bytes());
            cases.push((question, expected));
        }
    }
    for vector in vectors("commands") {
        let line = vector["line"].as_str().expect("a line");
        cases.push(stream_case(format!("{line}\u{1f}").as_bytes(), session(&vector)));
        let text = line.rsplit_once('*').expect("a CRC").0;
        (0..3).for_each(|number| cases.push(text_case(text.as_bytes(), number)));
        if let Some(digits) = vector["binary_line_hex"].as_str() {
            let stream = [from_hex(digits), vec![0x1F]].concat();
            cases.push(stream_case(&stream, session(&vector)));
        }
    }
    for vector in vectors("refused").into_iter().chain(vectors("tolerated")) {
        let text = vector["text"].as_str().expect("a text");
        (0..3).for_each(|number| cases.push(text_case(text.as_bytes(), number)));
    }
    assert!(cases.len() > 500, "{} cases", cases.len());
    cases
}
