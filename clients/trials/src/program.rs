//! Programs that a trial starts: ours, and those of the peers.

use std::fs::File;
use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use anyhow::{Context as _, bail};

/// A program that runs until this is dropped. What it says goes to a file.
#[derive(Debug)]
pub(crate) struct Program {
    child: Child,
    log: PathBuf,
}

impl Program {
    pub(crate) fn start(mut command: Command, log: PathBuf) -> anyhow::Result<Self> {
        let file = File::options().create(true).append(true).open(&log)?;
        let child = command
            .stdin(Stdio::null())
            .stdout(file.try_clone()?)
            .stderr(file)
            .spawn()
            .with_context(|| format!("cannot start {}", command.get_program().display()))?;
        Ok(Self { child, log })
    }

    pub(crate) fn id(&self) -> u32 {
        self.child.id()
    }

    pub(crate) fn lives(&mut self) -> bool {
        matches!(self.child.try_wait(), Ok(None))
    }

    /// All that it has said.
    pub(crate) fn said(&self) -> String {
        std::fs::read_to_string(&self.log).unwrap_or_default()
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        // As a power cut would: nothing has time to say goodbye.
        self.child.kill().ok();
        self.child.wait().ok();
    }
}

/// A port of loopback that nobody has.
pub(crate) fn free_port() -> anyhow::Result<u16> {
    Ok(TcpListener::bind("127.0.0.1:0")?.local_addr()?.port())
}

/// Looks again until there is something; fails after `patience`.
pub(crate) fn wait_for<T>(
    what: &str,
    patience: Duration,
    mut look: impl FnMut() -> anyhow::Result<Option<T>>,
) -> anyhow::Result<T> {
    let end = Instant::now() + patience;
    let mut last = None;
    while Instant::now() < end {
        match look() {
            Ok(Some(found)) => return Ok(found),
            Ok(None) => {}
            Err(error) => last = Some(error),
        }
        sleep(Duration::from_millis(50));
    }
    match last {
        Some(error) => Err(error).with_context(|| format!("{what} within {patience:?}")),
        None => bail!("{what}: not within {patience:?}"),
    }
}

/// The word after `version` in what a program says of itself, whatever code it ends with.
pub(crate) fn version_in(command: &mut Command) -> anyhow::Result<Option<String>> {
    let said = command.stdin(Stdio::null()).output()?;
    let text = [said.stdout, said.stderr].concat();
    let text = String::from_utf8_lossy(&text).into_owned();
    let mut words = text.split_whitespace().skip_while(|word| *word != "version");
    Ok(words.nth(1).map(|word| word.trim_end_matches(',').to_owned()))
}

/// The version of a package that a Python has.
pub(crate) fn python_package(python: &Path, name: &str) -> anyhow::Result<String> {
    let ask = format!("import importlib.metadata as m; print(m.version('{name}'))");
    Ok(output(Command::new(python).args(["-c", &ask]))?.trim().to_owned())
}

/// The output of a program that ends by itself.
pub(crate) fn output(command: &mut Command) -> anyhow::Result<String> {
    let output = command
        .stdin(Stdio::null())
        .output()
        .with_context(|| format!("cannot start {}", command.get_program().display()))?;
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    if !output.status.success() {
        bail!(
            "{} ended with {}: {}",
            command.get_program().display(),
            output.status,
            text(&output.stderr)
        );
    }
    Ok(text(&output.stdout) + &text(&output.stderr))
}

/// Debian keeps servers where only root looks for programs.
pub(crate) fn server(name: &str) -> PathBuf {
    let sbin = Path::new("/usr/sbin").join(name);
    if sbin.is_file() { sbin } else { name.into() }
}
