//! `rvac` on another computer: paired by a code, it does over TLS what it does over the daemon's socket, and speaks to no other robot.
#![allow(clippy::unwrap_used, reason = "in a test that is what a failure is")]

#[path = "../folder/mod.rs"]
mod folder;
#[path = "../stack/mod.rs"]
mod stack;

use std::io::Write as _;
use std::os::unix::fs::PermissionsExt as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::Duration;

use folder::Folder;
use stack::{Stack, binary};

/// A computer with its own settings.
struct Computer {
    settings: PathBuf,
    robot: String,
}

impl Computer {
    fn rvac(&self, words: &[&str], typed: &str) -> Output {
        let mut child = Command::new(binary("rvac"))
            .args(words)
            .args(["--robot", &self.robot])
            .env("XDG_CONFIG_HOME", &self.settings)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        child.stdin.take().unwrap().write_all(typed.as_bytes()).ok(); // It may not ask.
        child.wait_with_output().unwrap()
    }

    fn says(&self, words: &[&str]) -> String {
        printed(&self.rvac(words, ""))
    }

    fn until(&self, word: &str) {
        for _ in 0..200 {
            if self.says(&["status"]).contains(word) {
                return;
            }
            std::thread::sleep(Duration::from_millis(100));
        }
        panic!("never {word}: {}", self.says(&["status"]));
    }
}

fn printed(output: &Output) -> String {
    let [out, errors] =
        [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text).into_owned());
    format!("{out}{errors}")
}

fn here(stack: &Stack, words: &[&str]) -> Output {
    let mut command = Command::new(binary("rvac"));
    command
        .args(words)
        .arg("--socket")
        .arg(stack.daemon_socket())
        .output()
        .unwrap()
}

/// The code of a new window, and an address by which the robot is found without name resolution.
fn open(stack: &Stack) -> (String, Option<String>) {
    let said = stack.console(&["pair", "--role", "admin"]);
    let code = said.lines().find_map(|line| line.strip_prefix("Code: ")).unwrap();
    let is_address = |line: &&str| {
        let host = line.trim_start_matches("https://");
        line.starts_with("https://")
            && (host.starts_with('[') || host.starts_with(|c: char| c.is_ascii_digit()))
    };
    let address = said.lines().map(str::trim).find(is_address).map(str::to_owned);
    (code.to_owned(), address)
}

fn kept(settings: &Path) -> PathBuf {
    let mut files = std::fs::read_dir(settings.join("rvac/robots")).unwrap();
    files.next().unwrap().unwrap().path()
}

/// Both ways of asking for `word` give one answer.
fn reads_the_same(desk: &Computer, stack: &Stack, word: &str) {
    let ask_both = || (desk.rvac(&[word], ""), here(stack, &[word]));
    let (mut far, mut near) = ask_both();
    if printed(&far) != printed(&near) {
        (far, near) = ask_both(); // A minute of the clock in the answer may have ended between the two.
    }
    assert!(
        far.status.success() && near.status.success(),
        "{word}: {}",
        printed(&far)
    );
    assert_eq!(printed(&far), printed(&near), "{word}");
}

/// Packets of its own need a person beside the robot, or at its console.
fn types_packets(desk: &Computer, stack: &Stack) {
    let words = ["term", "--linger", "3000", "--skip", "state"];
    let refused = desk.rvac(&words, "{\"c\":\"info\"}\n");
    assert!(
        !refused.status.success() && printed(&refused).contains("(not-present)"),
        "{}",
        printed(&refused)
    );
    let listed = stack.console(&["clients"]);
    stack.console(&["clients", "vouch", listed.split_whitespace().next().unwrap()]);
    let typed = desk.rvac(&words, "{\"c\":\"info\"}\n");
    assert!(
        typed.status.success() && printed(&typed).contains("> {\"c\":\"info\""),
        "{}",
        printed(&typed)
    );
}

#[test]
fn rvac_does_over_tls_what_it_does_over_the_socket_and_only_with_its_own_robot() {
    let page = Folder::new();
    std::fs::write(page.join("index.html"), "<!doctype html><title>Panel</title>").unwrap();
    let mut stack = Stack::start_on_network(&page);
    let (code, address) = open(&stack);
    let Some(robot) = address else {
        println!("skipped: this machine has no address in a home network");
        return;
    };
    let desk = Computer {
        settings: page.join("settings"),
        robot,
    };
    let refused = desk.says(&["status"]);
    assert!(refused.contains("is not paired with"), "{refused}");
    let wrong = if code.starts_with('0') {
        "11111111\n"
    } else {
        "00000000\n"
    };
    let refused = printed(&desk.rvac(&["pair", "--name", "desk"], wrong));
    assert!(
        refused.contains("The code is wrong; 4 more attempts."),
        "{refused}"
    );
    let paired = printed(&desk.rvac(&["pair", "--name", "desk"], &format!("{code}\n")));
    assert!(paired.contains("with the role admin"), "{paired}");
    let mode = std::fs::metadata(kept(&desk.settings))
        .unwrap()
        .permissions()
        .mode();
    assert_eq!(mode & 0o777, 0o600);

    desk.until("docked"); // Before, what is known of the home changes from one answer to the next.
    for word in ["schedule", "history", "floor", "rooms", "mix"] {
        reads_the_same(&desk, &stack, word);
    }
    types_packets(&desk, &stack);
    assert!(desk.rvac(&["start"], "").status.success());
    desk.until("cleaning");
    assert!(desk.rvac(&["stop"], "").status.success());
    desk.until("stopped");

    stack.serve_as_another(&page);
    let refused = desk.says(&["status"]);
    assert!(
        refused.contains("is not the robot that this computer is paired with"),
        "{refused}"
    );
    stack.serve_as_before(&page);
    let number = stack.console(&["clients"]);
    stack.console(&["clients", "revoke", number.split_whitespace().next().unwrap()]);
    let refused = desk.says(&["status"]);
    assert!(
        refused.contains("does not know this computer any more"),
        "{refused}"
    );
}
