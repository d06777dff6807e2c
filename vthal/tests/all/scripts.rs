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

/// Runs a script and gives its lines.
fn run(interpreter: &str, name: &str) -> Vec<String> {
    let scratch = Scratch::new().expect("creates");
    let robot =
        SyntheticRobot::switch_on(&scratch.join("tty"), BinaryKinds::ALL, 1).expect("opens a terminal");
    let _robot = LivingRobot::new(robot);
    let _daemon = Daemon::start(Path::new(env!("CARGO_BIN_EXE_vthal")), &scratch, &["--seed", "1"])
        .expect("gets ready");
    let mut client = Client::watching(&scratch.join("vthal.sock"), r#"["status"]"#).expect("connects");
    let is_ready = |update: &Update| matches!(update, Update::Status(status) if status.state == "idle");
    let ready = client
        .wait_for(Instant::now() + PATIENCE, is_ready)
        .expect("reads");
    assert!(ready.is_some(), "the robot does not answer");
    let output = Command::new(interpreter)
        .arg(script(name))
        .arg(scratch.join("vthal.sock"))
        .output()
        .unwrap_or_else(|error| panic!("{interpreter}: {error}; cargo xtask test installs it"));
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    let complaint = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{said}{complaint}");
    said.lines().map(str::to_owned).collect()
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
fn python_starts_follows_and_stops_the_robot() {
    assert_followed(&run("python3", "robot.py"));
}

#[test]
fn raku_starts_follows_and_stops_the_robot() {
    assert_followed(&run("raku", "robot.raku"));
}

#[test]
fn node_starts_follows_and_stops_the_robot() {
    assert_followed(&run("node", "robot.mjs"));
}

#[test]
fn a_shell_starts_follows_and_stops_the_robot() {
    assert_followed(&run("sh", "robot.sh"));
}
