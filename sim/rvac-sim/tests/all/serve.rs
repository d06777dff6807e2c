//! The server as a process: terminal, socket, signals, bad input.

use crate::echo;
use crate::folder::Folder;
use std::fs::{self, File, OpenOptions};
use std::io::{BufRead, BufReader, Read, Write};
use std::net::Shutdown;
use std::os::unix::net::UnixStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::process::{Pid, Signal, kill_process};
use serde_json::Value;

const PATIENCE: Duration = Duration::from_secs(20);
const SEPARATOR: u8 = 0x1F;

fn link(folder: &Folder) -> PathBuf {
    folder.join("robot")
}

fn socket(folder: &Folder) -> PathBuf {
    folder.join("sim.sock")
}

fn home(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../homes")
        .join(name)
}

fn command(folder: &Folder, home: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_rvac-sim"));
    command.arg("serve").arg("--home").arg(home);
    command
        .arg("--link")
        .arg(link(folder))
        .arg("--socket")
        .arg(socket(folder));
    command
}

/// A server that has said `ready`; killed when dropped.
struct Server {
    child: Child,
    folder: Folder,
}

impl Server {
    fn start(name: &str, extra: &[&str]) -> Self {
        let folder = Folder::new(name);
        let mut child = command(&folder, &home("two-room-flat.toml"))
            .args(extra)
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut line = String::new();
        BufReader::new(child.stdout.take().unwrap())
            .read_line(&mut line)
            .unwrap();
        assert_eq!(line, "ready\n");
        Self { child, folder }
    }

    fn terminal(&self) -> File {
        OpenOptions::new()
            .read(true)
            .write(true)
            .open(link(&self.folder))
            .unwrap()
    }

    fn client(&self) -> Client {
        let stream = UnixStream::connect(socket(&self.folder)).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        Client(BufReader::new(stream))
    }

    fn terminate(&mut self) {
        let pid = Pid::from_child(&self.child);
        kill_process(pid, Signal::TERM).unwrap();
        assert!(self.child.wait().unwrap().success());
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        // Gone already when the test went well.
        self.child.kill().ok();
        self.child.wait().ok();
    }
}

struct Client(BufReader<UnixStream>);

impl Client {
    fn next(&mut self) -> Value {
        let mut message = Vec::new();
        self.0.read_until(SEPARATOR, &mut message).unwrap();
        assert_eq!(message.pop(), Some(SEPARATOR), "the server hung up");
        serde_json::from_slice(&message).unwrap()
    }

    fn next_of(&mut self, event: &str) -> Value {
        loop {
            let message = self.next();
            if message["e"] == event {
                return message;
            }
        }
    }

    fn say(&mut self, text: &str) {
        self.0.get_mut().write_all(text.as_bytes()).unwrap();
        self.0.get_mut().write_all(&[SEPARATOR]).unwrap();
    }
}

/// Reads from the terminal until `text` was seen.
fn read_until(terminal: &mut File, text: &str) -> String {
    let deadline = Instant::now() + PATIENCE;
    let mut seen = String::new();
    while !seen.contains(text) {
        let left = deadline.saturating_duration_since(Instant::now());
        assert!(!left.is_zero(), "waited in vain for {text} in {seen:?}");
        let timeout = Timespec::try_from(left).unwrap();
        poll(&mut [PollFd::new(&*terminal, PollFlags::IN)], Some(&timeout)).unwrap();
        let mut buffer = [0; 4096];
        let count = terminal.read(&mut buffer).unwrap();
        seen.push_str(&String::from_utf8_lossy(&buffer[..count]));
    }
    seen
}

#[test]
fn a_person_at_the_terminal_talks_to_the_robot_again_and_again() {
    let mut server = Server::start("terminal", &["--baud", "38400"]);
    for _ in 0..3 {
        let mut terminal = server.terminal();
        terminal.write_all(b"U\x1f{\"c\":\"info\"}\x1f").unwrap();
        read_until(&mut terminal, "cordlib-version");
    }
    server.terminate();
    assert!(
        fs::symlink_metadata(link(&server.folder)).is_err(),
        "the link is gone"
    );
    assert!(!socket(&server.folder).exists(), "the socket is gone");
}

