//! The examples of the book, typed into a shell in front of the real daemon, simulator and server.
//!
//! A block `sh` that a block `json` follows is run, and must print that: each line of the latter matches one line of the
//! output, in this order, others may be between. Numbers, texts and lists are examples; keys, and the words in `e`, `id`, `reason` and
//! `state`, are a promise. A block `sh` without such an answer defines what later ones use.
#![allow(clippy::unwrap_used, reason = "in a test that is what a failure is")]

#[path = "../folder/mod.rs"]
mod folder;
mod page;
#[path = "../stack/mod.rs"]
mod stack;

use std::fs;
use std::path::PathBuf;
use std::process::Command;
use std::time::{Duration, Instant};

use folder::Folder;
use page::Example;
use serde_json::Value;
use stack::Stack;

/// Keys whose values must be equal.
const EXACT: [&str; 4] = ["e", "id", "reason", "state"];

/// Longest wait for the robot to greet the daemon.
const READY_WITHIN: Duration = Duration::from_secs(20);

struct Shell {
    stack: Stack,
    page: Folder,
    /// Address of the server for paired devices.
    robot: String,
    /// Certificate that the robot's owner has written down.
    certificate: PathBuf,
    /// What the owner has given to a program in the role `drive`.
    token: String,
}

impl Shell {
    fn open() -> Self {
        let page = Folder::new();
        fs::write(page.join("index.html"), "<!doctype html><title>Panel</title>").unwrap();
        let mut stack = Stack::start_with_page(&page);
        let address = stack.serve_guarded_besides(&page);
        let token = stack.console(&["clients", "add", "Home automation", "--role", "drive"]);
        let saved = stack.console(&["trust", "--save", page.to_str().unwrap()]);
        let certificate = saved.lines().find_map(|line| line.strip_prefix("wrote "));
        let name = saved
            .lines()
            .find_map(|line| line.strip_prefix("Robot:"))
            .unwrap()
            .trim();
        let port = address.trim_end_matches('/').rsplit(':').next().unwrap();
        // Nobody in a test announces the robot's name.
        let found = format!("resolve = \"{name}:{port}:127.0.0.1\"\n");
        fs::write(page.join(".curlrc"), found).unwrap();
        Self {
            robot: format!("https://{name}:{port}"),
            certificate: certificate.filter(|path| path.ends_with(".pem")).unwrap().into(),
            token: token.trim().to_owned(),
            stack,
            page,
        }
    }

    /// What a shell prints for `script`.
    fn run(&self, script: &str) -> String {
        let output = Command::new("timeout")
            .args(["60", "sh", "-c", script])
            .env("RVAC_SOCKET", self.stack.daemon_socket())
            .env("RVAC_SIMULATOR", self.stack.simulator_socket())
            .env("PANEL", self.stack.address.trim_end_matches('/'))
            .env("ROBOT", &self.robot)
            .env("CURL_HOME", &*self.page)
            .env("CERTIFICATE", &self.certificate)
            .env("TOKEN", &self.token)
            .output()
            .unwrap();
        assert!(output.status.code() != Some(124), "{script}\ndoes not end");
        let errors = String::from_utf8_lossy(&output.stderr);
        assert!(errors.is_empty(), "{script}\nsays {errors}");
        String::from_utf8(output.stdout).unwrap()
    }

    fn wait_until_ready(&self, example: &Example) {
        let deadline = Instant::now() + READY_WITHIN;
        loop {
            let printed = self.run(&example.script);
            if first_missing(example, &printed).is_none() {
                return;
            }
            assert!(Instant::now() < deadline, "{} prints\n{printed}", example.script);
        }
    }
}

/// The first promised line that is not among the printed ones.
fn first_missing<'a>(example: &'a Example, printed: &str) -> Option<&'a Value> {
    let printed: Vec<Value> = printed
        .lines()
        .filter_map(|line| serde_json::from_str(line).ok())
        .collect();
    let mut left = printed.iter();
    example
        .answers
        .iter()
        .find(|promised| !left.any(|found| keeps(found, promised)))
}

/// Whether `found` has all that `promised` has.
fn keeps(found: &Value, promised: &Value) -> bool {
    let (Value::Object(found), Value::Object(promised)) = (found, promised) else {
        return same_kind(found, promised);
    };
    promised.iter().all(|(key, value)| {
        let there = found.get(key);
        if EXACT.contains(&key.as_str()) {
            there == Some(value)
        } else {
            there.is_some_and(|there| keeps(there, value))
        }
    })
}

fn same_kind(one: &Value, other: &Value) -> bool {
    std::mem::discriminant(one) == std::mem::discriminant(other)
}

fn try_page(name: &str, text: &str) {
    let examples = page::examples(text);
    assert!(examples.len() > 3, "{name} has examples");
    let shell = Shell::open();
    // The first example asks who is there; the robot may need a moment to greet.
    shell.wait_until_ready(&examples[0]);
    for example in &examples {
        let printed = shell.run(&example.script);
        let missing = first_missing(example, &printed);
        assert!(
            missing.is_none(),
            "{name}: {}\nprints\n{printed}\nwithout {missing:?}",
            example.script
        );
    }
}

#[test]
fn the_examples_of_the_page_on_the_socket_are_true() {
    try_page(
        "socket-api.md",
        include_str!("../../../../docs/book/src/socket-api.md"),
    );
}

#[test]
fn the_examples_of_the_page_on_http_are_true() {
    try_page(
        "http-api.md",
        include_str!("../../../../docs/book/src/http-api.md"),
    );
}
