//! Where a radio's bytes come from: a serial device, a FIFO, or the socket of a program.

use std::io;
use std::os::unix::fs::FileTypeExt;
use std::path::{Path, PathBuf};

use tokio::net::UnixStream;
use tokio::net::unix::pipe;

use crate::serial::{self, Line, SerialSettings};

/// An open source.
pub(super) enum Port {
    Serial(Line),
    Pipe(pipe::Receiver),
    Socket(UnixStream),
}

/// Why there is none.
#[derive(Debug, thiserror::Error)]
pub(super) enum PortError {
    #[error("cannot open {}: {error}", .path.display())]
    Open {
        path: PathBuf,
        #[source]
        error: io::Error,
    },
    #[error("{} is no serial device, FIFO or socket", .0.display())]
    Kind(PathBuf),
    #[error(transparent)]
    Serial(#[from] serial::OpenError),
}

impl Port {
    /// Opens the device or pipe at the path.
    pub(super) async fn open(path: &Path, baud: u32) -> Result<Self, PortError> {
        let refused = |error| PortError::Open {
            path: path.to_owned(),
            error,
        };
        let kind = std::fs::metadata(path).map_err(refused)?.file_type();
        if kind.is_char_device() {
            let settings = SerialSettings {
                path: path.to_owned(),
                baud,
            };
            return Ok(serial::open(&settings).map(Self::Serial)?);
        }
        if kind.is_fifo() {
            // Opened for writing, too: otherwise it is at its end whenever no program has it open.
            let opened = pipe::OpenOptions::new().read_write(true).open_receiver(path);
            return opened.map(Self::Pipe).map_err(refused);
        }
        if kind.is_socket() {
            return UnixStream::connect(path).await.map(Self::Socket).map_err(refused);
        }
        Err(PortError::Kind(path.to_owned()))
    }

    /// Waits for bytes; 0 when the other end has gone.
    pub(super) async fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        loop {
            let read = match self {
                Self::Serial(line) => return line.port.read(buffer).await,
                Self::Pipe(pipe) => {
                    pipe.readable().await?;
                    pipe.try_read(buffer)
                }
                Self::Socket(socket) => {
                    socket.readable().await?;
                    socket.try_read(buffer)
                }
            };
            if !read.as_ref().is_err_and(is_early) {
                return read;
            }
        }
    }

    /// Writes what is taken of a few bytes. Nobody listens at a FIFO.
    pub(super) async fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        match self {
            Self::Serial(line) => line.port.write_all(bytes).await,
            Self::Pipe(_) => Ok(()),
            Self::Socket(socket) => {
                socket.writable().await?;
                match socket.try_write(bytes) {
                    Err(error) if !is_early(&error) => Err(error),
                    Ok(_) | Err(_) => Ok(()),
                }
            }
        }
    }
}

/// tokio was notified of something that has gone meanwhile.
fn is_early(error: &io::Error) -> bool {
    error.kind() == io::ErrorKind::WouldBlock
}
