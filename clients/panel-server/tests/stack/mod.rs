//! The simulator, the daemon and the server as processes on sockets and ports of their own.
#![allow(
    dead_code,
    reason = "each set of tests that shares this uses another part of it"
)]

use std::ffi::OsStr;
use std::io::{BufRead, BufReader};
use std::os::unix::net::UnixStream;
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdout, Command, Stdio};

use rustix::process::{Pid, Signal, kill_process};
use rvac_api::SEPARATOR;

use crate::folder::Folder;

/// Running processes and their folder; all of it is gone when this is dropped.
#[derive(Debug)]
pub(crate) struct Stack {
    folder: Folder,
    processes: Vec<Process>,
    vthal: Option<Process>,
    /// Description of the simulated home.
    home: PathBuf,
    pub(crate) address: String,
}

#[derive(Debug)]
struct Process {
    child: Child,
    stdout: BufReader<ChildStdout>,
}

impl Process {
    /// Starts `command` and waits for its line `ready`, which is given back.
    fn start(command: &mut Command) -> (Self, String) {
        Self::try_start(command)
            .unwrap_or_else(|| panic!("{:?} ended before it was ready", command.get_program()))
    }

    /// The same with a program that may end before it is ready.
    fn try_start(command: &mut Command) -> Option<(Self, String)> {
        let mut child = command
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap_or_else(|error| {
                panic!(
                    "cannot start {:?}: {error}; build it first",
                    command.get_program()
                );
            });
        let stdout = BufReader::new(child.stdout.take().unwrap());
        let mut process = Self { child, stdout };
        let mut line = String::new();
        while !line.starts_with("ready") {
            line.clear();
            if process.stdout.read_line(&mut line).unwrap() == 0 {
                return None;
            }
        }
        Some((process, line))
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        self.child.kill().ok(); // It may have ended by itself.
        self.child.wait().ok();
    }
}

/// A process that does not go on until this is dropped.
#[derive(Debug)]
pub(crate) struct Stopped(Option<Pid>);

impl Stopped {
    fn new(process: u32) -> Self {
        let pid = i32::try_from(process).ok().and_then(Pid::from_raw);
        let stopped = Self(pid);
        stopped.tell(Signal::STOP);
        stopped
    }

    fn tell(&self, signal: Signal) {
        if let Some(pid) = self.0 {
            kill_process(pid, signal).ok(); // It may have ended meanwhile.
        }
    }
}

impl Drop for Stopped {
    fn drop(&mut self) {
        self.tell(Signal::CONT);
    }
}

/// The robot's map at the start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Home {
    /// Nothing.
    Unknown,
    /// The home it is in.
    Kept,
    /// The same after a whole job, in which it has detected the carpets.
    Cleaned,
}

/// A binary that cargo put beside that of the server.
pub(crate) fn binary(name: &str) -> PathBuf {
    Path::new(env!("CARGO_BIN_EXE_panel-server")).with_file_name(name)
}

/// Arguments of a server for paired devices.
fn guarded_by<'a>(state: &'a Path, updates: &'a Path) -> [&'a OsStr; 4] {
    [
        "--state".as_ref(),
        state.as_os_str(),
        "--updates".as_ref(),
        updates.as_os_str(),
    ]
}

