//! Links that the host clocks: the host's real end of each, over a master on the chip's pins.

use pic32::board::{CYCLES_PER_S, EmulatedRobot};
use robot_link::{ClockedEnd, I2cHost, SpiHost};
use rvac_channel::FaultRates;
use trials::buses::{Cable, I2cMaster, I2cWires, SpiMaster, SpiWires};

use crate::wire::LinkKind;

/// Clock of SPI.
const SPI_HZ: u32 = 1_000_000;
/// A link that was given up is opened again after that.
const REOPEN_US: u64 = 20_000;
const CYCLES_PER_US: u64 = CYCLES_PER_S / 1_000_000;

#[derive(Debug)]
enum Ends {
    Spi(ClockedEnd<SpiHost>, SpiMaster),
    I2c(ClockedEnd<I2cHost>, I2cMaster),
}

/// A link under way, with an attention line.
#[derive(Debug)]
pub(crate) struct ClockedBus {
    ends: Ends,
    /// The cycle at which the next turn is due.
    due: u64,
}

impl ClockedBus {
    /// A link of this kind, if the host clocks it.
    pub(crate) fn open(kind: LinkKind, robot: &mut EmulatedRobot) -> Option<Self> {
        let ends = match kind {
            LinkKind::Spi => Ends::Spi(fresh_spi(), SpiMaster::new(robot, SPI_HZ)),
            LinkKind::I2c => Ends::I2c(fresh_i2c(), I2cMaster::new(robot)),
            LinkKind::Uart | LinkKind::HalfDuplex | LinkKind::Tcp | LinkKind::Usb => return None,
        };
        Some(Self { ends, due: 0 })
    }

    /// These bytes are for the robot.
    pub(crate) fn send(&mut self, bytes: &[u8]) {
        match &mut self.ends {
            Ends::Spi(end, _) => end.send(bytes),
            Ends::I2c(end, _) => end.send(bytes),
        }
    }

    /// The cycle at which the host has to do something.
    pub(crate) fn due(&self, robot: &EmulatedRobot) -> u64 {
        let is_called = self.cable().is_called(robot);
        if is_called {
            self.due.min(robot.machine().cycle())
        } else {
            self.due
        }
    }

    /// One transfer; what the host hears is appended.
    pub(crate) fn turn(&mut self, robot: &mut EmulatedRobot, heard: &mut Vec<u8>) {
        let rest_us = match &mut self.ends {
            Ends::Spi(end, master) => {
                let Ok(()) = end.turn(&mut SpiWires { robot, master }, heard);
                if master.cable.is_called(robot) {
                    end.called();
                }
                end.rest_us()
            }
            Ends::I2c(end, master) => match end.turn(&mut I2cWires { robot, master }, heard) {
                Ok(()) => {
                    if master.cable.is_called(robot) {
                        end.called();
                    }
                    end.rest_us()
                }
                Err(_) => {
                    *end = fresh_i2c();
                    REOPEN_US
                }
            },
        };
        self.due = robot.machine().cycle() + rest_us * CYCLES_PER_US;
    }

    /// What the robot has said since the last call.
    pub(crate) fn take_said(&mut self) -> Vec<u8> {
        self.cable_mut().take_said()
    }

    /// From now on it is damaged.
    pub(crate) fn make_noisy(&mut self, seed: u64, rates: FaultRates) {
        self.cable_mut().make_noisy(seed, rates);
    }

    /// From now on it is not.
    pub(crate) fn make_quiet(&mut self) {
        self.cable_mut().make_quiet();
    }

    /// The cable is out between these cycles.
    pub(crate) fn cut(&mut self, from: u64, until: u64) {
        self.cable_mut().cut(from, until);
    }

    const fn cable(&self) -> &Cable {
        match &self.ends {
            Ends::Spi(_, master) => &master.cable,
            Ends::I2c(_, master) => &master.cable,
        }
    }

    const fn cable_mut(&mut self) -> &mut Cable {
        match &mut self.ends {
            Ends::Spi(_, master) => &mut master.cable,
            Ends::I2c(_, master) => &mut master.cable,
        }
    }
}

fn fresh_spi() -> ClockedEnd<SpiHost> {
    ClockedEnd::new(SpiHost::default(), true)
}

fn fresh_i2c() -> ClockedEnd<I2cHost> {
    ClockedEnd::new(I2cHost::default(), true)
}
