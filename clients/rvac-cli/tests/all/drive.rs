//! `rvac drive` before the real daemon and a simulated robot, which must be built: `cargo build -p vthal -p rvac-sim`.
#![allow(clippy::unwrap_used, reason = "in a test that is what a failure is")]

#[path = "../../../panel-server/tests/browser/robot.rs"]
mod robot;
#[path = "../../../panel-server/tests/browser/teller.rs"]
mod teller;

use std::io::{BufRead, BufReader, Lines, Write};
use std::os::unix::net::UnixStream;
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Output, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

use crate::folder::Folder;
use mixer::{Line, Name, OutputName, Profile, Source, standard_profile};
use robot::Observer;
use teller::Teller;

/// Whatever is awaited comes within this time or the test fails; the machine may be busy.
const PATIENCE: Duration = Duration::from_secs(40);
/// The lease, the braking of the wheels, and a busy machine.
const STAND: Duration = Duration::from_millis(1000);

/// A process that is gone when this is dropped.
struct Process {
    child: Child,
    /// Kept open: a program that writes into a closed pipe ends.
    _output: Option<Lines<BufReader<ChildStdout>>>,
}

impl Drop for Process {
    fn drop(&mut self) {
        self.child.kill().ok(); // It may have ended by itself.
        self.child.wait().ok();
    }
}

/// A robot in the middle of a room, and its daemon. The folder goes last.
struct World {
    _simulator: Process,
    _daemon: Process,
    folder: Folder,
}

impl World {
    fn start() -> Self {
        let folder = Folder::new();
        std::fs::create_dir_all(folder.join("state")).unwrap();
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let mut simulator = Command::new(binary("rvac-sim"));
        simulator.current_dir(root);
        simulator.args([
            "serve",
            "--robot",
            "sr8730",
            "--seed",
            "7",
            "--home",
            "homes/two-room-flat.toml",
        ]);
        simulator
            .arg("--link")
            .arg(folder.join("serial"))
            .arg("--socket")
            .arg(folder.join("simulator.sock"));
        let simulator = start(&mut simulator);
        let place = "{\"c\":\"place\",\"x\":-3.4,\"y\":0,\"heading\":3.14}\u{1f}";
        let mut hands = UnixStream::connect(folder.join("simulator.sock")).unwrap();
        hands.write_all(place.as_bytes()).unwrap();
        let mut daemon = Command::new(binary("vthal"));
        daemon
            .arg("--serial")
            .arg(folder.join("serial"))
            .arg("--socket")
            .arg(folder.join("vthal.sock"));
        daemon.arg("--state").arg(folder.join("state"));
        let daemon = start(&mut daemon);
        let world = Self {
            folder,
            _simulator: simulator,
            _daemon: daemon,
        };
        let deadline = Instant::now() + PATIENCE;
        while !text(&world.rvac(&["status"]).stdout).contains("idle") {
            assert!(
                Instant::now() < deadline,
                "{}",
                text(&world.rvac(&["status"]).stdout)
            );
        }
        world
    }

    fn rvac(&self, words: &[&str]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_rvac"));
        command
            .args(words)
            .arg("--socket")
            .arg(self.folder.join("vthal.sock"));
        command.output().unwrap()
    }

    fn witness(&self) -> Observer {
        Observer::watch(&self.folder.join("simulator.sock"))
    }
}

/// A binary that cargo put beside `rvac`.
fn binary(name: &str) -> PathBuf {
    Path::new(env!("CARGO_BIN_EXE_rvac")).with_file_name(name)
}

