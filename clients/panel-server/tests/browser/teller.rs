//! Another client, which sends an input of control mixes directly to the daemon's socket.

use std::io::{Read, Write};
use std::os::unix::net::UnixStream;
use std::path::Path;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::Duration;

use rvac_api::INPUT_LEASE_MS_MAX;

/// Often enough that no lease ends in between on a busy machine.
const BETWEEN: Duration = Duration::from_millis(50);

/// What it does from now on.
enum Turn {
    /// Tells this value again and again.
    Tell(f64),
    /// Says nothing more, and keeps the connection.
    FallSilent,
}

/// Ends without a word when it is dropped.
#[derive(Debug)]
pub(crate) struct Teller {
    turns: Option<Sender<Turn>>,
    thread: Option<JoinHandle<()>>,
}

impl Drop for Teller {
    fn drop(&mut self) {
        drop(self.turns.take());
        if let Some(thread) = self.thread.take() {
            thread.join().ok(); // A thread that failed has said why.
        }
    }
}

impl Teller {
    /// Tells that the input of this name is at rest.
    pub(crate) fn of(name: &str, socket: &Path) -> Self {
        let mut stream = UnixStream::connect(socket).unwrap();
        let mut answers = stream.try_clone().unwrap();
        // Reads the messages, so that they fill no buffer.
        std::thread::spawn(move || while answers.read(&mut [0; 4096]).is_ok_and(|count| count > 0) {});
        let name = name.to_owned();
        let (turns, inbox) = channel();
        let thread = std::thread::spawn(move || {
            let mut turn = Turn::Tell(0.0);
            loop {
                if let Turn::Tell(value) = turn {
                    let told = format!(
                        r#"{{"c":"set-inputs","values":{{"{name}":{value}}},"ttl":{INPUT_LEASE_MS_MAX}}}"#
                    );
                    stream.write_all((told + "\u{1f}").as_bytes()).unwrap();
                }
                match inbox.recv_timeout(BETWEEN) {
                    Ok(next) => turn = next,
                    Err(RecvTimeoutError::Timeout) => {}
                    Err(RecvTimeoutError::Disconnected) => {
                        stream.shutdown(std::net::Shutdown::Both).ok(); // The daemon may be gone.
                        return;
                    }
                }
            }
        });
        Self {
            turns: Some(turns),
            thread: Some(thread),
        }
    }

    pub(crate) fn tell(&self, value: f64) {
        self.turn(Turn::Tell(value));
    }

    pub(crate) fn fall_silent(&self) {
        self.turn(Turn::FallSilent);
    }

    fn turn(&self, turn: Turn) {
        self.turns
            .as_ref()
            .unwrap()
            .send(turn)
            .expect("it tells until it is dropped");
    }
}
