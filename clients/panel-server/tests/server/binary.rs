//! The binary as people start it.

use std::io::{BufRead, BufReader};
use std::net::TcpListener;
use std::process::{Command, Stdio};

use rustix::process::{Pid, Signal, kill_process};

use crate::folder::Folder;
use crate::rig::assets;

fn command(port: &str, assets: &Folder) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_panel-server"));
    command
        .args(["--vthal", "/nonexistent.sock", "--port", port, "--assets"])
        .arg(&**assets);
    command
}

#[test]
fn a_port_in_use_is_one_sentence_and_code_2() {
    let taken = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port().to_string();
    let output = command(&port, &assets()).output().unwrap();
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{text}");
    assert_eq!(text.lines().count(), 1, "{text}");
    assert!(text.contains(&port) && text.contains("already in use"), "{text}");
    assert!(output.stdout.is_empty());
}

#[test]
fn the_network_is_refused_with_code_2() {
    let output = command("0", &assets())
        .args(["--bind", "0.0.0.0"])
        .output()
        .unwrap();
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{text}");
    assert!(
        text.contains("could drive the robot") && text.contains("--state"),
        "{text}"
    );
}

#[test]
fn ready_is_printed_when_it_listens_and_it_ends_by_signal() {
    let assets = assets();
    let mut child = command("0", &assets)
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let mut line = String::new();
    BufReader::new(child.stdout.take().unwrap())
        .read_line(&mut line)
        .unwrap();
    let address = line
        .trim()
        .strip_prefix("ready http://")
        .and_then(|rest| rest.strip_suffix('/'))
        .unwrap()
        .to_owned();
    std::net::TcpStream::connect(address).unwrap();
    kill_process(Pid::from_child(&child), Signal::TERM).unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(0));
}
