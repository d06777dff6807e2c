//! `rvac update` as its owner runs it, killed in its midst, too; the daemon is a thread that answers unless its program is broken.

use crate::folder::Folder;
use crate::program;
use std::fs;
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::os::unix::net::UnixListener;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use flash_trials::signed_update::update_of_daemon;
use minisign::KeyPair;
use rvac_api::SEPARATOR;

/// What a daemon says whose robot answers.
const HELLO: &str = r#"{"e":"hello","api":1,"versions":{"vthal":"1","brain":"1"},"robot":{"device":"sr8730","radius_m":0.175,"swath_m":0.3,"speed_max_m_per_s":0.35,"turn_max_rad_per_s":1.5,"proximity":7,"parts":[]},"strategies":[],"expert":false}"#;

/// A board with a daemon that greets.
struct Board {
    folder: Folder,
    pair: KeyPair,
}

impl Board {
    fn new() -> Self {
        let (folder, pair) = (
            Folder::new(),
            KeyPair::generate_unencrypted_keypair().expect("random numbers"),
        );
        fs::create_dir_all(folder.join("keys")).expect("a folder");
        let public = pair.pk.to_box().expect("a box").into_string();
        fs::write(folder.join("keys/first.pub"), public).expect("a file");
        let listener = UnixListener::bind(folder.join("vthal.sock")).expect("a socket");
        let program = folder.join("updates/current/bin/vthal");
        std::thread::spawn(move || greet(&listener, &program));
        Self { folder, pair }
    }

    /// The file of an update with this daemon.
    fn update(&self, epoch: u64, daemon: &str) -> PathBuf {
        self.update_with(epoch, daemon.as_bytes())
    }

    fn update_with(&self, epoch: u64, daemon: &[u8]) -> PathBuf {
        update_of_daemon(&self.folder, (epoch, &self.pair), daemon).expect("an update")
    }

    fn arguments(&self, more: &[&str]) -> Vec<String> {
        let path = |name: &str| self.folder.join(name).to_string_lossy().into_owned();
        let own = [
            ("--folder", path("updates")),
            ("--keys", path("keys")),
            ("--wiring", path("no-wiring")),
            ("--socket", path("vthal.sock")),
            ("--page-port", "0".to_owned()),
            ("--patience-s", "1".to_owned()),
            ("--restart", path("restart")),
        ];
        let own = own.into_iter().flat_map(|(name, value)| [name.to_owned(), value]);
        std::iter::once("update".to_owned())
            .chain(own)
            .chain(more.iter().map(|word| (*word).to_owned()))
            .collect()
    }

    /// What restarts the programs is this script.
    fn restart_by(&self, script: &str) {
        use std::os::unix::fs::PermissionsExt as _;
        let path = self.folder.join("restart");
        fs::write(&path, format!("#!/bin/sh\n{script}\n")).expect("a file");
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).expect("its mode");
    }

    fn rvac(&self, more: &[&str]) -> Output {
        program::rvac(self.arguments(more), b"")
    }

    fn installed(&self) -> serde_json::Value {
        let output = self.rvac(&["--json"]);
        serde_json::from_slice(&output.stdout).expect("JSON")
    }

    fn daemon(&self) -> Option<String> {
        fs::read_to_string(self.folder.join("updates/current/bin/vthal")).ok()
    }
}

