//! Raw readings on request: one answer, or a stream under a lease that ends by itself.

use heapless::Vec;
use rvac_protocol::message::{PROBE_BYTES, Probe, ProbeTarget, Probed, ProbedContent, Refusal, SerialProbe};
use rvac_units::Tick;

use crate::board::PinProbe;
use crate::timing::{Deadline, Periodic};

/// Pause between two answers under a lease.
const PERIOD_MS: u32 = 50;
/// Bytes of a serial port wait this long for others to share their packet.
const GATHER_MS: u32 = 20;

/// The readings that are being reported.
#[derive(Clone, Debug)]
pub(crate) struct Probing {
    target: Option<ProbeTarget>,
    lease: Deadline,
    next: Periodic,
    gathered: Vec<u8, PROBE_BYTES>,
    gathered_at: Tick,
    /// Bytes sent since the port was opened.
    at: u32,
}

impl Probing {
    pub(crate) const fn starting_at(now: Tick) -> Self {
        Self {
            target: None,
            lease: Deadline::NONE,
            next: Periodic::starting_at(now),
            gathered: Vec::new(),
            gathered_at: now,
            at: 0,
        }
    }

    /// Begins readings, or extends the lease if the target is the same.
    ///
    /// # Errors
    /// As the board refuses the serial port.
    pub(crate) fn begin<P: PinProbe>(
        &mut self,
        board: &mut P,
        command: &Probe,
        now: Tick,
    ) -> Result<(), Refusal> {
        let goes_on = self.lease.is_running() && self.target == Some(command.target);
        if !goes_on {
            self.end(board);
            if let ProbeTarget::Serial { port, baud } = command.target {
                board.open_serial(port, baud)?;
            }
            self.next = Periodic::starting_at(now);
        }
        self.target = Some(command.target);
        self.lease = match command.lease_ms {
            0 => Deadline::NONE,
            lease_ms => Deadline::at(now.after(u32::from(lease_ms))),
        };
        Ok(())
    }

    /// Ends the readings, when their lease or the session is over.
    pub(crate) fn end<P: PinProbe>(&mut self, board: &mut P) {
        if let Some(ProbeTarget::Serial { .. }) = self.target {
            board.close_serial();
        }
        self.target = None;
        self.lease = Deadline::NONE;
        self.gathered.clear();
        self.at = 0;
    }

    /// Collects received bytes of the serial port, and ends readings whose lease is over.
    pub(crate) fn gather<P: PinProbe>(&mut self, board: &mut P, now: Tick) {
        if self.target.is_none() {
            return;
        }
        if self.lease.has_come(now) {
            self.end(board);
        }
        if let Some(ProbeTarget::Serial { .. }) = self.target {
            if self.gathered.is_empty() {
                self.gathered_at = now;
            }
            let mut bytes = [0; PROBE_BYTES];
            let room = PROBE_BYTES.saturating_sub(self.gathered.len());
            let taken = board.read_serial(bytes.get_mut(..room).unwrap_or_default());
            let received = bytes.get(..taken.min(room)).unwrap_or_default();
            // There is room: no more was asked for.
            self.gathered.extend_from_slice(received).ok();
        }
    }

    /// The answer that is due.
    pub(crate) fn take<P: PinProbe>(&mut self, board: &mut P, now: Tick) -> Option<Probed> {
        let target = self.target?;
        let content = match target {
            ProbeTarget::Serial { .. } => {
                let waited = now.since(self.gathered_at) >= GATHER_MS;
                if self.gathered.is_empty() || !(self.gathered.is_full() || waited) {
                    return None;
                }
                ProbedContent::Serial(self.take_serial(board))
            }
            _ if !self.next.is_due(now, PERIOD_MS) => return None,
            ProbeTarget::Analog => ProbedContent::Analog(board.analog()),
            ProbeTarget::Encoders => ProbedContent::Encoders(board.encoders()),
            ProbeTarget::Lines => ProbedContent::Lines(board.lines()),
            ProbeTarget::Buttons => ProbedContent::Buttons(board.buttons()),
        };
        if !self.lease.is_running() {
            self.target = None;
        }
        Some(Probed { tick: now, content })
    }

    fn take_serial<P: PinProbe>(&mut self, board: &mut P) -> SerialProbe {
        let bytes = core::mem::take(&mut self.gathered);
        let at = self.at;
        self.at = at.wrapping_add(u32::try_from(bytes.len()).unwrap_or(0));
        SerialProbe {
            at,
            lost: board.serial_lost(),
            bytes,
        }
    }
}
