//! `rvac term` against a robot's end of the link on a pseudo-terminal.

use crate::program;
use std::ffi::OsStr;
use std::os::fd::AsRawFd as _;
use std::path::PathBuf;
use std::process::Output;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use rvac_protocol::PacketBuffer;
use rvac_protocol::message::{
    BinaryKinds, Capabilities, Command, Description, Limits, MotorGaps, Name, Refusal, Report, ResetCause,
    State,
};
use rvac_protocol::session::{RobotEvent, RobotIdentity, RobotSession};
use rvac_units::{AngularSpeed, Length, Speed, Tick};
use serial2::SerialPort;

fn identity() -> RobotIdentity {
    let limits = Limits {
        speed_max: Speed::from_m_per_s(0.35),
        turn_max: AngularSpeed::from_rad_per_s(1.5),
        track: Length::from_m(0.23),
        count_nm: 500_000,
        radius: Length::from_m(0.175),
        swath: Length::from_m(0.3),
    };
    RobotIdentity {
        device: Name::try_from("test").expect("short"),
        firmware: Name::try_from("1").expect("short"),
        boot_count: 1,
        reset_cause: ResetCause::PowerOn,
        session_seed: 7,
        binary: BinaryKinds {
            state: true,
            drive: true,
        },
        description: Description {
            capabilities: Capabilities::default(),
            limits,
            motors: MotorGaps::default(),
        },
    }
}

/// A robot on a pseudo-terminal. It answers everything and reports which commands it was given.
struct Robot {
    path: PathBuf,
    commands: Receiver<Command>,
    over: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
    /// Keeps the terminal's other end open.
    _slave: SerialPort,
}

impl Robot {
    fn start() -> Self {
        let (mut line, slave) = SerialPort::pair().expect("a pseudo-terminal");
        line.set_read_timeout(Duration::from_millis(5))
            .expect("a timeout");
        let path = std::fs::read_link(format!("/proc/self/fd/{}", slave.as_raw_fd())).expect("a name");
        let (sender, commands) = channel();
        let over = Arc::new(AtomicBool::new(false));
        let thread = std::thread::spawn({
            let over = Arc::clone(&over);
            move || live(&line, &sender, &over)
        });
        Self {
            path,
            commands,
            over,
            thread: Some(thread),
            _slave: slave,
        }
    }
}

impl Drop for Robot {
    fn drop(&mut self) {
        self.over.store(true, Ordering::Relaxed);
        self.thread.take().map(JoinHandle::join);
    }
}

fn live(line: &SerialPort, commands: &Sender<Command>, over: &AtomicBool) {
    let start = Instant::now();
    let now = || Tick(10_000 + start.elapsed().as_millis() as u32);
    let mut session = RobotSession::new(identity(), now());
    let mut buffer = PacketBuffer::new();
    let mut chunk = [0; 256];
    let mut state_due = now();
    while !over.load(Ordering::Relaxed) {
        let count = line.read(&mut chunk).unwrap_or(0);
        for byte in &chunk[..count] {
            if let Some(RobotEvent::Command(command)) = session.receive(*byte, now()) {
                if let Some(sequence) = command.sequence().filter(|_| command.must_arrive()) {
                    let refusal = matches!(command, Command::Clear { .. }).then_some(Refusal::CauseRemains);
                    session.answer(sequence, refusal);
                }
                commands.send(command).ok();
            }
        }
        while session.poll(now()).is_some() {}
        if now().reached(state_due) {
            state_due = now().after(50);
            buffer.clear();
            let state = State {
                tick: now(),
                ..State::default()
            };
            session
                .encode(&Report::State(state), &mut buffer)
                .expect("it fits");
            line.write_all(buffer.as_bytes()).expect("room");
        }
        while session.next_packet(&mut buffer) {
            line.write_all(buffer.as_bytes()).expect("room");
        }
    }
}

fn term(robot: &Robot, more: &[&str], typed: &str) -> Output {
    let fixed = ["term", "--linger", "400", "--port"].map(OsStr::new);
    let arguments = fixed.into_iter().chain([robot.path.as_os_str()]);
    program::rvac(arguments.chain(more.iter().map(OsStr::new)), typed.as_bytes())
}

fn lines(output: &Output) -> Vec<String> {
    assert!(output.status.success(), "{output:?}");
    String::from_utf8_lossy(&output.stdout)
        .lines()
        .map(str::to_owned)
        .collect()
}

fn with<'a>(lines: &'a [String], parts: &[&str]) -> Vec<&'a String> {
    lines
        .iter()
        .filter(|line| parts.iter().all(|part| line.contains(part)))
        .collect()
}