/// Starts a program and waits for its line `ready`.
fn start(command: &mut Command) -> Process {
    let spawned = command.stdout(Stdio::piped()).stderr(Stdio::null()).spawn();
    let mut child =
        spawned.unwrap_or_else(|error| panic!("cannot start {:?}: {error}; build it", command.get_program()));
    let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
    let ready = lines
        .by_ref()
        .map_while(Result::ok)
        .find(|line| line.starts_with("ready"));
    assert!(
        ready.is_some(),
        "{:?} ended before it was ready",
        command.get_program()
    );
    Process {
        child,
        _output: Some(lines),
    }
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// `rvac drive`, with readings from this test.
struct Drive {
    process: Process,
    input: Option<ChildStdin>,
    said: Receiver<String>,
}

impl Drive {
    fn start(world: &World, words: &[&str]) -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_rvac"));
        command
            .args(["drive", "--readings"])
            .args(words)
            .arg("--socket")
            .arg(world.folder.join("vthal.sock"));
        let mut child = command
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let lines = BufReader::new(child.stdout.take().unwrap()).lines();
        let (sender, said) = channel();
        std::thread::spawn(move || lines.map_while(Result::ok).try_for_each(|line| sender.send(line)));
        Self {
            input: child.stdin.take(),
            process: Process { child, _output: None },
            said,
        }
    }

    fn read(&mut self, line: &str) {
        writeln!(self.input.as_mut().unwrap(), "{line}").unwrap();
    }

    fn wait_for(&self, wanted: &str) {
        self.wait_until(|line| line == wanted);
    }

    fn wait_for_start(&self, wanted: &str) {
        self.wait_until(|line| line.starts_with(wanted));
    }

    fn wait_until(&self, is_wanted: impl Fn(&str) -> bool) {
        let deadline = Instant::now() + PATIENCE;
        loop {
            let left = deadline.saturating_duration_since(Instant::now());
            if is_wanted(self.said.recv_timeout(left).unwrap().trim()) {
                return;
            }
        }
    }

    /// Pushes an input until the robot moves. On a machine that is too busy the lease ends between two words, and the wheels
    /// wait for a new hold: so does this.
    fn push(&mut self, input: &str, witness: &Observer) {
        for _ in 0..8 {
            self.read(&format!("{input} 0"));
            std::thread::sleep(Duration::from_millis(100));
            self.read(&format!("{input} -1"));
            if witness.moves_within(Duration::from_secs(3)) {
                return;
            }
        }
        panic!("the robot does not move");
    }
}

fn stands_soon(witness: &Observer, since: Instant, what: &str) {
    let stood = witness
        .stands_within(Duration::from_secs(5))
        .unwrap_or_else(|| panic!("{what}: it drives on"));
    let after = stood.saturating_duration_since(since);
    println!("{what}: the wheels stood after {} ms", after.as_millis());
    assert!(after < STAND, "{what}: {after:?}");
}

#[test]
fn a_pad_drives_and_whatever_is_lost_stops_the_wheels() {
    let world = World::start();
    let witness = world.witness();
    let mut drive = Drive::start(&world, &[]);
    drive.read("pad-0-axis-0 0");
    drive.wait_for("ready");

    drive.push("pad-0-axis-0", &witness);
    let gone = Instant::now();
    drive.read("pad-0 gone");
    stands_soon(&witness, gone, "a pad that is gone");

    drive.read("pad-0-axis-0 -1");
    drive.wait_for("waits until every input is at rest");
    assert!(
        !witness.moves_within(Duration::from_secs(1)),
        "a pad that comes back pushed drives"
    );
    drive.push("pad-0-axis-0", &witness);
    let ended = Instant::now();
    drive.input = None;
    stands_soon(&witness, ended, "readings that end");
    assert!(drive.process.child.wait().unwrap().success());

    // A mix that is kept on the robot, in which another input turns.
    let mut profile = standard_profile();
    profile.name = Name::new("Touch only").unwrap();
    for output in &mut profile.outputs {
        output.lines.retain(|line| line.input == Source::TouchRight);
    }
    let file = world.folder.join("mix.json");
    std::fs::write(&file, profile.to_pretty_json()).unwrap();
    let saved = world.rvac(&["mix", "save", file.to_str().unwrap()]);
    assert!(saved.status.success(), "{}", text(&saved.stderr));
    assert_eq!(
        text(&world.rvac(&["mix"]).stdout),
        "Touch only: 9 outputs, 1 lines\n"
    );
    assert_eq!(
        text(&world.rvac(&["mix", "show", "Touch only"]).stdout).trim(),
        profile.to_pretty_json()
    );
    let mut drive = Drive::start(&world, &["--mix", "Touch only"]);
    drive.read("touch-right 0");
    drive.wait_for("ready");
    drive.push("touch-right", &witness);
    let killed = Instant::now();
    drop(drive);
    stands_soon(&witness, killed, "a killed program");
    assert!(world.rvac(&["mix", "remove", "Touch only"]).status.success());
    let absent = world.rvac(&["drive", "--readings", "--mix", "Touch only"]);
    assert!(text(&absent.stderr).contains("the robot keeps no mix `Touch only`"));
}

