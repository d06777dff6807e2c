//! A pseudo terminal whose slave end has a path of our own.

use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::os::fd::AsFd;
use std::os::unix::ffi::OsStringExt;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::{OFlags, fcntl_getfl, fcntl_setfl};
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{OptionalActions, tcgetattr, tcsetattr};

/// The far end of a serial cable.
#[derive(Debug)]
pub struct Pty {
    master: File,
    /// Keeps the line from hanging up while no daemon has it open.
    _slave: File,
    link: PathBuf,
}

impl Pty {
    /// Opens one and lets `link` point to its slave end.
    pub fn open(link: &Path) -> io::Result<Self> {
        let master = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC)?;
        grantpt(&master)?;
        unlockpt(&master)?;
        let name = PathBuf::from(OsString::from_vec(ptsname(&master, Vec::new())?.into_bytes()));
        let slave = File::options().read(true).write(true).open(&name)?;
        let mut settings = tcgetattr(&slave)?;
        settings.make_raw();
        tcsetattr(&slave, OptionalActions::Now, &settings)?;
        let flags = fcntl_getfl(&master)?;
        fcntl_setfl(&master, flags | OFlags::NONBLOCK)?;
        fs::remove_file(link).ok();
        std::os::unix::fs::symlink(&name, link)?;
        Ok(Self {
            master: File::from(master),
            _slave: slave,
            link: link.to_owned(),
        })
    }

    /// Waits until bytes came or the deadline is over.
    pub fn wait(&self, deadline: Instant) -> io::Result<()> {
        let left = deadline.saturating_duration_since(Instant::now());
        let timeout = Timespec::try_from(left).unwrap_or_default();
        poll(
            &mut [PollFd::new(&self.master.as_fd(), PollFlags::IN)],
            Some(&timeout),
        )?;
        Ok(())
    }

    /// Takes the bytes that came.
    pub fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        match self.master.read(buffer) {
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => Ok(0),
            other => other,
        }
    }

    /// Writes everything; waits while the line is full, at most ten seconds.
    pub fn write_all(&mut self, mut bytes: &[u8]) -> io::Result<()> {
        let timeout = Timespec::try_from(Duration::from_secs(10)).unwrap_or_default();
        while !bytes.is_empty() {
            match self.master.write(bytes) {
                Ok(count) => bytes = bytes.get(count..).unwrap_or_default(),
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => {
                    let ready = poll(
                        &mut [PollFd::new(&self.master.as_fd(), PollFlags::OUT)],
                        Some(&timeout),
                    )?;
                    if ready == 0 {
                        return Err(io::ErrorKind::TimedOut.into());
                    }
                }
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }
}

impl Drop for Pty {
    fn drop(&mut self) {
        fs::remove_file(&self.link).ok();
    }
}
