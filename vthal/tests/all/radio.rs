//! Radios on pseudo terminals, FIFOs and sockets before the real binary, and one before the simulator's, which must be built:
//! `cargo build -p rvac-sim`. Waits are for events, with a deadline.

use std::fs;
use std::io::Write;
use std::os::unix::net::UnixListener;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use rustix::fs::{Mode, mkfifoat};
use rvac_api::Update;
use vthal_bench::{Client, Daemon, Pty, Scratch, built_beside};

/// Generous: the machine may be busy with other tests.
const PATIENCE: Duration = Duration::from_secs(30);

/// A daemon with a radio, and the folder in which it lives.
struct Desk {
    scratch: Scratch,
    _daemon: Daemon,
}

impl Desk {
    /// With this table of the configuration besides the device; the device is `radio` in the folder, which `prepare` makes.
    fn new(table: &str, prepare: impl FnOnce(&Path)) -> Self {
        let scratch = Scratch::new().expect("creates");
        prepare(&scratch.join("radio"));
        let daemon = daemon(&scratch, table, &["--seed", "1"]);
        Self {
            scratch,
            _daemon: daemon,
        }
    }

    /// Waits until the daemon's log says this so many times.
    fn wait_for(&self, text: &str, times: usize) {
        wait_for_log(&self.scratch, text, times);
    }

    fn log(&self) -> String {
        log(&self.scratch)
    }
}

fn log(scratch: &Scratch) -> String {
    fs::read_to_string(scratch.join("state/log/vthal.log")).unwrap_or_default()
}

fn wait_for_log(scratch: &Scratch, text: &str, times: usize) {
    let deadline = Instant::now() + PATIENCE;
    loop {
        let log = log(scratch);
        if log.matches(text).count() >= times {
            return;
        }
        assert!(Instant::now() < deadline, "{text:?} is missing in {log}");
        std::thread::sleep(Duration::from_millis(20));
    }
}

fn daemon(scratch: &Scratch, table: &str, more: &[&str]) -> Daemon {
    let config = scratch.join("vthal.toml");
    let device = scratch.join("radio");
    let text = format!("[radio]\ndevice = {:?}\n{table}", device.display().to_string());
    fs::write(&config, text).expect("writable");
    let mut arguments = vec!["--config", config.to_str().expect("text")];
    arguments.extend(more);
    Daemon::start(Path::new(env!("CARGO_BIN_EXE_vthal")), scratch, &arguments).expect("gets ready")
}

/// Reads until the daemon has sent `wanted` to the module.
fn expect(module: &mut Pty, wanted: &[u8]) {
    let deadline = Instant::now() + PATIENCE;
    let mut all = Vec::new();
    while !all.windows(wanted.len()).any(|part| part == wanted) {
        assert!(Instant::now() < deadline, "only {all:?} came");
        module.wait(deadline).expect("waits");
        let mut bytes = [0; 64];
        let count = module.read(&mut bytes).expect("reads");
        all.extend_from_slice(&bytes[..count]);
    }
}

#[test]
fn a_module_is_made_to_speak_is_lost_and_comes_back() {
    let desk = Desk::new("form = \"dwm1001\"\n", |_| {});
    desk.wait_for("nothing of beacons: cannot open", 1);
    let link = desk.scratch.join("radio");
    let mut module = Pty::open(&link).expect("opens");
    expect(&mut module, b"\r\r");
    expect(&mut module, b"lec\r");
    module
        .write_all(
            b"\r\ndwm> lec\r\nDIST,1,AN0,1151,5.00,8.00,2.25,6.48,POS,2.57,1.98,1.68,100\r\nDIST,1,AN0\r\n",
        )
        .expect("writes");
    desk.wait_for("hears the beacon 1151 (number ", 1);
    desk.wait_for("lines that could not be used: 1; the last, \"DIST,1,AN0\"", 1);
    drop(module);
    desk.wait_for("nothing of beacons: it hung up", 1);
    let mut again = Pty::open(&link).expect("opens");
    // This one prints already, so nothing is sent to it.
    for _ in 0..40 {
        again
            .write_all(b"DIST,1,AN0,1151,5.00,8.00,2.25,6.48\r\n")
            .expect("writes");
        std::thread::sleep(Duration::from_millis(100));
    }
    desk.wait_for("the radio speaks of beacons", 2);
    let mut bytes = [0; 64];
    assert_eq!(again.read(&mut bytes).expect("reads"), 0);
    assert_eq!(
        desk.log().matches("hears the beacon").count(),
        1,
        "it keeps its number"
    );
}

