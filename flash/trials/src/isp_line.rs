//! The serial line between a flasher and the simulated loader, on a virtual clock.

use stc_isp::{Action, Flasher, IspError, Report};
use stc90::loader::{BootLoader, LoaderByte};

/// What is wrong with the host.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct HostFaults {
    /// RX and TX are swapped: neither hears the other.
    pub is_swapped: bool,
    /// The supply is not switched: something else feeds the chip.
    pub is_fed: bool,
    /// The host sleeps for 50 ms after so many of its actions; 0 for never.
    pub pause_every: u32,
    /// The supply of robot and Linux board fails at this time.
    pub power_cut_ms: Option<u64>,
}

/// How a conversation ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// It is done.
    Finished(Report),
    /// It failed.
    Failed(IspError),
    /// The supply failed.
    PowerCut,
}

/// A host at the line, and the loader at its other end.
#[derive(Debug)]
pub struct SimulatedLine<'a> {
    loader: &'a mut BootLoader,
    faults: HostFaults,
    baud: u32,
    now_ms: u64,
    actions: u32,
    is_on: bool,
}

impl<'a> SimulatedLine<'a> {
    /// A line to a chip whose supply is on.
    pub fn new(loader: &'a mut BootLoader, faults: HostFaults, now_ms: u64) -> Self {
        loader.power_on(now_ms);
        Self {
            loader,
            faults,
            baud: 2_400,
            now_ms,
            actions: 0,
            is_on: true,
        }
    }

    /// Milliseconds since the start.
    pub fn now_ms(&self) -> u64 {
        self.now_ms
    }

    /// Holds the conversation to its end.
    pub fn converse(&mut self, flasher: &mut Flasher) -> Ending {
        loop {
            if self.faults.power_cut_ms.is_some_and(|at_ms| self.now_ms >= at_ms) {
                self.loader.power_off();
                return Ending::PowerCut;
            }
            let said = self.loader.say(self.now_ms);
            let heard: Vec<u8> = said.into_iter().filter_map(|said| self.heard(said)).collect();
            flasher.receive(&heard, self.now_ms);
            match flasher.next_action(self.now_ms) {
                Some(Action::Finish(report)) => return Ending::Finished(report),
                Some(Action::Fail(error)) => return Ending::Failed(error),
                Some(action) => self.perform(action),
                None => {
                    let wake_ms = flasher.wake_at_ms();
                    let next_ms = self
                        .loader
                        .says_at_ms()
                        .map_or(wake_ms, |at_ms| at_ms.min(wake_ms));
                    self.now_ms = next_ms.max(self.now_ms + 1);
                }
            }
        }
    }

    fn heard(&self, said: LoaderByte) -> Option<u8> {
        let is_close = said.baud.abs_diff(self.baud) * 20 <= self.baud;
        (is_close && !self.faults.is_swapped).then_some(said.byte)
    }

    fn perform(&mut self, action: Action) {
        self.actions += 1;
        if self.faults.pause_every != 0 && self.actions.is_multiple_of(self.faults.pause_every) {
            self.now_ms += 50;
        }
        match action {
            Action::Send(bytes) => self.send(&bytes),
            Action::SetBaud(baud) => self.baud = baud,
            Action::PowerOff | Action::AskForPowerCycle if !self.faults.is_fed => {
                self.is_on = false;
                self.loader.power_off();
                if action == Action::AskForPowerCycle {
                    self.now_ms += 2_000;
                    self.power_on();
                }
            }
            Action::PowerOn if !self.is_on => self.power_on(),
            _ => {}
        }
    }

    fn power_on(&mut self) {
        self.is_on = true;
        self.loader.power_on(self.now_ms);
    }

    /// Each byte arrives when its last bit has.
    fn send(&mut self, bytes: &[u8]) {
        let from_ms = self.now_ms;
        for (number, byte) in (1..).zip(bytes) {
            self.now_ms = from_ms + (number * 10_000_u64).div_ceil(u64::from(self.baud));
            if !self.faults.is_swapped {
                let heard = LoaderByte {
                    byte: *byte,
                    baud: self.baud,
                };
                self.loader.hear(heard, self.now_ms);
            }
        }
    }
}
