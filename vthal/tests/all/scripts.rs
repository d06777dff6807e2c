//! The scripts of the book, each in its own language, against the real daemon and a robot that answers.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use rvac_api::Update;
use rvac_protocol::message::BinaryKinds;
use vthal_bench::{Client, Daemon, LivingRobot, Scratch, SyntheticRobot};

/// Generous: the machine may be busy with other tests.
const PATIENCE: Duration = Duration::from_secs(20);

fn script(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../clients/scripts")
        .join(name)
}

/// A daemon with a robot that answers, ready for orders.
struct Stage {
    _robot: LivingRobot,
    _daemon: Daemon,
    scratch: Scratch,
}

impl Stage {
    fn new(scratch: Scratch, robot: SyntheticRobot) -> Self {
        let robot = LivingRobot::new(robot);
        let daemon = Daemon::start(Path::new(env!("CARGO_BIN_EXE_vthal")), &scratch, &["--seed", "1"])
            .expect("gets ready");
        let stage = Self {
            _robot: robot,
            _daemon: daemon,
            scratch,
        };
        let mut client = Client::watching(&stage.socket(), r#"["status"]"#).expect("connects");
        let is_ready = |update: &Update| matches!(update, Update::Status(status) if status.state == "idle");
        let ready = client
            .wait_for(Instant::now() + PATIENCE, is_ready)
            .expect("reads");
        assert!(ready.is_some(), "the robot does not answer");
        stage
    }

    /// On the floor of an unknown home.
    fn on_the_floor() -> Self {
        let scratch = Scratch::new().expect("creates");
        let robot = switch_on(&scratch);
        Self::new(scratch, robot)
    }

    fn socket(&self) -> PathBuf {
        self.scratch.join("vthal.sock")
    }

    /// Runs a job of a script and gives its lines.
    fn run(&self, language: (&str, &str), job: &str) -> Vec<String> {
        run_on(language, &self.socket(), job)
    }
}

fn switch_on(scratch: &Scratch) -> SyntheticRobot {
    SyntheticRobot::switch_on(&scratch.join("tty"), BinaryKinds::ALL, 1).expect("opens a terminal")
}

fn run_on((interpreter, name): (&str, &str), socket: &Path, job: &str) -> Vec<String> {
    let output = Command::new(interpreter)
        .arg(script(name))
        .arg(socket)
        .arg(job)
        .output()
        .unwrap_or_else(|error| panic!("{interpreter}: {error}; cargo xtask test installs it"));
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    let complaint = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{job}: {said}{complaint}");
    said.lines().map(str::to_owned).collect()
}

const PYTHON: (&str, &str) = ("python3", "robot.py");
const RAKU: (&str, &str) = ("raku", "robot.raku");
const NODE: (&str, &str) = ("node", "robot.mjs");
const SHELL: (&str, &str) = ("sh", "robot.sh");

/// The number between two words.
fn number(line: &str, before: &str, after: &str) -> f64 {
    line.strip_prefix(before)
        .and_then(|rest| rest.strip_suffix(after))
        .and_then(|number| number.parse().ok())
        .unwrap_or_else(|| panic!("{line:?} is no {before}...{after}"))
}

/// Telemetry comes, and is new.
fn assert_follows(stage: &Stage, language: (&str, &str)) {
    let lines = stage.run(language, "follow");
    assert_eq!(lines.len(), 6, "{lines:?}");
    for line in &lines[1..] {
        assert!(number(line, "telemetry: ", " ms old") < 2_000.0, "{lines:?}");
    }
}

/// Two seconds at 0.1 m/s, and nothing once the script has let go.
fn assert_drives(stage: &Stage, language: (&str, &str)) {
    let lines = stage.run(language, "drive");
    let [_, stopped, driven] = lines.as_slice() else {
        panic!("{lines:?}");
    };
    assert_eq!(stopped, "stopped");
    // A machine that is busy lets leases end.
    let driven_m = number(driven, "driven: ", " m");
    assert!((0.02..=0.4).contains(&driven_m), "{driven_m}");
}

/// What a script does in a home that the robot does not know.
fn assert_works(language: (&str, &str)) {
    let stage = Stage::on_the_floor();
    assert_follows(&stage, language);
    assert_drives(&stage, language);
    assert_followed(&stage.run(language, "start"));
}

/// What each of them says: who, what it does, where, and that it was stopped.
fn assert_followed(lines: &[String]) {
    let [robot, state, place, stopped] = lines else {
        panic!("{lines:?}");
    };
    assert_eq!(robot, "robot: synthetic");
    assert!(
        ["state: starting", "state: cleaning"].contains(&state.as_str()),
        "{state}"
    );
    assert!(place.starts_with("place: ") && place.contains(" m, "), "{place}");
    assert_eq!(stopped, "stopped");
}

#[test]
fn python_follows_drives_starts_and_stops() {
    assert_works(PYTHON);
}

#[test]
fn raku_follows_drives_starts_and_stops() {
    assert_works(RAKU);
}

#[test]
fn node_follows_drives_starts_and_stops() {
    assert_works(NODE);
}

#[test]
fn a_shell_follows_drives_starts_and_stops() {
    assert_works(SHELL);
}
