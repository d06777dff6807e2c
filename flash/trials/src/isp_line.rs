//! The serial line between a flasher and the simulated loader, on a virtual clock.

use rvac_flash::relax::{self, IspLine, JobError, Power};
use stc_isp::{Flasher, Report};
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

/// The supply failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the supply failed")]
pub struct SupplyLost;

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
    pub fn new(loader: &'a mut BootLoader, faults: HostFaults) -> Self {
        loader.power_on(0);
        Self {
            loader,
            faults,
            baud: 2_400,
            now_ms: 0,
            actions: 0,
            is_on: true,
        }
    }

    /// Holds the conversation to its end.
    ///
    /// # Errors
    /// Why it failed.
    pub fn converse(&mut self, flasher: Flasher) -> Result<Report, JobError> {
        relax::converse(self, flasher, &mut |_, _| {})
    }

    /// An action of the host begins.
    fn act(&mut self) -> Result<(), SupplyLost> {
        self.actions += 1;
        if self.faults.pause_every != 0 && self.actions.is_multiple_of(self.faults.pause_every) {
            self.now_ms += 50;
        }
        if self.faults.power_cut_ms.is_some_and(|at_ms| self.now_ms >= at_ms) {
            self.loader.power_off();
            return Err(SupplyLost);
        }
        Ok(())
    }

    fn power_on(&mut self) {
        self.is_on = true;
        self.loader.power_on(self.now_ms);
    }

    fn take_said(&mut self) -> Vec<u8> {
        let said = self.loader.say(self.now_ms);
        let is_heard = |said: &LoaderByte| {
            let is_close = said.baud.abs_diff(self.baud) * 20 <= self.baud;
            is_close && !self.faults.is_swapped
        };
        said.into_iter().filter(is_heard).map(|said| said.byte).collect()
    }
}

impl IspLine for SimulatedLine<'_> {
    type Error = SupplyLost;

    /// Each byte arrives when its last bit has.
    fn send(&mut self, bytes: &[u8]) -> Result<(), SupplyLost> {
        self.act()?;
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
        Ok(())
    }

    fn receive(&mut self, wait_ms: u64) -> Result<Vec<u8>, SupplyLost> {
        self.act()?;
        let said = self.take_said();
        if !said.is_empty() {
            return Ok(said);
        }
        let until_ms = self.now_ms + wait_ms.max(1);
        let next_ms = self
            .loader
            .says_at_ms()
            .map_or(until_ms, |at_ms| at_ms.min(until_ms));
        self.now_ms = next_ms.max(self.now_ms + 1);
        Ok(self.take_said())
    }

    fn set_baud(&mut self, baud: u32) -> Result<(), SupplyLost> {
        self.act()?;
        self.baud = baud;
        Ok(())
    }

    fn switch(&mut self, power: Power) -> Result<(), SupplyLost> {
        self.act()?;
        match power {
            Power::Off | Power::ByPerson if !self.faults.is_fed => {
                self.is_on = false;
                self.loader.power_off();
                if power == Power::ByPerson {
                    self.now_ms += 2_000;
                    self.power_on();
                }
            }
            Power::On if !self.is_on => self.power_on(),
            _ => {}
        }
        Ok(())
    }

    fn now_ms(&self) -> u64 {
        self.now_ms
    }
}