#[test]
fn any_program_can_tell_distances_through_a_fifo() {
    let desk = Desk::new("beacons = [\"hall\", \"kitchen\"]\n", |path| {
        mkfifoat(rustix::fs::CWD, path, Mode::RUSR | Mode::WUSR).expect("makes one");
    });
    for round in 1..=2 {
        let path = desk.scratch.join("radio");
        let mut program = fs::OpenOptions::new().write(true).open(path).expect("opens");
        program
            .write_all(
                b"\n{\"beacon\":\"kitchen\",\"range_m\":3.21}\n{\"beacon\":\"kitchen\",\"range_m\":-1}\n",
            )
            .expect("writes");
        desk.wait_for("the radio speaks of beacons", 1);
        desk.wait_for("could not be used: 1; the last, \"{\\\"beacon\\\"", 1);
        assert!(
            !desk.log().contains("nothing of beacons"),
            "round {round}: a FIFO has no end"
        );
    }
}

#[test]
fn a_program_may_also_listen_on_a_socket() {
    let mut listener = None;
    let desk = Desk::new("", |path| listener = UnixListener::bind(path).ok());
    let (mut program, _) = listener.as_ref().expect("binds").accept().expect("accepts");
    program
        .write_all(b"\n{\"beacon\":\"hall\",\"range_m\":3.21,\"sigma_m\":0.3}\n")
        .expect("writes");
    desk.wait_for("hears the beacon hall (number ", 1);
    drop(program);
    desk.wait_for("nothing of beacons: it hung up", 1);
}

#[test]
fn a_file_is_no_radio() {
    let desk = Desk::new("", |path| fs::write(path, "{}\n").expect("writable"));
    desk.wait_for("is no serial device, FIFO or socket", 1);
}

/// Simulated seconds to a second on the wall.
const SPEED: &str = "8";
/// Metres that the daemon takes itself to have driven before it counts as under way: it has left its dock.
const UNDER_WAY_M: f64 = 0.5;

/// How well it knows its place by them is told on a virtual clock, in `scenarios/tests/all/beacons.rs`.
#[test]
fn a_relax_without_gyro_drives_by_a_radio_on_its_linux_board() {
    let scratch = Scratch::new().expect("creates");
    let _simulator = simulator(&scratch);
    let more = ["--seed", "4", "--speed", SPEED];
    let _daemon = daemon(&scratch, "form = \"dwm1001\"\n", &more);
    let topics = r#"["status","pose","decisions"]"#;
    let mut client = Client::watching(&scratch.join("vthal.sock"), topics).expect("connects");
    wait_for_state(&mut client, "docked");
    wait_for_log(&scratch, "hears the beacon", 4);
    start_systematic(&mut client);
    let deadline = Instant::now() + PATIENCE;
    let under_way =
        |update: &Update| matches!(update, Update::Pose(pose) if pose.x.hypot(pose.y) > UNDER_WAY_M);
    let moved = client.wait_for(deadline, under_way).expect("reads");
    assert!(moved.is_some(), "its pose does not follow");
}

fn wait_for_state(client: &mut Client, state: &str) {
    let reached = |update: &Update| matches!(update, Update::Status(status) if status.state == state);
    let found = client.wait_for(Instant::now() + PATIENCE, reached);
    assert!(found.expect("reads").is_some(), "it never is {state}");
}

/// Lets the robot clean in lanes. It takes that on as soon as it hears three beacons; the log names them a moment earlier.
fn start_systematic(client: &mut Client) {
    let deadline = Instant::now() + PATIENCE;
    loop {
        client
            .send(r#"{"c":"start","strategy":"systematic"}"#)
            .expect("sends");
        let mut refusal = None;
        client
            .wait_for(deadline, |update| match update {
                Update::Failed(failure) => {
                    refusal = Some(failure.reason.clone());
                    true
                }
                Update::Decision(decision) => decision.what == "find-heading",
                _ => false,
            })
            .expect("reads");
        match refusal.as_deref() {
            None => return,
            Some("no-heading" | "already-running") => std::thread::sleep(Duration::from_millis(50)),
            Some(other) => panic!("refused: {other}"),
        }
        assert!(Instant::now() < deadline, "it is never taken on");
    }
}

fn simulator(scratch: &Scratch) -> Daemon {
    let program = built_beside("rvac-sim").expect("has a folder");
    let program: PathBuf = program.expect("built: cargo build -p rvac-sim");
    let mut command = std::process::Command::new(program);
    let home = Path::new(env!("CARGO_MANIFEST_DIR")).join("../homes/two-room-flat.toml");
    command
        .args([
            "serve",
            "--robot",
            "relax",
            "--seed",
            "2",
            "--speed",
            SPEED,
            "--beacons",
            "4",
        ])
        .arg("--home")
        .arg(home);
    for (flag, name) in [("--link", "tty"), ("--socket", "sim.sock"), ("--radio", "radio")] {
        command.arg(flag).arg(scratch.join(name));
    }
    Daemon::start_command(command).expect("gets ready")
}