#[test]
fn a_firmware_image_runs_behind_the_terminal() {
    let files = Folder::new("firmware");
    let image = files.join("echo.hex");
    fs::write(&image, echo::image()).unwrap();
    let server = Server::start(
        "emulated",
        &["--firmware", image.to_str().unwrap(), "--baud", "38400"],
    );
    for _ in 0..2 {
        let mut terminal = server.terminal();
        terminal.write_all(b"through every pin and back").unwrap();
        read_until(&mut terminal, "through every pin and back");
    }
    let mut client = server.client();
    client.say(r#"{"c":"report"}"#);
    assert_eq!(client.next_of("report")["monitor_violations"], 0);
}

#[test]
fn a_client_gets_plan_truth_and_report() {
    let server = Server::start("socket", &["--speed", "20"]);
    let mut client = server.client();
    let plan = client.next();
    assert_eq!(plan["e"], "simulated-plan");
    let cells: u64 = plan["cells"]
        .as_array()
        .unwrap()
        .iter()
        .skip(1)
        .step_by(2)
        .map(|run| run.as_u64().unwrap())
        .sum();
    assert_eq!(
        cells,
        plan["width"].as_u64().unwrap() * plan["height"].as_u64().unwrap()
    );
    let first = client.next_of("simulated-truth");
    let second = client.next_of("simulated-truth");
    let passed_s = second["sim_s"].as_f64().unwrap() - first["sim_s"].as_f64().unwrap();
    assert!(
        passed_s > 0.2,
        "20 times real time, ten truths a second: {passed_s} s between two"
    );
    client.say(r#"{"c":"report"}"#);
    let report = client.next_of("report");
    assert!(report["reachable_area_m2"].as_f64().unwrap() > 10.0);
    assert_eq!(report["monitor_violations"], 0);
    assert!(report["pose_rmse_m"].is_null());
    client.say("{}");
    assert_eq!(client.next_of("failed")["reason"], "unknown");
}

#[test]
fn a_client_plays_with_the_robot() {
    let server = Server::start("play", &[]);
    let mut client = server.client();
    let mut terminal = server.terminal();
    client.say(r#"{"c":"lift"}"#);
    read_until(&mut terminal, r#""e":"lift""#);
    client.say(r#"{"c":"put-down"}"#);
    client.say(r#"{"c":"press","button":1}"#);
    assert_eq!(client.next_of("done")["e"], "done");
    read_until(&mut terminal, r#""e":"button""#);
}

#[test]
fn who_has_asked_all_still_gets_the_answer() {
    let server = Server::start("asked", &["--speed", "20"]);
    let mut client = server.client();
    client.say(r#"{"c":"turn","turns":0.5}"#);
    client.0.get_ref().shutdown(Shutdown::Write).unwrap();
    client.next_of("done");
}

#[test]
fn a_client_that_never_reads_holds_nobody_up() {
    let server = Server::start("stalled", &["--speed", "20"]);
    let stalled = UnixStream::connect(socket(&server.folder)).unwrap();
    let mut client = server.client();
    let mut dead = server.client();
    dead.say(r#"{"c":"report"}"#);
    drop(dead);
    for _ in 0..2_000 {
        client.say(r#"{"c":"report"}"#);
        client.next_of("report");
    }
    let before = client.next_of("simulated-truth")["sim_s"].as_f64().unwrap();
    let after = client.next_of("simulated-truth")["sim_s"].as_f64().unwrap();
    assert!(after > before);
    drop(stalled);
}

fn refused(mut command: Command) -> String {
    let Output {
        status,
        stdout,
        stderr,
    } = command.output().unwrap();
    let text = String::from_utf8(stderr).unwrap();
    assert_eq!(status.code(), Some(2), "{text}");
    assert_eq!(stdout, b"", "{text}");
    assert_eq!(text.lines().count(), 1, "one sentence: {text}");
    text
}

#[test]
fn bad_input_gets_one_sentence_and_leaves_nothing_behind() {
    let folder = Folder::new("bad");
    let cut = folder.join("cut.json");
    fs::write(&cut, r#"{"__class":"ValetudoMap","metaData":{"version":2"#).unwrap();
    let wrong = folder.join("wrong.toml");
    fs::write(
        &wrong,
        "format = \"librervac-home\"\nversion = 1\n[[room]]\npolygon = 7\n",
    )
    .unwrap();
    let known = home("two-room-flat.toml");
    let cases = [
        (folder.join("none.toml"), vec![], "none.toml"),
        (cut.clone(), vec![], "cut.json"),
        (wrong.clone(), vec![], "line 4"),
        (known.clone(), vec!["--robot", "r2d2"], "r2d2"),
        (known.clone(), vec!["--noise", "loud"], "loud"),
        (
            known.clone(),
            vec!["--link", "/nonexistent/robot"],
            "/nonexistent/robot",
        ),
        (
            known,
            vec!["--socket", "/nonexistent/socket"],
            "/nonexistent/socket",
        ),
    ];
    for (home, extra, named) in cases {
        let mut command = Command::new(env!("CARGO_BIN_EXE_rvac-sim"));
        command.arg("serve").arg("--home").arg(&home).args(&extra);
        for (flag, path) in [("--link", link(&folder)), ("--socket", socket(&folder))] {
            if !extra.contains(&flag) {
                command.arg(flag).arg(path);
            }
        }
        let text = refused(command);
        assert!(text.contains(named), "{text} does not name {named}");
        assert!(
            fs::symlink_metadata(link(&folder)).is_err() && !socket(&folder).exists(),
            "{text}"
        );
    }
    fs::write(link(&folder), "precious").unwrap();
    assert!(refused(command(&folder, &home("two-room-flat.toml"))).contains("robot"));
    assert_eq!(fs::read_to_string(link(&folder)).unwrap(), "precious");
    assert!(!socket(&folder).exists());
}