/// What a pushed pad may say nothing for, in the mixer.
const SILENT: Duration = Duration::from_secs(2);

/// A gamepad without power keeps its last position in the kernel, and says nothing.
#[test]
fn a_pushed_pad_that_says_nothing_more_stops_the_wheels() {
    let world = World::start();
    let witness = world.witness();
    let mut drive = Drive::start(&world, &[]);
    drive.read("pad-0-axis-0 0");
    drive.wait_for("ready");
    for _ in 0..3 {
        drive.push("pad-0-axis-0", &witness);
        let last_word = Instant::now();
        drive.read("pad-0-axis-0 -1");
        drive.wait_for_start("pad-0 is silent (pad-silent)");
        let told = last_word.elapsed();
        assert!(told >= SILENT, "{told:?}");
        stands_soon(
            &witness,
            last_word + SILENT,
            "a pushed pad that was silent for two seconds",
        );
        // Another pad of the same name may be there instead, still pushed.
        drive.read("pad-0 gone");
        drive.read("pad-0-axis-0 -1");
        assert!(
            !witness.moves_within(Duration::from_secs(1)),
            "it drives though it was not at rest"
        );
    }
    // The same place said again and again is a pad that lives.
    drive.push("pad-0-axis-0", &witness);
    for _ in 0..30 {
        drive.read("pad-0-axis-0 -1");
        std::thread::sleep(Duration::from_millis(100));
    }
    assert!(
        witness.moves_within(Duration::from_millis(300)),
        "a pad that lives drives on"
    );
}

/// A mix that drives by another client's input only.
fn steered_from_afar() -> Profile {
    let mut profile = standard_profile();
    profile.name = Name::new("From afar").unwrap();
    let steer = Source::Client(Name::new("steer").unwrap());
    for output in &mut profile.outputs {
        output.lines.clear();
        if output.output == OutputName::Turn {
            output.lines.push(Line::new(profile.name.clone(), steer.clone()));
        }
    }
    profile
}

/// Tells that the input is pushed until the robot moves, from its rest on each time.
fn push_from_afar(teller: &Teller, witness: &Observer) {
    for _ in 0..8 {
        teller.tell(0.0);
        std::thread::sleep(Duration::from_millis(300));
        teller.tell(-1.0);
        if witness.moves_within(Duration::from_secs(3)) {
            return;
        }
    }
    panic!("the robot does not move");
}

#[test]
fn another_client_drives_by_a_mix_and_its_loss_stops_the_wheels() {
    let world = World::start();
    let witness = world.witness();
    let file = world.folder.join("mix.json");
    std::fs::write(&file, steered_from_afar().to_pretty_json()).unwrap();
    let drive = Drive::start(&world, &["--mix-file", file.to_str().unwrap()]);
    let socket = world.folder.join("vthal.sock");
    let gone = "client-steer is gone: the wheels stand";

    let teller = Teller::of("steer", &socket);
    push_from_afar(&teller, &witness);
    let silent = Instant::now();
    teller.fall_silent();
    stands_soon(&witness, silent, "a client that falls silent");
    drive.wait_for(gone);
    teller.tell(-1.0);
    assert!(
        !witness.moves_within(Duration::from_secs(1)),
        "a client that comes back pushed drives"
    );
    push_from_afar(&teller, &witness);
    let died = Instant::now();
    drop(teller);
    stands_soon(&witness, died, "a client that died");
    drive.wait_for(gone);
}

#[test]
fn a_mix_that_is_wrong_is_told_with_its_place() {
    let folder = Folder::new();
    let file = folder.join("wrong-mix.json");
    std::fs::write(
        &file,
        standard_profile()
            .to_pretty_json()
            .replace("\"weight\": 0.7", "\"weight\": 7"),
    )
    .unwrap();
    let listener = std::os::unix::net::UnixListener::bind(file.with_extension("sock")).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_rvac"));
    command
        .args(["drive", "--readings", "--mix-file"])
        .arg(&file)
        .arg("--socket")
        .arg(file.with_extension("sock"));
    let said = text(&command.output().unwrap().stderr);
    drop(listener);
    assert!(
        said.contains("output forward, line 4 (W), weight is 7: write a number from -2 to 2"),
        "{said}"
    );
}
