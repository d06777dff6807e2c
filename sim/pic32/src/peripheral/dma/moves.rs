//! DMA between the registers, the memories and the requests.

use super::{Dma, DmaRequests, DmaWrite, READ};
use crate::cpu::{Access, Width};
use crate::memory::{FLASH_START, Memory};
use crate::peripheral::schedule::Slot;
use crate::peripheral::{Chip, Irq, Misuse, Order};

/// Cycles of the system clock from one access to the next.
const ACCESS_CYCLES: u64 = 4;
const REGISTERS: std::ops::Range<u32> = 0x1F80_0000..0x1F90_0000;

/// Nothing is there, or it cannot be written.
struct AddressError;

impl Chip {
    /// How requests that stay up start cells.
    pub(crate) fn set_dma_requests(&mut self, requests: DmaRequests) {
        self.dma.set_requests(requests);
        self.interrupts.pulse_lines(requests == DmaRequests::OncePerEvent);
    }

    pub(in crate::peripheral) fn write_dma(&mut self, word: u8, value: u32) {
        match self.dma.write(word, value) {
            DmaWrite::Fine => {}
            DmaWrite::WhileOn(channel) => self.record.misuse(Misuse::DmaChannelOn(channel)),
            DmaWrite::Combination(channel) => self.record.misuse(Misuse::DmaSettings(channel)),
        }
        self.interrupts.listen(self.dma.listens_to());
        self.schedule_timers();
        self.settle_dma();
    }

    /// After anything that may start or end a transfer.
    pub(in crate::peripheral) fn settle_dma(&mut self) {
        let heard = self.interrupts.take_heard();
        if heard != 0 {
            self.dma.hear(heard);
        }
        self.dma.follow(self.interrupts.lines());
        let cycle = self.record.place.cycle;
        for (number, channel) in (0..).zip(&self.dma.channels) {
            self.interrupts.set_line(Irq::dma(number), channel.line(), cycle);
        }
        let wants = self.dma.next_mover(self.interrupts.lines()).is_some() && !self.is_asleep();
        if wants && !self.dma.is_moving {
            self.dma.is_moving = true;
            let due = cycle.saturating_add(self.clock.system.cycles_for(ACCESS_CYCLES));
            self.schedule.set(Slot::Dma, due);
        }
    }

    /// An access is due: memories are not here, so the machine gives them.
    pub(in crate::peripheral) fn serve_dma(&mut self, cycle: u64) {
        self.order(Order::Dma { cycle });
    }

    /// Moves one access of the channel whose turn it is.
    pub(crate) fn move_by_dma(&mut self, memory: &mut Memory, cycle: u64) {
        self.record.place.cycle = cycle;
        self.dma.is_moving = false;
        if let Some(number) = self
            .dma
            .next_mover(self.interrupts.lines())
            .filter(|_| !self.is_asleep())
        {
            // The chip's tables: a bus access between the two keys may spoil them.
            self.system.disturb_lock();
            self.dma.last = number;
            if self.move_one(number, memory, cycle).is_err() {
                self.dma.channels[usize::from(number)].fail();
            }
        }
        self.settle_dma();
        self.settle_request();
    }

    fn move_one(&mut self, number: u8, memory: &mut Memory, cycle: u64) -> Result<(), AddressError> {
        let place = usize::from(number);
        let appended = self.dma.crc.is_appended_to(number);
        let channel = &mut self.dma.channels[place];
        let width = channel.begin_access(appended);
        let (source, destination) = (channel.source.address(), channel.destination.address());
        let mut bytes = [0; 4];
        let bytes = &mut bytes[..width as usize];
        self.dma.note_access(number, source, READ);
        self.read_for_dma(source, bytes, (memory, cycle))?;
        if !appended {
            self.dma.note_access(number, destination, 0);
            self.write_for_dma(destination, bytes, (memory, cycle))?;
        }
        for byte in bytes.iter() {
            self.dma.crc.feed(number, *byte);
        }
        let last = bytes.last().copied().unwrap_or(0);
        if self.dma.channels[place].end_access(width, last, appended) {
            if appended {
                let result = u32::from(self.dma.crc.result()).to_le_bytes();
                let size = self.dma.channels[place].destination.bytes().min(4) as usize;
                self.write_for_dma(destination, &result[..size], (memory, cycle))?;
            }
            self.dma.chain(number);
        }
        Ok(())
    }

    fn read_for_dma(
        &mut self,
        address: u32,
        bytes: &mut [u8],
        (memory, cycle): (&Memory, u64),
    ) -> Result<(), AddressError> {
        if !REGISTERS.contains(&address) {
            return memory.read(address, bytes).map_err(|_| AddressError);
        }
        let value = self
            .load(self.access_of_dma(address, bytes.len(), cycle))
            .to_le_bytes();
        bytes.copy_from_slice(&value[..bytes.len()]);
        Ok(())
    }

    fn write_for_dma(
        &mut self,
        address: u32,
        bytes: &[u8],
        (memory, cycle): (&mut Memory, u64),
    ) -> Result<(), AddressError> {
        if REGISTERS.contains(&address) {
            let mut value = [0; 4];
            value[..bytes.len()].copy_from_slice(bytes);
            let access = self.access_of_dma(address, bytes.len(), cycle);
            self.store(access, u32::from_le_bytes(value));
            return Ok(());
        }
        // Flash is written by its own controller only.
        match address {
            ..FLASH_START => memory.write(address, bytes).map_err(|_| AddressError),
            _ => Err(AddressError),
        }
    }

    fn access_of_dma(&self, address: u32, bytes: usize, cycle: u64) -> Access {
        let width = match bytes {
            1 => Width::Byte,
            2 => Width::Half,
            _ => Width::Word,
        };
        let pc = self.record.place.pc;
        Access {
            address,
            width,
            cycle,
            pc,
        }
    }
}

impl Dma {
    /// DMASTAT and DMAADDR.
    fn note_access(&mut self, channel: u8, address: u32, direction: u32) {
        self.status = u32::from(channel) | direction;
        self.address = address;
    }
}
