//! A robot without calibration in a simulated flat, its owner's hands, and the program at the owner's terminal.

use std::fs;
use std::io::{BufRead, BufReader, Lines, Write};
use std::os::unix::net::UnixStream;
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::Duration;

use serde_json::Value;

const PATIENCE: Duration = Duration::from_secs(90);
const SEPARATOR: u8 = 0x1F;

/// The robot's firmware and the program, if `cargo xtask test --only emulator` has named them.
pub(crate) fn programs() -> Option<(PathBuf, PathBuf)> {
    let named = |name| std::env::var_os(name).map(PathBuf::from);
    let both = named("RVAC_FIRMWARE").zip(named("RVAC_PROGRAM"));
    if both.is_none() {
        println!("skipped: cargo xtask test --only emulator names the firmware and the program");
    }
    both
}

/// The simulated robot and the person beside it.
pub(crate) struct OwnerFixture {
    simulator: Child,
    hands: BufReader<UnixStream>,
    folder: PathBuf,
    program: PathBuf,
}

impl OwnerFixture {
    /// Opens it; `None` where firmware and program were not named.
    pub(crate) fn open(name: &str, extra: &[&str]) -> Option<Self> {
        let (firmware, program) = programs()?;
        let folder = std::env::temp_dir().join(format!("rvac-owner-{}-{name}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let home = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../homes/two-room-flat.toml");
        let mut simulator = Command::new(env!("CARGO_BIN_EXE_rvac-sim"))
            .args(["serve", "--home"])
            .arg(home)
            .arg("--link")
            .arg(folder.join("robot"))
            .arg("--socket")
            .arg(folder.join("sim.sock"))
            .arg("--firmware")
            .arg(firmware)
            .args(extra)
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut line = String::new();
        BufReader::new(simulator.stdout.take().unwrap())
            .read_line(&mut line)
            .unwrap();
        assert_eq!(line, "ready\n");
        let hands = UnixStream::connect(folder.join("sim.sock")).unwrap();
        hands.set_read_timeout(Some(PATIENCE)).unwrap();
        Some(Self {
            simulator,
            hands: BufReader::new(hands),
            folder,
            program,
        })
    }

    /// A file that goes with the workshop.
    pub(crate) fn file(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    /// Does something that takes no time, and waits until it has been done.
    pub(crate) fn touch(&mut self, request: &Value) {
        assert_eq!(self.ask(request)["e"], "done");
    }

    /// Does or reads something and waits for the answer.
    pub(crate) fn ask(&mut self, request: &Value) -> Value {
        self.say(request);
        loop {
            let answer = self.hear();
            let is_asked_anyway =
                ["simulated-plan", "simulated-truth"].contains(&answer["e"].as_str().unwrap());
            if !is_asked_anyway {
                assert_ne!(answer["e"], "failed", "{request}: {answer}");
                return answer;
            }
        }
    }

    /// Waits for so many simulated seconds.
    pub(crate) fn pass(&mut self, seconds: f64) {
        let now = |hands: &mut Self| loop {
            if let Some(sim_s) = hands.hear()["sim_s"].as_f64() {
                return sim_s;
            }
        };
        let end = now(self) + seconds;
        while now(self) < end {}
    }

    fn hear(&mut self) -> Value {
        let mut message = Vec::new();
        self.hands.read_until(SEPARATOR, &mut message).unwrap();
        assert_eq!(message.pop(), Some(SEPARATOR), "the simulator hung up");
        serde_json::from_slice(&message).unwrap()
    }

    fn say(&mut self, request: &Value) {
        let stream = self.hands.get_mut();
        stream.write_all(request.to_string().as_bytes()).unwrap();
        stream.write_all(&[SEPARATOR]).unwrap();
    }

    /// Starts the program with these arguments and the robot's terminal.
    pub(crate) fn rvac(&self, arguments: &[&str]) -> Terminal {
        let mut child = Command::new(&self.program)
            .args(arguments)
            .arg("--port")
            .arg(self.folder.join("robot"))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let keyboard = child.stdin.take().unwrap();
        let screen = BufReader::new(child.stdout.take().unwrap()).lines();
        Terminal {
            child,
            keyboard,
            screen,
        }
    }
}

impl Drop for OwnerFixture {
    fn drop(&mut self) {
        self.simulator.kill().ok();
        self.simulator.wait().ok();
        fs::remove_dir_all(&self.folder).ok();
    }
}

/// A program at work.
pub(crate) struct Terminal {
    child: Child,
    keyboard: ChildStdin,
    screen: Lines<BufReader<ChildStdout>>,
}

impl Terminal {
    /// The next line on the screen; `None` at the end.
    pub(crate) fn read(&mut self) -> Option<String> {
        self.screen.next().map(Result::unwrap)
    }

    /// Types a line.
    pub(crate) fn answer(&mut self, line: &str) {
        writeln!(self.keyboard, "{line}").unwrap();
    }

    /// Whether it ended well, and what it complained of.
    pub(crate) fn end(self) -> (bool, String) {
        let output = self.child.wait_with_output().unwrap();
        (output.status.success(), String::from_utf8(output.stderr).unwrap())
    }
}
