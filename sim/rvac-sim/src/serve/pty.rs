//! The pseudoterminal of the simulated robot.

use std::fs;
use std::io::{self, Read, Write};
use std::os::fd::{AsFd, BorrowedFd};
use std::os::unix::ffi::OsStringExt;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};

use rustix::io::Errno;
use rustix::pty::{OpenptFlags, grantpt, ioctl_tiocgptpeer, openpt, ptsname, unlockpt};
use rustix::termios::{OptionalActions, tcgetattr, tcsetattr};

/// A pseudoterminal in raw mode whose slave side has a symbolic link to it. The link goes with the value.
///
/// Nobody needs to have the slave open: bytes that the robot says then are lost, as on a serial cable.
#[derive(Debug)]
pub(crate) struct Pty {
    master: fs::File,
    link: PathBuf,
    slave: PathBuf,
}

impl Pty {
    /// Opens a pseudoterminal and makes `link` a symbolic link to its slave side. A symbolic link that exists there
    /// already is replaced: it is what a killed simulator leaves behind. Anything else there is left alone.
    ///
    /// # Errors
    /// The system has no pseudoterminal left, or the link cannot be made.
    pub(crate) fn open(link: &Path) -> Result<Self, PtyError> {
        let (master, slave) = open_raw().map_err(PtyError::Open)?;
        link_to(link, &slave)?;
        Ok(Self {
            master: master.into(),
            link: link.to_owned(),
            slave,
        })
    }

    /// Reads what the other side has written, at most `buffer.len()` bytes; 0 when there is nothing or no peer.
    ///
    /// # Errors
    /// What the system reports besides "nothing there".
    pub(crate) fn read(&mut self, buffer: &mut [u8]) -> io::Result<Peer> {
        match self.master.read(buffer) {
            Ok(count) => Ok(Peer::Present(count)),
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => Ok(Peer::Present(0)),
            Err(error) if error.kind() == io::ErrorKind::Interrupted => Ok(Peer::Present(0)),
            // Linux returns EIO while the slave is not open.
            Err(error) if error.raw_os_error() == Some(Errno::IO.raw_os_error()) => Ok(Peer::Absent),
            Err(error) => Err(error),
        }
    }

    /// Writes what fits and says how much that was; the rest is the caller's to drop, as a receiver that is not read
    /// overruns.
    ///
    /// # Errors
    /// What the system reports besides "no room".
    pub(crate) fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self.master.write(bytes) {
            Ok(count) => Ok(count),
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => Ok(0),
            Err(error) if error.kind() == io::ErrorKind::Interrupted => Ok(0),
            Err(error) if error.raw_os_error() == Some(Errno::IO.raw_os_error()) => Ok(0),
            Err(error) => Err(error),
        }
    }
}

impl AsFd for Pty {
    fn as_fd(&self) -> BorrowedFd<'_> {
        self.master.as_fd()
    }
}

impl Drop for Pty {
    fn drop(&mut self) {
        // Only our own link: another simulator may have taken the name over.
        if fs::read_link(&self.link).is_ok_and(|target| target == self.slave) {
            fs::remove_file(&self.link).ok();
        }
    }
}

/// Whether a process has the slave side open.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Peer {
    /// Somebody has, and this many bytes were read.
    Present(usize),
    /// Nobody has.
    Absent,
}

/// Why the pseudoterminal cannot be opened.
#[derive(Debug, thiserror::Error)]
pub enum PtyError {
    /// The system refuses.
    #[error(
        "no pseudoterminal can be opened: {0}; check that /dev/ptmx exists and that not too many terminals are open"
    )]
    Open(Errno),
    /// Something else than a symbolic link has the name.
    #[error("{} exists and is not a symbolic link; remove it or choose another --link", .0.display())]
    Taken(PathBuf),
    /// The link cannot be made.
    #[error("cannot make the symbolic link {}: {error}; choose another --link", path.display())]
    Link {
        /// Where.
        path: PathBuf,
        /// Why.
        error: io::Error,
    },
}

fn open_raw() -> Result<(std::os::fd::OwnedFd, PathBuf), Errno> {
    let flags = OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC;
    let master = openpt(flags)?;
    grantpt(&master)?;
    unlockpt(&master)?;
    let slave = ioctl_tiocgptpeer(&master, flags)?;
    let mut settings = tcgetattr(&slave)?;
    settings.make_raw();
    tcsetattr(&slave, OptionalActions::Now, &settings)?;
    rustix::io::ioctl_fionbio(&master, true)?;
    let name = ptsname(&master, Vec::new())?;
    Ok((master, std::ffi::OsString::from_vec(name.into_bytes()).into()))
}

fn link_to(link: &Path, slave: &Path) -> Result<(), PtyError> {
    match fs::symlink_metadata(link) {
        Ok(there) if !there.file_type().is_symlink() => return Err(PtyError::Taken(link.to_owned())),
        Ok(_) => fs::remove_file(link).map_err(|error| link_error(link, error))?,
        Err(_) => {}
    }
    symlink(slave, link).map_err(|error| link_error(link, error))
}

fn link_error(path: &Path, error: io::Error) -> PtyError {
    PtyError::Link {
        path: path.to_owned(),
        error,
    }
}

#[cfg(test)]
mod tests {
    use super::{Peer, Pty, PtyError};
    use std::fs;
    use std::io::{Read, Write};

    fn place(name: &str) -> std::path::PathBuf {
        std::env::temp_dir().join(format!("rvac-sim-{}-{name}", std::process::id()))
    }

    #[test]
    fn bytes_pass_unchanged_and_the_other_side_may_come_back() {
        let link = place("pty");
        let mut pty = Pty::open(&link).unwrap();
        let mut buffer = [0; 16];
        assert_eq!(pty.read(&mut buffer).unwrap(), Peer::Absent);
        for round in 0..5_u8 {
            let mut peer = fs::OpenOptions::new().read(true).write(true).open(&link).unwrap();
            // Bytes that a terminal in its usual mode would change or swallow.
            let awkward = [0x03, b'\r', b'\n', 0x1F, 0x7F, 0x80 + round];
            peer.write_all(&awkward).unwrap();
            assert_eq!(pty.read(&mut buffer).unwrap(), Peer::Present(6));
            assert_eq!(buffer[..6], awkward);
            assert_eq!(pty.write(&awkward).unwrap(), 6);
            peer.read_exact(&mut buffer[..6]).unwrap();
            assert_eq!(buffer[..6], awkward);
            drop(peer);
            assert_eq!(pty.read(&mut buffer).unwrap(), Peer::Absent);
        }
        drop(pty);
        assert!(fs::symlink_metadata(&link).is_err(), "the link goes with the pty");
    }

    #[test]
    fn a_side_that_never_reads_takes_only_what_fits() {
        let link = place("pty-full");
        let mut pty = Pty::open(&link).unwrap();
        let peer = fs::OpenOptions::new().read(true).write(true).open(&link).unwrap();
        let mut written = 0;
        for _ in 0..100 {
            written += pty.write(&[b'x'; 4096]).unwrap();
        }
        assert!(written < 100 * 4096, "the terminal's buffer is bounded");
        drop(peer);
    }

    #[test]
    fn a_file_of_somebody_is_left_alone() {
        let link = place("pty-taken");
        fs::write(&link, "precious").unwrap();
        assert!(matches!(Pty::open(&link), Err(PtyError::Taken(_))));
        assert_eq!(fs::read_to_string(&link).unwrap(), "precious");
        fs::remove_file(&link).unwrap();
    }
}
