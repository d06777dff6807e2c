//! The simulated loader behind a pseudo terminal, for flashers that want a serial device.

use std::collections::VecDeque;
use std::ffi::OsString;
use std::fs::File;
use std::io::{self, ErrorKind, Read as _, Write as _};
use std::os::unix::ffi::OsStringExt as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use rustix::fs::{OFlags, fcntl_getfl, fcntl_setfl};
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{OptionalActions, tcgetattr, tcsetattr};
use stc90::loader::{BootLoader, LoaderByte};

/// A person who is asked for it switches the robot off and on within so long.
const POWER_CYCLE_MS: u64 = 700;
/// How often the terminal is looked at.
const LOOK: Duration = Duration::from_millis(1);

/// A loader at the other end of a terminal; it ends with this value.
#[derive(Debug)]
pub struct LoaderTerminal {
    path: PathBuf,
    ends: Arc<AtomicBool>,
    thread: Option<JoinHandle<io::Result<BootLoader>>>,
    _slave: File,
}

impl LoaderTerminal {
    /// Puts a chip behind a terminal. Whenever its program runs and somebody calls, a person switches it off and on.
    ///
    /// # Errors
    /// What the system says.
    pub fn start(loader: BootLoader) -> io::Result<Self> {
        let master = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC)?;
        grantpt(&master)?;
        unlockpt(&master)?;
        let path = PathBuf::from(OsString::from_vec(ptsname(&master, Vec::new())?.into_bytes()));
        let slave = File::options().read(true).write(true).open(&path)?;
        let mut settings = tcgetattr(&slave)?;
        settings.make_raw();
        tcsetattr(&slave, OptionalActions::Now, &settings)?;
        fcntl_setfl(&master, fcntl_getfl(&master)? | OFlags::NONBLOCK)?;
        let ends = Arc::new(AtomicBool::new(false));
        let told = Arc::clone(&ends);
        let thread = std::thread::spawn(move || serve(File::from(master), loader, &told));
        Ok(Self {
            path,
            ends,
            thread: Some(thread),
            _slave: slave,
        })
    }

    /// The terminal's device.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Ends it, and gives the chip back.
    ///
    /// # Errors
    /// What the system said meanwhile.
    pub fn end(mut self) -> io::Result<BootLoader> {
        self.ends.store(true, Ordering::Relaxed);
        let thread = self.thread.take().ok_or(ErrorKind::NotFound)?;
        thread
            .join()
            .map_err(|_| io::Error::other("the loader's thread panicked"))?
    }
}

fn serve(mut master: File, mut loader: BootLoader, ends: &AtomicBool) -> io::Result<BootLoader> {
    let begun = Instant::now();
    let mut called_since_ms = None;
    let mut on_the_wire = VecDeque::new();
    let mut free_at_us = 0;
    loader.power_on(0);
    while !ends.load(Ordering::Relaxed) {
        let now_ms = u64::try_from(begun.elapsed().as_millis()).unwrap_or(u64::MAX);
        // The rate that the other end has set: a pseudo terminal carries bytes at any.
        let baud = tcgetattr(&master)?.output_speed();
        let mut buffer = [0; 512];
        let count = match master.read(&mut buffer) {
            Ok(count) => count,
            Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::Interrupted) => 0,
            Err(error) => return Err(error),
        };
        // A terminal carries bytes at once; on a wire each takes its ten bits.
        for byte in buffer.iter().take(count) {
            let byte_us = 10_000_000 / u64::from(baud.max(1));
            free_at_us = free_at_us.max(now_ms * 1_000) + byte_us;
            on_the_wire.push_back((free_at_us / 1_000, LoaderByte { byte: *byte, baud }));
        }
        while let Some((at_ms, byte)) = on_the_wire.pop_front_if(|(at_ms, _)| *at_ms <= now_ms) {
            loader.hear(byte, at_ms);
        }
        // Calls that nobody answers let a person switch the robot off and on.
        let heard = buffer.get(..count).unwrap_or_default();
        if heard.iter().any(|byte| *byte != 0x7F) {
            called_since_ms = None;
        } else if !heard.is_empty() {
            let since_ms = *called_since_ms.get_or_insert(now_ms);
            if now_ms > since_ms + POWER_CYCLE_MS {
                loader.power_off();
                loader.power_on(now_ms);
                called_since_ms = None;
            }
        }
        for said in loader.say(now_ms) {
            let is_close = said.baud.abs_diff(baud) * 20 <= baud;
            master.write_all(&[if is_close { said.byte } else { !said.byte }])?;
        }
        std::thread::sleep(LOOK);
    }
    Ok(loader)
}
