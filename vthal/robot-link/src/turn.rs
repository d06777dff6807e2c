//! One turn after the other on a link that the host clocks: what passes, how long to rest, and when a bus is given up.

use crate::{ClockedHost, PollPace, TransfersOver};

/// Transfers in a row that may fail before the link is given up: noise on a bus is over sooner. With the rests between them that
/// is a tenth of a second, less than any lease.
const FAILURES_MAX: u32 = 25;
/// Rest after a transfer that failed.
const REST_US: u64 = 4_000;

/// The host's end of a link that it clocks.
#[derive(Clone, Debug)]
pub struct ClockedEnd<H> {
    host: H,
    pace: PollPace,
    failures: u32,
}

impl<H: ClockedHost> ClockedEnd<H> {
    /// Nothing has passed yet.
    #[must_use]
    pub const fn new(host: H, has_attention: bool) -> Self {
        Self {
            host,
            pace: PollPace::new(has_attention),
            failures: 0,
        }
    }

    /// These bytes are for the robot.
    pub fn send(&mut self, bytes: &[u8]) {
        self.host.send(bytes);
    }

    /// Bytes that wait for the bus.
    #[must_use]
    pub fn waiting(&self) -> usize {
        self.host.waiting()
    }

    /// One transfer; what the robot said is appended to `heard`.
    ///
    /// # Errors
    /// The bus has failed many times in a row.
    pub fn turn<B>(&mut self, bus: &mut B, heard: &mut Vec<u8>) -> Result<(), H::Error>
    where
        H: TransfersOver<B>,
    {
        match self.host.transfer(bus, heard) {
            Ok(any) => {
                self.failures = 0;
                self.pace.transferred(any || self.host.waiting() > 0);
                Ok(())
            }
            Err(error) if self.failures >= FAILURES_MAX => Err(error),
            Err(_) => {
                self.failures += 1;
                Ok(())
            }
        }
    }

    /// How long to rest before the next turn, if nothing calls for it before.
    #[must_use]
    pub const fn rest_us(&self) -> u64 {
        if self.failures > 0 {
            REST_US
        } else {
            self.pace.pause_us()
        }
    }

    /// The robot holds its attention line high: the next turn follows at once, unless the bus fails.
    pub const fn called(&mut self) {
        self.pace.transferred(true);
    }
}

#[cfg(test)]
mod tests {
    use std::collections::VecDeque;

    use super::{ClockedEnd, FAILURES_MAX, REST_US};
    use crate::{I2cBus, I2cHost};

    /// Fails as the list says, then works with nothing to say and room for ten bytes.
    struct Bus {
        fails: VecDeque<bool>,
        heard: Vec<u8>,
    }

    impl I2cBus for Bus {
        type Error = u32;

        fn read(&mut self, _: u8, bytes: &mut [u8]) -> Result<(), u32> {
            if self.fails.pop_front().unwrap_or(false) {
                return Err(6);
            }
            bytes.copy_from_slice(&[0, 10]);
            Ok(())
        }

        fn write(&mut self, _: u8, bytes: &[u8]) -> Result<(), u32> {
            self.heard.extend_from_slice(bytes);
            Ok(())
        }
    }

    #[test]
    fn a_bus_that_fails_now_and_then_loses_nothing() {
        let mut bus = Bus {
            fails: [true, true, false, true].into(),
            heard: Vec::new(),
        };
        let mut end = ClockedEnd::new(I2cHost::default(), false);
        end.send(b"abc");
        let mut heard = Vec::new();
        for rest_us in [REST_US, REST_US] {
            assert_eq!(end.turn(&mut bus, &mut heard), Ok(()));
            assert_eq!((end.rest_us(), end.waiting()), (rest_us, 3));
        }
        assert_eq!(end.turn(&mut bus, &mut heard), Ok(()));
        assert_eq!((end.rest_us(), bus.heard.as_slice()), (0, b"abc".as_slice()));
        end.called();
        assert_eq!(end.turn(&mut bus, &mut heard), Ok(()));
        assert_eq!(end.rest_us(), REST_US, "a call does not hurry a bus that fails");
    }

    #[test]
    fn a_bus_that_goes_on_failing_is_given_up() {
        let mut bus = Bus {
            fails: vec![true; 100].into(),
            heard: Vec::new(),
        };
        let mut end = ClockedEnd::new(I2cHost::default(), true);
        let turns = (1..).find(|_| end.turn(&mut bus, &mut Vec::new()).is_err());
        assert_eq!(turns, Some(FAILURES_MAX + 1));
    }
}
