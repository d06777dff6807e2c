//! The daemon as a process.

use std::fs;
use std::io::{self, BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};

use anyhow::Context;
use rustix::process::{Pid, Signal, kill_process};

/// A folder for one trial, removed at its end.
#[derive(Debug)]
pub struct Scratch {
    path: PathBuf,
}

impl Scratch {
    /// A new folder under the system's folder for temporary files; short, because paths of sockets are.
    pub fn new() -> io::Result<Self> {
        static NUMBER: AtomicU32 = AtomicU32::new(0);
        let number = NUMBER.fetch_add(1, Ordering::Relaxed);
        let path = std::env::temp_dir().join(format!("vthal-{}-{number}", std::process::id()));
        fs::create_dir_all(&path)?;
        Ok(Self { path })
    }

    /// A path in it.
    pub fn join(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        fs::remove_dir_all(&self.path).ok();
    }
}

/// A running daemon. It is killed when the value goes.
#[derive(Debug)]
pub struct Daemon {
    child: Child,
    ready: String,
}

impl Daemon {
    /// Starts `program` as a daemon on the paths `tty`, `vthal.sock` and `state` of `scratch` and waits until it is ready.
    pub fn start(program: &Path, scratch: &Scratch, more: &[&str]) -> io::Result<Self> {
        Self::start_as(Command::new(program), scratch, more)
    }

    /// The same with so many bytes of address space at most: `prlimit` of util-linux sets the limit and becomes the program.
    pub fn start_within(
        address_space_bytes: u64,
        program: &Path,
        scratch: &Scratch,
        more: &[&str],
    ) -> io::Result<Self> {
        let mut command = Command::new("prlimit");
        command.arg(format!("--as={address_space_bytes}")).arg(program);
        Self::start_as(command, scratch, more)
    }

    /// The same by a command that becomes the program.
    pub fn start_as(mut command: Command, scratch: &Scratch, more: &[&str]) -> io::Result<Self> {
        command
            .arg("--serial")
            .arg(scratch.join("tty"))
            .arg("--socket")
            .arg(scratch.join("vthal.sock"))
            .arg("--state")
            .arg(scratch.join("state"))
            .args(more);
        Self::start_command(command)
    }

    /// Starts a command that prints one line when it is ready.
    pub fn start_command(mut command: Command) -> io::Result<Self> {
        let mut child = command
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()?;
        let stdout = child.stdout.take().ok_or(io::ErrorKind::BrokenPipe)?;
        let mut line = String::new();
        BufReader::new(stdout).read_line(&mut line)?;
        let daemon = Self { child, ready: line };
        if daemon.ready.starts_with("ready") {
            Ok(daemon)
        } else {
            Err(io::Error::other("the program did not get ready"))
        }
    }

    /// The line with which it said that it is ready.
    pub fn ready_line(&self) -> &str {
        self.ready.trim_end()
    }

    /// Its process number.
    pub fn id(&self) -> u32 {
        self.child.id()
    }

    /// Sends SIGTERM.
    pub fn terminate(&self) -> io::Result<()> {
        let pid = i32::try_from(self.child.id())
            .ok()
            .and_then(Pid::from_raw)
            .ok_or(io::ErrorKind::InvalidInput)?;
        Ok(kill_process(pid, Signal::TERM)?)
    }

    /// Sends SIGKILL and waits for the end.
    pub fn kill(mut self) -> io::Result<()> {
        self.child.kill()?;
        self.child.wait().map(drop)
    }

    /// The exit code if it has ended by itself.
    pub fn ended(&mut self) -> io::Result<Option<i32>> {
        Ok(self.child.try_wait()?.map(|status| status.code().unwrap_or(-1)))
    }
}

impl Drop for Daemon {
    fn drop(&mut self) {
        // It may have ended already, which is what was wanted.
        self.child.kill().ok();
        self.child.wait().ok();
    }
}

/// A program of the same build as the running one, without which there is nothing to measure.
pub fn needed_beside(name: &str) -> anyhow::Result<PathBuf> {
    built_beside(name)?
        .with_context(|| format!("{name} is not built beside this program: cargo build --bin {name}"))
}

/// A program of the same build as the running one, if it is there.
pub fn built_beside(name: &str) -> io::Result<Option<PathBuf>> {
    let mut folder = std::env::current_exe()?;
    folder.pop();
    if folder.ends_with("deps") {
        folder.pop();
    }
    let path = folder.join(name);
    Ok(path.exists().then_some(path))
}