fn packed_panel() -> PathBuf {
    let panel = std::env::var_os("RVAC_PANEL").expect("RVAC_PANEL names the folder of the packed panel");
    PathBuf::from(panel)
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

impl Stack {
    /// In a home that the robot does not know.
    pub(crate) fn start() -> Self {
        Self::new(Home::Unknown, None, &packed_panel())
    }

    /// The same with a page of the test's own in place of the packed panel.
    pub(crate) fn start_with_page(panel: &Path) -> Self {
        Self::new(Home::Unknown, None, panel)
    }

    /// In a home whose map was kept.
    pub(crate) fn start_at_home() -> Self {
        Self::new(Home::Kept, None, &packed_panel())
    }

    /// In a home whose map was kept after the robot had cleaned all of it.
    pub(crate) fn start_in_a_cleaned_home() -> Self {
        Self::new(Home::Cleaned, None, &packed_panel())
    }

    /// In a home that the robot does not know, with the robot's real firmware in an emulated chip.
    pub(crate) fn start_emulated() -> Self {
        Self::new(Home::Unknown, Some(&Self::firmware()), &packed_panel())
    }

    /// The same with nothing measured of the robot, as after the first flashing.
    pub(crate) fn start_uncalibrated() -> Self {
        let mut stack = Self::start_emulated();
        stack.reprogram(&["--uncalibrated".as_ref()]);
        stack
    }

    /// The simulated robot is programmed with this calibration.
    pub(crate) fn reprogram(&mut self, calibration: &[&OsStr]) {
        let simulator = self.processes.remove(0);
        drop(simulator);
        let program = self.simulator(Some(&Self::firmware()), calibration);
        self.processes.insert(0, program);
    }

    /// In a home that the robot does not know, with this file in the daemon's state folder.
    pub(crate) fn start_with_state(name: &str, text: &str) -> Self {
        let folder = Self::new_folder();
        std::fs::write(folder.join("state").join(name), text).unwrap();
        let description = PathBuf::from("homes/two-room-flat.toml");
        let mut stack = Self::without_server_in(folder, description, (Home::Unknown, None));
        stack.start_server(&packed_panel(), &[]);
        stack
    }

    /// In a home that the robot does not know, with a server that only paired devices may use.
    pub(crate) fn start_guarded() -> Self {
        Self::guarded(None)
    }

    /// The same with the robot's real firmware in an emulated chip.
    pub(crate) fn start_guarded_emulated() -> Self {
        Self::guarded(Some(&Self::firmware()))
    }

    fn firmware() -> PathBuf {
        std::env::var_os("RVAC_FIRMWARE")
            .expect("RVAC_FIRMWARE names the robot's firmware")
            .into()
    }

    fn guarded(firmware: Option<&Path>) -> Self {
        let mut stack = Self::without_server(Home::Unknown, firmware);
        let (state, updates) = (stack.folder.join("panel"), stack.updates());
        stack.start_server(&packed_panel(), &guarded_by(&state, &updates));
        stack
    }

    /// In a home that the robot does not know, with a server that paired devices may use from all networks.
    pub(crate) fn start_on_network(panel: &Path) -> Self {
        let mut stack = Self::without_server(Home::Unknown, None);
        stack.allow_packets();
        stack.serve_network(panel, ("0", "panel"));
        stack
    }

    /// Starts one more server in front of the same daemon, which only paired devices may use, and gives its address.
    pub(crate) fn serve_guarded_besides(&mut self, panel: &Path) -> String {
        let open = std::mem::take(&mut self.address);
        let state = self.folder.join("panel");
        self.start_server(panel, &["--state".as_ref(), state.as_os_str()]);
        std::mem::replace(&mut self.address, open)
    }

    /// Restarts the daemon, with clients that may send packets of their own.
    fn allow_packets(&mut self) {
        let path = self.folder.join("vthal.toml");
        let configuration = std::fs::read_to_string(&path).unwrap();
        std::fs::write(&path, format!("{configuration}[socket]\nexpert = true\n")).unwrap();
        self.kill_vthal();
        self.start_vthal();
    }

    /// Another robot takes the place of this one.
    pub(crate) fn serve_as_another(&mut self, panel: &Path) {
        self.serve_again_on_network(panel, "another");
    }

    /// This robot is back.
    pub(crate) fn serve_as_before(&mut self, panel: &Path) {
        self.serve_again_on_network(panel, "panel");
    }

    fn serve_again_on_network(&mut self, panel: &Path, state: &str) {
        self.stop_server();
        let port = self.port();
        self.serve_network(panel, (&port, state));
    }

    fn serve_network(&mut self, panel: &Path, (port, state): (&str, &str)) {
        let has_v6 = Path::new("/proc/net/if_inet6").exists();
        let all = if has_v6 { "::" } else { "0.0.0.0" };
        let state = self.folder.join(state);
        let more: [&OsStr; 4] = [
            "--bind".as_ref(),
            all.as_ref(),
            "--state".as_ref(),
            state.as_os_str(),
        ];
        self.serve((&self.daemon_socket(), port), panel, &more);
    }

    /// What `rvac` says at the console of that server.
    pub(crate) fn console(&self, words: &[&str]) -> String {
        let mut command = Command::new(binary("rvac"));
        command
            .args(words)
            .arg("--console")
            .arg(self.folder.join("panel/console.sock"));
        let output = command.output().unwrap();
        assert!(
            output.status.success(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
        String::from_utf8(output.stdout).unwrap()
    }

    /// In a home of the test's own whose map was kept, with the server not started yet.
    pub(crate) fn start_in(home: &str) -> Self {
        let folder = Self::new_folder();
        let description = folder.join("home.toml");
        std::fs::write(&description, home).unwrap();
        Self::without_server_in(folder, description, (Home::Kept, None))
    }

    /// Starts the server in front of this socket, behind which the daemon must be found.
    pub(crate) fn serve_from(&mut self, daemon: &Path) {
        self.serve((daemon, "0"), &packed_panel(), &[]);
    }

    pub(crate) fn folder(&self) -> &Path {
        &self.folder
    }

    fn new(home: Home, firmware: Option<&Path>, panel: &Path) -> Self {
        let mut stack = Self::without_server(home, firmware);
        stack.start_server(panel, &[]);
        stack
    }

    fn new_folder() -> Folder {
        let folder = Folder::new();
        std::fs::create_dir_all(folder.join("state")).unwrap();
        folder
    }

    fn without_server(home: Home, firmware: Option<&Path>) -> Self {
        let description = PathBuf::from("homes/two-room-flat.toml");
        Self::without_server_in(Self::new_folder(), description, (home, firmware))
    }

    fn without_server_in(
        folder: Folder,
        description_of_home: PathBuf,
        (home, firmware): (Home, Option<&Path>),
    ) -> Self {
        let description = root().join("robots/samsung-sr8730/robot.toml");
        let configuration = format!("[robot]\ndescription = {:?}\n", description.display().to_string());
        std::fs::write(folder.join("vthal.toml"), configuration).unwrap();
        let mut stack = Self {
            folder,
            processes: Vec::new(),
            vthal: None,
            home: description_of_home,
            address: String::new(),
        };
        match home {
            Home::Unknown => {}
            Home::Kept => stack.keep_map("1"),
            Home::Cleaned => stack.keep_map("20"),
        }
        stack.start_simulator(firmware);
        stack.start_vthal();
        stack
    }

    pub(crate) fn daemon_socket(&self) -> PathBuf {
        self.folder.join("vthal.sock")
    }

    /// Does what the hand of a person does, at the simulator.
    pub(crate) fn hand(&self, request: &str) {
        use std::io::Write as _;
        let mut stream = UnixStream::connect(self.simulator_socket()).unwrap();
        stream.write_all(format!("{request}\u{1f}").as_bytes()).unwrap();
        let done = br#"{"e":"done"}"#;
        let mut messages = BufReader::new(stream).split(SEPARATOR);
        assert!(
            messages.any(|message| message.is_ok_and(|message| message == done)),
            "the simulator does not do {request}"
        );
    }

    /// Whether the daemon has received the robot's description.
    pub(crate) fn daemon_knows_a_robot(&self) -> bool {
        use std::io::Write as _;
        let mut stream = UnixStream::connect(self.daemon_socket()).unwrap();
        stream
            .write_all(b"{\"c\":\"watch\",\"topics\":[\"status\"]}\x1f")
            .unwrap();
        let first = BufReader::new(stream).split(SEPARATOR).next();
        let text = String::from_utf8(first.unwrap().unwrap()).unwrap();
        !text.contains("no-robot")
    }

    pub(crate) fn simulator_socket(&self) -> PathBuf {
        self.folder.join("simulator.sock")
    }

    /// Where the server asks for the code for Matter; nobody listens there.
    pub(crate) fn matter_socket(&self) -> PathBuf {
        self.folder.join("matter.sock")
    }

    /// Ends the daemon as a power failure would.
    pub(crate) fn kill_vthal(&mut self) {
        self.vthal = None;
    }

    pub(crate) fn start_vthal(&mut self) {
        let program = binary("vthal");
        assert!(self.start_vthal_of(&program), "the daemon does not start");
    }

    /// Starts this program as the daemon; whether it became ready.
    pub(crate) fn start_vthal_of(&mut self, program: &Path) -> bool {
        let mut command = Command::new(program);
        command.arg("--config").arg(self.folder.join("vthal.toml"));
        command.arg("--serial").arg(self.folder.join("serial"));
        command.arg("--socket").arg(self.daemon_socket());
        command.arg("--state").arg(self.folder.join("state"));
        self.vthal = Process::try_start(&mut command).map(|(process, _)| process);
        self.vthal.is_some()
    }

    /// The program that runs as the daemon.
    pub(crate) fn vthal_program(&self) -> PathBuf {
        let daemon = self.vthal.as_ref().expect("a daemon runs");
        std::fs::read_link(format!("/proc/{}/exe", daemon.child.id())).unwrap()
    }

    /// The folder in which `rvac update` keeps its files.
    pub(crate) fn updates(&self) -> PathBuf {
        self.folder.join("updates")
    }

    /// The server for paired devices ends and is there again at once.
    pub(crate) fn restart_guarded(&mut self) {
        let port = self.port();
        self.stop_server();
        let (state, updates) = (self.folder.join("panel"), self.updates());
        let more = guarded_by(&state, &updates);
        self.serve((&self.daemon_socket(), &port), &packed_panel(), &more);
    }

    /// The map that a host has of the simulated home after so many minutes in it, as if it had been kept.
    fn keep_map(&self, minutes: &str) {
        let maps = self.folder.join("state/maps");
        std::fs::create_dir_all(&maps).unwrap();
        let mut command = Command::new(binary("rvac-sim"));
        command.current_dir(root()).stdout(Stdio::null());
        command.args(["run", "--robot", "sr8730", "--seed", "7"]);
        command.arg("--home").arg(&self.home);
        command.args([
            "--known-map",
            "--minutes",
            minutes,
            "--strategy",
            "systematic",
            "--save-map",
        ]);
        let status = command.arg(maps.join("000001.map")).status().unwrap();
        assert!(status.success(), "the simulator makes no map");
    }

    /// `firmware` runs in an emulated chip; without it the simulator's own does.
    fn start_simulator(&mut self, firmware: Option<&Path>) {
        let simulator = self.simulator(firmware, &[]);
        self.processes.push(simulator);
    }

    fn simulator(&self, firmware: Option<&Path>, more: &[&OsStr]) -> Process {
        let mut command = Command::new(binary("rvac-sim"));
        command.current_dir(root());
        command.args(["serve", "--robot", "sr8730", "--seed", "7"]);
        command.arg("--home").arg(&self.home);
        command.arg("--link").arg(self.folder.join("serial"));
        command.arg("--socket").arg(self.simulator_socket());
        if let Some(firmware) = firmware {
            command.arg("--firmware").arg(firmware);
        }
        Process::start(command.args(more)).0
    }

    /// Ends the server, as if its computer were switched off.
    pub(crate) fn stop_server(&mut self) {
        self.processes.pop();
    }

    /// The server stops in the middle of a word until the value is dropped: its connections stay open and are silent.
    pub(crate) fn freeze_server(&self) -> Stopped {
        let server = self.processes.last().expect("the server was started last");
        Stopped::new(server.child.id())
    }

    /// The server ends and is there again at once, as after an update.
    pub(crate) fn restart_server(&mut self) {
        self.stop_server();
        self.serve_again(&packed_panel());
    }

    fn port(&self) -> String {
        let port = self.address.trim_end_matches('/').rsplit(':').next();
        port.unwrap().to_owned()
    }

    /// Serves this panel at the same address again.
    pub(crate) fn serve_again(&mut self, panel: &Path) {
        let port = self.port();
        self.serve((&self.daemon_socket(), &port), panel, &[]);
    }

    fn start_server(&mut self, panel: &Path, more: &[&OsStr]) {
        self.serve((&self.daemon_socket(), "0"), panel, more);
    }

    fn serve(&mut self, (daemon, port): (&Path, &str), panel: &Path, more: &[&OsStr]) {
        let mut command = Command::new(env!("CARGO_BIN_EXE_panel-server"));
        command.args(["--port", port, "--assets"]).arg(panel).args(more);
        command.arg("--vthal").arg(daemon);
        command.arg("--simulator").arg(self.simulator_socket());
        command.arg("--matter").arg(self.matter_socket());
        let (process, line) = Process::start(&mut command);
        self.processes.push(process);
        self.address = line.trim().trim_start_matches("ready ").to_owned();
    }
}

impl Drop for Stack {
    fn drop(&mut self) {
        self.vthal = None;
        self.processes.clear();
    }
}
