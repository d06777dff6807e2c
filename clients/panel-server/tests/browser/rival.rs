//! Another client that asks to drive, directly at the daemon's socket.
#![allow(
    dead_code,
    reason = "each set of tests that shares this uses another part of it"
)]

use std::io::{BufRead, BufReader, Write};
use std::os::unix::net::UnixStream;
use std::path::Path;
use std::time::Duration;

use rvac_api::{SEPARATOR, Update};

/// The longest lease that the daemon gives, milliseconds.
const LEASE_MS: u32 = 400;

/// Often enough that a lease does not end between two asks.
const BETWEEN: Duration = Duration::from_millis(100);

/// Leaves the seat without a word when it is dropped.
#[derive(Debug)]
pub(crate) struct Rival {
    stream: UnixStream,
    heard: BufReader<UnixStream>,
    asked: u32,
}

impl Rival {
    pub(crate) fn at(socket: &Path) -> Self {
        let stream = UnixStream::connect(socket).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
        let heard = BufReader::new(stream.try_clone().unwrap());
        Self {
            stream,
            heard,
            asked: 0,
        }
    }

    /// Asks to turn on the spot so fast, rad/s, and gives why not.
    pub(crate) fn ask(&mut self, turn_rad_s: f64) -> Option<String> {
        self.asked += 1;
        let id = self.asked;
        let asked =
            format!(r#"{{"c":"drive","v":0,"w":{turn_rad_s},"ttl":{LEASE_MS},"id":{id}}}"#) + "\u{1f}";
        self.stream.write_all(asked.as_bytes()).unwrap();
        loop {
            let mut message = Vec::new();
            self.heard.read_until(SEPARATOR, &mut message).unwrap();
            message.pop();
            match serde_json::from_slice(&message).unwrap() {
                Update::Done { id: of } if of == id => return None,
                Update::Failed(failure) if failure.id == Some(id) => return Some(failure.reason),
                _ => {}
            }
        }
    }

    /// Holds a stick for a second, from its middle on; gives how many asks were granted, and why others were not.
    pub(crate) fn turn_for_a_second(&mut self, turn_rad_s: f64) -> (usize, Vec<String>) {
        let mut refused: Vec<String> = self.ask(0.0).into_iter().collect();
        for _ in 0..10 {
            std::thread::sleep(BETWEEN);
            refused.extend(self.ask(turn_rad_s));
        }
        (11 - refused.len(), refused)
    }
}