#[test]
fn typed_packets_are_sealed_numbered_and_answered() {
    let robot = Robot::start();
    let typed = "{\"c\":\"arm\",\"undock\":false}\n{\"c\":\"drive\",\"v\":0.1,\"w\":0}\n{\"c\":\"clear\",\"inhibit\":\"runaway\"}\n";
    let shown = lines(&term(&robot, &[], typed));
    let commands: Vec<Command> = robot.commands.try_iter().collect();
    let armed = commands.iter().find_map(|command| match command {
        Command::Arm { sequence, .. } => Some(sequence.0),
        _ => None,
    });
    let armed = armed.unwrap_or_else(|| panic!("no arm in {commands:?}"));
    assert!(
        commands.iter().any(
            |command| matches!(command, Command::Drive(drive) if drive.speed == Speed::from_m_per_s(0.1)
            && drive.seen_tick.0 >= 10_000 && drive.lease_ms == 250)
        ),
        "{commands:?}"
    );
    assert_eq!(
        with(&shown, &["# session ", " with test is open"]).len(),
        1,
        "{shown:#?}"
    );
    assert!(!with(&shown, &[" > {\"c\":\"hello\""]).is_empty(), "{shown:#?}");
    assert!(
        !with(&shown, &[" < ", &format!("{{\"a\":{armed}}}")]).is_empty(),
        "{shown:#?}"
    );
    assert!(
        !with(&shown, &[" < ", "\"err\":\"cause-remains\""]).is_empty(),
        "{shown:#?}"
    );
    assert!(
        !with(&shown, &[" < {\"c\":\"state\"", "(binary)"]).is_empty(),
        "{shown:#?}"
    );
    assert!(
        !with(&shown, &[" > {\"c\":\"drive\"", "(binary)"]).is_empty(),
        "{shown:#?}"
    );
}

#[test]
fn a_packet_with_its_own_number_goes_as_it_stands_and_bad_ones_are_marked() {
    let robot = Robot::start();
    let typed = "{\"c\":\"drive\",\"v\":0.1,\"w\":0,\"ttl\":250,\"n\":9,\"t\":1}\n{\"c\":\"dance\"}\n";
    let shown = lines(&term(&robot, &["--skip", "state", "--skip", "ping"], typed));
    assert!(
        !robot
            .commands
            .try_iter()
            .any(|command| matches!(command, Command::Drive(_))),
        "it was stale"
    );
    assert_eq!(
        with(
            &shown,
            &[" > {\"c\":\"drive\",\"v\":0.1,\"w\":0,\"ttl\":250,\"n\":9,\"t\":1}"]
        )
        .len(),
        1,
        "{shown:#?}"
    );
    assert!(
        !with(&shown, &[" < ", "\"err\":\"stale\""]).is_empty(),
        "{shown:#?}"
    );
    assert_eq!(
        with(&shown, &[" > BAD {\"c\":\"dance\"} [refused: unknown]"]).len(),
        1,
        "{shown:#?}"
    );
    assert!(with(&shown, &["\"c\":\"state\""]).is_empty(), "skipped");
}

#[test]
fn by_hand_nothing_is_sealed() {
    let robot = Robot::start();
    let typed = "{\"c\":\"drive\",\"v\":0.3,\"w\":0}\nstop\n";
    let shown = lines(&term(&robot, &["--hand"], typed));
    let commands: Vec<Command> = robot.commands.try_iter().collect();
    assert!(
        commands.iter().any(
            |command| matches!(command, Command::Drive(drive) if drive.speed == Speed::from_m_per_s(0.1))
        ),
        "clamped to the speed of hand mode: {commands:?}"
    );
    assert!(commands.contains(&Command::Stop), "{commands:?}");
    assert_eq!(
        with(&shown, &[" > {\"c\":\"drive\"", "[no CRC]"]).len(),
        1,
        "{shown:#?}"
    );
    assert!(with(&shown, &["hello", " > "]).is_empty(), "{shown:#?}");
}

#[test]
fn a_silent_line_is_reported() {
    let (_line, slave) = SerialPort::pair().expect("a pseudo-terminal");
    let path = std::fs::read_link(format!("/proc/self/fd/{}", slave.as_raw_fd())).expect("a name");
    let (_, commands) = channel();
    let over = Arc::new(AtomicBool::new(true));
    let robot = Robot {
        path,
        commands,
        over,
        thread: None,
        _slave: slave,
    };
    let output = term(&robot, &[], "{\"c\":\"info\"}\n");
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(!output.status.success());
    assert!(text.contains("--hand") && text.contains("--baud"), "{text}");
}
