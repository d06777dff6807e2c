//! The binary as people start it.

use std::io::{BufRead, BufReader};
use std::net::{TcpListener, UdpSocket};
use std::os::unix::net::UnixDatagram;
use std::process::{Command, Stdio};
use std::time::Duration;

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

/// What a socket of systemd's hears, within ten seconds for each word.
fn hear(socket: &UnixDatagram, wanted: &[&str]) {
    socket.set_read_timeout(Some(Duration::from_secs(10))).unwrap();
    for word in wanted {
        let mut bytes = [0; 256];
        let count = socket
            .recv(&mut bytes)
            .unwrap_or_else(|error| panic!("{word}: {error}"));
        assert_eq!(String::from_utf8_lossy(&bytes[..count]).trim_end(), *word);
    }
}

#[test]
fn systemd_hears_when_it_is_ready_that_it_lives_and_when_it_ends() {
    let folder = Folder::new();
    let socket = UnixDatagram::bind(folder.join("notify.sock")).unwrap();
    let assets = assets();
    let mut child = command("0", &assets)
        .env("NOTIFY_SOCKET", folder.join("notify.sock"))
        .env("WATCHDOG_USEC", "200000")
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    hear(&socket, &["READY=1", "WATCHDOG=1", "WATCHDOG=1", "WATCHDOG=1"]);
    kill_process(Pid::from_child(&child), Signal::TERM).unwrap();
    let mut last = String::new();
    while last != "STOPPING=1" {
        let mut bytes = [0; 256];
        let count = socket.recv(&mut bytes).unwrap();
        last = String::from_utf8_lossy(&bytes[..count]).trim_end().to_owned();
    }
    child.wait().unwrap();
}

/// A question for robots, as any program on the network asks it: one PTR question for `_librervac._tcp.local` (RFC 6763).
const QUESTION: &[u8] = b"\0\0\0\0\0\x01\0\0\0\0\0\0\x0a_librervac\x04_tcp\x05local\0\0\x0c\0\x01";

/// Whether this machine is on a network; loopback alone has no multicast.
fn has_network() -> bool {
    if_addrs::get_if_addrs()
        .unwrap()
        .iter()
        .any(|interface| !interface.is_loopback() && interface.ip().is_ipv4())
}

#[test]
fn its_name_is_announced_to_whoever_asks_the_network() {
    if !has_network() {
        println!("passed over: this machine is on no network");
        return;
    }
    let (folder, assets) = (Folder::new(), assets());
    let mut child = command("0", &assets)
        .args(["--bind", "0.0.0.0", "--announce", "--state"])
        .arg(folder.join("state"))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let socket = UdpSocket::bind("0.0.0.0:0").unwrap();
    socket.set_read_timeout(Some(Duration::from_millis(500))).unwrap();
    let mut answer = Vec::new();
    for _ in 0..40 {
        socket.send_to(QUESTION, "224.0.0.251:5353").unwrap();
        let mut bytes = [0; 4096];
        if let Ok(count) = socket.recv(&mut bytes) {
            answer = bytes[..count].to_vec();
            if holds(&answer, b"rvac-") {
                break;
            }
        }
    }
    kill_process(Pid::from_child(&child), Signal::TERM).unwrap();
    child.wait().unwrap();
    assert!(holds(&answer, b"rvac-"), "{}", String::from_utf8_lossy(&answer));
}

fn holds(bytes: &[u8], part: &[u8]) -> bool {
    bytes.windows(part.len()).any(|window| window == part)
}
