//! Programs of ours as processes: their folder, their first line, their socket, what they take.

use std::fs;
use std::io::{BufRead as _, BufReader, ErrorKind, Read as _, Write as _};
use std::os::unix::net::UnixStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};

use anyhow::{Context as _, ensure};
use rvac_api::SEPARATOR;

/// A folder for one trial, removed at its end; its path is short, because paths of sockets are.
#[derive(Debug)]
pub(crate) struct Scratch(PathBuf);

impl Scratch {
    pub(crate) fn new() -> anyhow::Result<Self> {
        static NUMBER: AtomicU32 = AtomicU32::new(0);
        let number = NUMBER.fetch_add(1, Ordering::Relaxed);
        let path = std::env::temp_dir().join(format!("joined-{}-{number}", std::process::id()));
        fs::create_dir_all(&path)?;
        Ok(Self(path))
    }

    pub(crate) fn join(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        // What is left is below the system's folder for temporary files.
        fs::remove_dir_all(&self.0).ok();
    }
}

/// A program that says `ready` when it is; it is killed when this goes, as by a power cut.
#[derive(Debug)]
pub(crate) struct Server {
    child: Child,
    ready: String,
}

impl Server {
    pub(crate) fn start(mut command: Command) -> anyhow::Result<Self> {
        let program = command.get_program().display().to_string();
        let mut child = command
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .with_context(|| format!("cannot start {program}"))?;
        let stdout = child.stdout.take().context("no output")?;
        let mut server = Self {
            child,
            ready: String::new(),
        };
        BufReader::new(stdout).read_line(&mut server.ready)?;
        ensure!(server.ready.starts_with("ready"), "{program} did not get ready");
        Ok(server)
    }

    pub(crate) fn id(&self) -> u32 {
        self.child.id()
    }

    /// The port in the line with which it said that it is ready.
    pub(crate) fn port(&self) -> anyhow::Result<u16> {
        let port = self
            .ready
            .rsplit(':')
            .next()
            .and_then(|rest| rest.trim().split('/').next());
        Ok(port.context("no port")?.parse()?)
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        // It may have ended already, which is what was wanted.
        self.child.kill().ok();
        self.child.wait().ok();
    }
}

/// A program of the same build as this one.
pub(crate) fn beside(name: &str) -> anyhow::Result<PathBuf> {
    let path = std::env::current_exe()?.with_file_name(name);
    ensure!(
        path.is_file(),
        "{name} is not built beside this program: cargo build --bin {name}"
    );
    Ok(path)
}

/// Asks at a socket of ours, and gives the first answer.
pub(crate) fn ask(socket: &Path, request: &str, patience: Duration) -> anyhow::Result<String> {
    ask_for(socket, (request, patience), |_| true)
}

/// The same, past what the socket says of itself: gives the first line that is an answer.
pub(crate) fn ask_for(
    socket: &Path,
    (request, patience): (&str, Duration),
    is_answer: impl Fn(&str) -> bool,
) -> anyhow::Result<String> {
    let mut stream = UnixStream::connect(socket)?;
    stream.write_all(request.as_bytes())?;
    stream.write_all(&[SEPARATOR])?;
    stream.set_read_timeout(Some(Duration::from_millis(100)))?;
    let end = Instant::now() + patience;
    let mut answer = Vec::new();
    let mut byte = [0];
    while Instant::now() < end {
        match stream.read(&mut byte) {
            Ok(0) => break,
            Ok(_) if byte == [SEPARATOR] => {
                let line = String::from_utf8_lossy(&core::mem::take(&mut answer)).into_owned();
                if is_answer(&line) {
                    return Ok(line);
                }
            }
            Ok(_) => answer.extend_from_slice(&byte),
            Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {}
            Err(error) => return Err(error.into()),
        }
    }
    anyhow::bail!("no answer to {request}")
}

/// Seconds for which a process has been on a processor.
pub(crate) fn ran_s(process: u32) -> anyhow::Result<f64> {
    let text = fs::read_to_string(format!("/proc/{process}/schedstat"))?;
    let ran_ns: f64 = text.split_whitespace().next().context("no time")?.parse()?;
    Ok(ran_ns / 1e9)
}

/// The share of a core that a program takes while something is done.
pub(crate) fn core_share(id: u32, work: impl FnOnce() -> anyhow::Result<()>) -> anyhow::Result<f64> {
    let before = ran_s(id)?;
    let begun = Instant::now();
    work()?;
    Ok((ran_s(id)? - before) / begun.elapsed().as_secs_f64())
}

/// Its memory in MiB: now (`VmRSS`), or the most that it was (`VmHWM`).
pub(crate) fn resident_mib(process: u32, which: &str) -> anyhow::Result<f64> {
    let text = fs::read_to_string(format!("/proc/{process}/status"))?;
    let line = text
        .lines()
        .find_map(|line| line.strip_prefix(which)?.strip_prefix(':'));
    let kib: f64 = line
        .and_then(|line| line.split_whitespace().next())
        .context("no memory")?
        .parse()?;
    Ok(kib / 1024.0)
}