/// Greets everybody, as long as the program is not broken.
fn greet(listener: &UnixListener, program: &Path) {
    for stream in listener.incoming() {
        let mut stream = stream.expect("a client");
        let mut byte = [0];
        while stream.read(&mut byte).is_ok_and(|count| count == 1) && byte[0] != SEPARATOR {}
        if fs::read_to_string(program).is_ok_and(|text| text.starts_with("broken")) {
            continue;
        }
        let mut bytes = HELLO.as_bytes().to_vec();
        bytes.push(SEPARATOR);
        // A client that was killed is gone.
        stream.write_all(&bytes).ok();
    }
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
fn an_update_is_put_in_use_refused_and_undone() {
    let board = Board::new();
    board.restart_by("exit 0");
    let file = |path: PathBuf| path.to_string_lossy().into_owned();
    let output = board.rvac(&[&file(board.update(1, "daemon 1"))]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert_eq!(board.daemon().as_deref(), Some("daemon 1"));
    assert_eq!(board.installed()["epoch"], 1);
    let again = board.rvac(&[&file(board.update(1, "daemon 1"))]);
    assert!(text(&again.stderr).contains("its epoch is 1, and 1 is installed"));
    let broken = board.rvac(&[&file(board.update(2, "broken"))]);
    let told = text(&broken.stderr);
    assert!(!broken.status.success());
    assert!(
        told.contains("everything is as it was before: the daemon does not answer"),
        "{told}"
    );
    assert_eq!(board.daemon().as_deref(), Some("daemon 1"));
    assert!(board.installed()["pending"].is_null());
    let output = board.rvac(&[&file(board.update(2, "daemon 2"))]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert_eq!(board.installed()["programs"]["update"], "b");
    fs::remove_file(board.folder.join("keys/first.pub")).expect("it was there");
    let keyless = board.rvac(&[&file(board.update(3, "daemon 3"))]);
    assert!(
        text(&keyless.stderr).contains("no key is given"),
        "{}",
        text(&keyless.stderr)
    );
    assert_eq!(board.daemon().as_deref(), Some("daemon 2"));
}

#[test]
fn killed_while_it_starts_programs_it_is_undone_at_the_next_boot() {
    let board = Board::new();
    board.restart_by("exit 0");
    let first = board.update(1, "daemon 1");
    assert!(board.rvac(&[&first.to_string_lossy()]).status.success());
    // Until somebody kills it.
    board.restart_by("exec sleep 60 >/dev/null 2>&1");
    let second = board.update(2, "daemon 2");
    let mut update = Command::new(env!("CARGO_BIN_EXE_rvac"))
        .args(board.arguments(&[&second.to_string_lossy()]))
        .stderr(Stdio::piped())
        .spawn()
        .expect("rvac starts");
    let told = BufReader::new(update.stderr.take().expect("a pipe"));
    let starts = told
        .lines()
        .map_while(Result::ok)
        .find(|line| line.starts_with("starts"));
    assert!(starts.is_some());
    while board.daemon().as_deref() != Some("daemon 2") {
        std::thread::yield_now();
    }
    update.kill().expect("it runs");
    update.wait().expect("it ends");
    assert_eq!(board.installed()["pending"]["epoch"], 2);
    let boot = board.rvac(&["--settle", "--at-boot"]);
    assert!(boot.status.success(), "{}", text(&boot.stderr));
    assert_eq!(board.daemon().as_deref(), Some("daemon 1"));
    assert!(board.installed()["pending"].is_null());
    board.restart_by("exit 0");
    assert!(board.rvac(&[&second.to_string_lossy()]).status.success());
    assert_eq!(board.daemon().as_deref(), Some("daemon 2"));
}

/// The script that services start, on the folders of a test.
fn run_script(folder: &Path) -> String {
    let script = fs::read_to_string("../../packaging/run").expect("the script");
    let root = folder.to_string_lossy();
    script
        .replace("/var/lib/librervac", &format!("{root}/updates"))
        .replace("/usr/", &format!("{root}/usr/"))
}

/// Starts the daemon as its service does, with what the service says of it before.
fn start_daemon(board: &Board) -> std::process::Child {
    assert!(board.rvac(&["--daemon-starts"]).status.success());
    let path = |name: &str| board.folder.join(name);
    Command::new("sh")
        .arg("-c")
        .arg(run_script(&board.folder))
        .args(["run", "vthal", "--serial"])
        .arg(path("no-robot"))
        .arg("--socket")
        .arg(path("daemon.sock"))
        .arg("--state")
        .arg(path("state"))
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .expect("sh runs")
}

/// What the service says after an end.
fn ended(board: &Board, status: &str) -> Output {
    let output = board.rvac(&["--daemon-ended", "exit-code", status]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    output
}

#[test]
fn a_daemon_that_fails_three_times_gives_way_to_the_one_before() {
    let board = Board::new();
    board.restart_by("exit 0");
    fs::create_dir_all(board.folder.join("state")).expect("a folder");
    let real = Path::new(env!("CARGO_BIN_EXE_rvac")).with_file_name("vthal");
    let real = fs::read(real).expect("the daemon: cargo build --bin vthal");
    let first = board.update_with(1, &real);
    assert!(board.rvac(&[&first.to_string_lossy()]).status.success());
    let second = board.update(2, "#!/bin/sh\nexit 1\n");
    assert!(board.rvac(&[&second.to_string_lossy()]).status.success());
    let in_use = || board.installed()["programs"]["update"].clone();
    // What must be changed in the configuration is no fault of the programs, and an end that is wanted begins the count anew.
    for status in ["1", "1", "2", "1", "1"] {
        let code = start_daemon(&board).wait().expect("it ends").code();
        assert_eq!(code, Some(1));
        ended(&board, status);
        assert_eq!(in_use(), "b");
    }
    // Power fails while it starts: that is none of its failures.
    start_daemon(&board).wait().expect("it ends");
    start_daemon(&board).wait().expect("it ends");
    let told = text(&ended(&board, "1").stderr);
    assert!(told.contains("the daemon of update 2 failed 3 times"), "{told}");
    assert_eq!(in_use(), "a");
    assert_eq!(board.installed()["given_up"], true);
    let progress = fs::read_to_string(board.folder.join("updates/progress.json")).expect("it is told");
    assert!(progress.contains(r#""end":"given-up""#), "{progress}");
    let mut daemon = start_daemon(&board);
    let mut lines = BufReader::new(daemon.stdout.take().expect("a pipe")).lines();
    let is_ready = lines.any(|line| line.is_ok_and(|line| line.starts_with("ready")));
    daemon.kill().expect("it runs");
    daemon.wait().expect("it ends");
    assert!(is_ready, "the real daemon runs again");
    let again = board.rvac(&[&second.to_string_lossy()]);
    assert!(text(&again.stderr).contains("only a higher one is accepted"));
    let third = board.update_with(3, &real);
    assert!(board.rvac(&[&third.to_string_lossy()]).status.success());
    assert_eq!(board.installed()["given_up"], serde_json::Value::Null);
}

#[test]
fn what_the_panel_hands_over_is_taken_and_its_course_is_told() {
    let board = Board::new();
    board.restart_by("exit 0");
    let progress = || -> serde_json::Value {
        let bytes = fs::read(board.folder.join("updates/progress.json")).expect("it is told");
        serde_json::from_slice(&bytes).expect("JSON")
    };
    let good = board.update(1, "daemon 1");
    assert!(board.rvac(&["--take", &good.to_string_lossy()]).status.success());
    assert!(!good.exists(), "it is tried once");
    assert_eq!(progress()["end"], "installed");
    assert_eq!(progress()["epoch"], 1);
    let silent = board.update(2, "broken");
    assert!(
        !board
            .rvac(&["--take", &silent.to_string_lossy()])
            .status
            .success()
    );
    assert!(!silent.exists());
    let told = progress();
    assert_eq!(
        (&told["end"], &told["failed"], &told["reason"]),
        (
            &"went-back".into(),
            &"try-programs".into(),
            &"update-silent".into()
        )
    );
    assert_eq!(told["text"], "The daemon does not answer with the update.");
    let old = board.update(1, "daemon 1");
    assert!(!board.rvac(&["--take", &old.to_string_lossy()]).status.success());
    assert_eq!(
        (&progress()["end"], &progress()["reason"]),
        (&"refused".into(), &"update-old".into())
    );
    let secret = board.folder.join("secret");
    fs::write(&secret, "of root").expect("a file");
    let link = board.folder.join("offer.update");
    std::os::unix::fs::symlink(&secret, &link).expect("a link");
    assert!(!board.rvac(&["--take", &link.to_string_lossy()]).status.success());
    assert_eq!(progress()["reason"], "update-file", "a link is not followed");
    assert!(secret.exists());
}

/// The script that services start: the update's program if there is one, else the package's.
#[test]
fn the_package_starts_the_program_of_the_update_in_use() {
    let folder = Folder::new();
    let root = folder.to_string_lossy();
    let script = run_script(&folder);
    let program = |path: &str, says: &str| {
        use std::os::unix::fs::PermissionsExt as _;
        let path = folder.join(path);
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        fs::write(&path, format!("#!/bin/sh\necho {says} \"$@\"\n")).expect("a file");
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).expect("its mode");
    };
    let run = |arguments: &[&str]| {
        let output = Command::new("sh")
            .arg("-c")
            .arg(&script)
            .arg("run")
            .args(arguments)
            .output();
        text(&output.expect("sh runs").stdout)
    };
    program("usr/bin/vthal", "package");
    program("usr/bin/panel-server", "package");
    assert_eq!(run(&["vthal", "--config", "x"]), "package --config x\n");
    let panel = format!("package --assets {root}/usr/share/rvac-panel --port 1\n");
    assert_eq!(run(&["panel-server", "--port", "1"]), panel);
    program("updates/a/bin/vthal", "update");
    program("updates/a/bin/panel-server", "update");
    std::os::unix::fs::symlink("a", folder.join("updates/current")).expect("a link");
    assert_eq!(run(&["vthal", "--config", "x"]), "update --config x\n");
    let panel = format!("update --assets {root}/updates/current/panel --port 1\n");
    assert_eq!(run(&["panel-server", "--port", "1"]), panel);
}
